#include "blactl/fleet/change/history.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace blactl::fleet {

using dronecan::UniqueId;
using state::ChangeEnd;

namespace {

state::Registers stored(const bla::Values& values) {
  state::Registers registers;
  for (const auto& [address, raw] : values) {
    registers.emplace(address.value(), raw);
  }
  return registers;
}

/// For a unit whose configuration was read after its restart.
state::RomProof proof_of(const Servo& servo, const RomReading& rom, const Session& session) {
  return {.unique_id = *servo.unique_id,
          .rom = stored(rom.values),
          .started = session.wall() - (session.now() - rom.started),
          .uptime = rom.uptime,
          .clock = clock_of(session),
          .serial_number = servo.identity.readings().serial_number};
}

/// Without those that could not be written back.
bla::Values can_go_back(const bla::Identity& identity, bla::Values values) {
  std::erase_if(values, [&](const auto& held) {
    const bla::Parameter* parameter = identity.parameter(held.first);
    return !identity.is_setting(held.first) || !identity.check_takes(*parameter);
  });
  return values;
}

/// The values that a change writes to RAM.
state::Registers written_by(const Plan& plan, const state::Registers& held) {
  state::Registers written;
  for (const RegisterChange& change : plan.changes) {
    if (change.is_planned() && held.contains(change.parameter->address.value())) {
      written.emplace(change.parameter->address.value(), change.requested);
    }
  }
  if (plan.erase) {
    for (const auto& [address, raw] : held) {
      if (const auto initial = bla::find(plan.expected, bla::Address(address))) {
        written.emplace(address, *initial);
      }
    }
  }
  return written;
}

/// What RAM holds already, and SAVE brings into ROM: of the named settings; where none is named, of
/// all but those whose changes are recorded, which SAVE makes permanent.
state::Registers replaced_in_rom(const Plan& plan, const state::Registers& rom,
                                 std::span<const state::SnapshotEntry> recorded) {
  state::Registers replaced;
  const bla::Identity& identity = plan.before.servo.identity;
  for (const auto& [number, raw] : plan.erase ? state::Registers() : rom) {
    const bla::Address address(number);
    const RegisterChange* change = plan.change_of(address);
    const bool is_recorded = std::ranges::any_of(
        recorded, [&](const state::SnapshotEntry& entry) { return entry.held.contains(number); });
    const bool is_meant =
        change != nullptr ? !change->is_planned() : plan.changes.empty() && !is_recorded;
    const auto held = plan.before.raw(address);
    if (is_meant && held && *held != raw && identity.is_setting(address)) {
      replaced.emplace(number, *held);
    }
  }
  return replaced;
}

/// An earlier change in RAM as SAVE leaves it: what it replaced in ROM. Empty: ROM stays as it is;
/// ERASE before it leaves nothing but the IDs that are kept.
std::optional<state::SnapshotEntry> lasting(state::SnapshotEntry change, const Plan& plan,
                                            const state::Registers& rom) {
  bool lasts = false;
  for (auto& [address, raw] : change.held) {
    const auto replaced = rom.find(address);
    const auto written = change.written.find(address);
    const bool is_changed = written == change.written.end() || written->second != raw;
    raw = is_changed && replaced != rom.end() ? replaced->second : raw;
    const auto saved = bla::find(plan.expected, bla::Address(address));
    const bool is_kept = !plan.erase || plan.change_of(bla::Address(address)) != nullptr;
    lasts = lasts || (is_kept && saved != raw);
  }
  change.saved = true;
  change.settled.reset();
  return lasts ? std::optional(std::move(change)) : std::nullopt;
}

/// Where nothing else tells of ROM: a static node ID that only RAM holds is not the one on which
/// the servo has started.
void add_static_node_id(const Snapshot& ram, bla::Values& rom) {
  const auto held = ram.raw(bla::address::static_node_id);
  if (held.value_or(0) != 0 && held != ram.servo.id.value() && ram.servo.id_is_known) {
    rom.emplace(bla::address::static_node_id, ram.servo.id.value());
  }
}

} // namespace

bla::Values replaced_by(const Plan& plan) {
  const bla::Identity& identity = plan.before.servo.identity;
  bla::Values values;
  if (plan.erase || plan.may_change_all) {
    values = plan.before.values();
  } else {
    for (const RegisterChange& change : plan.changes) {
      if (change.is_planned() && change.before) {
        values.emplace(change.parameter->address, *change.before);
      }
    }
  }
  const auto mode = plan.before.pwm_mode();
  const bool is_of_mode = std::ranges::any_of(values, [&](const auto& held) {
    const bla::Parameter* parameter = identity.parameter(held.first);
    return parameter != nullptr && bla::unit_depends_on_mode(*parameter);
  });
  if (mode && is_of_mode) { // another tool may change it: then the number is of another unit
    values.emplace(bla::address::pwm_mode, *mode);
  }
  return can_go_back(identity, std::move(values));
}

