#include "blactl/fleet/characterize/findings.hpp"

#include "support.hpp"

#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using dronecan::Health;
using dronecan::NodeStatus;

namespace {

/// A roster that the test tells who is there.
struct Bus {
  void hear(std::uint8_t id, NodeStatus status = {}) {
    const auto frames = message(NodeStatus::type, id, status.encode());
    const auto payload = status.encode();
    roster.hear(frames.front(), now);
    roster.receive({.header = {.kind = dronecan::Kind::message,
                               .data_type_id = NodeStatus::type.id,
                               .source = NodeId(id)},
                    .payload = payload.bytes(),
                    .at = now});
  }

  void servo(std::uint8_t id, std::int64_t servo_id, std::int64_t static_node_id = 0) {
    hear(id);
    Servo servo = bla21(id);
    servo.servo_id = servo_id;
    servo.static_node_id = static_node_id;
    roster.learn(servo, GetNodeInfo::Response{.unique_id = {id}});
  }

  [[nodiscard]] Findings findings(std::string_view list = "") const {
    const auto targets = list.empty() ? Targets{} : parse_targets(list);
    REQUIRE(targets);
    return gather(roster, *targets, profiles(), now);
  }

  Roster roster{NodeId(127), profiles()};
  Time now{1000s};
};

std::vector<int> ids(const Findings& findings) {
  std::vector<int> all;
  for (const Finding& node : findings.nodes) {
    all.push_back(node.servo.id.value());
  }
  return all;
}

/// The warnings of a servo with these readings.
std::vector<std::string> warnings_of(const bla::Readings& readings) {
  Member member{.id = NodeId(11), .is_servo = true, .identity = {profiles(), readings}};
  return warnings(member);
}

bool says(const std::vector<std::string>& all, std::string_view words) {
  return all.size() == 1 && all[0].find(words) != std::string::npos;
}

} // namespace

TEST_CASE("without -n every node that was heard is listed, with it those that are meant") {
  Bus bus;
  bus.servo(11, 1);
  bus.servo(12, 2);
  bus.hear(30);
  bus.roster.learn({.id = NodeId(40)}, std::nullopt); // was asked, and never heard
  CHECK(ids(bus.findings()) == std::vector{11, 12, 30});
  CHECK(ids(bus.findings("12,30,40")) == std::vector{12, 30});
  CHECK(ids(bus.findings("all")) == std::vector{11, 12});
  CHECK(ids(bus.findings("servo:2")) == std::vector{12});
}

TEST_CASE("servos with different numbers are no conflict, nor are several without a static ID") {
  Bus bus;
  bus.servo(11, 1);
  bus.servo(12, 2);
  bus.servo(13, 3, 20);
  CHECK(bus.findings().conflicts.empty());
}

TEST_CASE("two servos with one servo ID are a conflict, with a way out") {
  Bus bus;
  bus.servo(11, 4);
  bus.servo(12, 4);
  bus.servo(13, 5);
  const auto conflicts = bus.findings().conflicts;
  REQUIRE(conflicts.size() == 1);
  CHECK(conflicts[0].code == Code::duplicate_servo_id);
  CHECK(conflicts[0].nodes == std::vector{NodeId(11), NodeId(12)});
  CHECK(conflicts[0].text == "nodes 11, 12 have the same servo ID 4");
  CHECK(conflicts[0].hint.find("-n 12 servo_id=") != std::string::npos);
}

TEST_CASE("a conflict is told even if -n names only one of the two") {
  Bus bus;
  bus.servo(11, 4);
  bus.servo(12, 4);
  CHECK(bus.findings("11").conflicts.size() == 1);
}

