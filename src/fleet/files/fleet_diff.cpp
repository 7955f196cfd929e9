#include "blactl/fleet/files/fleet_diff.hpp"

#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/register_choice.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <ranges>
#include <set>
#include <utility>

namespace blactl::fleet {

using bla::Assignment;
using dronecan::NodeId;

namespace {

/// The registers of the entry that the servo has, and 0x37 if the unit of another depends on it.
std::vector<const bla::Parameter*> registers_of(const FleetEntry& entry, const Servo& servo) {
  std::vector<const bla::Parameter*> registers;
  for (const Assignment& assignment : entry.set) {
    if (const auto* own = own_register(*assignment.parameter, servo)) {
      registers.push_back(own);
    }
  }
  const bool needs_mode = std::ranges::any_of(
      registers, [](const auto* each) { return bla::unit_depends_on_mode(*each); });
  const auto* mode = servo.identity.parameter(bla::address::pwm_mode);
  if (needs_mode && !entry.wish(bla::address::pwm_mode) && mode != nullptr) {
    registers.push_back(mode);
  }
  return registers;
}

/// The identification of a servo, as far as an entry has it.
Servo servo_of(const FleetEntry& entry, const bla::Profiles& profiles) {
  const Match& match = entry.match;
  Servo servo{.id = match.node_id.value_or(NodeId{}),
              .unique_id = match.unique_id,
              .is_servo = true,
              .servo_id = match.servo_id};
  servo.identity = bla::Identity(profiles, {.model_number = {},
                                            .serial_number = match.serial_number,
                                            .firmware_version = {},
                                            .hardware_version = {}});
  return servo;
}

EntryDiff without_servo(const FleetEntry& entry, EntryStatus status,
                        const bla::Profiles& profiles) {
  return {.name = entry.name, .status = status, .servo = servo_of(entry, profiles)};
}

EntryDiff judged(EntryDiff diff) {
  diff.status = !diff.errors.empty()     ? EntryStatus::failed
                : diff.differences() > 0 ? EntryStatus::different
                                         : EntryStatus::unchanged;
  return diff;
}

EntryDiff compare(const FleetEntry& entry, const Snapshot& held, const bla::Profiles& profiles) {
  EntryDiff diff{.name = entry.name, .servo = held.servo, .errors = held.errors()};
  diff.mode_before = held.pwm_mode();
  diff.mode_after = entry.wish(bla::address::pwm_mode);
  if (!diff.mode_after) {
    diff.mode_after = diff.mode_before;
  }
  if (auto misfit = check_unit(entry.set, held, profiles)) {
    diff.errors.push_back(std::move(*misfit));
  }
  for (const Assignment& assignment : entry.set) {
    const auto* own = own_register(*assignment.parameter, held.servo);
    if (own == nullptr && held.servo.is_servo) {
      diff.errors.push_back(lacking(*assignment.parameter, held.servo));
    } else if (const auto raw = held.raw(assignment.parameter->address)) {
      diff.registers.push_back({own, raw, assignment.value.raw});
    }
  }
  return judged(std::move(diff));
}

/// The entry of another file for each one of a file, as far as there is one.
using Counterparts = std::map<const FleetEntry*, const FleetEntry*>;

/// What tells units apart comes before what people call them, and no entry has two counterparts.
Counterparts counterparts(const FleetFile& one, const FleetFile& other) {
  if (one.names_nobody() || other.names_nobody()) { // both have one entry
    return {{&one.servos.front(), &other.servos.front()}};
  }
  Counterparts found;
  std::set<const FleetEntry*> taken;
  const auto pair_by = [&](auto same) {
    for (const FleetEntry& entry : one.servos) {
      const auto it = std::ranges::find_if(other.servos, [&](const FleetEntry& each) {
        return !taken.contains(&each) && same(entry, each);
      });
      if (!found.contains(&entry) && it != other.servos.end()) {
        found.emplace(&entry, &*it);
        taken.insert(&*it);
      }
    }
  };
  const auto with_same = [](auto Match::* number) {
    return [number](const FleetEntry& entry, const FleetEntry& each) {
      return entry.match.*number && entry.match.*number == each.match.*number;
    };
  };
  pair_by(with_same(&Match::unique_id));
  pair_by(with_same(&Match::serial_number));
  pair_by([](const FleetEntry& entry, const FleetEntry& each) { return entry.name == each.name; });
  return found;
}

EntryDiff compare(const FleetEntry& one, const FleetEntry& other, const bla::Profiles& profiles) {
  const FleetEntry& who = other.name.empty() ? one : other; // not in a parameter file
  EntryDiff diff = without_servo(who, EntryStatus::unchanged, profiles);
  diff.mode_before = one.pwm_mode();
  diff.mode_after = other.pwm_mode();
  for (const bla::Parameter& parameter : profiles.registers()) {
    Difference registers{&parameter, one.wish(parameter.address), other.wish(parameter.address)};
    if (parameter.address == bla::address::pwm_mode && diff.mode_before != diff.mode_after &&
        diff.mode_before && diff.mode_after) { // by the unit of 0x36, if 0x37 is not there
      registers.before = diff.mode_before;
      registers.wished = diff.mode_after;
    }
    if (registers.before || registers.wished) {
      diff.registers.push_back(registers);
    }
  }
  return judged(std::move(diff));
}

} // namespace

std::string_view name(EntryStatus status) {
  switch (status) {
  case EntryStatus::changed: return "changed";
  case EntryStatus::unchanged: return "unchanged";
  case EntryStatus::different: return "different";
  case EntryStatus::failed: return "failed";
  case EntryStatus::skipped: return "skipped";
  case EntryStatus::missing: return "missing";
  case EntryStatus::extra: return "extra";
  }
  return {};
}

std::size_t EntryDiff::differences() const {
  return static_cast<std::size_t>(std::ranges::count_if(registers, &Difference::is_one));
}

std::vector<EntryDiff> unpaired(const FleetMatch& match, const Roster& roster,
                                const bla::Profiles& profiles) {
  std::vector<EntryDiff> entries;
  entries.reserve(match.missing.size() + match.left_out.size() + match.extra.size());
  for (const FleetEntry* entry : match.missing) {
    entries.push_back(without_servo(*entry, EntryStatus::missing, profiles));
  }
  for (const FleetEntry* entry : match.left_out) {
    entries.push_back(without_servo(*entry, EntryStatus::skipped, profiles));
  }
  for (const NodeId id : match.extra) {
    entries.push_back(
        {.name = {}, .status = EntryStatus::extra, .servo = roster.member(id).servo()});
  }
  for (const FleetMatch::Misfit& misfit : match.misfits) {
    entries.push_back({.name = misfit.entry->name,
                       .status = EntryStatus::failed,
                       .servo = roster.member(misfit.id).servo(),
                       .errors = {misfit.error}});
  }
  return entries;
}

namespace {

/// While a servo has not said who it is, it may be the one that an entry misses.
std::vector<EntryDiff> unpaired_or_unclear(FleetMatch match, const Roster& roster,
                                           const bla::Profiles& profiles) {
  if (!match.missing.empty()) {
    std::erase_if(match.extra, [&](NodeId id) { return !roster.member(id).is_known(); });
  }
  auto entries = unpaired(match, roster, profiles);
  for (std::size_t i = 0; i < match.missing.size(); ++i) { // they come first
    if (auto unclear = may_be_unidentified(*match.missing[i], roster)) {
      entries[i].errors.push_back(std::move(*unclear));
      entries[i] = judged(std::move(entries[i]));
    }
  }
  return entries;
}

} // namespace

FleetDiff diff(Session& session, const bla::Profiles& profiles, const FleetMatch& match,
               const Identification::Options& options) {
  const Roster& roster = session.roster();
  auto others = session.is_replay() // as they were matched: reading may identify one
                    ? unpaired(match, roster, profiles)
                    : unpaired_or_unclear(match, roster, profiles);
  std::vector<NodeId> ids;
  std::map<NodeId, const FleetEntry*> entries;
  for (const FleetMatch::Pair& pair : match.pairs) {
    ids.push_back(pair.id);
    entries.emplace(pair.id, pair.entry);
  }
  auto held = take_snapshots(session, profiles, ids, options, [&](const Servo& servo) {
    return Result<std::vector<const bla::Parameter*>>(registers_of(*entries.at(servo.id), servo));
  });
  FleetDiff found{.entries = {}, .broken = std::move(held.broken)};
  for (std::size_t i = 0; i < match.pairs.size(); ++i) {
    const FleetMatch::Pair& pair = match.pairs[i];
    EntryDiff entry = compare(*pair.entry, held.servos[i], profiles);
    if (roster.is_doubled(pair.id)) { // readings may be of either
      entry = {.name = pair.entry->name, .status = EntryStatus::failed, .servo = {.id = pair.id}};
      entry.errors = {doubled(roster, pair.id)};
    }
    found.entries.push_back(std::move(entry));
  }
  std::ranges::move(others, std::back_inserter(found.entries));
  return found;
}

FleetDiff diff(const FleetFile& one, const FleetFile& other, const bla::Profiles& profiles) {
  FleetDiff found;
  const Counterparts pairs = counterparts(one, other);
  for (const FleetEntry& entry : one.servos) {
    const auto pair = pairs.find(&entry);
    found.entries.push_back(pair != pairs.end()
                                ? compare(entry, *pair->second, profiles)
                                : without_servo(entry, EntryStatus::missing, profiles));
  }
  const auto paired = std::views::values(pairs);
  for (const FleetEntry& entry : other.servos) {
    if (std::ranges::find(paired, &entry) == paired.end()) {
      found.entries.push_back(without_servo(entry, EntryStatus::extra, profiles));
    }
  }
  return found;
}

} // namespace blactl::fleet
