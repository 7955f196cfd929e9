#include "blactl/sim/scenario/wire_faults.hpp"

#include "unit/sim/support.hpp"

#include <bit>
#include <chrono>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using testing::frame;

namespace {

constexpr std::uint64_t seed = 7;

unsigned different_bits(const can::Frame& a, const can::Frame& b) {
  unsigned count = 0;
  for (std::size_t i = 0; i < a.size; ++i) {
    count += static_cast<unsigned>(std::popcount(static_cast<unsigned>(a.data[i] ^ b.data[i])));
  }
  return count;
}

std::uint8_t tail(const can::Frame& one) {
  return one.data[one.size - std::size_t{1}];
}

} // namespace

TEST_CASE("without faults nothing goes wrong") {
  WireDisturbance wire({}, seed);
  const can::Frame sent = frame("1E0B7F8B#11223344556677A0");
  for (int i = 0; i < 1000; ++i) {
    const bool wrong = wire.destroys(Time(Duration(i))) || wire.duplicates() || wire.loses();
    CHECK_FALSE(wrong);
    CHECK(wire.received(sent) == sent);
  }
}

TEST_CASE("a probability is what it says, and the seed repeats it") {
  const auto losses = [](std::uint64_t with) {
    WireDisturbance wire({.loss = 0.25}, with);
    std::vector<bool> lost(4000);
    for (auto&& one : lost) {
      one = wire.loses();
    }
    return lost;
  };
  const auto lost = losses(seed);
  const auto count = std::ranges::count(lost, true);
  CHECK(count > 900);
  CHECK(count < 1100);
  CHECK(losses(seed) == lost);
  CHECK(losses(seed + 1) != lost);
}

TEST_CASE("bits turn around in the data of long transfers only, three at most") {
  WireDisturbance wire({.bit_flips = 0.9}, seed);
  const can::Frame single = frame("1E0B7F8B#11223344556677C0");
  unsigned most = 0;
  for (int i = 0; i < 200; ++i) {
    CHECK(wire.received(single) == single);
    unsigned flipped = 0;
    for (const char* text :
         {"1E0B7F8B#1122334455667780", "1E0B7F8B#1122334455667720", "1E0B7F8B#112240"}) {
      const can::Frame sent = frame(text);
      const can::Frame heard = wire.received(sent);
      CHECK(heard.id == sent.id);
      CHECK(tail(heard) == tail(sent));
      flipped += different_bits(sent, heard);
    }
    CHECK(flipped <= 3);
    most = std::max(most, flipped);
  }
  CHECK(most == 3);
}

TEST_CASE("bursts come at random and end") {
  WireDisturbance wire({.burst_interval = 100ms, .burst_length = 10ms}, seed);
  int destroyed = 0;
  int bursts = 0;
  bool before = false;
  constexpr int milliseconds = 100'000;
  for (int i = 0; i < milliseconds; ++i) {
    const bool now = wire.destroys(Time(std::chrono::milliseconds(i)));
    destroyed += now ? 1 : 0;
    bursts += now && !before ? 1 : 0;
    before = now;
  }
  CHECK(bursts > 700); // one in 110 ms
  CHECK(bursts < 1100);
  CHECK(destroyed > 7000);
  CHECK(destroyed < 12000);
}