Result<void> History::drop_proofs(std::span<const Plan> plans) {
  std::vector<UniqueId> units;
  for (const Plan& plan : plans) {
    const auto& unique_id = plan.before.servo.unique_id;
    // unproven: whether ERASE changes ROM
    if ((plan.restart || plan.erase) && unique_id && !unproven_.contains(*unique_id)) {
      keep_ids(plan);
      units.push_back(*unique_id);
    }
  }
  auto dropped = units.empty() ? Result<void>() : proofs_.drop(units);
  if (dropped) {
    unproven_.insert(units.begin(), units.end());
  }
  return dropped;
}

Result<void> History::doubt_rom(std::span<const UniqueId> units) {
  return units.empty() ? Result<void>() : proofs_.drop(units);
}

/// What a mere restart takes, as far as ROM is known.
bla::Values History::taken_from_ram(const Plan& plan, const Session& session) {
  bla::Values taken;
  if (plan.restart != RestartKind::restart) {
    return taken;
  }
  for (const auto& [address, raw] : known_rom(plan.before, session)) {
    const auto held = plan.before.raw(address);
    if (held && *held != raw) {
      taken.emplace(address, *held);
    }
  }
  return taken;
}

/// What ROM holds of the values in RAM that a plan replaces: another node may save it meanwhile.
void History::keep_rom(const Plan& plan, const state::Registers& held, const Session& session) {
  if (plan.restart == RestartKind::save) {
    return;
  }
  for (const auto& [address, raw] : known_rom(plan.before, session)) {
    const bool is_kept = plan.erase && plan.change_of(address) != nullptr;
    if (!is_kept && held.contains(address.value())) {
      in_rom_[*plan.before.servo.unique_id].emplace(address.value(), raw);
    }
  }
}

/// The record of a servo as this plan changes it; empty: there is none, or it stays as it is.
std::optional<state::SnapshotEntry> History::entry_of(const Plan& plan, const Roms& roms,
                                                      const Session& session) {
  const auto& unique_id = plan.before.servo.unique_id;
  auto held = stored(replaced_by(plan));
  if (plan.erase) { // IDs that are kept, or brought back after one that broke off
    for (const RegisterChange& change : plan.changes) {
      held.insert_or_assign(change.parameter->address.value(), change.requested);
    }
  }
  held.merge(stored(taken_from_ram(plan, session)));
  const auto rom = unique_id ? roms.find(*unique_id) : roms.end();
  state::Registers made_permanent;
  if (rom != roms.end()) {
    using Entries = std::span<const state::SnapshotEntry>;
    const auto lasting = lasting_.find(*unique_id);
    made_permanent = replaced_in_rom(
        plan, rom->second, lasting != lasting_.end() ? Entries(lasting->second) : Entries());
    held.insert(made_permanent.begin(), made_permanent.end());
  }
  const bool goes_on = unique_id && plan.restart == RestartKind::save && is_another_try(*unique_id);
  if (!unique_id || (held.empty() && !goes_on)) {
    return std::nullopt;
  }
  state::Registers in_ram;
  for (auto& [address, raw] : held) { // undo puts nothing into ROM that was in RAM only
    const bool is_kept = plan.erase && plan.change_of(bla::Address(address)) != nullptr;
    if (!is_kept && rom != roms.end() && rom->second.contains(address)) {
      in_ram.emplace(address, std::exchange(raw, rom->second.at(address)));
    }
  }
  keep_rom(plan, held, session);
  const auto known = kept_.find(*unique_id);
  state::SnapshotEntry entry =
      known != kept_.end() ? known->second.entry : new_entry(plan.before.servo, session);
  const state::SnapshotEntry before = entry;
  if (plan.restart == RestartKind::save && known != kept_.end()) { // undo would save them
    for (const std::uint8_t address : std::exchange(known->second.lost, {})) {
      entry.held.erase(address);
    }
  }
  made_permanent.merge(written_by(plan, held));
  for (const auto& [address, raw] : made_permanent) {
    const bool makes_way = known != kept_.end() && !known->second.is_another_try &&
                           address == bla::address::static_node_id.value();
    makes_way ? entry.written.emplace(address, raw) // it is on the ID that it got before
              : entry.written.insert_or_assign(address, raw);
  }
  std::erase_if(in_ram, [&](const auto& each) { return entry.held.contains(each.first); });
  if (plan.restart == RestartKind::save && !entry.saved && rom != roms.end()) {
    for (auto& [address, raw] : entry.held) { // of an earlier try, in RAM only
      if (const auto proven = rom->second.find(address); proven != rom->second.end()) {
        in_ram.emplace(address, std::exchange(raw, proven->second));
      }
    }
  }
  if (!in_ram.empty()) {
    in_ram_[*unique_id].merge(in_ram);
  }
  entry.held.merge(held); // values replaced in an earlier round stay
  entry.saved = entry.saved || plan.restart == RestartKind::save;
  entry.run = run_ != 0 ? run_ : entry.run;
  const bool begins_again = is_another_try(*unique_id) || entry.settled;
  if (entry.number != 0 && entry == before && !begins_again) {
    return std::nullopt;
  }
  if (begins_again) { // it may have restarted since the last try
    entry.at = session.wall();
    entry.clock = clock_of(session);
  }
  entry.settled.reset();
  entry.number = is_another_try(*unique_id) ? 0 : entry.number; // see former_numbers()
  return entry;
}

