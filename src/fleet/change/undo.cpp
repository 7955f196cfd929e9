#include "blactl/fleet/change/undo.hpp"

#include "blactl/fleet/bus/texts.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
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

using Tries = std::vector<state::SnapshotEntry>;

/// Whether the newer one is a change of its own: what was saved, and done, was repeated in RAM
/// only.
bool is_of_its_own(const state::SnapshotEntry& newer, const state::SnapshotEntry& older) {
  return !newer.saved && !newer.written.empty() && older.saved && older.ended;
}

/// All entries of the run of this one that are one change with it, the newest first.
Result<Tries> tries_of(const state::SnapshotStore& store, state::SnapshotEntry entry) {
  Tries tries{std::move(entry)};
  for (;;) {
    auto earlier = store.before(tries.back());
    if (!earlier) {
      return std::unexpected(std::move(earlier.error()));
    }
    if (!*earlier || (*earlier)->run != tries.back().run ||
        is_of_its_own(tries.front(), **earlier)) {
      return tries;
    }
    tries.push_back(std::move(**earlier));
  }
}

/// Where one try was saved, what a restart took from RAM in another one is not saved: ROM never
/// held it.
void leave_out_what_was_taken(Tries& tries) {
  for (state::SnapshotEntry& each : tries) {
    std::erase_if(each.held, [&](const auto& held) {
      return !each.saved && !each.written.contains(held.first);
    });
  }
}

/// All that the command of this entry did to its unit, as one: it may have been repeated, with
/// other wishes, until it succeeded.
Result<Undoing> whole(const state::SnapshotStore& store, state::SnapshotEntry entry) {
  auto tries = tries_of(store, std::move(entry));
  if (!tries) {
    return std::unexpected(std::move(tries.error()));
  }
  const bool was_saved = std::ranges::any_of(*tries, [](const state::SnapshotEntry& each) {
    return each.saved && !each.held.empty(); // by others since: see History::join()
  });
  if (was_saved) {
    leave_out_what_was_taken(*tries);
  }
  Undoing whole{.entry = tries->front()};
  for (const state::SnapshotEntry& each : *tries) {
    for (const auto& [address, raw] : each.held) {
      const auto [found, is_new] = whole.entry.held.emplace(address, raw);
      // History::join() has left out what somebody else changed in between
      if (!is_new && each.written.contains(address)) {
        found->second = raw;
      }
    }
    whole.numbers.push_back(each.number);
  }
  whole.entry.saved = was_saved;
  return whole;
}

/// The change to undo in place of this entry, if that is an undo which did not end, perhaps several
/// times.
Result<std::optional<Undoing>> meant_by(const state::SnapshotStore& store,
                                        state::SnapshotEntry entry) {
  const bool goes_on = is_unfinished_undo(entry);
  while (is_unfinished_undo(entry)) {
    auto before = store.before(entry);
    if (!before) {
      return std::unexpected(std::move(before.error()));
    }
    if (!*before) {
      return std::nullopt;
    }
    entry = std::move(**before);
  }
  auto undoing = whole(store, std::move(entry));
  if (undoing) {
    undoing->goes_on = goes_on;
  }
  return undoing;
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
  for (auto entry = entries->begin(); entry != entries->end();) { // changed by others since
    const auto last = store.last(entry->unique_id);
    if (!last) {
      return std::unexpected(last.error());
    }
    entry = *last && (*last)->run != entry->run ? entries->erase(entry) : std::next(entry);
  }
  std::map<dronecan::UniqueId, std::int64_t> newest;
  for (const state::SnapshotEntry& entry : *entries) {
    newest[entry.unique_id] = std::max(newest[entry.unique_id], entry.number);
  }
  std::erase_if(*entries, [&newest](const state::SnapshotEntry& entry) {
    return entry.number != newest.at(entry.unique_id); // of an earlier try, see whole()
  });
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
