// Measurements by writes to RAM while the output is off, or does nothing: nothing moves, and each
// setting is restored after its measurement.

#include "blactl/dronecan/types.hpp"

#include "fleet/characterize/findings.hpp"
#include "fleet/characterize/test_bench.hpp"
#include "fleet/characterize/texts.hpp"

#include <algorithm>
#include <array>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;
using dronecan::GetNodeInfo;
using dronecan::GetSet;

namespace {

/// An angle within the limits of every servo (0x38 is not below it, 0x39 not above).
constexpr std::int64_t zero_angle = 0;

/// After this time notices and the health show a change.
constexpr Duration until_shown = std::chrono::milliseconds(50);

/// Concludes from the response to a write out of range.
void conclude_out_of_range(Notes& notes, const Reply& reply, std::int64_t before,
                           std::int64_t limit, std::int64_t after) {
  const auto answer = reply.answered() ? GetSet::Response::decode(reply.payload) : std::nullopt;
  const auto* value = answer ? std::get_if<std::int64_t>(&answer->value) : nullptr;
  if (after == limit && (!answer || (value != nullptr && *value == limit))) {
    notes.found("out_of_range", "clamp");
  } else if (answer && value == nullptr && after == before) {
    notes.found("out_of_range", "fail");
    notes.found("failure_with_name", !answer->name.empty());
  } else if (value != nullptr && *value == before && after == before) {
    notes.found("out_of_range", "refuse");
  } else {
    const std::string told = value != nullptr ? std::to_string(*value)
                             : answer         ? std::string("-")
                                              : say<texts::bench_no_answer>();
    notes.leave("out_of_range", say<texts::bench_odd_answer>(told, after));
  }
}

/// Writes once, and to 0x27 only; upwards, where an accepted value does the least.
Result<void> measure_out_of_range(TestBench& bench, Notes& notes) {
  const bla::Parameter& parameter = *bench.servo().identity.parameter(at::timeout_time);
  const std::int64_t lowest = *parameter.min, highest = *parameter.max;
  const auto before = bench.read(at::timeout_time);
  if (!before) {
    return std::unexpected(before.error());
  }
  const bool upwards = *before != highest;
  const auto reply = bench.write_timeout_time(upwards ? highest + 1 : lowest - 1);
  const auto after = reply ? bench.read(at::timeout_time) : std::unexpected(reply.error());
  if (!after) {
    return std::unexpected(after.error());
  }
  conclude_out_of_range(notes, *reply, *before, upwards ? highest : lowest, *after);
  return {};
}

/// A value that was written stays, or becomes 0.
void conclude_kept(Notes& notes, std::string_view setting, std::int64_t written,
                   std::int64_t after) {
  if (after == written || after == 0) {
    notes.found(setting, after == written);
  } else {
    notes.leave(setting, say<texts::bench_read_value>(after));
  }
}

/// 0x01 while 0x25 is off or missing: the command is a standstill.
Result<void> measure_disabled_command(TestBench& bench, Notes& notes) {
  const bool has_switch = bench.held(at::speed_torque_control).has_value();
  auto set = bench.set(at::command_angle, zero_angle);
  set = set && has_switch ? bench.set(at::speed_torque_control, 0) : set;
  const auto held = set ? bench.write(at::command_speed, 0) : std::unexpected(set.error());
  if (!held) {
    return std::unexpected(held.error());
  }
  const bool ignores = *held == bla::not_active;
  if (has_switch) {
    notes.found("ignores_disabled_commands", ignores);
    notes.leave("speed_control_before_1100", say<texts::bench_has_switch>());
  } else if (ignores) {
    notes.found("ignores_disabled_commands", true);
    notes.found("speed_control_before_1100", false);
  } else {
    notes.leave("ignores_disabled_commands", say<texts::bench_takes_disabled>());
    notes.leave("speed_control_before_1100", say<texts::bench_takes_disabled>());
  }
  return bench.set(at::command_angle, zero_angle);
}

/// A speed that is dropped with 0x25; with the output off nothing turns.
Result<void> measure_kept_command(TestBench& bench, Notes& notes) {
  constexpr std::int64_t some_rpm = 10;
  if (!bench.held(at::speed_torque_control)) {
    notes.leave("keeps_disabled_command", say<texts::bench_no_switch>());
    return {};
  }
  const auto on = bench.set(at::speed_torque_control, 1);
  const auto held = on ? bench.write(at::command_speed, some_rpm) : std::unexpected(on.error());
  if (!held) {
    return std::unexpected(held.error());
  }
  if (*held != some_rpm) {
    notes.leave("keeps_disabled_command", say<texts::bench_command_not_taken>(*held));
    return bench.set(at::command_angle, zero_angle);
  }
  const auto off = bench.set(at::speed_torque_control, 0);
  const auto after = off ? bench.read(at::command_speed) : std::unexpected(off.error());
  if (!after) {
    return std::unexpected(after.error());
  }
  conclude_kept(notes, "keeps_disabled_command", some_rpm, *after);
  return bench.set(at::command_angle, zero_angle);
}

/// Whether the present notices, and nothing worse, change the health.
Result<void> look_at_health(TestBench& bench, Notes& notes) {
  if (auto waited = bench.pause(until_shown); !waited) {
    return waited;
  }
  std::array<std::int64_t, 3> faults{};
  const std::array registers{at::fault_notice, at::fault_warning, at::fault_failure};
  for (std::size_t i = 0; i < registers.size(); ++i) {
    const auto raw = bench.read(registers.at(i));
    if (!raw) {
      return std::unexpected(raw.error());
    }
    faults.at(i) = *raw;
  }
  const auto& [notices, warnings, failures] = faults;
  if (notices == 0 || warnings != 0 || failures != 0) {
    return {};
  }
  const auto reply = bench.ask(
      ask(bench.servo().id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), Patience{}));
  if (!reply) {
    return std::unexpected(reply.error());
  }
  const auto info =
      reply->answered() ? GetNodeInfo::Response::decode(reply->payload) : std::nullopt;
  if (info && info->status.health <= dronecan::Health::warning) {
    notes.found("notices_warn", info->status.health == dronecan::Health::warning);
  }
  return {};
}

