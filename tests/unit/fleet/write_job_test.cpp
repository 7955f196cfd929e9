#include "blactl/fleet/change/write_job.hpp"

#include "support.hpp"

#include <string>
#include <tuple>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

RegisterChange change(const char* name, std::int64_t requested,
                      std::optional<std::int64_t> before) {
  RegisterChange change;
  change.parameter = &parameter(name);
  change.requested = requested;
  change.before = before;
  change.status = before == requested ? ChangeStatus::unchanged : ChangeStatus::planned;
  return change;
}

/// A servo that is identified, without a bus.
struct Bench : Acquaintance {
  [[nodiscard]] WriteJob job(std::vector<RegisterChange> changes) const {
    return {roster, servo, std::move(changes), {}};
  }

  /// It is still the servo that is meant.
  std::string begin(WriteJob& job) {
    CHECK(text(job.next(Script::start())) == "GetNodeInfo");
    return text(job.next(script.info(1)));
  }

  std::string value(WriteJob& job, const char* name, std::int64_t value) {
    return text(job.next(script.value(name, value)));
  }

  /// Its uptime proves that it has run all the time.
  std::string proven(WriteJob& job) { return alone(job, text(job.next(script.info(1)))); }

  /// No second unit on the ID is heard within the time that it is listened for.
  std::string alone(WriteJob& job, const std::string& said) {
    return said == "pause" ? text(job.next({Outcome::Kind::woken, {}, {}})) : said;
  }

  /// The servo has only just started: it is asked again a second later, for what it `told` then.
  std::string young(WriteJob& job, std::uint32_t told) {
    CHECK(text(job.next(script.young_info(1))) == "pause");
    CHECK(text(job.next({Outcome::Kind::woken, {}, Time{1s}})) == "GetNodeInfo");
    Outcome outcome = script.info(1, told);
    outcome.at = outcome.asked = Time{1s};
    return alone(job, text(job.next(outcome)));
  }

  Script script;
};

std::size_t writes(const Scene& scene) {
  std::size_t count = 0;
  for (const can::Frame& frame : scene.sent) {
    const auto header = dronecan::decode_id(frame.id);
    // A read is one frame, a write three: the middle one is neither the first nor the last.
    const unsigned place = frame.data[frame.size - 1U] >> 6U;
    count += header && header->data_type_id == GetSet::type.id && place == 0 ? 1U : 0U;
  }
  return count;
}

constexpr const char* servo_11 = R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])";

} // namespace

TEST_CASE("a change is written and read again") {
  Scene scene(servo_11);
  scene.grow_old();
  WriteJob job(scene.roster(), scene.identify(11), {change("angle_limit_cw", 900, 1799)}, {});
  scene.sent.clear();
  scene.run(job);
  CHECK(job.changes()[0].status == ChangeStatus::written);
  CHECK(job.changes()[0].after == 900);
  CHECK_FALSE(job.changes()[0].error);
  CHECK(scene.sent.size() == 1 + 3 + 1 + 1); // who it is, and in the end whether it ran on
}

TEST_CASE("where all is read after a restart, an answer that shows the value suffices") {
  Scene scene(servo_11);
  scene.grow_old();
  WriteJob job(scene.roster(), scene.identify(11), {change("angle_limit_cw", 900, 1799)},
               {.echo = WriteJob::Echo::suffices});
  scene.sent.clear();
  scene.run(job);
  CHECK(job.changes()[0].status == ChangeStatus::written);
  CHECK(job.changes()[0].after == 900);
  CHECK(scene.sent.size() == 1 + 3 + 1);
  // One that shows another value, or none, does not.
  WriteJob refused(scene.roster(), scene.identify(11), {change("angle_p_gain", 1000, 40)},
                   {.echo = WriteJob::Echo::suffices});
  scene.sent.clear();
  scene.run(refused);
  CHECK(refused.changes()[0].status == ChangeStatus::failed);
  CHECK(refused.changes()[0].after == 40);
  CHECK(scene.sent.size() == 1 + 3 + 1 + 1);
}

TEST_CASE("a value that is held already is not sent") {
  Scene scene(servo_11);
  scene.grow_old();
  WriteJob job(scene.roster(), scene.identify(11),
               {change("angle_limit_cw", 1799, 1799), change("angle_limit_ccw", -900, -1799),
                change("reverse", 0, 0)},
               {});
  scene.sent.clear();
  scene.run(job);
  CHECK(job.changes()[0].status == ChangeStatus::unchanged);
  CHECK(job.changes()[1].status == ChangeStatus::written);
  CHECK(job.changes()[2].status == ChangeStatus::unchanged);
  CHECK(writes(scene) == 1);
  CHECK(scene.sent.size() == 1 + 3 + 3 + 1); // all three are read again
}

TEST_CASE("nothing to change writes nothing, and is proven all the same") {
  Scene scene(servo_11);
  scene.grow_old();
  const Servo servo = scene.identify(11);
  scene.sent.clear();
  WriteJob empty(scene.roster(), servo, {}, {});
  scene.run(empty);
  CHECK(scene.sent.empty());
  WriteJob unchanged(scene.roster(), servo, {change("reverse", 0, 0)}, {});
  scene.run(unchanged);
  CHECK(unchanged.changes()[0].status == ChangeStatus::unchanged);
  CHECK(scene.sent.size() == 1);
  CHECK(scene.requests(GetNodeInfo::type, 11) == 1);
}

TEST_CASE("what was held already is not called unchanged once the servo has restarted unheard") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 1)});
  CHECK(text(job.next(Script::start())) == "GetNodeInfo");
  CHECK(bench.young(job, 0) == "nothing");
  CHECK(job.changes()[0].status == ChangeStatus::failed);
  REQUIRE(job.changes()[0].error);
  CHECK(job.changes()[0].error->code == Code::state);
}

