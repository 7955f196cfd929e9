#include "blactl/fleet/live/fault_job.hpp"

#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include <algorithm>
#include <array>
#include <list>
#include <utility>

namespace blactl::fleet {
namespace {

using bla::Level;
using bla::Parameter;
using dronecan::NodeId;
using dronecan::Outcome;
using dronecan::Step;

constexpr std::array summary{bla::address::fault_summary};

/// A missing one of the three fault registers makes the faults incomplete, and so does any that is
/// refused; else 0x18 and related values do not.
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
    const bool is_refused = !reading.raw && reading.raw.error().code == Code::refused;
    if (is_missing || is_refused) {
      needed.readings.push_back(reading);
    }
  }
  return needed.errors();
}

/// `at`: the end of the look; on a recording, which may end much later, when it was last heard.
FaultState state_of(Snapshot snapshot, const Roster& roster, const bla::Profiles& profiles,
                    std::optional<Time> at) {
  FaultState state{.snapshot = std::move(snapshot), .faults = {}, .health = {}, .errors = {}};
  state.errors = errors_of(state.snapshot, roster);
  if (roster.is_doubled(state.snapshot.servo.id)) {
    state.snapshot.readings.clear(); // they may be either unit's
  }
  state.faults = bla::faults(state.snapshot.values(), profiles);
  const Member member = roster.member(state.snapshot.servo.id);
  if (const auto status = member.status_as_of(at.value_or(member.last_heard))) {
    state.health = status->health;
  }
  return state;
}

/// 0x18 has bits of a register that was read without any.
bool contradicts_itself(const FaultState& state) {
  const auto values = state.snapshot.values();
  return std::ranges::any_of(bla::fault_registers, [&](bla::Address reg) {
    return bla::is_summed_up(values, reg) && bla::find(values, reg) == 0;
  });
}

/// A register has bits that 0x18 has not: on a recording either may be the older reading.
bool shows_more_than_summary(const FaultState& state) {
  const auto values = state.snapshot.values();
  return bla::find(values, bla::address::fault_summary) &&
         std::ranges::any_of(bla::fault_registers, [&](bla::Address reg) {
           return !bla::is_summed_up(values, reg) && bla::find(values, reg).value_or(0) != 0;
         });
}

/// Its NodeStatus reports more than the registers, which were read at different times.
bool is_surpassed(const FaultState& state) {
  const bool warns = state.health && *state.health != dronecan::Health::ok;
  const bool fails = warns && *state.health != dronecan::Health::warning;
  return state.errors.empty() &&
         (contradicts_itself(state) || (warns && state.worst() < std::optional(Level::warning)) ||
          (fails && state.worst() < std::optional(Level::failure)));
}

/// Its NodeStatus reports less than a register, which it held before.
bool is_outlived(const FaultState& state, bla::Address reg) {
  using dronecan::Health;
  const bool is_of_failures = reg == bla::address::fault_failure;
  const bool is_of_warnings = reg == bla::address::fault_warning;
  const bool is_over = state.health == Health::ok
                           ? is_of_failures || is_of_warnings
                           : state.health == Health::warning && is_of_failures;
  return is_over && bla::find(state.snapshot.values(), reg).value_or(0) != 0;
}

bool is_outlived(const FaultState& state) {
  return std::ranges::any_of(bla::fault_registers,
                             [&](bla::Address reg) { return is_outlived(state, reg); });
}

/// A log cannot be asked again: if a servo reports more later, the value of 0x18 is unknown, and so
/// are the registers without faults; if it reports less, so are those with faults.
void doubt(FaultState& state, const bla::Profiles& profiles) {
  const std::uint8_t id = state.snapshot.servo.id.value();
  const Error error{Code::not_recorded, say<texts::faults_not_recorded>(id),
                    say<texts::faults_not_recorded_hint>(), id};
  for (Reading& reading : state.snapshot.readings) {
    const bla::Address address = reading.parameter->address;
    const bool is_empty = reading.raw == 0 && std::ranges::find(bla::fault_registers, address) !=
                                                  bla::fault_registers.end();
    if (is_empty || is_outlived(state, address) || address == bla::address::fault_summary) {
      reading.raw = std::unexpected(error);
    }
  }
  state.faults = bla::faults(state.snapshot.values(), profiles);
  state.errors.push_back(error);
}

} // namespace

