#include "blactl/sim/servo/servo.hpp"

#include "blactl/sim/servo/array_entry.hpp"

#include "sim/servo/names.hpp"

#include <charconv>
#include <chrono>
#include <limits>
#include <variant>

namespace blactl::sim {

using dronecan::ExecuteOpcode;
using dronecan::GetSet;
using dronecan::RestartNode;

namespace {

/// Responses waiting for their time; further requests are not served.
constexpr std::size_t max_answers = 16;

/// "0x2A": two upper-case hexadecimal digits (table 2-14).
std::optional<bla::Address> address_of(std::string_view name) {
  std::uint8_t value = 0;
  if (name.size() != 4 || !name.starts_with("0x")) {
    return std::nullopt;
  }
  std::from_chars(name.data() + 2, name.data() + name.size(), value, 16);
  return bla::Address(value).name() == name ? std::optional(bla::Address(value)) : std::nullopt;
}

/// 1400 is 1.40, as in the vendor's program. unproven: the contents of the two bytes.
struct Version {
  explicit Version(std::int64_t number)
      : major_part(static_cast<std::uint8_t>(number / 1000)),
        minor_part(static_cast<std::uint8_t>(number % 1000 / 10)) {}

  std::uint8_t major_part, minor_part;
};

} // namespace

// unproven: that a servo about to go down accepts no further requests.
void Servo::handle(const dronecan::Transfer& transfer) {
  if (departure_) {
    return;
  }
  if (transfer.header.kind == dronecan::Kind::message) {
    if (transfer.header.data_type_id == dronecan::ArrayCommand::type.id) {
      hear_commands(transfer);
    } else {
      hear_allocation(transfer);
    }
    return;
  }
  if (++requests_ == setup_.faults.restart_instead_of_answer) {
    restart(now_);
    return;
  }
  const auto kind = request_kind(transfer);
  if (!kind) {
    return; // requirement 8: no response
  }
  serve(transfer);
  if (counter_.restarts_after(*kind)) {
    departure_ = {.at = now_ + setup_.behaviour.answer_delay, .kind = Departure::Kind::fault};
  }
}

void Servo::serve(const dronecan::Transfer& transfer) {
  switch (transfer.header.data_type_id) {
  case dronecan::GetNodeInfo::type.id: serve_node_info(transfer); break;
  case GetSet::type.id: serve_get_set(transfer); break;
  case ExecuteOpcode::type.id: serve_opcode(transfer); break;
  case RestartNode::type.id: serve_restart(transfer); break;
  default: break;
  }
}

void Servo::hear_allocation(const dronecan::Transfer& transfer) {
  const auto message = dronecan::Allocation::decode(transfer.payload);
  if (!message || !allocatee_) {
    return;
  }
  const bool anonymous = !transfer.header.source.is_unicast();
  if (const auto id = allocatee_->receive(*message, anonymous, now_)) {
    operate(*id, now_);
  }
}

/// Requirement 28: not before there is a node ID.
void Servo::hear_commands(const dronecan::Transfer& transfer) {
  const auto message = dronecan::ArrayCommand::decode(transfer.payload);
  if (!message || allocatee_) {
    return;
  }
  for (const auto& command : message->commands) {
    const auto wanted = motion_command(command, setup_.behaviour);
    if (wanted && addresses(command, registers_.in_effect(address::servo_id), setup_.behaviour)) {
      motion_.command(*wanted, now_);
    }
  }
}

void Servo::serve_node_info(const dronecan::Transfer& request) {
  const Version software(setup_.firmware_version);
  const Version hardware(setup_.hardware_version);
  dronecan::GetNodeInfo::Response info;
  info.status = node_status(now_);
  info.software_major = software.major_part;
  info.software_minor = software.minor_part;
  info.hardware_major = hardware.major_part;
  info.hardware_minor = hardware.minor_part;
  info.unique_id = setup_.unique_id;
  info.name = setup_.name;
  answer(request, dronecan::GetNodeInfo::type, info.encode());
}

/// Requirement 69: a name takes precedence over an index.
std::optional<bla::Address> Servo::addressed(const GetSet::Request& request) const {
  if (!request.name.empty()) {
    return address_of(request.name);
  }
  if (!setup_.behaviour.index_only_access ||
      request.index > std::numeric_limits<std::uint8_t>::max()) {
    return std::nullopt;
  }
  return bla::Address(static_cast<std::uint8_t>(request.index));
}

/// An empty value is a failure.
dronecan::Payload Servo::get_set_answer(const GetSet::Request& request,
                                        std::optional<std::int64_t> value) const {
  const auto address = addressed(request);
  GetSet::Response response;
  if (value) {
    response.value = *value;
    response.name = address->name();
  } else if (setup_.behaviour.failure_with_name) {
    response.name = address ? address->name() : request.name;
  }
  return response.encode();
}

void Servo::serve_get_set(const dronecan::Transfer& transfer) {
  const auto request = GetSet::Request::decode(transfer.payload);
  if (!request) {
    return;
  }
  const auto address = addressed(*request);
  const auto* integer = std::get_if<std::int64_t>(&request->value);
  std::optional<std::int64_t> value;
  if (address && integer != nullptr) {
    value = motion_.write(*address, *integer, now_);
  } else if (address && std::holds_alternative<GetSet::Empty>(request->value)) {
    value = motion_.read(*address, now_);
  }
  const auto done = get_set_answer(*request, value);
  const auto order = integer != nullptr && value == 1 ? order_at(*address) : std::nullopt;
  if (order) {
    serve_order(*order, transfer, GetSet::type, done, get_set_answer(*request, std::nullopt));
  } else {
    answer(transfer, GetSet::type, done);
  }
}

std::optional<Servo::Order> Servo::order_at(bla::Address address) {
  if (address == bla::address::initialize) {
    return Order::erase;
  }
  if (address == bla::address::reboot) {
    return Order::restart;
  }
  return address == bla::address::write_rom ? std::optional(Order::save) : std::nullopt;
}

/// Tables 2-11 to 2-13. The argument is ignored.
void Servo::serve_opcode(const dronecan::Transfer& transfer) {
  const auto request = ExecuteOpcode::Request::decode(transfer.payload);
  if (!request) {
    return;
  }
  const auto done = ExecuteOpcode::Response{.ok = true}.encode();
  const auto refused = ExecuteOpcode::Response{.ok = false}.encode();
  switch (request->opcode) {
  case ExecuteOpcode::save:
    serve_order(Order::save, transfer, ExecuteOpcode::type, done, refused);
    break;
  case ExecuteOpcode::erase:
    serve_order(Order::erase, transfer, ExecuteOpcode::type, done, refused);
    break;
  default: answer(transfer, ExecuteOpcode::type, refused); break;
  }
}

void Servo::serve_restart(const dronecan::Transfer& transfer) {
  const auto request = RestartNode::Request::decode(transfer.payload);
  if (!request) {
    return;
  }
  const auto refused = RestartNode::Response{.ok = false}.encode();
  if (request->magic_number == RestartNode::magic) {
    serve_order(Order::restart, transfer, RestartNode::type,
                RestartNode::Response{.ok = true}.encode(), refused);
  } else {
    answer(transfer, RestartNode::type, refused);
  }
}

void Servo::serve_order(Order order, const dronecan::Transfer& request,
                        const dronecan::DataType& type, const dronecan::Payload& done,
                        const dronecan::Payload& refused) {
  ServoFaults& faults = setup_.faults;
  if (faults.ignore_opcodes > 0) {
    --faults.ignore_opcodes;
    return;
  }
  if (faults.refuse_opcodes) {
    answer(request, type, refused);
    return;
  }
  const bool answers = order != Order::save || setup_.behaviour.answers_save_first;
  if (faults.lose_opcode_answers > 0) {
    --faults.lose_opcode_answers;
  } else if (answers) {
    answer(request, type, faults.deny_opcodes ? refused : done);
  }
  obey(order, answers);
}

void Servo::answer(const dronecan::Transfer& request, const dronecan::DataType& type,
                   const dronecan::Payload& payload) {
  if (setup_.faults.lose_responses > 0) {
    --setup_.faults.lose_responses;
    return;
  }
  if (!setup_.faults.mute && answers_.size() < max_answers) {
    answers_.push_back(
        {now_ + setup_.behaviour.answer_delay, endpoint_.response(request, type, payload.bytes())});
  }
}

void Servo::send_answers(Time now) {
  while (!answers_.empty() && answers_.front().due <= now) {
    for (const can::Frame& frame : answers_.front().frames) {
      send(frame);
    }
    answers_.pop_front();
  }
}

void Servo::send_message(const dronecan::DataType& type, dronecan::Priority priority,
                         const dronecan::Payload& payload) {
  for (const can::Frame& frame : endpoint_.message(type, priority, payload.bytes())) {
    send(frame);
  }
}

dronecan::NodeStatus Servo::node_status(Time now) {
  motion_.look(now);
  const bool noticed = registers_.value(address::fault_notice) != 0;
  dronecan::NodeStatus status;
  if (assigned_now_ && setup_.behaviour.assignment_shows) {
    status.mode = dronecan::Mode::initialization;
  }
  status.uptime_s = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::seconds>(now - started_).count());
  if (registers_.value(address::fault_failure) != 0) {
    status.health = dronecan::Health::error;
  } else if (registers_.value(address::fault_warning) != 0 ||
             (noticed && setup_.behaviour.notices_warn)) {
    status.health = dronecan::Health::warning;
  }
  return status;
}

dronecan::ActuatorStatus Servo::actuator_status(Time now) {
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  constexpr float decidegrees_per_unit = 1000; // the field counts degrees / 100
  constexpr std::uint8_t unknown_rating = 127;
  motion_.look(now);
  dronecan::ActuatorStatus status;
  status.actuator_id = static_cast<std::uint8_t>(registers_.in_effect(address::servo_id));
  status.position =
      static_cast<float>(registers_.value(address::current_angle)) / decidegrees_per_unit;
  if (setup_.behaviour.unused_fields == UnusedFields::unknown) {
    status.force = unknown;
    status.speed = unknown;
    status.power_rating_pct = unknown_rating;
  }
  return status;
}

} // namespace blactl::sim