TEST_CASE("nothing is written to another unit that has come to the ID unheard") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0)});
  CHECK(text(job.next(Script::start())) == "GetNodeInfo");
  CHECK(text(job.next(bench.script.info(2))) == "nothing");
  CHECK(job.changes()[0].status == ChangeStatus::failed);
  REQUIRE(job.changes()[0].error);
  CHECK(job.changes()[0].error->code == Code::state);
}

TEST_CASE("nothing is written to a servo whose answer does not tell who it is") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0)});
  CHECK(text(job.next(Script::start())) == "GetNodeInfo");
  const std::vector<std::uint8_t> broken{1, 2, 3};
  CHECK(text(job.next({Outcome::Kind::answered, broken, {}})) == "nothing");
  CHECK_FALSE(job.has_written());
  REQUIRE(job.changes()[0].error);
  CHECK(job.changes()[0].error->code == Code::state);
}

TEST_CASE("a servo that keeps its old value refused") {
  Scene scene(servo_11); // refuses what is out of range
  WriteJob job(scene.roster(), scene.identify(11),
               {change("torque_limit_cw", 200, 100), change("reverse", 1, 0)}, {});
  scene.run(job);
  CHECK(job.changes()[0].status == ChangeStatus::failed);
  REQUIRE(job.changes()[0].error);
  CHECK(job.changes()[0].error->code == Code::refused);
  CHECK(job.changes()[0].error->node_id == 11);
  CHECK(job.changes()[0].after == 100);
  CHECK(job.changes()[1].status == ChangeStatus::written); // the others are written all the same
  CHECK(job.may_have_changed());
}

TEST_CASE("where all was refused nothing has changed") {
  Scene scene(servo_11);
  WriteJob job(scene.roster(), scene.identify(11), {change("torque_limit_cw", 200, 100)}, {});
  scene.run(job);
  CHECK(job.changes()[0].error->code == Code::refused);
  CHECK(job.has_written());
  CHECK_FALSE(job.may_have_changed());
}

TEST_CASE("where all that was sent was lost, and the rest is held back, nothing has changed") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("servo_id", 5, 0)});
  CHECK(bench.begin(job) == "write 0x23=1");
  CHECK(text(job.next(Script::timed_out())) == "read 0x23");
  CHECK(bench.value(job, "0x23", 0) == "GetNodeInfo");
  CHECK(bench.proven(job) == "write 0x23=1");
  arm(bench.roster, {});
  CHECK(text(job.next(Script::withheld())) == "nothing");
  CHECK(job.has_written());
  CHECK(job.changes()[0].error->code == Code::armed);
  CHECK(job.changes()[0].after == 0);
  CHECK(job.changes()[1].status == ChangeStatus::planned);
  CHECK_FALSE(job.may_have_changed());
}

TEST_CASE("a node ID that another node gives to another servo meanwhile is not written") {
  Bench bench;
  const auto other_gives = [&](std::uint8_t server, std::int64_t id) {
    dronecan::Transfer heard;
    heard.header = {.kind = dronecan::Kind::request,
                    .data_type_id = GetSet::type.id,
                    .source = NodeId(40),
                    .destination = NodeId(server)};
    heard.payload = GetSet::Request{.value = std::int64_t{id}, .name = "0x46"}.encode().bytes();
    heard.at = bench.servo.since + 1ms;
    bench.roster.receive(heard);
  };
  WriteJob job = bench.job({change("static_node_id", 20, 11)});
  const auto [server, id, is_written] =
      GENERATE(std::tuple(12, 20, false), std::tuple(12, 21, true));
  other_gives(static_cast<std::uint8_t>(server), id);
  const std::string said = bench.begin(job);
  if (is_written) {
    CHECK(said == "write 0x46=20");
  } else {
    CHECK(said == "nothing");
    REQUIRE(job.changes()[0].error);
    CHECK(job.changes()[0].error->code == Code::duplicate_node_id);
    CHECK_FALSE(job.has_written());
  }
}

TEST_CASE("a node ID under which another node is heard meanwhile is not written") {
  Bench bench;
  WriteJob job = bench.job({change("angle_limit_cw", 900, 450), change("static_node_id", 20, 11)});
  CHECK(bench.begin(job) == "write 0x38=900");
  const auto [id, is_written] =
      GENERATE(std::pair(std::uint8_t{20}, false), std::pair(std::uint8_t{21}, true));
  const auto status = message(dronecan::NodeStatus::type, id, dronecan::NodeStatus{}.encode());
  bench.roster.hear(status.front(), Time{500ms});
  CHECK((bench.value(job, "angle_limit_cw", 900) == "write 0x46=20") == is_written);
  if (!is_written) {
    REQUIRE(job.changes()[1].error);
    CHECK(job.changes()[1].error->code == Code::duplicate_node_id);
  }
}

TEST_CASE("a node ID that a unit meanwhile heard there has left again is written") {
  Bench bench;
  WriteJob job = bench.job({change("angle_limit_cw", 900, 450), change("static_node_id", 20, 11)});
  CHECK(bench.begin(job) == "write 0x38=900");
  const auto status = message(dronecan::NodeStatus::type, 20, dronecan::NodeStatus{}.encode());
  bench.roster.hear(status.front(), Time{500ms});
  bench.roster.learn(NodeId(20), {.unique_id = {7}}, Time{500ms});
  bench.roster.learn(NodeId(21), {.unique_id = {7}}, Time{2s}); // it has just started
  CHECK(bench.value(job, "angle_limit_cw", 900) == "write 0x46=20");
}

