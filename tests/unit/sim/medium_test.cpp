#include "blactl/can/frame_bits.hpp"
#include "blactl/sim/bus/medium.hpp"

#include "unit/sim/support.hpp"

#include <list>

using namespace blactl;
using namespace blactl::sim;
using testing::frame;

namespace {

Time at(std::int64_t microseconds) {
  return Time(Duration(microseconds));
}

Duration length(const can::Frame& one) {
  return Duration(can::frame_length(one));
}

struct Ear final : Medium::Listener {
  struct Happened {
    std::string what;
    Time at;
  };

  void heard(const can::Frame& one, Time time) override {
    events.push_back({"heard " + testing::text(one), time});
  }

  void sent(const can::Frame& one, Time time) override {
    events.push_back({"sent " + testing::text(one), time});
  }

  void bus_off(Time time) override { events.push_back({"bus off", time}); }

  [[nodiscard]] std::vector<std::string> words() const {
    std::vector<std::string> out;
    for (const Happened& event : events) {
      out.push_back(event.what);
    }
    return out;
  }

  std::vector<Happened> events;
};

/// A medium and its listeners.
struct Wire {
  explicit Wire(const WireFaults& faults = {}) : medium(faults, 1) {}

  Medium medium;
  std::list<Ear> ears;

  Medium::PortId attach(std::size_t capacity = 64) {
    return medium.attach(ears.emplace_back(), capacity, now);
  }

  void run_until(Time end) {
    while (medium.next_event() <= end) {
      now = std::max(now, medium.next_event());
      medium.advance(now);
    }
    now = end;
  }

  Ear& ear(Medium::PortId port) { return *std::next(ears.begin(), port); }

  Time now{};
};

using Words = std::vector<std::string>;

} // namespace

TEST_CASE("a frame takes its bits, the next one follows after the intermission",
          "[requirement-1]") {
  Wire wire;
  const auto a = wire.attach();
  const auto b = wire.attach();
  const can::Frame first = frame("1001550B#00000000000000C0");
  const can::Frame second = frame("1E0B7F8B#3078333845");
  wire.medium.send(a, first, at(0));
  wire.medium.send(a, second, at(0));
  wire.run_until(at(1000));

  REQUIRE(wire.ear(b).events.size() == 2);
  CHECK(wire.ear(b).events[0].at == at(0) + length(first));
  CHECK(wire.ear(b).events[1].at == at(0) + length(first) + Duration(3) + length(second));
  CHECK(wire.ear(a).words() ==
        Words{"sent " + testing::text(first), "sent " + testing::text(second)});
  CHECK(wire.medium.counters().frames == 2);
  CHECK(wire.medium.counters().busy == length(first) + length(second) + Duration(6));
}

TEST_CASE("the lowest identifier goes first, whoever asked first while the bus was busy") {
  Wire wire;
  const auto a = wire.attach();
  const auto b = wire.attach();
  const auto c = wire.attach();
  wire.medium.send(a, frame("1F000001#00"), at(0));
  wire.run_until(at(10));
  wire.medium.send(b, frame("1E000002#00"), at(10));
  wire.run_until(at(20));
  wire.medium.send(c, frame("10000003#00"), at(20));
  wire.run_until(at(1000));
  CHECK(wire.ear(c).words() == Words{"heard 1F000001#00", "sent 10000003#00", "heard 1E000002#00"});
}

TEST_CASE("all who send at one moment take part in the arbitration") {
  Wire wire;
  const auto a = wire.attach();
  const auto b = wire.attach();
  wire.medium.send(a, frame("1F000001#00"), at(5));
  wire.medium.send(b, frame("10000002#00"), at(5));
  wire.run_until(at(1000));
  CHECK(wire.ear(a).words() == Words{"heard 10000002#00", "sent 1F000001#00"});
}

TEST_CASE("one node's frames stay in order, the head alone takes part in the arbitration") {
  Wire wire;
  const auto a = wire.attach();
  const auto b = wire.attach();
  wire.medium.send(a, frame("1F000001#00"), at(0));
  wire.medium.send(a, frame("00000001#01"), at(0));
  wire.medium.send(b, frame("1E000002#00"), at(0));
  wire.run_until(at(1000));
  CHECK(wire.ear(b).words() == Words{"sent 1E000002#00", "heard 1F000001#00", "heard 00000001#01"});
}

TEST_CASE("alone on the bus nothing is acknowledged, until somebody comes") {
  Wire wire;
  const auto a = wire.attach();
  wire.medium.send(a, frame("1F000001#00"), at(0));
  CHECK(wire.medium.next_event() == never);
  wire.run_until(at(5000));
  CHECK(wire.ear(a).events.empty());
  const auto b = wire.attach();
  wire.run_until(at(6000));
  REQUIRE(wire.ear(b).events.size() == 1);
  CHECK(wire.ear(b).events[0].at == at(5000) + length(frame("1F000001#00")));
  CHECK(wire.ear(a).words() == Words{"sent 1F000001#00"});
}

