// Judges the observed starts of a servo.

#include "blactl/bla/fault_bits.hpp"

#include "fleet/characterize/findings.hpp"
#include "fleet/characterize/soft_start.hpp"
#include "fleet/characterize/texts.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <span>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;
using bla::Values;

namespace {

using namespace std::chrono_literals;

/// The tolerance at 0 deg and at a commanded angle (4.14: about 1 deg).
constexpr std::int64_t near_decideg = 20;

std::string milliseconds(Duration time) {
  return std::to_string(std::chrono::round<std::chrono::milliseconds>(time).count()) + "ms";
}

/// From the response, or the request if there was none.
std::optional<Duration> silence_of(const Start& start) {
  return start.first ? std::optional(*start.first - start.answered.value_or(start.asked))
                     : std::nullopt;
}

/// Judges the value of 0x00 in a servo that started in place.
void judge_start_angle(const Values& seen, Notes& notes) {
  const auto angle = bla::find(seen, at::current_angle);
  const auto command = bla::find(seen, at::command_angle);
  if (!angle || !command) {
    notes.leave("start_angle", say<texts::bench_start_unheard>());
  } else if (starts_softly(seen)) {
    notes.leave("start_angle", say<texts::bench_started_softly>());
  } else if (std::abs(*angle) <= near_decideg) {
    notes.leave("start_angle", say<texts::bench_at_zero>());
  } else if (*command == 0) {
    notes.found("start_angle", "zero");
  } else if (std::abs(*command - *angle) <= near_decideg) {
    notes.found("start_angle", "present");
  } else {
    notes.leave("start_angle", say<texts::bench_read_value>(*command));
  }
}

/// Whether something else ended the soft start (4.14): a timeout that turns the output off, or a
/// fault that stops the motor.
bool was_cut(const Values& seen, const Values& rom) {
  constexpr std::int64_t goes_on = 0;      // of 0x26
  constexpr std::int64_t long_after = 500; // ms; the servo was asked at once
  const bool times_out = bla::find(rom, at::timeout_action) != goes_on &&
                         bla::find(rom, at::timeout_time).value_or(0) < long_after;
  return times_out || bla::find(seen, at::fault_warning) != 0 ||
         bla::find(seen, at::fault_failure) != 0;
}

/// Judges the registers that the soft start overrides while it goes on. `rom`: their own values.
void judge_soft_start(const Values& seen, const Values& rom, Notes& notes) {
  const auto angle = bla::find(seen, at::current_angle);
  if (!angle || seen.size() < asked_at_once().size() - 1) {
    notes.leave("soft_start_shows", say<texts::bench_start_unheard>());
    return;
  }
  if (!starts_softly(seen)) {
    notes.leave("soft_start_shows", say<texts::bench_no_soft_start>());
    return;
  }
  if (was_cut(seen, rom)) {
    notes.leave("soft_start_shows", say<texts::bench_soft_start_cut>());
    return;
  }
  if (std::abs(*angle) <= near_decideg) { // it is over
    notes.leave("soft_start_shows", say<texts::bench_at_zero>());
    return;
  }
  bool shows = true, hides = true, differs = false;
  for (const auto& [address, limit] : soft_start_limits) {
    const auto told = bla::find(seen, address), held = bla::find(rom, address);
    shows = shows && told == limit;
    hides = hides && told == held;
    differs = differs || held != limit;
  }
  if (differs && shows != hides) {
    notes.found("soft_start_shows", shows);
  } else {
    notes.leave("soft_start_shows", say<texts::bench_limits_alike>());
  }
}

/// By the bits that tell why it restarted by itself, if it has one: none of these starts was that.
void judge_failures(const StartsSeen& seen, Notes& notes) {
  const std::int64_t before = seen.failures_before & bla::fault::restart_failures;
  if (before != 0) {
    notes.found("restart_keeps_failures", (seen.failures_after & before) == before);
  }
}

/// The median: a single start with a missed frame does not count. Empty: most starts differ from
/// it, and so may the next.
std::optional<Duration> usual(std::vector<Duration> times) {
  constexpr Duration alike = 20ms; // starts vary by more than a millisecond
  if (times.empty()) {
    return std::nullopt;
  }
  std::ranges::sort(times);
  const Duration middle = times[times.size() / 2];
  const auto near = static_cast<std::size_t>(std::ranges::count_if(
      times, [&](Duration time) { return std::chrono::abs(time - middle) <= alike; }));
  return 2 * near > times.size() ? std::optional(middle) : std::nullopt;
}

std::vector<Duration> until_first_status(std::span<const Start> starts) {
  std::vector<Duration> times;
  for (const Start& start : starts) {
    if (start.first && start.first_status) {
      times.push_back(*start.first_status - *start.first);
    }
  }
  return times;
}

void judge_first_status(const std::vector<Duration>& times, Notes& notes) {
  const auto time = usual(times);
  if (time && *time <= 1s) {
    notes.found("first_node_status", milliseconds(*time));
  } else {
    notes.leave("first_node_status", times.empty() || time ? say<texts::bench_start_unheard>()
                                                           : say<texts::bench_starts_vary>());
  }
}

/// The first frame of a start may look like the next one of the previous run. Its NodeStatus does
/// not, and comes with the same delay as in other starts. `until_status` empty: it does not.
void correct(Start& start, std::optional<Duration> until_status) {
  if (start.first && start.first_status && until_status) {
    start.first = std::min(*start.first, *start.first_status - *until_status);
  }
}

void judge_allocation(const Start& last, Notes& notes) {
  if (!last.requested) {
    notes.leave("assignment_shows", say<texts::bench_static_id>());
    return;
  }
  const Time gone = last.answered.value_or(last.asked);
  notes.observe(say<texts::bench_seen_request>(), milliseconds(*last.requested - gone));
  if (last.first) {
    notes.observe(say<texts::bench_seen_allocation>(), milliseconds(*last.first - gone));
  }
  if (last.first_mode) {
    notes.found("assignment_shows", *last.first_mode == dronecan::Mode::initialization);
  } else {
    notes.leave("assignment_shows", say<texts::bench_start_unheard>());
  }
}

/// As usual; empty: starts vary, or a servo that requests a node ID first does not show it.
std::optional<Duration> judge_boot(std::span<const Start> starts, Notes& notes) {
  std::vector<Duration> times;
  std::string all;
  for (const Start& start : starts) {
    const auto silence = silence_of(start);
    if (start.requested || !silence) {
      notes.leave("boot_time", start.requested ? say<texts::bench_asks_for_id>()
                                               : say<texts::bench_start_unheard>());
      return std::nullopt;
    }
    times.push_back(*silence);
    all += (all.empty() ? "" : ", ") + milliseconds(*silence);
  }
  notes.observe(say<texts::bench_seen_starts>(), all);
  const auto boot = usual(times);
  if (boot) {
    notes.found("boot_time", milliseconds(*boot));
  } else {
    notes.leave("boot_time", say<texts::bench_starts_vary>());
  }
  return boot;
}

/// A save is silent for longer than a restart. One that got no response and is not longer may never
/// have been received: the servo restarted by itself on the request.
bool is_proven(const Start& save, std::optional<Duration> boot) {
  constexpr Duration shortest_write = 20ms; // starts vary by more than a millisecond
  const auto silence = silence_of(save);
  return save.answered || (boot && silence && *silence >= *boot + shortest_write);
}

void judge_save(const Start& save, std::optional<Duration> boot, Notes& notes) {
  if (!is_proven(save, boot)) {
    for (const auto* setting : {"answers_save_first", "rom_write_time"}) {
      notes.leave(setting, save.requested ? say<texts::bench_asks_for_id>()
                                          : say<texts::bench_save_unproven>());
    }
    return;
  }
  if (save.answered) {
    notes.found("answers_save_first", true);
  } else if (notes.has_lost_answers()) {
    notes.leave("answers_save_first", say<texts::bench_answers_lost>());
  } else {
    notes.found("answers_save_first", false);
  }
  const auto silence = silence_of(save);
  if (silence) {
    notes.observe(say<texts::bench_seen_save>(), milliseconds(*silence));
  }
  if (boot && silence) {
    notes.found("rom_write_time", milliseconds(std::max(Duration{}, *silence - *boot)));
  } else {
    notes.leave("rom_write_time", save.requested ? say<texts::bench_asks_for_id>()
                                  : silence      ? say<texts::bench_starts_vary>()
                                                 : say<texts::bench_start_unheard>());
  }
}

} // namespace

