// Restores a servo's settings, whatever was under way.

#include "blactl/bla/value.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"

#include "fleet/characterize/jobs.hpp"
#include "fleet/characterize/soft_start.hpp"
#include "fleet/characterize/test_bench.hpp"
#include "fleet/characterize/texts.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;
using bla::Values;
using dronecan::GetNodeInfo;

namespace {

using namespace std::chrono_literals;

/// Between two searches for a servo that is away.
constexpr Duration look_period = 200ms;

} // namespace

Result<void> TestBench::put_back() {
  puts_back_ = true;
  if (!has_changed_) {
    return {};
  }
  tell(texts::bench_stage_put_back);
  const auto given = give_back();
  auto saved = saved_by_other();
  if (given) {
    return saved ? std::unexpected(std::move(*saved)) : given;
  }
  Error error = not_put_back(given.error());
  if (saved) {
    error.message = say<texts::bench_not_back_and_saved>(error.message, saved->message);
    error.hint = std::move(saved->hint);
  }
  return std::unexpected(std::move(error));
}

Result<void> TestBench::give_back() {
  const auto found = find_servo();
  auto now = found ? read_all() : std::unexpected(found.error());
  if (!now) {
    return std::unexpected(now.error());
  }
  const bool may_hide_command = has_started_ && !starts_softly(*now);
  if (is_as_before(*now) && !may_hide_command) {
    return {};
  }
  // With the output off nothing moves until all is restored; and no soft start hides anything.
  now = rest();
  const auto given = now ? give_back_all(*now) : std::unexpected(now.error());
  const auto end = given ? read_all() : std::unexpected(given.error());
  return end ? prove_given(*end) : std::unexpected(end.error());
}

/// In this order nothing moves. Refused values stay as they are, and show at the end.
Result<void> TestBench::give_back_all(const Values& now) {
  auto given = give_back_standstill();
  given = given ? give_back_settings(now) : given;
  given = given ? give_back_output() : given;
  if (!given) {
    return given;
  }
  // switching the output on has changed the command
  return was_never_commanded() ? give_back_start() : give_back_command();
}

Result<void> TestBench::prove_given(const Values& now) const {
  Values expected = before_;
  std::erase_if(expected,
                [&](const auto& entry) { return hides(entry.first, now.at(entry.first)); });
  if (auto difference = differs_from(now, expected)) {
    return std::unexpected(refused_.value_or(*difference));
  }
  if (const bla::Parameter* moving = motion()) {
    return fail(Code::state, say<texts::bench_still_commanded>(
                                 moving->name, bla::display(*moving, now.at(moving->address))));
  }
  return {};
}

/// The one of 0x01 and 0x02 that can move the shaft; it was at rest before.
const bla::Parameter* TestBench::motion() const {
  for (const Address address : {at::command_speed, at::command_torque}) {
    if (const auto raw = bla::find(known_, address).value_or(0);
        raw != 0 && raw != bla::not_active) {
      return servo_.identity.parameter(address);
    }
  }
  return nullptr;
}

/// While the output is off nothing turns; a start need not clear a command.
Result<void> TestBench::give_back_standstill() {
  const bla::Parameter* moving = motion();
  const auto still = moving != nullptr ? write(moving->address, 0) : Result<std::int64_t>(0);
  return still ? Result<void>() : std::unexpected(still.error());
}

Result<void> TestBench::give_back_output() {
  constexpr std::int64_t on = 0; // 4.13
  const auto output = held(at::torque_output);
  const bla::Parameter* moving = motion();
  const bool turns = moving != nullptr && bla::find(known_, at::speed_torque_control) != 0;
  if (turns && output == on) {
    return fail(Code::state,
                say<texts::bench_would_turn>(
                    moving->name, bla::display(*moving, *bla::find(known_, moving->address))));
  }
  return output ? try_set(at::torque_output, *output) : Result<void>();
}

/// Continues if the value is refused.
Result<void> TestBench::try_set(Address address, std::int64_t raw) {
  auto given = set(address, raw);
  if (!given && (given.error().code == Code::refused || given.error().code == Code::out_of_range)) {
    note_refusal(std::move(given.error()));
    return {};
  }
  return given;
}

