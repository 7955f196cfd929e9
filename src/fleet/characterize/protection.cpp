// Whether the motor stops at a limit of 0x3E to 0x41, or only beyond it. With the output on the
// shaft is commanded an angle inside a wide dead band, which moves nothing; when a protection has
// ended, 0x00 reads the present angle instead (4.7).

#include "blactl/bla/fault_bits.hpp"

#include "fleet/characterize/findings.hpp"
#include "fleet/characterize/test_bench.hpp"
#include "fleet/characterize/texts.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;

namespace {

using namespace std::chrono_literals;

constexpr std::int64_t output_is_on = 0, output_is_off = 1; // 4.13

/// How far the commanded angle is from the shaft, the dead band meanwhile, and how far the angle
/// limits are away.
constexpr std::int64_t aside_decideg = 10, dead_band_decideg = 50, room_decideg = 200;

/// What a reading of the angle may differ by while the shaft stands.
constexpr std::int64_t noise_decideg = 3;

/// A limit and the reading that it is put on: 1 beyond that, at it, and 1 inside.
struct Protection {
  Address limit, reading;
  bool is_upper;

  [[nodiscard]] std::int64_t beyond(std::int64_t read) const {
    return is_upper ? read - 1 : read + 1;
  }

  [[nodiscard]] std::int64_t inside(std::int64_t read) const {
    return is_upper ? read + 1 : read - 1;
  }
};

/// Temperature first: it is steadier.
constexpr std::array protections{
    Protection{at::temperature_limit_high, at::current_temperature, true},
    Protection{at::temperature_limit_low, at::current_temperature, false},
    Protection{at::voltage_limit_high, at::current_voltage, true},
    Protection{at::voltage_limit_low, at::current_voltage, false},
};

/// Whether the limit is away from the reading now, and can be put to both sides of it.
bool fits(const TestBench& bench, const Protection& each, std::int64_t read) {
  const bla::Parameter* limit = bench.servo().identity.parameter(each.limit);
  const auto held = bench.held(each.limit);
  if (limit == nullptr || !limit->min || !limit->max || !held) {
    return false;
  }
  const auto [least, most] = std::minmax({each.beyond(read), each.inside(read)});
  const bool is_away = each.is_upper ? *held > most : *held < least;
  return is_away && least >= *limit->min && most <= *limit->max;
}

/// With its reading.
struct Chosen {
  Protection protection;
  std::int64_t read = 0;
};

Result<std::optional<Chosen>> choose_protection(TestBench& bench) {
  for (const Protection& each : protections) {
    const auto read = bench.read(each.reading);
    if (!read) {
      return std::unexpected(read.error());
    }
    if (fits(bench, each, *read)) {
      return Chosen{each, *read};
    }
  }
  return std::nullopt;
}

/// The reason why the output must not come on now; empty: it may.
Result<std::string> obstacle(TestBench& bench) {
  std::array<std::int64_t, 4> now{};
  const std::array registers{at::fault_notice, at::fault_warning, at::fault_failure,
                             at::current_speed};
  for (std::size_t i = 0; i < registers.size(); ++i) {
    const auto raw = bench.read(registers.at(i));
    if (!raw) {
      return std::unexpected(raw.error());
    }
    now.at(i) = *raw;
  }
  const auto& [notices, warnings, failures, speed] = now;
  const bool has_pulses =
      bench.servo().identity.check_pwm_input() && (notices & bla::fault::pwm_missing) == 0;
  return warnings != 0 || failures != 0 ? say<texts::bench_other_faults>()
         : speed != 0                   ? say<texts::bench_shaft_turns>()
         : has_pulses                   ? say<texts::bench_pulses>()
                                        : std::string();
}

/// Switches the output on so that nothing moves, whatever is commanded near `angle`: no timeout, no
/// limit, no boost, and a wide dead band.
Result<void> hold_loosely(TestBench& bench, std::int64_t angle) {
  constexpr std::int64_t holds_after_timeout = 0; // 0x26
  const std::int64_t dead_band = bench.held(at::angle_dead_band).value_or(0);
  auto set = bench.set(at::angle_limit_cw, std::max<std::int64_t>(angle, 0) + room_decideg);
  const std::array settings{
      std::pair(at::angle_limit_ccw, std::min<std::int64_t>(angle, 0) - room_decideg),
      std::pair(at::timeout_action, holds_after_timeout),
      std::pair(at::angle_dead_band, std::max(dead_band, dead_band_decideg)),
      std::pair(at::angle_boost, std::int64_t{0}),
      std::pair(at::command_angle, angle),
      std::pair(at::torque_output, output_is_on)};
  for (const auto& [address, raw] : settings) {
    const bool is_there = address == at::command_angle || bench.held(address).has_value();
    set = set && is_there ? bench.set(address, raw) : set;
  }
  return set;
}

/// What became of 0x00; `unsteady`: the reading, or the shaft, did not stand still.
enum class Command : std::uint8_t { kept, replaced, unsteady };

/// Puts the limit to a value for a moment.
Result<Command> command_after(TestBench& bench, const Chosen& chosen, std::int64_t angle,
                              std::int64_t limit) {
  constexpr int looks = 5;
  constexpr Duration between = 40ms;
  const std::int64_t commanded = angle + aside_decideg;
  const auto& [protection, read] = chosen;
  const auto taken = bench.write(at::command_angle, commanded);
  auto set = taken ? bench.set(protection.limit, limit) : std::unexpected(taken.error());
  bool is_steady = taken == commanded;
  for (int i = 0; i <= looks; ++i) { // the last one without the limit
    set = set && i == looks ? bench.set(protection.limit, *bench.held(protection.limit)) : set;
    set = set ? bench.pause(between) : set;
    const auto now = set ? bench.read(protection.reading) : std::unexpected(set.error());
    if (!now) {
      return std::unexpected(now.error());
    }
    is_steady = is_steady && *now == read;
  }
  const auto held = bench.read(at::command_angle);
  const auto there = held ? bench.read(at::current_angle) : held;
  if (!there) {
    return std::unexpected(there.error());
  }
  const bool stands = std::abs(*there - angle) <= noise_decideg;
  const bool is_replaced = std::abs(*held - angle) <= noise_decideg;
  return !is_steady || !stands || (!is_replaced && *held != commanded) ? Command::unsteady
         : is_replaced                                                 ? Command::replaced
                                                                       : Command::kept;
}

/// Only if 0x00 stays with the limit inside, and is replaced with it beyond, it tells anything; and
/// twice, as a reading may flicker between two looks.
Result<void> compare(TestBench& bench, Notes& notes, const Chosen& chosen, std::int64_t angle) {
  const std::int64_t inside = chosen.protection.inside(chosen.read);
  const std::int64_t beyond = chosen.protection.beyond(chosen.read);
  const std::array limits{inside, chosen.read, beyond, chosen.read, inside};
  std::array<Command, limits.size()> became{};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const auto command = command_after(bench, chosen, angle, limits.at(i));
    if (!command) {
      return std::unexpected(command.error());
    }
    became.at(i) = *command;
  }
  const bool is_steady = std::ranges::find(became, Command::unsteady) == became.end() &&
                         became[0] == Command::kept && became[4] == Command::kept &&
                         became[1] == became[3];
  if (!is_steady) {
    notes.leave("inclusive_stops", say<texts::bench_reading_unsteady>());
  } else if (became[2] != Command::replaced) {
    notes.leave("inclusive_stops", say<texts::bench_protection_unseen>());
  } else {
    notes.found("inclusive_stops", became[1] == Command::replaced);
  }
  return {};
}

} // namespace

/// In the end the output is off again, before any setting is restored.
Result<void> measure_protection(TestBench& bench, Notes& notes) {
  const auto why = obstacle(bench);
  const auto chosen = why ? choose_protection(bench) : std::unexpected(why.error());
  const auto angle = chosen ? bench.read(at::current_angle) : std::unexpected(chosen.error());
  if (!angle) {
    return std::unexpected(angle.error());
  }
  if (!why->empty() || !*chosen) {
    notes.leave("inclusive_stops", why->empty() ? say<texts::bench_limits_out_of_reach>() : *why);
    return {};
  }
  auto measured = hold_loosely(bench, *angle);
  measured = measured ? compare(bench, notes, **chosen, *angle) : measured;
  return measured ? bench.set(at::torque_output, output_is_off) : measured;
}

} // namespace blactl::fleet
