// A servo on the way from the command: who commands it, and what it makes of that.

#include "blactl/bla/value.hpp"

#include "fleet/doctor/motion_findings.hpp"
#include "fleet/doctor/motion_texts.hpp"

#include <chrono>
#include <cstdint>
#include <string>

namespace blactl::fleet {
namespace {

namespace at = bla::address;
using bla::Level;

class CommandExamination {
 public:
  CommandExamination(const MotionFacts& facts, MotionFindings& found)
      : facts_(facts), heard_(facts.heard()), id_(facts.id()), found_(found) {}

  void all() {
    commander();
    period();
    pwm_input();
    mode();
  }

 private:
  using Stream = HeardCommands::Stream;

  // Who commands it

  void commander() {
    if (facts_.is_commanded() || facts_.has_pulses() || !heard_.is_long_enough) {
      return;
    }
    if (heard_.to_others.empty()) {
      not_commanded();
    } else if (facts_.servo().servo_id) { // else one of them may be its own
      commanded_other();
    }
  }

  void not_commanded() {
    const auto time = facts_.held(at::timeout_time);
    const auto action = facts_.held(at::timeout_action) == 0 ? say<texts::motion_timeout_hold>()
                                                             : facts_.timeout_text();
    const bool starts_softly =
        facts_.held(at::soft_start) == 1 && facts_.held(at::torque_output) == 0;
    found_.add("not_commanded", Level::notice, Weight::remark,
               say<texts::motion_not_commanded>(
                   id_,
                   time && !action.empty()
                       ? say<texts::motion_timeout>(facts_.shown(at::timeout_time, *time), action)
                       : std::string(),
                   starts_softly ? say<texts::motion_soft_start>() : std::string()),
               facts_.servo().servo_id
                   ? say<texts::motion_not_commanded_fix>(*facts_.servo().servo_id, id_, trial())
                   : say<texts::motion_try_fix>(id_, trial()));
  }

  /// An angle that its limits allow: "angle=10deg".
  [[nodiscard]] std::string trial() const {
    constexpr std::int64_t wanted = 100; // 10 deg: to be seen
    const std::int64_t cw = facts_.held(at::angle_limit_cw).value_or(wanted);
    const std::int64_t ccw = facts_.held(at::angle_limit_ccw).value_or(-wanted);
    const std::int64_t nearest = cw >= -ccw ? cw : ccw;
    const std::int64_t raw = cw >= wanted ? wanted : ccw <= -wanted ? -wanted : nearest;
    const bla::Parameter* angle = facts_.servo().identity.parameter(at::command_angle);
    return "angle=" + (raw % 10 == 0 || angle == nullptr ? std::to_string(raw / 10) + "deg"
                                                         : bla::input_text(*angle, raw, {}));
  }

  void commanded_other() {
    std::string ids;
    for (const auto& [servo_id, by] : heard_.to_others) {
      ids += (ids.empty() ? "" : ", ") + std::to_string(servo_id);
    }
    const std::int64_t own = *facts_.servo().servo_id;
    const bool is_vacant = !heard_.vacant.empty();
    const std::uint8_t wanted =
        is_vacant ? *heard_.vacant.begin() : heard_.to_others.begin()->first;
    found_.add(
        "commanded_other", is_vacant ? Level::warning : Level::notice, Weight::remark,
        say<texts::motion_commanded_other>(heard_.to_others.at(wanted).value(), ids, id_, own),
        is_vacant ? say<texts::motion_take_servo_id_fix>(own, id_, wanted)
                  : say<texts::motion_commanded_other_fix>(own));
  }

