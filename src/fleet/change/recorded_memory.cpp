// What the record tells of the present RAM and ROM of a servo.

#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/history.hpp"

#include <array>
#include <chrono>
#include <utility>
#include <vector>

namespace blactl::fleet {

namespace {

/// A crystal with a drift of 30 ppm uses a twentieth of the tolerance in this time.
constexpr std::chrono::hours worth_renewing{1};

/// The longest usual time from the record of a change to its last write: the servo may have
/// restarted in between.
constexpr std::chrono::seconds writing_time{10};

/// Whether RAM holds a value that this change has put there; empty: no register of it was read.
std::optional<bool> is_shown(const state::SnapshotEntry& change, const Snapshot& ram) {
  std::optional<bool> shown;
  for (const auto& [address, written] : change.written) {
    const auto before = change.held.find(address);
    const auto now = ram.raw(bla::Address(address));
    if (now && before != change.held.end() && before->second != written) {
      shown = shown.value_or(false) || *now == written;
    }
  }
  return shown;
}

/// A clock that was set, or a restart between the record and the write, puts a change before the
/// start of the servo: then RAM itself tells, if `ram` is known.
bool is_in_ram(const state::SnapshotEntry& change, WallTime started, const Snapshot* ram) {
  if (change.at >= started || change.written.empty()) {
    return change.at >= started;
  }
  const auto shown = ram != nullptr ? is_shown(change, *ram) : std::nullopt;
  return shown.value_or(change.at + writing_time >= started);
}

/// When the last uptime of this node was heard.
WallTime told_at(const Member& member, const Session& session) {
  return session.wall() - (session.now() - member.status_at);
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

} // namespace

/// Empty: it has not told its uptime.
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
  if (!proof || !*proof || !state::holds(**proof, uptime, told)) {
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
  if (!proof || proof->rom.empty()) {
    return std::nullopt;
  }
  bla::Values values;
  for (const auto& [address, raw] : proof->rom) {
    values.emplace(bla::Address(address), raw);
  }
  return values;
}

std::vector<state::SnapshotEntry> History::unsaved(const Servo& servo, const Session& session,
                                                   const Snapshot* ram) const {
  std::vector<state::SnapshotEntry> entries;
  const auto started = start_of(servo, session);
  if (!started) {
    return entries;
  }
  auto entry = snapshots_.last(*servo.unique_id);
  while (entry && *entry && !(*entry)->saved && is_in_ram(**entry, *started, ram)) {
    entries.push_back(std::move(**entry));
    entry = snapshots_.before(entries.back());
  }
  return entries;
}

Result<void> History::renew(std::vector<state::SnapshotEntry> changes, const Session& session) {
  for (state::SnapshotEntry& change : changes) {
    change.at = session.wall();
  }
  const auto kept = changes.empty() ? Result<std::vector<std::int64_t>>()
                                    : snapshots_.keep(changes, session.wall());
  return kept ? Result<void>() : std::unexpected(kept.error());
}

bla::Values History::replaced_in_ram(const Snapshot& ram, const Session& session) const {
  return replaced_by(unsaved(ram.servo, session, &ram));
}

bla::Values History::lost_ids(const Snapshot& ram, const Session& session) const {
  bla::Values lost;
  const auto started = start_of(ram.servo, session);
  const auto last = started ? snapshots_.last(*ram.servo.unique_id)
                            : Result<std::optional<state::SnapshotEntry>>();
  if (!last || !*last || (*last)->ended || (*last)->command != erase_keeping_ids ||
      (*last)->at < *started) {
    return lost;
  }
  for (const bla::Address address : {bla::address::servo_id, bla::address::static_node_id}) {
    const auto held = (*last)->held.find(address.value());
    if (held != (*last)->held.end() && ram.raw(address) == 0) {
      lost.emplace(address, held->second);
    }
  }
  return lost;
}

bool History::is_rom_unread(const Servo& servo, const Session& session) {
  const auto proof = this->proof(servo, session);
  return proof && proof->rom.empty();
}

} // namespace blactl::fleet
