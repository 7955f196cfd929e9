#pragma once
// Settings that a change does not name, and that RAM and ROM hold differently.

#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/change/goal.hpp"
#include "blactl/fleet/change/history.hpp"

#include <vector>

namespace blactl::fleet {

/// Empty if nothing makes RAM and ROM equal, there is no record (null), or the servo could not read
/// its ROM: what it held before a change was not from there then.
[[nodiscard]] ToldRom told_rom(const Goal& goal, const Snapshot& held, History* record,
                               const Session& session);

/// Warnings about registers outside of the goal that differ between RAM and ROM: SAVE keeps them, a
/// restart resets them, or has done so (`is_restarted`).
[[nodiscard]] std::vector<Warning> unnamed(const Goal& goal, const Snapshot& ram,
                                           const ToldRom& rom, Need need,
                                           bool is_restarted = false);

} // namespace blactl::fleet
