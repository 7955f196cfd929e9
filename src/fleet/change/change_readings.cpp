// What a change reads of its servo on the way, and what that shows.

#include "blactl/fleet/change/change_job.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <utility>

namespace blactl::fleet {

/// The settings by which the plan was judged, besides those that it writes. After ERASE they are
/// others, and a restart then ends the change.
std::vector<WriteJob::Premise> ChangeJob::premises() const {
  std::vector<WriteJob::Premise> premises;
  for (const auto& [address, raw] : plan_.erase ? bla::Values() : plan_.before.values()) {
    const bla::Parameter* parameter = servo_.identity.parameter(address);
    const RegisterChange* change = plan_.change_of(address);
    const bool is_written = change != nullptr && change->is_planned();
    if (parameter != nullptr && parameter->is_setting() && !is_written) {
      premises.push_back({parameter, raw});
    }
  }
  return premises;
}

/// `now` ends with an uptime of the servo. Empty: it has restarted since.
std::optional<RomReading> ChangeJob::rom_reading(const Snapshot& now) const {
  const Member member = roster_.member(now.servo.id);
  if (!member.is_unit(*servo_.unique_id)) {
    return std::nullopt;
  }
  RomReading rom{.values = now.values(),
                 .started = member.info_start,
                 .uptime = std::chrono::seconds(member.info->status.uptime_s)};
  std::erase_if(rom.values,
                [&](const auto& held) { return !now.servo.identity.is_setting(held.first); });
  return rom;
}

/// The start of a servo that holds initial values instead of its ROM, as it did before: the first
/// time the next start may help.
std::optional<RomReading> ChangeJob::unread_rom(const Snapshot& now) const {
  auto rom = check_rom(plan_.before) ? rom_reading(now) : std::nullopt;
  if (rom) {
    rom->values.clear();
  }
  return rom;
}

void ChangeJob::take_reading(const Snapshot& now) {
  if (const auto servo_id = now.raw(bla::address::servo_id)) {
    result_.servo.servo_id = servo_id;
  }
  roster_.learn_static_node_id(now.servo.id, now.raw(bla::address::static_node_id));
}

/// The configuration; after ERASE also the commands, after a save also whether ROM could be read.
std::unique_ptr<ReadJob> ChangeJob::read_configuration() {
  const bool after_save = stage_ == Stage::read_back;
  const bool after_erase = stage_ == Stage::read_erased;
  return std::make_unique<ReadJob>(
      roster_, after_save ? *result_.returned : servo_.id, profiles_, options_.identification,
      [=](const Servo& servo) -> Result<std::vector<const bla::Parameter*>> {
        auto parameters = servo.identity.configuration();
        if (const auto* rom = rom_state(servo.identity); after_save && rom != nullptr) {
          parameters.push_back(rom);
        }
        if (after_erase) {
          std::ranges::copy(servo.identity.registers(bla::command_registers),
                            std::back_inserter(parameters));
        }
        return parameters;
      },
      after_save ? ReadJob::Proof::unit : ReadJob::Proof::moment);
}

/// Values of the moment only: the settings were read before, or written since. unproven: that 0x19
/// follows a change before the writes have been proven.
std::unique_ptr<ReadJob> ChangeJob::read_shown() {
  return std::make_unique<ReadJob>(
      roster_, result_.node_id_after.value_or(servo_.id), profiles_, options_.identification,
      [this](const Servo& servo) -> Result<std::vector<const bla::Parameter*>> {
        auto parameters = servo.identity.registers(plan_.shown);
        std::erase_if(parameters, [](const auto* each) { return each->is_setting(); });
        if (brings_unread_rom()) {
          std::ranges::copy(servo.identity.registers(
                                std::array{bla::address::servo_id, bla::address::fault_warning}),
                            std::back_inserter(parameters));
        }
        return parameters;
      });
}

/// ERASE sets the commands to 0, too (4.9), unless another node drives the servo.
std::optional<Error> ChangeJob::check_commands(const Snapshot& now) const {
  if (roster_.driver_of(now.servo, now.servo.since)) {
    return std::nullopt;
  }
  bla::Values expected;
  for (const bla::Address command : bla::command_registers) {
    const auto raw = now.raw(command);
    expected[command] = raw == bla::not_active ? bla::not_active : 0;
    // unproven: its output comes on by that, and holds the shaft in place (errata E3)
    if (command == bla::address::command_angle &&
        plan_.before.raw(bla::address::torque_output) != 0) {
      expected.erase(command);
    }
  }
  return compare(now, expected);
}

} // namespace blactl::fleet
