#include "blactl/can/frame_bits.hpp"
#include "blactl/fleet/statistics/bus_statistics.hpp"

#include "catch.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace std::chrono_literals;
using dronecan::Header;
using dronecan::Kind;
using dronecan::NodeId;

namespace {

constexpr Time start{1'000'000s};

Header status_of(std::uint8_t source) {
  return {.data_type_id = 1011, .source = NodeId(source)};
}

/// A transfer of 7 bytes.
dronecan::Transfer transfer(const Header& header, unsigned id, Time at) {
  static const std::array<std::uint8_t, 7> payload{};
  return {.header = header,
          .transfer_id = static_cast<dronecan::TransferId>(id % 32),
          .payload = payload,
          .at = at};
}

can::Received frame(const Header& header, Time at) {
  return {.frame = {.id = encode_id(header), .size = 8},
          .at = at,
          .wall = WallTime(at.time_since_epoch())};
}

/// Feeds one stream: steps of the transfer ID and of the time since the transfer before.
struct Sender {
  LostTransfers losses{};
  unsigned id = 0;
  Time at = start;

  Sender& go(unsigned steps, Duration time) {
    id += steps;
    at += time;
    losses.take(static_cast<dronecan::TransferId>(id % 32), at);
    return *this;
  }

  /// So many in order, one each 100 ms.
  Sender& run(unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
      go(1, 100ms);
    }
    return *this;
  }
};

using Lost = std::optional<std::uint64_t>;

} // namespace

