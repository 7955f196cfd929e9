#include "blactl/fleet/change/allocation_service.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "fleet/change/id_texts.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace blactl::fleet {

using dronecan::Bytes;
using dronecan::NodeId;
using dronecan::UniqueId;

namespace {

/// More units than node IDs, so that those without one are stored, too.
constexpr std::size_t most_units = 256;

/// A unit that asks again after this number of responses does not accept its ID: so many
/// consecutive losses are unlikely.
constexpr unsigned most_vain_answers = 5;

} // namespace

AllocationService::AllocationService(Session& session, state::AllocationStore& store, Range range,
                                     Hook hook)
    : session_(session), store_(store), range_(range), hook_(std::move(hook)),
      allocator_(session.node(), *this), last_request_(session.now()) {
  session_.attach(*this);
}

AllocationService::~AllocationService() {
  session_.detach(*this);
}

std::optional<Error> AllocationService::end() const {
  if (failure_) {
    return failure_;
  }
  const auto& others = session_.roster().allocators();
  if (others.empty()) {
    return std::nullopt;
  }
  const NodeId other = *others.begin();
  const Member member = session_.roster().member(other);
  const std::string name = member.info ? " (" + printable(member.info->name) + ")" : std::string();
  return Error{Code::other_allocator, say<texts::other_allocator>(other.value(), name),
               say<texts::other_allocator_hint>(), other.value()};
}

void AllocationService::receive(const dronecan::Transfer& transfer) {
  const dronecan::Header& header = transfer.header;
  const bool is_request = header.kind == dronecan::Kind::message && !header.source.is_unicast() &&
                          header.data_type_id == dronecan::Allocation::type.id;
  if (is_request) {
    const auto request = dronecan::Allocation::decode(transfer.payload);
    if (request && request->first_part_of_unique_id) {
      hear_first_part(Bytes(request->unique_id).first(request->size), transfer.at);
    }
  }
  allocator_.receive(transfer);
}

void AllocationService::hear_first_part(Bytes prefix, Time at) {
  const auto& requests = session_.roster().requests();
  const auto known = requests.find(UniqueIdPrefix(prefix.begin(), prefix.end()));
  if (!is_meant(prefix) || is_left_out(prefix)) {
    return;
  }
  if (known != requests.end() && known->second.is_repeated()) {
    last_request_ = at;
  } else {
    asked_once_ = at;
  }
}

bool AllocationService::may_begin_to_ask() const {
  return asked_once_ && session_.now() - *asked_once_ < request_period;
}

std::size_t AllocationService::asking() const {
  const auto is_there = [this](const UniqueIdPrefix& prefix, Time asked) {
    return std::ranges::any_of(units_, [&](const auto& entry) {
      return dronecan::begins_with(entry.first, prefix) && entry.second.asked_at >= asked &&
             this->is_there(entry.second);
    });
  };
  const auto& requests = session_.roster().requests();
  return static_cast<std::size_t>(std::ranges::count_if(requests, [&](const auto& entry) {
    const auto& [prefix, asking] = entry;
    return session_.now() - asking.last < request_period && !is_there(prefix, asking.last);
  }));
}

/// A refused unit asks for ever, and so does one that does not accept its ID.
bool AllocationService::is_left_out(Bytes prefix) const {
  return std::ranges::any_of(units_, [&](const auto& entry) {
    const AllocatedUnit& unit = entry.second;
    return (unit.refused || (unit.is_deaf && !is_there(unit))) &&
           dronecan::begins_with(entry.first, prefix);
  });
}

void AllocationService::advance(Time now) {
  allocator_.advance(now);
  watch_for_twins();
}

/// A unit with the same ID may join at any time.
void AllocationService::watch_for_twins() {
  for (const NodeId id : session_.roster().doubled()) {
    for (auto& [unique_id, unit] : units_) {
      if (unit.node_id == id && !unit.refused) {
        unit.is_shared = true;
        refuse(unit, Event::conflict, shared(unit));
      }
    }
  }
}

bool AllocationService::is_meant(Bytes prefix) const {
  return !only_ || std::ranges::any_of(*only_, [&](const UniqueId& unit) {
    return dronecan::begins_with(unit, prefix);
  });
}

