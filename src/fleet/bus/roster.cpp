#include "blactl/fleet/bus/roster.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace blactl::fleet {

using dronecan::Kind;
using dronecan::NodeId;
using dronecan::Transfer;

namespace {

constexpr std::uint8_t tail_start_of_transfer = 0x80;

/// The identification (table 3-11) and the settings (kept by SAVE, 4.11) of a servo: two values in
/// responses to one request are of two servos.
std::set<std::string> names_of_settled(const bla::Profiles& profiles) {
  namespace at = bla::address;
  std::set<std::string> names{at::model_number.name(), at::serial_number.name(),
                              at::firmware_version.name(), at::hardware_version.name()};
  for (const bla::Parameter& parameter : profiles.registers()) {
    if (parameter.is_setting()) {
      names.insert(parameter.address.name());
    }
  }
  return names;
}

bool may_be_servo(const Member& member) {
  return member.is_servo || member.sends_actuator_status();
}

/// Whether it ran while the other was running already.
bool ran_beside(const Member& member, const Member& other) {
  return member.status_at > other.info_start;
}

} // namespace

Servo Member::servo() const {
  return {.id = id,
          .unique_id = unique_id(),
          .boot = identified_boot,
          .since = since,
          .is_young = is_young,
          .name = info ? info->name : std::string(),
          .is_servo = is_servo,
          .identity = identity,
          .servo_id = servo_id,
          .static_node_id = static_node_id,
          .id_is_known = id_is_known};
}

Roster::Roster(NodeId local, const bla::Profiles& profiles)
    : local_(local), profiles_(profiles),
      answers_(names_of_settled(profiles),
               [this](NodeId id, const std::set<dronecan::UniqueId>& units) {
                 doubled_[id] = known(id).last_heard;
                 units_[id].insert(units.begin(), units.end());
               }) {}

void Roster::mark_doubled(NodeId id, const dronecan::UniqueId& one,
                          const dronecan::UniqueId& other) {
  doubled_[id] = known(id).last_heard;
  units_[id].insert({one, other});
}

std::set<dronecan::UniqueId> Roster::units(NodeId id) const {
  const auto it = units_.find(id);
  return it != units_.end() ? it->second : std::set<dronecan::UniqueId>{};
}

Member& Roster::known(NodeId id) {
  const auto [it, added] = members_.try_emplace(id);
  if (added) {
    it->second.id = id;
  }
  return it->second;
}

Member Roster::member(NodeId id) const {
  const Member* known = find(id);
  return known != nullptr ? *known : Member{.id = id};
}

void Roster::announce(const Member& member) {
  for (Listener* listener : std::vector(listeners_)) { // they may add or remove listeners
    if (std::ranges::find(listeners_, listener) != listeners_.end()) {
      listener->on_new_unit(member);
    }
  }
}

void Roster::learn(NodeId id, const dronecan::GetNodeInfo::Response& info, Time at) {
  Member& member = known(id);
  if (member.info && member.info_boot == member.boots && member.info->unique_id != info.unique_id) {
    mark_doubled(id, member.info->unique_id, info.unique_id);
  }
  member.info = info;
  member.info_boot = member.boots;
  member.info_at = at;
  member.info_start = at - std::chrono::seconds(info.status.uptime_s);
  if (!member.is_known()) {
    member.identified = member.is_servo = false;
    member.identity = {};
    member.servo_id = member.static_node_id = std::nullopt;
  }
}

void Roster::learn(const Servo& servo, const std::optional<dronecan::GetNodeInfo::Response>& info) {
  Member& member = known(servo.id);
  member.info = info;
  member.info_boot = member.identified_boot = servo.boot;
  member.since = servo.since;
  member.is_young = servo.is_young;
  member.is_servo = servo.is_servo;
  member.identity = servo.identity;
  member.servo_id = servo.servo_id;
  member.static_node_id = servo.static_node_id;
  member.identified = true;
  if (servo.unique_id) {
    first_told_.try_emplace(*servo.unique_id, servo.since);
  }
}

