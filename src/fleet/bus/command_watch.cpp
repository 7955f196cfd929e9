#include "blactl/fleet/bus/command_watch.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace blactl::fleet {

using dronecan::Kind;
using dronecan::NodeId;
using dronecan::Transfer;

namespace {

/// ERASE writes all of them; so may a name that is not one of ours.
constexpr std::optional<bla::Address> every_register{};
constexpr std::uint16_t last_index = 0xFF;

bool is_at(const dronecan::GetSet::Request& request, bla::Address address) {
  // a name takes precedence over an index, which is the address
  return request.name.empty() ? request.index == address.value() : request.name == address.name();
}

std::optional<bla::Address> register_of(const dronecan::GetSet::Request& request) {
  return request.name.empty() ? std::optional(bla::Address(
                                    static_cast<std::uint8_t>(std::min(request.index, last_index))))
                              : bla::find_address(request.name);
}

} // namespace

void Repeated::hear(Time at, Duration usual) {
  constexpr int periods = 3;
  const bool is_first = lasts_ == Duration::zero();
  const Duration since = is_first ? usual / periods : at - at_;
  if (!is_first) {
    shortest_ = std::min(shortest_.value_or(since), since);
  }
  lasts_ = is_first ? usual : std::clamp<Duration>(periods * std::max(since, since_), least, most);
  since_ = since;
  at_ = at;
}

void Commander::Command::ask(const std::optional<MotionCommand>& command) {
  if (!command) {
    asked.reset();
  } else if (!asked || asked->reg != command->reg) {
    asked = {.reg = command->reg, .least = command->raw, .greatest = command->raw};
  } else {
    asked->least = std::min(asked->least, command->raw);
    asked->greatest = std::max(asked->greatest, command->raw);
  }
}

void CommandWatch::receive(const Transfer& transfer) {
  const auto& header = transfer.header;
  const auto is = [&](Kind kind, const dronecan::DataType& type) {
    return header.kind == kind && header.data_type_id == type.id;
  };
  if (is(Kind::request, dronecan::GetSet::type)) {
    on_write(transfer);
  } else if (is(Kind::request, dronecan::ExecuteOpcode::type)) {
    on_opcode(transfer);
  } else if (is(Kind::request, dronecan::RestartNode::type)) {
    on_restart(transfer);
  } else if (is(Kind::message, dronecan::ArrayCommand::type)) {
    on_command(transfer);
  } else if (is(Kind::message, dronecan::ArmingStatus::type)) {
    on_arming(transfer);
  }
}

Commander& CommandWatch::commander(NodeId source) {
  Commander& known = commanders_[source];
  known.source = source;
  return known;
}

void CommandWatch::on_command(const Transfer& transfer) {
  const auto command = dronecan::ArrayCommand::decode(transfer.payload);
  if (!command) {
    return;
  }
  for (const auto& entry : command->commands) {
    auto& known = commander(transfer.header.source).servo_ids[entry.actuator_id];
    known.heard.hear(transfer.at);
    known.type = entry.command_type;
    known.ask(motion_command(entry));
  }
}

/// Each node counts for itself: a disarmed one does not disarm another.
void CommandWatch::on_arming(const Transfer& transfer) {
  if (const auto arming = dronecan::ArmingStatus::decode(transfer.payload)) {
    const NodeId source = transfer.header.source;
    if (arming->status == dronecan::ArmingStatus::disarmed) {
      armed_.erase(source);
    } else {
      armed_[source].hear(transfer.at, Repeated::most);
    }
  }
}

void CommandWatch::on_write(const Transfer& transfer) {
  const auto request = dronecan::GetSet::Request::decode(transfer.payload);
  if (!request || std::holds_alternative<dronecan::GetSet::Empty>(request->value)) {
    return;
  }
  namespace at = bla::address;
  const auto& [source, server] = std::pair(transfer.header.source, transfer.header.destination);
  const auto command = std::ranges::find_if(bla::command_registers,
                                            [&](bla::Address reg) { return is_at(*request, reg); });
  if (command != bla::command_registers.end()) {
    Commander::Command& known = commander(source).nodes[server];
    const auto* raw = std::get_if<std::int64_t>(&request->value);
    known.heard.hear(transfer.at);
    known.ask(raw != nullptr ? std::optional(MotionCommand{*command, *raw}) : std::nullopt);
  } else if (is_at(*request, at::initialize)) {
    writes_[server][every_register] = {source, transfer.at};
  } else if (is_at(*request, at::reboot)) {
    restarts_[server] = {source, transfer.at};
  } else if (is_at(*request, at::write_rom)) {
    saves_[server] = {source, transfer.at};
  } else {
    write(transfer, register_of(*request), request->value);
  }
}

/// Of a value that was heard twice the servo may still have lost one.
void CommandWatch::write(const Transfer& transfer, Register reg,
                         const dronecan::GetSet::Value& value) {
  constexpr int times_to_be_sure = 2;
  const NodeId server = transfer.header.destination;
  Repetition& known = repetitions_[server][reg];
  const bool goes_on = reg != every_register && known.times > 0 && known.value == value &&
                       known.last > disturbed(server, reg);
  known = {.value = value, .last = transfer.at, .times = goes_on ? known.times + 1 : 1};
  if (known.times <= times_to_be_sure) {
    writes_[server][reg] = {transfer.header.source, transfer.at};
  }
}