TEST_CASE("a servo that has another node ID now is one servo") {
  Bus bus;
  const auto servo_as = [&bus](std::uint8_t id) {
    const GetNodeInfo::Response info{.unique_id = {7}};
    Servo servo = bla21(id);
    servo.servo_id = 3;
    bus.hear(id);
    bus.roster.learn(NodeId(id), info, bus.now);
    bus.roster.learn(servo, info);
    bus.now += 100ms;
  };
  servo_as(34);
  servo_as(61);
  CHECK(ids(bus.findings()) == std::vector{61});
  CHECK(bus.findings().conflicts.empty());
  // It goes on under its old ID: two units claim to be this one.
  bus.hear(34);
  CHECK(ids(bus.findings()) == std::vector{34, 61});
  const auto conflicts = bus.findings().conflicts;
  REQUIRE(conflicts.size() == 2);
  CHECK(conflicts[0].code == Code::duplicate_unique_id);
  CHECK(conflicts[0].nodes == std::vector{NodeId(34), NodeId(61)});
  CHECK(conflicts[1].code == Code::duplicate_servo_id);
}

TEST_CASE("who has restarted and was not asked since is not told by what was there before") {
  Bus bus;
  bus.servo(11, 5);
  bus.now += 10s;
  bus.hear(11, {.uptime_s = 60});
  bus.now += 2s;
  bus.hear(11, {.uptime_s = 1}); // a restart, or another unit
  const Findings findings = bus.findings();
  REQUIRE(findings.nodes.size() == 1);
  const Finding& node = findings.nodes[0];
  CHECK(node.servo.is_servo);
  CHECK_FALSE(node.servo.unique_id);
  CHECK(node.servo.identity.model().empty());
  CHECK_FALSE(node.info);
  CHECK(node.status);
  CHECK(node.warnings.size() == 1);
}

TEST_CASE("two servos with one static node ID will collide after a restart") {
  Bus bus;
  bus.servo(11, 1, 20);
  bus.servo(12, 2, 20);
  const auto conflicts = bus.findings().conflicts;
  REQUIRE(conflicts.size() == 1);
  CHECK(conflicts[0].code == Code::duplicate_node_id);
  CHECK(conflicts[0].text == "nodes 11, 12 have the same static node ID 20");
}

TEST_CASE("one node ID for two units is a conflict of one ID") {
  Bus bus;
  bus.servo(11, 1);
  bus.roster.mark_doubled(NodeId(11), {11}, {12});
  const auto conflicts = bus.findings().conflicts;
  REQUIRE(conflicts.size() == 1);
  CHECK(conflicts[0].code == Code::duplicate_node_id);
  CHECK(conflicts[0].nodes == std::vector{NodeId(11)});
  CHECK(conflicts[0].text == "two units use node ID 11: uid:0b" + std::string(30, '0') +
                                 ", uid:0c" + std::string(30, '0'));
  CHECK_FALSE(conflicts[0].hint.empty());
}

TEST_CASE(
    "two units on one node ID are two findings, and nothing is said that may be the other's") {
  Bus bus;
  bus.servo(11, 1, 20);
  bus.servo(12, 1, 20); // no conflict with what is known of 11: it may not be so
  bus.roster.mark_doubled(NodeId(11), {11}, {13});
  const auto findings = bus.findings();
  CHECK(ids(findings) == std::vector{11, 11, 12});
  CHECK(findings.nodes[0].servo.unique_id == dronecan::UniqueId{11});
  CHECK(findings.nodes[1].servo.unique_id == dronecan::UniqueId{13});
  for (const std::size_t index : {0U, 1U}) {
    const Finding& node = findings.nodes[index];
    CHECK(node.servo.is_servo);
    CHECK(node.servo.identity.model().empty());
    CHECK_FALSE(node.servo.identity.readings().serial_number);
    CHECK_FALSE(node.servo.servo_id);
    CHECK_FALSE(node.servo.static_node_id);
    CHECK_FALSE(node.info);
    CHECK_FALSE(node.status);
    CHECK(node.warnings.empty());
  }
  CHECK(findings.conflicts.size() == 1);
}

TEST_CASE("another allocator and servos of one servo ID other than 0 are notes for who writes") {
  Bus bus;
  bus.servo(11, 4);
  bus.servo(12, 4);
  bus.servo(13, 0);
  bus.servo(14, 0);
  const dronecan::Allocation part{.node_id = 21, .size = 6, .unique_id = {1}};
  const auto payload = part.encode();
  bus.roster.receive({.header = {.kind = dronecan::Kind::message,
                                 .data_type_id = dronecan::Allocation::type.id,
                                 .source = NodeId(40)},
                      .payload = payload.bytes(),
                      .at = bus.now});
  CHECK(notes_before_writing(bus.roster) ==
        std::vector<std::string>{"node 40 allocates node IDs",
                                 "nodes 11, 12 have the same servo ID 4"});
}

