// What the record says of a change once its outcome is known.

#include "blactl/fleet/change/history.hpp"

#include <algorithm>
#include <utility>

namespace blactl::fleet {

using dronecan::UniqueId;
using state::ChangeEnd;

/// For an undo that has begun elsewhere: servos it did not begin are not done yet, either.
bool History::is_half_undone() const {
  return command_ == "undo" && std::ranges::any_of(kept_, [](const auto& each) {
           return each.second.was_changed && !each.second.is_empty;
         });
}

namespace {

/// Whether a restart has brought back what this change wrote: one of its tries has saved it.
bool is_shown_in_rom(const state::SnapshotEntry& change, const RomReading& rom) {
  return std::ranges::any_of(change.written, [&](const auto& written) {
    const auto held = change.held.find(written.first);
    return held != change.held.end() && held->second != written.second &&
           bla::find(rom.values, bla::Address(written.first)) == written.second;
  });
}

/// Adds named values that were held already, until another write of the command changed them.
bool take_in_changed(const ChangeResult& result, state::SnapshotEntry& entry) {
  bool has_more = false;
  for (const RegisterChange& change : result.changes) {
    const bool is_other =
        change.status == ChangeStatus::written ||
        (change.status == ChangeStatus::mismatch && change.after != change.before);
    const bool can_go_back = change.before && change.parameter->is_setting() &&
                             result.servo.identity.check_takes(*change.parameter).has_value();
    if (is_other && can_go_back) {
      has_more |= entry.held.emplace(change.parameter->address.value(), *change.before).second;
    }
  }
  return has_more;
}

} // namespace

/// A restart that has shown what ROM holds took all that RAM held beside it.
Result<void> History::keep_what_was_taken(std::span<const ChangeResult> results,
                                          const Session& session) {
  std::vector<state::SnapshotEntry> entries;
  for (const ChangeResult& result : results) {
    const auto ram =
        result.servo.unique_id ? before_proof_.extract(*result.servo.unique_id) : Roms::node_type();
    if (!ram || !result.was_sent || result.may_have_saved || !result.rom) {
      continue;
    }
    std::erase_if(ram.mapped(), [&](const auto& held) {
      return bla::find(result.rom->values, bla::Address(held.first)).value_or(held.second) ==
             held.second;
    });
    const auto known = kept_.find(ram.key());
    state::SnapshotEntry entry =
        known != kept_.end() ? known->second.entry : new_entry(result.servo, session);
    const std::size_t size = entry.held.size();
    entry.held.merge(ram.mapped());
    if (entry.held.size() != size) {
      entries.push_back(std::move(entry));
    }
  }
  return entries.empty() ? Result<void>() : store(std::move(entries), session.wall());
}

/// A restart that has shown what ROM holds replaced nothing else.
Result<void> History::leave_what_was_lost(std::span<const ChangeResult> results, WallTime now) {
  std::vector<state::SnapshotEntry> shorter;
  for (const ChangeResult& result : results) {
    const auto known = result.servo.unique_id ? kept_.find(*result.servo.unique_id) : kept_.end();
    if (known == kept_.end() || !result.was_sent || result.may_have_saved || !result.rom) {
      continue;
    }
    state::SnapshotEntry& entry = known->second.entry;
    const std::size_t size = entry.held.size();
    std::erase_if(entry.held, [&](const auto& held) {
      return bla::find(result.rom->values, bla::Address(held.first)) == held.second;
    });
    known->second.is_empty = entry.held.empty();
    for (const auto& [address, raw] : entry.held) {
      known->second.lost.insert(address);
    }
    if (entry.held.size() != size && !entry.held.empty()) {
      shorter.push_back(entry);
    }
  }
  const auto kept =
      shorter.empty() ? Result<std::vector<std::int64_t>>() : snapshots_.keep(shorter, now);
  return kept ? Result<void>() : std::unexpected(kept.error());
}

/// What is known after a round.
struct History::Settled {
  std::vector<state::Settlement> ends{};
  std::vector<state::SnapshotEntry> entries{}; ///< to be kept anew
};

/// The entries of one servo, after a round that has ended like this.
void History::settle(const ChangeResult& result, WallTime wall, Settled& settled) {
  if (!result.servo.unique_id) {
    return;
  }
  const UniqueId& unique_id = *result.servo.unique_id;
  const bool is_known = result.saved || !result.may_have_saved;
  if (auto earlier = lasting_.extract(unique_id)) {
    for (state::SnapshotEntry& change : earlier.mapped()) {
      if (!is_known) {
        continue; // as they are
      }
      if (result.may_have_saved) {
        settled.ends.push_back({change.number, ChangeEnd::saved, wall});
      } else {
        settled.entries.push_back(std::move(change));
      }
    }
  }
  const auto known = kept_.find(unique_id);
  if (known == kept_.end()) {
    return;
  }
  Kept& kept = known->second;
  if (kept.is_empty || (!kept.was_changed && !is_half_undone())) {
    settled.ends.push_back({.number = kept.entry.number, .end = ChangeEnd::never_begun});
    kept_.erase(known);
    run_ = kept_.empty() ? joined_ : run_;
    return;
  }
  const auto trials = in_ram_.find(unique_id);
  const bool is_of_ram = kept.entry.saved && !kept.was_saved && trials != in_ram_.end();
  const auto others = in_rom_.find(unique_id);
  const bool is_of_rom = !kept.entry.saved && kept.was_saved && others != in_rom_.end();
  const bool was_planned = std::exchange(kept.entry.saved, kept.was_saved) == kept.was_saved;
  const bool has_more = kept.was_changed && take_in_changed(result, kept.entry);
  if (is_of_rom) { // another node has saved it
    for (const auto& [address, raw] : others->second) {
      kept.entry.held.insert_or_assign(address, raw);
    }
  }
  if (!is_known) { // until the servo restarts
    if (!was_planned || has_more) {
      settled.entries.push_back(kept.entry);
    }
    return;
  }
  kept.entry.settled = wall;
  if (is_of_ram) { // RAM alone was changed
    for (const auto& [address, raw] : trials->second) {
      kept.entry.held.insert_or_assign(address, raw);
    }
  }
  if (is_of_ram || is_of_rom || has_more) {
    settled.entries.push_back(kept.entry);
  } else {
    settled.ends.push_back({.number = kept.entry.number,
                            .end = kept.was_saved ? ChangeEnd::saved : ChangeEnd::not_saved,
                            .at = wall});
  }
}

Result<void> History::settle(std::span<const ChangeResult> results, WallTime wall) {
  for (const ChangeResult& result : results) {
    const auto known = result.servo.unique_id ? kept_.find(*result.servo.unique_id) : kept_.end();
    if (known != kept_.end()) {
      known->second.was_changed = known->second.was_changed || result.may_have_changed;
      known->second.was_saved = known->second.was_saved || result.may_have_saved ||
                                (result.rom && is_shown_in_rom(known->second.entry, *result.rom));
    }
  }
  Settled settled;
  for (const ChangeResult& result : results) {
    settle(result, wall, settled);
  }
  auto ended = settled.ends.empty() ? Result<void>() : snapshots_.settle(settled.ends);
  const auto kept = settled.entries.empty() ? Result<std::vector<std::int64_t>>()
                                            : snapshots_.keep(settled.entries, wall);
  return kept || !ended ? ended : std::unexpected(kept.error());
}

} // namespace blactl::fleet
