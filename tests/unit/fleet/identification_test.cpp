#include "blactl/fleet/bus/identification.hpp"

#include "support.hpp"

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

using Lines = std::vector<std::string>;

namespace {

constexpr const char* one_servo = R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
    "servo_id": 7, "serial_number": 240900558, "firmware_version": 1400,
    "unique_id": "00112233445566778899aabbccddeeff"}])";

/// An identification that is asked without a bus.
struct Dialogue {
  explicit Dialogue(Identification::Options options = {})
      : identification(roster, NodeId(11), profiles(), options) {}

  std::string next(const Outcome& outcome) { return text(identification.next(outcome)); }

  [[nodiscard]] Member member() const { return roster.member(NodeId(11)); }

  void hear_uptime(std::uint32_t uptime_s) {
    hear(dronecan::NodeStatus::type, dronecan::NodeStatus{.uptime_s = uptime_s}.encode());
  }

  void hear(const dronecan::DataType& type, const dronecan::Payload& payload) {
    roster.receive(
        {.header = {.kind = dronecan::Kind::message, .data_type_id = type.id, .source = NodeId(11)},
         .payload = payload.bytes(),
         .at = Time{1000s}});
  }

  void hear_actuator() {
    hear(dronecan::ActuatorStatus::type, dronecan::ActuatorStatus{.actuator_id = 3}.encode());
  }

  /// It is taken for a servo that does not say what model it is.
  [[nodiscard]] bool mute() const {
    REQUIRE(identification.error());
    CHECK(identification.error()->node_id == 11);
    CHECK_FALSE(identification.done());
    CHECK_FALSE(member().is_known());
    return identification.error()->code == Code::timeout;
  }

  /// The answers to 0x50 and all that follows.
  void pass_registers() {
    CHECK(next(script.value("0x50", std::int64_t{61})) == "read 0x51");
    CHECK(next(script.value("0x51", std::int64_t{1})) == "read 0x52");
    CHECK(next(script.value("0x52", std::int64_t{1400})) == "read 0x53");
    CHECK(next(script.value("0x53", std::int64_t{12050})) == "read 0x45");
    CHECK(next(script.value("0x45", std::int64_t{3})) == "nothing");
  }

  /// As far as 0x50, which is not answered yet.
  void pass_node_info(std::uint8_t unit = 1) {
    CHECK(next(Script::start()) == "GetNodeInfo");
    CHECK(next(script.info(unit)) == "read 0x50");
  }

  Roster roster{NodeId(127), profiles()};
  Script script;
  Identification identification;
};

/// A frame of node 11, so that it counts as heard.
void hear_node(Roster& roster) {
  roster.hear(message(dronecan::NodeStatus::type, 11, dronecan::NodeStatus{}.encode()).front(),
              Time{});
}

} // namespace

TEST_CASE("a servo is asked for its unique ID, 0x50-0x53 and 0x45, each once", "[requirement-14]") {
  Scene scene(one_servo);
  const Servo servo = scene.identify(11);
  CHECK(scene.member(11).is_known());
  CHECK(servo.is_servo);
  CHECK(servo.unique_id->at(1) == 0x11);
  CHECK(servo.servo_id == 7);
  CHECK_FALSE(servo.static_node_id);
  CHECK(servo.identity.model() == "BLA21-12U-AB");
  CHECK(servo.identity.certain());
  CHECK(servo.identity.readings().serial_number == 240900558);
  CHECK(servo.identity.readings().firmware_version == 1400);
  CHECK(scene.requests(GetNodeInfo::type, 11) == 1);
  CHECK(scene.requests(GetSet::type, 11) == 5);
  CHECK(scene.sent.size() == 1 + 5 * 1);
}

TEST_CASE("the static node ID is asked for where it is wanted") {
  Scene scene(one_servo);
  const Servo servo = scene.identify(11, {.patience = {}, .static_node_id = true});
  CHECK(servo.static_node_id == 11);
  CHECK(scene.requests(GetSet::type, 11) == 6);
}

