#include "blactl/fleet/files/fleet_match.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "fleet/files/texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <string_view>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

/// A dynamic servo may have another one's node ID after the next start.
bool is_found_by_passing_id(const Match& match, const Servo& servo) {
  const bool has_more = match.unique_id || match.serial_number || match.servo_id;
  return match.node_id && !has_more && servo.static_node_id.value_or(0) != servo.id.value();
}

/// An entry for one unit also matches it when it already has the values that the entry sets.
bool means(const FleetEntry& entry, const Servo& servo, const bla::Profiles& profiles) {
  Match match = entry.match;
  if (match.unique_id || match.serial_number) {
    const auto servo_id = entry.wish(bla::address::servo_id);
    const auto node_id = entry.wish(bla::address::static_node_id);
    match.servo_id = servo_id && servo_id == servo.servo_id ? servo_id : match.servo_id;
    match.node_id = node_id && node_id == servo.id.value() ? std::nullopt : match.node_id;
  }
  return match.means(servo, profiles);
}

/// The value of -n for this servo.
std::string selector_of(const Member& member) {
  if (member.id_is_known) {
    return std::to_string(member.id.value());
  }
  if (const auto unique_id = member.unique_id()) {
    return "uid:" + hex(*unique_id);
  }
  const auto serial = member.identity.readings().serial_number;
  return serial ? fmt::format("serial:{}", *serial)
                : fmt::format("servo:{}", member.servo_id.value_or(0));
}

class Matching {
 public:
  Matching(const Roster& roster, const Targets& targets, const bla::Profiles& profiles,
           bool is_recording)
      : roster_(roster), targets_(targets), profiles_(profiles), is_recording_(is_recording) {}

  FleetMatch run(const FleetFile& file) {
    if (file.names_nobody()) {
      give_to_selected(file);
      check_named();
      check_unidentified(file);
      check_doubled(file);
      return std::move(match_);
    }
    for (const FleetEntry& entry : file.servos) {
      add(entry);
    }
    for (const auto& [id, member] : roster_.members()) {
      if (may_be_servo(id, member) && !taken_.contains(id) && is_wanted(member)) {
        match_.extra.push_back(id);
      }
    }
    check_named();
    check_unidentified(file);
    check_doubled(file);
    std::ranges::sort(match_.pairs, {}, &FleetMatch::Pair::id);
    return std::move(match_);
  }

 private:
  /// The settings in a parameter file or a recipe are for the servos selected by -n, or the only
  /// one.
  void give_to_selected(const FleetFile& file) {
    std::vector<NodeId> there;
    for (const auto& [id, member] : roster_.members()) {
      // an unidentified one may be the one wanted
      if ((narrows() ? is_one_servo(id, member) : may_be_servo(id, member)) && is_wanted(member)) {
        there.push_back(id);
      }
    }
    if (there.size() > 1 && !targets_.given) {
      refuse(say<texts::params_several>(printable(file.file), id_list(there)),
             say<texts::params_several_hint>(selector_of(*roster_.find(there.front()))));
    } else if (!there.empty()) {
      give(file, there);
    } else if (narrows()) { // reported by check_named()
      match_.left_out.push_back(&file.servos.front());
    } else {
      match_.errors.push_back(
          unless_shared(roster_, {Code::not_found, say<texts::no_servo_found>(),
                                  say<texts::no_servo_found_hint>(), std::nullopt}));
    }
  }

  void give(const FleetFile& file, const std::vector<NodeId>& servos) {
    const FleetEntry& entry =
        servos.size() > 1 && file.entry_without_ids ? *file.entry_without_ids : file.servos.front();
    if (servos.size() > 1 && !are_for_several(file, servos.size())) {
      return;
    }
    for (const NodeId id : servos) {
      auto wrong = file.recipe ? check_fit(roster_.member(id).servo(), *file.recipe, profiles_)
                               : std::nullopt;
      if (wrong) {
        wrong->message = say<texts::about_node>(id.value(), wrong->message);
        match_.misfits.push_back({&entry, id, std::move(*wrong)});
      } else {
        match_.pairs.push_back({&entry, id});
      }
    }
  }

