#include "fleet/bus/hearing.hpp"

#include "blactl/dronecan/types.hpp"

#include <cstdint>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

can::Filter message_filter(const dronecan::DataType& type) {
  constexpr std::uint32_t type_and_kind = 0x00FFFF80;
  return {static_cast<std::uint32_t>(type.id) << 8, type_and_kind};
}

} // namespace

std::vector<can::Filter> filters(Session::Hearing hearing, NodeId local) {
  if (hearing == Session::Hearing::all) {
    return {};
  }
  constexpr std::uint32_t service = 0x80;
  constexpr std::uint32_t request = 0x8000;
  constexpr std::uint32_t to_us = 0x7F80;
  constexpr std::uint32_t source = 0x7F;
  constexpr std::uint32_t anonymous_type = 0x3FF;
  std::vector<can::Filter> wanted{
      {static_cast<std::uint32_t>(local.value()) << 8 | service, to_us},
      {local.value(), source},
      message_filter(dronecan::NodeStatus::type),
      message_filter(dronecan::ActuatorStatus::type),
      message_filter(dronecan::Allocation::type),
      // an anonymous request has only two bits for its type (specification 4.1)
      {static_cast<std::uint32_t>(dronecan::Allocation::type.id) << 8, anonymous_type},
  };
  if (hearing == Session::Hearing::commands) {
    wanted.push_back(message_filter(dronecan::ArrayCommand::type));
    wanted.push_back(message_filter(dronecan::ArmingStatus::type));
    for (const dronecan::DataType* type :
         {&dronecan::GetSet::type, &dronecan::ExecuteOpcode::type, &dronecan::RestartNode::type}) {
      wanted.push_back({static_cast<std::uint32_t>(type->id) << 16 | request | service,
                        0x00FF0000 | request | service});
    }
  }
  return wanted;
}

} // namespace blactl::fleet
