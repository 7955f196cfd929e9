#include "blactl/sim/servo/request_counter.hpp"

#include "blactl/dronecan/types.hpp"

#include <algorithm>
#include <variant>

namespace blactl::sim {

std::optional<RequestKind> request_kind(const dronecan::Transfer& request) {
  using dronecan::GetSet;
  switch (request.header.data_type_id) {
  case dronecan::GetNodeInfo::type.id: return RequestKind::node_info;
  case dronecan::ExecuteOpcode::type.id: return RequestKind::opcode;
  case dronecan::RestartNode::type.id: return RequestKind::restart;
  case GetSet::type.id: break;
  default: return std::nullopt;
  }
  const auto get_set = GetSet::Request::decode(request.payload);
  if (!get_set) {
    return std::nullopt;
  }
  return std::holds_alternative<GetSet::Empty>(get_set->value) ? RequestKind::read
                                                               : RequestKind::write;
}

bool RequestCounter::restarts_after(RequestKind kind) {
  const auto count = [this](RequestKind of) -> std::uint32_t& {
    return counts_.at(static_cast<std::size_t>(of));
  };
  ++count(RequestKind::any);
  ++count(kind);
  return std::ranges::any_of(faults_, [&](const RestartAfterAnswer& fault) {
    return (fault.to == RequestKind::any || fault.to == kind) && fault.number == count(fault.to);
  });
}

} // namespace blactl::sim
