// A servo from the command to the shaft.

#include "blactl/bla/fault_bits.hpp"
#include "blactl/bla/faults.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/doctor/motion.hpp"

#include "fleet/doctor/motion_texts.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace blactl::fleet {
namespace {

namespace at = bla::address;
using bla::Address;
using bla::Level;

/// A pair of limits, and the commands that they hold for.
struct CommandLimits {
  Address command, cw, ccw;
};

constexpr CommandLimits angle_limits{at::command_angle, at::angle_limit_cw, at::angle_limit_ccw};
constexpr CommandLimits speed_limits{at::command_speed, at::speed_limit_cw, at::speed_limit_ccw};
constexpr CommandLimits torque_limits{at::command_torque, at::torque_limit_cw,
                                      at::torque_limit_ccw};
constexpr std::array all_limits{angle_limits, speed_limits, torque_limits};

/// Whether findings about a servo show that it cannot follow a command, or help who asks about it.
enum class Weight : std::uint8_t { obstacle, remark };

/// What 0x25 means for speed, torque, and their limits (4.18, 4.32, 4.33).
enum class Control : std::uint8_t {
  unknown,
  on,
  off,
  missing ///< not in this firmware: what then holds is unproven
};

/// What arrives at the PWM input (4.30).
enum class Pulses : std::uint8_t {
  unknown, ///< or there is no such input
  none,
  too_short,
  too_long,
  valid
};

class MotionExamination {
 public:
  MotionExamination(const Snapshot& servo, const HeardCommands& heard,
                    const bla::Profiles& profiles)
      : servo_(servo.servo), values_(servo.values()), heard_(heard), profiles_(profiles),
        id_(servo.servo.id.value()), control_(control()), pulses_(pulses()) {}

  [[nodiscard]] Diagnoses all(MotionLook look) {
    look_ = look;
    commander();
    period();
    pwm_input();
    mode();
    output();
    faults();
    zero_limits(torque_limits, "torque_limit_zero",
                say<texts::motion_no_torque>(id_, zeros(torque_limits)));
    if (!is_asked_only(at::command_torque)) { // it does not heed them (4.32)
      zero_limits(speed_limits, "speed_limit_zero",
                  say<texts::motion_no_speed>(id_, zeros(speed_limits)));
    }
    idle_limits();
    angles();
    beyond_limits();
    return std::move(found_);
  }

 private:
  using Stream = HeardCommands::Stream;

  void add(std::string code, Level level, Weight weight, std::string text, std::string fix) {
    if (look_ == MotionLook::named || weight == Weight::obstacle) {
      found_.push_back({std::move(code), level, servo_.id, std::move(text), std::move(fix)});
    }
  }

  // What is known

  [[nodiscard]] std::optional<std::int64_t> held(Address reg) const {
    return bla::find(values_, reg);
  }

  [[nodiscard]] Control control() const {
    const bla::Parameter* known = servo_.identity.parameter(at::speed_torque_control);
    if (known != nullptr && !servo_.identity.has(*known)) {
      return Control::missing;
    }
    const auto raw = held(at::speed_torque_control);
    return !raw ? Control::unknown : *raw == 0 ? Control::off : Control::on;
  }

  [[nodiscard]] Pulses pulses() const {
    const bla::Profile* profile = servo_.identity.profile();
    const auto notices = bla::fault_register(values_, at::fault_notice);
    if (profile == nullptr || !profile->pwm || !notices || !servo_.identity.check_pwm_input()) {
      return Pulses::unknown;
    }
    namespace fault = bla::fault;
    return (*notices & fault::pwm_missing) != 0     ? Pulses::none
           : (*notices & fault::pwm_too_short) != 0 ? Pulses::too_short
           : (*notices & fault::pwm_too_long) != 0  ? Pulses::too_long
                                                    : Pulses::valid;
  }

  [[nodiscard]] bool has_pulses() const {
    return pulses_ != Pulses::unknown && pulses_ != Pulses::none;
  }

  [[nodiscard]] bool is_commanded() const { return !heard_.to_it.empty(); }