TEST_CASE("the questions come one after the other") {
  Dialogue dialogue;
  dialogue.pass_node_info();
  CHECK(dialogue.next(dialogue.script.value("0x50", std::int64_t{61})) == "read 0x51");
  CHECK(dialogue.next(dialogue.script.value("0x51", std::int64_t{1})) == "read 0x52");
  CHECK(dialogue.next(dialogue.script.value("0x52", std::int64_t{1400})) == "read 0x53");
  CHECK(dialogue.next(dialogue.script.value("0x53", std::int64_t{12050})) == "read 0x45");
  CHECK_FALSE(dialogue.member().is_known());
  CHECK(dialogue.next(dialogue.script.value("0x45", std::int64_t{3})) == "nothing");
  CHECK(dialogue.identification.done());
  CHECK(dialogue.member().is_known());
}

TEST_CASE("a model number that 0x50 cannot hold is not known; who tells one is a servo") {
  Dialogue dialogue;
  dialogue.pass_node_info();
  CHECK(dialogue.next(dialogue.script.value("0x50", std::int64_t{999})) == "read 0x51");
  dialogue.next(dialogue.script.value("0x51", std::int64_t{1}));
  dialogue.next(dialogue.script.value("0x52", std::int64_t{1400}));
  dialogue.next(dialogue.script.value("0x53", std::int64_t{12050}));
  CHECK(dialogue.next(dialogue.script.value("0x45", std::int64_t{3})) == "nothing");
  CHECK(dialogue.identification.servo().is_servo);
  CHECK_FALSE(dialogue.identification.servo().identity.readings().model_number);
}

TEST_CASE("who is known is not asked again until it restarts") {
  Scene scene(one_servo);
  scene.identify(11);
  const std::size_t sent = scene.sent.size();
  CHECK(scene.identify(11).servo_id == 7);
  CHECK(scene.sent.size() == sent);
  const auto long_ago = dronecan::NodeStatus{.uptime_s = 1'000'000}.encode();
  scene.roster().receive({.header = {.kind = dronecan::Kind::message,
                                     .data_type_id = dronecan::NodeStatus::type.id,
                                     .source = NodeId(11)},
                          .payload = long_ago.bytes(),
                          .at = scene.session->now()});
  CHECK_FALSE(scene.member(11).is_known());
  scene.identify(11);
  CHECK(scene.sent.size() == 2 * sent);
  CHECK(scene.member(11).is_known());
}

TEST_CASE("a restart in the middle of the questions leaves a servo that is not known") {
  Dialogue dialogue;
  dialogue.hear_uptime(100);
  dialogue.pass_node_info();
  dialogue.hear_uptime(0);
  for (const char* name : {"0x50", "0x51", "0x52", "0x53"}) {
    CHECK(dialogue.next(dialogue.script.value(name, std::int64_t{61})) != "nothing");
  }
  CHECK(dialogue.next(dialogue.script.value("0x45", std::int64_t{3})) == "nothing");
  CHECK_FALSE(dialogue.member().is_known());
}