Result<void> History::keep(std::span<const Plan> plans, const Session& session) {
  for (const Plan& plan : plans) {
    const Servo& servo = plan.before.servo;
    auto resumed = servo.unique_id ? resume(plan, session) : Result<void>();
    if (!resumed) {
      return resumed;
    }
  }
  if (auto joined = join_done(plans, session); !joined) {
    return joined;
  }
  const Roms roms = roms_before(plans, session);
  if (auto lasting = keep_lasting(plans, roms, session); !lasting) {
    return lasting;
  }
  std::vector<state::SnapshotEntry> entries;
  for (const Plan& plan : plans) {
    if (plan.proves_rom && plan.before.servo.unique_id) {
      before_proof_.insert_or_assign(
          *plan.before.servo.unique_id,
          stored(can_go_back(plan.before.servo.identity, plan.before.values())));
    }
    if (auto entry = entry_of(plan, roms, session)) {
      entries.push_back(std::move(*entry));
    }
  }
  return entries.empty() ? Result<void>() : store(std::move(entries), session.wall());
}

state::SnapshotEntry History::new_entry(const Servo& servo, const Session& session) const {
  return {.run = run_,
          .at = session.wall(),
          .command = command_,
          .unique_id = *servo.unique_id,
          .clock = clock_of(session),
          .serial_number = servo.identity.readings().serial_number};
}

/// Entries of this command, which are those of their units from now on.
Result<void> History::store(std::vector<state::SnapshotEntry> entries, WallTime now) {
  const auto numbers = snapshots_.keep(entries, now, former_numbers(entries));
  if (!numbers) {
    return std::unexpected(numbers.error());
  }
  run_ = run_ != 0 ? run_ : numbers->front();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    entries[i].number = (*numbers)[i];
    entries[i].run = run_;
    Kept& kept = kept_[entries[i].unique_id];
    kept.is_another_try = false;
    kept.entry = std::move(entries[i]);
  }
  return {};
}

Result<void> History::take_back(std::span<const UniqueId> units) {
  std::vector<state::Settlement> settlements;
  for (const UniqueId& unit : units) {
    if (const auto known = kept_.find(unit); known != kept_.end()) {
      settlements.push_back({known->second.entry.number, ChangeEnd::never_begun});
      kept_.erase(known);
    }
  }
  return settlements.empty() ? Result<void>() : snapshots_.settle(settlements);
}

Result<void> History::conclude(std::span<const ChangeResult> results, const Session& session) {
  auto settled = keep_what_was_taken(results, session);
  if (settled) {
    settled = leave_what_was_lost(results, session.wall());
  }
  if (settled) {
    settled = settle(results, session.wall());
  }
  std::vector<state::RomProof> proofs;
  for (const ChangeResult& result : results) {
    const bool tells =
        result.rom && !result.is_read_again && (result.is_done() || result.rom->values.empty());
    if (tells && result.servo.unique_id) {
      proofs.push_back(proof_of(result.servo, *result.rom, session));
      if (proofs.back().rom.empty()) {
        proofs.back().rom = ids_in_rom_[*result.servo.unique_id];
      }
    }
  }
  auto put = proofs.empty() ? Result<void>() : proofs_.put(proofs);
  if (put) {
    for (const state::RomProof& proof : proofs) {
      unproven_.erase(proof.unique_id);
    }
  }
  return settled ? put : settled;
}

/// What the ROM of each servo to be saved holds, as far as known.
History::Roms History::roms_before(std::span<const Plan> plans, const Session& session) {
  Roms roms;
  for (const Plan& plan : plans) {
    if (plan.restart == RestartKind::save && plan.before.servo.unique_id) {
      bla::Values rom = known_rom(plan.before, session);
      add_static_node_id(plan.before, rom);
      roms.emplace(*plan.before.servo.unique_id, stored(rom));
    }
  }
  return roms;
}

/// SAVE makes earlier changes in RAM permanent: until settled they count as saved.
Result<void> History::keep_lasting(std::span<const Plan> plans, const Roms& roms,
                                   const Session& session) {
  std::vector<state::SnapshotEntry> changed;
  for (const Plan& plan : plans) {
    const Servo& servo = plan.before.servo;
    if (plan.restart != RestartKind::save || !servo.unique_id) {
      continue;
    }
    const state::Registers& rom = roms.at(*servo.unique_id);
    for (state::SnapshotEntry& change : unsaved(servo, session, &plan.before)) {
      const auto known = kept_.find(*servo.unique_id); // its own entry tells what it has replaced
      if (known != kept_.end() && known->second.entry.number == change.number) {
        continue;
      }
      if (auto kept = lasting(change, plan, rom)) {
        changed.push_back(std::move(*kept));
        lasting_[*servo.unique_id].push_back(std::move(change));
      }
    }
  }
  const auto kept = changed.empty() ? Result<std::vector<std::int64_t>>()
                                    : snapshots_.keep(changed, session.wall());
  return kept ? Result<void>() : std::unexpected(kept.error());
}

} // namespace blactl::fleet
