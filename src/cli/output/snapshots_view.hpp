#pragma once
// Output of `blactl undo --list`: the recorded changes.

#include "blactl/base/json_writer.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/state/snapshot_store.hpp"

#include "cli/output/page.hpp"

#include <span>
#include <string>

namespace blactl::cli {

/// The member "snapshots" of the document (contract, section 5), in the order given. `profiles`:
/// for the names of settings.
void write_snapshots(JsonWriter& json, std::span<const state::SnapshotEntry> entries,
                     const bla::Profiles& profiles);

[[nodiscard]] std::string text(std::span<const state::SnapshotEntry> entries,
                               const bla::Profiles& profiles, const Page& page);

} // namespace blactl::cli
