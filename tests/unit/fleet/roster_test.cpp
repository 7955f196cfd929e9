#include "blactl/fleet/roster.hpp"
#include "blactl/sim/random.hpp"

#include "support.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using dronecan::ActuatorStatus;
using dronecan::Allocation;
using dronecan::ArmingStatus;
using dronecan::ArrayCommand;
using dronecan::Kind;
using dronecan::NodeStatus;

namespace {

/// A roster that hears frames as a session makes it hear them.
class Ear {
 public:
  explicit Ear(NodeId local = NodeId(127)) : roster(local) {}

  void hear(const std::vector<can::Frame>& frames) {
    for (const auto& frame : frames) {
      roster.hear(frame, now);
      receiver_.receive(frame, now);
    }
  }

  void status(std::uint8_t source, std::uint32_t uptime_s) {
    hear(message(NodeStatus::type, source, NodeStatus{.uptime_s = uptime_s}.encode(), next()));
  }

  void actuator(std::uint8_t source, std::uint8_t servo_id = 0) {
    hear(message(ActuatorStatus::type, source, ActuatorStatus{.actuator_id = servo_id}.encode(),
                 next()));
  }

  void arming(std::uint8_t source, std::uint8_t status) {
    hear(message(ArmingStatus::type, source, ArmingStatus{status}.encode(), next()));
  }

  void command(std::uint8_t source, std::vector<std::uint8_t> servo_ids) {
    ArrayCommand array;
    for (const std::uint8_t id : servo_ids) {
      array.commands.push_back({id, 1, 0});
    }
    hear(message(ArrayCommand::type, source, array.encode(), next()));
  }

  void get_set(std::uint8_t source, std::uint8_t server, const GetSet::Request& request) {
    hear(service(Kind::request, GetSet::type, source, server, request.encode(), next()));
  }

  /// A part of an allocation exchange; `source` 0: the one who asks.
  void allocation(std::uint8_t source, const std::vector<std::uint8_t>& unique_id,
                  bool first_part = false, std::uint8_t node_id = 0) {
    Allocation part{.node_id = node_id,
                    .first_part_of_unique_id = first_part,
                    .size = static_cast<std::uint8_t>(unique_id.size()),
                    .unique_id = {}};
    std::ranges::copy(unique_id, part.unique_id.begin());
    hear(message(Allocation::type, source, part.encode(), next()));
  }

  dronecan::TransferId next() {
    return static_cast<dronecan::TransferId>(id_++ % dronecan::transfer_id_modulus);
  }

  Roster roster;
  Time now{1000s};

 private:
  unsigned id_ = 0;
  dronecan::Receiver receiver_{
      256,
      dronecan::anonymous,
      {.transfer = [this](const dronecan::Transfer& transfer) { roster.receive(transfer); },
       .error = {},
       .signature = [](Kind kind, std::uint16_t type_id) -> std::optional<std::uint64_t> {
         const auto* type = dronecan::find_type(kind, type_id);
         return type != nullptr ? std::optional(type->signature) : std::nullopt;
       }}};
};

Member servo_at(std::uint8_t id) {
  Member servo;
  servo.id = NodeId(id);
  return servo;
}

std::vector<std::uint8_t> unit(std::uint8_t number, std::size_t size) {
  std::vector<std::uint8_t> id(size, 0xEE);
  id.front() = number;
  return id;
}

} // namespace

TEST_CASE("a node becomes a member by any frame of it, and is announced once") {
  Ear ear;
  std::vector<std::uint8_t> announced;
  ear.roster.on_new_unit([&](Member& member) { announced.push_back(member.id.value()); });
  ear.status(10, 0);
  const Time first = ear.now;
  ear.now += 1s;
  ear.status(10, 1);
  ear.hear(service(Kind::response, GetSet::type, 11, 50, GetSet::Response{}.encode()));
  CHECK(announced == std::vector<std::uint8_t>{10, 11});
  REQUIRE(ear.roster.find(NodeId(10)) != nullptr);
  CHECK(ear.roster.find(NodeId(10))->first_heard == first);
  CHECK(ear.roster.find(NodeId(10))->last_heard == ear.now);
  CHECK(ear.roster.find(NodeId(10))->status == NodeStatus{.uptime_s = 1});
  CHECK(ear.roster.heard(NodeId(10)));
}

