#pragma once
// Judges the observed starts of a servo.

#include "blactl/bla/values.hpp"

#include "fleet/characterize/ear.hpp"
#include "fleet/characterize/findings.hpp"

#include <optional>
#include <vector>

namespace blactl::fleet {

struct StartsSeen {
  std::vector<Start> restarts{};
  bla::Values at_once{};       ///< read as soon as it was back from the first start
  bla::Values rom{};           ///< register values at rest after a start
  bool is_rom_readable = true; ///< false: nothing was saved
  std::optional<Start> save{};
};

/// The registers to read as soon as it is back; the angle last, so that it is as of the end of the
/// reads.
[[nodiscard]] std::vector<bla::Address> asked_at_once();

void judge_starts(StartsSeen seen, Notes& notes);

} // namespace blactl::fleet