TEST_CASE("periods have a mean, a shortest, a longest, and a standard deviation") {
  Periods periods;
  CHECK_FALSE(periods.mean_us());
  Time at = start;
  periods.take(at);
  CHECK_FALSE(periods.min());
  for (const Duration period : {90ms, 110ms, 90ms, 110ms}) {
    periods.take(at += period);
  }
  CHECK(periods.count() == 4);
  CHECK(periods.mean_us().value_or(0) == Approx(100'000));
  CHECK(periods.min() == Duration(90ms));
  CHECK(periods.max() == Duration(110ms));
  CHECK(periods.jitter_us().value_or(0) == Approx(10'000));
}

TEST_CASE("one period has no jitter, equal ones none at all") {
  Periods periods;
  periods.take(start);
  periods.take(start + 20ms);
  CHECK(periods.mean_us() == 20'000);
  CHECK_FALSE(periods.jitter_us());
  for (int i = 2; i < 100'000; ++i) {
    periods.take(start + i * 20ms);
  }
  CHECK(periods.jitter_us() == 0);
}

TEST_CASE("a time that goes back ends no period") {
  Periods periods;
  for (const Duration at : {0ms, 100ms, -5000ms, -4900ms}) {
    periods.take(start + at);
  }
  CHECK(periods.count() == 2);
  CHECK(periods.min() == Duration(100ms));
  CHECK(periods.max() == Duration(100ms));
}

TEST_CASE("transfer IDs that count on, also over their end, lose nothing") {
  Sender sender;
  CHECK(sender.run(100).losses.lost() == Lost(0));
  CHECK(sender.losses.jumps() == 0);
}

TEST_CASE("a gap of transfer IDs is what was lost, also over their end") {
  for (unsigned before = 3; before < 40; ++before) { // gaps begin at every ID
    Sender sender;
    sender.run(before).go(5, 500ms).run(3);
    INFO(before);
    CHECK(sender.losses.lost() == Lost(4));
    CHECK(sender.losses.jumps() == 0);
  }
  Sender often;
  for (int i = 0; i < 10; ++i) {
    often.run(5).go(2, 200ms);
  }
  CHECK(often.losses.lost() == Lost(10));
}

TEST_CASE("up to 31 can be lost; a silence in which 32 fit tells no number") {
  CHECK(Sender().run(10).go(31, 3100ms).losses.lost() == Lost(30));
  for (const unsigned steps : {2U, 8U, 31U}) {
    const Sender sender = Sender().run(10).go(steps, 3200ms + steps * 100ms);
    CHECK(sender.losses.lost() == Lost(0));
    CHECK(sender.losses.jumps() == 1);
  }
}

TEST_CASE(
    "IDs that go on by one after a silence in which they came round once or more are a jump") {
  for (const auto silence : {3300ms, 6500ms}) {
    Sender sender = Sender().run(10).go(1, silence);
    INFO(silence.count());
    CHECK(sender.losses.lost() == Lost(0));
    CHECK(sender.losses.jumps() == 1);
    CHECK(sender.run(5).go(3, 300ms).losses.lost() == Lost(2)); // and no sign of another period
    CHECK(sender.losses.jumps() == 1);
  }
}

TEST_CASE("who pauses, or becomes slower, jumps once at most") {
  Sender pauses; // for 4 s, then for as long as 32 and one
  pauses.run(10).go(1, 4s);
  for (int i = 0; i < 5; ++i) {
    pauses.run(20).go(1, 3300ms);
  }
  CHECK(pauses.losses.jumps() == 0);
  Sender slower = Sender().run(20);
  for (int i = 0; i < 40; ++i) {
    slower.go(1, 3300ms);
  }
  CHECK(slower.losses.jumps() == 1);
  CHECK(slower.go(4, 13200ms).losses.lost() == Lost(3));
}

TEST_CASE("a sender that is not exact loses nothing by that") {
  Sender sender;
  for (int i = 0; i < 50; ++i) {
    sender.go(1, i % 2 == 0 ? 20ms : 180ms);
  }
  CHECK(sender.go(3, 230ms).losses.lost() == Lost(2));
  CHECK(sender.losses.jumps() == 0);
}

TEST_CASE("a node that restarts has lost nothing") {
  // Its IDs begin at 0 again, after 500 ms of silence.
  const Sender sender = Sender().run(50).go(32 - 50 % 32, 500ms).run(10);
  CHECK(sender.losses.lost() == Lost(0));
  CHECK(sender.losses.jumps() == 1);
}

TEST_CASE("a transfer that comes twice, and two senders of one ID, are no losses") {
  const Sender twice = Sender().run(10).go(32, 1ms).run(10);
  CHECK(twice.losses.lost() == Lost(0));
  CHECK(twice.losses.jumps() == 1);
  Sender two;
  for (int i = 0; i < 20; ++i) { // one at 3, 4, 5 …, the other at 20, 21, 22 …
    two.go(17, 50ms).go(16, 50ms);
  }
  CHECK_FALSE(two.losses.lost());
  CHECK(two.losses.jumps() == 39);
}

TEST_CASE("of a sender whose period nobody knows nothing is lost") {
  Sender sender;
  CHECK_FALSE(sender.losses.lost());
  CHECK_FALSE(sender.go(1, 0ms).go(7, 100ms).losses.lost());
  CHECK(sender.go(1, 100ms).losses.lost() == Lost(0));
  CHECK(sender.losses.jumps() == 1);
}

TEST_CASE("a burst after a long pause still tells what it lost") {
  Sender sender;
  for (int i = 0; i < 5; ++i) {
    sender.run(20).go(1, 60s);
  }
  CHECK(sender.run(2).go(3, 300ms).losses.lost() == Lost(2));
  CHECK(sender.losses.jumps() == 0);
}

TEST_CASE("a sender that changes its rate is followed") {
  Sender sender;
  sender.run(20);
  for (int i = 0; i < 40; ++i) {
    sender.go(1, 1s);
  }
  CHECK(sender.go(4, 4s).losses.lost() == Lost(3));
  for (int i = 0; i < 40; ++i) {
    sender.go(1, 10ms);
  }
  CHECK(sender.go(4, 40ms).losses.lost() == Lost(6));
}

TEST_CASE("where stamps run backwards a gap is not counted, and the next one is") {
  const Sender sender = Sender().run(10).go(3, -100s).run(5).go(3, 300ms);
  CHECK(sender.losses.lost() == Lost(2));
  CHECK(sender.losses.jumps() == 1);
}

TEST_CASE("the load is counted over all, over the busiest second and over the last") {
  BusLoad load;
  CHECK_FALSE(load.mean_permille());
  load.hear(100'000, start);
  CHECK_FALSE(load.mean_permille()); // no time has passed
  load.hear(100'000, start + 900ms);
  CHECK_FALSE(load.max_permille()); // no second has
  load.hear(600'000, start + 1850ms);
  load.hear(0, start + 2s);
  CHECK(load.mean_permille() == 400U);
  CHECK(load.last_permille() == 600U);
  CHECK(load.max_permille() == 700U); // from 0.9 s or so on
  load.pass(start + 100s);
  CHECK(load.mean_permille() == 8U);
  CHECK(load.last_permille() == 0U);
  CHECK(load.max_permille() == 700U);
  CHECK(load.duration() == Duration(100s));
}

TEST_CASE("a bus that is evenly busy is so in each second") {
  BusLoad load;
  for (int i = 0; i <= 10'000; ++i) {
    load.hear(250, start + i * 1ms);
  }
  CHECK(load.mean_permille() == 250U);
  CHECK(load.max_permille() == 250U);
  CHECK(load.last_permille() == 250U);
  CHECK(load.bits() == 2'500'250);
}

TEST_CASE("a load has no mean where times run backwards, but its seconds") {
  BusLoad load;
  const auto second = [&](Time from) {
    for (int i = 0; i <= 10; ++i) {
      load.hear(10'000, from + i * 100ms);
    }
  };
  second(start);
  load.hear(10'000, start + 600ms); // as sockets that are read in turn do
  CHECK(load.mean_permille() == 120U);
  second(start - 10s);
  CHECK_FALSE(load.duration());
  CHECK_FALSE(load.mean_permille());
  CHECK(load.last_permille() == 100U);
  CHECK(load.max_permille() == 100U);
}

TEST_CASE("each sender, kind and type is a stream of its own") {
  BusStatistics bus;
  const Header request{
      .kind = Kind::request, .data_type_id = 11, .source = NodeId(127), .destination = NodeId(10)};
  Header other = request;
  other.destination = NodeId(20);
  for (unsigned i = 0; i < 10; ++i) {
    const Time at = start + i * 100ms;
    for (const std::uint8_t node : {std::uint8_t{10}, std::uint8_t{20}}) {
      bus.hear(frame(status_of(node), at), true);
      bus.take(transfer(status_of(node), i, at));
    }
    bus.take(transfer(request, i, at));
    bus.take(transfer(i < 5 ? request : other, i, at));
  }
  bus.take_broken(status_of(20));
  bus.hear(frame(status_of(30), start + 1s), false);
  REQUIRE(bus.streams().size() == 3);
  CHECK(bus.frames() == 21);
  CHECK(bus.begin() == WallTime(start.time_since_epoch()));
  CHECK(bus.end() - bus.begin() == 1s);
  auto stream = bus.streams().begin();
  CHECK(stream->second.source == NodeId(10));
  CHECK(stream->second.count == 10);
  CHECK(stream->second.bytes == 70);
  CHECK(stream->second.frames == 10);
  CHECK(stream->second.bits ==
        10 * (can::frame_length(frame(status_of(10), start).frame) + can::intermission_bits));
  CHECK(stream->second.periods.mean_us().value_or(0) == Approx(100'000));
  CHECK(stream->second.losses.lost() == Lost(0));
  CHECK(stream->second.errors == 0);
  CHECK((++stream)->second.errors == 1);
  ++stream;
  CHECK(stream->second.kind == Kind::request);
  CHECK(stream->second.count == 20);
  CHECK_FALSE(stream->second.destination.is_unicast());
  CHECK_FALSE(stream->second.periods.mean_us()); // services come when somebody asks
  CHECK_FALSE(stream->second.losses.lost());
}

TEST_CASE("what one node asks of one other names both") {
  BusStatistics bus;
  const Header request{
      .kind = Kind::request, .data_type_id = 11, .source = NodeId(127), .destination = NodeId(10)};
  bus.take(transfer(request, 0, start));
  bus.take(transfer(request, 1, start + 1s));
  CHECK(bus.streams().begin()->second.destination == NodeId(10));
}

TEST_CASE("streams beyond the bound are added up in one") {
  BusStatistics bus;
  constexpr std::size_t more = 100;
  for (std::size_t i = 0; i < BusStatistics::most_streams + more; ++i) {
    const Header header{.data_type_id = static_cast<std::uint16_t>(i), .source = NodeId(1)};
    bus.hear(frame(header, start), true);
    bus.take(transfer(header, 0, start));
    bus.take(transfer(header, 1, start + 1s));
  }
  CHECK(bus.streams().size() == BusStatistics::most_streams);
  REQUIRE(bus.rest());
  CHECK(bus.rest()->count == 2 * more);
  CHECK(bus.rest()->frames == more);
  CHECK_FALSE(bus.rest()->losses.lost());
  CHECK_FALSE(bus.rest()->periods.mean_us());
}

TEST_CASE("senders without a node ID have no rhythm") {
  BusStatistics bus;
  const Header header{.data_type_id = 1, .discriminator = 5};
  bus.take(transfer(header, 0, start));
  bus.take(transfer(header, 9, start + 1s));
  CHECK(bus.streams().begin()->second.count == 2);
  CHECK_FALSE(bus.streams().begin()->second.periods.mean_us());
  CHECK(bus.streams().begin()->second.losses.jumps() == 0);
}
