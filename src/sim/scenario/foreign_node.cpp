#include "blactl/sim/scenario/foreign_node.hpp"

#include "sim/scenario/foreign_role.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::sim {

using namespace std::chrono_literals;

namespace {

constexpr Duration actuator_period = 100ms; ///< of actuator.Status, as of BLA servos
constexpr dronecan::Priority command_priority = dronecan::priority_medium;

} // namespace

ForeignNode::ForeignNode(const ForeignSetup& setup, Time power_on)
    : setup_(setup), role_(make_role(power_on)),
      endpoint_(role_->subscriptions(),
                [this](const dronecan::Transfer& transfer) { handle(transfer); }),
      power_on_(power_on), now_(power_on),
      next_status_(setup.status_period > Duration::zero() ? power_on : never) {
  endpoint_.set_node_id(dronecan::NodeId(setup.node_id));
  if (setup.armed.value_or(false) && setup.begins > Duration::zero()) {
    arms_ = power_on + setup.begins;
  }
  if (setup.commands) {
    next_command_ = power_on + setup.begins;
  }
  if (setup.actuator_id) {
    next_actuator_ = power_on;
  }
}

ForeignNode::~ForeignNode() = default;

std::unique_ptr<ForeignRole> ForeignNode::make_role(Time power_on) {
  ForeignRole::Broadcast broadcast = [this](const dronecan::DataType& type,
                                            dronecan::Priority priority, dronecan::Bytes payload) {
    return send_message(type, priority, payload);
  };
  if (const auto* gnss = std::get_if<GnssSetup>(&setup_.kind)) {
    return make_gnss_receiver(*gnss, setup_.node_id, std::move(broadcast), power_on);
  }
  if (const auto* esc = std::get_if<EscSetup>(&setup_.kind)) {
    return make_esc(*esc, std::move(broadcast), power_on);
  }
  if (const auto* babbler = std::get_if<BabblerSetup>(&setup_.kind)) {
    return make_babbler(*babbler, std::move(broadcast), power_on);
  }
  if (const auto* pilot = std::get_if<AutopilotSetup>(&setup_.kind); pilot && pilot->allocates) {
    return make_allocation_server(dronecan::NodeId(setup_.node_id), std::move(broadcast));
  }
  return std::make_unique<ForeignRole>(std::move(broadcast));
}

void ForeignNode::receive(const can::Frame& frame, Time at) {
  if (at < power_on_) {
    return;
  }
  now_ = at;
  role_->hear(frame);
  endpoint_.receive(frame, at);
}

Time ForeignNode::next_deadline() const {
  return std::min(
      {next_status_, arms_, next_command_, next_actuator_, next_order(), role_->next_deadline()});
}

void ForeignNode::advance(Time now) {
  now_ = now;
  if (next_status_ <= now) {
    next_status_ += setup_.status_period;
    const dronecan::Priority priority = role_->status_priority();
    send_message(dronecan::NodeStatus::type, priority, node_status().encode().bytes());
    if (setup_.armed) {
      send_arming();
    }
  }
  if (arms_ <= now) {
    arms_ = never;
    send_arming();
  }
  if (next_command_ <= now) {
    next_command_ += setup_.commands->period;
    dronecan::ArrayCommand array;
    for (const std::uint8_t id : setup_.commands->servo_ids) {
      array.commands.push_back({id, setup_.commands->type, setup_.commands->value});
    }
    send_message(dronecan::ArrayCommand::type, command_priority, array.encode().bytes());
  }
  if (next_actuator_ <= now) {
    next_actuator_ += actuator_period;
    const dronecan::ActuatorStatus status{.actuator_id = *setup_.actuator_id};
    send_message(dronecan::ActuatorStatus::type, dronecan::priority_medium,
                 status.encode().bytes());
  }
  while (next_order() <= now) {
    send_order(setup_.orders[orders_sent_++]);
  }
  role_->advance(now);
}

void ForeignNode::send_arming() {
  const bool is_armed = *setup_.armed && power_on_ + setup_.begins <= now_;
  const dronecan::ArmingStatus arming{.status = is_armed ? dronecan::ArmingStatus::fully_armed
                                                         : dronecan::ArmingStatus::disarmed};
  send_message(dronecan::ArmingStatus::type, role_->status_priority(), arming.encode().bytes());
}

Time ForeignNode::next_order() const {
  return orders_sent_ < setup_.orders.size() ? power_on_ + setup_.orders[orders_sent_].at : never;
}

std::vector<can::Frame> ForeignNode::write(dronecan::NodeId server, bla::Address address,
                                           std::int64_t value) {
  const dronecan::GetSet::Request request{.index = 0, .value = value, .name = address.name()};
  return endpoint_.request(server, dronecan::GetSet::type, request.encode().bytes());
}

void ForeignNode::send_order(const OrderSetup& order) {
  using Order = OrderSetup::Order;
  using dronecan::ExecuteOpcode;
  const dronecan::NodeId server(order.to);
  std::vector<can::Frame> frames;
  switch (order.order) {
  case Order::erase:
  case Order::save: {
    const auto opcode = order.order == Order::save ? ExecuteOpcode::save : ExecuteOpcode::erase;
    frames = endpoint_.request(server, ExecuteOpcode::type,
                               ExecuteOpcode::Request{.opcode = opcode}.encode().bytes());
    break;
  }
  case Order::restart:
    frames = endpoint_.request(server, dronecan::RestartNode::type,
                               dronecan::RestartNode::Request{}.encode().bytes());
    break;
  case Order::initialize: frames = write(server, bla::address::initialize, 1); break;
  case Order::write: frames = write(server, bla::Address(order.address), order.value); break;
  }
  for (const can::Frame& frame : frames) {
    send(frame);
  }
}

void ForeignNode::handle(const dronecan::Transfer& transfer) {
  if (transfer.header.kind == dronecan::Kind::message) {
    role_->receive(transfer);
  } else if (transfer.header.data_type_id == dronecan::GetNodeInfo::type.id) {
    dronecan::GetNodeInfo::Response info;
    info.status = node_status();
    info.software_major = 1;
    info.hardware_major = 1;
    info.unique_id = setup_.unique_id;
    info.name = setup_.name;
    answer(transfer, dronecan::GetNodeInfo::type, info.encode());
  } else if (transfer.header.data_type_id == dronecan::GetSet::type.id && setup_.serves_get_set) {
    if (const auto request = dronecan::GetSet::Request::decode(transfer.payload)) {
      answer(transfer, dronecan::GetSet::type, role_->get_set(*request).encode());
    }
  }
}

void ForeignNode::answer(const dronecan::Transfer& request, const dronecan::DataType& type,
                         const dronecan::Payload& payload) {
  for (const can::Frame& frame : endpoint_.response(request, type, payload.bytes())) {
    send(frame);
  }
}

std::vector<can::Frame> ForeignNode::send_message(const dronecan::DataType& type,
                                                  dronecan::Priority priority,
                                                  dronecan::Bytes payload) {
  std::vector<can::Frame> frames = endpoint_.message(type, priority, payload);
  for (const can::Frame& frame : frames) {
    send(frame);
  }
  return frames;
}

dronecan::NodeStatus ForeignNode::node_status() const {
  dronecan::NodeStatus status;
  status.uptime_s = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::seconds>(now_ - power_on_).count());
  return status;
}

} // namespace blactl::sim
