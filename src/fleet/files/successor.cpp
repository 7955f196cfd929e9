#include "blactl/fleet/files/successor.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/files/fleet_match.hpp"

#include "fleet/files/texts.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

/// The entry that a servo has; null: none.
const FleetEntry* entry_of(const FleetMatch& matched, NodeId id) {
  const auto pair = std::ranges::find(matched.pairs, id, &FleetMatch::Pair::id);
  return pair != matched.pairs.end() ? pair->entry : nullptr;
}

/// Of another model than the entry is for, as far as it tells.
std::optional<Error> refuse_model(const FleetFile& file, const FleetEntry& entry,
                                  const Servo& servo, const bla::Profiles& profiles) {
  const std::string model =
      !entry.match.model.empty() ? entry.match.model : entry.about.model.value_or(std::string());
  const auto models = profiles.matching(model);
  if (models.empty() || std::ranges::find(models, servo.identity.profile()) != models.end()) {
    return std::nullopt;
  }
  const std::uint8_t id = servo.id.value();
  return Error{
      Code::model_mismatch,
      say<texts::successor_model>(id, servo.identity.model(), entry.name, printable(model)),
      say<texts::successor_model_hint>(shell_word(file.file), shell_word(entry.name), id), id};
}

Error none(const FleetFile& file, const FleetEntry& entry, const Roster& roster) {
  const std::size_t waiting = roster.pending().size();
  return unless_shared(
      roster,
      {Code::not_found, say<texts::successor_none>(entry.name, printable(file.file)),
       waiting > 0 ? say<texts::successor_waits_hint>(waiting) : say<texts::successor_none_hint>(),
       std::nullopt});
}

/// Those that may take the place: of -n, else all that no entry means.
Result<std::vector<NodeId>> candidates(const FleetMatch& matched, const FleetEntry& entry,
                                       const Roster& roster, const Targets& targets,
                                       std::span<const NodeId> selected) {
  if (targets.mean_all()) {
    const auto unclear = unidentified(roster);
    return unclear.empty() ? Result<std::vector<NodeId>>(matched.extra)
                           : std::unexpected(not_identified(roster, unclear.front(), entry.name,
                                                            /*is_recording=*/false));
  }
  std::vector<NodeId> others;
  for (const NodeId id : selected) {
    const FleetEntry* own = entry_of(matched, id);
    if (own != nullptr && own != &entry) {
      return std::unexpected(Error{Code::usage,
                                   say<texts::successor_has_entry>(id.value(), own->name),
                                   say<texts::successor_has_entry_hint>(), id.value()});
    }
    if (own == nullptr) {
      others.push_back(id);
    }
  }
  return others;
}

} // namespace

Result<Successor> find_successor(const FleetFile& file, const FleetEntry& entry,
                                 const Roster& roster, const Targets& targets,
                                 std::span<const NodeId> selected, const bla::Profiles& profiles) {
  if (!entry.match.means_one()) {
    return fail(Code::usage, say<texts::successor_of_all>(entry.name),
                say<texts::successor_of_all_hint>(shell_word(file.file)));
  }
  const auto matched = match(file, roster, Targets(), profiles);
  if (!matched.errors.empty()) {
    return std::unexpected(matched.errors.front());
  }
  const auto found = candidates(matched, entry, roster, targets, selected);
  if (!found) {
    return std::unexpected(found.error());
  }
  const auto present = std::ranges::find(matched.pairs, &entry, &FleetMatch::Pair::entry);
  if (present != matched.pairs.end()) {
    return found->empty() ? Result<Successor>({present->id, true})
                          : std::unexpected(still_there(file, entry, present->id));
  }
  if (found->empty()) {
    return std::unexpected(none(file, entry, roster));
  }
  if (found->size() > 1) {
    return fail(Code::several_servos,
                say<texts::successor_several>(found->size(), printable(file.file), id_list(*found)),
                say<texts::successor_several_hint>(found->front().value()));
  }
  const Servo servo = roster.member(found->front()).servo();
  auto refused = refuse_model(file, entry, servo, profiles);
  return refused ? Result<Successor>(std::unexpected(std::move(*refused)))
                 : Successor{.id = servo.id};
}

