#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/erase_job.hpp"
#include "blactl/fleet/change/guard.hpp"
#include "blactl/fleet/change/save_restart_job.hpp"

#include "support.hpp"

#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
namespace at = bla::address;

namespace {

/// A servo on a bus that was heard for as long as writers hear it.
class Watched {
 public:
  explicit Watched(std::string_view others = "")
      : scene(fmt::format(
                  R"("servos": [{{"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 3}}]{})",
                  others),
              Session::Hearing::commands),
        servo(scene.identify(11)) {
    scene.live(1100ms);
  }

  [[nodiscard]] std::optional<Error> forbids(const Plan& plan, bool while_driven = false) const {
    return forbidden(scene.roster(), scene.session->now(), plan, while_driven);
  }

  [[nodiscard]] std::optional<Error> forbids(const char* assignment,
                                             bool while_driven = false) const {
    return forbids(plan({.assignments = assignments({assignment})}), while_driven);
  }

  [[nodiscard]] Plan plan(const Wanted& wanted, const bla::Values& held = {}) const {
    return plan_for(wanted, held, servo);
  }

  Scene scene;
  Servo servo;
};

constexpr const char* armed_node =
    R"(, "foreign": [{"kind": "node", "node_id": 30, "armed": true}])";
constexpr const char* driving_node =
    R"(, "foreign": [{"kind": "node", "node_id": 30, "commands": {"servo_ids": [3]}}])";

const Wanted restart{.restart = RestartKind::restart};
const Wanted erase{.erase = true};

} // namespace

TEST_CASE("on a quiet bus nothing is forbidden") {
  const Watched bus;
  CHECK_FALSE(bus.forbids("torque_output=off"));
  CHECK_FALSE(bus.forbids("static_node_id=20"));
  CHECK_FALSE(bus.forbids(bus.plan(restart)));
  CHECK_FALSE(bus.forbids(bus.plan(erase)));
}

TEST_CASE("while the vehicle is armed nothing is written, whatever the options") {
  const Watched bus(armed_node);
  const auto error = bus.forbids("smoothing=off", true);
  REQUIRE(error);
  CHECK(error->code == Code::armed);
  CHECK(error->node_id == 11);
  CHECK(error->message.find("30") != std::string::npos);
  CHECK(bus.forbids(bus.plan(restart), true)->code == Code::armed);
  CHECK(bus.forbids(bus.plan(erase), true)->code == Code::armed);
}

TEST_CASE("a plan that does nothing is not forbidden by anybody") {
  const Watched bus(armed_node);
  const Wanted wanted{.assignments = assignments({"reverse=on"})};
  CHECK_FALSE(bus.forbids(bus.plan(wanted, {{at::reverse, 1}})));
}

TEST_CASE("while another node drives the servo it is not moved, unless that is wanted") {
  const Watched bus(driving_node);
  const auto error = bus.forbids("torque_output=off");
  REQUIRE(error);
  CHECK(error->code == Code::driven);
  CHECK(error->node_id == 11);
  CHECK_FALSE(bus.forbids("torque_output=off", true));
  CHECK_FALSE(bus.forbids("smoothing=off")); // moves nothing
  for (const Wanted& wanted : {restart, erase, Wanted{.restart = RestartKind::save}}) {
    CHECK(bus.forbids(bus.plan(wanted))->code == Code::driven);
    CHECK_FALSE(bus.forbids(bus.plan(wanted), true));
  }
}

TEST_CASE("no servo gets a servo ID that another node commands") {
  const Watched bus(R"(, "foreign": [{"kind": "node", "node_id": 30,
                                      "commands": {"servo_ids": [0, 7]}}])");
  CHECK_FALSE(bus.forbids("servo_id=5"));
  CHECK(bus.forbids("servo_id=7")->code == Code::driven);
  CHECK_FALSE(bus.forbids("servo_id=7", true));
  CHECK(bus.forbids(bus.plan(erase))->code == Code::driven); // 0, the default
  CHECK_FALSE(bus.forbids(bus.plan(restart)));
  Wanted brings_back = restart;
  brings_back.rom_servo_id = 7;
  CHECK(bus.forbids(bus.plan(brings_back))->code == Code::driven);
  CHECK_FALSE(bus.forbids(bus.plan(brings_back), true));
}

