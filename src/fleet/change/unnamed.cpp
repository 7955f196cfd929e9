#include "fleet/change/unnamed.hpp"

#include "blactl/fleet/change/history.hpp"

#include "fleet/change/texts.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace blactl::fleet {
namespace {

bool names(const Goal& goal, bla::Address address) {
  return std::ranges::any_of(goal.wanted.assignments, [&](const bla::Assignment& wish) {
    return wish.parameter->address == address;
  });
}

Warning unnamed(const std::string& name, const std::string& ram, const std::string& rom,
                bool is_saved, bool is_proven) {
  if (is_saved) {
    return {"unnamed_saved", is_proven ? say<texts::unnamed_saved>(name, ram, rom)
                                       : say<texts::recorded_saved>(name, ram, rom)};
  }
  return {"unnamed_lost", is_proven ? say<texts::unnamed_at_risk>(name, ram, rom)
                                    : say<texts::recorded_at_risk>(name, ram, rom)};
}

} // namespace

ToldRom told_rom(const Goal& goal, const Snapshot& held, History* record, const Session& session) {
  if (!goal.wanted.restart || goal.wanted.erase || record == nullptr || check_rom(held)) {
    return {};
  }
  auto proven = record->proven_rom(held.servo, session);
  return proven ? ToldRom{.values = std::move(*proven), .is_proven = true}
                : ToldRom{.values = record->replaced_in_ram(held, session)};
}

std::vector<Warning> unnamed(const Goal& goal, const Snapshot& ram, const ToldRom& rom, Need need,
                             bool is_restarted) {
  const bool is_saved = goal.saves() && need != Need::prove;
  std::vector<Warning> warnings;
  for (const Reading& reading : ram.readings) {
    const bla::Parameter& parameter = *reading.parameter;
    const auto kept = bla::find(rom.values, parameter.address);
    if (!parameter.is_setting() || names(goal, parameter.address) || !reading.raw || !kept ||
        kept == reading.raw) {
      continue;
    }
    const std::string in_ram = bla::display(parameter, *reading.raw, ram.pwm_mode());
    const std::string in_rom = bla::display(parameter, *kept, ram.pwm_mode());
    warnings.push_back(
        is_restarted
            ? Warning{"unnamed_lost", say<texts::unnamed_lost>(parameter.name, in_ram, in_rom)}
            : unnamed(parameter.name, in_ram, in_rom, is_saved, rom.is_proven));
  }
  return warnings;
}

} // namespace blactl::fleet