  /// Several streams may fill the pauses of one another.
  void period() {
    const auto limit = facts_.held(at::timeout_time);
    const auto action = facts_.timeout_text();
    if (heard_.to_it.size() != 1 || !limit || action.empty()) {
      return;
    }
    const Stream& only = heard_.to_it.front();
    const auto shortest = only.command.heard.shortest_period();
    const auto ms =
        std::chrono::duration_cast<std::chrono::milliseconds>(shortest.value_or(Duration::zero()))
            .count();
    if (ms > *limit) {
      found_.add("not_commanded", Level::warning, Weight::obstacle,
                 say<texts::motion_rarely_commanded>(
                     only.by.value(), id_, ms, facts_.shown(at::timeout_time, *limit), action),
                 say<texts::motion_rarely_commanded_fix>(facts_.set(at::timeout_time, 2 * ms)));
    }
  }

  void pwm_input() {
    if (!facts_.has_pulses()) {
      return;
    }
    constexpr const char* code = "pwm_has_no_say";
    if (facts_.is_commanded()) {
      const std::uint8_t by = heard_.to_it.front().by.value();
      const auto time = facts_.held(at::timeout_time);
      found_.add(code, Level::notice, Weight::remark,
                 say<texts::motion_can_before_pwm>(by, id_,
                                                   time ? facts_.shown(at::timeout_time, *time)
                                                        : facts_.name_of(at::timeout_time)),
                 say<texts::motion_can_before_pwm_fix>(by));
    } else if (facts_.pulses() != MotionFacts::Pulses::valid) {
      found_.add(code, Level::warning, Weight::remark,
                 facts_.pulses() == MotionFacts::Pulses::too_short
                     ? say<texts::motion_pulse_short>(id_)
                     : say<texts::motion_pulse_long>(id_),
                 say<texts::motion_pulse_fix>(id_));
    } else if (facts_.held(at::pwm_output_range) == 0) {
      found_.add(code, Level::warning, Weight::remark, say<texts::motion_pulse_means_zero>(id_),
                 say<texts::motion_pulse_fix>(id_));
    }
  }

  // What is made of the command

  void mode() {
    for (const Stream& stream : heard_.to_it) {
      mode(stream);
    }
    if (!facts_.is_commanded() && facts_.has_pulses() &&
        facts_.held(at::pwm_mode) == bla::pwm_speed_mode &&
        facts_.control() == MotionFacts::Control::off) {
      found_.add("mode_without_effect", Level::warning, Weight::remark,
                 say<texts::motion_pwm_mode_off>(id_), facts_.set(at::speed_torque_control, 1));
    }
  }

  void mode(const Stream& stream) {
    constexpr const char* code = "mode_without_effect";
    constexpr std::uint8_t known_types = 5; // those of DroneCAN; PWM has a finding of its own
    const std::uint8_t by = stream.by.value();
    const auto& asked = stream.command.asked;
    if (!asked && stream.command.type >= known_types) {
      found_.add(code, Level::warning, Weight::obstacle,
                 say<texts::motion_type_unknown>(by, id_, stream.command.type),
                 say<texts::motion_type_unknown_fix>());
    }
    if (!asked || asked->reg == at::command_angle) {
      return;
    }
    const std::string word = facts_.name_of(asked->reg);
    if (facts_.control() == MotionFacts::Control::off) {
      found_.add(code, Level::warning, Weight::obstacle,
                 say<texts::motion_mode_off>(by, id_, word, asked->reg.name()),
                 say<texts::motion_mode_fix>(facts_.set(at::speed_torque_control, 1)));
    } else if (facts_.control() == MotionFacts::Control::missing) {
      found_.add(code, Level::notice, Weight::obstacle,
                 say<texts::motion_mode_unproven>(by, id_, word, asked->reg.name()),
                 say<texts::motion_mode_unproven_fix>());
    }
  }

  const MotionFacts& facts_;
  const HeardCommands& heard_;
  std::uint8_t id_;
  MotionFindings& found_;
};

} // namespace

void find_in_commands(const MotionFacts& facts, MotionFindings& found) {
  CommandExamination(facts, found).all();
}

} // namespace blactl::fleet
