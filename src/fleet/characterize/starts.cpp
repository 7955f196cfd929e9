// Measurements of restarts and saves. Each start leaves the servo with its ROM settings.

#include "fleet/characterize/findings.hpp"
#include "fleet/characterize/test_bench.hpp"
#include "fleet/characterize/texts.hpp"

#include <algorithm>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;
using bla::Values;

namespace {

/// Reads 0x11 only, and just before a restart: a servo that takes the read for an order restarts
/// anyway.
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

/// Since the servo started, only the output was written, and restored: RAM equals ROM, and saving
/// changes nothing.
Result<Start> save_what_rom_holds(TestBench& bench, const Values& rom) {
  if (auto output = bench.set(at::torque_output, *bla::find(rom, at::torque_output)); !output) {
    return std::unexpected(output.error());
  }
  auto save = bench.restart(RestartKind::save);
  const auto after = save ? bench.rest() : std::unexpected(save.error());
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

Result<StartsSeen> see_starts(TestBench& bench) {
  StartsSeen seen;
  const auto failures = bench.read(at::fault_failure);
  if (!failures) {
    return std::unexpected(failures.error());
  }
  seen.failures_before = *failures;
  for (int i = 0; i < restarts_measured; ++i) {
    auto start =
        bench.restart(RestartKind::restart, i == 0 ? asked_at_once() : std::vector<Address>());
    if (!start) {
      return std::unexpected(start.error());
    }
    seen.restarts.push_back(*start);
    if (i == 0) {
      seen.at_once = bench.at_once();
    }
  }
  const auto after = bench.read(at::fault_failure);
  auto rom = after ? bench.rest() : std::unexpected(after.error());
  seen.failures_after = after.value_or(0);
  const auto readable = rom ? is_rom_readable(bench) : std::unexpected(rom.error());
  if (!readable) {
    return std::unexpected(readable.error());
  }
  bench.learn_rom(*rom);
  seen.rom = std::move(*rom);
  seen.is_rom_readable = *readable;
  if (*readable) {
    bench.tell(texts::bench_stage_save);
    auto save = save_what_rom_holds(bench, seen.rom);
    if (!save) {
      return std::unexpected(save.error());
    }
    seen.save = *save;
  }
  return seen;
}

} // namespace

Result<void> measure_starts(TestBench& bench, Notes& notes) {
  bench.tell(texts::bench_stage_starts);
  const auto read = read_write_only(bench, notes);
  auto seen = read ? see_starts(bench) : std::unexpected(read.error());
  if (!seen) {
    return std::unexpected(seen.error());
  }
  judge_starts(std::move(*seen), notes);
  return {};
}

} // namespace blactl::fleet