TEST_CASE("what gives a servo ID is withheld as long as another node commands it") {
  const Watched bus(R"(, "foreign": [{"kind": "node", "node_id": 30, "begins": "3s",
                                      "commands": {"servo_ids": [0, 7]}}])");
  const auto leaves = [&](const Guard& guard, std::int64_t next) {
    return guard.guarded({}, bus.servo, next).may_leave(bus.scene.session->now());
  };
  const Guard guard(bus.scene.roster(), false);
  CHECK(leaves(guard, 0));
  CHECK(leaves(guard, 7));
  bus.scene.live(3s); // it begins while the command runs
  CHECK_FALSE(leaves(guard, 0));
  CHECK_FALSE(leaves(guard, 7));
  CHECK(leaves(guard, 3)); // its own
  CHECK(leaves(Guard(bus.scene.roster(), false, true), 7));
  CHECK_FALSE(leaves(Guard(bus.scene.roster(), true, false), 7));
}

TEST_CASE("no servo is erased, or restarted, into a servo ID that another node commands") {
  const Watched bus(R"(, "foreign": [{"kind": "node", "node_id": 30,
                                      "commands": {"servo_ids": [0, 7]}}])");
  EraseJob erases(bus.scene.roster(), bus.servo, {});
  bus.scene.run(erases);
  CHECK_FALSE(erases.is_sent());
  REQUIRE(erases.error());
  CHECK(erases.error()->code == Code::driven);
  bus.scene.live(2s);
  SaveRestartJob restarts(
      bus.scene.roster(), bus.servo,
      {.kind = RestartKind::restart, .come_back = 5s, .patience = {}, .next_servo_id = 7});
  bus.scene.run(restarts);
  CHECK_FALSE(restarts.is_sent());
  REQUIRE(restarts.error());
  CHECK(restarts.error()->code == Code::driven);
}

TEST_CASE("a value in RAM is not written beside settings that another node has changed") {
  const Watched bus(R"(, "foreign": [{"kind": "node", "node_id": 30, "orders": [{"at": "900ms",
      "to": 11, "order": "write", "address": 38, "value": 0}]}])");
  const auto forbids = [&](const char* assignment, const bla::Values& held) {
    return bus.forbids(bus.plan({.assignments = assignments({assignment})}, held));
  };
  CHECK(forbids("command_speed=30rpm", {{at::timeout_action, 1}, {at::speed_torque_control, 1}})
            ->code == Code::state);
  CHECK_FALSE(forbids("smoothing=off", {{at::smoothing, 1}}));
}

TEST_CASE("nothing is written to a doubled node ID") {
  const Watched bus;
  bus.scene.roster().mark_doubled(NodeId(11), {0x11, 1}, {0x11, 2});
  const auto error = bus.forbids("smoothing=off", true);
  REQUIRE(error);
  CHECK(error->code == Code::duplicate_node_id);
  CHECK(error->node_id == 11);
  CHECK(error->message == doubled(bus.scene.roster(), NodeId(11)).message);
}

TEST_CASE("the units on a doubled ID are named where they are known") {
  const Watched bus;
  const std::string unnamed = doubled(bus.scene.roster(), NodeId(11)).message;
  CHECK(unnamed.find("uid:") == std::string::npos);
  bus.scene.roster().mark_doubled(NodeId(11), {0x11, 1}, {0x11, 2});
  const Error named = doubled(bus.scene.roster(), NodeId(11));
  CHECK(named.code == Code::duplicate_node_id);
  CHECK(named.node_id == 11);
  CHECK(named.message.find("uid:1101") != std::string::npos);
  CHECK(named.message.find("uid:1102") != std::string::npos);
  CHECK_FALSE(named.hint.empty());
}

TEST_CASE("what was read of a servo before its restart is no ground to write to it") {
  Acquaintance known(bla21());
  const Plan plan = plan_for({.assignments = assignments({"smoothing=off"})}, {}, known.servo);
  CHECK_FALSE(forbidden(known.roster, known.now, plan, false));
  known.restart();
  CHECK(forbidden(known.roster, known.now, plan, true)->code == Code::state);
  // Identified again it is known, but the plan is still that of the time before.
  Servo again = known.servo;
  again.boot = 1;
  known.roster.learn(again, GetNodeInfo::Response{.unique_id = *again.unique_id});
  REQUIRE(known.member().is_known());
  CHECK(forbidden(known.roster, known.now, plan, true)->code == Code::state);
}