TEST_CASE("who was only asked for is no node that was heard") {
  Ear ear;
  bool announced = false;
  ear.roster.on_new_unit([&](Member&) { announced = true; });
  CHECK(ear.roster.find(NodeId(10)) == nullptr);
  CHECK(ear.roster.member(NodeId(10)).id == NodeId(10));
  CHECK_FALSE(ear.roster.heard(NodeId(10)));
  CHECK_FALSE(announced);
  ear.status(10, 0);
  CHECK(announced);
}

TEST_CASE("we ourselves, nodes without an ID and other traffic are no members") {
  Ear ear;
  ear.status(127, 0);
  ear.allocation(0, unit(1, 6), true);
  ear.roster.hear({.id = 0x55, .extended = false, .size = 1, .data = {0xC0}}, ear.now);
  ear.roster.hear({.id = 0x1001550A, .remote = true, .size = 1, .data = {0xC0}}, ear.now);
  ear.roster.hear({.id = 0x1001550A, .size = 0}, ear.now);
  CHECK(ear.roster.members().empty());
}

TEST_CASE("a servo tells its servo ID in actuator.Status") {
  Ear ear;
  ear.status(10, 0);
  ear.actuator(11, 7);
  CHECK_FALSE(ear.roster.find(NodeId(10))->sends_actuator_status());
  CHECK(ear.roster.find(NodeId(11))->actuator_id == 7);
}

TEST_CASE("two servos with one ID show by the rate of actuator.Status") {
  Ear ear;
  for (int i = 0; i < 10; ++i) {
    ear.actuator(10);
    ear.now += 40ms;
    ear.actuator(10);
    ear.now += 60ms;
  }
  CHECK(ear.roster.is_doubled(NodeId(10)));
  CHECK(ear.roster.doubled() == std::set{NodeId(10)});
  CHECK_FALSE(ear.roster.is_doubled(NodeId(11)));
}