TEST_CASE("a node ID that an allocator gives to another unit meanwhile is not written") {
  Bench bench;
  const auto [unit, is_written] = GENERATE(std::pair(std::uint8_t{13}, false), // another's
                                           std::pair(std::uint8_t{1}, true));  // its own
  const dronecan::Allocation given{.node_id = 20, .size = 16, .unique_id = {unit}};
  const auto payload = given.encode();
  bench.roster.receive({.header = {.kind = dronecan::Kind::message,
                                   .data_type_id = dronecan::Allocation::type.id,
                                   .source = NodeId(40)},
                        .payload = payload.bytes(),
                        .at = bench.servo.since + 1ms});
  WriteJob job = bench.job({change("static_node_id", 20, 11)});
  CHECK((bench.begin(job) == "write 0x46=20") == is_written);
  if (!is_written) {
    REQUIRE(job.changes()[0].error);
    CHECK(job.changes()[0].error->code == Code::duplicate_node_id);
  }
}

TEST_CASE("a value is not written once another node has changed what it was judged by") {
  Bench bench;
  WriteJob job(bench.roster, bench.servo,
               {change("smoothing", 0, 1), change("pwm_output_range", 600, 700)},
               {.premises = {{change("pwm_mode", 0, 0).parameter, 0}}});
  CHECK(bench.begin(job) == "write 0x22=0");
  const dronecan::Step second = job.next(bench.script.value("0x22", std::int64_t{0}));
  CHECK(text(second) == "write 0x36=600");
  REQUIRE(second.request());
  const auto [name, is_premise] =
      GENERATE(std::pair("0x37", true), std::pair("0x27", false)); // no other setting matters
  dronecan::Transfer heard;
  heard.header = {.kind = dronecan::Kind::request,
                  .data_type_id = GetSet::type.id,
                  .source = NodeId(40),
                  .destination = bench.servo.id};
  const auto payload = GetSet::Request{.value = std::int64_t{1}, .name = name}.encode();
  heard.payload = payload.bytes();
  heard.at = bench.servo.since + 1ms;
  bench.roster.receive(heard);
  CHECK(second.request()->may_leave({}) == !is_premise);
  if (is_premise) {
    CHECK(text(job.next(Script::withheld())) == "read 0x22");
    CHECK(bench.value(job, "0x22", 0) == "GetNodeInfo");
    CHECK(bench.proven(job) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::written);
    CHECK(job.changes()[1].status == ChangeStatus::failed);
    REQUIRE(job.changes()[1].error);
    CHECK(job.changes()[1].error->code == Code::state);
  }
}

TEST_CASE("a servo that holds another value than was written is a mismatch", "[requirement-73]") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
                             "ram": {"torque_limit_cw": "50%"},
                             "behaviour": {"out_of_range": "clamp"}}])");
  WriteJob job(scene.roster(), scene.identify(11), {change("torque_limit_cw", 200, 50)}, {});
  scene.run(job);
  CHECK(job.changes()[0].status == ChangeStatus::mismatch);
  REQUIRE(job.changes()[0].error);
  CHECK(job.changes()[0].error->code == Code::mismatch);
  CHECK(job.changes()[0].after == 100);
}

TEST_CASE("a lost answer to a write is no failure: the register tells") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0)});
  CHECK(bench.begin(job) == "write 0x23=1");
  CHECK(text(job.next(Script::timed_out())) == "read 0x23");
  SECTION("it was written") {
    CHECK(bench.value(job, "0x23", 1) == "GetNodeInfo");
    CHECK(bench.proven(job) == "read 0x23");
    CHECK(bench.value(job, "0x23", 1) == "GetNodeInfo");
    CHECK(bench.proven(job) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::written);
  }
  SECTION("it was not: whether the servo refused it, or never had it, is not known") {
    for (int tries = Patience{}.retries; tries >= 0; --tries) {
      CHECK(bench.value(job, "0x23", 0) == "GetNodeInfo");
      CHECK(bench.proven(job) == (tries > 0 ? "write 0x23=1" : "nothing"));
      if (tries > 0) {
        CHECK(text(job.next(Script::timed_out())) == "read 0x23");
      }
    }
    CHECK(job.changes()[0].status == ChangeStatus::failed);
    CHECK(job.changes()[0].error->code == Code::timeout);
    CHECK(job.changes()[0].after == 0);
  }
  SECTION("it holds neither the one nor the other value") {
    CHECK(bench.value(job, "0x23", 2) == "GetNodeInfo");
    CHECK(bench.proven(job) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::mismatch);
    CHECK(job.changes()[0].error->code == Code::mismatch);
  }
  SECTION("it is mute") {
    CHECK(text(job.next(Script::timed_out())) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::failed);
    CHECK(job.changes()[0].error->code == Code::timeout);
    CHECK_FALSE(job.changes()[0].after);
  }
}

TEST_CASE("an answer that echoes the value proves nothing by itself") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0)});
  std::ignore = bench.begin(job);
  CHECK(text(job.next(bench.script.value("0x23", std::int64_t{1}))) == "read 0x23");
  CHECK(bench.value(job, "0x23", 0) == "GetNodeInfo"); // or it has restarted
  CHECK(bench.proven(job) == "nothing");
  CHECK(job.changes()[0].error->code == Code::refused);
}

TEST_CASE("a write that never left is given up, and nothing behind it is tried") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("servo_id", 5, 0)});
  std::ignore = bench.begin(job);
  const auto [outcome, code] = GENERATE(std::pair(Outcome::Kind::cancelled, Code::interrupted),
                                        std::pair(Outcome::Kind::not_sent, Code::no_acknowledge));
  CHECK(text(job.next({outcome, {}, {}})) == "nothing");
  CHECK(job.changes()[0].status == ChangeStatus::failed);
  CHECK(job.changes()[0].error->code == code);
  CHECK(job.changes()[1].status == ChangeStatus::planned);
}

