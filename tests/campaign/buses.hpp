#pragma once
// Buses around the simulated one: a witness, and one that disturbs.

#include "blactl/can/bus.hpp"

#include "disturbance.hpp"
#include "record.hpp"

#include <deque>
#include <memory>
#include <utility>

namespace blactl::campaign {

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

/// Writes down what passes, as --record does.
class Witness final : public BusAround {
 public:
  Witness(std::unique_ptr<can::Bus> bus, Record& record)
      : BusAround(std::move(bus)), record_(record) {}

  [[nodiscard]] std::optional<can::BusEvent> receive() override;

 private:
  Record& record_;
};

/// Does to one frame, or to all from one on, what `disturbance` says; it outlives this.
class DisturbedBus final : public BusAround {
 public:
  DisturbedBus(std::unique_ptr<can::Bus> bus, Disturbance& disturbance)
      : BusAround(std::move(bus)), disturbance_(disturbance) {}

  [[nodiscard]] Result<bool> send(const can::Frame& frame) override;
  [[nodiscard]] std::optional<can::BusEvent> receive() override;

 private:
  [[nodiscard]] std::optional<can::BusEvent> disturbed(can::Received received);

  Disturbance& disturbance_;
  std::deque<can::BusEvent> next_;     ///< to be received before anything else
  std::deque<can::Received> withheld_; ///< the late ones
};

} // namespace blactl::campaign
