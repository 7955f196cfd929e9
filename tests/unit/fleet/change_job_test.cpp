#include "blactl/fleet/change/change_job.hpp"

#include "support.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using dronecan::ExecuteOpcode;
using dronecan::RestartNode;
namespace at = bla::address;

namespace {

/// One servo and the job that changes it, without a bus: the servo answers when the test says so.
class Bench {
 public:
  explicit Bench(const Wanted& wanted, const bla::Values& held = {}, Servo known = bla21())
      : rom(*bla21().identity.factory_defaults()), known_(prepare(std::move(known))) {
    for (const auto& [address, raw] : held) {
      rom[address] = raw;
    }
    ram = rom;
    plan = plan_for(wanted, ram, known_.servo);
    job.emplace(known_.roster, profiles(), plan,
                ChangeJob::Options{.identification = {}, .come_back = 5s, .pace = nullptr});
    ask({Outcome::Kind::start, {}, {}});
  }

  /// Answers as the servo does until the job asks for this; it is not answered.
  void until(std::string_view question) {
    while (asked.back() != question) {
      INFO(question);
      REQUIRE(asked.back() != "nothing");
      answer();
    }
  }

  /// To the end.
  const ChangeResult& finish() {
    until("nothing");
    return job->result();
  }

  /// Answers what is asked; comes back from a restart that is waited for.
  void answer() {
    if (step_.request() == nullptr) {
      is_away_ ? come_back() : time_is_over();
      return;
    }
    ask(script_.answer(reply(*step_.request())));
  }

  void time_out() { ask(Script::timed_out()); }

  /// No answer to anything, to the end.
  void fall_silent() {
    while (asked.back() != "nothing") {
      step_.pause() != nullptr ? time_is_over() : time_out();
    }
  }

  /// The pause is over, nothing has been heard.
  void time_is_over() {
    REQUIRE(step_.pause() != nullptr);
    known_.now = std::max(known_.now, step_.pause()->until); // time never goes back
    ask({Outcome::Kind::woken, {}, {}});
  }

  const ChangeResult& cancel() {
    ask(Script::cancelled());
    CHECK(asked.back() == "nothing");
    CHECK_FALSE(job->must_finish());
    return job->result();
  }

  /// As if its supply had been off for a moment, which its NodeStatus tells.
  void restart_by_itself() {
    restart_silently();
    known_.restart();
    started = known_.now;
  }

  /// Likewise, at this moment.
  void restart_now() {
    restart_silently();
    known_.hear_uptime(0);
  }

  /// Only its uptime tells, when it is asked.
  void restart_silently() {
    ram = rom;
    started = known_.now;
  }

  /// Node 40 writes to a register of it.
  void other_writes(bla::Address address, std::int64_t raw) {
    ram[address] = raw;
    const auto payload = GetSet::Request{.value = raw, .name = address.name()}.encode();
    known_.roster.receive({.header = {.kind = dronecan::Kind::request,
                                      .data_type_id = GetSet::type.id,
                                      .source = NodeId(40),
                                      .destination = NodeId(11)},
                           .payload = payload.bytes(),
                           .at = known_.now});
  }

  /// It sends as ever, for so long.
  void is_heard(Duration time) {
    for (const Time end = known_.now + time; known_.now < end; known_.now += 100ms) {
      const auto id = static_cast<dronecan::TransferId>(sent_++ % dronecan::transfer_id_modulus);
      known_.roster.hear(
          message(dronecan::ActuatorStatus::type, 11, dronecan::ActuatorStatus{}.encode(), id)
              .front(),
          known_.now);
    }
  }

  /// Time goes by.
  void live(Duration time) { known_.now += time; }

  /// The pause is over because of something that was heard.
  void wake() {
    REQUIRE(step_.pause() != nullptr);
    REQUIRE(step_.pause()->ready());
    ask({Outcome::Kind::woken, {}, {}});
  }

  /// Another unit shows on its node ID.
  void double_id() { known_.roster.mark_doubled(NodeId(11), {11}, {2}); }

  [[nodiscard]] std::size_t count(std::string_view question) const {
    return static_cast<std::size_t>(std::ranges::count(asked, question));
  }

  /// Which registers were written.
  [[nodiscard]] std::vector<std::string> writes() const {
    std::vector<std::string> all;
    std::ranges::copy_if(asked, std::back_inserter(all),
                         [](const std::string& each) { return each.starts_with("write"); });
    return all;
  }

  bla::Values ram, rom;
  std::set<bla::Address> stuck{};    ///< registers that keep their value, whatever is written
  std::set<bla::Address> nameless{}; ///< registers that it does not know
  bool obeys = true;                 ///< opcodes and restarts
  bool agrees = true;                ///< to them
  Duration start_time = 3s;          ///< from a restart until it is heard
  Time started{900s};                ///< since when it runs
  Plan plan;
  std::optional<ChangeJob> job;
  std::vector<std::string> asked; ///< "SAVE", "write 0x23=1", …, "nothing" in the end

 private:
  static Servo prepare(Servo servo) {
    servo.since = Time{1000s};
    return servo;
  }

  void ask(Outcome outcome) {
    outcome.at = outcome.asked = known_.now;
    step_ = job->next(outcome);
    // A second unit on the ID is listened for, and is not there.
    const dronecan::Pause* pause = step_.pause();
    if (pause != nullptr && pause->until == known_.now + RunProof::twin_time) {
      known_.now = pause->until;
      step_ = job->next({Outcome::Kind::woken, {}, known_.now});
    }
    asked.push_back(said());
  }