bool AllocationService::serves(Bytes prefix) const {
  if (end() || !is_meant(prefix)) {
    return false;
  }
  if (bus_is_known_) {
    return true;
  }
  const auto entries = store_.entries();
  return entries && std::ranges::any_of(*entries, [&](const state::AllocationEntry& entry) {
           return dronecan::begins_with(entry.unique_id, prefix);
         });
}

/// Null: there are too many already.
AllocatedUnit* AllocationService::known(const UniqueId& unique_id) {
  const auto unit = units_.find(unique_id);
  if (unit != units_.end()) {
    return &unit->second;
  }
  return units_.size() < most_units
             ? &units_.emplace(unique_id, AllocatedUnit{.unique_id = unique_id}).first->second
             : nullptr;
}

std::optional<NodeId> AllocationService::assign(const UniqueId& unique_id, NodeId preferred) {
  AllocatedUnit* unit = is_meant(unique_id) ? known(unique_id) : nullptr;
  if (unit == nullptr || end()) {
    return std::nullopt;
  }
  note_request(*unit);
  if (const auto copy = copy_of(*unit)) {
    unit->node_id = *copy;
    refuse(*unit, Event::conflict,
           {Code::duplicate_unique_id, say<texts::same_unique_id>(copy->value(), hex(unique_id)),
            say<texts::same_unique_id_hint>(), copy->value()});
    return std::nullopt;
  }
  const auto entry = store_.find(unique_id);
  if (!entry) {
    failure_ = entry.error();
    return std::nullopt;
  }
  return *entry ? keep(*unit, (*entry)->node_id) : give(*unit, {.preferred = preferred});
}

void AllocationService::note_request(AllocatedUnit& unit) {
  unit.given = is_there(unit) ? 0 : unit.given;
  const bool was_deaf = std::exchange(unit.is_deaf, unit.given >= most_vain_answers);
  unit.asked_at = session_.now();
  last_request_ = unit.refused || unit.is_deaf ? last_request_ : session_.now();
  if (unit.is_deaf && !was_deaf) {
    hook_(Event::deaf, unit);
  } else if (!unit.refused && !unit.is_deaf) {
    hook_(Event::request, unit);
  }
}

Error AllocationService::shared(const AllocatedUnit& unit) const {
  Error error = doubled(session_.roster(), unit.node_id);
  if (session_.roster().units(unit.node_id).empty()) {
    error.message = say<texts::allocated_id_doubled>(unit.node_id.value(), hex(unit.unique_id));
  }
  return error;
}

std::optional<Error> AllocationService::refusal(const AllocatedUnit& unit) const {
  if (unit.is_shared) {
    return shared(unit);
  }
  const Roster& roster = session_.roster();
  const bool has_copy = is_there(unit) && !roster.copies(unit.node_id).empty();
  return has_copy ? not_unique(roster, unit.node_id) : unit.refused;
}

Error AllocationService::absence(const AllocatedUnit& unit) const {
  const std::uint8_t id = unit.node_id.value();
  if (unit.given == 0) { // other nodes are not known yet
    return in_use(unit);
  }
  return unit.given == 1
             ? Error{Code::not_back, say<texts::allocated_not_up>(id, hex(unit.unique_id)),
                     say<texts::allocated_not_up_hint>(), id}
             : Error{Code::not_back, say<texts::allocated_not_taken>(id, hex(unit.unique_id)),
                     say<texts::allocated_not_taken_hint>(), id};
}

Error AllocationService::in_use(const AllocatedUnit& unit) const {
  const NodeId id = unit.node_id;
  const Member member = session_.roster().member(id);
  std::string who = say<texts::another_unit>();
  if (id == session_.node().id()) {
    who = "blactl";
  } else if (member.info && member.info->unique_id != unit.unique_id) {
    who = "uid:" + hex(member.info->unique_id);
  }
  return {Code::duplicate_node_id,
          say<texts::allocated_id_in_use>(id.value(), hex(unit.unique_id), who),
          say<texts::allocated_id_in_use_hint>(hex(unit.unique_id)), id.value()};
}

std::optional<NodeId> AllocationService::keep(AllocatedUnit& unit, NodeId id) {
  unit.node_id = id;
  switch (holder(id, unit.unique_id)) {
  case Holder::unknown: return std::nullopt; // it asks again, and then more is known
  case Holder::other: return give(unit, {.is_lost = true});
  case Holder::nobody: break;
  }
  unit.is_shared = false;
  unit.refused.reset();
  ++unit.given;
  session_.records().give(unit.unique_id, session_.now());
  if (!unit.is_deaf) {
    hook_(Event::kept, unit);
  }
  return id;
}