TEST_CASE("what a later write changes of an earlier one is seen") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("smoothing", 0, 1)});
  CHECK(bench.begin(job) == "write 0x23=1");
  CHECK(bench.value(job, "0x23", 1) == "write 0x22=0");
  CHECK(bench.value(job, "0x22", 0) == "read 0x23");
  CHECK(bench.value(job, "0x23", 0) == "GetNodeInfo");
  CHECK(bench.proven(job) == "read 0x22");
  CHECK(bench.value(job, "0x22", 0) == "GetNodeInfo");
  CHECK(bench.proven(job) == "nothing");
  CHECK(job.changes()[0].error->code == Code::refused);
  CHECK(job.changes()[0].after == 0);
  CHECK(job.changes()[1].status == ChangeStatus::written);
}

TEST_CASE("what a write changes of a value that was held already is written after it") {
  Bench bench;
  WriteJob job = bench.job({change("pwm_output_range", 70, 70), change("pwm_mode", 1, 0)});
  CHECK(bench.begin(job) == "write 0x37=1");
  CHECK(bench.value(job, "0x37", 1) == "read 0x36");
  CHECK(bench.value(job, "0x36", 300) == "GetNodeInfo");
  CHECK(bench.proven(job) == "write 0x36=70");
  SECTION("and looked at like the others") {
    CHECK(bench.value(job, "0x36", 70) == "read 0x36");
    CHECK(bench.value(job, "0x36", 70) == "read 0x37");
    CHECK(bench.value(job, "0x37", 1) == "GetNodeInfo");
    CHECK(bench.proven(job) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::written);
    CHECK(job.changes()[1].status == ChangeStatus::written);
  }
  SECTION("once: then the two do not go together") {
    CHECK(bench.value(job, "0x36", 300) == "read 0x36");
    CHECK(bench.value(job, "0x36", 300) == "GetNodeInfo");
    CHECK(bench.proven(job) == "read 0x37");
    CHECK(bench.value(job, "0x37", 1) == "GetNodeInfo");
    CHECK(bench.proven(job) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::mismatch);
    CHECK(job.changes()[0].after == 300);
    CHECK(job.changes()[1].status == ChangeStatus::written);
  }
}

TEST_CASE("armed in the middle: nothing more is written, and what was written is proven") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("servo_id", 5, 0)});
  CHECK(bench.begin(job) == "write 0x23=1");
  const dronecan::Step second = job.next(bench.script.value("0x23", std::int64_t{1}));
  CHECK(text(second) == "write 0x45=5");
  REQUIRE(second.request()->may_leave);
  CHECK(second.request()->may_leave({}));
  arm(bench.roster, {});
  CHECK_FALSE(second.request()->may_leave({}));
  CHECK(text(job.next(Script::withheld())) == "read 0x23");
  CHECK(bench.value(job, "0x23", 1) == "GetNodeInfo");
  CHECK(bench.proven(job) == "nothing");
  CHECK(job.has_written());
  CHECK(job.changes()[0].status == ChangeStatus::written);
  CHECK(job.changes()[0].after == 1);
  CHECK(job.changes()[1].status == ChangeStatus::failed);
  CHECK(job.changes()[1].error->code == Code::armed);
}

TEST_CASE("a write is not repeated to whoever has started on that node ID since") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0)});
  CHECK(text(job.next(Script::start())) == "GetNodeInfo");
  const dronecan::Step step = job.next(bench.script.info(1));
  CHECK(text(step) == "write 0x23=1");
  REQUIRE(step.request());
  CHECK(step.request()->may_leave({}));
  bench.restart();
  CHECK_FALSE(step.request()->may_leave({}));
  CHECK(text(job.next(Script::withheld())) == "GetNodeInfo"); // who is there?
}

TEST_CASE("armed before the first write: nothing was written") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0)});
  std::ignore = bench.begin(job);
  arm(bench.roster, {});
  CHECK(text(job.next(Script::withheld())) == "nothing");
  CHECK_FALSE(job.has_written());
  CHECK(job.changes()[0].error->code == Code::armed);
}

TEST_CASE("a job that is cancelled while it reads back says so") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("servo_id", 5, 0)});
  std::ignore = bench.begin(job);
  CHECK(bench.value(job, "0x23", 1) == "write 0x45=5");
  CHECK(bench.value(job, "0x45", 5) == "read 0x23");
  CHECK(text(job.next(Script::cancelled())) == "nothing");
  CHECK(job.changes()[0].error->code == Code::interrupted);
  CHECK(job.changes()[1].status == ChangeStatus::failed);
}

TEST_CASE("after a restart nothing is written before the unique ID was asked again") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0)});
  bench.restart();
  CHECK(text(job.next(Script::start())) == "GetNodeInfo");
  SECTION("the same servo is written to") {
    CHECK(text(job.next(bench.script.info(1))) == "GetNodeInfo");
    CHECK(text(job.next(bench.script.info(1))) == "write 0x23=1");
  }
  SECTION("another servo is not") {
    CHECK(text(job.next(bench.script.info(2))) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::failed);
    CHECK(job.changes()[0].error->code == Code::state);
  }
  SECTION("nor one that does not answer") {
    CHECK(text(job.next(Script::timed_out())) == "nothing");
    CHECK(job.changes()[0].error->code == Code::timeout);
  }
}

TEST_CASE("another servo in the place of the first one gets none of the values") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("servo_id", 5, 0)});
  std::ignore = bench.begin(job);
  bench.restart();
  CHECK(text(job.next(bench.script.value("0x23", std::int64_t{1}))) == "GetNodeInfo");
  CHECK(text(job.next(bench.script.info(2))) == "nothing");
  CHECK(job.changes()[0].status == ChangeStatus::failed); // lost with the servo that had it
  CHECK(job.changes()[0].error->code == Code::state);
  CHECK(job.changes()[1].status == ChangeStatus::planned);
}

