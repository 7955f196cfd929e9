#include "blactl/fleet/safety.hpp"

#include "blactl/fleet/texts.hpp"

#include <algorithm>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;

namespace {

constexpr Address torque_limit_cw{0x3C}, torque_limit_ccw{0x3D};
constexpr Address temperature{0x0B}, temperature_high{0x3E}, temperature_low{0x3F};
constexpr Address voltage{0x0C}, voltage_high{0x40}, voltage_low{0x41};
constexpr Address fault_notice{0x19};
constexpr Address pwm_neutral{0x34}, pwm_range{0x35};

bool is_pwm_mapping(Address address) {
  return address == pwm_neutral || address == pwm_range || address == at::pwm_output_range ||
         address == at::pwm_mode;
}

bool is_one_of(Address address, std::initializer_list<Address> set) {
  return std::ranges::find(set, address) != set.end();
}

/// Registers of which every change is asked.
bool always_asks(Address address) {
  return is_one_of(address, {at::command_angle, at::command_speed, at::command_torque,
                             at::torque_output, at::reverse, at::extended_angle, at::timeout_action,
                             at::timeout_time, at::origin});
}

/// A limit that the present value trips at once (inclusive, 4.12).
bool trips(const Change& change, std::optional<std::int64_t> present, bool is_upper) {
  return !present || (is_upper ? *present >= change.requested : *present <= change.requested);
}

/// The bit "no PWM input" of 0x19 (4.12).
bool has_pwm_input(const ReadJob& values) {
  constexpr std::int64_t no_input = 1LL << 20;
  const auto notices = values.raw(fault_notice);
  return !notices || (*notices & no_input) == 0;
}

bool is_planned(const Change& change) {
  return change.status == ChangeStatus::planned;
}

bool gives_node_id(const Change& change) {
  return is_planned(change) && change.parameter->address == at::static_node_id &&
         change.requested != 0;
}

} // namespace

std::vector<Address> values_needed(Address address) {
  if (is_one_of(address, {at::angle_limit_cw, at::angle_limit_ccw})) {
    return {at::current_angle};
  }
  if (is_one_of(address, {temperature_high, temperature_low})) {
    return {temperature};
  }
  if (is_one_of(address, {voltage_high, voltage_low})) {
    return {voltage};
  }
  return is_pwm_mapping(address) ? std::vector{fault_notice} : std::vector<Address>{};
}

bool may_move(const Change& change, const ReadJob& values) {
  const Address address = change.parameter->address;
  if (always_asks(address)) {
    return true;
  }
  if (is_one_of(address, {torque_limit_cw, torque_limit_ccw})) {
    return change.requested == 0;
  }
  if (is_pwm_mapping(address)) {
    return has_pwm_input(values);
  }
  // An angle limit inside of the present angle pulls the shaft back.
  const auto angle = values.raw(at::current_angle);
  if (address == at::angle_limit_cw) {
    return !angle || change.requested < *angle;
  }
  if (address == at::angle_limit_ccw) {
    return !angle || change.requested > *angle;
  }
  if (is_one_of(address, {temperature_high, temperature_low})) {
    return trips(change, values.raw(temperature), address == temperature_high);
  }
  if (is_one_of(address, {voltage_high, voltage_low})) {
    return trips(change, values.raw(voltage), address == voltage_high);
  }
  return false;
}

bool needs_watch(std::span<const Change> changes) {
  return std::ranges::any_of(changes, is_planned);
}

Error doubled(dronecan::NodeId id) {
  return {Code::duplicate_node_id, say<texts::doubled_target>(id.value()),
          say<texts::doubled_target_hint>(), id.value()};
}

std::optional<Error> forbidden(Session& session, const Member& servo, bool moves,
                               bool while_driven) {
  const Roster& roster = session.roster();
  const std::uint8_t id = servo.id.value();
  if (roster.is_doubled(servo.id)) {
    return doubled(servo.id);
  }
  if (!servo.is_known()) { // what was read and asked belongs to the time before
    return Error{Code::state, say<texts::restarted_before_write>(id), say<texts::run_again_hint>(),
                 id};
  }
  if (const auto by = roster.armed_by()) {
    return Error{Code::armed, say<texts::armed>(by->value()), say<texts::armed_hint>(), id};
  }
  const auto driver = roster.driver_of(servo, session.now());
  if (moves && driver && !while_driven) {
    return Error{Code::driven, say<texts::driven>(driver->value(), id), say<texts::driven_hint>(),
                 id};
  }
  return std::nullopt;
}

std::optional<Error> forbidden(Session& session, std::span<const Change> changes,
                               const ReadJob& values, bool while_driven) {
  const Roster& roster = session.roster();
  const Member& servo = values.member();
  const std::uint8_t id = servo.id.value();
  if (std::ranges::none_of(changes, is_planned)) {
    return std::nullopt;
  }
  const bool moves = std::ranges::any_of(changes, [&](const Change& change) {
    return is_planned(change) && may_move(change, values);
  });
  if (auto error = forbidden(session, servo, moves, while_driven)) {
    return error;
  }
  for (const Change& change : changes) {
    if (gives_node_id(change) && change.requested == roster.local().value()) {
      return Error{Code::out_of_range, say<texts::node_id_is_ours>(change.requested),
                   say<texts::own_id_in_use_hint>(), id};
    }
    if (gives_node_id(change) && change.requested != id &&
        roster.heard(dronecan::NodeId(static_cast<std::uint8_t>(change.requested)))) {
      return Error{Code::out_of_range, say<texts::node_id_in_use>(change.requested),
                   say<texts::node_id_in_use_hint>(), id};
    }
  }
  return std::nullopt;
}

} // namespace blactl::fleet
