// An electronic speed controller: a node with other parameters than a servo.

#include "sim/scenario/foreign_role.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace blactl::sim {
namespace {

using dronecan::GetSet;

/// uavcan/equipment/esc/1034.Status.uavcan
constexpr dronecan::DataType esc_status{"uavcan.equipment.esc.Status", 1034, false,
                                        0xA9AF28AEA2FBB254};
constexpr dronecan::Priority priority = dronecan::priority_medium;

std::vector<GetSet::Response> parameters(std::uint8_t index) {
  const std::int64_t own_index = index;
  const std::int64_t last_index = 31;
  const std::int64_t telemetry_hz = 50;
  const std::int64_t max_telemetry_hz = 200;
  const float kv = 380.0F;
  const float max_kv = 10000.0F;
  return {
      {own_index, std::int64_t{0}, last_index, std::int64_t{0}, "esc_index"},
      {telemetry_hz, telemetry_hz, max_telemetry_hz, std::int64_t{0}, "telemetry_rate"},
      {kv, kv, max_kv, 0.0F, "motor_kv"},
      {false, false, {}, {}, "direction_reversed"},
      {std::string("unnamed"), std::string("unnamed"), {}, {}, "label"},
  };
}

template <class Number> bool within(const GetSet::Response& parameter, Number value) {
  const auto* min = std::get_if<Number>(&parameter.min_value);
  const auto* max = std::get_if<Number>(&parameter.max_value);
  // written so that NaN fails
  return (min == nullptr || value >= *min) && (max == nullptr || value <= *max);
}

bool takes(const GetSet::Response& parameter, const GetSet::Value& value) {
  if (value.index() != parameter.value.index()) {
    return false;
  }
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    return within(parameter, *integer);
  }
  const auto* real = std::get_if<float>(&value);
  return real == nullptr || within(parameter, *real);
}

/// Sends esc.Status, and has parameters of every kind in GetSet, by name and by index from 0. A
/// value of another kind or out of range leaves the parameter unchanged; nothing is saved to ROM.
class Esc final : public ForeignRole {
 public:
  Esc(const EscSetup& setup, Broadcast broadcast, Time power_on)
      : ForeignRole(std::move(broadcast)), setup_(setup), parameters_(parameters(setup.index)),
        next_status_(power_on + setup.period) {}

  [[nodiscard]] dronecan::GetSet::Response
  get_set(const dronecan::GetSet::Request& request) override;

  [[nodiscard]] Time next_deadline() const override { return next_status_; }

  void advance(Time now) override;

 private:
  EscSetup setup_;
  std::vector<dronecan::GetSet::Response> parameters_; ///< each as the response to a read
  Time next_status_;
};

GetSet::Response Esc::get_set(const GetSet::Request& request) {
  auto found = parameters_.end();
  if (!request.name.empty()) {
    found = std::ranges::find(parameters_, request.name, &GetSet::Response::name);
  } else if (request.index < parameters_.size()) {
    found = parameters_.begin() + request.index;
  }
  if (found == parameters_.end()) {
    return {};
  }
  if (takes(*found, request.value)) {
    found->value = request.value;
  }
  return *found;
}

void Esc::advance(Time now) {
  if (next_status_ > now) {
    return;
  }
  next_status_ += setup_.period;
  constexpr float volts = 24.0F;
  constexpr float kelvin = 310.0F;
  constexpr unsigned index_shift = 2;
  dronecan::Payload payload;
  const auto put = [&payload](std::initializer_list<std::uint8_t> bytes) {
    payload.append(dronecan::Bytes(bytes.begin(), bytes.size()));
  };
  put({0, 0, 0, 0});                                // error count
  for (const float value : {volts, 0.0F, kelvin}) { // voltage, current, temperature
    const std::uint16_t bits = dronecan::to_float16(value);
    put({static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8U)});
  }
  // Speed and power of a stopped motor: 18 and 7 bits of 0, then 5 bits of index.
  put({0, 0, 0, static_cast<std::uint8_t>(setup_.index << index_shift)});
  broadcast(esc_status, priority, payload.bytes());
}

} // namespace

std::unique_ptr<ForeignRole> make_esc(const EscSetup& setup, ForeignRole::Broadcast broadcast,
                                      Time power_on) {
  return std::make_unique<Esc>(setup, std::move(broadcast), power_on);
}

} // namespace blactl::sim