TEST_CASE(
    "where its runs must be told apart, a servo that has only just started grows older first") {
  const Identification::Options settled{.patience = {}, .settled = true};
  Dialogue dialogue(settled);
  const auto told = [&](std::uint32_t uptime_s, Duration at) {
    Outcome outcome = dialogue.script.info(1, uptime_s);
    outcome.at = Time{} + at;
    outcome.asked = outcome.at - 2ms;
    return outcome;
  };
  CHECK(dialogue.next(Script::start()) == "GetNodeInfo");
  SECTION("a second later whole seconds show a restart") {
    const dronecan::Step step = dialogue.identification.next(told(0, 100ms));
    REQUIRE(step.pause() != nullptr);
    CHECK(step.pause()->until == Time{} + 1100ms);
    CHECK(dialogue.next(Script::start()) == "GetNodeInfo");
    CHECK(dialogue.next(told(1, 1102ms)) == "read 0x50");
    dialogue.pass_registers();
    CHECK_FALSE(dialogue.identification.servo().is_young);
    CHECK(dialogue.identification.servo().since == Time{} + 1100ms);
  }
  SECTION("one that has run for a second is not waited for") {
    CHECK(dialogue.next(told(1, 100ms)) == "read 0x50");
  }
  SECTION("one that restarts again and again is not waited for any longer") {
    for (int i = 0; i < 4; ++i) {
      CHECK(dialogue.next(told(0, 100ms)) == "pause");
      CHECK(dialogue.next(Script::start()) == "GetNodeInfo");
    }
    CHECK(dialogue.next(told(0, 100ms)) == "read 0x50");
    dialogue.pass_registers();
    CHECK(dialogue.identification.servo().is_young);
  }
  SECTION("one that goes while it is waited for has gone, and is not just mute") {
    hear_node(dialogue.roster);
    dialogue.roster.learn(NodeId(11), GetNodeInfo::Response{.unique_id = {1}}, Time{});
    CHECK(dialogue.next(told(0, 100ms)) == "pause");
    CHECK(dialogue.next(Script::start()) == "GetNodeInfo");
    CHECK(dialogue.next(Script::timed_out()) == "nothing");
    REQUIRE(dialogue.identification.error());
    CHECK(dialogue.identification.error()->message == "node 11 does not answer any more");
  }
  SECTION("the wait can be cancelled") {
    CHECK(dialogue.next(told(0, 100ms)) == "pause");
    CHECK(dialogue.next(Script::cancelled()) == "nothing");
    REQUIRE(dialogue.identification.error());
    CHECK(dialogue.identification.error()->code == Code::interrupted);
  }
}

TEST_CASE("who was identified too young is identified anew where that matters") {
  Scene scene(one_servo);
  CHECK(scene.identify(11).is_young);
  scene.sent.clear();
  const Servo servo = scene.identify(11, {.patience = {}, .settled = true});
  CHECK_FALSE(servo.is_young);
  CHECK(servo.servo_id == 7);
  CHECK(scene.requests(GetNodeInfo::type, 11) == 1);
  CHECK(scene.requests(GetSet::type, 11) == 5);
  scene.sent.clear();
  CHECK_FALSE(scene.identify(11, {.patience = {}, .settled = true}).is_young);
  CHECK(scene.sent.empty());
}

TEST_CASE("numbers are narrowed to the width of their registers") {
  Dialogue dialogue;
  dialogue.pass_node_info();
  CHECK(dialogue.next(dialogue.script.value("0x50", std::int64_t{61})) == "read 0x51");
  dialogue.next(dialogue.script.value("0x51", std::int64_t{-1}));
  dialogue.next(dialogue.script.value("0x52", std::int64_t{1400}));
  dialogue.next(dialogue.script.value("0x53", std::int64_t{12050}));
  dialogue.next(dialogue.script.value("0x45", std::int64_t{-2}));
  const auto readings = dialogue.member().identity.readings();
  CHECK(readings.model_number == 61);
  CHECK(readings.serial_number == 0xFFFF'FFFF);
  CHECK(dialogue.member().servo_id == 254);
}

TEST_CASE("a node without parameters is identified, and is no servo") {
  Scene scene(R"("foreign": [{"kind": "node", "node_id": 30, "name": "org.example.gnss",
                              "serves_get_set": true}])");
  scene.identify(30);
  const Member node = scene.member(30);
  CHECK(node.is_known());
  CHECK_FALSE(node.is_servo);
  CHECK(node.info->name == "org.example.gnss");
  CHECK(node.identity.model().empty());
  CHECK(scene.requests(GetSet::type, 30) == 1);
}

TEST_CASE("a node that does not serve GetSet at all is no servo either") {
  Scene scene(R"("foreign": [{"kind": "node", "node_id": 30}])");
  scene.identify(30, {.patience = {.timeout = 50ms, .retries = 1}});
  const Member node = scene.member(30);
  CHECK(node.is_known());
  CHECK_FALSE(node.is_servo);
  CHECK(scene.requests(GetSet::type, 30) == 2);
}

TEST_CASE("another run of this program is no servo that is mute") {
  Scene scene(R"("foreign": [{"kind": "node", "node_id": 127, "name": "blactl"}])");
  scene.identify(127, {.patience = {.timeout = 50ms, .retries = 1}});
  CHECK(scene.member(127).is_known());
  CHECK_FALSE(scene.member(127).is_servo);
}

