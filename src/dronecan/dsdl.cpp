// The fields of the data types, by hand from their DSDL: those of the BLA specification (section
// 2.3), and others that occur on the bus of a drone.

#include "dronecan/dsdl.hpp"

#include <algorithm>
#include <array>
#include <tuple>

namespace blactl::dronecan::dsdl {
namespace {

using Word = std::string_view;

// uavcan/protocol/341.NodeStatus.uavcan
constexpr std::array<Word, 4> health{"ok", "warning", "error", "critical"};
constexpr std::array<Word, 8> mode{
    "operational", "initialization", "maintenance", "software_update", "", "", "", "offline"};
constexpr std::array node_status{natural("uptime_sec", 32), natural("health", 2, health),
                                 natural("mode", 3, mode), natural("sub_mode", 3),
                                 natural("vendor_specific_status_code", 16)};

// uavcan/protocol/1.GetNodeInfo.uavcan, SoftwareVersion.uavcan, HardwareVersion.uavcan
constexpr std::array software_version{natural("major", 8), natural("minor", 8),
                                      natural("optional_field_flags", 8), natural("vcs_commit", 32),
                                      natural("image_crc", 64)};
constexpr std::array hardware_version{natural("major", 8), natural("minor", 8),
                                      fixed_bytes("unique_id", 16),
                                      bytes("certificate_of_authenticity", 255)};
constexpr std::array node_info{structure("status", node_status),
                               structure("software_version", software_version),
                               structure("hardware_version", hardware_version), text("name", 80)};

// uavcan/protocol/dynamic_node_id/1.Allocation.uavcan
constexpr std::array allocation{natural("node_id", 7), truth("first_part_of_unique_id"),
                                bytes("unique_id", 16)};

// uavcan/protocol/4.GlobalTimeSync.uavcan, 5.Panic.uavcan
constexpr std::array global_time_sync{natural("previous_transmission_timestamp_usec", 56)};
constexpr std::array panic{text("reason_text", 7)};

// uavcan/protocol/4.GetTransportStats.uavcan, CANIfaceStats.uavcan
constexpr std::array can_interface_stats{natural("frames_tx", 48), natural("frames_rx", 48),
                                         natural("errors", 48)};
constexpr std::array transport_stats{natural("transfers_tx", 48), natural("transfers_rx", 48),
                                     natural("transfer_errors", 48),
                                     up_to(3, structure("can_iface_stats", can_interface_stats))};

// uavcan/protocol/5.RestartNode.uavcan
constexpr std::array restart_request{natural("magic_number", 40)};
constexpr std::array ok_only{truth("ok")};

// uavcan/protocol/param/10.ExecuteOpcode.uavcan
constexpr std::array<Word, 2> opcode{"save", "erase"};
constexpr std::array opcode_request{natural("opcode", 8, opcode), integer("argument", 48)};
constexpr std::array opcode_response{integer("argument", 48), truth("ok")};

// uavcan/protocol/param/11.GetSet.uavcan, Value.uavcan, NumericValue.uavcan
constexpr std::array value{empty("empty"), integer("integer_value", 64), real("real_value", 32),
                           natural("boolean_value", 8), text("string_value", 128)};
constexpr std::array numeric_value{empty("empty"), integer("integer_value", 64),
                                   real("real_value", 32)};
constexpr std::array get_set_request{natural("index", 13), choice("value", value),
                                     text("name", 92)};
constexpr std::array get_set_response{padding(5),      choice("value", value),
                                      padding(5),      choice("default_value", value),
                                      padding(6),      choice("max_value", numeric_value),
                                      padding(6),      choice("min_value", numeric_value),
                                      text("name", 92)};

// uavcan/protocol/file/40.BeginFirmwareUpdate.uavcan, Path.uavcan
constexpr std::array path{text("path", 200)};
constexpr std::array firmware_request{natural("source_node_id", 8),
                                      structure("image_file_remote_path", path)};
constexpr std::array firmware_response{natural("error", 8), text("optional_error_message", 127)};

// uavcan/protocol/debug/16370.KeyValue.uavcan, 16383.LogMessage.uavcan, LogLevel.uavcan
constexpr std::array<Word, 4> level{"debug", "info", "warning", "error"};
constexpr std::array log_level{natural("value", 3, level)};
constexpr std::array key_value{real("value", 32), text("key", 58)};
constexpr std::array log_message{structure("level", log_level), text("source", 31),
                                 text("text", 90)};

// uavcan/equipment/actuator/1010.ArrayCommand.uavcan, Command.uavcan, 1011.Status.uavcan
constexpr std::array<Word, 5> command_type{"unitless", "position", "force", "speed", "pwm"};
constexpr std::array command{natural("actuator_id", 8), natural("command_type", 8, command_type),
                             real("command_value", 16)};
constexpr std::array array_command{up_to(15, structure("commands", command))};
constexpr std::array actuator_status{
    natural("actuator_id", 8), real("position", 16), real("force", 16),
    real("speed", 16),         padding(1),           natural("power_rating_pct", 7)};

// uavcan/equipment/esc/1030.RawCommand.uavcan, 1031.RPMCommand.uavcan, 1034.Status.uavcan
constexpr std::array raw_command{up_to(20, integer("cmd", 14))};
constexpr std::array rpm_command{up_to(20, integer("rpm", 18))};
constexpr std::array esc_status{natural("error_count", 32), real("voltage", 16),
                                real("current", 16),        real("temperature", 16),
                                integer("rpm", 18),         natural("power_rating_pct", 7),
                                natural("esc_index", 5)};

// uavcan/equipment/power/1091.CircuitStatus.uavcan
constexpr std::array circuit_status{natural("circuit_id", 16), real("voltage", 16),
                                    real("current", 16), natural("error_flags", 8)};

// uavcan/equipment/safety/1100.ArmingStatus.uavcan
constexpr std::array arming_status{natural("status", 8)};

struct Known {
  Kind kind;
  std::uint16_t id;
  std::span<const Field> fields;
};

constexpr auto order(const Known& type) {
  return std::tuple(type.kind, type.id);
}

constexpr auto all = std::to_array<Known>({
    {Kind::message, 1, allocation},
    {Kind::message, 4, global_time_sync},
    {Kind::message, 5, panic},
    {Kind::message, 341, node_status},
    {Kind::message, 1010, array_command},
    {Kind::message, 1011, actuator_status},
    {Kind::message, 1030, raw_command},
    {Kind::message, 1031, rpm_command},
    {Kind::message, 1034, esc_status},
    {Kind::message, 1091, circuit_status},
    {Kind::message, 1100, arming_status},
    {Kind::message, 16370, key_value},
    {Kind::message, 16383, log_message},
    {Kind::request, 1, {}},
    {Kind::request, 4, {}},
    {Kind::request, 5, restart_request},
    {Kind::request, 10, opcode_request},
    {Kind::request, 11, get_set_request},
    {Kind::request, 40, firmware_request},
    {Kind::response, 1, node_info},
    {Kind::response, 4, transport_stats},
    {Kind::response, 5, ok_only},
    {Kind::response, 10, opcode_response},
    {Kind::response, 11, get_set_response},
    {Kind::response, 40, firmware_response},
});

static_assert(std::ranges::is_sorted(all, {}, order));

} // namespace

const std::span<const Field>* find_fields(Kind kind, std::uint16_t data_type_id) {
  const std::tuple wanted(kind, data_type_id);
  const auto it = std::ranges::lower_bound(all, wanted, {}, order);
  return it != all.end() && order(*it) == wanted ? &it->fields : nullptr;
}

} // namespace blactl::dronecan::dsdl
