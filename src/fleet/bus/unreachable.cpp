#include "blactl/fleet/bus/unreachable.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace blactl::fleet {
namespace {

/// Whether a unit whose unique ID begins like this asks for a node ID.
bool is_pending(const Roster& roster, const Selector& selector) {
  return selector.key == Selector::Key::unique_id &&
         std::ranges::any_of(roster.pending(), [&](const UniqueIdPrefix& prefix) {
           const std::string heard = hex(prefix);
           return heard.starts_with(selector.value) || selector.value.starts_with(heard);
         });
}

} // namespace

bool all_wait_for_id(const Roster& roster) {
  return !roster.pending().empty() &&
         std::ranges::none_of(roster.members(), [&](const auto& entry) {
           const Member& member = entry.second;
           return roster.heard(entry.first) && !member.is_foreign() &&
                  (member.is_servo || member.sends_actuator_status());
         });
}

std::string not_found_hint(const Roster& roster) {
  return all_wait_for_id(roster) ? say<texts::all_wait_for_id_hint>()
                                 : say<texts::node_not_found_hint>();
}

Error not_a_servo(dronecan::NodeId id, std::string_view name) {
  return {Code::not_found, say<texts::not_a_servo>(id.value(), printable(name)),
          say<texts::node_not_found_hint>(), id.value()};
}

Error nothing_matches(const Roster& roster, const Selector& selector) {
  if (is_pending(roster, selector)) {
    return {Code::not_found, say<texts::target_waits_for_id>(printable(selector.text)),
            say<texts::target_waits_for_id_hint>(), std::nullopt};
  }
  return {Code::not_found, say<texts::nothing_matches>(printable(selector.text)),
          not_found_hint(roster), std::nullopt};
}

std::vector<dronecan::NodeId> unidentified(const Roster& roster) {
  std::vector<dronecan::NodeId> nodes;
  for (const auto& [id, member] : roster.members()) {
    if (roster.heard(id) && member.sends_actuator_status() && !member.is_known() &&
        !member.is_foreign() && !roster.has_moved(member)) {
      nodes.push_back(id);
    }
  }
  return nodes;
}

Error identity_unrecorded(dronecan::NodeId id) {
  return {Code::not_recorded, say<texts::identity_not_recorded>(id.value()),
          say<texts::not_recorded_hint>(), id.value()};
}

bool is_met(const Roster& roster, const Selector& selector, const bla::Profiles& profiles) {
  return std::ranges::any_of(roster.members(), [&](const auto& entry) {
    return selector.matches(entry.second, profiles) && !roster.is_doubled(entry.first) &&
           !roster.has_moved(entry.second);
  });
}

std::vector<dronecan::NodeId> may_be_meant(const Roster& roster, const Selector& selector,
                                           const bla::Profiles& profiles) {
  if (selector.is_unique() && is_met(roster, selector, profiles)) {
    return {};
  }
  auto nodes = unidentified(roster);
  std::erase_if(nodes, [&](dronecan::NodeId id) {
    return !selector.may_match(roster.member(id), profiles, roster.last_heard());
  });
  return nodes;
}

Error not_identified(const Roster& roster, dronecan::NodeId id, std::string_view what,
                     bool is_recording) {
  if (roster.is_doubled(id)) {
    return doubled(roster, id);
  }
  return is_recording ? identity_unrecorded(id)
                      : Error{Code::timeout, say<texts::may_be_meant>(id.value(), printable(what)),
                              say<texts::no_answer_hint>(), id.value()};
}

std::vector<Error> unmet(const Roster& roster, std::span<const Selector> selectors,
                         const bla::Profiles& profiles, bool is_recording) {
  std::vector<Error> errors;
  for (const Selector& selector : selectors) {
    const auto nodes = may_be_meant(roster, selector, profiles);
    for (const dronecan::NodeId id : nodes) {
      errors.push_back(not_identified(roster, id, selector.text, is_recording));
    }
    if (nodes.empty() && !is_met(roster, selector, profiles)) {
      errors.push_back(unless_shared(roster, nothing_matches(roster, selector)));
    }
  }
  return errors;
}

/// A node that sends no actuator.Status may be a servo all the same.
Error no_servo(const Roster& roster) {
  std::string ids, first;
  for (const auto& [id, member] : roster.members()) {
    if (roster.heard(id)) {
      ids += (ids.empty() ? "" : ", ") + std::to_string(id.value());
      first = first.empty() ? ids : first;
    }
  }
  if (ids.empty() || all_wait_for_id(roster)) {
    return {Code::not_found, say<texts::no_servo_found>(),
            all_wait_for_id(roster) ? not_found_hint(roster) : say<texts::no_servo_found_hint>(),
            std::nullopt};
  }
  return {Code::not_found, say<texts::no_node_is_servo>(ids),
          say<texts::no_node_is_servo_hint>(first), std::nullopt};
}

Error unrecorded(dronecan::NodeId id) {
  return {Code::not_recorded, say<texts::node_not_recorded>(id.value()),
          say<texts::not_recorded_hint>(), id.value()};
}

Error doubled(const Roster& roster, dronecan::NodeId id) {
  const auto units = roster.units(id);
  std::string named;
  for (const dronecan::UniqueId& unit : units) {
    named += (named.empty() ? "uid:" : ", uid:") + hex(unit);
  }
  return {Code::duplicate_node_id,
          units.empty() ? say<texts::doubled_target>(id.value())
                        : say<texts::doubled_units>(id.value(), named),
          say<texts::doubled_target_hint>(), id.value()};
}

Error unless_shared(const Roster& roster, Error error) {
  const auto shared = roster.doubled();
  return shared.empty() ? std::move(error) : doubled(roster, *shared.begin());
}

std::optional<Error> not_unique(const Roster& roster, dronecan::NodeId id) {
  const Member* member = roster.find(id);
  const auto unique_id = member != nullptr ? member->unique_id() : std::nullopt;
  if (!unique_id) {
    return std::nullopt;
  }
  auto nodes = roster.copies(id);
  if (!nodes.empty()) {
    nodes.insert(std::ranges::upper_bound(nodes, id), id);
    return Error{Code::duplicate_unique_id,
                 say<texts::doubled_unique_id>(id_list(nodes), hex(*unique_id)),
                 say<texts::doubled_unique_id_hint>(), id.value()};
  }
  if (dronecan::is_blank(*unique_id)) {
    return Error{Code::duplicate_unique_id,
                 say<texts::blank_unique_id>(id.value(), hex(*unique_id)),
                 say<texts::blank_unique_id_hint>(), id.value()};
  }
  return std::nullopt;
}

Error silent(const Roster& roster, dronecan::NodeId node) {
  const std::uint8_t id = node.value();
  const Member member = roster.member(node);
  if (roster.is_doubled(node)) { // two that answer at once cannot be read
    return doubled(roster, node);
  }
  if (!roster.heard(node) || !member.id_is_known) {
    return {Code::not_found, say<texts::node_not_found>(id), not_found_hint(roster), id};
  }
  return {Code::timeout, member.info ? say<texts::node_gone>(id) : say<texts::node_mute>(id),
          say<texts::no_answer_hint>(), id};
}

Error other_serial(const Servo& servo, std::int64_t serial) {
  const std::uint8_t id = servo.id.value();
  return {Code::duplicate_unique_id,
          say<texts::other_serial>(id, servo.identity.readings().serial_number.value_or(0), serial),
          say<texts::doubled_unique_id_hint>(), id};
}

} // namespace blactl::fleet