void Roster::recall(const Servo& servo) {
  learn(servo, std::nullopt);
  Member& member = known(servo.id);
  member.told_unique_id = servo.unique_id;
  member.id_is_known = servo.id_is_known;
  heard_[servo.id.value()] = true;
}

void Roster::learn_run(const Servo& servo) {
  Member& member = known(servo.id);
  member.info_boot = member.identified_boot = servo.boot;
  member.since = servo.since;
  member.is_young = servo.is_young;
  member.servo_id = servo.servo_id;
  member.static_node_id = servo.static_node_id;
}

void Roster::learn_static_node_id(NodeId id, std::optional<std::int64_t> static_node_id) {
  known(id).static_node_id = static_node_id;
}

bool Roster::has_moved(const Member& member) const {
  return member.info && std::ranges::any_of(members_, [&](const auto& entry) {
           const Member& other = entry.second;
           return other.id != member.id && other.is_unit(member.info->unique_id) &&
                  other.info_start > member.last_heard;
         });
}

std::vector<NodeId> Roster::copies(NodeId id) const {
  std::vector<NodeId> copies;
  const Member* member = find(id);
  if (member == nullptr || !member->info || !member->is_unit(member->info->unique_id) ||
      !may_be_servo(*member)) {
    return copies;
  }
  const bool is_blank = dronecan::is_blank(member->info->unique_id); // as of many other nodes
  for (const auto& [other_id, other] : members_) {
    const bool is_one =
        other.is_unit(member->info->unique_id) && (may_be_servo(other) || !is_blank);
    const bool were_both_there = ran_beside(*member, other) && ran_beside(other, *member);
    if (other_id != id &&
        ((is_one && were_both_there) || units(other_id).contains(member->info->unique_id))) {
      copies.push_back(other_id);
    }
  }
  return copies;
}

const Member* Roster::find(NodeId id) const {
  const auto it = members_.find(id);
  return it != members_.end() ? &it->second : nullptr;
}

void Roster::hear(const can::Frame& frame, Time at) {
  if (!frame.extended || frame.remote || frame.size == 0) {
    return;
  }
  const auto header = dronecan::decode_id(frame.id);
  if (!header || !header->source.is_unicast() || header->source == local_) {
    return;
  }
  hear_request(*header, frame, at);
  Member& heard = known(header->source);
  heard.back_at = at - heard.last_heard > longest_pause ? at : heard.back_at;
  heard.missed_until = at - heard.last_heard > usual_start ? at : heard.missed_until;
  heard.last_heard = at;
  answers_.receive(*header, frame, at);
  const std::uint8_t tail = frame.data[frame.size - 1U];
  if (!is_late_ && header->kind == Kind::message &&
      header->data_type_id == dronecan::ActuatorStatus::type.id &&
      (tail & tail_start_of_transfer) != 0) {
    watches_[header->source.value()].count_actuator_status(frame, at);
  }
  if (!std::exchange(heard_[header->source.value()], true)) {
    heard.first_heard = at;
    announce(heard);
  }
  if (!is_late_ && header->kind == Kind::message &&
      header->data_type_id == dronecan::NodeStatus::type.id) {
    hear_status(heard, frame, at);
  }
}

/// The present uptimes tell of restarts in the meantime.
void Roster::be_late(bool is_late) {
  if (is_late && !is_late_) {
    std::ranges::for_each(watches_, &UnitWatch::begin_rates_anew);
  }
  is_late_ = is_late;
}

Time Roster::last_heard() const {
  Time last{};
  for (const auto& [id, member] : members_) {
    last = std::max(last, member.last_heard);
  }
  return last;
}

void Roster::hear_own(const can::Frame& frame, Time at) {
  if (const auto header = dronecan::decode_id(frame.id); header && frame.size > 0) {
    hear_request(*header, frame, at);
  }
}

