// What the record tells of the present RAM and ROM of a servo.

#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/history.hpp"

#include "fleet/change/id_holders.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace blactl::fleet {

namespace {

/// A crystal with a drift of 30 ppm uses a twentieth of the tolerance in this time.
constexpr std::chrono::hours worth_renewing{1};

constexpr int clocks_agree = 20'000; // to 50 ppm

/// How far the clock of a servo may have gone away from ours since then.
Duration drift(WallTime since, WallTime now) {
  return std::max(now - since, WallTime::duration{}) / clocks_agree;
}

using Entries = std::vector<state::SnapshotEntry>;
using Addresses = std::set<bla::Address>;

/// Whether `later` found a value that `earlier` had written: the servo did not restart in between.
bool follows(const state::SnapshotEntry& later, const state::SnapshotEntry& earlier) {
  return std::ranges::any_of(later.held, [&](const auto& held) {
    const auto written = earlier.written.find(held.first);
    return written != earlier.written.end() && written->second == held.second;
  });
}

/// Whether RAM holds a value that these changes, the newest first, have put there in the end;
/// empty: no register of them was read. One that they have put back shows nothing.
std::optional<bool> are_shown(const Entries& changes, const Snapshot& ram) {
  std::map<std::uint8_t, std::int64_t> written, replaced;
  for (const state::SnapshotEntry& change : changes) {
    written.insert(change.written.begin(), change.written.end());
    for (const auto& [address, raw] : change.held) {
      replaced.insert_or_assign(address, raw);
    }
  }
  std::optional<bool> shown;
  for (const auto& [address, raw] : written) {
    const auto before = replaced.find(address);
    const auto now = ram.raw(bla::Address(address));
    if (now && before != replaced.end()) {
      shown = shown.value_or(false) || (*now == raw && before->second != raw);
    }
  }
  return shown;
}

/// A restart between the record and the write puts changes before the start of the servo, as does
/// its crystal, and so does a clock that was set: then RAM itself tells, if `ram` is known. From an
/// earlier run of the servo there is nothing in RAM that ROM does not hold.
bool are_in_ram(const Entries& changes, WallTime started, const Session& session,
                const Snapshot* ram) {
  const state::SnapshotEntry& newest = changes.front();
  const WallTime last = newest.saved ? newest.at : last_write(newest);
  const bool is_before = last < started - drift(newest.at, session.wall());
  if (newest.written.empty() || (is_before && is_of_this_clock(newest, session))) {
    return false;
  }
  return (ram != nullptr ? are_shown(changes, *ram) : std::nullopt).value_or(!is_before);
}

/// The servo started after this change, whatever clocks say: it has written nothing, and its end is
/// known.
bool is_restart(const state::SnapshotEntry& change) {
  return change.written.empty() && change.settled && change.command != characterizing;
}

/// When the last uptime of this node was heard.
WallTime told_at(const Member& member, const Session& session) {
  return session.wall() - (session.now() - member.status_at);
}

constexpr std::array ids{bla::address::servo_id, bla::address::static_node_id};

/// The IDs that an ERASE has taken, as RAM shows, but for those changed `since`.
bla::Values taken_by(const state::SnapshotEntry& erase, const Addresses& since,
                     const Snapshot& ram) {
  bla::Values taken;
  for (const bla::Address id : ids) {
    const auto held = since.contains(id) ? erase.held.end() : erase.held.find(id.value());
    if (held != erase.held.end() && held->second != 0 && ram.raw(id) == 0) {
      taken.emplace(id, held->second);
    }
  }
  return taken;
}

bla::Values replaced_by(const std::vector<state::SnapshotEntry>& changes) {
  bla::Values values;
  for (const state::SnapshotEntry& change : changes) {
    for (const auto& [address, raw] : change.held) {
      values.insert_or_assign(bla::Address(address), raw); // the first one replaced that of ROM
    }
  }
  return values;
}

/// Of a ROM that could not be read: it tells no more than the IDs that it may hold.
bool is_unread(const state::RomProof& proof) {
  return std::ranges::all_of(proof.rom,
                             [](const auto& held) { return bla::is_id(bla::Address(held.first)); });
}

} // namespace

std::optional<bool> is_shown(const state::SnapshotEntry& change, const Snapshot& ram) {
  return are_shown({change}, ram);
}

WallTime clock_of(const Session& session) {
  return session.wall() - session.now().time_since_epoch();
}

bool is_same_clock(std::optional<WallTime> one, std::optional<WallTime> other) {
  return one && other && std::chrono::abs(*one - *other) <= state::clock_tolerance;
}

