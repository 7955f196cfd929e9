#pragma once
// A bus around another one, for tests that watch or disturb what passes.

#include "blactl/can/bus.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace blactl::test {

/// Passes everything on.
class BusAround : public can::Bus {
 public:
  explicit BusAround(std::unique_ptr<can::Bus> bus) : bus_(std::move(bus)) {}

  [[nodiscard]] std::string_view name() const override { return bus_->name(); }

  [[nodiscard]] Result<bool> send(const can::Frame& frame) override { return bus_->send(frame); }

  [[nodiscard]] std::optional<can::BusEvent> receive() override { return bus_->receive(); }

  [[nodiscard]] Result<void> filter(std::span<const can::Filter> filters) override {
    return bus_->filter(filters);
  }

  [[nodiscard]] bool echoes() const override { return bus_->echoes(); }

  [[nodiscard]] std::string bus_off_hint() const override { return bus_->bus_off_hint(); }

  [[nodiscard]] int descriptor() const override { return bus_->descriptor(); }

  [[nodiscard]] Time now() const override { return bus_->now(); }

  [[nodiscard]] WallTime wall() const override { return bus_->wall(); }

  [[nodiscard]] Time idle_until(Time deadline) override { return bus_->idle_until(deadline); }

 private:
  std::unique_ptr<can::Bus> bus_;
};

} // namespace blactl::test