TEST_CASE("what a restart took from the RAM is written again") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("servo_id", 5, 0)});
  CHECK(bench.begin(job) == "write 0x23=1");
  bench.restart();
  CHECK(bench.value(job, "0x23", 1) == "GetNodeInfo");
  CHECK(text(job.next(bench.script.info(1))) == "write 0x23=1");
  CHECK(bench.value(job, "0x23", 1) == "write 0x45=5");
  CHECK(bench.value(job, "0x45", 5) == "read 0x23");
  CHECK(bench.value(job, "0x23", 1) == "read 0x45");
  CHECK(bench.value(job, "0x45", 5) == "GetNodeInfo");
  CHECK(bench.proven(job) == "nothing");
  CHECK(job.changes()[0].status == ChangeStatus::written);
  CHECK(job.changes()[1].status == ChangeStatus::written);
}

TEST_CASE("what a servo held when it refused a value is not told of it after a restart") {
  Bench bench;
  WriteJob job = bench.job({change("angle_limit_cw", 900, 1799), change("reverse", 1, 0)});
  CHECK(bench.begin(job) == "write 0x38=900");
  CHECK(bench.value(job, "0x38", 1799) == "read 0x38");
  CHECK(bench.value(job, "0x38", 1799) == "GetNodeInfo");
  CHECK(bench.proven(job) == "write 0x23=1");
  CHECK(job.changes()[0].error->code == Code::refused);
  bench.restart();
  CHECK(bench.value(job, "0x23", 1) == "GetNodeInfo");
  CHECK(text(job.next(bench.script.info(1))) == "write 0x38=900");
  CHECK(bench.value(job, "0x38", 1500) == "read 0x38");
  CHECK(bench.value(job, "0x38", 1500) == "GetNodeInfo");
  CHECK(bench.proven(job) == "write 0x23=1");
  CHECK(job.changes()[0].after == 1500);
}

TEST_CASE("nothing is written again where the restart has brought other settings back") {
  Bench bench;
  WriteJob job(bench.roster, bench.servo, {change("pwm_output_range", 900, 700)},
               {.premises = {{change("pwm_mode", 0, 0).parameter, 0}}});
  CHECK(bench.begin(job) == "write 0x36=900");
  bench.restart();
  CHECK(text(job.next(Script::timed_out())) == "read 0x36");
  CHECK(text(job.next(bench.script.value("0x36", std::int64_t{150}))) == "GetNodeInfo");
  CHECK(text(job.next(bench.script.info(1))) == "read 0x37");
  SECTION("they are as they were") {
    CHECK(text(job.next(bench.script.value("0x37", std::int64_t{0}))) == "write 0x36=900");
  }
  SECTION("they are not") {
    CHECK(text(job.next(bench.script.value("0x37", std::int64_t{1}))) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::failed);
    CHECK(job.changes()[0].error->code == Code::state);
  }
  SECTION("nobody knows") {
    CHECK(text(job.next(Script::timed_out())) == "nothing");
    CHECK(job.changes()[0].error->code == Code::timeout);
  }
}

TEST_CASE("a write that was lost is sent again once the servo is known to have run on") {
  Bench bench;
  WriteJob job(bench.roster, bench.servo, {change("command_angle", 900, 0)},
               {.premises = {{change("timeout_action", 1, 1).parameter, 1}}});
  CHECK(bench.begin(job) == "write 0x00=900");
  CHECK(text(job.next(Script::timed_out())) == "read 0x00");
  SECTION("it has not taken it") {
    CHECK(text(job.next(bench.script.value("0x00", std::int64_t{0}))) == "GetNodeInfo");
    CHECK(bench.proven(job) == "write 0x00=900");
  }
  SECTION("it has") {
    CHECK(bench.value(job, "0x00", 900) == "GetNodeInfo");
    CHECK(bench.proven(job) == "read 0x00");
    CHECK(bench.value(job, "0x00", 900) == "GetNodeInfo");
    CHECK(bench.proven(job) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::written);
  }
  SECTION("it has restarted, and may hold other settings now") {
    bench.restart();
    CHECK(text(job.next(bench.script.value("0x00", std::int64_t{0}))) == "GetNodeInfo");
    CHECK(text(job.next(bench.script.info(1))) == "read 0x26");
  }
}

TEST_CASE("each change has its own tries") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("smoothing", 0, 1)});
  std::string said = bench.begin(job);
  std::vector<std::string> writes;
  while (said.starts_with("write")) { // none of them arrives
    writes.push_back(said.substr(0, 10));
    CHECK(text(job.next(Script::timed_out())).starts_with("read"));
    const bool is_first = said.starts_with("write 0x23");
    CHECK(bench.value(job, is_first ? "0x23" : "0x22", is_first ? 0 : 1) == "GetNodeInfo");
    said = bench.proven(job);
  }
  const std::string one = "write 0x23", other = "write 0x22";
  CHECK(writes == std::vector{one, one, one, other, other, other});
}