/// A request for GetNodeInfo is one frame.
void Roster::hear_request(const dronecan::Header& header, const can::Frame& frame, Time at) {
  if (header.kind == Kind::request && header.data_type_id == dronecan::GetNodeInfo::type.id) {
    watches_[header.destination.value()].hear_request(
        header.source, frame.data[frame.size - 1U] % dronecan::transfer_id_modulus, at);
  }
}

/// NodeStatus is one frame.
void Roster::hear_status(Member& sender, const can::Frame& frame, Time at) {
  const std::size_t size = frame.size - 1U;
  const auto status = dronecan::NodeStatus::decode(dronecan::Bytes(frame.data.data(), size));
  if (status) {
    const dronecan::TransferId id = frame.data[size] % dronecan::transfer_id_modulus;
    UnitWatch& watch = watches_[sender.id.value()];
    watch.count_node_status(frame, status->uptime_s, at);
    take(watch.hear_repetition(id, status->uptime_s, at), sender, sender.status_at);
  }
}

/// When it last showed. An actuator of another make may send its status as fast as it likes.
std::optional<Time> Roster::doubled_at(NodeId id) const {
  const Member* sender = find(id);
  const bool is_foreign = sender != nullptr && sender->identified && !sender->is_servo;
  const UnitWatch& watch = watches_[id.value()];
  const auto told = doubled_.find(id);
  return std::max({told != doubled_.end() ? std::optional(told->second) : std::nullopt,
                   is_foreign ? std::nullopt : watch.too_fast_at(), watch.two_statuses_at()});
}

bool Roster::is_doubled(NodeId id) const {
  return doubled_at(id).has_value();
}

std::set<NodeId> Roster::doubled() const {
  std::set<NodeId> all;
  for (const auto& [id, member] : members_) {
    if (is_doubled(id)) {
      all.insert(id);
    }
  }
  return all;
}

void Roster::forget_gone(Time since) {
  std::erase_if(members_, [&](const auto& member) {
    const NodeId id = member.first;
    const bool is_gone = member.second.last_heard < since;
    if (is_gone) {
      heard_[id.value()] = false;
      watches_[id.value()] = {};
      doubled_.erase(id);
      units_.erase(id);
    }
    return is_gone;
  });
  allocations_.forget_silent(since);
}

void Roster::forget_doubled(Time since) {
  for (const NodeId id : doubled()) {
    if (doubled_at(id) < since) {
      begin_anew(id);
    }
  }
}

/// Another unit has come in a silence: what is known of this ID was told by the one before.
void Roster::begin_anew(NodeId id) {
  doubled_.erase(id);
  units_.erase(id);
  watches_[id.value()].begin_anew();
  begin_unit(known(id));
}

void Roster::receive(const Transfer& transfer) {
  const auto& header = transfer.header;
  if (header.source == local_ && local_.is_unicast()) {
    return;
  }
  commands_.receive(transfer);
  if (header.kind == Kind::response && header.data_type_id == dronecan::GetNodeInfo::type.id) {
    // its uptime counts as well as that of NodeStatus: a restart before the first of these shows
    if (const auto info = dronecan::GetNodeInfo::Response::decode(transfer.payload);
        info && header.source.is_unicast()) {
      Member& sender = known(header.source);
      greet(sender, transfer.at);
      if (accepts_exchanges_ && sender.may_be_another() &&
          sender.is_another_unit(info->unique_id)) {
        begin_anew(header.source);
      }
      const Time heard_before = std::exchange(sender.status_at, transfer.at);
      sender.status = info->status;
      take(watches_[header.source.value()].hear_answer(info->status.uptime_s, transfer), sender,
           heard_before);
      learn(header.source, *info, transfer.at);
    }
  }
  if (header.kind != Kind::message) {
    return;
  }
  switch (header.data_type_id) {
  case dronecan::NodeStatus::type.id: on_status(transfer); break;
  case dronecan::Allocation::type.id: allocations_.receive(transfer); break;
  case dronecan::ActuatorStatus::type.id:
    if (const auto status = dronecan::ActuatorStatus::decode(transfer.payload);
        status && header.source.is_unicast()) {
      Member& member = known(header.source);
      member.actuator_id = status->actuator_id;
      member.actuator_at = transfer.at;
    }
    break;
  default: break;
  }
}

