#pragma once
// A cable that is replugged from one servo to another one of the same node ID, and back.

#include "blactl/sim/bus/private_bus.hpp"
#include "blactl/sim/scenario/scenario.hpp"

#include "bus_around.hpp"
#include "catch.hpp"
#include "support.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::fleet::test {

/// `servos`: as in a scenario.
inline std::unique_ptr<can::Bus> bus_of(std::string_view servos) {
  const auto scenario = sim::parse_scenario(
      fmt::format(R"({{"schema": "blactl-scenario/1", "clock": "virtual", "servos": [{}]}})",
                  servos),
      "test.json", profiles());
  INFO((scenario ? "" : scenario.error().message));
  REQUIRE(scenario);
  return std::make_unique<sim::PrivateBus>("sim:test.json", *scenario);
}

/// When the cable is pulled off one servo, and when it is on the other one.
struct Gap {
  Time off, on;
};

/// The cable changes over in every gap. Both buses run all the time.
class Replugged final : public blactl::test::BusAround {
 public:
  Replugged(std::string_view one, std::string_view other, std::vector<Gap> gaps)
      : BusAround(bus_of(one)), other_(bus_of(other)), gaps_(std::move(gaps)) {}

  [[nodiscard]] Result<bool> send(const can::Frame& frame) override {
    return is_on_other() ? other_->send(frame) : BusAround::send(frame);
  }

  [[nodiscard]] std::optional<can::BusEvent> receive() override {
    auto event = is_on_other() ? other_->receive() : BusAround::receive();
    const auto* received = event ? std::get_if<can::Received>(&*event) : nullptr;
    const bool is_lost = received != nullptr && std::ranges::any_of(gaps_, [&](const Gap& gap) {
                           return received->at >= gap.off && received->at < gap.on;
                         });
    return is_lost ? std::nullopt : event;
  }

  [[nodiscard]] Result<void> filter(std::span<const can::Filter> filters) override {
    REQUIRE(other_->filter(filters));
    return BusAround::filter(filters);
  }

  [[nodiscard]] Time now() const override { return std::max(BusAround::now(), other_->now()); }

  [[nodiscard]] Time idle_until(Time deadline) override {
    for (const Gap& gap : gaps_) {
      deadline = gap.off > now() ? std::min(deadline, gap.off) : deadline;
    }
    if (is_on_other()) {
      const Time end = other_->idle_until(deadline);
      while (BusAround::now() < end) {
        while (BusAround::receive()) {
        }
        (void)BusAround::idle_until(end);
      }
      return end;
    }
    const Time end = BusAround::idle_until(deadline);
    while (other_->now() < end) {
      while (other_->receive()) {
      }
      (void)other_->idle_until(end);
    }
    return end;
  }

 private:
  [[nodiscard]] bool is_on_other() const {
    return std::ranges::count_if(gaps_, [&](const Gap& gap) { return gap.off <= now(); }) % 2 != 0;
  }

  std::unique_ptr<can::Bus> other_;
  std::vector<Gap> gaps_;
};

/// Two servos of one node ID; only the second one has a fault, a temperature above its limit.
constexpr std::string_view servo_1001 =
    R"({"model": "BLA21-12U-AB", "node_id": 20, "serial_number": 1001,
        "behaviour": {"boot_time": "100ms"}})";
constexpr std::string_view servo_1002 =
    R"({"model": "BLA21-12U-AB", "node_id": 20, "serial_number": 1002,
        "rom": {"temperature_limit_high": "20degC"}, "behaviour": {"boot_time": "100ms"}})";

} // namespace blactl::fleet::test