bool is_of_this_clock(const state::SnapshotEntry& change, const Session& session) {
  return is_same_clock(change.clock, clock_of(session));
}

bool started_before(WallTime started, WallTime at, WallTime now) {
  constexpr std::chrono::seconds clock_set{5};
  return started + clock_set < at - drift(at, now);
}

bool started_after(WallTime started, WallTime at, WallTime now) {
  return at < started - drift(at, now);
}

WallTime last_write(const state::SnapshotEntry& change) {
  constexpr std::chrono::seconds writing_time{10}; // usual, where nobody recorded how it ended
  constexpr std::chrono::seconds whole_second{1};  // an uptime lets a start look later by as much
  return change.settled ? *change.settled + whole_second : change.at + writing_time;
}

std::optional<WallTime> History::start_of(const Servo& servo, const Session& session) {
  const Member member = session.roster().member(servo.id);
  return servo.unique_id && member.is_unit(*servo.unique_id) && member.status
             ? std::optional(told_at(member, session) -
                             std::chrono::seconds(member.status->uptime_s))
             : std::nullopt;
}

std::optional<state::RomProof> History::proof(const Servo& servo, const Session& session) {
  const Member member = session.roster().member(servo.id);
  if (!servo.unique_id || !member.is_unit(*servo.unique_id) || !member.status ||
      not_unique(session.roster(), servo.id)) {
    return std::nullopt;
  }
  const auto proof = proofs_.find(*servo.unique_id);
  const std::chrono::seconds uptime(member.status->uptime_s);
  const WallTime told = told_at(member, session);
  if (!proof || !*proof || has_other_serial(servo, (*proof)->serial_number) ||
      !state::holds(**proof, uptime, told, clock_of(session))) {
    return std::nullopt;
  }
  if (uptime - (*proof)->uptime > worth_renewing) {
    // on failure it expires sooner
    [[maybe_unused]] const auto put =
        proofs_.put(std::array{state::renewed(**proof, uptime, told)});
  }
  return *proof;
}

std::optional<bla::Values> History::proven_rom(const Servo& servo, const Session& session) {
  const auto proof = this->proof(servo, session);
  if (!proof || is_unread(*proof)) {
    return std::nullopt;
  }
  bla::Values values;
  for (const auto& [address, raw] : proof->rom) {
    values.emplace(bla::Address(address), raw);
  }
  return values;
}

/// As far as known: one to be saved whose command was killed may be in RAM only.
bool History::is_in_rom(const state::SnapshotEntry& change) const {
  const auto known = kept_.find(change.unique_id);
  const auto lasting = lasting_.find(change.unique_id);
  const bool is_of_this_command =
      (known != kept_.end() && known->second.entry.number == change.number &&
       !known->second.is_another_try) ||
      (lasting != lasting_.end() &&
       std::ranges::find(lasting->second, change.number, &state::SnapshotEntry::number) !=
           lasting->second.end());
  return change.saved && (change.settled || is_of_this_command);
}

Result<std::optional<state::SnapshotEntry>> History::last_of(const Servo& servo) const {
  return snapshots_.last(*servo.unique_id, servo.identity.readings().serial_number);
}

std::vector<state::SnapshotEntry> History::unsaved(const Servo& servo, const Session& session,
                                                   const Snapshot* ram) const {
  std::vector<state::SnapshotEntry> entries;
  const auto started = start_of(servo, session);
  if (!started) {
    return entries;
  }
  auto entry = last_of(servo);
  while (entry && *entry && !is_in_rom(**entry)) {
    Entries changes{std::move(**entry)};
    entry = snapshots_.before(changes.back());
    const bool is_of_this_run = changes.front().at >= *started && !is_restart(changes.front());
    const bool is_in_future = changes.front().at > session.wall(); // the clock was set back
    if (!is_of_this_run || is_in_future) {
      while (entry && *entry && !is_in_rom(**entry) && follows(changes.back(), **entry)) {
        changes.push_back(std::move(**entry));
        entry = snapshots_.before(changes.back());
      }
      if (!are_in_ram(changes, *started, session, ram)) {
        break;
      }
    }
    std::ranges::move(changes, std::back_inserter(entries));
  }
  return entries;
}

Result<void> History::renew(std::vector<state::SnapshotEntry> changes, const Session& session) {
  for (state::SnapshotEntry& change : changes) {
    change.at = session.wall();
    change.clock = clock_of(session);
    change.settled = change.settled ? std::optional(change.at) : std::nullopt;
  }
  const auto kept = changes.empty() ? Result<std::vector<std::int64_t>>()
                                    : snapshots_.keep(changes, session.wall());
  return kept ? Result<void>() : std::unexpected(kept.error());
}