TEST_CASE("equal values that a restart has changed are not told as unchanged") {
  Bench bench;
  const RegisterChange mode = change("pwm_mode", 0, 0), torque = change("torque_output", 0, 0);
  WriteJob job(bench.roster, bench.servo, {torque, mode, change("pwm_output_range", 900, 700)},
               {.premises = {{torque.parameter, 0}, {mode.parameter, 0}}});
  CHECK(bench.begin(job) == "write 0x36=900");
  bench.restart();
  CHECK(text(job.next(Script::timed_out())) == "read 0x36");
  CHECK(text(job.next(bench.script.value("0x36", std::int64_t{150}))) == "GetNodeInfo");
  CHECK(text(job.next(bench.script.info(1))) == "read 0x20");
  SECTION("one of them") {
    CHECK(text(job.next(bench.script.value("0x20", std::int64_t{0}))) == "read 0x37");
    CHECK(text(job.next(bench.script.value("0x37", std::int64_t{1}))) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::unchanged);
    CHECK(job.changes()[1].status == ChangeStatus::mismatch);
    CHECK(job.changes()[1].after == 1);
  }
  SECTION("those that were not read since are in doubt") {
    CHECK(text(job.next(Script::timed_out())) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::failed);
    CHECK(job.changes()[1].status == ChangeStatus::failed);
    CHECK_FALSE(job.changes()[1].after);
  }
}

TEST_CASE(
    "what a register held instead of its new value is not told once a restart has replaced it") {
  Bench bench;
  const RegisterChange mode = change("pwm_mode", 0, 0);
  WriteJob job(bench.roster, bench.servo, {change("reverse", 1, 0), mode},
               {.premises = {{mode.parameter, 0}}});
  CHECK(bench.begin(job) == "write 0x23=1");
  CHECK(bench.value(job, "0x23", 2) == "read 0x23");
  CHECK(bench.value(job, "0x23", 2) == "GetNodeInfo");
  CHECK(bench.proven(job) == "read 0x37");
  CHECK(job.changes()[0].status == ChangeStatus::mismatch);
  CHECK(bench.value(job, "0x37", 0) == "GetNodeInfo");
  bench.restart();
  CHECK(text(job.next(bench.script.info(1))) == "read 0x37");
  CHECK(bench.value(job, "0x37", 1) == "nothing");
  CHECK(job.changes()[0].status == ChangeStatus::failed);
  CHECK_FALSE(job.changes()[0].after);
  CHECK(job.changes()[0].error->code == Code::state);
  CHECK(job.changes()[1].after == 1);
}

TEST_CASE("where all was equal, and a restart has changed it, that is an error") {
  Bench bench;
  const RegisterChange torque = change("torque_output", 1, 1);
  WriteJob job(bench.roster, bench.servo, {torque, change("angle_p_gain", 30, 30)},
               {.premises = {{torque.parameter, 1}}});
  CHECK(text(job.next(Script::start())) == "GetNodeInfo");
  bench.restart();
  CHECK(text(job.next(bench.script.info(1))) == "read 0x20");
  const auto [told, status] =
      GENERATE(std::pair(0, ChangeStatus::mismatch), std::pair(-1, ChangeStatus::failed));
  CHECK(text(job.next(told < 0 ? Script::timed_out() : bench.script.value("0x20", told))) ==
        "nothing");
  CHECK(job.changes()[0].status == status);
  CHECK(job.changes()[1].status == ChangeStatus::failed);
  REQUIRE(job.changes()[0].error);
  CHECK(job.changes()[0].error->code == (told < 0 ? Code::timeout : Code::state));
}

TEST_CASE("no write repeats itself") {
  Bench bench;
  WriteJob job = bench.job({change("smoothing", 1, 0)});
  std::ignore = job.next(Script::start());
  const dronecan::Step step = job.next(bench.script.info(1));
  REQUIRE(step.request() != nullptr);
  CHECK(step.request()->retries == 0);
}

TEST_CASE("a servo that restarted behind the last write is written to again") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0)});
  std::ignore = bench.begin(job);
  std::ignore = job.next(bench.script.value("0x23", std::int64_t{1}));
  bench.restart(); // whether before or after the answer was sent nobody knows
  CHECK(text(job.next(bench.script.value("0x23", std::int64_t{1}))) == "GetNodeInfo");
  SECTION("if it answers") {
    CHECK(text(job.next(bench.script.info(1))) == "write 0x23=1");
  }
  SECTION("or counts as failed") {
    CHECK(text(job.next(Script::timed_out())) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::failed);
    CHECK(job.changes()[0].error->code == Code::timeout);
  }
}

TEST_CASE("what was equal before a restart is not called unchanged after it") {
  Bench bench;
  RegisterChange equal = change("reverse", 1, 1);
  equal.status = ChangeStatus::unchanged;
  WriteJob job = bench.job({equal});
  bench.restart();
  CHECK(text(job.next(Script::start())) == "GetNodeInfo");
  SECTION("the same servo may hold another value") {
    CHECK(text(job.next(bench.script.info(1))) == "nothing");
    CHECK(job.changes()[0].error->code == Code::state);
  }
  SECTION("and so may one that does not answer") {
    CHECK(text(job.next(Script::timed_out())) == "nothing");
    CHECK(job.changes()[0].error->code == Code::timeout);
  }
  CHECK(job.changes()[0].status == ChangeStatus::failed);
  CHECK_FALSE(job.changes()[0].after);
}

TEST_CASE("a servo that restarts with every write is given up") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("servo_id", 5, 0)});
  std::string question = bench.begin(job);
  int written = 0;
  while (question != "nothing") {
    REQUIRE(written < 10);
    if (question == "GetNodeInfo") {
      question = text(job.next(bench.script.info(1)));
    } else {
      const bool is_write = question.starts_with("write");
      written += is_write ? 1 : 0;
      if (is_write) {
        bench.restart();
      }
      question = text(job.next(bench.script.value("0x23", std::int64_t{1})));
    }
  }
  CHECK(written == 3);
  CHECK(job.changes()[0].status == ChangeStatus::failed);
  CHECK(job.changes()[0].error->code == Code::state);
  CHECK(job.changes()[1].status == ChangeStatus::planned);
}

