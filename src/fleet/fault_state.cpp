#include "blactl/fleet/fault_state.hpp"

#include "blactl/fleet/guard.hpp"
#include "blactl/fleet/texts.hpp"

#include <algorithm>
#include <utility>

namespace blactl::fleet {
namespace {

using bla::Level;
using bla::Parameter;

/// What is missing of the three registers is missing of the faults; the values behind them and
/// 0x18 are not.
std::vector<Error> errors_of(const Snapshot& snapshot, const Roster& roster) {
  const dronecan::NodeId id = snapshot.servo.id;
  if (roster.is_doubled(id)) {
    return {doubled(roster, id)};
  }
  Snapshot needed{.servo = snapshot.servo, .error = snapshot.error};
  const auto values = snapshot.values();
  for (const Reading& reading : snapshot.readings) {
    const bool is_missing = std::ranges::find(bla::fault_registers, reading.parameter->address) !=
                                bla::fault_registers.end() &&
                            !bla::fault_register(values, reading.parameter->address);
    if (is_missing) {
      needed.readings.push_back(reading);
    }
  }
  return needed.errors();
}

FaultState state_of(Snapshot snapshot, const Roster& roster, const bla::Profiles& profiles) {
  FaultState state{.snapshot = std::move(snapshot), .faults = {}, .health = {}, .errors = {}};
  state.errors = errors_of(state.snapshot, roster);
  if (roster.is_doubled(state.snapshot.servo.id)) {
    state.snapshot.readings.clear(); // they may be of either
  }
  state.faults = bla::faults(state.snapshot.values(), profiles);
  if (const auto& status = roster.member(state.snapshot.servo.id).status) {
    state.health = status->health;
  }
  return state;
}

/// 0x18 has bits of a register that had none when it was read.
bool contradicts_itself(const FaultState& state) {
  const auto values = state.snapshot.values();
  return std::ranges::any_of(bla::fault_registers, [&](bla::Address reg) {
    return bla::is_summed_up(values, reg) && bla::find(values, reg) == 0;
  });
}

/// Its NodeStatus tells of more than the registers did, which were not read at one time.
bool is_surpassed(const FaultState& state) {
  const bool warns = state.health && *state.health != dronecan::Health::ok;
  const bool fails = warns && *state.health != dronecan::Health::warning;
  return state.errors.empty() &&
         (contradicts_itself(state) || (warns && state.worst() < std::optional(Level::warning)) ||
          (fails && state.worst() < std::optional(Level::failure)));
}

/// A log cannot be asked again: of a servo that tells later of more it is not known what 0x18
/// holds, nor what the registers do in which nothing was found.
void doubt(FaultState& state) {
  const std::uint8_t id = state.snapshot.servo.id.value();
  const Error error{Code::not_recorded, say<texts::faults_not_recorded>(id),
                    say<texts::faults_not_recorded_hint>(), id};
  for (Reading& reading : state.snapshot.readings) {
    const bla::Address address = reading.parameter->address;
    const bool is_empty = reading.raw == 0 && std::ranges::find(bla::fault_registers, address) !=
                                                  bla::fault_registers.end();
    if (is_empty || address == bla::address::fault_summary) {
      reading.raw = std::unexpected(error);
    }
  }
  state.errors.push_back(error);
}

/// `first`: the registers to read of each in any case.
FaultStates read(Session& session, const bla::Profiles& profiles,
                 std::span<const dronecan::NodeId> servos, const Identification::Options& options,
                 std::span<const bla::Address> first) {
  auto snapshots = take_snapshots(
      session, profiles, servos, options,
      [&](const Servo& servo) -> Result<std::vector<const Parameter*>> {
        return servo.identity.registers(first);
      },
      ReadJob::Proof::moment,
      [&](const Snapshot& so_far) {
        return so_far.servo.identity.registers(bla::fault_details(so_far.values(), profiles));
      });
  FaultStates states{.servos = {}, .broken = std::move(snapshots.broken)};
  for (Snapshot& snapshot : snapshots.servos) {
    states.servos.push_back(state_of(std::move(snapshot), session.roster(), profiles));
  }
  return states;
}

} // namespace

std::optional<std::int64_t> FaultState::fault_register(bla::Address reg) const {
  return bla::fault_register(snapshot.values(), reg);
}

std::optional<bla::Level> FaultState::worst() const {
  return faults.empty() ? std::nullopt : std::optional(faults.front().level);
}

std::vector<Reading> FaultState::values_of(const bla::Fault& fault) const {
  std::vector<Reading> values;
  for (const Reading& reading : snapshot.readings) {
    const bla::Address address = reading.parameter->address;
    if (reading.raw && fault.known != nullptr &&
        std::ranges::find(fault.known->values, address) != fault.known->values.end()) {
      values.push_back(reading);
    }
  }
  return values;
}

FaultStates read_faults(Session& session, const bla::Profiles& profiles,
                        std::span<const dronecan::NodeId> servos,
                        const Identification::Options& options) {
  constexpr std::array summary{bla::address::fault_summary};
  FaultStates states = read(session, profiles, servos, options, summary);
  std::vector<dronecan::NodeId> surpassed;
  for (FaultState& state : states.servos) {
    if (is_surpassed(state) && session.is_recording()) {
      doubt(state);
    } else if (is_surpassed(state)) {
      surpassed.push_back(state.snapshot.servo.id);
    }
  }
  if (states.broken || surpassed.empty()) {
    return states;
  }
  FaultStates again = read(session, profiles, surpassed, options, bla::all_fault_registers);
  for (FaultState& now : again.servos) {
    if (now.errors.empty() && contradicts_itself(now)) {
      const std::uint8_t id = now.snapshot.servo.id.value();
      now.errors.push_back(
          {Code::state, say<texts::faults_flicker>(id), say<texts::run_again_hint>(), id});
    }
    const auto before = std::ranges::find(states.servos, now.snapshot.servo.id,
                                          [](const auto& each) { return each.snapshot.servo.id; });
    *before = std::move(now);
  }
  states.broken = std::move(again.broken);
  return states;
}

} // namespace blactl::fleet