  /// Whether another register than this one is known not to be commanded: by what is heard, else by
  /// what 0x00-0x02 hold.
  [[nodiscard]] bool is_asked_only(Address reg) const {
    if (is_commanded()) {
      return std::ranges::all_of(heard_.to_it, [&](const Stream& stream) {
        return stream.command.asked && stream.command.asked->reg == reg;
      });
    }
    return std::ranges::all_of(bla::command_registers, [&](Address each) {
      const auto raw = held(each);
      return raw && (*raw == bla::not_active) == (each != reg);
    });
  }

  /// "timeout_time=1000ms"; the names only, if what to set is not known.
  [[nodiscard]] std::string setting(Address reg, std::optional<std::int64_t> raw) const {
    const bla::Parameter* known = servo_.identity.parameter(reg);
    if (known == nullptr) {
      return reg.name();
    }
    return known->name + '=' +
           (raw ? bla::input_text(*known, *raw, held(at::pwm_mode)) : std::string("VALUE"));
  }

  [[nodiscard]] std::string default_of(Address reg) const {
    const bla::Parameter* known = servo_.identity.parameter(reg);
    return setting(reg, known != nullptr ? known->default_raw : std::nullopt);
  }

  /// The command that sets this, after who commands the servo has stopped.
  [[nodiscard]] std::string set(const std::string& settings) const {
    return is_commanded()
               ? say<texts::motion_set_when_stopped>(heard_.to_it.front().by.value(), id_, settings)
               : say<texts::motion_set>(id_, settings);
  }

  [[nodiscard]] std::string shown(Address reg, std::int64_t raw) const {
    const bla::Parameter* known = servo_.identity.parameter(reg);
    return known != nullptr ? bla::display(*known, raw) : std::to_string(raw);
  }

  [[nodiscard]] std::string name_of(Address reg) const {
    const bla::Parameter* known = servo_.identity.parameter(reg);
    return known != nullptr ? known->name : reg.name();
  }

  /// "speed_limit_cw 60 rpm, torque_limit_cw 50 %"
  [[nodiscard]] std::string listed(std::span<const Address> registers) const {
    std::string list;
    for (const Address reg : registers) {
      list += (list.empty() ? "" : ", ") + name_of(reg) + ' ' + shown(reg, held(reg).value_or(0));
    }
    return list;
  }

  [[nodiscard]] std::string defaults(std::span<const Address> registers) const {
    std::string list;
    for (const Address reg : registers) {
      list += (list.empty() ? "" : " ") + default_of(reg);
    }
    return list;
  }

  /// What the output does after a pause in the commands (4.19); empty: it stays, or is unknown.
  [[nodiscard]] std::string timeout_text() const {
    const auto action = held(at::timeout_action);
    return action == 1   ? say<texts::motion_timeout_off>()
           : action == 2 ? say<texts::motion_timeout_brake>()
                         : std::string();
  }

  // Who commands it

  void commander() {
    if (is_commanded() || has_pulses() || !heard_.is_long_enough) {
      return;
    }
    if (heard_.to_others.empty()) {
      not_commanded();
    } else if (servo_.servo_id) { // else one of them may be its own
      commanded_other();
    }
  }

  void not_commanded() {
    const auto time = held(at::timeout_time);
    const auto action =
        held(at::timeout_action) == 0 ? say<texts::motion_timeout_hold>() : timeout_text();
    const bool starts_softly = held(at::soft_start) == 1 && held(at::torque_output) == 0;
    add("not_commanded", Level::notice, Weight::remark,
        say<texts::motion_not_commanded>(
            id_,
            time && !action.empty()
                ? say<texts::motion_timeout>(shown(at::timeout_time, *time), action)
                : std::string(),
            starts_softly ? say<texts::motion_soft_start>() : std::string()),
        servo_.servo_id ? say<texts::motion_not_commanded_fix>(*servo_.servo_id, id_)
                        : say<texts::motion_try_fix>(id_));
  }