std::optional<std::int64_t> FaultState::fault_register(bla::Address reg) const {
  return bla::fault_register(snapshot.values(), reg);
}

std::optional<bla::Level> FaultState::worst() const {
  return faults.empty() ? std::nullopt : std::optional(faults.front().level);
}

std::optional<bla::Level> FaultState::unexplained_health() const {
  if (!errors.empty() || !health || *health == dronecan::Health::ok) {
    return std::nullopt;
  }
  const Level told = *health == dronecan::Health::warning ? Level::warning : Level::failure;
  const bool is_explained = told == Level::failure ? worst() == told : worst().has_value();
  return is_explained ? std::nullopt : std::optional(told);
}

bool FaultState::has_answered() const {
  return std::ranges::all_of(errors,
                             [](const Error& error) { return error.code == Code::refused; });
}

std::vector<Reading> FaultState::values_of(const bla::Fault& fault) const {
  std::vector<Reading> values;
  for (const bla::Address address : bla::cause(fault, snapshot.values()).values) {
    const auto reading = std::ranges::find_if(snapshot.readings, [&](const Reading& each) {
      return each.parameter->address == address && each.raw;
    });
    if (reading != snapshot.readings.end()) {
      values.push_back(*reading);
    }
  }
  return values;
}

bool has_found(const FaultState& servo, Level level) {
  return std::max(servo.worst(), servo.unexplained_health()) >= std::optional(level);
}

FaultJob::FaultJob(Session& session, const bla::Profiles& profiles, NodeId id,
                   const Identification::Options& options)
    : session_(session), profiles_(profiles), options_(options) {
  state_.snapshot.servo.id = id;
  session.is_replay() ? look(bla::all_fault_registers) : look(summary);
}

/// `first`: the registers that are read in any case.
void FaultJob::look(std::span<const bla::Address> first) {
  read_.emplace(
      session_.records(), state_.snapshot.servo.id, profiles_, options_,
      [first](const Servo& servo) -> Result<std::vector<const Parameter*>> {
        return servo.identity.registers(first);
      },
      session_.is_replay() ? ReadJob::Proof::none : ReadJob::Proof::moment,
      [this](const Snapshot& so_far) {
        return so_far.servo.identity.registers(bla::fault_details(so_far.values(), profiles_));
      });
}

Step FaultJob::next(const Outcome& outcome) {
  Step step = read_->next(outcome);
  return step.is_end() ? judge(outcome.at) : step;
}

Step FaultJob::judge(Time now) {
  state_ = state_of(read_->snapshot(), session_.roster(), profiles_,
                    session_.is_replay() ? std::nullopt : std::optional(now));
  if (is_second_) {
    if (state_.errors.empty() && contradicts_itself(state_)) {
      const std::uint8_t id = state_.snapshot.servo.id.value();
      state_.errors.push_back(
          {Code::state, say<texts::faults_flicker>(id), say<texts::run_again_hint>(), id});
    }
    return std::nullopt;
  }
  if (session_.is_replay()) {
    if (is_surpassed(state_) || is_outlived(state_) || shows_more_than_summary(state_)) {
      doubt(state_, profiles_);
    }
    return std::nullopt;
  }
  if (!is_surpassed(state_)) {
    return std::nullopt;
  }
  is_second_ = true;
  look(bla::all_fault_registers);
  return read_->next({Outcome::Kind::start, {}, now});
}

FaultStates read_faults(Session& session, const bla::Profiles& profiles,
                        std::span<const NodeId> servos, const Identification::Options& options) {
  session.records().accept_exchanges();
  std::list<FaultJob> jobs;
  std::vector<dronecan::Job*> group;
  for (const NodeId id : servos) {
    group.push_back(&jobs.emplace_back(session, profiles, id, options));
  }
  const auto ran = session.run(group);
  FaultStates states{.servos = {}, .broken = {}};
  for (const FaultJob& job : jobs) {
    states.servos.push_back(job.state());
  }
  if (!ran) {
    states.broken = ran.error();
  }
  return states;
}

} // namespace blactl::fleet
