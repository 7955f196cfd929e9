#include "blactl/fleet/bus/roster.hpp"
#include "blactl/sim/node/random.hpp"

#include "support.hpp"

#include <algorithm>
#include <functional>
#include <optional>
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
  explicit Ear(NodeId local = NodeId(127)) : roster(local, profiles()) {}

  void hear(const std::vector<can::Frame>& frames) {
    for (const auto& frame : frames) {
      roster.hear(frame, now);
      receiver_.receive(frame, now);
    }
  }

  void status(std::uint8_t source, std::uint32_t uptime_s) {
    hear(message(NodeStatus::type, source, NodeStatus{.uptime_s = uptime_s}.encode(), next()));
  }

  /// With this priority.
  void status_at(unsigned priority, std::uint8_t source, std::uint32_t uptime_s) {
    auto frames = message(NodeStatus::type, source, NodeStatus{.uptime_s = uptime_s}.encode(), 0);
    for (can::Frame& frame : frames) {
      frame.id = (frame.id & 0xFF'FFFFU) | priority << 24U;
    }
    hear(frames);
  }

  /// With this transfer ID.
  void status(std::uint8_t source, std::uint32_t uptime_s, dronecan::TransferId id) {
    hear(message(NodeStatus::type, source, NodeStatus{.uptime_s = uptime_s}.encode(), id));
  }

  void actuator(std::uint8_t source, std::uint8_t servo_id = 0) {
    actuator_of(actuators_, source, servo_id);
  }

  /// One is lost on its way.
  void lose_actuator() { ++actuators_; }

  /// The last one comes twice.
  void actuator_again(std::uint8_t source) {
    --actuators_;
    actuator(source);
  }

  /// Of a second unit, which counts its transfers by itself.
  void twin(std::uint8_t source) { actuator_of(twins_, source, 0); }

  /// Two units, `gap` apart, and then a rest.
  void both(std::uint8_t source, int times, Duration gap, Duration rest) {
    for (int i = 0; i < times; ++i) {
      actuator(source);
      now += gap;
      twin(source);
      now += rest;
    }
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

  void ask_info(std::uint8_t client, std::uint8_t server, dronecan::TransferId id) {
    for (const auto& frame : service(Kind::request, GetNodeInfo::type, client, server, {}, id)) {
      client == roster.local().value() ? roster.hear_own(frame, now) : roster.hear(frame, now);
    }
  }

  /// The answer of a unit to GetNodeInfo.
  void info(std::uint8_t source, std::uint8_t unit, std::uint32_t uptime_s, dronecan::TransferId id,
            std::uint8_t client = 127) {
    const GetNodeInfo::Response response{
        .status = {.uptime_s = uptime_s}, .unique_id = {unit}, .name = "servo"};
    hear(service(Kind::response, GetNodeInfo::type, source, client, response.encode(), id));
  }

  dronecan::TransferId next() {
    return static_cast<dronecan::TransferId>(id_++ % dronecan::transfer_id_modulus);
  }

  Roster roster;
  Time now{1000s};

 private:
  void actuator_of(dronecan::TransferId& counter, std::uint8_t source, std::uint8_t servo_id) {
    const auto id = static_cast<dronecan::TransferId>(counter++ % dronecan::transfer_id_modulus);
    hear(message(ActuatorStatus::type, source, ActuatorStatus{.actuator_id = servo_id}.encode(),
                 id));
  }

  dronecan::TransferId actuators_ = 0;
  dronecan::TransferId twins_ = 0;

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

Servo servo_at(std::uint8_t id) {
  return {.id = NodeId(id)};
}

/// Writes down who is announced.
class Witness final : public Roster::Listener {
 public:
  explicit Witness(Roster& roster) : roster_(roster) { roster.add(*this); }

  ~Witness() override { roster_.remove(*this); }

  void on_new_unit(const Member& member) override {
    announced.push_back(member.id.value());
    if (reaction) {
      reaction();
    }
  }

  std::vector<int> announced;
  std::function<void()> reaction;

 private:
  Roster& roster_;
};

std::vector<std::uint8_t> unit(std::uint8_t number, std::size_t size) {
  std::vector<std::uint8_t> id(size, 0xEE);
  id.front() = number;
  return id;
}

} // namespace

TEST_CASE("a node becomes a member by any frame of it, and is announced once") {
  Ear ear;
  const Witness witness(ear.roster);
  ear.status(10, 0);
  const Time first = ear.now;
  ear.now += 1s;
  ear.status(10, 1);
  ear.hear(service(Kind::response, GetSet::type, 11, 50, GetSet::Response{}.encode()));
  CHECK(witness.announced == std::vector{10, 11});
  REQUIRE(ear.roster.find(NodeId(10)) != nullptr);
  CHECK(ear.roster.find(NodeId(10))->first_heard == first);
  CHECK(ear.roster.find(NodeId(10))->last_heard == ear.now);
  CHECK(ear.roster.find(NodeId(10))->status == NodeStatus{.uptime_s = 1});
  CHECK(ear.roster.heard(NodeId(10)));
}

TEST_CASE("what was heard last is a frame of another node, however much later it is now") {
  Ear ear;
  CHECK(ear.roster.last_heard() == Time{});
  ear.now = Time{3s};
  ear.status(12, 3);
  ear.now = Time{2s};
  ear.status(11, 2);
  ear.now = Time{9s};
  CHECK(ear.roster.last_heard() == Time{3s});
}

TEST_CASE("who was only asked for is no node that was heard") {
  Ear ear;
  const Witness witness(ear.roster);
  CHECK(ear.roster.find(NodeId(10)) == nullptr);
  CHECK(ear.roster.member(NodeId(10)).id == NodeId(10));
  CHECK_FALSE(ear.roster.heard(NodeId(10)));
  CHECK(ear.roster.members().empty());
  CHECK(witness.announced.empty());
  ear.status(10, 0);
  CHECK(witness.announced == std::vector{10});
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
  ear.both(10, 10, 40ms, 60ms);
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

TEST_CASE("one servo whose frames come twice is no second servo") {
  Ear ear;
  sim::Random random(7);
  for (int i = 0; i < 2'000; ++i) {
    ear.actuator(10);
    const Duration gap = random.between(100us, 900us);
    if (i % 2 == 0) {
      ear.now += gap;
      ear.actuator_again(10);
    }
    ear.now += 95ms - gap;
  }
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("what a servo that was alone on the bus could not send is no second servo") {
  const int waiting = GENERATE(3, 10, 60);
  Ear ear;
  for (int i = 0; i < waiting; ++i) {
    ear.actuator(10);
    ear.now += 250us;
  }
  for (int i = 0; i < 30; ++i) {
    ear.actuator(10);
    ear.now += 100ms;
  }
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("two servos show whatever their counters have in common") {
  const int ahead = GENERATE(0, 1, 2, 31);
  Ear ear;
  for (int i = 0; i < ahead; ++i) {
    ear.actuator(10);
    ear.now += 100ms;
  }
  ear.both(10, 10, 20ms, 80ms);
  CHECK(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("a shared ID counts as shared until nothing has shown it for a time") {
  Ear ear;
  ear.both(10, 10, 40ms, 60ms);
  const Time last = ear.now;
  const unsigned boots = ear.roster.find(NodeId(10))->boots;
  ear.roster.forget_doubled(last - 1s);
  CHECK(ear.roster.is_doubled(NodeId(10)));
  ear.roster.forget_doubled(last + 1ms);
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
  CHECK(ear.roster.doubled().empty());
  CHECK(ear.roster.find(NodeId(10))->boots == boots + 1); // who is left has to be identified
}

TEST_CASE("an actuator of another make may send its status as fast as it likes") {
  Ear ear;
  ear.both(10, 50, 20ms, 20ms);
  CHECK(ear.roster.is_doubled(NodeId(10))); // it may be two servos, as far as known
  ear.roster.learn(servo_at(10), std::nullopt);
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
  CHECK(ear.roster.doubled().empty());
  ear.roster.learn({.id = NodeId(10), .is_servo = true}, std::nullopt);
  CHECK(ear.roster.is_doubled(NodeId(10)));
  CHECK(ear.roster.doubled() == std::set{NodeId(10)});
}

TEST_CASE("a node whose status waited for a bus that was full is no second node") {
  const auto waited = GENERATE(1600ms, 2500ms, 3400ms, 8700ms);
  Ear ear;
  const Time begin = ear.now;
  std::uint32_t uptime = 0;
  const auto rest_until = [&](Time end) {
    for (; begin + uptime * 1s < end; ++uptime) {
      ear.now = std::max(ear.now, begin + uptime * 1s);
      ear.status(10, uptime);
    }
  };
  rest_until(begin + 5s);
  ear.now = begin + 5s + waited; // nothing got through, and now all of it does
  while (begin + uptime * 1s <= ear.now) {
    ear.status(10, uptime++);
    ear.now += 1ms;
  }
  rest_until(begin + 30s);
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("two nodes with one ID show even where the first was silent for a while") {
  Ear ear;
  ear.status(10, 20);
  ear.now += 30s;
  ear.status(10, 40); // another one, or the first after a restart
  for (std::uint32_t i = 0; i < 3; ++i) {
    ear.now += 500ms;
    ear.status(10, 51 + i);
    ear.now += 500ms;
    ear.status(10, 41 + i);
  }
  CHECK(ear.roster.is_doubled(NodeId(10)));
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

TEST_CASE("restarts are counted and are no doubled ID", "[requirement-25]") {
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

TEST_CASE("who is younger than a silence has restarted; who is as old as before it has not",
          "[requirement-25]") {
  const auto [uptime, boots] = GENERATE(std::pair(165U, 0U), std::pair(120U, 1U));
  Ear ear;
  ear.status(10, 105);
  ear.now += 60s;
  ear.status(10, uptime); // not less than before, in either case
  CHECK(ear.roster.find(NodeId(10))->boots == boots);
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

TEST_CASE("a servo that restarts about once a second, always at an uptime of 0, restarts") {
  const auto period = GENERATE(800ms, 1s, 1200ms, 1400ms);
  Ear ear;
  for (int run = 0; run < 5; ++run) {
    ear.status(10, 0);
    ear.now += period;
  }
  CHECK(ear.roster.find(NodeId(10))->boots > 0);
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("start times that are close to each other are those of one servo") {
  Ear ear;
  ear.status(10, 0);
  ear.now += 2050ms; // it restarted a second ago
  GetNodeInfo::Response info;
  ear.hear(service(Kind::response, GetNodeInfo::type, 10, 127, info.encode()));
  CHECK(ear.roster.find(NodeId(10))->boots == 1);
  ear.now += 200ms;
  ear.status(10, 1);
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

TEST_CASE(
    "two units whose transfer IDs are in step are two, and a repeated frame is no second unit") {
  Ear ear;
  const bool is_two = GENERATE(true, false);
  for (std::uint32_t second = 0; second < 3; ++second) {
    const auto id = static_cast<dronecan::TransferId>(second);
    ear.status(10, 100 + second, id);
    ear.now += 1ms; // as soon as the bus is free
    ear.status(10, (is_two ? 130 : 100) + second, id);
    ear.now += 999ms;
  }
  CHECK(ear.roster.is_doubled(NodeId(10)) == is_two);
  CHECK((ear.roster.member(NodeId(10)).boots == 0) == !is_two);
}

TEST_CASE("one servo whose waiting frames come at once, some of them lost, is one") {
  Ear ear;
  const int every = GENERATE(2, 3, 4); // one of so many is lost
  for (int i = 0; i < 60; ++i) {
    i % every == 0 ? ear.lose_actuator() : ear.actuator(10);
    ear.now += 1ms;
  }
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("one servo that starts three times in its first second is one") {
  Ear ear;
  for (const auto& [pause, uptime] :
       {std::pair(0ms, 0), {227ms, 0}, {545ms, 0}, {1000ms, 1}, {1000ms, 2}}) {
    ear.now += pause;
    ear.status(10, static_cast<std::uint32_t>(uptime), static_cast<dronecan::TransferId>(uptime));
  }
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("two units are two however far apart their transfer IDs are") {
  Ear ear;
  const int ahead = GENERATE(range(0, 32));
  for (int i = 0; i < ahead; ++i) {
    ear.lose_actuator();
  }
  ear.both(10, 20, 40ms, 60ms);
  CHECK(ear.roster.is_doubled(NodeId(10)));
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

TEST_CASE("a late response with an old uptime is no second unit, whoever asked") {
  const auto client = GENERATE(std::uint8_t{126}, std::uint8_t{127});
  Ear ear;
  ear.status(47, 0);
  ear.now += 700ms;
  ear.ask_info(client, 47, 3);
  ear.now += 300ms;
  ear.status(47, 1);
  ear.now += 1s;
  ear.status(47, 2);
  ear.now += 200ms;
  ear.info(47, 1, 0, 3, client); // 1.5 s late
  ear.now += 800ms;
  ear.status(47, 3);
  CHECK_FALSE(ear.roster.is_doubled(NodeId(47)));
  CHECK(ear.roster.member(NodeId(47)).boots == 0);
}

TEST_CASE("a restart right after another shows where a response told the older age between them") {
  Ear ear;
  ear.status(47, 0); // it runs for almost a second already
  ear.now += 1s;
  ear.status(47, 1);
  ear.now += 50ms;
  ear.ask_info(127, 47, 3);
  ear.info(47, 2, 0, 3);
  ear.now += 1250ms; // restarted at once, and heard again only when it is a second old
  ear.status(47, 1);
  CHECK(ear.roster.member(NodeId(47)).boots == 1);
}

TEST_CASE("two units that were switched on together show by twice as many NodeStatus") {
  const auto first_of_other =
      GENERATE(std::uint8_t{0}, std::uint8_t{7}); // it may number others, too
  Ear ear;
  for (std::uint8_t second = 0; second < 4; ++second) {
    ear.status(47, second, second);
    ear.now += 300ms;
    ear.status(47, second, static_cast<std::uint8_t>(second + first_of_other));
    ear.now += 700ms;
  }
  CHECK(ear.roster.is_doubled(NodeId(47)));
}

TEST_CASE("two units that were switched on together show by their priorities of NodeStatus") {
  constexpr unsigned mine = 16, other = 20;
  Ear ear;
  ear.status_at(mine, 10, 0);
  ear.now += 700ms;
  ear.status_at(other, 10, 0);
  SECTION("as soon as the first one is heard again") {
    CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
    ear.now += 300ms;
    ear.status_at(mine, 10, 1);
    CHECK(ear.roster.is_doubled(NodeId(10)));
  }
  SECTION("one that has another program since its restart is one") {
    for (std::uint32_t uptime_s = 1; uptime_s < 5; ++uptime_s) {
      ear.now += 1s;
      ear.status_at(other, 10, uptime_s);
    }
    ear.now += 1s;
    ear.status_at(mine, 10, 0);
    ear.now += 1s;
    ear.status_at(mine, 10, 1);
    CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
  }
}

TEST_CASE("neither a fast NodeStatus, nor lost ones, nor restarts show a second unit") {
  Ear ear;
  for (std::uint8_t i = 0; i < 30; ++i) { // five a second
    ear.status(46, i / 5U, i);
    ear.now += 200ms;
  }
  for (std::uint8_t i = 0; i < 10; ++i) {
    ear.status(48, i % 2, i % 2); // restarts as soon as it runs
    ear.now += i % 2 == 0 ? 1s : 500ms;
  }
  for (std::uint8_t i = 0; i < 20; i += 2) {
    ear.status(47, i, i);                              // every second one is lost
    ear.now += i < 10 ? Duration(2s) : Duration(10ms); // and the rest was read late
  }
  for (const std::uint8_t id : {std::uint8_t{46}, std::uint8_t{47}, std::uint8_t{48}}) {
    INFO(+id);
    CHECK_FALSE(ear.roster.is_doubled(NodeId(id)));
  }
}

TEST_CASE("a prompt response with an old uptime is of a unit that has restarted") {
  Ear ear;
  ear.status(47, 3);
  ear.now += 500ms;
  ear.ask_info(127, 47, 3);
  ear.now += 10ms;
  ear.info(47, 1, 0, 3);
  CHECK(ear.roster.member(NodeId(47)).boots == 1);
}

TEST_CASE("who asks for a node ID is pending until it has one") {
  Ear ear;
  ear.allocation(0, unit(1, 6), true);
  ear.allocation(0, unit(2, 6), true);
  ear.allocation(0, unit(1, 6), true); // asks again: still one
  CHECK(std::ranges::equal(ear.roster.pending(), std::set{unit(1, 6), unit(2, 6)}));
  CHECK(ear.roster.allocators().empty());
  ear.allocation(126, unit(1, 6));
  CHECK(ear.roster.pending().size() == 2); // not settled
  ear.allocation(0, unit(1, 6));           // the second part is no request of its own
  ear.allocation(126, unit(1, 16), false, 0);
  CHECK(ear.roster.pending().size() == 2); // all of the unique ID, but no node ID
  ear.allocation(126, unit(1, 16), false, 125);
  CHECK(std::ranges::equal(ear.roster.pending(), std::set{unit(2, 6)}));
  CHECK(ear.roster.allocators() == std::set{NodeId(126)});
}

TEST_CASE("who has gone is forgotten: another unit on that ID is no second one") {
  Ear ear;
  ear.status(11, 100);
  ear.status(12, 100);
  ear.hear(message(Allocation::type, 126, Allocation{.node_id = 12}.encode()));
  ear.now += 4s;
  ear.status(12, 104);
  ear.roster.forget_gone(ear.now - 3s);
  CHECK(ear.roster.find(NodeId(11)) == nullptr);
  CHECK_FALSE(ear.roster.heard(NodeId(11)));
  CHECK(ear.roster.find(NodeId(12)) != nullptr);
  CHECK(ear.roster.allocators().empty());
  ear.status(11, 3);
  ear.now += 1s;
  ear.status(11, 4);
  CHECK_FALSE(ear.roster.is_doubled(NodeId(11)));
  CHECK(ear.roster.member(NodeId(11)).boots == 0);
}

TEST_CASE("our own allocator is no other allocator") {
  Ear ear;
  ear.allocation(127, unit(1, 6));
  CHECK(ear.roster.allocators().empty());
}

TEST_CASE("an ArrayCommand drives the servos it names for two seconds") {
  Ear ear;
  const Servo servo{.id = NodeId(10), .servo_id = 3};
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
  const Servo unknown = servo_at(10);
  ear.command(30, {1});
  CHECK_FALSE(ear.roster.driver_of(unknown, ear.now));
  ear.command(30, {255});
  CHECK(ear.roster.driver_of(unknown, ear.now) == NodeId(30));
}

TEST_CASE("a servo that was not read yet is driven by the servo ID that it broadcasts") {
  Ear ear;
  ear.actuator(10, 4);
  ear.command(30, {4});
  CHECK(ear.roster.driver_of(servo_at(10), ear.now) == NodeId(30));
}

TEST_CASE("a write to 0x00-0x02 of a node drives that node, by name and by index") {
  const Servo servo = servo_at(10);
  const Servo other = servo_at(11);
  const auto name = GENERATE(as<std::string>{}, "0x00", "0x01", "0x02", "");
  Ear ear;
  ear.get_set(30, 10, {.index = 2, .value = std::int64_t{100}, .name = name});
  CHECK(ear.roster.driver_of(servo, ear.now) == NodeId(30));
  CHECK_FALSE(ear.roster.driver_of(other, ear.now));
  CHECK_FALSE(ear.roster.driver_of(servo, ear.now + 2s + 1us));
}

TEST_CASE("reading 0x00 and writing other registers drives nobody") {
  const Servo servo = servo_at(10);
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
  CHECK_FALSE(ear.roster.said_armed());
}

TEST_CASE("armed is armed until the same node says otherwise") {
  Ear ear;
  const auto armed_by = [&] { return ear.roster.armed_by(ear.now); };
  CHECK_FALSE(armed_by());
  ear.arming(30, ArmingStatus::fully_armed);
  CHECK(armed_by() == NodeId(30));
  ear.arming(31, ArmingStatus::disarmed); // another one does not disarm it
  CHECK(armed_by() == NodeId(30));
  ear.arming(30, 1); // not fully, but not disarmed either
  CHECK(armed_by() == NodeId(30));
  ear.arming(30, ArmingStatus::disarmed);
  CHECK_FALSE(armed_by());
  CHECK_FALSE(ear.roster.said_armed());
}

TEST_CASE("an ArmingStatus out of turn is no shorter period") {
  Ear ear;
  ear.arming(30, ArmingStatus::fully_armed);
  ear.now += 200ms;
  ear.arming(30, ArmingStatus::fully_armed);
  CHECK(ear.roster.armed_by(ear.now + 3s));
  ear.now += 3s;
  ear.arming(30, ArmingStatus::fully_armed);
  ear.now += 200ms;
  ear.arming(30, ArmingStatus::fully_armed);
  CHECK(ear.roster.armed_by(ear.now + 8s));
}

TEST_CASE("ERASE, a restart and 0x10 of another node write every register; SAVE does not") {
  const dronecan::Payload one = GetSet::Request{.value = std::int64_t{1}, .name = "0x10"}.encode();
  const dronecan::Payload reboot =
      GetSet::Request{.value = std::int64_t{1}, .name = "0x11"}.encode();
  using dronecan::ExecuteOpcode;
  const std::pair<const dronecan::DataType*, dronecan::Payload> orders[]{
      {&ExecuteOpcode::type, ExecuteOpcode::Request{.opcode = ExecuteOpcode::erase}.encode()},
      {&dronecan::RestartNode::type, dronecan::RestartNode::Request{}.encode()},
      {&GetSet::type, one},
      {&GetSet::type, reboot}};
  for (const auto& [type, payload] : orders) {
    Ear ear;
    const Time before = ear.now - 1us;
    ear.hear(service(Kind::request, *type, 90, 11, payload));
    CHECK(ear.roster.writer_to(NodeId(11), before, bla::Address(0x38)) == NodeId(90));
    CHECK_FALSE(ear.roster.writer_to(NodeId(12), before));
    CHECK_FALSE(ear.roster.saver_of(NodeId(11), before));
  }
  Ear ear;
  const Time before = ear.now - 1us;
  ear.hear(service(Kind::request, ExecuteOpcode::type, 90, 11, ExecuteOpcode::Request{}.encode()));
  CHECK_FALSE(ear.roster.writer_to(NodeId(11), before));
  CHECK(ear.roster.saver_of(NodeId(11), before) == NodeId(90));
  CHECK_FALSE(ear.roster.saver_of(NodeId(11), ear.now));
}

TEST_CASE("what was heard counts for three periods of its sender, at least 2 s, at most 10 s") {
  Ear ear;
  const auto [period, lasts] = GENERATE(std::pair(100ms, 2000ms), std::pair(1000ms, 3000ms),
                                        std::pair(3000ms, 9000ms), std::pair(60000ms, 10000ms));
  ear.arming(30, ArmingStatus::fully_armed);
  ear.command(30, {3});
  CHECK(ear.roster.armed_by(ear.now + 10s)); // its period is not known yet
  for (int i = 0; i < 2; ++i) {
    ear.now += period;
    ear.arming(30, ArmingStatus::fully_armed);
    ear.command(30, {3});
  }
  const Servo servo{.id = NodeId(10), .servo_id = 3};
  CHECK(ear.roster.armed_by(ear.now + lasts) == NodeId(30));
  CHECK_FALSE(ear.roster.armed_by(ear.now + lasts + 1us));
  CHECK(ear.roster.said_armed() == NodeId(30));
  CHECK(ear.roster.driver_of(servo, ear.now + lasts) == NodeId(30));
  CHECK_FALSE(ear.roster.driver_of(servo, ear.now + lasts + 1us));
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
  CHECK(ear.roster.pending().size() <= 1024);
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

TEST_CASE("a unit that restarts is announced again, as often as it does") {
  Ear ear;
  const Witness witness(ear.roster);
  ear.status(10, 100);
  ear.now += 10s;
  ear.status(10, 110);
  CHECK(witness.announced == std::vector{10});
  ear.now += 10s;
  ear.status(10, 1);
  ear.now += 10s;
  ear.status(10, 1);
  CHECK(witness.announced == std::vector{10, 10, 10});
}

TEST_CASE("every listener is told, in the order in which they came, until it leaves") {
  Ear ear;
  std::vector<int> order;
  Witness first(ear.roster);
  first.reaction = [&] { order.push_back(1); };
  {
    Witness second(ear.roster);
    second.reaction = [&] { order.push_back(2); };
    ear.status(10, 0);
    CHECK(order == std::vector{1, 2});
  }
  ear.status(11, 0);
  CHECK(order == std::vector{1, 2, 1});
}

TEST_CASE("a listener that leaves in its call does not keep the others from being told") {
  Ear ear;
  Witness first(ear.roster);
  const Witness second(ear.roster);
  first.reaction = [&] { ear.roster.remove(first); };
  ear.status(10, 0);
  ear.status(11, 0);
  CHECK(first.announced == std::vector{10});
  CHECK(second.announced == std::vector{10, 11});
}

TEST_CASE("a listener that another one sends away in its call is gone: it may live no more") {
  Ear ear;
  Witness first(ear.roster);
  std::optional<Witness> second;
  second.emplace(ear.roster);
  std::vector<int> told;
  second->reaction = [&] { told.push_back(2); };
  first.reaction = [&] { second.reset(); };
  ear.status(10, 0);
  CHECK(told.empty());
  CHECK(first.announced == std::vector{10});
}

TEST_CASE("a listener that comes in a call is told of the next unit") {
  Ear ear;
  Witness first(ear.roster);
  std::optional<Witness> second;
  first.reaction = [&] {
    if (!second) {
      second.emplace(ear.roster);
    }
  };
  ear.status(10, 0);
  REQUIRE(second);
  CHECK(second->announced.empty());
  ear.status(11, 0);
  CHECK(second->announced == std::vector{11});
}

TEST_CASE("what a node said before its restart is not taken for what it is now") {
  Ear ear;
  ear.status(10, 100);
  ear.roster.learn({.id = NodeId(10), .is_servo = true, .servo_id = 3, .static_node_id = 10},
                   GetNodeInfo::Response{.unique_id = {1}});
  CHECK(ear.roster.member(NodeId(10)).is_known());
  CHECK(ear.roster.member(NodeId(10)).is_unit({1}));
  ear.now += 10s;
  ear.status(10, 0);
  CHECK_FALSE(ear.roster.member(NodeId(10)).is_known());
  CHECK_FALSE(ear.roster.member(NodeId(10)).is_unit({1}));
  CHECK(ear.roster.member(NodeId(10)).servo().servo_id == 3); // the last that was heard of it
  ear.roster.learn(NodeId(10), GetNodeInfo::Response{.unique_id = {2}}, ear.now);
  CHECK(ear.roster.member(NodeId(10)).is_unit({2}));
  CHECK_FALSE(ear.roster.member(NodeId(10)).is_servo);
  CHECK_FALSE(ear.roster.member(NodeId(10)).servo_id);
}

TEST_CASE("two answers to one question show two units, which the receiver takes for one answer") {
  Ear ear;
  ear.info(10, 1, 100, 5);
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
  CHECK(ear.roster.units(NodeId(10)).empty());
  ear.now += 3ms;
  ear.info(10, 2, 100, 5);
  CHECK(ear.roster.is_doubled(NodeId(10)));
  CHECK(ear.roster.units(NodeId(10)) == std::set<dronecan::UniqueId>{{1}, {2}});
  CHECK(ear.roster.units(NodeId(11)).empty());
}

TEST_CASE("two values of what is set, in answers to one question, show two units") {
  Ear ear;
  const auto answer = [&ear](const char* name, std::int64_t value) {
    const GetSet::Response response{.value = value, .name = name};
    ear.hear(service(Kind::response, GetSet::type, 10, 127, response.encode(), 5));
    ear.now += 1ms;
  };
  SECTION("a setting") {
    answer("0x46", 10);
    CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
    answer("0x46", 11);
    CHECK(ear.roster.is_doubled(NodeId(10)));
  }
  SECTION("a measured value") {
    answer("0x08", 10);
    answer("0x08", 11);
    CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
  }
}

TEST_CASE("answers to different questions show two units as well, unless there was a restart") {
  Ear ear;
  ear.info(10, 1, 100, 5);
  ear.now += 10s;
  SECTION("no restart") {
    ear.info(10, 2, 110, 6);
    CHECK(ear.roster.is_doubled(NodeId(10)));
    CHECK(ear.roster.units(NodeId(10)) == std::set<dronecan::UniqueId>{{1}, {2}});
  }
  SECTION("another unit came in its place") {
    ear.info(10, 2, 3, 6);
    CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
    CHECK(ear.roster.member(NodeId(10)).boots == 1);
    CHECK(ear.roster.member(NodeId(10)).is_unit({2}));
  }
  SECTION("the same one") {
    ear.info(10, 1, 110, 6);
    CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
  }
}

TEST_CASE("the answer of another unit after a restart is no second answer to an old question") {
  Ear ear;
  ear.info(10, 1, 100, 5);
  ear.now += 1s;
  ear.status(10, 0);
  ear.now += 10ms;
  ear.info(10, 2, 0, 5); // the transfer IDs have gone round meanwhile
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("what a node answers of its status is news like its NodeStatus") {
  Ear ear;
  ear.status(10, 100);
  ear.now += 10ms;
  const GetNodeInfo::Response info{
      .status = {.uptime_s = 100, .mode = dronecan::Mode::software_update}, .unique_id = {1}};
  ear.hear(service(Kind::response, GetNodeInfo::type, 10, 127, info.encode()));
  REQUIRE(ear.roster.member(NodeId(10)).status);
  CHECK(ear.roster.member(NodeId(10)).status->mode == dronecan::Mode::software_update);
  ear.now += 10ms;
  ear.status(10, 100);
  CHECK(ear.roster.member(NodeId(10)).status->mode == dronecan::Mode::operational);
}

TEST_CASE("whoever asked, an answer tells which unit a node is") {
  Ear ear;
  const GetNodeInfo::Response response{.unique_id = {7}, .name = "servo"};
  ear.hear(service(Kind::response, GetNodeInfo::type, 10, 99, response.encode(), 5));
  CHECK(ear.roster.member(NodeId(10)).is_unit({7}));
  CHECK_FALSE(ear.roster.member(NodeId(10)).is_known());
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("doubled units without names stay without") {
  Ear ear;
  ear.status(10, 100);
  ear.now += 300ms;
  ear.status(10, 5);
  ear.now += 700ms;
  ear.status(10, 101);
  REQUIRE(ear.roster.is_doubled(NodeId(10)));
  CHECK(ear.roster.units(NodeId(10)).empty());
}

TEST_CASE("the statuses of a servo are counted from its first one, whenever it comes") {
  Ear ear;
  ear.now = Time{900ms}; // the clock has just started
  ear.both(10, 7, 71ms, 71ms);
  CHECK_FALSE(ear.roster.is_doubled(NodeId(10)));
  ear.actuator(10); // within the same second
  CHECK(ear.roster.is_doubled(NodeId(10)));
}

TEST_CASE("a servo that was recognised after a restart is known as before") {
  Acquaintance known(bla21());
  known.restart();
  REQUIRE_FALSE(known.member().is_known());
  Servo again = known.servo;
  again.boot = 1;
  again.since = known.now;
  known.roster.learn_run(again);
  CHECK(known.member().is_known());
  CHECK(known.member().servo().since == known.now);
  CHECK(known.member().servo().boot == 1);
  CHECK(known.member().is_unit(*known.servo.unique_id));
}

TEST_CASE("who writes to a setting of another node is remembered; commands and reads are no such") {
  Ear ear;
  const Time before = ear.now;
  ear.now += 1s;
  ear.get_set(40, 11, {.name = "0x38"});
  ear.get_set(40, 11, {.value = std::int64_t{900}, .name = "0x00"});
  ear.get_set(40, 11, {.index = 1, .value = std::int64_t{10}});
  CHECK_FALSE(ear.roster.writer_to(NodeId(11), before));
  ear.get_set(40, 11, {.value = std::int64_t{900}, .name = "0x38"});
  CHECK(ear.roster.writer_to(NodeId(11), before) == NodeId(40));
  CHECK_FALSE(ear.roster.writer_to(NodeId(11), ear.now)); // that was before
  CHECK_FALSE(ear.roster.writer_to(NodeId(12), before));
  CHECK(ear.roster.writer_to(NodeId(11), before, bla::Address(0x38)) == NodeId(40));
  CHECK_FALSE(ear.roster.writer_to(NodeId(11), before, bla::Address(0x39)));
  ear.get_set(127, 12, {.value = std::int64_t{900}, .name = "0x38"}); // it is ours
  CHECK_FALSE(ear.roster.writer_to(NodeId(12), before));
}

TEST_CASE(
    "frames that waited while nobody read are of one unit, in one run, however many are lost") {
  const bool has_restarted = GENERATE(false, true);
  Ear ear;
  for (std::uint32_t uptime_s = 100; uptime_s < 105; ++uptime_s) {
    ear.status(11, uptime_s);
    for (int i = 0; i < 10; ++i) {
      ear.actuator(11);
      ear.now += 100ms;
    }
  }
  ear.now += 4s;
  ear.roster.be_late(true);
  for (std::uint32_t uptime_s = 105; uptime_s < 108; ++uptime_s) {
    ear.status(11, uptime_s);
    for (int i = 0; i < 10; ++i) {
      ear.actuator(11);
      ear.lose_actuator();
      for (int lost = 0; i % 3 == 0 && lost < 20; ++lost) {
        ear.lose_actuator();
      }
    }
  }
  ear.roster.be_late(false);
  for (std::uint32_t uptime_s = has_restarted ? 2 : 109; ear.now < Time(1020s); ++uptime_s) {
    ear.status(11, uptime_s);
    for (int i = 0; i < 10; ++i) {
      ear.actuator(11);
      ear.now += 100ms;
    }
  }
  CHECK_FALSE(ear.roster.is_doubled(NodeId(11)));
  CHECK(ear.roster.member(NodeId(11)).boots == (has_restarted ? 1U : 0U));
}
