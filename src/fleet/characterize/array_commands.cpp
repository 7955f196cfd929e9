// Measurements by ArrayCommand while the output is off: nothing moves, and no other servo obeys.

#include "fleet/characterize/findings.hpp"
#include "fleet/characterize/servo_ids.hpp"
#include "fleet/characterize/test_bench.hpp"
#include "fleet/characterize/texts.hpp"

#include <array>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;

namespace {

constexpr std::int64_t no_angle = 0; ///< within the limits of every servo
constexpr int most_tries = 3;        ///< messages are not retried

/// How an ArrayCommand was seen to be obeyed: by the register, or by the bit of 0x19 alone.
enum class Obeyed : std::uint8_t { unseen, shown, noticed };

/// An angle within the limits other than the commanded one.
std::optional<std::int64_t> free_angle(const TestBench& bench) {
  constexpr std::int64_t step = 10;
  const std::int64_t cw = bench.held(at::angle_limit_cw).value_or(0);
  const std::int64_t ccw = bench.held(at::angle_limit_ccw).value_or(0);
  return cw >= step ? std::optional(step) : ccw <= -step ? std::optional(-step) : std::nullopt;
}

/// A command that no register shows: the notice that it is beyond a limit shows whether it was
/// accepted.
Result<bool> is_noticed(TestBench& bench, std::int64_t servo_id, std::int64_t angle) {
  const Address limit = angle > 0 ? at::angle_limit_cw : at::angle_limit_ccw;
  const std::int64_t bit = bit_of(bench, angle > 0 ? "angle_limit_cw" : "angle_limit_ccw");
  auto set = bench.set(at::command_angle, no_angle);
  set = set ? bench.set(limit, angle / 2) : set;
  const auto before = set ? bench.read(at::fault_notice) : std::unexpected(set.error());
  if (!before) {
    return std::unexpected(before.error());
  }
  const auto sent = bench.command(servo_id, at::command_angle, angle);
  const auto after = sent ? bench.read(at::fault_notice) : std::unexpected(sent.error());
  set =
      after ? bench.set(limit, bench.held(limit).value_or(angle)) : std::unexpected(after.error());
  if (!set) {
    return std::unexpected(set.error());
  }
  return (*before & bit) == 0 && (*after & bit) != 0;
}

/// Commands a free angle; afterwards 0 deg is commanded again.
Result<Obeyed> command(TestBench& bench, std::int64_t servo_id, std::int64_t angle) {
  if (auto set = bench.set(at::command_angle, no_angle); !set) {
    return std::unexpected(set.error());
  }
  auto obeyed = Obeyed::unseen;
  for (int tries = 0; tries < most_tries && obeyed == Obeyed::unseen; ++tries) {
    const auto sent = bench.command(servo_id, at::command_angle, angle);
    const auto held = sent ? bench.read(at::command_angle) : std::unexpected(sent.error());
    if (!held) {
      return std::unexpected(held.error());
    }
    obeyed = *held == angle ? Obeyed::shown : obeyed;
  }
  if (obeyed == Obeyed::unseen) {
    const auto noticed = is_noticed(bench, servo_id, angle);
    if (!noticed) {
      return std::unexpected(noticed.error());
    }
    obeyed = *noticed ? Obeyed::noticed : obeyed;
  }
  const auto set = bench.set(at::command_angle, no_angle);
  return set ? Result<Obeyed>(obeyed) : std::unexpected(set.error());
}

/// 0x01 after some tries to command this speed; with the output off nothing turns.
Result<std::int64_t> speed_after(TestBench& bench, std::int64_t servo_id, std::int64_t rpm) {
  Result<std::int64_t> held = bla::not_active;
  for (int tries = 0; tries < most_tries && held && *held != rpm; ++tries) {
    const auto sent = bench.command(servo_id, at::command_speed, rpm);
    held = sent ? bench.read(at::command_speed) : std::unexpected(sent.error());
  }
  return held;
}

/// The least speed out of range, between two that are taken: so it was not lost.
Result<void> measure_range(TestBench& bench, Notes& notes, std::int64_t servo_id) {
  constexpr std::int64_t some_rpm = 10, other_rpm = 11;
  const std::int64_t most = bench.servo().identity.parameter(at::command_speed)->max.value_or(0);
  if (!bench.held(at::speed_torque_control)) {
    notes.leave("array_out_of_range", say<texts::bench_no_switch>());
    return {};
  }
  const auto on = bench.set(at::speed_torque_control, 1);
  std::array<std::int64_t, 3> held{};
  const std::array commanded{some_rpm, most + 1, other_rpm};
  for (std::size_t i = 0; i < commanded.size(); ++i) {
    const auto speed =
        on ? speed_after(bench, servo_id, commanded.at(i)) : std::unexpected(on.error());
    if (!speed) {
      return std::unexpected(speed.error());
    }
    held.at(i) = *speed;
  }
  if (held[0] != some_rpm || held[2] != other_rpm) {
    notes.leave("array_out_of_range", say<texts::bench_command_not_taken>(held[2]));
  } else if (held[1] == most || held[1] == some_rpm) {
    notes.found("array_out_of_range", held[1] == most ? "clamp" : "ignore");
  } else {
    notes.leave("array_out_of_range", say<texts::bench_read_value>(held[1]));
  }
  return bench.set(at::command_angle, no_angle);
}

/// A servo that obeys another servo ID, under ID 0.
Result<void> measure_servo_id_0(TestBench& bench, Notes& notes, std::int64_t angle) {
  if (!is_free_servo_id(bench, 0)) {
    notes.leave("obeys_servo_id_0", say<texts::bench_servo_id_shared>(0));
    return {};
  }
  const auto is_0 = take_servo_id(bench, 0);
  if (!is_0 || *is_0 != ServoIdTaken::at_once) {
    notes.leave("obeys_servo_id_0", say<texts::bench_servo_id_waits>());
    return is_0 ? Result<void>() : std::unexpected(is_0.error());
  }
  const auto obeyed = command(bench, 0, angle);
  if (obeyed) {
    notes.found("obeys_servo_id_0", *obeyed != Obeyed::unseen);
  }
  return obeyed ? Result<void>() : std::unexpected(obeyed.error());
}

/// A servo with ID 0 that seems deaf: does it obey another ID? Returns that.
Result<std::optional<std::int64_t>> leave_servo_id_0(TestBench& bench) {
  const auto other = free_servo_id(bench);
  const auto taken =
      other ? take_servo_id(bench, *other) : Result<ServoIdTaken>(ServoIdTaken::unseen);
  if (!taken) {
    return std::unexpected(taken.error());
  }
  return *taken == ServoIdTaken::at_once ? other : std::nullopt;
}

void leave_all(Notes& notes, const std::string& reason) {
  for (const auto* setting : {"array_command_shows", "array_out_of_range", "obeys_servo_id_0"}) {
    notes.leave(setting, reason);
  }
}

} // namespace

