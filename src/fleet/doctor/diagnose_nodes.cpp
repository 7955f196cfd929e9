// The nodes of a bus, individually and together.

#include "blactl/base/hex.hpp"
#include "blactl/bla/defect.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/bus/status_words.hpp"
#include "blactl/fleet/doctor/diagnosis.hpp"
#include "blactl/fleet/doctor/motion.hpp"
#include "blactl/state/local_node_id.hpp"

#include "fleet/doctor/diagnosis_texts.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <ranges>
#include <set>
#include <utility>

namespace blactl::fleet {
namespace {

using bla::Level;
using dronecan::NodeId;

/// A node heard for this long without a NodeStatus does not send it; one a second is due.
constexpr Duration enough_for_status = std::chrono::milliseconds(2500);

/// The longest period of NodeStatus is 1 s (uavcan/protocol/341.NodeStatus); the bus may delay one.
constexpr Duration slow_status = std::chrono::milliseconds(1300);

constexpr std::uint8_t every_servo = 255;

/// Of ArrayCommand (1010.ArrayCommand.uavcan); PWM came after the BLA servos.
constexpr std::uint8_t type_unitless = 0, type_pwm = 4;

/// The range of UNITLESS +-1 (errata C10), in tenths of a degree; +180 is not reached.
constexpr std::int64_t unitless_cw = 1799, unitless_ccw = -1800;

/// "11, 12"
std::string joined_ids(const auto& nodes) {
  std::string ids;
  for (const NodeId id : nodes) {
    ids += (ids.empty() ? "" : ", ") + std::to_string(id.value());
  }
  return ids;
}

/// "uid:0a1b2c3d4e5f,uid:…": as much of each as was heard.
std::string selectors_of(std::span<const UniqueIdPrefix> units) {
  std::string list;
  for (const UniqueIdPrefix& unit : units) {
    list += (list.empty() ? "uid:" : ",uid:") + hex(unit);
  }
  return list;
}

class NodeExamination {
 public:
  NodeExamination(const Findings& findings, const Traffic& traffic, MotionLook look)
      : findings_(findings), traffic_(traffic), look_(look) {}

  [[nodiscard]] Diagnoses all(std::span<const Snapshot> limits) {
    conflicts();
    for (const Finding& node : findings_.nodes) {
      node_alone(node);
    }
    serial_numbers();
    answers();
    allocation();
    for (const auto& [id, commander] : findings_.roster->commanders()) {
      commands(commander);
    }
    for (const Snapshot& servo : limits) {
      unitless(servo);
    }
    if (const auto by = findings_.roster->said_armed()) {
      add("armed", Level::notice, by, say<texts::says_vehicle_armed>(by->value()),
          say<texts::says_vehicle_armed_fix>());
    }
    return std::move(found_);
  }

 private:
  void add(std::string code, Level level, std::optional<NodeId> node, std::string text,
           std::string fix) {
    found_.push_back({std::move(code), level, node, std::move(text), std::move(fix)});
  }

  void conflicts() {
    for (const Conflict& conflict : findings_.conflicts) {
      const bool is_fatal = conflict.code != Code::duplicate_servo_id;
      add(std::string(name(conflict.code)), is_fatal ? Level::failure : Level::warning,
          conflict.nodes.size() == 1 ? std::optional(conflict.nodes.front()) : std::nullopt,
          conflict.text, conflict.hint);
    }
  }

  void node_alone(const Finding& node) {
    const std::uint8_t id = node.servo.id.value();
    if (findings_.roster->is_doubled(node.servo.id)) {
      return; // known facts may be the other unit's
    }
    if (node.is_offline) {
      if (!is_tool(node)) {
        add("offline", Level::warning, node.servo.id, say<texts::node_offline>(id),
            say<texts::node_offline_fix>(id));
      }
      return;
    }
    if (node.status && node.status->health != dronecan::Health::ok) {
      const bool is_warning = node.status->health == dronecan::Health::warning;
      add("health", is_warning ? Level::warning : Level::failure, node.servo.id,
          say<texts::node_bad_health>(id, health_word(node.status->health)),
          say<texts::node_bad_health_fix>(id));
    }
    mode(node);
    life(node.servo.id);
    if (node.servo.is_servo) {
      servo(node.servo);
    }
  }