Error still_there(const FleetFile& file, const FleetEntry& entry, NodeId id) {
  const bool has_id = id.is_unicast();
  return {Code::several_servos,
          has_id ? say<texts::successor_old_there>(entry.name, id.value())
                 : say<texts::successor_old_waits>(entry.name),
          say<texts::successor_old_there_hint>(shell_word(file.file)),
          has_id ? std::optional(id.value()) : std::nullopt};
}

std::optional<Error> back_on_its_id(const FleetEntry& entry, const dronecan::UniqueId& successor,
                                    std::optional<std::int64_t> serial, const Roster& roster) {
  const auto& named = entry.match.serial_number; // of the successor, once the file names it
  for (const NodeId id : roster.doubled()) {
    auto units = roster.units(id);
    if (units.erase(successor) == 0 || units.empty()) {
      continue;
    }
    const auto old = entry.match.unique_id && units.contains(*entry.match.unique_id)
                         ? *entry.match.unique_id
                         : *units.begin();
    return Error{Code::duplicate_node_id,
                 say<texts::successor_old_on_its_id>(
                     id.value(), hex(successor), entry.name, hex(old),
                     named && serial && named != serial ? say<texts::successor_old_serial>(*named)
                                                        : std::string()),
                 say<texts::successor_old_on_its_id_hint>(), id.value()};
  }
  return std::nullopt;
}

std::optional<Error> come_back(const FleetFile& file, const FleetEntry& entry,
                               const dronecan::UniqueId& unit, const Roster& roster,
                               const bla::Profiles& profiles) {
  const Match& match = entry.match;
  const auto pending = roster.pending();
  const bool asks = match.unique_id ? match.unique_id != unit && roster.is_pending(*match.unique_id)
                                    : std::ranges::any_of(pending, [&](const auto& prefix) {
                                        return !dronecan::begins_with(unit, prefix); // it restarted
                                      });
  if (asks) {
    return still_there(file, entry, {});
  }
  for (const auto& [id, member] : roster.members()) {
    if (roster.heard(id) && member.unique_id() != unit && match.means(member.servo(), profiles)) {
      return still_there(file, entry, id);
    }
  }
  return std::nullopt;
}

bool names_unit(const FleetEntry& entry, const Servo& unit) {
  const auto serial = unit.identity.readings().serial_number;
  return entry.match.unique_id ? entry.match.unique_id == unit.unique_id
                               : entry.match.serial_number && entry.match.serial_number == serial;
}

Result<std::vector<bla::Assignment>> settings_of_successor(const FleetEntry& entry,
                                                           const bla::Profiles& profiles) {
  const Match& by = entry.match;
  std::vector<bla::Assignment> all = entry.set;
  const auto add = [&](bla::Address address, std::optional<std::int64_t> id) -> Result<void> {
    if (!id || entry.wish(address)) {
      return {};
    }
    auto made = bla::make_assignment(profiles, address.name(), std::to_string(*id) + "raw");
    if (!made) {
      return std::unexpected(std::move(made.error()));
    }
    all.push_back(std::move(*made));
    return {};
  };
  auto added = add(bla::address::servo_id, by.servo_id);
  if (added) {
    added = add(bla::address::static_node_id,
                by.node_id.transform([](NodeId id) { return std::int64_t{id.value()}; }));
  }
  std::ranges::sort(all, {}, [](const bla::Assignment& each) { return each.parameter->address; });
  return added ? Result<std::vector<bla::Assignment>>(std::move(all))
               : std::unexpected(std::move(added.error()));
}

} // namespace blactl::fleet
