// The types of every node: status, information, address, restart; and which types there are.

#include "blactl/dronecan/types.hpp"

#include "dronecan/wire.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace blactl::dronecan {
namespace {

constexpr std::size_t max_node_name = 80;
constexpr std::size_t max_certificate = 255;

void put(Payload& payload, const NodeStatus& status) {
  const auto health = std::min(std::to_underlying(status.health), std::uint8_t{3});
  const auto mode = std::min(std::to_underlying(status.mode), std::uint8_t{7});
  const auto sub_mode = std::min(status.sub_mode, std::uint8_t{7});
  put_integer(payload, status.uptime_s, 4);
  put_integer(payload, static_cast<unsigned>(health << 6U | mode << 3U | sub_mode), 1);
  put_integer(payload, status.vendor_status, 2);
}

NodeStatus take_status(Reader& reader) {
  NodeStatus status;
  status.uptime_s = reader.u32();
  const auto bits = reader.u8();
  status.health = static_cast<Health>(bits >> 6U);
  status.mode = static_cast<Mode>((bits >> 3U) & 7U);
  status.sub_mode = bits & 7U;
  status.vendor_status = reader.u16();
  return status;
}

} // namespace

std::string_view name(Health health) {
  constexpr std::array<std::string_view, 4> words{"ok", "warning", "error", "critical"};
  return words[std::to_underlying(health) & 3U];
}

std::string_view name(Mode mode) {
  switch (mode) {
  case Mode::operational: return "operational";
  case Mode::initialization: return "initialization";
  case Mode::maintenance: return "maintenance";
  case Mode::software_update: return "software_update";
  case Mode::offline: return "offline";
  }
  return {};
}

Payload NodeStatus::encode() const {
  Payload payload;
  put(payload, *this);
  return payload;
}

std::optional<NodeStatus> NodeStatus::decode(Bytes payload) {
  Reader reader(payload);
  const auto status = take_status(reader);
  return reader.ok() ? std::optional(status) : std::nullopt;
}

Payload GetNodeInfo::Response::encode() const {
  Payload payload;
  put(payload, status);
  payload.append(software_major);
  payload.append(software_minor);
  payload.append(optional_field_flags);
  put_integer(payload, vcs_commit, 4);
  put_integer(payload, image_crc, 8);
  payload.append(hardware_major);
  payload.append(hardware_minor);
  payload.append(unique_id);
  const auto shown = Bytes(certificate).first(std::min(certificate.size(), max_certificate));
  put_integer(payload, shown.size(), 1);
  payload.append(shown);
  put_text(payload, name, max_node_name);
  return payload;
}

std::optional<GetNodeInfo::Response> GetNodeInfo::Response::decode(Bytes payload) {
  Reader reader(payload);
  Response response;
  response.status = take_status(reader);
  response.software_major = reader.u8();
  response.software_minor = reader.u8();
  response.optional_field_flags = reader.u8();
  response.vcs_commit = reader.u32();
  response.image_crc = reader.u64();
  response.hardware_major = reader.u8();
  response.hardware_minor = reader.u8();
  std::ranges::copy(reader.take(response.unique_id.size()), response.unique_id.begin());
  const auto certificate = reader.take(reader.u8());
  response.certificate.assign(certificate.begin(), certificate.end());
  response.name = reader.text_to_end(max_node_name);
  return reader.ok() ? std::optional(std::move(response)) : std::nullopt;
}

Payload Allocation::encode() const {
  Payload payload;
  const auto id = std::min(node_id, NodeId::max);
  put_integer(payload, (unsigned{id} << 1U) | (first_part_of_unique_id ? 1U : 0U), 1);
  payload.append(Bytes(unique_id).first(std::min<std::size_t>(size, unique_id.size())));
  return payload;
}

std::optional<Allocation> Allocation::decode(Bytes payload) {
  Reader reader(payload);
  Allocation allocation;
  const auto bits = reader.u8();
  allocation.node_id = bits >> 1U;
  allocation.first_part_of_unique_id = (bits & 1U) != 0;
  const auto part = reader.rest();
  if (!reader.ok() || part.size() > allocation.unique_id.size()) {
    return std::nullopt;
  }
  allocation.size = static_cast<std::uint8_t>(part.size());
  std::ranges::copy(part, allocation.unique_id.begin());
  return allocation;
}

Payload RestartNode::Request::encode() const {
  constexpr std::uint64_t max = 0xFF'FFFF'FFFF;
  Payload payload;
  put_integer(payload, std::min(magic_number, max), 5);
  return payload;
}

std::optional<RestartNode::Request> RestartNode::Request::decode(Bytes payload) {
  Reader reader(payload);
  const Request request{.magic_number = reader.integer(5)};
  return reader.ok() ? std::optional(request) : std::nullopt;
}

Payload RestartNode::Response::encode() const {
  Payload payload;
  payload.append(ok ? true_bit : std::uint8_t{0});
  return payload;
}

std::optional<RestartNode::Response> RestartNode::Response::decode(Bytes payload) {
  Reader reader(payload);
  const Response response{.ok = (reader.u8() & true_bit) != 0};
  return reader.ok() ? std::optional(response) : std::nullopt;
}

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
