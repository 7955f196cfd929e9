#pragma once
// What was seen of the starts of a servo, and what that says.

#include "blactl/bla/values.hpp"

#include "fleet/characterize/ear.hpp"
#include "fleet/characterize/findings.hpp"

#include <optional>
#include <vector>

namespace blactl::fleet {

struct StartsSeen {
  std::vector<Start> restarts{};
  bla::Values at_once{};       ///< what it told as soon as it was back from the first
  bla::Values rom{};           ///< what the registers hold after a start, once it is at rest
  bool is_rom_readable = true; ///< else nothing was saved
  std::optional<Start> save{};
};

/// What to ask it as soon as it is back; the angle last, as it is when all else was read.
[[nodiscard]] std::vector<bla::Address> asked_at_once();

void judge_starts(StartsSeen seen, Notes& notes);

} // namespace blactl::fleet