  [[nodiscard]] std::string said() const {
    const std::string question = text(step_);
    if (question != "ExecuteOpcode") {
      return question;
    }
    const auto request = ExecuteOpcode::Request::decode(step_.request()->payload.bytes());
    REQUIRE(request);
    return request->opcode == ExecuteOpcode::save ? "SAVE" : "ERASE";
  }

  dronecan::Payload reply(const dronecan::Request& request) {
    if (request.type->id == GetNodeInfo::type.id) {
      const auto payload = info().encode();
      known_.roster.receive({.header = {.kind = dronecan::Kind::response,
                                        .data_type_id = GetNodeInfo::type.id,
                                        .source = NodeId(11)},
                             .payload = payload.bytes(),
                             .at = known_.now});
      return payload;
    }
    if (request.type->id == RestartNode::type.id) {
      is_away_ = agrees;
      return RestartNode::Response{.ok = agrees}.encode();
    }
    return request.type->id == GetSet::type.id ? reply_value(request) : reply_opcode(request);
  }

  [[nodiscard]] GetNodeInfo::Response info() const {
    const auto uptime = std::chrono::duration_cast<std::chrono::seconds>(known_.now - started);
    return {.status = {.uptime_s = static_cast<std::uint32_t>(uptime.count())},
            .unique_id = *known_.servo.unique_id,
            .name = "servo"};
  }

  dronecan::Payload reply_opcode(const dronecan::Request& request) {
    const auto opcode = ExecuteOpcode::Request::decode(request.payload.bytes())->opcode;
    if (agrees && obeys && opcode == ExecuteOpcode::save) {
      rom = ram;
      is_away_ = true;
    } else if (agrees && obeys) {
      ram = *bla21().identity.factory_defaults();
    }
    return ExecuteOpcode::Response{.ok = agrees}.encode();
  }

  dronecan::Payload reply_value(const dronecan::Request& request) {
    const auto get_set = GetSet::Request::decode(request.payload.bytes());
    const bla::Address address = *bla::find_address(get_set->name);
    const auto* number = std::get_if<std::int64_t>(&get_set->value);
    if (number != nullptr && !stuck.contains(address)) {
      ram[address] = *number;
    }
    if (nameless.contains(address)) {
      return GetSet::Response{}.encode();
    }
    const bla::Values product{{at::model_number, 61},
                              {at::serial_number, 240900558},
                              {at::firmware_version, 1400},
                              {at::hardware_version, 12050}};
    const auto value = bla::find(product, address).value_or(bla::find(ram, address).value_or(0));
    return GetSet::Response{.value = value, .name = get_set->name}.encode();
  }

  void come_back() {
    REQUIRE(step_.pause() != nullptr);
    is_away_ = false;
    restart_silently();
    known_.now += start_time;
    known_.hear_uptime(info().status.uptime_s);
    known_.roster.learn(NodeId(11), info(), known_.now);
    REQUIRE(step_.pause()->ready());
    ask({Outcome::Kind::woken, {}, {}});
  }

  Acquaintance known_;
  Script script_;
  dronecan::Step step_ = std::nullopt;
  unsigned sent_ = 0;    ///< of actuator.Status
  bool is_away_ = false; ///< it restarts because it was told to
};

Wanted set(const std::vector<std::string>& texts, bool save = false) {
  return {.assignments = assignments(texts),
          .restart = save ? std::optional(RestartKind::save) : std::nullopt};
}

const Wanted save{.restart = RestartKind::save};
const Wanted restart{.restart = RestartKind::restart};
const Wanted erase{.erase = true};
const Wanted erase_and_save{.erase = true, .restart = RestartKind::save};
const Wanted erase_keeping_ids{.erase = true, .keep_ids = true, .restart = RestartKind::save};

const bla::Values with_ids{{at::servo_id, 7}, {at::static_node_id, 11}};

/// That nothing looks like success, and which error there is.
Code failure(const ChangeResult& result) {
  CHECK_FALSE(result.is_done());
  CHECK_FALSE(result.is_verified);
  CHECK_FALSE(result.saved);
  REQUIRE_FALSE(result.errors().empty());
  CHECK(result.errors().front().node_id == 11);
  return result.errors().front().code;
}

bool says(const ChangeResult& result, std::string_view words) {
  return std::ranges::any_of(result.errors(), [&](const Error& error) {
    return error.message.find(words) != std::string::npos;
  });
}

} // namespace

TEST_CASE("what is set is written and read again, and nothing is saved or restarted") {
  Bench bench(set({"reverse=on", "angle_limit_cw=90deg"}));
  const ChangeResult& result = bench.finish();
  CHECK(bench.asked == std::vector<std::string>{"GetNodeInfo", "write 0x23=1", "write 0x38=900",
                                                "read 0x23", "read 0x38", "GetNodeInfo",
                                                "nothing"});
  CHECK(result.is_done());
  CHECK(result.changes[0].status == ChangeStatus::written);
  CHECK(result.changes[1].after == 900);
  CHECK_FALSE(result.saved);
  CHECK_FALSE(result.was_restarted);
  CHECK(result.node_id_after == NodeId(11));
  CHECK(result.errors().empty());
}

TEST_CASE("a plan that does nothing asks whether it is the same servo, and no more") {
  Bench bench(set({"reverse=on"}), {{at::reverse, 1}});
  const ChangeResult& result = bench.finish();
  CHECK(bench.asked == std::vector<std::string>{"GetNodeInfo", "nothing"});
  CHECK(result.changes[0].status == ChangeStatus::unchanged);
  CHECK(result.errors().empty());
}

