#include "blactl/can/returning_bus.hpp"

#include "catch.hpp"
#include "fake_bus.hpp"

#include <unistd.h>

#include <array>
#include <memory>
#include <optional>

using namespace blactl;
using namespace blactl::can;
using blactl::can::test::FakeBus;
using blactl::can::test::Wire;

namespace {

constexpr Duration period = std::chrono::milliseconds(5);

/// A bus whose interface the test takes away.
struct Rig {
  Rig() : bus(std::make_unique<FakeBus>(first), [this] { return open(); }, period) {}

  Result<std::unique_ptr<Bus>> open() {
    ++tries;
    return next != nullptr ? Result<std::unique_ptr<Bus>>(std::make_unique<FakeBus>(*next))
                           : fail(Code::interface, "not there");
  }

  void unplug() { first.happen(Gone{{Code::interface, "gone"}}); }

  /// As the loop does, until something happens.
  BusEvent wait() {
    for (int i = 0; i < 1000; ++i) {
      if (auto event = bus.receive()) {
        return std::move(*event);
      }
      usleep(1000);
    }
    FAIL("nothing happened");
    return Ended{};
  }

  Wire first, second;
  Wire* next = nullptr; ///< what can be opened
  int tries = 0;
  ReturningBus bus;
};

Frame frame() {
  return {.id = 1, .size = 1};
}

} // namespace

TEST_CASE("an interface that goes is away, and back as soon as it can be opened") {
  Rig rig;
  rig.first.hear(frame());
  CHECK(std::holds_alternative<Received>(rig.wait()));
  rig.unplug();
  const BusEvent away = rig.wait();
  REQUIRE(std::holds_alternative<Away>(away));
  CHECK(std::get<Away>(away).error.message == "gone");
  CHECK(rig.bus.descriptor() == -1);
  CHECK(rig.bus.name() == "fake");
  CHECK_FALSE(rig.bus.receive());
  CHECK(rig.tries == 0);
  const Time look_again = rig.bus.idle_until(never);
  CHECK(look_again <= rig.bus.now() + period);
  while (rig.tries < 3) {
    usleep(1000);
    CHECK_FALSE(rig.bus.receive());
  }
  rig.next = &rig.second;
  CHECK(std::holds_alternative<Back>(rig.wait()));
  rig.second.hear(frame());
  CHECK(std::holds_alternative<Received>(rig.wait()));
  CHECK(rig.bus.send(frame()).value());
  CHECK(rig.second.sent.size() == 1);
}

TEST_CASE("while it is away frames wait, and its filter is that of the next one") {
  Rig rig;
  REQUIRE(rig.bus.filter(std::array{Filter{1, 2}}));
  rig.unplug();
  (void)rig.wait();
  CHECK_FALSE(rig.bus.send(frame()).value());
  CHECK(rig.bus.send_again_at(rig.bus.now()) > rig.bus.now());
  REQUIRE(rig.bus.filter(std::array{Filter{3, 4}}));
  rig.next = &rig.second;
  CHECK(std::holds_alternative<Back>(rig.wait()));
  REQUIRE(rig.second.filters.size() == 1);
  CHECK(rig.second.filters[0].id == 3);
}

TEST_CASE("that it is gone may be told by sending, and is told once") {
  Rig rig;
  rig.first.error = Error{Code::interface, "no such device"};
  CHECK_FALSE(rig.bus.send(frame()).value());
  CHECK_FALSE(rig.bus.send(frame()).value());
  const Time look_again = rig.bus.idle_until(never);
  CHECK(look_again <= rig.bus.now());
  CHECK(std::get<Away>(rig.wait()).error.message == "no such device");
  CHECK_FALSE(rig.bus.receive());
}

TEST_CASE("one that opens by a dialogue is back when that has ended") {
  Rig rig;
  rig.unplug();
  (void)rig.wait();
  rig.second.open = false;
  rig.next = &rig.second;
  rig.second.happen(Gone{{Code::interface, "no answer"}}); // and is tried again
  while (rig.tries < 2) {
    CHECK_FALSE(rig.bus.receive());
    usleep(1000);
  }
  CHECK_FALSE(rig.bus.is_open());
  rig.second.happen(Opened{});
  CHECK(std::holds_alternative<Back>(rig.wait()));
}

TEST_CASE("what was never there is not waited for, nor what has another reason to end") {
  Wire never_open;
  never_open.open = false;
  never_open.happen(Gone{{Code::interface, "no answer"}});
  ReturningBus closed(std::make_unique<FakeBus>(never_open),
                      [] { return Result<std::unique_ptr<Bus>>(fail(Code::interface, "")); });
  CHECK(std::holds_alternative<Gone>(closed.receive().value()));
  Rig rig;
  rig.first.happen(Gone{{Code::permission, "not allowed"}});
  CHECK(std::holds_alternative<Gone>(rig.wait()));
}

TEST_CASE("what was lost is counted on") {
  Rig rig;
  rig.first.happen(Overflow{3});
  rig.first.unreadable = 2;
  CHECK(std::get<Overflow>(rig.wait()).lost == 3);
  rig.unplug();
  (void)rig.wait();
  rig.next = &rig.second;
  rig.second.unreadable = 1;
  (void)rig.wait();
  rig.second.happen(Overflow{4});
  CHECK(std::get<Overflow>(rig.wait()).lost == 7);
  CHECK(rig.bus.unreadable() == 3);
}
