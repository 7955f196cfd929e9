#pragma once
// The folder of this user's persistent state.

#include "blactl/base/error.hpp"

#include <string>
#include <vector>

namespace blactl::state {

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

} // namespace blactl::state