TEST_CASE("what is in RAM only is lost if the servo restarts while others are still at work") {
  const auto after_the_end = [](Bench& bench, bool restarts) {
    bench.finish();
    if (restarts) {
      bench.restart_by_itself();
    }
    bench.job->look_back();
    return bench.job->result();
  };
  SECTION("written") {
    Bench bench(set({"reverse=on"}));
    CHECK(failure(after_the_end(bench, true)) == Code::state);
    CHECK(bench.job->result().changes[0].status == ChangeStatus::failed);
    CHECK_FALSE(bench.job->result().changes[0].after);
  }
  SECTION("held already") {
    Bench bench(set({"reverse=on"}), {{at::reverse, 1}});
    CHECK(failure(after_the_end(bench, true)) == Code::state);
  }
  SECTION("erased") {
    Bench bench(erase);
    CHECK(failure(after_the_end(bench, true)) == Code::state);
  }
  SECTION("but not if it runs on") {
    Bench bench(set({"reverse=on"}));
    CHECK(after_the_end(bench, false).is_done());
  }
  SECTION("and not if it was saved") {
    Bench bench(set({"reverse=on"}, true));
    CHECK(after_the_end(bench, true).saved);
    CHECK(bench.job->result().is_done());
  }
}

TEST_CASE(
    "what was proven is not, if another unit shows on the ID while others are still at work") {
  Bench bench(set({"reverse=on"}, true));
  bench.finish();
  bench.double_id();
  bench.job->look_back();
  CHECK(failure(bench.job->result()) == Code::duplicate_node_id);
  CHECK(bench.job->result().changes[0].status == ChangeStatus::failed);
}

TEST_CASE("what another node wrote meanwhile is not told as what the servo holds") {
  SECTION("to a register that held the value already") {
    Bench bench(set({"reverse=on"}), {{at::reverse, 1}});
    bench.live(1s);
    bench.other_writes(at::reverse, 0);
    bench.finish();
    bench.job->look_back();
    CHECK(failure(bench.job->result()) == Code::state);
    CHECK(says(bench.job->result(), "node 40 wrote to node 11"));
  }
  SECTION("after it was read back") {
    Bench bench(set({"reverse=on"}));
    bench.finish();
    bench.live(1s);
    bench.other_writes(at::reverse, 0);
    bench.job->look_back();
    CHECK(failure(bench.job->result()) == Code::state);
  }
  SECTION("to a setting by which the value was judged, after that was written") {
    Bench bench(set({"temperature_limit_high=20degC"}), {{at::temperature_limit_low, -40}});
    bench.finish();
    bench.live(1s);
    bench.other_writes(at::temperature_limit_low, 20);
    bench.job->look_back();
    CHECK(failure(bench.job->result()) == Code::state);
  }
  SECTION("a command to move is no setting, and overwritten all the same") {
    Bench bench(set({"command_angle=10deg"}));
    bench.finish();
    bench.live(1s);
    bench.other_writes(at::command_angle, 0);
    bench.job->look_back();
    CHECK(failure(bench.job->result()) == Code::state);
  }
  SECTION("but another register is another matter") {
    Bench bench(set({"reverse=on"}));
    bench.live(1s);
    bench.other_writes(at::smoothing, 0);
    bench.finish();
    bench.job->look_back();
    CHECK(bench.job->result().is_done());
  }
}

TEST_CASE("what is shown beside the changes and tells of a moment is read again after them") {
  constexpr std::int64_t no_pulse = 1 << 20, too_long = 1 << 22;
  Wanted wanted = set({"pwm_range=100us"});
  wanted.also_read = {at::fault_notice, at::pwm_neutral};
  SECTION("what is only written") {
    Bench bench(wanted, {{at::fault_notice, no_pulse}});
    bench.until("write 0x35=100");
    bench.ram[at::fault_notice] = too_long;
    const ChangeResult& result = bench.finish();
    CHECK(bench.asked == std::vector<std::string>{"GetNodeInfo", "write 0x35=100", "read 0x35",
                                                  "GetNodeInfo", "read 0x19", "GetNodeInfo",
                                                  "nothing"});
    CHECK(result.is_done());
    CHECK(bla::find(result.before, at::fault_notice) == no_pulse);
    CHECK(bla::find(result.after(), at::fault_notice) == too_long);
    CHECK(bla::find(result.after(), at::pwm_neutral) == 1520);
  }
  SECTION("what is saved") {
    wanted.restart = RestartKind::save;
    Bench bench(wanted, {{at::fault_notice, no_pulse}});
    bench.until("SAVE");
    bench.ram[at::fault_notice] = too_long;
    const ChangeResult& result = bench.finish();
    CHECK(result.saved);
    CHECK(bla::find(result.after(), at::fault_notice) == too_long);
  }
  SECTION("what cannot be read is not shown, and hinders nothing") {
    Bench bench(wanted, {{at::fault_notice, no_pulse}});
    bench.until("read 0x19");
    bench.fall_silent();
    CHECK(bench.job->result().is_done());
    CHECK_FALSE(bla::find(bench.job->result().after(), at::fault_notice));
  }
  SECTION("what is only planned tells nothing of a moment to come") {
    const ChangeResult planned = as_planned(plan_for(wanted, {{at::fault_notice, no_pulse}}));
    CHECK(bla::find(planned.before, at::fault_notice) == no_pulse);
    CHECK_FALSE(bla::find(planned.after(), at::fault_notice));
  }
}