  /// No two servos get the same ID: a tool has saved those of a parameter file with the others, in
  /// a recipe somebody wants them.
  bool are_for_several(const FleetFile& file, std::size_t servos) {
    for (const bla::Assignment& each : file.servos.front().set) {
      if (!bla::is_id(each.parameter->address)) {
        continue;
      }
      if (file.is_params) {
        match_.ids_left_out.push_back(each.parameter->name);
      } else if (each.value.raw != 0) {
        refuse(say<texts::recipe_id_of_many>(printable(file.file), each.parameter->name, servos),
               say<texts::recipe_id_of_many_hint>());
      }
    }
    if (file.entry_without_ids && file.entry_without_ids->set.empty()) {
      match_.ids_left_out.clear();
      refuse(say<texts::params_only_ids>(printable(file.file)), say<texts::params_only_ids_hint>());
    }
    return match_.errors.empty();
  }

  void add(const FleetEntry& entry) {
    std::vector<NodeId> meant;
    for (const auto& [id, member] : roster_.members()) {
      if (is_one_servo(id, member) && means(entry, member.servo(), profiles_)) {
        meant.push_back(id);
      }
    }
    if (const auto shared = shared_by(entry.match); meant.empty() && shared) {
      match_.errors.push_back(doubled(roster_, *shared));
      return;
    }
    if (meant.empty()) {
      (narrows() ? match_.left_out : match_.missing).push_back(&entry);
      return;
    }
    if (meant.size() > 1 && entry.match.means_one()) {
      auto copies = entry.match.unique_id ? not_unique(roster_, meant.front()) : std::nullopt;
      if (copies) {
        match_.errors.push_back(std::move(*copies));
      } else {
        refuse(say<texts::fleet_entry_means_several>(entry.name, id_list(meant)),
               say<texts::fleet_entry_means_several_hint>());
      }
      return;
    }
    for (const NodeId id : meant) {
      pair(entry, id);
    }
  }

  /// The node ID that the wanted unit shares with another one, or may share: of two under one ID
  /// only the unique IDs are known.
  [[nodiscard]] std::optional<NodeId> shared_by(const Match& match) const {
    for (const NodeId id : roster_.doubled()) {
      const bool is_meant = match.unique_id ? roster_.units(id).contains(*match.unique_id)
                            : match.node_id ? match.node_id == id
                                            : match.means_one();
      if (is_meant) {
        return id;
      }
    }
    return std::nullopt;
  }

  /// Nodes selected by -n must be present, and be one servo each.
  void check_named() {
    for (const NodeId id : targets_.ids) {
      const Member* member = roster_.find(id);
      if (roster_.is_doubled(id)) {
        match_.errors.push_back(doubled(roster_, id));
      } else if (member == nullptr || !is_one_servo(id, *member) || !member->id_is_known) {
        match_.errors.push_back(silent(roster_, id));
      }
    }
    std::ranges::move(unmet(roster_, targets_.selectors, profiles_, is_recording_),
                      std::back_inserter(match_.errors));
    if (auto ambiguous = targets_.ambiguity(roster_, profiles_)) {
      match_.errors.push_back(std::move(*ambiguous));
    }
  }

  /// An entry for several servos, or `-n all`, may mean one that has not said who it is.
  void check_unidentified(const FleetFile& file) {
    const auto several = std::ranges::find_if(
        file.servos, [](const FleetEntry& entry) { return !entry.match.means_one(); });
    const bool is_of_the_one = file.names_nobody() && !targets_.given;
    if (narrows() || is_recording_ || several == file.servos.end() || is_of_the_one) {
      return;
    }
    const std::string_view what = file.names_nobody() ? "-n all" : std::string_view(several->name);
    for (const NodeId id : unidentified(roster_)) {
      match_.errors.push_back(not_identified(roster_, id, what, is_recording_));
    }
  }

