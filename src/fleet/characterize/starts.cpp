// How a servo restarts and saves: how long it is silent, what it sends first, what it holds then.

#include "blactl/fleet/texts.hpp"

#include "fleet/characterize/findings.hpp"
#include "fleet/characterize/soft_start.hpp"
#include "fleet/characterize/test_bench.hpp"
#include "fleet/characterize/texts.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <numeric>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;
using bla::Values;

namespace {

using namespace std::chrono_literals;

/// How near to 0 deg a shaft may be, and to a command, to count as there (4.14: about 1 deg).
constexpr std::int64_t near_decideg = 20;

/// In the order in which they are read: the angle last, as it was when all else was read.
std::vector<Address> at_once() {
  std::vector<Address> all{at::torque_output, at::soft_start, at::command_angle};
  for (const auto& [address, raw] : soft_start_limits) {
    all.push_back(address);
  }
  all.push_back(at::current_angle);
  return all;
}

std::string milliseconds(Duration time) {
  return std::to_string(std::chrono::round<std::chrono::milliseconds>(time).count()) + "ms";
}

/// From the answer on, or the question where there was none.
std::optional<Duration> silence_of(const Start& start) {
  return start.first ? std::optional(*start.first - start.answered.value_or(start.asked))
                     : std::nullopt;
}

/// What 0x00 says of a servo that was turned on in place.
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

/// What the registers say that the soft start changes, while it goes on. `rom`: what they hold.
void judge_soft_start(const Values& seen, const Values& rom, Notes& notes) {
  const auto angle = bla::find(seen, at::current_angle);
  if (!angle || seen.size() < at_once().size() - 1) {
    notes.leave("soft_start_shows", say<texts::bench_start_unheard>());
    return;
  }
  if (!starts_softly(seen)) {
    notes.leave("soft_start_shows", say<texts::bench_no_soft_start>());
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

/// The middle one: one start in which something was not heard counts for nothing.
std::optional<Duration> middle(std::vector<Duration> times) {
  std::ranges::sort(times);
  return times.empty() ? std::nullopt : std::optional(times[times.size() / 2]);
}

void judge_first_status(std::span<const Start> starts, Notes& notes) {
  std::vector<Duration> times;
  for (const Start& start : starts) {
    if (start.first && start.first_status) {
      times.push_back(*start.first_status - *start.first);
    }
  }
  const auto time = middle(times);
  if (time && *time <= 1s) {
    notes.found("first_node_status", milliseconds(*time));
  } else {
    notes.leave("first_node_status", say<texts::bench_start_unheard>());
  }
}

void judge_allocation(std::span<const Start> starts, Notes& notes) {
  const Start& last = starts.back();
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

/// The mean of the starts; empty: a servo that asks for a node ID first does not show it.
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
  const Duration mean = std::accumulate(times.begin(), times.end(), Duration{}) /
                        static_cast<Duration::rep>(times.size());
  notes.found("boot_time", milliseconds(mean));
  return mean;
}

void judge_save(const Start& save, std::optional<Duration> boot, Notes& notes) {
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
                                                 : say<texts::bench_start_unheard>());
  }
}

/// 0x11 alone, and just before it is restarted: a servo that takes the question for an order does
/// what it would do anyway.
Result<void> read_write_only(TestBench& bench, Notes& notes) {
  const std::uint32_t boots = bench.roster().member(bench.servo().id).boots;
  const auto reply = bench.read_once(at::reboot);
  if (!reply) {
    return std::unexpected(reply.error());
  }
  const auto answer =
      reply->answered() ? dronecan::GetSet::Response::decode(reply->payload) : std::nullopt;
  const auto* value = answer ? std::get_if<std::int64_t>(&answer->value) : nullptr;
  if (bench.roster().member(bench.servo().id).boots != boots) {
    notes.leave("write_only_reads", say<texts::bench_restarted_by_read>());
  } else if (!answer) {
    notes.leave("write_only_reads", say<texts::bench_no_answer>());
  } else if (value == nullptr) {
    notes.found("write_only_reads", "fail");
  } else if (*value == 0) {
    notes.found("write_only_reads", "zero");
  } else {
    notes.leave("write_only_reads", say<texts::bench_read_value>(*value));
  }
  return {};
}

/// It has just started, and nothing was written since but the output, which is given back: RAM is
/// what ROM is, and to save it changes nothing.
Result<Start> save_what_rom_holds(TestBench& bench, const Values& rom) {
  if (auto output = bench.set(at::torque_output, *bla::find(rom, at::torque_output)); !output) {
    return std::unexpected(output.error());
  }
  auto save = bench.restart(RestartKind::save);
  if (!save) {
    return save;
  }
  const auto after = bench.rest();
  if (!after) {
    return std::unexpected(after.error());
  }
  if (auto difference = bench.differs_from(*after, rom)) {
    return std::unexpected(std::move(*difference));
  }
  return save;
}

Result<bool> is_rom_readable(TestBench& bench) {
  if (rom_state(bench.servo().identity) == nullptr) {
    return true;
  }
  const auto bits = bench.profiles().fault_bits();
  const auto corrupt = std::ranges::find(bits, "rom_corrupt", &bla::FaultBit::code);
  const auto warnings = bench.read(at::fault_warning);
  if (!warnings) {
    return std::unexpected(warnings.error());
  }
  return corrupt == bits.end() || (*warnings >> corrupt->bit & 1) == 0;
}

} // namespace

Result<void> measure_starts(TestBench& bench, Notes& notes) {
  bench.tell(texts::bench_stage_starts);
  if (auto read = read_write_only(bench, notes); !read) {
    return read;
  }
  std::vector<Start> starts;
  Values seen;
  for (int i = 0; i < restarts_measured; ++i) {
    auto start = bench.restart(RestartKind::restart, i == 0 ? at_once() : std::vector<Address>());
    if (!start) {
      return std::unexpected(start.error());
    }
    starts.push_back(*start);
    seen = i == 0 ? bench.at_once() : seen;
  }
  const auto rom = bench.rest();
  if (!rom) {
    return std::unexpected(rom.error());
  }
  judge_start_angle(seen, notes);
  judge_soft_start(seen, *rom, notes);
  const auto boot = judge_boot(starts, notes);
  const auto readable = is_rom_readable(bench);
  if (!readable) {
    return std::unexpected(readable.error());
  }
  if (!*readable) {
    for (const auto* setting : {"answers_save_first", "rom_write_time"}) {
      notes.leave(setting, say<texts::bench_rom_unreadable>());
    }
  } else {
    bench.tell(texts::bench_stage_save);
    const auto save = save_what_rom_holds(bench, *rom);
    if (!save) {
      return std::unexpected(save.error());
    }
    judge_save(*save, boot, notes);
    starts.push_back(*save);
  }
  judge_first_status(starts, notes);
  judge_allocation(starts, notes);
  return {};
}

} // namespace blactl::fleet
