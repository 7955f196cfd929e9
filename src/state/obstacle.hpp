#pragma once
// What keeps this process from writing state.

#include <string>

namespace blactl::state {

/// The errno of what keeps this process from writing files in an existing folder: missing rights,
/// or a full disk, on which a transaction and its journal would find no room; 0: nothing.
[[nodiscard]] int obstacle_in(const std::string& folder);

/// As obstacle_in(), for an existing file and the journal beside it.
[[nodiscard]] int obstacle_to(const std::string& file);

/// Whether a folder, which exists, is on a file system of another machine: locks and syncs are no
/// promise there. FUSE is not one by itself, nor is 9P, on which containers stand.
[[nodiscard]] bool is_on_network(const std::string& folder);

} // namespace blactl::state