TEST_CASE("an actuator that answers neither 0x50 nor 0x51 is of another make") {
  Dialogue dialogue;
  dialogue.hear_actuator();
  dialogue.pass_node_info();
  CHECK(dialogue.next(Script::timed_out()) == "read 0x51");
  SECTION("it answers no GetSet") {
    CHECK(dialogue.next(Script::timed_out()) == "nothing");
    CHECK(dialogue.identification.done());
    CHECK_FALSE(dialogue.identification.error());
    CHECK(dialogue.member().is_known());
    CHECK_FALSE(dialogue.member().is_servo);
  }
  SECTION("it answers the second one: a servo whose model is not known") {
    CHECK(dialogue.next(dialogue.script.value("0x51", std::int64_t{1})) == "nothing");
    CHECK(dialogue.mute());
  }
  SECTION("two units on the ID disturb each other's answers") {
    dialogue.roster.mark_doubled(NodeId(11), {1}, {2});
    CHECK(dialogue.next(Script::timed_out()) == "nothing");
    CHECK(dialogue.mute());
  }
}

TEST_CASE("an actuator that is called like a servo is a servo that is mute") {
  const std::string name = GENERATE("futaba.bla", "jp.co.futaba.servo", "BLA21");
  CAPTURE(name);
  Dialogue dialogue;
  dialogue.hear_actuator();
  CHECK(dialogue.next(Script::start()) == "GetNodeInfo");
  const GetNodeInfo::Response info{.unique_id = {1}, .name = name};
  CHECK(dialogue.next(dialogue.script.answer(info.encode())) == "read 0x50");
  CHECK(dialogue.next(Script::timed_out()) == "read 0x51");
  CHECK(dialogue.next(Script::timed_out()) == "nothing");
  CHECK(dialogue.mute());
}

TEST_CASE("a servo is dated by the question that it answered first") {
  Dialogue dialogue;
  CHECK(dialogue.next({Outcome::Kind::start, {}, Time{499s}}) == "GetNodeInfo");
  Outcome answer = dialogue.script.info(1);
  answer.asked = Time{500s}; // once more: it may have started after the one before
  answer.at = Time{501s};
  CHECK(dialogue.next(answer) == "read 0x50");
  dialogue.next(dialogue.script.value("0x50", std::int64_t{61}));
  dialogue.next(dialogue.script.value("0x51", std::int64_t{1}));
  dialogue.next(dialogue.script.value("0x52", std::int64_t{1400}));
  dialogue.next(dialogue.script.value("0x53", std::int64_t{12050}));
  dialogue.next(dialogue.script.value("0x45", std::int64_t{3}));
  CHECK(dialogue.identification.servo().since == Time{500s});
  CHECK(dialogue.member().servo().since == Time{500s});
  Identification again(dialogue.roster, NodeId(11), profiles(), {});
  CHECK(again.next({Outcome::Kind::start, {}, Time{600s}}).is_end());
  CHECK(again.servo().since == Time{500s});
}

TEST_CASE("a servo of an unknown model can be read, and has no model") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11, "model_number": 99}])");
  const Servo servo = scene.identify(11);
  CHECK(servo.is_servo);
  CHECK(servo.identity.model().empty());
  CHECK(servo.identity.profile() == nullptr);
  CHECK(servo.identity.parameter(bla::address::angle_limit_cw) != nullptr);
  CHECK_FALSE(servo.identity.may_write(bla::address::angle_limit_cw, 900));
}

TEST_CASE("--profile fills in for a model that no profile fits, for reading only") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11, "model_number": 99}])");
  const Servo servo = scene.identify(11, {.patience = {}, .assumed = &model("BLA21-12U-AB")});
  CHECK(servo.identity.model() == "BLA21-12U-AB");
  CHECK(servo.identity.may_write(bla::address::angle_limit_cw, 900).error().code ==
        Code::no_profile);
}