TEST_CASE("the value that is read back is narrowed to the width of its register",
          "[requirement-76]") {
  Bench bench;
  WriteJob job = bench.job({change("angle_limit_ccw", -900, -1799)});
  CHECK(bench.begin(job) == "write 0x39=-900");
  std::ignore = job.next(bench.script.value("0x39", std::int64_t{-900}));
  CHECK(bench.value(job, "0x39", 0xFFFF'FC7C) == "GetNodeInfo");
  CHECK(bench.proven(job) == "nothing");
  CHECK(job.changes()[0].status == ChangeStatus::written);
  CHECK(job.changes()[0].after == -900);
}

TEST_CASE("a register whose value was not known before and is another one now is a mismatch") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, std::nullopt)});
  std::ignore = bench.begin(job);
  std::ignore = job.next(bench.script.value("0x23", std::int64_t{0}));
  CHECK(bench.value(job, "0x23", 0) == "GetNodeInfo");
  CHECK(bench.proven(job) == "nothing");
  CHECK(job.changes()[0].error->code == Code::mismatch);
}

TEST_CASE("nothing is called written before the servo has told that it ran on") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("servo_id", 5, 0)});
  CHECK(bench.begin(job) == "write 0x23=1");
  CHECK(bench.value(job, "0x23", 1) == "write 0x45=5");
  CHECK(bench.value(job, "0x45", 5) == "read 0x23");
  CHECK(bench.value(job, "0x23", 1) == "read 0x45");
  CHECK(bench.value(job, "0x45", 5) == "GetNodeInfo");
  const auto none_written = [&](Code code) {
    for (const RegisterChange& each : job.changes()) {
      CHECK(each.status == ChangeStatus::failed);
      CHECK_FALSE(each.after);
    }
    REQUIRE(job.changes()[0].error);
    CHECK(job.changes()[0].error->code == code);
    CHECK(job.changes()[0].error->node_id == 11);
  };
  SECTION("it did") {
    CHECK(bench.proven(job) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::written);
    CHECK(job.changes()[1].status == ChangeStatus::written);
  }
  SECTION("it does not answer any more") {
    CHECK(text(job.next(Script::timed_out())) == "nothing");
    none_written(Code::timeout);
  }
  SECTION("the question does not leave") {
    CHECK(text(job.next(Script::not_sent())) == "nothing");
    none_written(Code::no_acknowledge);
  }
  SECTION("it is left alone") {
    CHECK(text(job.next(Script::cancelled())) == "nothing");
    none_written(Code::interrupted);
  }
  SECTION("another unit answers") {
    CHECK(text(job.next(bench.script.info(2))) == "nothing");
    none_written(Code::state);
  }
  SECTION("two units are on its ID") {
    bench.roster.mark_doubled(NodeId(11), {1}, {2});
    CHECK(bench.proven(job) == "nothing");
    none_written(Code::duplicate_node_id);
  }
  SECTION("it restarted") {
    bench.restart();
    CHECK(bench.proven(job) == "write 0x23=1");
  }
}

TEST_CASE("a servo that has only just started is asked again when its uptime tells") {
  Bench bench;
  WriteJob job = bench.job(
      {change("reverse", 1, 0), change("angle_limit_cw", 900, 900), change("servo_id", 5, 0)});
  CHECK(bench.begin(job) == "write 0x23=1");
  CHECK(bench.value(job, "0x23", 1) == "write 0x45=5");
  CHECK(bench.value(job, "0x45", 5) == "read 0x23");
  CHECK(bench.value(job, "0x23", 1) == "read 0x38");
  CHECK(bench.value(job, "0x38", 900) == "read 0x45");
  CHECK(bench.value(job, "0x45", 5) == "GetNodeInfo");
  SECTION("it ran on") {
    CHECK(bench.young(job, 1) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::written);
    CHECK(job.changes()[1].status == ChangeStatus::unchanged);
    CHECK(job.changes()[2].status == ChangeStatus::written);
  }
  SECTION("it restarted: what was written is written again, what was equal may be equal no more") {
    CHECK(bench.young(job, 0) == "write 0x23=1");
    CHECK(job.changes()[1].status == ChangeStatus::failed);
    CHECK(job.changes()[1].error->code == Code::state);
  }
  SECTION("a restart is heard meanwhile") {
    CHECK(text(job.next(bench.script.young_info(1))) == "pause");
    bench.restart();
    CHECK(text(job.next({Outcome::Kind::woken, {}, {}})) == "GetNodeInfo");
    CHECK(text(job.next(bench.script.young_info(1))) == "write 0x23=1");
  }
  SECTION("a twin shows meanwhile") {
    CHECK(text(job.next(bench.script.young_info(1))) == "pause");
    bench.roster.mark_doubled(NodeId(11), {1}, {2});
    CHECK(text(job.next({Outcome::Kind::woken, {}, {}})) == "GetNodeInfo");
    CHECK(text(job.next(bench.script.young_info(1))) == "nothing");
    CHECK(job.changes()[0].error->code == Code::duplicate_node_id);
  }
  SECTION("its answers are always too late") {
    for (std::uint32_t second = 0; second < 8; ++second) {
      Outcome outcome = bench.script.info(1, second);
      outcome.at = Time{second * 1s + 900ms};
      outcome.asked = outcome.at - 10ms;
      CHECK(text(job.next(outcome)) == (second < 7 ? "pause" : "nothing"));
      if (second < 7) {
        CHECK(text(job.next({Outcome::Kind::woken, {}, {}})) == "GetNodeInfo");
      }
    }
    for (const RegisterChange& each : job.changes()) {
      CHECK((each.status == ChangeStatus::failed || each.status == ChangeStatus::unchanged));
    }
    CHECK(job.changes()[0].error->code == Code::state);
  }
}

