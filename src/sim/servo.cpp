#include "blactl/sim/servo.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <limits>
#include <utility>
#include <variant>

namespace blactl::sim {

using namespace std::chrono_literals;
using dronecan::Kind;

namespace {

// Section 2.2.
constexpr Duration node_status_period = 1s;
constexpr Duration status_period = 100ms;
constexpr dronecan::Priority status_priority = 16;
constexpr dronecan::Priority allocation_priority = 24;

/// unproven: how long a servo takes from power to its first frame; each a little different.
constexpr Duration min_boot_time = 50ms;
constexpr Duration max_boot_time = 150ms;

/// Answers that wait for their time; a request beyond that is not served.
constexpr std::size_t max_answers = 16;

constexpr bla::Address fault_warning{0x1A}, fault_failure{0x1B};

/// "0x2A": two upper-case hexadecimal digits (table 2-14).
std::optional<bla::Address> address_of(std::string_view name) {
  std::uint8_t value = 0;
  if (name.size() != 4 || !name.starts_with("0x")) {
    return std::nullopt;
  }
  std::from_chars(name.data() + 2, name.data() + name.size(), value, 16);
  return bla::Address(value).name() == name ? std::optional(bla::Address(value)) : std::nullopt;
}

/// 1400 is 1.40, as the vendor's program shows it. unproven: what the two bytes really hold.
struct Version {
  explicit Version(std::int64_t number)
      : major_part(static_cast<std::uint8_t>(number / 1000)),
        minor_part(static_cast<std::uint8_t>(number % 1000 / 10)) {}

  std::uint8_t major_part, minor_part;
};

} // namespace

Servo::Servo(const ServoSetup& setup, std::uint64_t seed, Time power_on)
    : setup_(setup), random_(seed), registers_(setup),
      endpoint_({dronecan::Allocation::type.id},
                [this](const dronecan::Transfer& transfer) { handle(transfer); }),
      started_(power_on + random_.between(min_boot_time, max_boot_time)), now_(power_on) {}

void Servo::receive(const can::Frame& frame, Time at) {
  now_ = at;
  if (running_) {
    endpoint_.receive(frame, at);
  }
}

Time Servo::next_deadline() const {
  if (!running_) {
    return started_;
  }
  if (allocatee_) {
    return allocatee_->next_deadline();
  }
  const Time next = std::min(next_node_status_, next_status_);
  return answers_.empty() ? next : std::min(next, answers_.front().due);
}

void Servo::advance(Time now) {
  now_ = now;
  if (!running_) {
    if (now < started_) {
      return;
    }
    start(now);
  }
  if (allocatee_) {
    if (const auto request = allocatee_->advance(now)) {
      send_message(dronecan::Allocation::type, allocation_priority, request->encode());
    }
    return;
  }
  send_answers(now);
  if (next_node_status_ <= now) {
    next_node_status_ += node_status_period;
    send_message(dronecan::NodeStatus::type, status_priority, node_status(now).encode());
  }
  if (next_status_ <= now) {
    next_status_ += status_period;
    send_message(dronecan::ActuatorStatus::type, status_priority, actuator_status().encode());
  }
}

void Servo::start(Time now) {
  running_ = true;
  const dronecan::NodeId id(
      static_cast<std::uint8_t>(registers_.value(bla::address::static_node_id)));
  if (id.is_unicast()) {
    operate(id, now);
  } else {
    allocatee_.emplace(setup_.unique_id, random_.next(), now);
  }
}

void Servo::operate(dronecan::NodeId id, Time now) {
  allocatee_.reset();
  endpoint_.set_node_id(id);
  next_node_status_ = next_status_ = now;
}

void Servo::handle(const dronecan::Transfer& transfer) {
  if (transfer.header.kind == Kind::message) {
    hear_allocation(transfer);
    return;
  }
  switch (transfer.header.data_type_id) {
  case dronecan::GetNodeInfo::type.id: serve_node_info(transfer); break;
  case dronecan::GetSet::type.id: serve_get_set(transfer); break;
  default: break; // requirement 8: no answer
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

/// Requirement 69: a name wins over an index.
std::optional<bla::Address> Servo::addressed(const dronecan::GetSet::Request& request) const {
  if (!request.name.empty()) {
    return address_of(request.name);
  }
  if (!setup_.behaviour.index_only_access ||
      request.index > std::numeric_limits<std::uint8_t>::max()) {
    return std::nullopt;
  }
  return bla::Address(static_cast<std::uint8_t>(request.index));
}

void Servo::serve_get_set(const dronecan::Transfer& transfer) {
  const auto request = dronecan::GetSet::Request::decode(transfer.payload);
  if (!request) {
    return;
  }
  const auto address = addressed(*request);
  const auto* integer = std::get_if<std::int64_t>(&request->value);
  const bla::Parameter* parameter = address ? setup_.profile->find(*address) : nullptr;
  if (integer != nullptr && parameter != nullptr && parameter->group == bla::Group::operation) {
    return; // intentional: what 0x10-0x12 do is not simulated
  }
  std::optional<std::int64_t> value;
  if (address && integer != nullptr) {
    value = registers_.write(*address, *integer);
  } else if (address && std::holds_alternative<dronecan::GetSet::Empty>(request->value)) {
    value = registers_.read(*address);
  }
  dronecan::GetSet::Response response;
  if (value) {
    response.value = *value;
    response.name = address->name();
  } else if (setup_.behaviour.failure_with_name) {
    response.name = address ? address->name() : request->name;
  }
  answer(transfer, dronecan::GetSet::type, response.encode());
}

void Servo::answer(const dronecan::Transfer& request, const dronecan::DataType& type,
                   const dronecan::Payload& payload) {
  if (setup_.faults.lose_responses > 0) {
    --setup_.faults.lose_responses;
    return;
  }
  if (!setup_.faults.mute && answers_.size() < max_answers) {
    answers_.push_back(
        {now_ + setup_.answer_delay, endpoint_.response(request, type, payload.bytes())});
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

dronecan::NodeStatus Servo::node_status(Time now) const {
  dronecan::NodeStatus status;
  status.uptime_s = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::seconds>(now - started_).count());
  if (registers_.value(fault_failure) != 0) {
    status.health = dronecan::Health::error;
  } else if (registers_.value(fault_warning) != 0) {
    status.health = dronecan::Health::warning;
  }
  return status;
}

dronecan::ActuatorStatus Servo::actuator_status() const {
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  constexpr float decidegrees_per_unit = 1000; // the field counts degrees / 100
  constexpr std::uint8_t unknown_rating = 127;
  dronecan::ActuatorStatus status;
  status.actuator_id = static_cast<std::uint8_t>(registers_.value(bla::address::servo_id));
  status.position =
      static_cast<float>(registers_.value(bla::address::current_angle)) / decidegrees_per_unit;
  status.force = unknown;
  status.speed = unknown;
  status.power_rating_pct = unknown_rating;
  return status;
}

} // namespace blactl::sim