/// The time of that write; before all others: there was none.
Time CommandWatch::last(const Writes& writes, NodeId server, Register reg) {
  const auto of_server = writes.find(server);
  if (of_server == writes.end()) {
    return Time::min();
  }
  const auto write = of_server->second.find(reg);
  return write != of_server->second.end() ? write->second.at : Time::min();
}

/// When something else may have changed this register, beside writes of others to it.
Time CommandWatch::disturbed(NodeId server, Register reg) const {
  const auto restart = restarts_.find(server);
  return std::max({last(writes_, server, every_register), last(others_, server, every_register),
                   last(others_, server, reg),
                   restart != restarts_.end() ? restart->second.at : Time::min()});
}

void CommandWatch::ask(const dronecan::Request& request, Time at) {
  if (request.type == &dronecan::ExecuteOpcode::type ||
      request.type == &dronecan::RestartNode::type) {
    others_[request.server][every_register].at = at;
  } else if (request.type == &dronecan::GetSet::type) {
    const auto sent = dronecan::GetSet::Request::decode(request.payload.bytes());
    if (sent && !std::holds_alternative<dronecan::GetSet::Empty>(sent->value)) {
      others_[request.server][register_of(*sent)].at = at;
    }
  }
}

void CommandWatch::on_opcode(const Transfer& transfer) {
  const auto request = dronecan::ExecuteOpcode::Request::decode(transfer.payload);
  const Write write{transfer.header.source, transfer.at};
  if (request && request->opcode == dronecan::ExecuteOpcode::erase) {
    writes_[transfer.header.destination][every_register] = write;
  } else if (request && request->opcode == dronecan::ExecuteOpcode::save) {
    saves_[transfer.header.destination] = write;
  }
}

/// A node obeys the magic number only.
void CommandWatch::on_restart(const Transfer& transfer) {
  using dronecan::RestartNode;
  const auto request = RestartNode::Request::decode(transfer.payload);
  if (request && request->magic_number == RestartNode::magic) {
    restarts_[transfer.header.destination] = {transfer.header.source, transfer.at};
  }
}

std::optional<NodeId> CommandWatch::saver_of(NodeId id, Time since) const {
  const auto save = saves_.find(id);
  return save != saves_.end() && save->second.at > since ? std::optional(save->second.source)
                                                         : std::nullopt;
}

std::optional<NodeId> CommandWatch::armed_by(Time now) const {
  const auto armed =
      std::ranges::find_if(armed_, [&](const auto& entry) { return entry.second.counts(now); });
  return armed == armed_.end() ? std::nullopt : std::optional(armed->first);
}

std::optional<NodeId> CommandWatch::giver_of(bla::Address reg, std::int64_t value, NodeId except,
                                             Time since) const {
  for (const auto& [server, registers] : repetitions_) {
    const auto given = registers.find(reg);
    const auto* raw =
        given != registers.end() ? std::get_if<std::int64_t>(&given->second.value) : nullptr;
    if (server != except && raw != nullptr && *raw == value && given->second.last > since) {
      return server;
    }
  }
  return std::nullopt;
}

std::optional<NodeId> CommandWatch::writer_to(NodeId id, Time since,
                                              std::optional<bla::Address> reg) const {
  const auto restart = restarts_.find(id);
  return restart != restarts_.end() && restart->second.at > since
             ? std::optional(restart->second.source)
             : setter_of(id, since, reg);
}

std::optional<NodeId> CommandWatch::setter_of(NodeId id, Time since,
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

std::vector<CommandWatch::Written> CommandWatch::written_to(NodeId id, Time since) const {
  std::vector<Written> all;
  const auto writes = writes_.find(id);
  const auto values = repetitions_.find(id);
  if (writes == writes_.end() || values == repetitions_.end()) {
    return all;
  }
  for (const auto& [reg, write] : writes->second) {
    const auto value = values->second.find(reg);
    const auto* raw =
        value != values->second.end() ? std::get_if<std::int64_t>(&value->second.value) : nullptr;
    if (reg && raw != nullptr && write.at > since) {
      all.push_back({*reg, *raw, write.source, write.at});
    }
  }
  return all;
}

std::optional<NodeId>
CommandWatch::commander_of(const Servo& servo, std::optional<std::uint8_t> actuator_id,
                           const std::function<bool(const Repeated&)>& matters) const {
  for (const auto& [source, commander] : commanders_) {
    const auto by_node = commander.nodes.find(servo.id);
    if (by_node != commander.nodes.end() && matters(by_node->second.heard)) {
      return source;
    }
    for (const auto& [servo_id, command] : commander.servo_ids) {
      constexpr std::uint8_t every_servo = 255;
      // register and actuator.Status may differ: it is not known which of them it obeys
      const bool is_meant =
          servo_id == every_servo || servo.servo_id == servo_id || actuator_id == servo_id;
      if (is_meant && matters(command.heard)) {
        return source;
      }
    }
  }
  return std::nullopt;
}

std::optional<NodeId> CommandWatch::commander_of_id(std::int64_t servo_id, Time now) const {
  for (const auto& [source, commander] : commanders_) {
    const auto command = std::ranges::find(commander.servo_ids, servo_id,
                                           [](const auto& entry) { return entry.first; });
    if (command != commander.servo_ids.end() && command->second.heard.counts(now)) {
      return source;
    }
  }
  return std::nullopt;
}

} // namespace blactl::fleet
