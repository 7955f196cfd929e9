#include "blactl/dronecan/types.hpp"

#include <array>

namespace blactl::dronecan {

const DataType* find_type(Kind kind, std::uint16_t data_type_id) {
  static constexpr std::array types{
      &NodeStatus::type,   &GetNodeInfo::type,    &Allocation::type,
      &RestartNode::type,  &GetSet::type,         &ExecuteOpcode::type,
      &ArrayCommand::type, &ActuatorStatus::type, &ArmingStatus::type,
  };
  const bool service = kind != Kind::message;
  for (const auto* type : types) {
    if (type->service == service && type->id == data_type_id) {
      return type;
    }
  }
  return nullptr;
}

} // namespace blactl::dronecan