Result<void> measure_array_command(TestBench& bench, Notes& notes) {
  std::int64_t servo_id = bench.held(at::servo_id).value_or(0);
  const auto angle = free_angle(bench);
  if (!angle || !is_free_servo_id(bench, servo_id)) {
    leave_all(notes, angle ? say<texts::bench_servo_id_shared>(servo_id)
                           : say<texts::bench_no_free_angle>());
    return {};
  }
  auto obeyed = command(bench, servo_id, *angle);
  const bool has_id_0 = servo_id == 0;
  const bool may_be_deaf = obeyed && has_id_0 && *obeyed == Obeyed::unseen;
  if (may_be_deaf) {
    const auto other = leave_servo_id_0(bench);
    if (other && !*other) {
      leave_all(notes, say<texts::bench_servo_id_waits>());
      return {};
    }
    servo_id = other ? **other : servo_id;
    obeyed = other ? command(bench, servo_id, *angle) : std::unexpected(other.error());
  }
  if (!obeyed || *obeyed == Obeyed::unseen) {
    leave_all(notes, say<texts::bench_command_unseen>());
    return obeyed ? Result<void>() : std::unexpected(obeyed.error());
  }
  notes.found("array_command_shows", *obeyed == Obeyed::shown);
  if (has_id_0) {
    notes.found("obeys_servo_id_0", !may_be_deaf);
  }
  Result<void> measured;
  if (*obeyed == Obeyed::shown) {
    measured = measure_range(bench, notes, servo_id);
  } else {
    notes.leave("array_out_of_range", say<texts::bench_array_not_shown>());
  }
  return measured && !has_id_0 ? measure_servo_id_0(bench, notes, *angle) : measured;
}

} // namespace blactl::fleet