/// The first one is reported.
void TestBench::note_refusal(Error error) {
  if (!refused_) {
    refused_ = std::move(error);
  }
}

/// The servo may be away, or under another node ID.
Result<void> TestBench::find_servo() {
  const Time deadline = session_.now() + put_back_time;
  const dronecan::UniqueId unit = servo_.unique_id.value_or(dronecan::UniqueId{});
  for (;;) {
    for (const auto& [id, member] : roster().members()) {
      if (member.is_unit(unit)) {
        servo_.id = id;
      }
    }
    const auto reply = ask(fleet::ask(servo_.id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(),
                                      {manner_.identification.patience.timeout, 0}));
    if (!reply) {
      return std::unexpected(reply.error());
    }
    const auto info =
        reply->answered() ? GetNodeInfo::Response::decode(reply->payload) : std::nullopt;
    if (info && info->unique_id == unit) {
      servo_.boot = roster().member(servo_.id).boots;
      servo_.since = reply->asked;
      return {};
    }
    if (session_.now() >= deadline) {
      const std::uint8_t id = servo_.id.value();
      return std::unexpected(
          Error{Code::not_back, say<texts::node_gone>(id), say<texts::no_answer_hint>(), id});
    }
    if (auto waited = pause(look_period); !waited) {
      return waited;
    }
  }
}

/// All settings but the output, and the command before 0x25 goes off, which ends speeds and
/// torques.
Result<void> TestBench::give_back_settings(const Values& now) {
  const auto differs = [&](Address address, std::int64_t raw) {
    return servo_.identity.is_setting(address) && address != at::torque_output &&
           bla::find(now, address) != raw;
  };
  for (const auto& [address, raw] : before_) {
    if (!differs(address, raw) || address == at::speed_torque_control) {
      continue;
    }
    const bool is_taken = address == at::static_node_id && raw != 0 && is_of_another(raw);
    if (is_taken) {
      note_refusal({Code::duplicate_node_id, say<texts::bench_id_in_use>(raw)});
    } else if (auto given = try_set(address, raw); !given) {
      return given;
    }
  }
  if (auto given = was_never_commanded() ? Result<void>() : give_back_command(); !given) {
    return given;
  }
  const auto speed_control = held(at::speed_torque_control);
  return speed_control && bla::find(known_, at::speed_torque_control) != speed_control
             ? try_set(at::speed_torque_control, *speed_control)
             : Result<void>();
}

bool TestBench::is_of_another(std::int64_t node_id) const {
  const dronecan::NodeId id(static_cast<std::uint8_t>(node_id));
  return id == roster().local() || (id != servo_.id && roster().heard(id));
}

/// The one of 0x00-0x02 that was active before.
std::optional<Address> TestBench::commanded() const {
  for (const Address address : bla::command_registers) {
    if (const auto raw = held(address); raw && *raw != bla::not_active) {
      return address;
    }
  }
  return std::nullopt;
}

/// The state after a start: a command to one of 0x00-0x02 makes the others not active.
bool TestBench::was_never_commanded() const {
  return std::ranges::none_of(bla::command_registers, [&](Address address) {
    return held(address).value_or(bla::not_active) == bla::not_active;
  });
}

/// Only a start restores that, and values from ROM that a register refuses; it brings the shaft
/// slowly to its target.
Result<void> TestBench::give_back_start() {
  for (const Address address : bla::command_registers) {
    if (const auto now = read(address); !now) {
      return std::unexpected(now.error());
    }
  }
  const bool is_as_started = std::ranges::all_of(bla::command_registers, [&](Address address) {
    return bla::find(known_, address) == held(address);
  });
  if (is_as_started && !refused_) {
    return {};
  }
  SaveRestartJob job(roster(), servo_,
                     {.kind = RestartKind::restart,
                      .come_back = longest_start,
                      .patience = manner_.identification.patience,
                      .may_be_driven = manner_.while_driven}); // its load would drop
  Stubborn stubborn(job);
  if (auto ran = run(stubborn); !ran) {
    return ran;
  }
  if (job.error()) {
    return std::unexpected(*job.error());
  }
  const auto found = find_servo();
  return found ? give_back_after_start() : found;
}

