#include "blactl/fleet/archive.hpp"

#include <optional>
#include <string_view>

namespace blactl::fleet {

using dronecan::GetNodeInfo;
using dronecan::GetSet;
using dronecan::Kind;
using dronecan::Outcome;
using dronecan::Transfer;

namespace {

/// The register that a GetSet request is about: a name wins over an index, which is the address
/// (specification 2.3). Empty: none of a BLA servo.
std::optional<bla::Address> address_of(const GetSet::Request& request) {
  if (!request.name.empty()) {
    return bla::find_address(request.name);
  }
  constexpr std::uint16_t most = 0xFF;
  return request.index <= most
             ? bla::find_address(bla::Address(static_cast<std::uint8_t>(request.index)).name())
             : std::nullopt;
}

} // namespace

void Archive::receive(const Transfer& transfer) {
  const auto& header = transfer.header;
  if (header.kind == Kind::request && header.data_type_id == GetSet::type.id) {
    receive_question(transfer);
  } else if (header.kind == Kind::response && header.data_type_id == GetSet::type.id) {
    receive_register(transfer);
  } else if (header.kind == Kind::response && header.data_type_id == GetNodeInfo::type.id &&
             GetNodeInfo::Response::decode(transfer.payload)) {
    keep(servers_[header.source].info, transfer);
  }
}

void Archive::receive_question(const Transfer& transfer) {
  const auto request = GetSet::Request::decode(transfer.payload);
  const auto address = request ? address_of(*request) : std::nullopt;
  auto& question = servers_[transfer.header.destination].questions[transfer.transfer_id];
  question = address ? Question{transfer.header.source, *address} : Question{};
}

void Archive::receive_register(const Transfer& transfer) {
  const auto response = GetSet::Response::decode(transfer.payload);
  if (!response) {
    return;
  }
  Server& server = servers_[transfer.header.source];
  const Question& question = server.questions[transfer.transfer_id];
  auto address = bla::find_address(response->name);
  if (response->name.empty() && question.client == transfer.header.destination) {
    address = question.address;
  }
  if (address) {
    keep(server.registers[*address], transfer);
  }
}

void Archive::keep(Answer& slot, const Transfer& transfer) {
  slot.payload.assign(transfer.payload.begin(), transfer.payload.end());
  slot.at = transfer.at;
  slot.boots = boots(transfer.header.source);
}

/// How often the node has restarted so far.
std::uint32_t Archive::boots(dronecan::NodeId node) const {
  const Member* member = roster_.find(node);
  return member != nullptr ? member->boots : 0;
}

const Archive::Answer* Archive::find(const dronecan::Request& request) const {
  const auto server = servers_.find(request.server);
  if (server == servers_.end()) {
    return nullptr;
  }
  if (request.type->id == GetNodeInfo::type.id) {
    return &server->second.info;
  }
  const auto get_set = request.type->id == GetSet::type.id
                           ? GetSet::Request::decode(request.payload.bytes())
                           : std::nullopt;
  if (!get_set || !std::holds_alternative<GetSet::Empty>(get_set->value)) {
    return nullptr;
  }
  const auto address = address_of(*get_set);
  const auto& registers = server->second.registers;
  const auto answer = address ? registers.find(*address) : registers.end();
  return answer != registers.end() ? &answer->second : nullptr;
}

Outcome Archive::answer(const dronecan::Request& request) const {
  const Answer* answer = find(request);
  const bool holds = answer != nullptr && !answer->payload.empty() &&
                     answer->boots == boots(request.server) &&
                     (!request.accepts || request.accepts(answer->payload));
  return holds ? Outcome{Outcome::Kind::answered, answer->payload, answer->at, answer->at}
               : Outcome{Outcome::Kind::not_recorded, {}, {}};
}

} // namespace blactl::fleet