Result<void> History::renew_own(const dronecan::UniqueId& unit,
                                std::vector<state::SnapshotEntry> before, const Session& session) {
  if (const auto own = kept_.find(unit); own != kept_.end()) {
    before.push_back(own->second.entry);
  }
  return renew(std::move(before), session);
}

/// Empty also where the record is full: earlier changes may have left it.
ToldRom History::recorded_rom(const Snapshot& ram, const Session& session) const {
  const auto changes = unsaved(ram.servo, session, &ram);
  if (changes.size() >= state::most_snapshots) {
    return {};
  }
  ToldRom rom{.values = replaced_by(changes)};
  for (const state::SnapshotEntry& change : changes) {
    for (const auto& [address, raw] : change.held) {
      if (change.saved) {
        rom.perhaps_saved.insert(bla::Address(address));
      }
    }
  }
  return rom;
}

bla::Values History::known_rom(const Snapshot& ram, const Session& session) {
  auto proven = proven_rom(ram.servo, session);
  return proven ? std::move(*proven) : recorded_rom(ram, session).values;
}

bla::Values History::saved_since_start(const Servo& servo, const Session& session) const {
  const auto started = start_of(servo, session);
  auto entry = started ? last_of(servo) : Result<std::optional<state::SnapshotEntry>>();
  while (entry && *entry && !(*entry)->saved && (*entry)->at >= *started) {
    entry = snapshots_.before(**entry);
  }
  bla::Values values;
  if (entry && *entry && (*entry)->saved && (*entry)->at >= *started) {
    for (const auto& [address, raw] : (*entry)->written) {
      values.emplace(bla::Address(address), raw);
    }
  }
  return values;
}

LostIds History::lost_ids(const Snapshot& ram, const Session& session) const {
  const bool lacks_one =
      std::ranges::any_of(ids, [&](bla::Address id) { return ram.raw(id) == 0; });
  auto entry = ram.servo.unique_id && lacks_one ? last_of(ram.servo)
                                                : Result<std::optional<state::SnapshotEntry>>();
  Addresses since; // changed on purpose
  for (; entry && *entry; entry = snapshots_.before(**entry)) {
    const state::SnapshotEntry& change = **entry;
    if (change.command == erase_keeping_ids) {
      const auto started = start_of(ram.servo, session);
      const WallTime now = session.wall();
      const bool is_of_this_run = started && is_of_this_clock(change, session) &&
                                  change.at - drift(change.at, now) >= *started;
      return {.ids = change.ended ? bla::Values() : taken_by(change, since, ram),
              .is_certain = is_of_this_run};
    }
    for (const auto& [address, raw] : change.held) {
      since.insert(bla::Address(address));
    }
  }
  return {};
}

std::vector<Waiting> History::waiting(const Roster& roster) const {
  std::vector<Waiting> units;
  const auto proofs = proofs_.proofs();
  for (const state::RomProof& proof : proofs ? *proofs : std::vector<state::RomProof>()) {
    const auto id = proof.rom.find(bla::address::static_node_id.value());
    if (id != proof.rom.end() && id->second != 0 && roster.is_pending(proof.unique_id) &&
        !is_here(roster, proof.unique_id)) {
      units.push_back({proof.unique_id, id->second});
    }
  }
  return units;
}

bla::Values History::last_proven_ids(const Servo& servo) const {
  bla::Values held;
  const auto proof =
      servo.unique_id ? proofs_.find(*servo.unique_id) : Result<std::optional<state::RomProof>>();
  if (proof && *proof && !has_other_serial(servo, (*proof)->serial_number)) {
    for (const auto& [number, raw] : (*proof)->rom) {
      if (const bla::Address address(number); bla::is_id(address)) {
        held.emplace(address, raw);
      }
    }
  }
  return held;
}

/// What ROM may hold once it cannot be read: the IDs to be saved, else those of its proof.
void History::keep_ids(const Plan& plan) {
  state::Registers& ids = ids_in_rom_[*plan.before.servo.unique_id];
  const bla::Values rom =
      plan.restart == RestartKind::save ? plan.expected : last_proven_ids(plan.before.servo);
  for (const auto& [address, raw] : rom) {
    if (bla::is_id(address)) {
      ids.insert_or_assign(address.value(), raw);
    }
  }
}

bool History::is_rom_unread(const Servo& servo, const Session& session) {
  const auto proof = this->proof(servo, session);
  return proof && is_unread(*proof);
}

} // namespace blactl::fleet
