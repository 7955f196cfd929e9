#include "blactl/fleet/change/undo.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/change/history.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <map>
#include <ranges>
#include <set>
#include <string>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;

Result<Wanted> to_undo(const state::SnapshotEntry& entry, const bla::Profiles& profiles) {
  Wanted wanted{.restart = entry.saved ? std::optional(RestartKind::save) : std::nullopt,
                .never_while_driven = true};
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

/// Since a time of the record, as far as the uptime tells.
bool has_run_on(const Servo& servo, WallTime since, const Session& session) {
  const auto started = History::start_of(servo, session);
  return started && started_before(*started, since, session.wall()) && since <= session.wall();
}

/// Whether RAM was loaded from ROM after the last write of a change that was in RAM only.
bool has_restarted_since(const state::SnapshotEntry& entry, const Servo& servo,
                         const Session& session) {
  const auto started = History::start_of(servo, session);
  return !entry.saved && started && is_of_this_clock(entry, session) &&
         started_after(*started, last_write(entry), session.wall());
}

/// The registers of a change as RAM holds them now.
Result<Snapshot> read_held(const Undoing& change, NodeId id, Session& session,
                           const bla::Profiles& profiles, const Identification::Options& options) {
  std::vector<bla::Address> addresses;
  for (const auto& [address, raw] : change.entry.held) {
    addresses.emplace_back(address);
  }
  auto read = take_snapshots(session, profiles, std::array{id}, options, [&](const Servo& asked) {
    return asked.identity.registers(addresses);
  });
  return read.broken ? Result<Snapshot>(std::unexpected(*read.broken))
                     : std::move(read.servos.front());
}

/// Whether RAM holds a value that the change has put there.
bool shows(const Undoing& change, const Snapshot& ram) {
  return std::ranges::any_of(change.entry.held, [&](const auto& held) {
    const auto written = change.written.find(held.first);
    const auto now = ram.raw(bla::Address(held.first));
    return now && *now != held.second && written != change.written.end() &&
           written->second.contains(*now);
  });
}

bool is_unfinished_undo(const state::SnapshotEntry& entry) {
  return entry.command == "undo" && !entry.ended;
}

using Tries = std::vector<state::SnapshotEntry>;

/// Whether the newer one is a change of its own: in RAM only, after a try that was saved, or has
/// ended with a restart otherwise. (One without a restart since has gone on in the same entry.)
bool is_of_its_own(const state::SnapshotEntry& newer, const state::SnapshotEntry& older) {
  return !newer.saved && !newer.written.empty() && older.saved;
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

/// See Undoing.
std::optional<WallTime> perhaps_saved_since(const Tries& tries) {
  std::optional<WallTime> first;
  for (const state::SnapshotEntry& each : tries) {
    if (each.saved && each.settled) {
      return std::nullopt;
    }
    first = each.saved ? std::optional(each.at) : first; // the newest comes first
  }
  return first;
}

/// Several changes of one unit, the newest first, as one.
Undoing as_one(Tries changes) {
  const bool was_saved = std::ranges::any_of(changes, [](const state::SnapshotEntry& each) {
    return each.saved && !each.held.empty(); // by others since: see History::join()
  });
  if (was_saved) {
    leave_out_what_was_taken(changes);
  }
  Undoing one{.entry = changes.front(), .perhaps_saved_since = perhaps_saved_since(changes)};
  const auto has_other_clock = [&](const state::SnapshotEntry& each) {
    return !is_same_clock(each.clock, changes.front().clock);
  };
  if (std::ranges::any_of(changes, has_other_clock)) {
    one.entry.clock.reset();
  }
  std::set<std::uint8_t> told_by_save; // what ROM held, as far as known, and not RAM alone
  for (const state::SnapshotEntry& each : changes) {
    for (const auto& [address, raw] : each.held) {
      const auto [found, is_new] = one.entry.held.emplace(address, raw);
      // History::join() has left out what somebody else changed in between
      const bool is_older = each.saved || !told_by_save.contains(address);
      if (!is_new && is_older && each.written.contains(address)) {
        found->second = raw;
      }
      if (each.saved) {
        told_by_save.insert(address);
      }
    }
    for (const auto& [address, raw] : each.written) {
      one.written[address].insert(raw);
    }
    one.numbers.push_back(each.number);
  }
  one.entry.saved = was_saved;
  return one;
}

/// All that the command of this entry did to its unit: it may have been repeated, with other
/// wishes, until it succeeded.
Result<Undoing> whole(const state::SnapshotStore& store, state::SnapshotEntry entry) {
  auto tries = tries_of(store, std::move(entry));
  const auto earlier = tries ? store.before(tries->back()) : std::unexpected(tries.error());
  if (!earlier) {
    return std::unexpected(earlier.error());
  }
  Undoing one = as_one(std::move(*tries));
  one.is_after_trial = *earlier && !(*earlier)->saved;
  return one;
}

/// What was in RAM only when ROM was changed is recorded as saved; else a restart had taken it.
void leave_out_what_was_lost(Tries& changes) {
  const auto saved = std::ranges::find_if(changes, &state::SnapshotEntry::saved);
  const auto lost = std::remove_if(saved, changes.end(), std::not_fn(&state::SnapshotEntry::saved));
  changes.erase(lost, changes.end());
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

std::string displayed(const state::SnapshotEntry& entry, bla::Address address, std::int64_t raw,
                      const bla::Profiles& profiles) {
  const bla::Parameter* parameter = profiles.find(address);
  const auto mode = entry.held.find(bla::address::pwm_mode.value());
  return parameter == nullptr
             ? std::to_string(raw)
             : bla::display(*parameter, raw,
                            mode != entry.held.end() ? std::optional(mode->second) : std::nullopt);
}

Result<Undoing> as_left(Undoing change, NodeId id, Session& session, const bla::Profiles& profiles,
                        const Identification::Options& options) {
  const Servo servo = session.roster().member(id).servo();
  if (!change.perhaps_saved_since) {
    if (!change.is_after_trial && has_restarted_since(change.entry, servo, session)) {
      const auto ram = read_held(change, id, session, profiles, options);
      if (!ram) {
        return std::unexpected(ram.error());
      }
      change.entry.saved = shows(change, *ram); // ROM has brought it back: somebody has saved it
    }
    return change;
  }
  if (is_of_this_clock(change.entry, session) &&
      has_run_on(servo, *change.perhaps_saved_since, session)) {
    change.entry.saved = false;
    return change;
  }
  const auto ram = read_held(change, id, session, profiles, options);
  if (!ram) {
    return std::unexpected(ram.error());
  }
  const bool keeps_ids = change.entry.command == erase_keeping_ids;
  std::erase_if(change.entry.held, [&](const auto& held) {
    const bla::Address address(held.first);
    const auto written = change.written.find(held.first);
    const auto now = ram->raw(address);
    const bool is_erased = keeps_ids && bla::is_id(address) && now == 0;
    // where RAM holds what was there before, only a restart shows whether ROM does
    return now && *now != held.second && written != change.written.end() &&
           !written->second.contains(*now) && !is_erased && address != bla::address::static_node_id;
  });
  change.entry.saved = !change.entry.held.empty();
  return change;
}

Result<std::optional<Undoing>> last_change(const state::SnapshotStore& store,
                                           const dronecan::UniqueId& unique_id,
                                           std::optional<std::int64_t> serial_number) {
  auto last = store.last(unique_id, serial_number);
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
    const auto last = store.last(entry->unique_id, entry->serial_number);
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

Result<std::vector<Undoing>> changes_since(const state::SnapshotStore& store, std::int64_t run) {
  auto entries = store.entries();
  if (!entries) {
    return std::unexpected(std::move(entries.error()));
  }
  const auto is_of_run = [run](const state::SnapshotEntry& entry) { return entry.run == run; };
  const auto first = std::find_if(entries->rbegin(), entries->rend(), is_of_run);
  if (first == entries->rend()) {
    return fail(Code::not_found, say<texts::no_command_with_number>(run),
                say<texts::no_command_with_number_hint>());
  }
  std::map<dronecan::UniqueId, std::int64_t> last_serials; // that older versions did not record
  for (const state::SnapshotEntry& entry : *entries) {
    if (entry.serial_number) {
      last_serials.emplace(entry.unique_id, *entry.serial_number);
    }
  }
  std::map<std::pair<dronecan::UniqueId, std::int64_t>, Tries> by_unit;
  for (auto entry = entries->begin(); entry != first.base(); ++entry) {
    const auto serial = entry->serial_number.value_or(last_serials[entry->unique_id]);
    by_unit[{entry->unique_id, serial}].push_back(std::move(*entry));
  }
  std::vector<Undoing> changes;
  for (Tries& each : by_unit | std::views::values) {
    if (each.size() >= state::most_snapshots) { // earlier ones have been dropped
      return fail(Code::not_found, say<texts::too_many_changes_since>(run, hex(each[0].unique_id)),
                  say<texts::no_command_with_number_hint>());
    }
    leave_out_what_was_lost(each);
    changes.push_back(as_one(std::move(each)));
    changes.back().is_after_trial = true; // several changes: which of them ROM holds is not known
  }
  return changes;
}

} // namespace blactl::fleet