/// A limit of 0 on a shaft that stands still: at the limit, not beyond.
Result<void> measure_limits(TestBench& bench, Notes& notes) {
  const std::int64_t bit = bit_of(bench, "speed_limit_cw");
  const auto speed = bench.read(at::current_speed);
  const auto before = speed ? bench.read(at::fault_notice) : speed;
  if (!before) {
    return std::unexpected(before.error());
  }
  if (*speed != 0) {
    notes.leave("inclusive_limits", say<texts::bench_shaft_turns>());
    return {};
  }
  if ((*before & bit) != 0 && bench.held(at::speed_limit_cw) != 0) {
    notes.leave("inclusive_limits", say<texts::bench_notice_before>());
    return {};
  }
  auto set = bench.set(at::speed_limit_cw, 0);
  set = set ? bench.pause(until_shown) : set;
  const auto after = set ? bench.read(at::fault_notice) : std::unexpected(set.error());
  if (!after) {
    return std::unexpected(after.error());
  }
  notes.found("inclusive_limits", (*after & bit) != 0);
  return look_at_health(bench, notes);
}

/// An angle beyond limits of 0 deg: the value of 0x00, and the resulting notice.
Result<void> measure_limited_angle(TestBench& bench, Notes& notes) {
  constexpr std::int64_t beyond = 10;
  for (const Address limit : {at::angle_limit_cw, at::angle_limit_ccw}) {
    if (auto set = bench.set(limit, 0); !set) {
      return set;
    }
  }
  const auto held = bench.write(at::command_angle, beyond);
  if (!held) {
    return std::unexpected(held.error());
  }
  conclude_kept(notes, "keeps_limited_angle", beyond, *held);
  if (auto looked = look_at_health(bench, notes); !looked) {
    return looked;
  }
  if (!notes.value("notices_warn")) {
    notes.leave("notices_warn", say<texts::bench_no_notice>());
  }
  return bench.set(at::command_angle, zero_angle);
}

/// An angle at a limit that the shaft is well inside of; and, as a check, beyond it.
Result<void> measure_command_at_limit(TestBench& bench, Notes& notes) {
  constexpr std::int64_t room = 100;
  const std::int64_t bit = bit_of(bench, "angle_limit_cw");
  const auto angle = bench.read(at::current_angle);
  const std::int64_t limit = std::max(angle.value_or(0), zero_angle) + room;
  std::array<std::int64_t, 3> notices{};
  const std::array commanded{zero_angle, limit, limit + room};
  auto set = angle ? bench.set(at::angle_limit_cw, limit) : std::unexpected(angle.error());
  for (std::size_t i = 0; i < commanded.size(); ++i) {
    const auto held =
        set ? bench.write(at::command_angle, commanded.at(i)) : std::unexpected(set.error());
    set = held ? bench.pause(until_shown) : std::unexpected(held.error());
    const auto notice = set ? bench.read(at::fault_notice) : std::unexpected(set.error());
    if (!notice) {
      return std::unexpected(notice.error());
    }
    notices.at(i) = *notice & bit;
  }
  const auto there = bench.read(at::current_angle);
  if (there && (notices[0] != 0 || *there >= limit)) {
    notes.leave("command_at_limit_notifies", say<texts::bench_notice_before>());
  } else if (there && notices[1] == 0 && notices[2] == 0) { // a command may become the limit
    notes.leave("command_at_limit_notifies", say<texts::bench_no_notice_beyond>());
  } else if (there) {
    notes.found("command_at_limit_notifies", notices[1] != 0);
  }
  return there ? bench.set(at::command_angle, zero_angle) : std::unexpected(there.error());
}

} // namespace

std::int64_t bit_of(const TestBench& bench, std::string_view code) {
  const auto bits = bench.profiles().fault_bits();
  const auto found = std::ranges::find(bits, code, &bla::FaultBit::code);
  return found != bits.end() ? std::int64_t{1} << found->bit : 0;
}

std::span<const Measurement> measurements_at_rest() {
  static constexpr std::array<Measurement, 9> all{
      measure_out_of_range,     measure_disabled_command, measure_kept_command,
      measure_limits,           measure_limited_angle,    measure_array_command,
      measure_command_at_limit, measure_waiting_settings, measure_protection};
  return all;
}

} // namespace blactl::fleet