  void mode(const Finding& node) {
    const auto mode = node.status ? node.status->mode : dronecan::Mode::operational;
    if (mode == dronecan::Mode::operational) {
      return;
    }
    const std::uint8_t id = node.servo.id.value();
    add("mode", Level::warning, node.servo.id, say<texts::node_in_mode>(id, mode_word(mode)),
        node.servo.is_servo ? say<texts::servo_in_mode_fix>(id, id)
                            : say<texts::node_in_mode_fix>(id));
  }

  void life(NodeId node) {
    const Member member = findings_.roster->member(node);
    const std::uint8_t id = node.value();
    const auto sender = traffic_.senders().find(node);
    const bool is_mute = sender == traffic_.senders().end() || sender->second.statuses == 0;
    if (is_mute && member.last_heard - member.first_heard >= enough_for_status) {
      add("no_node_status", Level::warning, node, say<texts::node_mute_status>(id),
          say<texts::node_mute_status_fix>());
    } else if (!is_mute && sender->second.longest_status_period > slow_status) {
      const auto period = std::chrono::duration_cast<std::chrono::milliseconds>(
          sender->second.longest_status_period);
      add("slow_node_status", Level::warning, node,
          say<texts::node_slow_status>(id, period.count()), say<texts::node_slow_status_fix>());
    }
    if (member.boots > 0) {
      add("restarted", Level::warning, node, say<texts::node_restarted>(id),
          say<texts::node_restarted_fix>(id));
    }
  }

  void servo(const Servo& servo) {
    const std::uint8_t id = servo.id.value();
    const auto& readings = servo.identity.readings();
    if (servo.identity.model().empty() && servo.unique_id) { // else nobody asked
      add("unknown_model", Level::warning, servo.id, say<texts::node_unknown_model>(id),
          say<texts::node_unknown_model_fix>());
    }
    if (servo.unique_id && dronecan::is_blank(*servo.unique_id)) {
      add("no_unique_id", Level::warning, servo.id,
          say<texts::blank_unique_id>(id, hex(*servo.unique_id)),
          say<texts::blank_unique_id_hint>());
    }
    if (bla::may_stall(servo.identity)) {
      add("firmware_defect", Level::notice, servo.id,
          say<texts::node_may_stall>(bla::firmware_text(*readings.firmware_version), id),
          say<texts::node_may_stall_fix>());
    }
    if (state::is_tool_id(servo.id)) {
      add("tool_node_id", Level::warning, servo.id, say<texts::servo_on_tool_id>(id),
          say<texts::servo_on_tool_id_fix>(id));
    }
    if (servo.static_node_id.value_or(0) != 0 && *servo.static_node_id != id) {
      add("static_node_id", Level::warning, servo.id,
          say<texts::node_static_differs>(id, *servo.static_node_id),
          say<texts::node_static_differs_fix>(id));
    }
  }

  /// Of present servos; one that has moved to another ID is counted once.
  void serial_numbers() {
    std::map<std::int64_t, std::map<std::optional<dronecan::UniqueId>, NodeId>> holders;
    for (const Finding& node : findings_.nodes) {
      const auto& number = node.servo.identity.readings().serial_number;
      if (node.servo.is_servo && !node.is_offline && number) {
        holders[*number].emplace(node.servo.unique_id, node.servo.id);
      }
    }
    for (const auto& [number, units] : holders) {
      if (units.size() > 1) {
        add("duplicate_serial_number", Level::warning, std::nullopt,
            say<texts::shared_serial_number>(joined_ids(std::views::values(units)), number),
            say<texts::shared_serial_number_fix>());
      }
    }
  }

  /// Of servos that are present and respond: restarts and silence have their own diagnoses; a node
  /// that is not a servo need not respond to a servo's requests.
  void answers() {
    Traffic::Questions all;
    std::vector<NodeId> nodes;
    for (const Finding& node : findings_.nodes) {
      const Traffic::Questions questions = traffic_.questions_to(node.servo.id);
      const bool ran_on = !node.is_offline && findings_.roster->member(node.servo.id).boots == 0 &&
                          !findings_.roster->is_doubled(node.servo.id);
      if (!node.servo.is_servo || !ran_on) {
        continue;
      }
      all.asked += questions.asked;
      all.unanswered += questions.unanswered;
      if (questions.unanswered > 0) {
        nodes.push_back(node.servo.id);
      }
    }
    if (all.unanswered > 0) {
      add("lost_answers", Level::warning, std::nullopt,
          say<texts::answers_lost>(all.unanswered, all.asked, joined_ids(nodes)),
          say<texts::answers_lost_fix>());
    }
  }