  void commanded_other() {
    std::string ids;
    for (const auto& [servo_id, by] : heard_.to_others) {
      ids += (ids.empty() ? "" : ", ") + std::to_string(servo_id);
    }
    const std::int64_t own = *servo_.servo_id;
    const bool is_vacant = !heard_.vacant.empty();
    const std::uint8_t wanted =
        is_vacant ? *heard_.vacant.begin() : heard_.to_others.begin()->first;
    add("commanded_other", is_vacant ? Level::warning : Level::notice, Weight::remark,
        say<texts::motion_commanded_other>(heard_.to_others.at(wanted).value(), ids, id_, own),
        is_vacant ? say<texts::motion_take_servo_id_fix>(own, id_, wanted)
                  : say<texts::motion_commanded_other_fix>(own));
  }

  /// Several streams may fill the pauses of one another.
  void period() {
    const auto limit = held(at::timeout_time);
    const auto action = timeout_text();
    if (heard_.to_it.size() != 1 || !limit || action.empty()) {
      return;
    }
    const Stream& only = heard_.to_it.front();
    const auto shortest = only.command.heard.shortest_period();
    const auto ms =
        std::chrono::duration_cast<std::chrono::milliseconds>(shortest.value_or(Duration::zero()))
            .count();
    if (ms > *limit) {
      add("not_commanded", Level::warning, Weight::obstacle,
          say<texts::motion_rarely_commanded>(only.by.value(), id_, ms,
                                              shown(at::timeout_time, *limit), action),
          say<texts::motion_rarely_commanded_fix>(set(setting(at::timeout_time, 2 * ms))));
    }
  }

  void pwm_input() {
    if (!has_pulses()) {
      return;
    }
    constexpr const char* code = "pwm_has_no_say";
    if (is_commanded()) {
      const std::uint8_t by = heard_.to_it.front().by.value();
      const auto time = held(at::timeout_time);
      add(code, Level::notice, Weight::remark,
          say<texts::motion_can_before_pwm>(
              by, id_, time ? shown(at::timeout_time, *time) : name_of(at::timeout_time)),
          say<texts::motion_can_before_pwm_fix>(by));
    } else if (pulses_ != Pulses::valid) {
      add(code, Level::warning, Weight::remark,
          pulses_ == Pulses::too_short ? say<texts::motion_pulse_short>(id_)
                                       : say<texts::motion_pulse_long>(id_),
          say<texts::motion_pulse_fix>(id_));
    } else if (held(at::pwm_output_range) == 0) {
      add(code, Level::warning, Weight::remark, say<texts::motion_pulse_means_zero>(id_),
          say<texts::motion_pulse_fix>(id_));
    }
  }

  // What is made of the command

  void mode() {
    for (const Stream& stream : heard_.to_it) {
      mode(stream);
    }
    if (!is_commanded() && has_pulses() && held(at::pwm_mode) == bla::pwm_speed_mode &&
        control_ == Control::off) {
      add("mode_without_effect", Level::warning, Weight::remark,
          say<texts::motion_pwm_mode_off>(id_), set(setting(at::speed_torque_control, 1)));
    }
  }

  void mode(const Stream& stream) {
    constexpr const char* code = "mode_without_effect";
    constexpr std::uint8_t known_types = 5; // those of DroneCAN; PWM has a finding of its own
    const std::uint8_t by = stream.by.value();
    const auto& asked = stream.command.asked;
    if (!asked && stream.command.type >= known_types) {
      add(code, Level::warning, Weight::obstacle,
          say<texts::motion_type_unknown>(by, id_, stream.command.type),
          say<texts::motion_type_unknown_fix>());
    }
    if (!asked || asked->reg == at::command_angle) {
      return;
    }
    const std::string word = name_of(asked->reg);
    if (control_ == Control::off) {
      add(code, Level::warning, Weight::obstacle,
          say<texts::motion_mode_off>(by, id_, word, asked->reg.name()),
          say<texts::motion_mode_fix>(set(setting(at::speed_torque_control, 1))));
    } else if (control_ == Control::missing) {
      add(code, Level::notice, Weight::obstacle,
          say<texts::motion_mode_unproven>(by, id_, word, asked->reg.name()),
          say<texts::motion_mode_unproven_fix>());
    }
  }