TEST_CASE("a refusal is believed if the servo ran on") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("servo_id", 5, 0)});
  CHECK(bench.begin(job) == "write 0x23=1");
  CHECK(bench.value(job, "0x23", 0) == "read 0x23");
  CHECK(bench.value(job, "0x23", 0) == "GetNodeInfo");
  SECTION("it ran on: the others are written all the same") {
    CHECK(bench.proven(job) == "write 0x45=5");
    CHECK(job.changes()[0].error->code == Code::refused);
  }
  SECTION("it has restarted, and takes the value now") {
    CHECK(bench.young(job, 0) == "write 0x23=1");
    CHECK(bench.value(job, "0x23", 0) == "read 0x23");
    CHECK(bench.value(job, "0x23", 1) == "write 0x45=5");
    CHECK(job.changes()[0].status == ChangeStatus::written);
  }
  SECTION("it does not answer any more") {
    CHECK(text(job.next(Script::timed_out())) == "nothing");
    CHECK(job.changes()[0].status == ChangeStatus::failed);
    CHECK(job.changes()[0].error->code == Code::timeout);
    CHECK(job.changes()[1].status == ChangeStatus::planned);
  }
}

TEST_CASE("an end in between leaves nothing that is called written") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("servo_id", 5, 0)});
  CHECK(bench.begin(job) == "write 0x23=1");
  CHECK(bench.value(job, "0x23", 1) == "write 0x45=5");
  const bool reads_back = GENERATE(false, true);
  if (reads_back) {
    CHECK(bench.value(job, "0x45", 5) == "read 0x23");
  }
  CHECK(text(job.next(Script::cancelled())) == "nothing");
  CHECK(job.changes()[0].status == ChangeStatus::failed);
  CHECK_FALSE(job.changes()[0].after);
  CHECK(job.changes()[1].status == ChangeStatus::failed);
  CHECK(job.changes()[reads_back ? 0 : 1].error->code == Code::interrupted);
}

TEST_CASE("where no frame leaves any more, or all is to end, nothing more is asked or written") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("servo_id", 5, 0)});
  const bool is_sent = GENERATE(false, true); // the question that ends it
  const Outcome end = is_sent ? Script::cancelled() : Script::not_sent();
  const Code code = is_sent ? Code::interrupted : Code::no_acknowledge;
  CHECK(bench.begin(job) == "write 0x23=1");
  SECTION("as it is read what became of a write without an answer") {
    CHECK(text(job.next(Script::timed_out())) == "read 0x23");
    CHECK(text(job.next(end)) == "nothing");
    CHECK(job.changes()[1].status == ChangeStatus::planned);
  }
  SECTION("as it is read once more in the end") {
    CHECK(bench.value(job, "0x23", 1) == "write 0x45=5");
    CHECK(bench.value(job, "0x45", 5) == "read 0x23");
    CHECK(text(job.next(end)) == "nothing");
    CHECK(job.changes()[1].status == ChangeStatus::failed);
  }
  CHECK(job.changes()[0].status == ChangeStatus::failed);
  CHECK_FALSE(job.changes()[0].after);
  REQUIRE(job.changes()[0].error);
  CHECK(job.changes()[0].error->code == code);
}

TEST_CASE("nothing is written to two units, and an error that was told before stays") {
  Bench bench;
  WriteJob job = bench.job({change("reverse", 1, 0), change("servo_id", 5, 0)});
  SECTION("they were known before") {
    bench.roster.mark_doubled(NodeId(11), {1}, {2});
    CHECK(text(job.next(Script::start())) == "nothing");
    CHECK(job.changes()[0].error->code == Code::duplicate_node_id);
    CHECK(job.changes()[1].status == ChangeStatus::planned);
  }
  SECTION("they show in between") {
    CHECK(bench.begin(job) == "write 0x23=1");
    CHECK(text(job.next(Script::timed_out())) == "read 0x23");
    bench.roster.mark_doubled(NodeId(11), {1}, {2});
    CHECK(text(job.next(Script::timed_out())) == "nothing");
    CHECK(job.changes()[0].error->code == Code::timeout);
    CHECK(job.changes()[1].error->code == Code::duplicate_node_id);
  }
  SECTION("nothing is to be written") {
    WriteJob empty = bench.job({});
    bench.roster.mark_doubled(NodeId(11), {1}, {2});
    CHECK(text(empty.next(Script::start())) == "nothing");
  }
}

TEST_CASE("a second unit that answers the last question too is heard") {
  Bench bench;
  WriteJob job = bench.job({change("angle_limit_cw", 900, 1799)});
  CHECK(bench.begin(job) == "write 0x38=900");
  CHECK(bench.value(job, "0x38", 900) == "read 0x38");
  CHECK(bench.value(job, "0x38", 900) == "GetNodeInfo");
  const dronecan::Step step = job.next(bench.script.info(1));
  REQUIRE(step.pause() != nullptr);
  CHECK_FALSE(step.pause()->ready());
  bench.roster.mark_doubled(NodeId(11), {1}, {2});
  CHECK(step.pause()->ready());
  CHECK(text(job.next({Outcome::Kind::woken, {}, {}})) == "nothing");
  CHECK(job.changes()[0].status == ChangeStatus::failed);
  REQUIRE(job.changes()[0].error);
  CHECK(job.changes()[0].error->code == Code::duplicate_node_id);
}

TEST_CASE("the states of a change are called as scripts read them") {
  CHECK(name(ChangeStatus::planned) == "planned");
  CHECK(name(ChangeStatus::unchanged) == "unchanged");
  CHECK(name(ChangeStatus::written) == "written");
  CHECK(name(ChangeStatus::failed) == "failed");
  CHECK(name(ChangeStatus::mismatch) == "mismatch");
}