TEST_CASE("--profile against a successful identification is a mismatch") {
  Scene scene(one_servo);
  IdentifyJob job(scene.roster(), NodeId(11), profiles(),
                  {.patience = {}, .assumed = &model("BLA34-28U-AB")});
  scene.run(job);
  REQUIRE(job.identification().error());
  CHECK(job.identification().error()->code == Code::model_mismatch);
  CHECK(job.identification().error()->node_id == 11);
  CHECK_FALSE(scene.member(11).is_known());
}

TEST_CASE("an ID that was never heard is not found, after all tries") {
  Scene scene(one_servo);
  IdentifyJob job(scene.roster(), NodeId(55), profiles(),
                  {.patience = {.timeout = 50ms, .retries = 2}});
  scene.run(job);
  REQUIRE(job.identification().error());
  CHECK(job.identification().error()->code == Code::not_found);
  CHECK(job.identification().error()->node_id == 55);
  CHECK(scene.requests(GetNodeInfo::type, 55) == 3);
  CHECK(scene.requests(GetSet::type, 55) == 0);
}

TEST_CASE("an ID that was heard and does not answer timed out") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11, "faults": {"mute": true}}])");
  IdentifyJob job(scene.roster(), NodeId(11), profiles(),
                  {.patience = {.timeout = 50ms, .retries = 0}});
  scene.run(job);
  REQUIRE(job.identification().error());
  CHECK(job.identification().error()->code == Code::timeout);
}

TEST_CASE("lost answers are asked for again") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
                             "faults": {"lose_responses": 2}}])");
  CHECK(scene.identify(11).is_servo);
  CHECK(scene.requests(GetNodeInfo::type, 11) == 3);
}

TEST_CASE("an answer that cannot be read is none, and tells who it is about") {
  Dialogue dialogue;
  hear_node(dialogue.roster);
  CHECK(dialogue.next(Script::start()) == "GetNodeInfo");
  const std::vector<std::uint8_t> stub{1, 2, 3};
  CHECK(dialogue.next(dialogue.script.answer(dronecan::Payload(stub))) == "nothing");
  REQUIRE(dialogue.identification.error());
  CHECK(dialogue.identification.error()->code == Code::timeout);
}

TEST_CASE("what was cancelled or did not leave is told as that") {
  const auto [outcome, code] = GENERATE(std::pair(Outcome::Kind::cancelled, Code::interrupted),
                                        std::pair(Outcome::Kind::not_sent, Code::no_acknowledge));
  Dialogue dialogue;
  SECTION("GetNodeInfo") {
    dialogue.next(Script::start());
  }
  SECTION("a register") {
    dialogue.pass_node_info();
  }
  CHECK(dialogue.next({outcome, {}, {}}) == "nothing");
  REQUIRE(dialogue.identification.error());
  CHECK(dialogue.identification.error()->code == code);
}

TEST_CASE("a register that is refused stays unknown, and the others are asked") {
  Dialogue dialogue;
  dialogue.pass_node_info();
  dialogue.next(dialogue.script.value("0x50", std::int64_t{61}));
  CHECK(dialogue.next(dialogue.script.value("", {})) == "read 0x52");
  dialogue.next(dialogue.script.value("0x52", std::int64_t{1400}));
  dialogue.next(dialogue.script.value("0x53", std::int64_t{12050}));
  dialogue.next(dialogue.script.value("", {}));
  CHECK(dialogue.member().is_known());
  CHECK_FALSE(dialogue.member().identity.readings().serial_number);
  CHECK_FALSE(dialogue.member().servo_id);
}

TEST_CASE("nothing of the unit that had the ID before is left") {
  Scene scene(R"("foreign": [{"kind": "node", "node_id": 11, "serves_get_set": true}])");
  Servo before{.id = NodeId(11), .boot = 1, .is_servo = true, .servo_id = 3, .static_node_id = 11};
  before.identity = bla::Identity(profiles(), {61, 240900558, 1400, 12050});
  scene.roster().learn(before, std::nullopt);
  REQUIRE(scene.member(11).is_servo);
  scene.identify(11);
  const Member node = scene.member(11);
  CHECK_FALSE(node.is_servo);
  CHECK_FALSE(node.servo_id);
  CHECK_FALSE(node.static_node_id);
  CHECK(node.identity.model().empty());
  CHECK_FALSE(node.identity.readings().serial_number);
}

