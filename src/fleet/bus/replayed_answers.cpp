#include "blactl/fleet/bus/replayed_answers.hpp"

#include <algorithm>
#include <optional>

namespace blactl::fleet {

using dronecan::ExecuteOpcode;
using dronecan::GetNodeInfo;
using dronecan::GetSet;
using dronecan::Kind;
using dronecan::Outcome;
using dronecan::RestartNode;
using dronecan::Transfer;

namespace {

/// The register of a GetSet request: a name takes precedence over an index, which is the address
/// (specification 2.3). Empty: not one of a BLA servo.
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

/// ERASE sets the commands to 0, too (4.9).
ReplayedAnswers::Moment ReplayedAnswers::unchanged_since(const Server& server,
                                                         bla::Address address) const {
  const bool is_erasable =
      roster_.profiles().is_setting(address) ||
      std::ranges::find(bla::command_registers, address) != bla::command_registers.end();
  const auto write = server.written.find(address);
  return std::max({server.restarted, is_erasable ? server.erased : 0,
                   write != server.written.end() ? write->second : 0});
}

void ReplayedAnswers::receive(const Transfer& transfer) {
  ++now_;
  const auto& header = transfer.header;
  if (header.kind == Kind::request) {
    receive_request(transfer);
  } else if (header.kind == Kind::response && header.data_type_id == GetSet::type.id) {
    receive_register(transfer);
  } else if (header.kind == Kind::response && header.data_type_id == GetNodeInfo::type.id &&
             GetNodeInfo::Response::decode(transfer.payload)) {
    keep(servers_[header.source].info, transfer, now_);
  }
}

void ReplayedAnswers::receive_request(const Transfer& transfer) {
  const auto& header = transfer.header;
  if (header.data_type_id == GetSet::type.id) {
    receive_question(transfer);
  } else if (header.data_type_id == RestartNode::type.id) {
    servers_[header.destination].restarted = now_;
  } else if (header.data_type_id == ExecuteOpcode::type.id) {
    const auto request = ExecuteOpcode::Request::decode(transfer.payload);
    Server& server = servers_[header.destination];
    if (request && request->opcode == ExecuteOpcode::erase) {
      server.erased = now_;
    } else if (request && request->opcode == ExecuteOpcode::save) {
      server.restarted = now_;
    }
  }
}

void ReplayedAnswers::receive_question(const Transfer& transfer) {
  Server& server = servers_[transfer.header.destination];
  const std::pair asked_by(transfer.header.source, transfer.transfer_id);
  const auto request = GetSet::Request::decode(transfer.payload);
  const auto address = request ? address_of(*request) : std::nullopt;
  if (!address) {
    server.questions.erase(asked_by);
    return;
  }
  server.questions[asked_by] = {*address, now_};
  if (std::holds_alternative<GetSet::Empty>(request->value)) {
    return;
  }
  namespace at = bla::address;
  if (*address == at::initialize) {
    server.erased = now_;
  } else if (*address == at::reboot || *address == at::write_rom) {
    server.restarted = now_;
  } else {
    server.written[*address] = now_;
  }
}

void ReplayedAnswers::receive_register(const Transfer& transfer) {
  const auto response = GetSet::Response::decode(transfer.payload);
  if (!response) {
    return;
  }
  Server& server = servers_[transfer.header.source];
  const auto question = server.questions.find({transfer.header.destination, transfer.transfer_id});
  const bool is_known = question != server.questions.end();
  auto address = bla::find_address(response->name);
  if (response->name.empty() && is_known) {
    address = question->second.address;
  }
  if (address) {
    const bool is_about_it = is_known && question->second.address == *address;
    keep(server.registers[*address], transfer, is_about_it ? question->second.at : now_);
  }
}

void ReplayedAnswers::keep(Answer& slot, const Transfer& transfer, Moment asked) {
  slot.payload.assign(transfer.payload.begin(), transfer.payload.end());
  slot.at = transfer.at;
  slot.boots = boots(transfer.header.source);
  slot.asked = asked;
}

void ReplayedAnswers::recall(dronecan::NodeId node, bla::Address address, std::int64_t raw) {
  const auto payload = GetSet::Response{.value = raw, .name = address.name()}.encode();
  Answer& slot = servers_[node].registers[address];
  slot.payload.assign(payload.bytes().begin(), payload.bytes().end());
  slot.boots = boots(node);
}

/// The number of restarts of the node so far.
std::uint32_t ReplayedAnswers::boots(dronecan::NodeId node) const {
  const Member* member = roster_.find(node);
  return member != nullptr ? member->boots : 0;
}

const ReplayedAnswers::Answer* ReplayedAnswers::find(const dronecan::Request& request) const {
  const auto server = servers_.find(request.server);
  if (server == servers_.end()) {
    return nullptr;
  }
  const Server& held = server->second;
  if (request.type->id == GetNodeInfo::type.id) {
    return held.info.asked >= held.restarted ? &held.info : nullptr;
  }
  const auto get_set = request.type->id == GetSet::type.id
                           ? GetSet::Request::decode(request.payload.bytes())
                           : std::nullopt;
  if (!get_set || !std::holds_alternative<GetSet::Empty>(get_set->value)) {
    return nullptr;
  }
  const auto address = address_of(*get_set);
  const auto answer = address ? held.registers.find(*address) : held.registers.end();
  const bool is_valid =
      answer != held.registers.end() && answer->second.asked >= unchanged_since(held, *address);
  return is_valid ? &answer->second : nullptr;
}

Outcome ReplayedAnswers::answer(const dronecan::Request& request) const {
  const Answer* answer = find(request);
  const bool holds = answer != nullptr && !answer->payload.empty() &&
                     answer->boots == boots(request.server) &&
                     (!request.accepts || request.accepts(answer->payload));
  return holds ? Outcome{Outcome::Kind::answered, answer->payload, answer->at, answer->at}
               : Outcome{Outcome::Kind::not_recorded, {}, {}};
}

} // namespace blactl::fleet
