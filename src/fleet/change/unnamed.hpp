#pragma once
// Settings that a change does not name, and that RAM and ROM hold differently.

#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/change/goal.hpp"
#include "blactl/fleet/change/history.hpp"
#include "blactl/fleet/change/plan.hpp"

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

/// Likewise about what other nodes were heard to write since this was told, before the restart at
/// that time has taken it.
[[nodiscard]] std::vector<Warning> written_before_restart(const Roster& roster, const Plan& plan,
                                                          Time restart);

/// Of the warnings of an earlier round, those of what its restart has taken from RAM.
[[nodiscard]] std::vector<Warning> losses(std::vector<Warning> warnings);

} // namespace blactl::fleet
