#pragma once
// Where this user's state lies: what blactl must still know after a restart of the machine.

#include <string>

namespace blactl::state {

/// $BLACTL_STATE_DIR, else $XDG_STATE_HOME/blactl, else ~/.local/state/blactl; empty: this user has
/// none. It need not be there yet.
[[nodiscard]] std::string state_folder();

} // namespace blactl::state