std::vector<Address> asked_at_once() {
  std::vector<Address> all{at::torque_output, at::soft_start, at::command_angle, at::fault_warning,
                           at::fault_failure};
  for (const auto& [address, raw] : soft_start_limits) {
    all.push_back(address);
  }
  all.push_back(at::current_angle);
  return all;
}

void judge_starts(StartsSeen seen, Notes& notes) {
  std::vector<Start> all = seen.restarts;
  if (seen.save) {
    all.push_back(*seen.save);
  }
  const auto until_statuses = until_first_status(all);
  const auto until_status = usual(until_statuses);
  judge_first_status(until_statuses, notes);
  judge_allocation(all.back(), notes);
  judge_failures(seen, notes);
  judge_start_angle(seen.at_once, notes);
  judge_soft_start(seen.at_once, seen.rom, notes);
  for (Start& start : seen.restarts) {
    correct(start, until_status);
  }
  const auto boot = judge_boot(seen.restarts, notes);
  if (seen.save) {
    correct(*seen.save, until_status);
    judge_save(*seen.save, boot, notes);
  } else if (!seen.is_rom_readable) {
    for (const auto* setting : {"answers_save_first", "rom_write_time"}) {
      notes.leave(setting, say<texts::bench_rom_unreadable>());
    }
  }
}

} // namespace blactl::fleet
