// A servo on the way to the shaft: its output, and its limits.

#include "blactl/bla/fault_bits.hpp"
#include "blactl/bla/faults.hpp"
#include "blactl/bla/value.hpp"

#include "fleet/doctor/motion_findings.hpp"
#include "fleet/doctor/motion_texts.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

class OutputExamination {
 public:
  OutputExamination(const MotionFacts& facts, MotionFindings& found)
      : facts_(facts), heard_(facts.heard()), id_(facts.id()), found_(found) {}

  void all() {
    output();
    faults();
    zero_limits(torque_limits, "torque_limit_zero",
                say<texts::motion_no_torque>(id_, zeros(torque_limits)));
    if (!facts_.is_asked_only(at::command_torque)) { // it does not heed them (4.32)
      zero_limits(speed_limits, "speed_limit_zero",
                  say<texts::motion_no_speed>(id_, zeros(speed_limits)));
    }
    idle_limits();
    angles();
    beyond_limits();
    torque_at_limit();
  }

 private:
  using Stream = HeardCommands::Stream;

  // The output

  void output() {
    const auto raw = facts_.held(at::torque_output);
    if (raw.value_or(0) != 0) {
      found_.add("torque_off", Level::warning, Weight::obstacle,
                 say<texts::motion_torque_off>(id_, facts_.shown(at::torque_output, *raw)),
                 facts_.set(at::torque_output, 0));
    }
  }

