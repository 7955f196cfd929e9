#pragma once
// A witness of what passes on the simulated bus, and one that disturbs.

#include "bus_around.hpp"
#include "disturbance.hpp"
#include "record.hpp"

#include <deque>
#include <memory>
#include <optional>
#include <utility>

namespace blactl::campaign {

/// Writes down what passes, as --record does.
class Witness final : public test::BusAround {
 public:
  Witness(std::unique_ptr<can::Bus> bus, Record& record)
      : BusAround(std::move(bus)), record_(record) {}

  [[nodiscard]] std::optional<can::BusEvent> receive() override;

 private:
  Record& record_;
};

/// Does to one frame, or to all from one on, what `disturbance` says; it outlives this.
class DisturbedBus final : public test::BusAround {
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
