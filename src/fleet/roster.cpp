#include "blactl/fleet/roster.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace blactl::fleet {

using dronecan::Kind;
using dronecan::NodeId;
using dronecan::Transfer;

namespace {

/// A BLA servo sends actuator.Status every 100 ms (table 2-2). More than fourteen in a second are
/// two servos: one servo cannot send them even if every delay falls the worst way.
constexpr Duration status_window = std::chrono::seconds(1);
constexpr unsigned most_statuses_of_one = 14;

/// Uptime counts whole seconds and its message may be late: two start times less than this apart
/// are one.
constexpr Duration boot_tolerance = std::chrono::milliseconds(1500);

/// The same for an answer, which may be as late as it is waited for. RestartJob lets servos grow
/// older than this before it restarts them.
constexpr Duration answer_tolerance = std::chrono::seconds(2);

constexpr std::uint8_t tail_start_of_transfer = 0x80;

/// ERASE writes all of them; a name that is none of ours may be any.
constexpr std::optional<bla::Address> every_register{};
constexpr std::uint16_t last_index = 0xFF;

/// Bound for what anybody on the bus can make us remember.
constexpr std::size_t most_pending = 256;

/// What a servo is (table 3-11), and how it is set (what SAVE keeps, 4.11): two values in answers
/// to one question are of two servos.
std::set<std::string> names_of_settled() {
  namespace at = bla::address;
  std::set<std::string> names{at::model_number.name(), at::serial_number.name(),
                              at::firmware_version.name(), at::hardware_version.name()};
  for (unsigned value = 0; value <= last_index; ++value) {
    if (const bla::Address address(static_cast<std::uint8_t>(value)); bla::is_setting(address)) {
      names.insert(address.name());
    }
  }
  return names;
}

} // namespace

Servo Member::servo() const {
  return {.id = id,
          .unique_id = info ? std::optional(info->unique_id) : std::nullopt,
          .boot = identified_boot,
          .since = since,
          .name = info ? info->name : std::string(),
          .is_servo = is_servo,
          .identity = identity,
          .servo_id = servo_id,
          .static_node_id = static_node_id};
}

Roster::Roster(NodeId local)
    : local_(local),
      answers_(names_of_settled(), [this](NodeId id, const std::set<dronecan::UniqueId>& units) {
        doubled_.insert(id);
        units_[id].insert(units.begin(), units.end());
      }) {}

