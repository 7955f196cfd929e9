#include "blactl/can/bus.hpp"

#include "catch.hpp"

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;

namespace {

/// A bus in a process that another one interrupts while it reads the wall clock.
class InterruptedBus final : public Bus {
 public:
  explicit InterruptedBus(int interruptions) : interruptions_(interruptions) {}

  [[nodiscard]] std::string_view name() const override { return "interrupted"; }

  [[nodiscard]] Result<bool> send(const Frame&) override { return false; }

  [[nodiscard]] std::optional<BusEvent> receive() override { return std::nullopt; }

  [[nodiscard]] Result<void> filter(std::span<const Filter>) override { return {}; }

  [[nodiscard]] bool echoes() const override { return true; }

  [[nodiscard]] int descriptor() const override { return -1; }

  [[nodiscard]] Time now() const override { return Time{} + passed_; }

  [[nodiscard]] WallTime wall() const override {
    const WallTime read = WallTime{} + 1h + passed_;
    passed_ += interruptions_-- > 0 ? 30ms : 0ms;
    return read;
  }

 private:
  mutable Duration passed_ = 10s;
  mutable int interruptions_;
};

} // namespace

TEST_CASE("the wall time of a moment is the same however often the process is interrupted") {
  const int interruptions = GENERATE(0, 1, 5);
  const InterruptedBus bus(interruptions);
  CHECK(bus.wall_at(Time{} + 9s) == WallTime{} + 1h + 9s);
}

TEST_CASE("a process that is interrupted at every look still gets a wall time") {
  const InterruptedBus bus(1000);
  const WallTime exact = WallTime{} + 1h + 9s;
  CHECK(bus.wall_at(Time{} + 9s) >= exact - 30ms);
  CHECK(bus.wall_at(Time{} + 9s) <= exact + 30ms);
}
