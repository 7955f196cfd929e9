#include "blactl/fleet/change/undo.hpp"

#include "blactl/fleet/bus/texts.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

namespace blactl::fleet {

Result<Wanted> to_undo(const state::SnapshotEntry& entry, const bla::Profiles& profiles) {
  Wanted wanted{.restart = entry.saved ? std::optional(RestartKind::save) : std::nullopt};
  for (const auto& [address, raw] : entry.held) {
    const bla::Address setting(address);
    if (!profiles.is_setting(setting)) {
      return fail(Code::bad_file, say<texts::no_setting_in_history>(setting.name()),
                  say<texts::no_setting_in_history_hint>());
    }
    auto assignment = bla::make_assignment(profiles, setting.name(), std::to_string(raw) + "raw");
    if (!assignment) {
      return std::unexpected(std::move(assignment.error()));
    }
    wanted.assignments.push_back(std::move(*assignment));
  }
  return wanted;
}

namespace {

bool is_unfinished_undo(const state::SnapshotEntry& entry) {
  return entry.command == "undo" && !entry.ended;
}

/// The change to undo in place of this entry, if that is an undo which did not end.
Result<std::optional<Undoing>> meant_by(const state::SnapshotStore& store,
                                        state::SnapshotEntry entry) {
  if (!is_unfinished_undo(entry)) {
    return Undoing{.entry = std::move(entry)};
  }
  auto before = store.before(entry);
  if (!before) {
    return std::unexpected(std::move(before.error()));
  }
  return *before ? std::optional(Undoing{.entry = std::move(**before), .goes_on = true})
                 : std::nullopt;
}

} // namespace

Result<std::optional<Undoing>> last_change(const state::SnapshotStore& store,
                                           const dronecan::UniqueId& unique_id) {
  auto last = store.last(unique_id);
  if (!last) {
    return std::unexpected(std::move(last.error()));
  }
  return *last ? meant_by(store, std::move(**last)) : std::optional<Undoing>();
}

Result<std::vector<Undoing>> last_changes(const state::SnapshotStore& store) {
  auto entries = store.last_run();
  if (!entries) {
    return std::unexpected(std::move(entries.error()));
  }
  if (std::ranges::any_of(*entries, is_unfinished_undo)) {
    std::erase_if(*entries, std::not_fn(is_unfinished_undo));
  }
  std::vector<Undoing> changes;
  for (state::SnapshotEntry& entry : *entries) {
    auto change = meant_by(store, std::move(entry));
    if (!change) {
      return std::unexpected(std::move(change.error()));
    }
    if (*change) {
      changes.push_back(std::move(**change));
    }
  }
  return changes;
}

} // namespace blactl::fleet
