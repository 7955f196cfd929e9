#pragma once
// The data types as the test vectors write them: JSON by the names of the DSDL, floats that JSON
// does not know as "nan", "inf", "-inf".

#include "blactl/dronecan/types.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace blactl::dronecan::test {

using Json = nlohmann::json;

inline Json from_float(float value) {
  if (std::isnan(value)) {
    return "nan";
  }
  if (std::isinf(value)) {
    return value > 0 ? "inf" : "-inf";
  }
  return static_cast<double>(value);
}

inline float to_float(const Json& json) {
  return json.is_string() ? std::stof(json.get<std::string>()) : json.get<float>();
}

inline Json from_text(const std::string& text) {
  Json array = Json::array();
  for (const char c : text) {
    array.push_back(static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return array;
}

inline std::string to_text(const Json& json) {
  const auto bytes = json.get<std::vector<std::uint8_t>>();
  return {bytes.begin(), bytes.end()};
}

struct UnionToJson {
  Json operator()(std::monostate) const { return {{"empty", Json::object()}}; }

  Json operator()(std::int64_t value) const { return {{"integer_value", value}}; }

  Json operator()(float value) const { return {{"real_value", from_float(value)}}; }

  Json operator()(bool value) const { return {{"boolean_value", value ? 1 : 0}}; }

  Json operator()(const std::string& value) const { return {{"string_value", from_text(value)}}; }
};

inline GetSet::NumericValue to_numeric(const Json& json) {
  if (json.contains("integer_value")) {
    return json["integer_value"].get<std::int64_t>();
  }
  if (json.contains("real_value")) {
    return to_float(json["real_value"]);
  }
  return GetSet::Empty{};
}

inline GetSet::Value to_value(const Json& json) {
  if (json.contains("boolean_value")) {
    return json["boolean_value"].get<int>() != 0;
  }
  if (json.contains("string_value")) {
    return to_text(json["string_value"]);
  }
  return std::visit([](auto value) { return GetSet::Value(value); }, to_numeric(json));
}

inline Json fields(const NodeStatus& status) {
  return {{"uptime_sec", status.uptime_s},
          {"health", std::to_underlying(status.health)},
          {"mode", std::to_underlying(status.mode)},
          {"sub_mode", status.sub_mode},
          {"vendor_specific_status_code", status.vendor_status}};
}

inline void read(const Json& json, NodeStatus& status) {
  status = {json["uptime_sec"], static_cast<Health>(json["health"].get<int>()),
            static_cast<Mode>(json["mode"].get<int>()), json["sub_mode"],
            json["vendor_specific_status_code"]};
}

inline Json fields(const GetNodeInfo::Request&) {
  return Json::object();
}

inline void read(const Json&, GetNodeInfo::Request&) {}

inline Json fields(const GetNodeInfo::Response& info) {
  return {{"status", fields(info.status)},
          {"software_version",
           {{"major", info.software_major},
            {"minor", info.software_minor},
            {"optional_field_flags", info.optional_field_flags},
            {"vcs_commit", info.vcs_commit},
            {"image_crc", info.image_crc}}},
          {"hardware_version",
           {{"major", info.hardware_major},
            {"minor", info.hardware_minor},
            {"unique_id", info.unique_id},
            {"certificate_of_authenticity", info.certificate}}},
          {"name", from_text(info.name)}};
}

inline void read(const Json& json, GetNodeInfo::Response& info) {
  const auto& software = json["software_version"];
  const auto& hardware = json["hardware_version"];
  read(json["status"], info.status);
  info.software_major = software["major"];
  info.software_minor = software["minor"];
  info.optional_field_flags = software["optional_field_flags"];
  info.vcs_commit = software["vcs_commit"];
  info.image_crc = software["image_crc"];
  info.hardware_major = hardware["major"];
  info.hardware_minor = hardware["minor"];
  hardware["unique_id"].get_to(info.unique_id);
  hardware["certificate_of_authenticity"].get_to(info.certificate);
  info.name = to_text(json["name"]);
}

inline Json fields(const Allocation& allocation) {
  const auto part = Bytes(allocation.unique_id).first(allocation.size);
  return {{"node_id", allocation.node_id},
          {"first_part_of_unique_id", allocation.first_part_of_unique_id},
          {"unique_id", std::vector<std::uint8_t>(part.begin(), part.end())}};
}

inline void read(const Json& json, Allocation& allocation) {
  allocation.node_id = json["node_id"];
  allocation.first_part_of_unique_id = json["first_part_of_unique_id"];
  const auto part = json["unique_id"].get<std::vector<std::uint8_t>>();
  allocation.size = static_cast<std::uint8_t>(part.size());
  std::ranges::copy(part, allocation.unique_id.begin());
}

inline Json fields(const RestartNode::Request& request) {
  return {{"magic_number", request.magic_number}};
}

inline void read(const Json& json, RestartNode::Request& request) {
  request.magic_number = json["magic_number"];
}

inline Json fields(const RestartNode::Response& response) {
  return {{"ok", response.ok}};
}

inline void read(const Json& json, RestartNode::Response& response) {
  response.ok = json["ok"];
}

inline Json fields(const ExecuteOpcode::Request& request) {
  return {{"opcode", request.opcode}, {"argument", request.argument}};
}

inline void read(const Json& json, ExecuteOpcode::Request& request) {
  request = {json["opcode"], json["argument"]};
}

inline Json fields(const ExecuteOpcode::Response& response) {
  return {{"argument", response.argument}, {"ok", response.ok}};
}

inline void read(const Json& json, ExecuteOpcode::Response& response) {
  response = {json["argument"], json["ok"]};
}

inline Json fields(const GetSet::Request& request) {
  return {{"index", request.index},
          {"value", std::visit(UnionToJson{}, request.value)},
          {"name", from_text(request.name)}};
}

inline void read(const Json& json, GetSet::Request& request) {
  request = {json["index"], to_value(json["value"]), to_text(json["name"])};
}

inline Json fields(const GetSet::Response& response) {
  return {{"value", std::visit(UnionToJson{}, response.value)},
          {"default_value", std::visit(UnionToJson{}, response.default_value)},
          {"max_value", std::visit(UnionToJson{}, response.max_value)},
          {"min_value", std::visit(UnionToJson{}, response.min_value)},
          {"name", from_text(response.name)}};
}

inline void read(const Json& json, GetSet::Response& response) {
  response = {to_value(json["value"]), to_value(json["default_value"]),
              to_numeric(json["max_value"]), to_numeric(json["min_value"]), to_text(json["name"])};
}

inline Json fields(const ArrayCommand& array) {
  Json commands = Json::array();
  for (const auto& command : array.commands) {
    commands.push_back({{"actuator_id", command.actuator_id},
                        {"command_type", command.command_type},
                        {"command_value", from_float(command.value)}});
  }
  return {{"commands", commands}};
}

inline void read(const Json& json, ArrayCommand& array) {
  for (const auto& command : json["commands"]) {
    array.commands.push_back(
        {command["actuator_id"], command["command_type"], to_float(command["command_value"])});
  }
}

inline Json fields(const ActuatorStatus& status) {
  return {{"actuator_id", status.actuator_id},
          {"position", from_float(status.position)},
          {"force", from_float(status.force)},
          {"speed", from_float(status.speed)},
          {"power_rating_pct", status.power_rating_pct}};
}

inline void read(const Json& json, ActuatorStatus& status) {
  status = {json["actuator_id"], to_float(json["position"]), to_float(json["force"]),
            to_float(json["speed"]), json["power_rating_pct"]};
}

/// A data type between JSON and payload.
struct Codec {
  Payload (*encode)(const Json& fields);
  std::optional<Json> (*decode)(Bytes payload); ///< empty: refused
};

template <class Type> Codec codec() {
  return {[](const Json& json) {
            Type value;
            read(json, value);
            return value.encode();
          },
          [](Bytes payload) {
            const auto value = Type::decode(payload);
            return value ? std::optional(fields(*value)) : std::nullopt;
          }};
}

inline const Codec& find_codec(Kind kind, std::uint16_t data_type_id) {
  using enum Kind;
  static const std::map<std::pair<Kind, std::uint16_t>, Codec> codecs{
      {{message, NodeStatus::type.id}, codec<NodeStatus>()},
      {{message, Allocation::type.id}, codec<Allocation>()},
      {{message, ArrayCommand::type.id}, codec<ArrayCommand>()},
      {{message, ActuatorStatus::type.id}, codec<ActuatorStatus>()},
      {{request, GetNodeInfo::type.id}, codec<GetNodeInfo::Request>()},
      {{response, GetNodeInfo::type.id}, codec<GetNodeInfo::Response>()},
      {{request, RestartNode::type.id}, codec<RestartNode::Request>()},
      {{response, RestartNode::type.id}, codec<RestartNode::Response>()},
      {{request, ExecuteOpcode::type.id}, codec<ExecuteOpcode::Request>()},
      {{response, ExecuteOpcode::type.id}, codec<ExecuteOpcode::Response>()},
      {{request, GetSet::type.id}, codec<GetSet::Request>()},
      {{response, GetSet::type.id}, codec<GetSet::Response>()},
  };
  return codecs.at({kind, data_type_id});
}

} // namespace blactl::dronecan::test