std::optional<NodeId> AllocationService::give(AllocatedUnit& unit, state::AllocationChoice choice) {
  if (!bus_is_known_) {
    return std::nullopt;
  }
  choice.taken = avoided_;
  choice.first = range_.first;
  choice.last = range_.last;
  const auto given = allocate(session_, store_, unit.unique_id, choice);
  if (given) {
    unit.node_id = given->node_id;
    unit.is_new = true;
    unit.former = given->former;
    unit.is_shared = false;
    unit.refused.reset();
    ++unit.given;
    session_.records().give(unit.unique_id, session_.now());
    hook_(Event::assigned, unit);
    return given->node_id;
  }
  if (given.error().code == Code::table_full) {
    refuse(unit, Event::full, given.error());
  } else if (given.error().code != Code::busy) { // then it is free when the unit asks again
    failure_ = given.error();
  }
  return std::nullopt;
}

void AllocationService::refuse(AllocatedUnit& unit, Event event, Error error) {
  const bool is_news = !unit.refused;
  unit.refused = std::move(error);
  if (is_news) {
    hook_(event, unit);
  }
}

/// The holder of this node ID on the bus, other than this unit itself, which may have been heard
/// before it restarted.
AllocationService::Holder AllocationService::holder(NodeId id, const UniqueId& unique_id) const {
  const Roster& roster = session_.roster();
  if (id == session_.node().id()) {
    return Holder::other;
  }
  if (!roster.heard(id)) { // who sends once a second needs that time to be heard
    const bool is_early = session_.now() - session_.opened() < bus_watch_time;
    return is_early ? Holder::unknown : Holder::nobody;
  }
  const Member member = roster.member(id);
  if (roster.is_doubled(id)) {
    return Holder::other;
  }
  if (member.info && member.info->unique_id == unique_id) {
    return Holder::nobody;
  }
  const bool is_gone = session_.now() - member.last_heard >= offline_time;
  const bool comes_back = member.static_node_id == id.value();
  if (is_gone && !comes_back) {
    return Holder::nobody;
  }
  return member.info ? Holder::other : Holder::unknown;
}

/// A unit that asks has no node ID, so frames of its unique ID since it began are another's; one
/// that was known for that remains so until it is gone. Whose frames those under a doubled ID are
/// is not known.
std::optional<NodeId> AllocationService::copy_of(const AllocatedUnit& unit) const {
  const auto asked = session_.roster().asked_at(unit.unique_id);
  if (!asked) {
    return std::nullopt;
  }
  const bool has_copy = unit.refused && unit.refused->code == Code::duplicate_unique_id;
  for (const auto& [id, member] : session_.roster().members()) {
    const bool is_copy =
        member.last_heard > *asked ||
        (has_copy && unit.node_id == id && session_.now() - member.last_heard < offline_time);
    if (member.is_unit(unit.unique_id) && is_copy && !session_.roster().is_doubled(id)) {
      return id;
    }
  }
  return std::nullopt;
}

bool AllocationService::is_there(const AllocatedUnit& unit) const {
  const Member* member = session_.roster().find(unit.node_id);
  return member != nullptr && !unit.refused && member->is_unit(unit.unique_id) &&
         member->last_heard >= unit.asked_at;
}

std::size_t AllocationService::free_ids() const {
  const state::NodeIds used = session_.roster().ids_in_use({});
  std::size_t free = 0;
  for (std::size_t id = range_.first.value(); id <= range_.last.value(); ++id) {
    free += used[id] ? 0U : 1U;
  }
  return free;
}

Result<state::Allocation> allocate(const Session& session, state::AllocationStore& table,
                                   const UniqueId& unique_id, state::AllocationChoice choice) {
  choice.taken |= session.roster().ids_in_use(unique_id);
  return table.allocate(unique_id, choice, session.wall());
}

std::vector<std::string> taken_over(std::span<const AllocatedUnit> units) {
  std::vector<std::string> notes;
  for (const AllocatedUnit& unit : units) {
    if (unit.former) {
      notes.push_back(say<texts::oldest_id_taken_over>(unit.node_id.value(), hex(*unit.former),
                                                       hex(unit.unique_id)));
    }
  }
  return notes;
}

} // namespace blactl::fleet