  void allocation() {
    const Roster& roster = *findings_.roster;
    if (const auto waiting = roster.pending(); !waiting.empty()) {
      add("no_node_id", Level::warning, std::nullopt, say<texts::units_ask_for_id>(waiting.size()),
          say<texts::units_ask_for_id_fix>(selectors_of(waiting)));
    }
    if (roster.allocators().size() > 1) {
      add("several_allocators", Level::failure, std::nullopt,
          say<texts::several_allocators>(joined_ids(roster.allocators())),
          say<texts::several_allocators_fix>());
    }
  }

  void commands(const Commander& commander) {
    const std::uint8_t by = commander.source.value();
    if (look_ == MotionLook::commanded) { // who asks about a servo wants it to be commanded
      add("commander", Level::notice, commander.source, say<texts::somebody_commands>(by),
          say<texts::somebody_commands_fix>());
    }
    for (const auto& [servo_id, command] : commander.servo_ids) {
      if (servo_id != every_servo && !has_servo_id(*findings_.roster, servo_id)) {
        add("no_such_servo", Level::warning, commander.source,
            say<texts::commanded_nobody>(by, servo_id), say<texts::commanded_nobody_fix>(servo_id));
      }
      if (command.type == type_pwm) {
        add("pwm_command", Level::failure, commander.source,
            say<texts::commanded_pwm>(by, servo_id, type_pwm), say<texts::commanded_pwm_fix>());
      }
    }
  }

  [[nodiscard]] bool is_commanded_unitless(const Servo& servo) const {
    return std::ranges::any_of(findings_.roster->commanders(), [&](const auto& entry) {
      return std::ranges::any_of(entry.second.servo_ids, [&](const auto& command) {
        return command.second.type == type_unitless &&
               (command.first == every_servo || servo.servo_id == command.first);
      });
    });
  }

  void unitless(const Snapshot& servo) {
    const auto* cw = servo.servo.identity.parameter(bla::address::angle_limit_cw);
    const auto* ccw = servo.servo.identity.parameter(bla::address::angle_limit_ccw);
    const auto right = servo.raw(bla::address::angle_limit_cw);
    const auto left = servo.raw(bla::address::angle_limit_ccw);
    const bool is_narrower = right && left && (*right < unitless_cw || *left > unitless_ccw);
    if (is_narrower && cw != nullptr && ccw != nullptr && is_commanded_unitless(servo.servo)) {
      add("unitless_range", Level::notice, servo.servo.id,
          say<texts::unitless_limited>(servo.servo.id.value(), bla::display(*cw, *right),
                                       bla::display(*ccw, *left)),
          say<texts::unitless_limited_fix>(servo.servo.id.value()));
    }
  }

  const Findings& findings_;
  const Traffic& traffic_;
  MotionLook look_;
  Diagnoses found_;
};

} // namespace

Diagnoses diagnose_identifications(const Findings& findings,
                                   const std::vector<std::optional<Error>>& ends) {
  Diagnoses found;
  std::set<NodeId> told;
  for (const auto& error : ends) {
    const auto node =
        error && error->node_id ? std::optional(NodeId(*error->node_id)) : std::nullopt;
    const auto is_here = [&](const Finding& each) {
      return each.servo.id == node && !each.is_offline;
    };
    if (!node || std::ranges::none_of(findings.nodes, is_here) || // has its own, or not selected
        error->code == Code::not_recorded || findings.roster->is_doubled(*node) ||
        findings.roster->member(*node).is_known()) {
      continue;
    }
    if (told.insert(*node).second) {
      found.push_back(
          {std::string(name(error->code)), Level::failure, node, error->message, error->hint});
    }
  }
  return found;
}

bool awaits_status(const Roster& roster, const Traffic& traffic) {
  return std::ranges::any_of(traffic.senders(), [&](const auto& sender) {
    const Member member = roster.member(sender.first);
    return sender.second.statuses == 1 &&
           member.last_heard - member.first_heard >= enough_for_status;
  });
}

Diagnoses diagnose_nodes(const Findings& findings, const Traffic& traffic,
                         std::span<const Snapshot> limits, MotionLook look) {
  return NodeExamination(findings, traffic, look).all(limits);
}

} // namespace blactl::fleet