TEST_CASE("what another node wrote meanwhile is not shown beside the changes, either") {
  Wanted wanted = set({"pwm_range=100us"});
  wanted.also_read = {at::fault_notice, at::pwm_output_range};
  Bench bench(wanted);
  bench.until("write 0x35=100");
  bench.live(1s);
  bench.other_writes(at::pwm_output_range, 1400);
  bench.finish();
  bench.job->look_back();
  const ChangeResult& result = bench.job->result();
  CHECK(failure(result) == Code::state);
  CHECK(says(result, "node 40 wrote to node 11"));
  CHECK_FALSE(bla::find(result.after(), at::pwm_range));
  CHECK_FALSE(bla::find(result.after(), at::fault_notice));
}

TEST_CASE("what is set and saved is written, saved once, and all of it read again") {
  Bench bench(set({"reverse=on"}, true));
  bench.until("SAVE");
  CHECK(bench.job->must_finish());
  const ChangeResult& result = bench.finish();
  CHECK(result.is_done());
  CHECK(result.saved);
  CHECK(result.was_restarted);
  CHECK(result.returned == NodeId(11));
  CHECK(result.node_id_after == NodeId(11));
  CHECK(result.values_read == 34);
  CHECK(result.duration > 0s);
  CHECK(bench.count("SAVE") == 1);
  CHECK(bench.count("read 0x1A") == 1); // whether ROM could be read
  CHECK(bench.count("read 0x46") == 1);
  CHECK(bench.rom.at(at::reverse) == 1);
}

TEST_CASE("a save alone writes no register") {
  Bench bench(save);
  CHECK(bench.finish().is_done());
  CHECK(bench.job->result().saved);
  CHECK(bench.writes().empty());
}

TEST_CASE("a restart is not a save: the servo is identified again, nothing is claimed of ROM") {
  Bench bench(restart);
  const ChangeResult& result = bench.finish();
  CHECK(result.is_done());
  CHECK_FALSE(result.saved);
  CHECK(result.returned == NodeId(11));
  CHECK(result.values_read == 0);
  CHECK(bench.count("RestartNode") == 1);
  CHECK(bench.count("SAVE") == 0);
  CHECK(bench.writes().empty());
  CHECK(bench.count("read 0x46") == 0);
}

TEST_CASE("an erased servo is read again before anything else, and saved only if that is wanted") {
  const bool saves = GENERATE(true, false);
  Bench bench(saves ? erase_and_save : erase, with_ids);
  const ChangeResult& result = bench.finish();
  CHECK(result.is_done());
  CHECK(result.saved == saves);
  CHECK(result.servo.servo_id == 0);
  CHECK(result.values_read == 34);
  CHECK(bench.asked[0] == "GetNodeInfo");
  CHECK(bench.asked[1] == "ERASE");
  CHECK(bench.asked[2] == "read 0x20");
  CHECK(bench.count("ERASE") == 1);
  CHECK(bench.count("SAVE") == (saves ? 1U : 0U));
  CHECK(bench.writes().empty());
}

TEST_CASE("kept IDs are written again after ERASE and before SAVE") {
  Bench bench(erase_keeping_ids, with_ids);
  const ChangeResult& result = bench.finish();
  CHECK(result.is_done());
  CHECK(result.saved);
  CHECK(result.servo.servo_id == 7);
  CHECK(bench.writes() == std::vector<std::string>{"write 0x45=7", "write 0x46=11"});
  CHECK(bench.rom.at(at::servo_id) == 7);
  CHECK(bench.rom.at(at::static_node_id) == 11);
}

TEST_CASE("a servo that restarts by itself after ERASE has its old values back: nothing is saved") {
  const bool saves = GENERATE(true, false);
  Wanted wanted = erase_keeping_ids;
  if (!saves) {
    wanted.restart.reset();
  }
  Bench bench(wanted, {{at::servo_id, 7}, {at::static_node_id, 11}, {at::reverse, 1}});
  bench.until("write 0x46=11");
  bench.restart_by_itself();
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::state);
  CHECK(says(result, "may be back"));
  CHECK(bench.ram.at(at::reverse) == 1);
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE(
    "a servo that restarts by itself while it is written to is written to again, then saved") {
  Bench bench(set({"reverse=on", "angle_limit_cw=90deg"}, true));
  bench.until("write 0x38=900");
  bench.restart_by_itself();
  const ChangeResult& result = bench.finish();
  CHECK(result.is_done());
  CHECK(bench.count("write 0x23=1") == 2);
  CHECK(bench.count("SAVE") == 1);
  CHECK(bench.rom.at(at::reverse) == 1);
}

TEST_CASE("a servo that restarts while the defaults are read back is not called another model") {
  Bench bench(erase_keeping_ids, {{at::servo_id, 7}, {at::static_node_id, 11}, {at::reverse, 1}});
  bench.until("read 0x24");
  bench.restart_by_itself();
  bench.live(3s);
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::state);
  CHECK(says(result, "may be back"));
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE("what another node wrote is blamed on that node, not on ROM or the model") {
  Bench bench(set({"reverse=on"}, true));
  bench.until("SAVE");
  bench.live(1ms);
  bench.other_writes(at::angle_limit_cw, 900);
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::state);
  CHECK(says(result, "node 40 wrote to node 11 meanwhile"));
  CHECK(result.error->hint.find("ROM") == std::string::npos);
}

TEST_CASE("the servo ID that was written is the one that the result shows") {
  Bench bench(set({"servo_id=7"}));
  CHECK(bench.finish().servo.servo_id == 7);
}

