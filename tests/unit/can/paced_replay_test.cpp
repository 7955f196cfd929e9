#include "blactl/can/paced_replay.hpp"

#include "catch.hpp"
#include "fake_bus.hpp"

#include <unistd.h>

#include <chrono>
#include <memory>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;
using blactl::can::test::FakeBus;
using blactl::can::test::Wire;

namespace {

/// A log of which a frame is told at once, whenever it was.
struct Rig {
  Rig() : begin(wire.now), bus(std::make_unique<FakeBus>(wire)) {}

  void log(Duration later) { wire.happen(Received{.frame = {}, .at = begin + later, .wall = {}}); }

  /// How long the machine waits for the next event.
  Duration wait() {
    const Time start = bus.Bus::now();
    while (!bus.receive()) {
      REQUIRE(bus.Bus::now() - start < 10s);
      usleep(500);
    }
    return bus.Bus::now() - start;
  }

  Wire wire;
  Time begin;
  PacedReplay bus;
};

} // namespace

TEST_CASE("a frame of a log comes when its time has come") {
  Rig rig;
  rig.log(0ms);
  rig.log(100ms);
  CHECK(rig.wait() < 50ms);
  CHECK_FALSE(rig.bus.receive());
  const Time wake = rig.bus.idle_until(never);
  CHECK(wake > rig.bus.now());
  CHECK(wake <= rig.begin + 101ms);
  CHECK(rig.bus.descriptor() == -1);
  CHECK(rig.wait() > 40ms);
  CHECK(rig.bus.now() >= rig.begin + 100ms);
}

TEST_CASE("a log is played faster and slower, within limits") {
  Rig rig;
  for (int i = 0; i < 10; ++i) {
    rig.bus.go_faster();
  }
  CHECK(rig.bus.doublings() == 6);
  rig.log(3200ms);
  CHECK(rig.wait() < 1000ms);
  const Time then = rig.bus.now();
  CHECK(then >= rig.begin + 3200ms);
  for (int i = 0; i < 20; ++i) {
    rig.bus.go_slower();
  }
  CHECK(rig.bus.doublings() == -3);
  CHECK(rig.bus.now() - then < 3s); // the pace changes, the time does not
  rig.log(rig.bus.now() - rig.begin + 5ms);
  CHECK(rig.wait() > 30ms);
}

TEST_CASE("a log that is paused stands still, and goes on from there") {
  Rig rig;
  rig.log(20ms);
  rig.bus.pause(true);
  CHECK_FALSE(rig.bus.receive());
  const Time then = rig.bus.now();
  usleep(40'000);
  CHECK(rig.bus.now() == then);
  CHECK_FALSE(rig.bus.receive());
  CHECK(rig.bus.idle_until(then + 1s) == never);
  rig.bus.pause(false);
  CHECK(rig.wait() > 5ms);
}

TEST_CASE("at the end of a log time stands still") {
  Rig rig;
  rig.wire.happen(Ended{});
  CHECK(std::holds_alternative<Ended>(rig.bus.receive().value()));
  const Time then = rig.bus.now();
  usleep(5'000);
  CHECK(rig.bus.now() == then);
}
