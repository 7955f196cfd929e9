#include "blactl/sim/foreign_node.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::sim {

using namespace std::chrono_literals;

namespace {

constexpr Duration status_period = 1s; ///< of NodeStatus and ArmingStatus
constexpr dronecan::Priority status_priority = 20;
constexpr dronecan::Priority command_priority = dronecan::priority_medium;

} // namespace

ForeignNode::ForeignNode(const ForeignSetup& setup, Time power_on)
    : setup_(setup),
      endpoint_({}, [this](const dronecan::Transfer& transfer) { handle(transfer); }),
      power_on_(power_on), now_(power_on), next_status_(power_on) {
  endpoint_.set_node_id(dronecan::NodeId(setup.node_id));
  if (setup.commands) {
    next_command_ = power_on;
  }
}

void ForeignNode::receive(const can::Frame& frame, Time at) {
  now_ = at;
  endpoint_.receive(frame, at);
}

Time ForeignNode::next_deadline() const {
  return std::min(next_status_, next_command_);
}

void ForeignNode::advance(Time now) {
  now_ = now;
  if (next_status_ <= now) {
    next_status_ += status_period;
    send_message(dronecan::NodeStatus::type, status_priority, node_status().encode());
    if (setup_.armed) {
      dronecan::ArmingStatus arming;
      arming.status =
          *setup_.armed ? dronecan::ArmingStatus::fully_armed : dronecan::ArmingStatus::disarmed;
      send_message(dronecan::ArmingStatus::type, status_priority, arming.encode());
    }
  }
  if (next_command_ <= now) {
    next_command_ += setup_.commands->period;
    dronecan::ArrayCommand array;
    for (const std::uint8_t id : setup_.commands->servo_ids) {
      array.commands.push_back({id, setup_.commands->type, setup_.commands->value});
    }
    send_message(dronecan::ArrayCommand::type, command_priority, array.encode());
  }
}

void ForeignNode::handle(const dronecan::Transfer& request) {
  if (request.header.data_type_id == dronecan::GetNodeInfo::type.id) {
    dronecan::GetNodeInfo::Response info;
    info.status = node_status();
    info.software_major = 1;
    info.hardware_major = 1;
    info.unique_id = setup_.unique_id;
    info.name = setup_.name;
    answer(request, dronecan::GetNodeInfo::type, info.encode());
  } else if (request.header.data_type_id == dronecan::GetSet::type.id && setup_.serves_get_set) {
    // Without value and name: there is no such parameter (DSDL 11.GetSet).
    answer(request, dronecan::GetSet::type, dronecan::GetSet::Response{}.encode());
  }
}

void ForeignNode::answer(const dronecan::Transfer& request, const dronecan::DataType& type,
                         const dronecan::Payload& payload) {
  for (const can::Frame& frame : endpoint_.response(request, type, payload.bytes())) {
    send(frame);
  }
}

void ForeignNode::send_message(const dronecan::DataType& type, dronecan::Priority priority,
                               const dronecan::Payload& payload) {
  for (const can::Frame& frame : endpoint_.message(type, priority, payload.bytes())) {
    send(frame);
  }
}

dronecan::NodeStatus ForeignNode::node_status() const {
  dronecan::NodeStatus status;
  status.uptime_s = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::seconds>(now_ - power_on_).count());
  return status;
}

} // namespace blactl::sim