TEST_CASE("probes ask every silent ID once, eight at a time, and never our own") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11},
                            {"model": "BLA21-12U-AB", "node_id": 125}])",
              Session::Hearing::all, state::LocalNodeId::unshared({NodeId(60)}));
  REQUIRE(scene.session->wait_until_open());
  const Time begin = scene.session->now();
  std::uint8_t cursor = 0;
  std::vector<std::unique_ptr<ProbeJob>> probes;
  for (int i = 0; i < 8; ++i) {
    probes.push_back(std::make_unique<ProbeJob>(scene.roster(), cursor, 60ms));
    scene.session->start(*probes.back());
  }
  CHECK(scene.session->node().jobs() == 8);
  REQUIRE(scene.session->run());
  for (std::uint8_t id = 1; id <= 127; ++id) {
    const bool asked = id != 11 && id != 125 && id != 60 && id < 126;
    CHECK(scene.requests(GetNodeInfo::type, id) == (asked ? 1U : 0U));
  }
  CHECK(scene.session->now() - begin < 1100ms);
}

TEST_CASE("a probed node answers and is heard; a cancelled probe asks no more") {
  Scene scene(R"("foreign": [{"kind": "node", "node_id": 2}])");
  Roster roster(NodeId(127), profiles()); // has not heard it
  std::uint8_t cursor = 0;
  ProbeJob probe(roster, cursor, 60ms);
  scene.session->start(probe);
  scene.live(90ms);
  CHECK(scene.member(2).last_heard > Time(Scene::start_time));
  scene.session->node().cancel_all(scene.session->now());
  const std::size_t sent = scene.sent.size();
  scene.live(500ms);
  CHECK(scene.sent.size() == sent);
}

TEST_CASE("a second answer with another unique ID is another unit") {
  Acquaintance known;
  Roster& roster = known.roster;
  Script script;
  DoubleCheckJob job(roster, known.servo, {});
  CHECK(text(job.next(Script::start())) == "GetNodeInfo");
  SECTION("the same one") {
    CHECK(text(job.next(script.info(1))) == "nothing");
    CHECK_FALSE(roster.is_doubled(NodeId(11)));
  }
  SECTION("another one") {
    CHECK(text(job.next(script.info(2))) == "nothing");
    CHECK(roster.is_doubled(NodeId(11)));
    CHECK(roster.units(NodeId(11)) == std::set<dronecan::UniqueId>{{1}, {2}});
  }
  SECTION("another one after a restart came in its place") {
    known.restart();
    CHECK(text(job.next(script.info(2))) == "nothing");
    CHECK_FALSE(roster.is_doubled(NodeId(11)));
  }
  SECTION("no answer tells nothing") {
    CHECK(text(job.next(Script::timed_out())) == "nothing");
    CHECK_FALSE(roster.is_doubled(NodeId(11)));
  }
}

TEST_CASE("a unit that appeared is asked for its unique ID, and for nothing else") {
  Acquaintance known;
  known.restart();
  Script script;
  UnitJob job(known.roster, NodeId(11), {});
  CHECK(text(job.next(Script::start())) == "GetNodeInfo");
  CHECK(job.must_finish());
  SECTION("the unit that was there before is recognised, but what it holds is not known") {
    CHECK(text(job.next(script.info(1))) == "nothing");
    CHECK(known.member().is_unit({1}));
    CHECK_FALSE(known.member().is_known());
  }
  SECTION("another unit is another unit") {
    CHECK(text(job.next(script.info(2))) == "nothing");
    CHECK(known.member().is_unit({2}));
    CHECK_FALSE(known.member().is_unit({1}));
    CHECK_FALSE(known.member().is_servo);
  }
  SECTION("without an answer nobody is recognised") {
    CHECK(text(job.next(Script::timed_out())) == "nothing");
    CHECK_FALSE(known.member().is_unit({1}));
  }
}