TEST_CASE("one servo is not doubled, whatever delays its status has, for hours") {
  Ear ear;
  sim::Random random(5);
  const Time begin = ear.now;
  for (int i = 0; i < 72'000; ++i) {
    ear.now = begin + i * 100ms + random.between(0ms, 90ms);
    ear.actuator(10);
  }
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("an actuator of another make may send its status as fast as it likes") {
  Ear ear;
  for (int i = 0; i < 100; ++i) {
    ear.actuator(10);
    ear.now += 20ms;
  }
  CHECK(ear.roster.is_doubled(NodeId(10))); // it may be two servos, as far as known
  ear.roster.member(NodeId(10)).identified = true;
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
  CHECK(ear.roster.doubled().empty());
  ear.roster.member(NodeId(10)).is_servo = true;
  CHECK(ear.roster.is_doubled(NodeId(10)));
  CHECK(ear.roster.doubled() == std::set{NodeId(10)});
}

TEST_CASE("two nodes with one ID show by uptimes that interleave") {
  Ear ear;
  ear.status(10, 100);
  ear.now += 300ms;
  ear.status(10, 5);
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10))); // it may have restarted
  ear.now += 700ms;
  ear.status(10, 101);
  CHECK(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("restarts are counted and are no doubled ID") {
  Ear ear;
  for (std::uint32_t run = 0; run < 20; ++run) {
    for (std::uint32_t uptime = 0; uptime < 5 + run; ++uptime) {
      ear.status(10, uptime);
      ear.now += 1s;
    }
    CHECK(ear.roster.find(NodeId(10))->boots == run);
  }
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("a servo that restarts right after its start restarted all the same") {
  Ear ear;
  ear.status(10, 0);
  ear.now += 1s;
  ear.status(10, 1);
  ear.now += 200ms;
  ear.status(10, 0);
  CHECK(ear.roster.find(NodeId(10))->boots == 1);
  for (std::uint32_t uptime = 1; uptime < 100; ++uptime) {
    ear.now += 1s;
    ear.status(10, uptime);
  }
  CHECK(ear.roster.find(NodeId(10))->boots == 1);
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("a clock that drifts for hours is neither a restart nor a second unit") {
  const auto period = GENERATE(995ms, 1s, 1005ms); // ten times as bad as a ceramic resonator
  Ear ear;
  const Time begin = ear.now;
  for (std::uint32_t uptime = 0; uptime < 36'000; ++uptime) {
    ear.now = begin + uptime * Duration(period);
    ear.status(10, uptime);
  }
  CHECK(ear.roster.find(NodeId(10))->boots == 0);
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("an uptime that is cut to seconds here and there is no restart") {
  Ear ear;
  const Time begin = ear.now;
  sim::Random random(3);
  for (int i = 0; i < 10'000; ++i) {
    const Duration at = i * 1s + random.between(0ms, 60ms); // a status may be late
    ear.now = begin + at;
    ear.status(10, static_cast<std::uint32_t>((at + 970ms) / 1s));
  }
  CHECK(ear.roster.find(NodeId(10))->boots == 0);
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("the uptime of GetNodeInfo counts: a restart before the first NodeStatus shows") {
  Ear ear;
  GetNodeInfo::Response info;
  info.status.uptime_s = 500;
  ear.hear(service(Kind::response, GetNodeInfo::type, 10, 127, info.encode()));
  ear.now += 800ms;
  ear.status(10, 0);
  CHECK(ear.roster.find(NodeId(10))->boots == 1);
}

TEST_CASE("an answer that was under way for long is no restart") {
  Ear ear;
  ear.status(10, 9);
  ear.now += 1s;
  ear.status(10, 10);
  GetNodeInfo::Response info;
  info.status.uptime_s = 9;
  ear.now += 150ms;
  ear.hear(service(Kind::response, GetNodeInfo::type, 10, 127, info.encode()));
  CHECK(ear.roster.find(NodeId(10))->boots == 0);
}

TEST_CASE("who asks for a node ID is pending until it has one") {
  Ear ear;
  ear.allocation(0, unit(1, 6), true);
  ear.allocation(0, unit(2, 6), true);
  ear.allocation(0, unit(1, 6), true); // asks again: still one
  CHECK(ear.roster.pending() == std::set{unit(1, 6), unit(2, 6)});
  CHECK(ear.roster.allocators().empty());
  ear.allocation(126, unit(1, 6));
  CHECK(ear.roster.pending().size() == 2); // not settled
  ear.allocation(0, unit(1, 6));           // the second part is no request of its own
  ear.allocation(126, unit(1, 16), false, 0);
  CHECK(ear.roster.pending().size() == 2); // all of the unique ID, but no node ID
  ear.allocation(126, unit(1, 16), false, 125);
  CHECK(ear.roster.pending() == std::set{unit(2, 6)});
  CHECK(ear.roster.allocators() == std::set{NodeId(126)});
}

TEST_CASE("our own allocator is no other allocator") {
  Ear ear;
  ear.allocation(127, unit(1, 6));
  CHECK(ear.roster.allocators().empty());
}

TEST_CASE("an ArrayCommand drives the servos it names for two seconds") {
  Ear ear;
  Member servo = servo_at(10);
  servo.servo_id = 3;
  CHECK_FALSE(ear.roster.driver_of(servo, ear.now));
  ear.command(30, {1, 2});
  CHECK_FALSE(ear.roster.driver_of(servo, ear.now));
  ear.command(30, {1, 3});
  CHECK(ear.roster.driver_of(servo, ear.now) == NodeId(30));
  CHECK(ear.roster.driver_of(servo, ear.now + 2s) == NodeId(30));
  CHECK_FALSE(ear.roster.driver_of(servo, ear.now + 2s + 1us));
  CHECK(ear.roster.commanders().at(NodeId(30)).servo_ids.size() == 3);
}

TEST_CASE("actuator ID 255 means every servo, also one whose servo ID is not known") {
  Ear ear;
  Member unknown = servo_at(10);
  ear.command(30, {1});
  CHECK_FALSE(ear.roster.driver_of(unknown, ear.now));
  ear.command(30, {255});
  CHECK(ear.roster.driver_of(unknown, ear.now) == NodeId(30));
}

TEST_CASE("a servo that was not read yet is driven by the servo ID that it broadcasts") {
  Ear ear;
  ear.actuator(10, 4);
  ear.command(30, {4});
  CHECK(ear.roster.driver_of(*ear.roster.find(NodeId(10)), ear.now) == NodeId(30));
}

TEST_CASE("a write to 0x00-0x02 of a node drives that node, by name and by index") {
  const Member servo = servo_at(10);
  const Member other = servo_at(11);
  const auto name = GENERATE(as<std::string>{}, "0x00", "0x01", "0x02", "");
  Ear ear;
  ear.get_set(30, 10, {.index = 2, .value = std::int64_t{100}, .name = name});
  CHECK(ear.roster.driver_of(servo, ear.now) == NodeId(30));
  CHECK_FALSE(ear.roster.driver_of(other, ear.now));
  CHECK_FALSE(ear.roster.driver_of(servo, ear.now + 2s + 1us));
}

TEST_CASE("reading 0x00 and writing other registers drives nobody") {
  const Member servo = servo_at(10);
  Ear ear;
  ear.get_set(30, 10, {.index = 0, .value = {}, .name = "0x00"});
  ear.get_set(30, 10, {.index = 0, .value = {}, .name = ""});
  ear.get_set(30, 10, {.index = 0, .value = std::int64_t{1}, .name = "0x38"}); // a name wins
  ear.get_set(30, 10, {.index = 0x38, .value = std::int64_t{1}, .name = ""});
  CHECK(ear.roster.commanders().empty());
  CHECK_FALSE(ear.roster.driver_of(servo, ear.now));
}

TEST_CASE("what we command ourselves is not another node's doing") {
  Ear ear;
  ear.command(127, {255});
  ear.get_set(127, 10, {.index = 0, .value = std::int64_t{100}, .name = "0x00"});
  ear.arming(127, 255);
  CHECK(ear.roster.commanders().empty());
  CHECK_FALSE(ear.roster.armed_by());
}

TEST_CASE("armed is armed until the same node says otherwise") {
  Ear ear;
  CHECK_FALSE(ear.roster.armed_by());
  ear.arming(30, ArmingStatus::fully_armed);
  CHECK(ear.roster.armed_by() == NodeId(30));
  ear.arming(31, ArmingStatus::disarmed); // another one does not disarm it
  CHECK(ear.roster.armed_by() == NodeId(30));
  ear.arming(30, 1); // not fully, but not disarmed either
  CHECK(ear.roster.armed_by() == NodeId(30));
  ear.arming(30, ArmingStatus::disarmed);
  CHECK_FALSE(ear.roster.armed_by());
}

TEST_CASE("a flood from every node ID leaves bounded tables") {
  Ear ear;
  sim::Random random(9);
  for (int i = 0; i < 50'000; ++i) {
    const auto chance = random.next();
    const auto source = static_cast<std::uint8_t>(chance % 128);
    const auto byte = static_cast<std::uint8_t>(chance >> 8U);
    std::vector<std::uint8_t> id(6);
    std::ranges::generate(id, [&] { return static_cast<std::uint8_t>(random.next()); });
    switch (chance >> 32U & 3U) {
    case 0: ear.allocation(0, id, true); break;
    case 1: ear.allocation(source, id); break;
    case 2: ear.command(source == 0 ? 1 : source, {byte}); break;
    default:
      ear.get_set(1 + source % 60, 61 + byte % 60,
                  {.index = 0, .value = std::int64_t{1}, .name = "0x00"});
    }
    ear.now += 1ms;
  }
  CHECK(ear.roster.members().size() <= 127);
  CHECK(ear.roster.pending().size() <= 256);
  CHECK(ear.roster.allocators().size() <= 127);
  CHECK(ear.roster.commanders().size() <= 127);
  for (const auto& [source, commander] : ear.roster.commanders()) {
    CHECK(commander.servo_ids.size() <= 256);
    CHECK(commander.nodes.size() <= 127);
  }
}

TEST_CASE("payloads of any bytes are heard without harm") {
  Ear ear;
  sim::Random random(11);
  for (int i = 0; i < 20'000; ++i) {
    can::Frame frame{.id = static_cast<std::uint32_t>(random.next()) & can::extended_id_mask,
                     .size = static_cast<std::uint8_t>(random.next() % 9)};
    std::ranges::generate(frame.data, [&] { return static_cast<std::uint8_t>(random.next()); });
    ear.hear({frame});
    ear.now += 100us;
  }
  CHECK(ear.roster.members().size() <= 127);
}
