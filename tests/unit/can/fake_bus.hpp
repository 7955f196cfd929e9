#pragma once
// A bus that does what a test says, on a clock that moves only while the loop waits.

#include "blactl/can/bus.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::can::test {

/// What a test holds of its bus: the loop owns the bus itself.
struct Wire {
  enum class Echo : unsigned char {
    at_once, ///< somebody acknowledges every frame
    by_hand, ///< the test calls acknowledge()
    absent,  ///< this kind of bus has none
  };

  Time now{std::chrono::seconds(1000)};
  Echo echo = Echo::at_once;
  bool open = true;     ///< else it takes no frame, until Opened has happened
  std::size_t full = 0; ///< how many sends find the queue full
  std::uint64_t unreadable = 0;
  bool stamps = true;
  Duration oversleep{};       ///< the process stands still at the end of the next wait
  std::optional<Error> error; ///< of every send
  std::size_t tries = 0;      ///< how often send() was called
  std::vector<Frame> sent;    ///< taken from the loop
  std::multimap<Time, BusEvent> events;
  std::size_t receives_after_gone = 0;
  bool gone = false;
  std::vector<Filter> filters;

  void happen(BusEvent event, Duration later = {}) {
    events.emplace(now + later, std::move(event));
  }

  void hear(const Frame& frame, Duration later = {}) {
    happen(Received{frame, now + later, {}}, later);
  }

  void acknowledge(const Frame& frame, Duration later = {}) {
    happen(Sent{frame, now + later, {}}, later);
  }
};

class FakeBus final : public Bus {
 public:
  explicit FakeBus(Wire& wire) : wire_(wire) {}

  [[nodiscard]] std::string_view name() const override { return "fake"; }

  [[nodiscard]] bool is_open() const override { return wire_.open; }

  [[nodiscard]] Time send_again_at(Time refused) const override {
    return wire_.open ? Bus::send_again_at(refused) : never;
  }

  [[nodiscard]] Result<bool> send(const Frame& frame) override {
    ++wire_.tries;
    if (!wire_.open) {
      return false;
    }
    if (wire_.error) {
      return std::unexpected(*wire_.error);
    }
    if (wire_.full > 0) {
      --wire_.full;
      return false;
    }
    wire_.sent.push_back(frame);
    if (wire_.echo == Wire::Echo::at_once) {
      wire_.acknowledge(frame);
    }
    return true;
  }

  [[nodiscard]] std::optional<BusEvent> receive() override {
    wire_.receives_after_gone += wire_.gone ? 1U : 0U;
    if (wire_.events.empty() || wire_.events.begin()->first > wire_.now) {
      return std::nullopt;
    }
    BusEvent event = std::move(wire_.events.begin()->second);
    wire_.events.erase(wire_.events.begin());
    wire_.open = wire_.open || std::holds_alternative<Opened>(event);
    wire_.gone = wire_.gone || std::holds_alternative<Gone>(event);
    return event;
  }

  [[nodiscard]] Result<void> filter(std::span<const Filter> filters) override {
    wire_.filters.assign(filters.begin(), filters.end());
    return {};
  }

  [[nodiscard]] bool echoes() const override { return wire_.echo != Wire::Echo::absent; }

  [[nodiscard]] std::uint64_t unreadable() const override { return wire_.unreadable; }

  [[nodiscard]] bool stamps() const override { return wire_.stamps; }

  [[nodiscard]] int descriptor() const override { return -1; }

  [[nodiscard]] Time now() const override { return wire_.now; }

  [[nodiscard]] WallTime wall() const override { return WallTime(wire_.now.time_since_epoch()); }

  [[nodiscard]] Time idle_until(Time deadline) override {
    const Time next = wire_.events.empty() ? never : wire_.events.begin()->first;
    const Time end = std::min(deadline, next);
    if (end != never) {
      wire_.now = std::max(wire_.now, end) + std::exchange(wire_.oversleep, Duration{});
    }
    return end;
  }

 private:
  Wire& wire_;
};

} // namespace blactl::can::test