TEST_CASE("a servo that refuses ERASE is left alone") {
  Bench bench(erase_keeping_ids, with_ids);
  bench.agrees = false;
  CHECK(failure(bench.finish()) == Code::refused);
  CHECK(bench.count("ERASE") == 1);
  CHECK(bench.count("SAVE") == 0);
  CHECK(bench.writes().empty());
}

TEST_CASE("a servo that answers ERASE with a refusal and carries it out is found out") {
  Bench bench(erase, with_ids);
  bench.until("ERASE");
  bench.agrees = false;
  bench.ram = *bla21().identity.factory_defaults();
  const ChangeResult& result = bench.finish();
  CHECK(result.is_done());
  CHECK(result.may_have_changed);
}

TEST_CASE("a refused ERASE is not repeated where it has left neither the old values nor defaults") {
  Bench bench(erase_and_save, {{at::angle_limit_cw, 900}});
  bench.agrees = false;
  bench.until("read 0x38");
  bench.ram[at::angle_limit_cw] = 450;
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::mismatch);
  CHECK(bench.count("ERASE") == 1);
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE("an ERASE without an answer is judged by the registers") {
  Bench bench(erase, with_ids);
  bench.until("ERASE");
  SECTION("it was carried out: it is not sent again") {
    bench.ram = *bla21().identity.factory_defaults();
    bench.time_out();
    CHECK(bench.finish().is_done());
    CHECK(bench.count("ERASE") == 1);
  }
  SECTION("it was not: it is sent once more") {
    bench.time_out();
    CHECK(bench.finish().is_done());
    CHECK(bench.count("ERASE") == 2);
  }
  SECTION("nor the second time: there is no third one") {
    bench.time_out();
    bench.until("ERASE");
    while (bench.asked.back() == "ERASE") {
      bench.time_out();
    }
    CHECK(failure(bench.finish()) == Code::timeout);
    CHECK(says(bench.job->result(), "ERASE"));
    CHECK(bench.count("ERASE") == 2);
  }
}

TEST_CASE("a servo that confirms ERASE and keeps its values is a mismatch, and is not saved") {
  Bench bench(erase_and_save, with_ids);
  bench.obeys = false;
  CHECK(failure(bench.finish()) == Code::mismatch);
  CHECK(says(bench.job->result(), "servo_id"));
  CHECK(bench.count("ERASE") == 1);
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE("a servo that cannot be read after ERASE is not proven to be erased") {
  Bench bench(erase_and_save, with_ids);
  bench.until("read 0x46");
  bench.time_out();
  CHECK(failure(bench.finish()) == Code::timeout);
  CHECK(bench.count("ERASE") == 1);
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE("what a servo did not take is not looked after in its RAM") {
  Bench bench(set({"reverse=on"}));
  bench.stuck = {at::reverse};
  CHECK(failure(bench.finish()) == Code::refused);
  CHECK_FALSE(bench.job->in_ram_only());
}

TEST_CASE("where one register is not taken nothing is saved") {
  Bench bench(set({"reverse=on", "angle_limit_cw=90deg"}, true));
  bench.stuck = {at::reverse};
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::refused);
  CHECK(result.changes[1].status == ChangeStatus::written); // the others are written all the same
  CHECK(bench.count("SAVE") == 0);
  CHECK_FALSE(result.was_restarted);
  CHECK(result.errors().size() == 1);
}

TEST_CASE("a servo that refuses to save or restart is not read again") {
  Bench bench(GENERATE(as<Wanted>{}, save, restart));
  bench.agrees = false;
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::refused);
  CHECK_FALSE(result.returned);
  CHECK(bench.count("read 0x20") == 0);
}

TEST_CASE("a servo that does not come back has no node ID any more") {
  Bench bench(GENERATE(as<Wanted>{}, save, restart));
  bench.until("pause");
  bench.fall_silent();
  const ChangeResult& result = bench.job->result();
  CHECK(failure(result) == Code::not_back);
  CHECK_FALSE(result.returned);
  CHECK_FALSE(result.node_id_after);
  CHECK(result.duration == 5s);
}

TEST_CASE("a servo whose ROM did not take what RAM had is found out, and told so") {
  Bench bench(set({"reverse=on"}, true));
  bench.until("pause");
  bench.rom[at::reverse] = 0;
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::mismatch);
  CHECK(says(result, "reverse"));
  CHECK(result.changes[0].status == ChangeStatus::mismatch);
  CHECK(result.changes[0].after == 0);
  CHECK(result.error->hint.find("ROM") != std::string::npos);
  CHECK(result.returned == NodeId(11));
  CHECK(bench.count("SAVE") == 1);
}

TEST_CASE("a servo that restarted instead of saving has no faulty ROM") {
  Bench bench(set({"reverse=on"}, true));
  bench.until("SAVE");
  bench.restart_by_itself();
  bench.time_out();
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::mismatch);
  CHECK_FALSE(result.saved);
  CHECK(result.error->hint.find("faulty") == std::string::npos);
}

TEST_CASE("what another node writes after the restart hides what ROM holds") {
  Bench bench(set({"reverse=on"}, true));
  bench.until("SAVE");
  bench.until("read 0x20");
  bench.other_writes(at::reverse, 1);
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::state);
  CHECK(says(result, "node 40 wrote to node 11"));
  CHECK_FALSE(result.saved);
}