  /// Two servos on one node ID are left out by nobody's wish: what is for several may be for them.
  void check_doubled(const FleetFile& file) {
    const bool is_for_several =
        file.names_nobody() || std::ranges::any_of(file.servos, [](const FleetEntry& entry) {
          return !entry.match.means_one();
        });
    for (const NodeId id : roster_.doubled()) {
      const Member member = roster_.member(id);
      const bool may_be_servos =
          !member.is_foreign() && (member.is_servo || member.sends_actuator_status());
      const bool is_told = std::ranges::any_of(match_.errors, [&](const Error& error) {
        return error.code == Code::duplicate_node_id && error.node_id == id.value();
      });
      if (may_be_servos && !is_told && (narrows() ? is_selected(member) : is_for_several)) {
        match_.errors.push_back(doubled(roster_, id));
      }
    }
  }

  /// Whether a selector that means several may mean it.
  [[nodiscard]] bool is_selected(const Member& member) const {
    return std::ranges::any_of(targets_.selectors, [&](const Selector& selector) {
      return !selector.is_unique() && selector.may_match(member, profiles_, roster_.last_heard());
    });
  }

  void pair(const FleetEntry& entry, NodeId id) {
    const Member& member = *roster_.find(id);
    if (const auto [it, is_new] = taken_.try_emplace(id, &entry); !is_new) {
      refuse(say<texts::fleet_servo_meant_twice>(id.value(), it->second->name, entry.name),
             say<texts::fleet_entry_means_several_hint>(), id);
    } else if (is_found_by_passing_id(entry.match, member.servo())) {
      refuse(say<texts::fleet_passing_id>(entry.name, id.value()),
             say<texts::fleet_passing_id_hint>(), id);
    } else if (is_wanted(member)) {
      match_.pairs.push_back({&entry, id});
    } else {
      match_.left_out.push_back(&entry);
    }
  }

  [[nodiscard]] bool is_one_servo(NodeId id, const Member& member) const {
    return member.is_known() && member.is_servo && !roster_.is_doubled(id);
  }

  /// Likewise, or it is unidentified, but sends messages of servos.
  [[nodiscard]] bool may_be_servo(NodeId id, const Member& member) const {
    return is_one_servo(id, member) || (!member.is_known() && member.sends_actuator_status() &&
                                        !roster_.is_doubled(id) && !roster_.has_moved(member));
  }

  /// Whether there may be servos outside of -n.
  [[nodiscard]] bool narrows() const { return !targets_.mean_all(); }

  [[nodiscard]] bool is_wanted(const Member& member) const {
    return !targets_.given || targets_.mean(member, profiles_);
  }

  void refuse(std::string message, std::string hint, std::optional<NodeId> id = std::nullopt) {
    match_.errors.push_back({Code::usage, std::move(message), std::move(hint),
                             id ? std::optional(id->value()) : std::nullopt});
  }

  const Roster& roster_;
  const Targets& targets_;
  const bla::Profiles& profiles_;
  bool is_recording_;
  std::map<NodeId, const FleetEntry*> taken_;
  FleetMatch match_;
};

} // namespace

std::string text(const Match& match) {
  std::string out;
  const auto add = [&](std::string_view key, const std::string& value) {
    out += (out.empty() ? "" : ", ") + std::string(key) + ' ' + value;
  };
  if (match.unique_id) {
    add("unique_id", hex(*match.unique_id));
  }
  if (match.serial_number) {
    add("serial_number", std::to_string(*match.serial_number));
  }
  if (match.servo_id) {
    add("servo_id", std::to_string(*match.servo_id));
  }
  if (match.node_id) {
    add("node_id", std::to_string(match.node_id->value()));
  }
  if (!match.model.empty()) {
    add("model", match.model);
  }
  return out;
}

std::optional<Error> may_be_unidentified(const FleetEntry& entry, const Roster& roster) {
  const auto nodes = unidentified(roster);
  if (nodes.empty()) {
    return std::nullopt;
  }
  const std::uint8_t id = nodes.front().value();
  return Error{Code::timeout, say<texts::entry_may_be>(entry.name, text(entry.match), id),
               say<texts::run_again_hint>(), id};
}

FleetMatch match(const FleetFile& file, const Roster& roster, const Targets& targets,
                 const bla::Profiles& profiles, bool is_recording) {
  return Matching(roster, targets, profiles, is_recording).run(file);
}

} // namespace blactl::fleet
