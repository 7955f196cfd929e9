#include "fleet/change/unnamed.hpp"

#include "fleet/change/texts.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

namespace blactl::fleet {
namespace {

bool names(const Goal& goal, bla::Address address) {
  return std::ranges::any_of(goal.wanted.assignments, [&](const bla::Assignment& wish) {
    return wish.parameter->address == address;
  });
}

/// How it is known what ROM holds of a register.
enum class Source : std::uint8_t { proof, record, uncertain_record };

Warning unnamed(const std::string& name, const std::string& ram, const std::string& rom,
                bool is_saved, Source source) {
  const char* code = is_saved ? "unnamed_saved" : "unnamed_lost";
  switch (source) {
  case Source::proof:
    return {code, is_saved ? say<texts::unnamed_saved>(name, ram, rom)
                           : say<texts::unnamed_at_risk>(name, ram, rom)};
  case Source::uncertain_record:
    return {code, is_saved ? say<texts::perhaps_saved>(name, ram, rom)
                           : say<texts::perhaps_at_risk>(name, ram, rom)};
  case Source::record: break;
  }
  return {code, is_saved ? say<texts::recorded_saved>(name, ram, rom)
                         : say<texts::recorded_at_risk>(name, ram, rom)};
}

Source source_of(const ToldRom& rom, bla::Address address) {
  return rom.is_proven                         ? Source::proof
         : rom.perhaps_saved.contains(address) ? Source::uncertain_record
                                               : Source::record;
}

/// Of a register of which it is not known what ROM holds.
Warning just_written(const std::string& name, const std::string& ram, dronecan::NodeId writer,
                     bool is_saved) {
  const std::uint8_t id = writer.value();
  return is_saved ? Warning{"unnamed_saved", say<texts::just_written_saved>(name, ram, id)}
                  : Warning{"unnamed_lost", say<texts::just_written_at_risk>(name, ram, id)};
}

/// A servo that started with this static node ID would be on it: no record is needed to tell that
/// it is in RAM only. One that could not read its ROM has started with none.
std::optional<Warning> pending_id(const Goal& goal, const Snapshot& ram, const ToldRom& rom,
                                  bool is_saved) {
  constexpr bla::Address address = bla::address::static_node_id;
  const auto id = ram.raw(address);
  if (!id || *id == 0 || *id == ram.servo.id.value() || names(goal, address) ||
      bla::find(rom.values, address) || rom.written_by.contains(address) || check_rom(ram)) {
    return std::nullopt;
  }
  const std::string& name = ram.servo.identity.parameter(address)->name;
  return Warning{is_saved ? "unnamed_saved" : "unnamed_lost",
                 is_saved ? say<texts::pending_id_saved>(name, *id)
                          : say<texts::pending_id_at_risk>(name, *id)};
}

} // namespace

ToldRom told_rom(const Goal& goal, const Snapshot& held, History* record, const Session& session) {
  const bool resets_all = goal.wanted.erase && !goal.wanted.keep_ids;
  if (!goal.wanted.restart || resets_all || record == nullptr || check_rom(held)) {
    return {};
  }
  auto proven = record->proven_rom(held.servo, session);
  ToldRom told = proven ? ToldRom{.values = std::move(*proven), .is_proven = true}
                        : record->recorded_rom(held, session);
  if (goal.wanted.erase) { // keeps the IDs, and gives back those that one before has lost
    const bla::Values lost = record->lost_ids(held, session).ids;
    std::erase_if(told.values, [&](const auto& rom) {
      return !bla::is_id(rom.first) || bla::find(lost, rom.first);
    });
    return told;
  }
  const Roster& roster = session.roster();
  const Time started = roster.started(held.servo.id).value_or(Time::min());
  for (const Reading& reading : held.readings) {
    const bla::Address address = reading.parameter->address;
    if (const auto writer = roster.setter_of(held.servo.id, started, address)) {
      told.written_by.emplace(address, *writer);
    }
  }
  return told;
}

std::vector<Warning> unnamed(const Goal& goal, const Snapshot& ram, const ToldRom& rom, Need need,
                             bool is_restarted) {
  const bool is_saved = goal.saves() && need != Need::prove;
  std::vector<Warning> warnings;
  for (const Reading& reading : ram.readings) {
    const bla::Parameter& parameter = *reading.parameter;
    const auto kept = bla::find(rom.values, parameter.address);
    const auto writer = rom.written_by.find(parameter.address);
    if (!parameter.is_setting() || names(goal, parameter.address) || !reading.raw ||
        kept == reading.raw || (!kept && writer == rom.written_by.end())) {
      continue;
    }
    const std::string in_ram = bla::display(parameter, *reading.raw, ram.pwm_mode());
    if (!kept) {
      warnings.push_back(just_written(parameter.name, in_ram, writer->second, is_saved));
      continue;
    }
    const std::string in_rom = bla::display(parameter, *kept, ram.pwm_mode());
    warnings.push_back(
        is_restarted
            ? Warning{"unnamed_lost", say<texts::unnamed_lost>(parameter.name, in_ram, in_rom)}
            : unnamed(parameter.name, in_ram, in_rom, is_saved, source_of(rom, parameter.address)));
  }
  const bool keeps_id = !goal.wanted.erase || goal.wanted.keep_ids;
  if (goal.wanted.restart && keeps_id && !is_restarted) {
    if (auto pending = pending_id(goal, ram, rom, is_saved)) {
      warnings.push_back(std::move(*pending));
    }
  }
  return warnings;
}

std::vector<Warning> written_before_restart(const Roster& roster, const Plan& plan, Time restart) {
  const Snapshot& ram = plan.before;
  std::vector<Warning> warnings;
  for (const auto& written : roster.written_to(ram.servo.id, plan.told_until)) {
    const bla::Parameter* parameter = ram.servo.identity.parameter(written.reg);
    if (written.at <= restart && parameter != nullptr && parameter->is_setting() &&
        ram.raw(written.reg) != written.raw) {
      warnings.push_back(just_written(parameter->name,
                                      bla::display(*parameter, written.raw, ram.pwm_mode()),
                                      written.source, false));
    }
  }
  return warnings;
}

std::vector<Warning> losses(std::vector<Warning> warnings) {
  std::erase_if(warnings, [](const Warning& warning) { return warning.code != "unnamed_lost"; });
  return warnings;
}

} // namespace blactl::fleet