void Roster::mark_doubled(NodeId id, const dronecan::UniqueId& one,
                          const dronecan::UniqueId& other) {
  doubled_.insert(id);
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
  for (Listener* listener : std::vector(listeners_)) { // they may leave, bring or remove others
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
  member.is_servo = servo.is_servo;
  member.identity = servo.identity;
  member.servo_id = servo.servo_id;
  member.static_node_id = servo.static_node_id;
  member.identified = true;
}

void Roster::learn_run(const Servo& servo) {
  Member& member = known(servo.id);
  member.info_boot = member.identified_boot = servo.boot;
  member.since = servo.since;
}

void Roster::learn_static_node_id(NodeId id, std::optional<std::int64_t> static_node_id) {
  known(id).static_node_id = static_node_id;
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
  Member& heard = known(header->source);
  heard.last_heard = at;
  answers_.receive(*header, frame, at);
  const std::uint8_t tail = frame.data[frame.size - 1U];
  if (header->kind == Kind::message && header->data_type_id == dronecan::ActuatorStatus::type.id &&
      (tail & tail_start_of_transfer) != 0) {
    count_status(header->source, tail % dronecan::transfer_id_modulus, at);
  }
  if (!std::exchange(heard_[header->source.value()], true)) {
    heard.first_heard = at;
    announce(heard);
  }
  if (header->kind == Kind::message && header->data_type_id == dronecan::NodeStatus::type.id) {
    hear_status(heard, frame, at);
  }
}

/// NodeStatus is one frame. One with the transfer ID of the last is dropped as its repetition
/// before it comes to receive(); but it may be of another unit, whose uptime tells.
void Roster::hear_status(Member& sender, const can::Frame& frame, Time at) {
  const std::size_t size = frame.size - 1U;
  const dronecan::TransferId id = frame.data[size] % dronecan::transfer_id_modulus;
  const bool is_repeated = std::exchange(pulses_[sender.id.value()].last_status_id, id) == id;
  const auto status = dronecan::NodeStatus::decode(dronecan::Bytes(frame.data.data(), size));
  if (is_repeated && status) {
    watch_uptime(sender, status->uptime_s, at);
  }
}

/// Nobody acknowledges a servo that is alone on the bus: when somebody joins, its waiting frames
/// come all at once. But one unit numbers its transfers one by one; where the numbers of two units
/// mix, at least every second one does not follow the one before.
void Roster::count_status(NodeId source, dronecan::TransferId transfer_id, Time at) {
  Pulse& pulse = pulses_[source.value()];
  if (!pulse.window_start || at - *pulse.window_start > status_window) {
    pulse.window_start = at;
    pulse.count = pulse.leaps = 0;
  }
  const unsigned next = (pulse.last_transfer_id + 1U) % dronecan::transfer_id_modulus;
  pulse.leaps += transfer_id != next ? 1U : 0U;
  pulse.last_transfer_id = transfer_id;
  ++pulse.count;
  if (pulse.count > most_statuses_of_one && pulse.leaps * 4 > pulse.count) {
    too_fast_.insert(source);
  }
}

/// An actuator of another make may send its status as fast as it likes.
bool Roster::is_too_fast(NodeId id) const {
  const Member* sender = find(id);
  const bool is_foreign = sender != nullptr && sender->identified && !sender->is_servo;
  return too_fast_.contains(id) && !is_foreign;
}

bool Roster::is_doubled(NodeId id) const {
  return doubled_.contains(id) || is_too_fast(id);
}

std::set<NodeId> Roster::doubled() const {
  std::set<NodeId> all = doubled_;
  std::ranges::copy_if(too_fast_, std::inserter(all, all.end()),
                       [this](NodeId id) { return is_too_fast(id); });
  return all;
}

void Roster::receive(const Transfer& transfer) {
  const auto& header = transfer.header;
  if (header.source == local_ && local_.is_unicast()) {
    return;
  }
  if (header.kind == Kind::request && header.data_type_id == dronecan::GetSet::type.id) {
    on_write(transfer);
  }
  if (header.kind == Kind::request && header.data_type_id == dronecan::ExecuteOpcode::type.id) {
    const auto request = dronecan::ExecuteOpcode::Request::decode(transfer.payload);
    if (request && request->opcode == dronecan::ExecuteOpcode::erase) {
      writes_[header.destination][every_register] = {header.source, transfer.at};
    }
  }
  if (header.kind == Kind::response && header.data_type_id == dronecan::GetNodeInfo::type.id) {
    // Its uptime counts as well as that of NodeStatus: a restart before the first of these shows.
    if (const auto info = dronecan::GetNodeInfo::Response::decode(transfer.payload);
        info && header.source.is_unicast()) {
      Member& sender = known(header.source);
      sender.status = info->status;
      sender.status_at = transfer.at;
      if (is_news(header.source, info->status.uptime_s, transfer.at)) {
        watch_uptime(sender, info->status.uptime_s, transfer.at);
      } else if (is_of_before(header.source, info->status.uptime_s, transfer.at)) {
        doubled_.insert(header.source);
      }
      learn(header.source, *info, transfer.at);
    }
  }
  if (header.kind != Kind::message) {
    return;
  }
  switch (header.data_type_id) {
  case dronecan::NodeStatus::type.id: on_status(transfer); break;
  case dronecan::Allocation::type.id: on_allocation(transfer); break;
  case dronecan::ArrayCommand::type.id: on_command(transfer); break;
  case dronecan::ActuatorStatus::type.id:
    if (const auto status = dronecan::ActuatorStatus::decode(transfer.payload);
        status && header.source.is_unicast()) {
      known(header.source).actuator_id = status->actuator_id;
    }
    break;
  case dronecan::ArmingStatus::type.id:
    if (const auto arming = dronecan::ArmingStatus::decode(transfer.payload)) {
      // Each speaks for itself: one that is disarmed does not disarm another.
      arming->status == dronecan::ArmingStatus::disarmed ? armed_.erase(header.source)
                                                         : armed_.insert(header.source).second;
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
  sender.status = *status;
  sender.status_at = transfer.at;
  watch_uptime(sender, status->uptime_s, transfer.at);
}

/// Whether the uptime of an answer tells of another start than is known. An answer may have been
/// under way for long: its uptime is older than it looks.
bool Roster::is_news(NodeId source, std::uint32_t uptime_s, Time at) const {
  const Pulse& pulse = pulses_[source.value()];
  const std::optional<Time>& known = pulse.boots[pulse.last_boot];
  return !known || at - std::chrono::seconds(uptime_s) - *known > answer_tolerance;
}

/// Whether the uptime of an answer tells of an older start than the last one that was heard: who
/// answers did not start then. However late it comes, its start looks later and not earlier.
bool Roster::is_of_before(NodeId source, std::uint32_t uptime_s, Time at) const {
  const Pulse& pulse = pulses_[source.value()];
  const std::optional<Time>& known = pulse.boots[pulse.last_boot];
  return known && *known - (at - std::chrono::seconds(uptime_s)) > answer_tolerance;
}

void Roster::watch_uptime(Member& sender, std::uint32_t uptime_s, Time at) {
  if (has_restarted(sender, uptime_s, at)) {
    ++sender.boots;
    answers_.forget(sender.id);
    announce(sender);
  }
}

/// Every uptime tells when its unit started. A new start is a restart; coming back to the old one
/// means that two units send under one ID. A unit that restarts at once shows by its uptime alone,
/// which never goes back.
bool Roster::has_restarted(Member& sender, std::uint32_t uptime_s, Time at) {
  Pulse& pulse = pulses_[sender.id.value()];
  const Time boot = at - std::chrono::seconds(uptime_s);
  const std::uint32_t before = std::exchange(pulse.last_uptime_s, uptime_s);
  // A servo that restarts right after its start has two that are close to each other.
  const auto distance = [&](const std::optional<Time>& known) {
    return known ? std::chrono::abs(*known - boot) : Duration::max();
  };
  const auto it = std::ranges::min_element(pulse.boots, {}, distance);
  if (distance(*it) < boot_tolerance) {
    const auto index = static_cast<std::size_t>(it - pulse.boots.begin());
    *it = boot; // clocks drift
    if (index != std::exchange(pulse.last_boot, index)) {
      doubled_.insert(sender.id);
      return false;
    }
    return uptime_s < before;
  }
  const bool first = !pulse.boots[pulse.last_boot];
  pulse.last_boot = first ? pulse.last_boot : 1 - pulse.last_boot;
  pulse.boots[pulse.last_boot] = boot;
  return !first;
}

void Roster::on_allocation(const Transfer& transfer) {
  const auto allocation = dronecan::Allocation::decode(transfer.payload);
  if (!allocation) {
    return;
  }
  const UniqueIdPrefix prefix(allocation->unique_id.begin(),
                              allocation->unique_id.begin() + allocation->size);
  if (transfer.header.source.is_unicast()) {
    allocators_.insert(transfer.header.source);
    if (allocation->node_id != 0 && prefix.size() == allocation->unique_id.size()) {
      std::erase_if(pending_, [&](const UniqueIdPrefix& waiting) {
        return std::ranges::equal(waiting, std::span(prefix).first(waiting.size()));
      });
    }
  } else if (allocation->first_part_of_unique_id && !prefix.empty() &&
             pending_.size() < most_pending) {
    pending_.insert(prefix);
  }
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

bool Roster::is_pending(const dronecan::UniqueId& unique_id) const {
  return std::ranges::any_of(pending_, [&](const UniqueIdPrefix& prefix) {
    return std::ranges::equal(prefix, std::span(unique_id).first(prefix.size()));
  });
}

Commander& Roster::commander(NodeId source) {
  Commander& known = commanders_[source];
  known.source = source;
  return known;
}

void Roster::on_command(const Transfer& transfer) {
  const auto command = dronecan::ArrayCommand::decode(transfer.payload);
  if (!command) {
    return;
  }
  for (const auto& entry : command->commands) {
    commander(transfer.header.source).servo_ids[entry.actuator_id] = {transfer.at,
                                                                      entry.command_type};
  }
}

void Roster::on_write(const Transfer& transfer) {
  const auto request = dronecan::GetSet::Request::decode(transfer.payload);
  if (!request || std::holds_alternative<dronecan::GetSet::Empty>(request->value)) {
    return;
  }
  // A name wins over an index, which is the address.
  const auto is_at = [&](bla::Address address) {
    return request->name.empty() ? request->index == address.value()
                                 : request->name == address.name();
  };
  namespace at = bla::address;
  const auto& [source, server] = std::pair(transfer.header.source, transfer.header.destination);
  if (is_at(at::command_angle) || is_at(at::command_speed) || is_at(at::command_torque)) {
    commander(source).nodes[server] = transfer.at;
  } else {
    const auto reg = request->name.empty() ? std::optional(bla::Address(static_cast<std::uint8_t>(
                                                 std::min(request->index, last_index))))
                                           : bla::find_address(request->name);
    writes_[server][reg] = {source, transfer.at};
  }
}

std::optional<Time> Roster::started(NodeId id) const {
  const Pulse& pulse = pulses_[id.value()];
  return pulse.boots[pulse.last_boot];
}

std::optional<NodeId> Roster::writer_to(NodeId id, Time since,
                                        std::optional<bla::Address> reg) const {
  const auto it = writes_.find(id);
  if (it == writes_.end()) {
    return std::nullopt;
  }
  for (const auto& [written, write] : it->second) {
    if (write.at > since && (!reg || !written || *written == *reg)) {
      return write.source;
    }
  }
  return std::nullopt;
}

std::optional<NodeId> Roster::driver_of(const Servo& servo, Time now) const {
  return commander_of(servo, now - driving_time);
}

std::optional<NodeId> Roster::commander_of(const Servo& servo, Time since) const {
  const Member* member = find(servo.id);
  const auto recent = [&](Time at) { return at >= since; };
  for (const auto& [source, commander] : commanders_) {
    const auto by_node = commander.nodes.find(servo.id);
    if (by_node != commander.nodes.end() && recent(by_node->second)) {
      return source;
    }
    for (const auto& [servo_id, command] : commander.servo_ids) {
      constexpr std::uint8_t every_servo = 255;
      // Register and actuator.Status may differ: which of them it obeys is not known.
      const bool meant = servo_id == every_servo || servo.servo_id == servo_id ||
                         (member != nullptr && member->actuator_id == servo_id);
      if (meant && recent(command.at)) {
        return source;
      }
    }
  }
  return std::nullopt;
}

} // namespace blactl::fleet