TEST_CASE("a second restart, behind a silence in which nobody was heard, proves nothing of ROM") {
  Bench bench(set({"reverse=on"}, true));
  bench.until("SAVE");
  bench.until("read 0x20");
  bench.is_heard(200ms);
  bench.live(4s);
  bench.restart_now();
  bench.is_heard(100ms);
  bench.rom[at::reverse] = 0; // another tool has saved it, and then tries the wished value in RAM
  bench.ram[at::reverse] = 1;
  const ChangeResult& result = bench.finish();
  CHECK_FALSE(result.saved);
  CHECK(says(result, "has restarted since"));
}

TEST_CASE("what another node writes between the writes and SAVE is not saved") {
  Bench bench(set({"reverse=on"}, true));
  bench.until("write 0x23=1");
  bench.live(1s);
  bench.other_writes(at::smoothing, 0);
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::state);
  CHECK(says(result, "node 40 wrote to node 11"));
  CHECK_FALSE(result.saved);
  CHECK_FALSE(result.may_have_saved);
  CHECK(result.changes.front().status == ChangeStatus::written);
}

TEST_CASE("a servo that says that it could not read its ROM did not save") {
  Bench bench(save);
  bench.until("pause");
  bench.rom[at::fault_warning] = 1 << 15;
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::mismatch);
  CHECK(says(result, "could not read its ROM"));
}

TEST_CASE("a servo that is back and cannot be read is not proven to be saved") {
  Bench bench(save);
  for (int times = 0; times < 5; ++times) { // one lost answer is no reason
    bench.until("read 0x38");
    bench.time_out();
  }
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::timeout);
  CHECK(result.returned == NodeId(11));
}