TEST_CASE("a static node ID that is not ours is for others to judge") {
  const Watched bus(R"(, "foreign": [{"kind": "node", "node_id": 30}])");
  CHECK_FALSE(bus.forbids("static_node_id=30")); // survey() asks who has it
  CHECK_FALSE(bus.forbids("static_node_id=11")); // its own
  CHECK_FALSE(bus.forbids("static_node_id=0"));  // dynamic
}

TEST_CASE("the ID of this process is not given to a servo") {
  const Acquaintance known(bla21(), NodeId(20));
  const auto forbids = [&](const Wanted& wanted, const bla::Values& held = {}) {
    return forbidden(known.roster, known.now, plan_for(wanted, held, known.servo), false);
  };
  const auto error = forbids({.assignments = assignments({"static_node_id=20"})});
  REQUIRE(error);
  CHECK(error->code == Code::out_of_range);
  CHECK(error->node_id == 11);
  CHECK(error->hint.find("--local-node-id") != std::string::npos);
  CHECK_FALSE(forbids({.assignments = assignments({"servo_id=20"})})); // another number
  CHECK_FALSE(forbids({.assignments = assignments({"static_node_id=0"})}));
  const Wanted save{.restart = RestartKind::save};
  CHECK(forbids(save, {{at::static_node_id, 20}})->code == Code::out_of_range);
}

TEST_CASE("who restarts while others are asked who they are is asked again") {
  const Scene scene(R"("servos": [
      {"model": "BLA21-12U-AB", "serial_number": 240900001, "node_id": 11, "unique_id": "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"},
      {"model": "BLA21-12U-AB", "serial_number": 240900002, "node_id": 12, "unique_id": "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"},
      {"model": "BLA21-12U-AB", "serial_number": 240900003, "node_id": 13, "faults": {"mute": true}}],
      "events": [{"at": "1300ms", "servo": 240900002, "world": {"voltage": "2V"}},
                 {"at": "1400ms", "servo": 240900002, "world": {"voltage": "12V"}}])");
  scene.live(1s);
  (void)scene.identify(11);
  (void)scene.identify(12);
  REQUIRE(scene.roster().copies(NodeId(11)) == std::vector{NodeId(12)});
  const auto heard = hear_others(*scene.session, {}, std::nullopt, {});
  CHECK(heard.errors.empty());
  REQUIRE(scene.member(12).boots == 1);
  CHECK(scene.roster().copies(NodeId(11)) == std::vector{NodeId(12)});
}

TEST_CASE("who came after the search is refused, but not a servo that this change has restarted") {
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])");
  const Servo servo = scene.identify(11);
  const Time before = scene.member(11).first_heard - 1s;
  const auto others = hear_others(*scene.session, {}, before, {});
  REQUIRE(others.errors.size() == 1);
  CHECK(others.errors[0].code == Code::state);
  CHECK(others.errors[0].node_id == 11);
  const std::vector own{*servo.unique_id};
  CHECK(hear_others(*scene.session, {}, before, own).errors.empty());
}

TEST_CASE("a silent node that restarts again and again does not hold up a command") {
  std::string events;
  for (int at = 2; at < 20; ++at) {
    events += fmt::format(R"({}{{"at": "{}s", "servo": 1, "world": {{"voltage": "2V"}}}},
                             {{"at": "{}100ms", "servo": 1, "world": {{"voltage": "12V"}}}})",
                          at == 2 ? "" : ",", at, at);
  }
  const Scene scene(fmt::format(R"("servos": [
      {{"model": "BLA21-12U-AB", "serial_number": 1, "node_id": 13, "faults": {{"mute": true}}}}],
      "events": [{}])",
                                events));
  scene.live(1500ms);
  CHECK(hear_others(*scene.session, {}, std::nullopt, {}).errors.empty());
  CHECK(scene.member(13).boots == 3);
  CHECK(scene.requests(GetNodeInfo::type, 13) == 9); // each of three runs, with its repetitions
}