  void faults() {
    for (const bla::Fault& fault : bla::faults(facts_.values(), facts_.profiles())) {
      const auto holds = bla::holds_output_off(fault, facts_.values());
      if (fault.known == nullptr || !fault.known->output_off || holds == false) {
        continue;
      }
      const std::string what(choose(fault.known->text_en, fault.known->text_ja));
      const bla::Cause cause = bla::cause(fault, facts_.values());
      const std::string why(choose(cause.condition_en, cause.condition_ja));
      const std::string measured = measured_text(cause);
      const int bit = fault.bit;
      found_.add(
          "fault_holds_off", holds ? fault.level : Level::notice,
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
    const bool is_known = std::ranges::all_of(
        cause.values, [&](Address reg) { return facts_.held(reg).has_value(); });
    return cause.values.empty() || !is_known ? std::string()
                                             : " (" + facts_.listed(cause.values) + ")";
  }

  /// It pushes as hard as it may and stands still. Of a limit of 0 it is told that it is 0.
  void torque_at_limit() {
    if (!facts_.is_commanded() || facts_.held(at::current_speed) != 0 ||
        !zero_sides(torque_limits).empty()) {
      return;
    }
    for (const bla::Fault& fault : bla::faults(facts_.values(), facts_.profiles())) {
      const bla::Cause cause = bla::cause(fault, facts_.values());
      const bool is_limit =
          std::ranges::find(cause.values, at::current_torque) != cause.values.end();
      if (is_limit) {
        found_.add("torque_at_limit", Level::warning, Weight::obstacle,
                   say<texts::motion_torque_at_limit>(id_, measured_text(cause)),
                   say<texts::motion_torque_at_limit_fix>(id_));
      }
    }
  }

  // Limits

  [[nodiscard]] std::vector<Address> zero_sides(const CommandLimits& pair) const {
    std::vector<Address> sides;
    for (const Address side : {pair.cw, pair.ccw}) {
      if (facts_.held(side) == 0) {
        sides.push_back(side);
      }
    }
    return sides;
  }

  [[nodiscard]] std::string zeros(const CommandLimits& pair) const {
    return facts_.listed(zero_sides(pair));
  }

  void zero_limits(const CommandLimits& pair, std::string code, std::string text) {
    const auto sides = zero_sides(pair);
    if (sides.empty() || (facts_.control() != MotionFacts::Control::on &&
                          facts_.control() != MotionFacts::Control::missing)) {
      return;
    }
    const bool acts = facts_.control() == MotionFacts::Control::on;
    found_.add(std::move(code), acts ? Level::warning : Level::notice, Weight::obstacle,
               acts ? std::move(text) : text + say<texts::motion_limit_unproven>(),
               facts_.set_defaults(sides));
  }

  /// A limit that is not as from the factory was set by somebody who counts on it.
  void idle_limits() {
    if (facts_.control() != MotionFacts::Control::off) {
      return;
    }
    std::vector<Address> idle;
    for (const CommandLimits& pair : {speed_limits, torque_limits}) {
      for (const Address side : {pair.cw, pair.ccw}) {
        const bla::Parameter* known = facts_.servo().identity.parameter(side);
        const auto raw = facts_.held(side);
        if (known != nullptr && known->default_raw && raw && raw != known->default_raw) {
          idle.push_back(side);
        }
      }
    }
    if (!idle.empty()) {
      found_.add("limits_without_effect", Level::notice, Weight::remark,
                 say<texts::motion_limits_idle>(id_, facts_.listed(idle)),
                 say<texts::motion_limits_idle_fix>(facts_.set(at::speed_torque_control, 1),
                                                    facts_.defaults_command(idle)));
    }
  }

  /// They hold for angles only (4.31).
  [[nodiscard]] bool may_be_asked_angles() const {
    return !facts_.is_asked_only(at::command_speed) && !facts_.is_asked_only(at::command_torque);
  }

  void angles() {
    const auto sides = zero_sides(angle_limits);
    if (sides.empty() || !may_be_asked_angles()) {
      return;
    }
    const bool is_fixed = sides.size() == 2;
    found_.add("angle_limits", is_fixed ? Level::warning : Level::notice,
               is_fixed ? Weight::obstacle : Weight::remark,
               is_fixed ? say<texts::motion_angle_fixed>(id_, facts_.listed(sides))
                        : say<texts::motion_angle_one_side>(id_, facts_.listed(sides)),
               facts_.set_defaults(sides));
  }

  // A command beyond a limit

  void beyond_limits() {
    for (const CommandLimits& pair : all_limits) {
      const bool heeds = pair.command == at::command_angle
                             ? zero_sides(pair).size() < 2
                             : facts_.control() == MotionFacts::Control::on;
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
    const auto raw = facts_.held(pair.command);
    if (!facts_.is_commanded() && raw && *raw != bla::not_active) {
      beyond(pair, std::nullopt, {.reg = pair.command, .least = *raw, .greatest = *raw});
    }
  }

  void beyond(const CommandLimits& pair, std::optional<dronecan::NodeId> by,
              const Commander::Asked& asked) {
    // +180.0 deg is reached as +179.9 (4.1)
    constexpr std::int64_t half_turn = 1800;
    const auto cw = facts_.held(pair.cw);
    const auto ccw = facts_.held(pair.ccw);
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
    const std::int64_t most = *facts_.held(limit);
    if (most == 0 && command != at::command_angle) {
      return; // it is told that the limit is 0
    }
    const std::string value = facts_.shown(command, raw), word = facts_.name_of(command);
    const std::string name = facts_.name_of(limit), reach = facts_.shown(limit, most);
    found_.add("command_beyond_limit", Level::warning,
               facts_.is_commanded() ? Weight::obstacle : Weight::remark,
               by ? say<texts::motion_beyond>(by->value(), id_, value, word, name, reach)
                  : say<texts::motion_held_beyond>(id_, value, word, name, reach),
               facts_.servo().identity.may_write(limit, raw)
                   ? say<texts::motion_widen_fix>(facts_.set(limit, raw))
                   : say<texts::motion_within_fix>());
  }

  const MotionFacts& facts_;
  const HeardCommands& heard_;
  std::uint8_t id_;
  MotionFindings& found_;
};

} // namespace

void find_in_output(const MotionFacts& facts, MotionFindings& found) {
  OutputExamination(facts, found).all();
}

} // namespace blactl::fleet