TEST_CASE("interrupted while it writes: the rest is not tried, nothing is saved") {
  Bench bench(set({"reverse=on", "angle_limit_cw=90deg"}, GENERATE(true, false)));
  bench.until("write 0x23=1");
  CHECK_FALSE(bench.job->must_finish());
  const ChangeResult& result = bench.cancel();
  CHECK(failure(result) == Code::interrupted);
  CHECK(result.changes[0].status == ChangeStatus::failed);
  CHECK(result.changes[1].status == ChangeStatus::planned);
  CHECK(bench.writes() == std::vector<std::string>{"write 0x23=1"});
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE("interrupted while it writes: what was refused before stays said") {
  Bench bench(set({"reverse=on", "angle_limit_cw=90deg"}));
  bench.stuck.insert(at::reverse);
  bench.until("write 0x38=900");
  const ChangeResult& result = bench.cancel();
  CHECK(failure(result) == Code::refused);
  CHECK(says(result, "interrupted while node 11 was written"));
}

TEST_CASE("interrupted between writing and SAVE: RAM has it, ROM does not, and that is told") {
  const bool erases = GENERATE(true, false);
  Bench bench(erases ? erase_keeping_ids : set({"reverse=on"}, true), with_ids);
  bench.until(erases ? "write 0x46=11" : "write 0x23=1");
  bench.answer();
  REQUIRE(bench.asked.back() == "GetNodeInfo"); // what was written is proven
  bench.answer();
  REQUIRE(bench.asked.back() == "GetNodeInfo"); // SAVE is next
  CHECK_FALSE(bench.job->must_finish());
  const ChangeResult& result = bench.cancel();
  CHECK(failure(result) == Code::interrupted);
  CHECK(says(result, erases ? "a SAVE would keep them" : "is not saved"));
  CHECK_FALSE(says(result, "before anything was sent"));
  CHECK(result.changes[0].status == ChangeStatus::written);
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE("interrupted before what was written is proven: it is not said to be written") {
  Bench bench(set({"reverse=on"}, true));
  bench.until("write 0x23=1");
  bench.until("GetNodeInfo");
  CHECK_FALSE(bench.job->must_finish());
  const ChangeResult& result = bench.cancel();
  CHECK(failure(result) == Code::interrupted);
  CHECK(result.changes[0].status == ChangeStatus::failed);
  CHECK_FALSE(result.changes[0].after);
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE("interrupted while it is looked at before SAVE: ROM was not written") {
  Bench bench(set({"reverse=on"}, true));
  bench.until("write 0x23=1");
  bench.until("GetNodeInfo");
  bench.answer();
  bench.live(10s);
  bench.restart_silently();
  bench.live(3s);
  bench.until("read 0x20");
  CHECK_FALSE(bench.job->must_finish());
  const ChangeResult& result = bench.cancel();
  CHECK(failure(result) == Code::interrupted);
  CHECK(says(result, "is not saved"));
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE("interrupted before the one request that it is about: nothing was sent") {
  Bench bench(GENERATE(as<Wanted>{}, save, restart));
  REQUIRE(bench.asked.back() == "GetNodeInfo");
  CHECK_FALSE(bench.job->must_finish());
  const ChangeResult& result = bench.cancel();
  CHECK(failure(result) == Code::interrupted);
  CHECK(says(result, "before anything was sent"));
  CHECK(bench.asked == std::vector<std::string>{"GetNodeInfo", "nothing"});
}

TEST_CASE("interrupted after SAVE was sent: what ROM holds is not known") {
  const auto* at = GENERATE("SAVE", "pause");
  Bench bench(save);
  bench.until(at);
  CHECK(bench.job->must_finish());
  const ChangeResult& result = bench.cancel();
  CHECK(failure(result) == Code::interrupted);
  CHECK(says(result, "not known"));
  CHECK_FALSE(result.returned);
  CHECK(bench.count("SAVE") == 1);
  CHECK(bench.count("read 0x20") == 0);
}

TEST_CASE("interrupted while it is read after SAVE: it is back, and not proven") {
  const auto* question = GENERATE("read 0x50", "read 0x20", "read 0x1A");
  Bench bench(save);
  bench.until(question);
  CHECK(bench.job->must_finish());
  const ChangeResult& result = bench.cancel();
  CHECK(failure(result) == Code::interrupted);
  CHECK(says(result, "not read again"));
  CHECK(result.errors().size() == 1);
  CHECK(result.returned == NodeId(11));
  CHECK(result.node_id_after == NodeId(11));
}

TEST_CASE("interrupted while it is read after a restart that was to prove ROM: nothing was saved") {
  Wanted proving = restart;
  proving.proves_rom = true;
  Bench bench(proving);
  bench.until("RestartNode");
  bench.until("read 0x38");
  const ChangeResult& result = bench.cancel();
  CHECK(failure(result) == Code::interrupted);
  CHECK(says(result, "not read completely"));
  CHECK_FALSE(says(result, "saved"));
  CHECK_FALSE(result.may_have_saved);
}

TEST_CASE("interrupted before ERASE it is not sent; after it, it is not claimed") {
  const auto* question = GENERATE("GetNodeInfo", "ERASE", "read 0x20", "read 0x46");
  Bench bench(erase_and_save, with_ids);
  bench.until(question);
  CHECK_FALSE(bench.job->must_finish());
  const ChangeResult& result = bench.cancel();
  CHECK(failure(result) == Code::interrupted);
  const bool is_sent = std::string_view(question) != "GetNodeInfo";
  CHECK(bench.count("ERASE") == (is_sent ? 1U : 0U));
  CHECK(says(result, "what its RAM holds is not known") == is_sent);
  CHECK(bench.count("SAVE") == 0);
  CHECK(bench.writes().empty());
}

TEST_CASE("interrupted while the kept IDs are written: they may be lost, and that is told") {
  Bench bench(erase_keeping_ids, with_ids);
  bench.until("write 0x45=7");
  const ChangeResult& result = bench.cancel();
  CHECK(failure(result) == Code::interrupted);
  CHECK(result.changes[0].status == ChangeStatus::failed);
  CHECK(result.changes[1].status == ChangeStatus::planned);
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE("interrupted after ERASE and before SAVE: the defaults are in RAM only") {
  Bench bench(erase_and_save, with_ids);
  bench.until("ERASE");
  bench.answer();
  bench.until("GetNodeInfo"); // what was read is of one moment
  bench.answer();
  bench.until("GetNodeInfo"); // SAVE is next
  const ChangeResult& result = bench.cancel();
  CHECK(failure(result) == Code::interrupted);
  CHECK(says(result, "a SAVE would keep them"));
  CHECK(result.errors().front().hint.find("blactl get") != std::string::npos);
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE("what is in RAM only is doubted as well where another register was refused") {
  const bool restarts = GENERATE(true, false);
  Bench bench(set({"reverse=on", "angle_limit_cw=90deg"}));
  bench.stuck = {at::angle_limit_cw};
  bench.finish();
  REQUIRE(bench.job->result().changes[0].status == ChangeStatus::written);
  bench.live(10s);
  restarts ? bench.restart_by_itself() : bench.other_writes(at::reverse, 0);
  bench.job->look_back();
  const ChangeResult& result = bench.job->result();
  CHECK(result.changes[0].status == ChangeStatus::failed);
  CHECK_FALSE(result.changes[0].after);
  CHECK(failure(result) == Code::refused);
}

TEST_CASE("an ERASE that left a command as it was did nothing") {
  Bench bench(Wanted{.erase = true});
  bench.obeys = false;
  bench.ram[at::command_angle] = 450;
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::mismatch);
  CHECK(says(result, "command_angle"));
}

TEST_CASE(
    "a servo that restarted before SAVE is looked at again, and not saved where RAM lost it") {
  const bool is_heard = GENERATE(true, false);
  Bench bench(set({"reverse=on"}, true));
  bench.until("write 0x23=1");
  bench.until("GetNodeInfo");
  bench.answer();
  REQUIRE(bench.asked.back() == "GetNodeInfo"); // SAVE is next
  bench.live(10s);
  is_heard ? bench.restart_by_itself() : bench.restart_silently();
  bench.live(3s);
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::state);
  CHECK(says(result, "restarted before SAVE"));
  CHECK(says(result, "nothing was saved"));
  CHECK(result.changes[0].status == ChangeStatus::mismatch);
  CHECK(result.changes[0].after == 0);
  CHECK(bench.count("SAVE") == 0);
  CHECK(bench.count("write 0x23=1") == 1);
}

TEST_CASE("a servo that restarted before SAVE and holds all of it all the same is saved") {
  Bench bench(save);
  bench.live(10s);
  bench.restart_by_itself();
  bench.live(3s);
  const ChangeResult& result = bench.finish();
  CHECK(result.is_done());
  CHECK(result.saved);
  CHECK(bench.count("SAVE") == 1);
  CHECK(bench.count("read 0x20") == 2); // before SAVE and after it
}

TEST_CASE("a servo that cannot be read before SAVE is not saved") {
  Bench bench(save);
  bench.live(10s);
  bench.restart_by_itself();
  bench.live(3s);
  bench.until("read 0x38");
  bench.time_out();
  CHECK(failure(bench.finish()) == Code::timeout);
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE("a servo that restarts again and again is not saved") {
  Bench bench(save);
  for (int restarts = 0; bench.asked.back() != "nothing"; ++restarts) {
    REQUIRE(restarts < 20);
    bench.live(10s);
    bench.restart_by_itself();
    bench.live(3s);
    bench.answer(); // it restarts whenever it is asked who it is
    while (bench.asked.back() != "GetNodeInfo" && bench.asked.back() != "nothing") {
      bench.answer();
    }
  }
  CHECK(failure(bench.job->result()) == Code::state);
  CHECK(says(bench.job->result(), "again and again"));
  CHECK(bench.count("SAVE") == 0);
}

TEST_CASE("a servo to which another node writes whenever it has been looked at is not saved") {
  Bench bench(save);
  while (bench.asked.back() != "nothing") {
    REQUIRE(bench.asked.size() < 1000);
    const std::string before = bench.asked.size() < 2 ? "" : bench.asked[bench.asked.size() - 2];
    if (bench.asked.back() == "GetNodeInfo" && !before.starts_with("read")) { // not of the reading
      bench.live(1s);
      bench.other_writes(at::reverse, 1);
      bench.other_writes(at::reverse, 0); // as it was
    }
    bench.answer();
  }
  CHECK(failure(bench.job->result()) == Code::state);
  CHECK(says(bench.job->result(), "writes to node"));
  CHECK_FALSE(says(bench.job->result(), "restarts"));
  CHECK(bench.count("SAVE") == 0);
  CHECK(bench.count("read 0x38") == 3);
}

TEST_CASE(
    "a servo that tells its serial number only before a save, or only after it, is that one") {
  const bool before = GENERATE(false, true);
  Servo known = bla21();
  if (!before) {
    known.identity = bla::Identity(profiles(), {61, std::nullopt, 1400, 12050});
  }
  Bench bench(save, {}, known);
  bench.nameless = before ? std::set{at::serial_number} : std::set<bla::Address>{};
  const ChangeResult& result = bench.finish();
  CHECK(result.is_done());
  CHECK(result.saved);
}

TEST_CASE("a servo that is young when it is read back is read once: what it holds is from ROM") {
  Bench bench(save);
  bench.start_time = 0s;
  const ChangeResult& result = bench.finish();
  CHECK(result.is_done());
  CHECK(result.saved);
  CHECK(bench.count("read 0x20") == 1);
}

TEST_CASE("a servo that crashes while it saves does not hold what was told to be written") {
  Bench bench(set({"reverse=on"}, true));
  bench.until("SAVE");
  bench.time_out();
  bench.fall_silent();
  const ChangeResult& result = bench.job->result();
  CHECK(failure(result) == Code::not_back);
  CHECK(result.changes[0].status == ChangeStatus::failed);
  CHECK_FALSE(result.changes[0].after);
}

TEST_CASE("a servo that refuses SAVE holds in RAM what was written") {
  Bench bench(set({"reverse=on"}, true));
  bench.agrees = false;
  const ChangeResult& result = bench.finish();
  CHECK(failure(result) == Code::refused);
  CHECK(result.changes[0].status == ChangeStatus::written);
  CHECK(result.changes[0].after == 1);
}

TEST_CASE("another unit that shows on the ID while it saves: nothing is claimed") {
  Bench bench(set({"reverse=on"}, true));
  bench.until("pause");
  bench.double_id();
  bench.wake();
  const ChangeResult& result = bench.job->result();
  CHECK(failure(result) == Code::duplicate_node_id);
  CHECK_FALSE(result.returned);
  CHECK(result.changes[0].status == ChangeStatus::failed);
}

TEST_CASE("another unit that shows when something was sent may have taken it, which is told") {
  const auto hint_after = [](const Wanted& wanted, std::string_view sent) {
    Bench bench(wanted);
    bench.until(sent);
    bench.until("GetNodeInfo");
    bench.double_id();
    const ChangeResult& result = bench.finish();
    CHECK(failure(result) == Code::duplicate_node_id);
    return result.errors().front().hint;
  };
  const std::string after_write = hint_after(set({"reverse=on"}), "read 0x23");
  CHECK(after_write.find("may have taken what was sent") != std::string::npos);
  const std::string after_erase = hint_after(Wanted{.erase = true}, "read 0x38");
  CHECK(after_erase == after_write);
  CHECK(hint_after(set({"reverse=on"}), "GetNodeInfo") != after_write);
}

TEST_CASE("the warnings of a plan are those of its result") {
  const Plan plan = plan_for(set({"speed_p_gain=5"}));
  REQUIRE(plan.warnings.size() == 1);
  const ChangeResult result = as_planned(plan);
  REQUIRE(result.warnings.size() == 1);
  CHECK(result.warnings[0].code == "leave_at_default");
}

TEST_CASE("errors are told in the order in which they happened: registers, then the servo") {
  ChangeResult result;
  RegisterChange change;
  change.error = Error{Code::refused, "first"};
  result.changes = {change, RegisterChange{}};
  result.error = Error{Code::not_back, "second"};
  const auto errors = result.errors();
  REQUIRE(errors.size() == 2);
  CHECK(errors[0].message == "first");
  CHECK(errors[1].message == "second");
}

TEST_CASE("a plan that is only shown has its changes, and is not done") {
  const Plan plan = plan_for(set({"reverse=on"}, true));
  const ChangeResult shown = as_planned(plan);
  CHECK(shown.changes.size() == 1);
  CHECK(shown.changes[0].is_planned());
  CHECK(shown.servo.id == NodeId(11));
  CHECK(shown.node_id_after == NodeId(11));
  CHECK_FALSE(shown.is_done());
  CHECK_FALSE(shown.saved);
  CHECK_FALSE(shown.was_restarted);
  CHECK(shown.errors().empty());
}