TEST_CASE("a node that has gone silent is offline", "[requirement-26]") {
  Bus bus;
  bus.servo(11, 1);
  bus.now += 2999ms;
  bus.servo(12, 2);
  CHECK_FALSE(bus.findings().nodes[0].is_offline);
  CHECK(bus.findings().nodes[0].status->mode == dronecan::Mode::operational);
  bus.now += 1ms;
  const auto nodes = bus.findings().nodes;
  CHECK(nodes[0].is_offline);
  CHECK(nodes[0].status->mode == dronecan::Mode::offline);
  CHECK(says(nodes[0].warnings, "has not been heard for 3 s"));
  CHECK_FALSE(nodes[1].is_offline);
}

TEST_CASE("who does not answer and is heard is not away") {
  Bus bus;
  bus.servo(11, 1);
  const auto look = [&bus] {
    return gather(bus.roster, Targets{}, profiles(), bus.now, {NodeId(11)}).nodes[0];
  };
  bus.now += 299ms;
  CHECK_FALSE(look().is_offline);
  CHECK(look().status->mode == dronecan::Mode::operational);
  CHECK(says(look().warnings, "did not answer"));
  bus.now += 1ms;
  CHECK(look().is_offline);
  CHECK(says(look().warnings, "does not answer any more"));
}

TEST_CASE("a node is foreign only if it said so itself") {
  Bus bus;
  bus.hear(30); // nobody asked it
  bus.hear(31);
  bus.roster.learn(NodeId(31), GetNodeInfo::Response{.name = "org.example.gps"},
                   bus.now); // not decided
  bus.hear(32);
  bus.roster.learn({.id = NodeId(32)}, GetNodeInfo::Response{.name = "org.example.gps"});
  const auto nodes = bus.findings().nodes;
  REQUIRE(nodes.size() == 3);
  CHECK_FALSE(nodes[0].is_foreign);
  CHECK_FALSE(nodes[1].is_foreign);
  CHECK(nodes[2].is_foreign);
}

TEST_CASE("a foreign node shares no servo ID with anybody") {
  Bus bus;
  bus.servo(11, 0);
  bus.hear(30);
  bus.roster.learn({.id = NodeId(30), .servo_id = 0}, std::nullopt);
  CHECK(bus.findings().conflicts.empty());
}

TEST_CASE("a servo that is as it should be has no warning") {
  CHECK(warnings_of({61, 240900558, 1400, 12050}).empty());
}

TEST_CASE("an unknown or uncertain model and old firmware are warned of") {
  CHECK(says(warnings_of({99, 1, 1400, 55555}), "can only be read"));
  CHECK(says(warnings_of({61, 1, 1400, 12051}), "12051"));
  CHECK(says(warnings_of({61, 1, 1399, 12050}), "1.399 may stall"));
}

TEST_CASE("a servo that will be somewhere else after a restart is warned of") {
  Member member{.id = NodeId(11), .is_servo = true, .identity = bla21().identity};
  member.static_node_id = 20;
  CHECK(says(warnings(member), "0x46 in RAM is 20"));
  member.static_node_id = 11;
  CHECK(warnings(member).empty());
  member.static_node_id = 0; // it asks for one
  CHECK(warnings(member).empty());
}

TEST_CASE("bad health is warned of, whoever has it; what only servos have of servos alone") {
  Member node{.id = NodeId(30)};
  node.static_node_id = 20;
  CHECK(warnings(node).empty());
  node.status = NodeStatus{.health = Health::warning};
  CHECK(says(warnings(node), "health: warning"));
}

TEST_CASE("the status that a node sends by itself is newer than that of GetNodeInfo") {
  Member member;
  CHECK_FALSE(status(member));
  member.info = GetNodeInfo::Response{.status = {.uptime_s = 1}};
  CHECK(status(member)->uptime_s == 1);
  member.status = NodeStatus{.uptime_s = 2};
  CHECK(status(member)->uptime_s == 2);
}
