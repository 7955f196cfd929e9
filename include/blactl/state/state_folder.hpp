#pragma once
// Where this user's state lies: what blactl must still know after a restart of the machine.

#include "blactl/base/error.hpp"

#include <string>

namespace blactl::state {

/// $BLACTL_STATE_DIR, else $XDG_STATE_HOME/blactl, else ~/.local/state/blactl; empty: this user has
/// none. It need not be there yet.
[[nodiscard]] std::string state_folder();

/// Whether what must outlive a process can be kept there; makes nothing. Errors: state (this user
/// has no folder), permission (it, or the one that it would be made in, cannot be written).
[[nodiscard]] Result<void> check_state_folder(const std::string& folder);

} // namespace blactl::state