void Roster::on_status(const Transfer& transfer) {
  const auto status = dronecan::NodeStatus::decode(transfer.payload);
  if (!status || !transfer.header.source.is_unicast()) {
    return;
  }
  Member& sender = known(transfer.header.source);
  greet(sender, transfer.at);
  sender.status = *status;
  const Time heard_before = std::exchange(sender.status_at, transfer.at);
  if (!is_late_) {
    take(watches_[sender.id.value()].hear_uptime(status->uptime_s, transfer.at), sender,
         heard_before);
  }
}

/// What was written to this node ID before concerned somebody else, or nobody.
void Roster::greet(const Member& sender, Time at) {
  if (!sender.status) {
    commands_.begin(sender.id, at);
  }
}

/// Takes the result of an uptime for a node; `heard_before`: the uptime before it.
void Roster::take(UnitWatch::Start start, Member& sender, Time heard_before) {
  const bool may_be_exchanged = accepts_exchanges_ && sender.back_at > heard_before;
  if (start == UnitWatch::Start::twin && may_be_exchanged) {
    begin_anew(sender.id);
  } else if (start == UnitWatch::Start::twin) {
    doubled_[sender.id] = sender.last_heard;
  } else if (start == UnitWatch::Start::anew) {
    begin_unit(sender);
  }
}

/// Another unit, or another run of it: what is known was told by the one before.
void Roster::begin_unit(Member& member) {
  ++member.boots;
  commands_.begin(member.id, member.status_at);
  answers_.forget(member.id);
  announce(member);
}

/// A unit that has been given one is heard within the time of a request.
std::optional<NodeId> Roster::giver_of(NodeId given, NodeId except, Time since) const {
  const auto allotted = allocations_.allotment(given);
  if (allotted && allotted->at + request_period > since &&
      !member(except).is_unit(allotted->unit)) {
    return allotted->by;
  }
  return commands_.giver_of(bla::address::static_node_id, given.value(), except, since);
}

std::optional<NodeId> Roster::renumbered_by(const Servo& servo) const {
  const auto told = servo.unique_id ? first_told_.find(*servo.unique_id) : first_told_.end();
  return told != first_told_.end() ? setter_of(servo.id, told->second, bla::address::servo_id)
                                   : std::nullopt;
}

const Member* Roster::newcomer_with(std::int64_t servo_id, Time since, NodeId except,
                                    const std::set<dronecan::UniqueId>& own) const {
  for (const auto& [id, member] : members_) {
    if (id != except && member.actuator_id == servo_id && member.first_heard > since &&
        !(member.info && own.contains(member.info->unique_id))) {
      return &member;
    }
  }
  return nullptr;
}

state::NodeIds Roster::ids_in_use(const dronecan::UniqueId& unit) const {
  state::NodeIds ids;
  ids.set(local_.value());
  for (const auto& [id, member] : members_) {
    const bool is_own = member.info && member.info->unique_id == unit && !is_doubled(id);
    if (is_own) {
      continue;
    }
    if (heard(id)) {
      ids.set(id.value());
    }
    if (const auto fixed = member.static_node_id.value_or(0); fixed > 0 && fixed <= NodeId::max) {
      ids.set(static_cast<std::size_t>(fixed));
    }
  }
  return ids;
}

std::optional<NodeId> Roster::driver_of(const Servo& servo, Time now) const {
  return commands_.commander_of(servo, member(servo.id).actuator_id,
                                [now](const Repeated& command) { return command.counts(now); });
}

std::optional<NodeId> Roster::commander_of(const Servo& servo, Time since) const {
  return commands_.commander_of(servo, member(servo.id).actuator_id,
                                [since](const Repeated& command) { return command.at() >= since; });
}

} // namespace blactl::fleet