  // The output

  void output() {
    const auto raw = held(at::torque_output);
    if (raw.value_or(0) != 0) {
      add("torque_off", Level::warning, Weight::obstacle,
          say<texts::motion_torque_off>(id_, shown(at::torque_output, *raw)),
          set(setting(at::torque_output, 0)));
    }
  }

  void faults() {
    for (const bla::Fault& fault : bla::faults(values_, profiles_)) {
      const auto holds = bla::holds_output_off(fault, values_);
      if (fault.known == nullptr || !fault.known->output_off || holds == false) {
        continue;
      }
      const std::string what(choose(fault.known->text_en, fault.known->text_ja));
      const bla::Cause cause = bla::cause(fault, values_);
      const std::string why(choose(cause.condition_en, cause.condition_ja));
      const std::string measured = measured_text(cause);
      const int bit = fault.bit;
      add("fault_holds_off", holds ? fault.level : Level::notice,
          holds ? Weight::obstacle : Weight::remark,
          holds
              ? say<texts::motion_held_off>(id_, what, fault.reg.name(), bit, why, measured)
              : say<texts::motion_maybe_held_off>(id_, what, fault.reg.name(), bit, why, measured),
          say<texts::motion_held_off_fix>(choose(fault.known->action_en, fault.known->action_ja),
                                          id_));
    }
  }

  /// " (current_voltage 3.4 V, voltage_limit_low 4.0 V)"; empty: nothing is measured.
  [[nodiscard]] std::string measured_text(const bla::Cause& cause) const {
    const bool is_known =
        std::ranges::all_of(cause.values, [&](Address reg) { return held(reg).has_value(); });
    return cause.values.empty() || !is_known ? std::string() : " (" + listed(cause.values) + ")";
  }

  // Limits

  [[nodiscard]] std::vector<Address> zero_sides(const CommandLimits& pair) const {
    std::vector<Address> sides;
    for (const Address side : {pair.cw, pair.ccw}) {
      if (held(side) == 0) {
        sides.push_back(side);
      }
    }
    return sides;
  }

  [[nodiscard]] std::string zeros(const CommandLimits& pair) const {
    return listed(zero_sides(pair));
  }

  void zero_limits(const CommandLimits& pair, std::string code, std::string text) {
    const auto sides = zero_sides(pair);
    if (sides.empty() || (control_ != Control::on && control_ != Control::missing)) {
      return;
    }
    const bool acts = control_ == Control::on;
    add(std::move(code), acts ? Level::warning : Level::notice, Weight::obstacle,
        acts ? std::move(text) : text + say<texts::motion_limit_unproven>(), set(defaults(sides)));
  }

  /// A limit that is not as from the factory was set by somebody who counts on it.
  void idle_limits() {
    if (control_ != Control::off) {
      return;
    }
    std::vector<Address> idle;
    for (const CommandLimits& pair : {speed_limits, torque_limits}) {
      for (const Address side : {pair.cw, pair.ccw}) {
        const bla::Parameter* known = servo_.identity.parameter(side);
        const auto raw = held(side);
        if (known != nullptr && known->default_raw && raw && raw != known->default_raw) {
          idle.push_back(side);
        }
      }
    }
    if (!idle.empty()) {
      add("limits_without_effect", Level::notice, Weight::remark,
          say<texts::motion_limits_idle>(id_, listed(idle)),
          say<texts::motion_limits_idle_fix>(set(setting(at::speed_torque_control, 1)),
                                             say<texts::motion_set>(id_, defaults(idle))));
    }
  }

  /// They hold for angles only (4.31).
  [[nodiscard]] bool may_be_asked_angles() const {
    return !is_asked_only(at::command_speed) && !is_asked_only(at::command_torque);
  }

