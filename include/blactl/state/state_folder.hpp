#pragma once
// The folder of this user's persistent state.

#include "blactl/base/error.hpp"

#include <string>
#include <vector>

namespace blactl::state {

/// In it: the state of simulated buses.
inline constexpr const char* simulated_folder = "simulated";

/// $BLACTL_STATE_DIR, else $XDG_STATE_HOME/blactl, else ~/.local/state/blactl; empty: this user has
/// none. It need not exist yet.
[[nodiscard]] std::string state_folder();

/// Checks that state can be stored there, without creating anything. Errors: state (this user has
/// no folder), permission (it, or its parent if it does not exist, is not writable), io (its disk
/// is full).
[[nodiscard]] Result<void> check_state_folder(const std::string& folder);

/// Reads all of the state files in a folder, and creates none. Returns the errors of those that
/// cannot be used: bad_file (also where only this reading meets the damage), permission, io, busy.
[[nodiscard]] std::vector<Error> check_state_files(const std::string& folder);

/// Whether a state file of this user is, or would be, at this path: one of the folder, or of that
/// of simulated buses in it, with what SQLite puts beside it.
[[nodiscard]] bool is_state_file(const std::string& path);

} // namespace blactl::state