TEST_CASE("a full queue takes nothing") {
  Wire wire;
  const auto a = wire.attach(2);
  wire.attach();
  CHECK(wire.medium.send(a, frame("1F000001#00"), at(0)));
  CHECK(wire.medium.send(a, frame("1F000001#01"), at(0)));
  CHECK_FALSE(wire.medium.send(a, frame("1F000001#02"), at(0)));
  wire.run_until(at(1000));
  CHECK(wire.medium.counters().frames == 2);
}

TEST_CASE("what a node queued before it was detached is sent all the same") {
  Wire wire;
  const auto a = wire.attach();
  const auto b = wire.attach();
  wire.medium.send(a, frame("1F000001#00"), at(0));
  wire.medium.send(a, frame("1F000001#01"), at(0));
  wire.run_until(at(10));
  wire.medium.detach(a);
  wire.run_until(at(1000));
  CHECK(wire.ear(b).words() == Words{"heard 1F000001#00", "heard 1F000001#01"});
  CHECK(wire.ear(a).events.empty());
  wire.medium.send(b, frame("1F000002#00"), at(1000)); // and then the node is gone
  CHECK(wire.medium.next_event() == never);
}

TEST_CASE("the same frame of two nodes at one moment is one frame on the wire") {
  Wire wire;
  const auto a = wire.attach();
  const auto b = wire.attach();
  const auto c = wire.attach();
  wire.medium.send(a, frame("1F000001#00"), at(0));
  wire.medium.send(b, frame("1F000001#00"), at(0));
  wire.run_until(at(1000));
  CHECK(wire.ear(c).words() == Words{"heard 1F000001#00"});
  CHECK(wire.ear(a).words() == Words{"sent 1F000001#00"});
  CHECK(wire.ear(b).words() == Words{"sent 1F000001#00"});
}

TEST_CASE(
    "two nodes under one identifier destroy each other's frames, until one is error passive") {
  Wire wire;
  const auto a = wire.attach();
  const auto b = wire.attach();
  const auto c = wire.attach();
  wire.medium.send(a, frame("1F000001#01"), at(0));
  wire.medium.send(b, frame("1F000001#00"), at(0));
  wire.run_until(at(10'000));
  // 16 errors take both to 128: then the recessive one can no longer destroy the dominant one.
  CHECK(wire.medium.counters().collisions == 16);
  CHECK(wire.ear(c).words() == Words{"heard 1F000001#00", "heard 1F000001#01"});
}

TEST_CASE("a node that never wins against its double ends off the bus, and comes back") {
  Wire wire;
  const auto a = wire.attach();
  const auto b = wire.attach();
  const auto c = wire.attach();
  wire.medium.send(a, frame("1F000001#FF"), at(0));
  for (int i = 0; i < 40; ++i) {
    wire.medium.send(b, frame("1F000001#00"), at(0));
  }
  wire.run_until(at(100'000));
  CHECK(std::ranges::count(wire.ear(a).words(), "bus off") == 1);
  CHECK(wire.medium.counters().frames == 40);
  wire.medium.send(a, frame("1F000003#00"), at(100'000));
  wire.run_until(at(101'000));
  CHECK(wire.ear(c).words().back() == "heard 1F000003#00");
}

TEST_CASE("a lost frame is missed by a receiver, its sender knows nothing") {
  Wire wire({.loss = 1});
  const auto a = wire.attach();
  const auto b = wire.attach();
  wire.medium.send(a, frame("1E0B7F8B#3078333845"), wire.now);
  wire.run_until(at(1000));
  CHECK(wire.ear(a).words() == Words{"sent 1E0B7F8B#3078333845"});
  CHECK(wire.ear(b).words().empty());
}

TEST_CASE("a frame that only its sender sees fail is received twice and sent once") {
  Wire wire({.duplication = 0.5});
  const auto a = wire.attach();
  const auto b = wire.attach();
  for (int i = 0; i < 50; ++i) {
    wire.medium.send(a, frame("1E0B7F8B#3078333845"), wire.now);
  }
  wire.run_until(at(100'000));
  CHECK(wire.ear(a).events.size() == 50);
  CHECK(wire.ear(b).events.size() > 75);
  CHECK(wire.ear(b).events.size() < 130);
  CHECK(wire.medium.counters().frames == wire.ear(b).events.size());
}

TEST_CASE("an error costs the bus time, the frame comes through in the end") {
  Wire wire({.errors = 0.5});
  const auto a = wire.attach();
  const auto b = wire.attach();
  const can::Frame sent = frame("1E0B7F8B#3078333845");
  for (int i = 0; i < 50; ++i) {
    wire.medium.send(a, sent, wire.now);
  }
  wire.run_until(at(100'000));
  CHECK(wire.ear(b).events.size() == 50);
  CHECK(wire.medium.counters().errors > 20);
  CHECK(wire.medium.counters().busy > 50 * length(sent));
}

TEST_CASE("a long burst takes its sender off the bus") {
  Wire wire({.burst_interval = Duration(1), .burst_length = std::chrono::seconds(1)});
  const auto a = wire.attach();
  wire.attach();
  wire.run_until(at(10));
  wire.medium.send(a, frame("1E0B7F8B#3078333845"), wire.now);
  wire.run_until(at(10'000));
  CHECK(wire.ear(a).words() == Words{"bus off"});
  CHECK(wire.medium.counters().errors == 32);
}