/// Settings that were in RAM only, and the angle.
Result<void> TestBench::give_back_after_start() {
  const auto now = read_all();
  if (!now) {
    return std::unexpected(now.error());
  }
  is_starting_softly_ = starts_softly(*now);
  refused_.reset();
  for (const auto& [address, raw] : before_) {
    const std::int64_t told = now->at(address);
    const bool is_hidden = hides(address, told);
    const bool is_held = is_hidden ? bla::find(rom_, address) == raw : told == raw;
    if (!servo_.identity.is_setting(address) || is_held) {
      continue;
    }
    const auto held = write(address, raw);
    if (!held) {
      return std::unexpected(held.error());
    }
    if (*held != raw && !hides(address, *held)) {
      note_refusal(not_taken(address, raw, *held));
    }
  }
  return is_starting_softly_ ? Result<void>() : give_back_angle();
}

/// Whether a read shows the soft start's value instead of the register's own.
bool TestBench::hides(Address address, std::int64_t told) const {
  return is_starting_softly_ && is_soft_start_limit(address, told);
}

/// For a servo that starts in place, and was elsewhere before. The value of 0x00 after a start
/// proves nothing before a command: the output stays as it is.
Result<void> TestBench::give_back_angle() {
  const auto told = give_back_output();
  const auto raw = held(at::command_angle);
  const auto now = told ? read(at::command_angle) : std::unexpected(told.error());
  if (!now) {
    return std::unexpected(now.error());
  }
  return !raw || *now == *raw ? Result<void>() : try_set(at::command_angle, *raw);
}

Result<void> TestBench::give_back_command() {
  const auto address = commanded();
  if (!address) {
    return {};
  }
  const auto now = read(*address);
  if (!now) {
    return std::unexpected(now.error());
  }
  if (*now == *held(*address)) {
    return {};
  }
  const bool needs_switch =
      *address != at::command_angle && bla::find(known_, at::speed_torque_control) == 0;
  const auto on = needs_switch ? try_set(at::speed_torque_control, 1) : Result<void>();
  return on ? try_set(*address, *held(*address)) : on;
}

bool TestBench::is_as_before(const Values& now) const {
  return hidden_.empty() && std::ranges::all_of(before_, [&](const auto& entry) {
           return bla::find(now, entry.first) == entry.second;
         });
}

/// As far as known. For a speed or torque 0 and not active are equivalent.
bool TestBench::is_put_back(Address address, std::int64_t raw) const {
  const bla::Parameter* moving = motion();
  if (address == at::command_speed || address == at::command_torque) {
    return moving == nullptr || moving->address != address;
  }
  return raw == bla::not_active || bla::find(known_, address) == raw;
}

/// The command to type. Motion commands are left out: they would exclude each other, or move the
/// shaft.
std::string TestBench::put_back_hint(const std::vector<const bla::Parameter*>& left) const {
  const std::uint8_t id = servo_.id.value();
  std::string assignments;
  for (const bla::Parameter* parameter : left) {
    if (parameter->is_setting()) {
      assignments += (assignments.empty() ? "" : " ") + parameter->name + "=" +
                     std::to_string(*held(parameter->address)) + "raw";
    }
  }
  if (!assignments.empty() && motion() == nullptr) {
    return say<texts::bench_put_back_hint>(id, assignments);
  }
  return assignments.empty() && !was_never_commanded() && commanded() == at::command_angle
             ? say<texts::bench_angle_hint>(id, *held(at::command_angle))
             : say<texts::bench_restart_hint>(id);
}

/// The remaining differences, as far as known, and the command that restores them.
Error TestBench::not_put_back(const Error& reason) const {
  const std::uint8_t id = servo_.id.value();
  std::vector<const bla::Parameter*> left;
  std::string names;
  for (const auto& [address, raw] : before_) {
    const bla::Parameter* parameter = servo_.identity.parameter(address);
    if (parameter != nullptr && !is_put_back(address, raw)) {
      names += (names.empty() ? "" : ", ") + parameter->name;
      left.push_back(parameter);
    }
  }
  if (names.empty()) {
    return {reason.code, say<texts::bench_not_proven>(id, reason.message), reason.hint, id};
  }
  return {reason.code, say<texts::bench_not_put_back>(id, names, reason.message),
          put_back_hint(left), id};
}

} // namespace blactl::fleet