  void angles() {
    const auto sides = zero_sides(angle_limits);
    if (sides.empty() || !may_be_asked_angles()) {
      return;
    }
    const bool is_fixed = sides.size() == 2;
    add("angle_limits", is_fixed ? Level::warning : Level::notice,
        is_fixed ? Weight::obstacle : Weight::remark,
        is_fixed ? say<texts::motion_angle_fixed>(id_, listed(sides))
                 : say<texts::motion_angle_one_side>(id_, listed(sides)),
        set(defaults(sides)));
  }

  // A command beyond a limit

  void beyond_limits() {
    for (const CommandLimits& pair : all_limits) {
      const bool heeds =
          pair.command == at::command_angle ? zero_sides(pair).size() < 2 : control_ == Control::on;
      if (heeds) {
        beyond(pair);
      }
    }
  }

  void beyond(const CommandLimits& pair) {
    for (const Stream& stream : heard_.to_it) {
      if (stream.command.asked && stream.command.asked->reg == pair.command) {
        beyond(pair, stream.by, *stream.command.asked);
      }
    }
    const auto raw = held(pair.command);
    if (!is_commanded() && raw && *raw != bla::not_active) {
      beyond(pair, std::nullopt, {.reg = pair.command, .least = *raw, .greatest = *raw});
    }
  }

  void beyond(const CommandLimits& pair, std::optional<dronecan::NodeId> by,
              const Commander::Asked& asked) {
    // +180.0 deg is reached as +179.9 (4.1)
    constexpr std::int64_t half_turn = 1800;
    const auto cw = held(pair.cw);
    const auto ccw = held(pair.ccw);
    const bool is_half_turn =
        pair.command == at::command_angle && asked.greatest == half_turn && cw == half_turn - 1;
    if (cw && asked.greatest > *cw && !is_half_turn) {
      beyond(pair.command, asked.greatest, pair.cw, by);
    }
    if (ccw && asked.least < *ccw) {
      beyond(pair.command, asked.least, pair.ccw, by);
    }
  }

  void beyond(Address command, std::int64_t raw, Address limit,
              std::optional<dronecan::NodeId> by) {
    const std::int64_t most = *held(limit);
    if (most == 0 && command != at::command_angle) {
      return; // it is told that the limit is 0
    }
    const std::string value = shown(command, raw), word = name_of(command);
    const std::string name = name_of(limit), reach = shown(limit, most);
    add("command_beyond_limit", Level::warning, is_commanded() ? Weight::obstacle : Weight::remark,
        by ? say<texts::motion_beyond>(by->value(), id_, value, word, name, reach)
           : say<texts::motion_held_beyond>(id_, value, word, name, reach),
        servo_.identity.may_write(limit, raw)
            ? say<texts::motion_widen_fix>(set(setting(limit, raw)))
            : say<texts::motion_within_fix>());
  }

  const Servo& servo_;
  bla::Values values_;
  const HeardCommands& heard_;
  const bla::Profiles& profiles_;
  std::uint8_t id_;
  Control control_;
  Pulses pulses_;
  MotionLook look_ = MotionLook::named;
  Diagnoses found_;
};

} // namespace

std::vector<const bla::Parameter*> registers_of_motion(const Servo& servo) {
  return servo.identity.registers(std::array{
      at::command_angle,
      at::command_speed,
      at::command_torque,
      at::current_temperature,
      at::current_voltage,
      at::fault_summary,
      at::fault_notice,
      at::fault_warning,
      at::fault_failure,
      at::torque_output,
      at::soft_start,
      at::speed_torque_control,
      at::timeout_action,
      at::timeout_time,
      at::pwm_output_range,
      at::pwm_mode,
      at::angle_limit_cw,
      at::angle_limit_ccw,
      at::speed_limit_cw,
      at::speed_limit_ccw,
      at::torque_limit_cw,
      at::torque_limit_ccw,
      at::temperature_limit_high,
      at::temperature_limit_low,
      at::voltage_limit_high,
      at::voltage_limit_low,
  });
}

Diagnoses diagnose_motion(const Snapshot& servo, const HeardCommands& heard,
                          const bla::Profiles& profiles, MotionLook look) {
  return MotionExamination(servo, heard, profiles).all(look);
}

} // namespace blactl::fleet
