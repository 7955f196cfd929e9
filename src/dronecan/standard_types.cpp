#include "blactl/dronecan/standard_types.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace blactl::dronecan {
namespace {

using Order = std::pair<bool, std::uint16_t>;

constexpr Order order(const DataType& type) {
  return {type.service, type.id};
}

// clang-format off
constexpr auto types = std::to_array<DataType>({
    {"uavcan.protocol.dynamic_node_id.Allocation", 1, false, 0x0B2A812620A11D40},
    {"uavcan.protocol.GlobalTimeSync", 4, false, 0x20271116A793C2DB},
    {"uavcan.protocol.Panic", 5, false, 0x8B79B4101811C1D7},
    {"uavcan.protocol.NodeStatus", 341, false, 0x0F0868D0C1A7C6F1},
    {"dronecan.protocol.Stats", 342, false, 0x763AE3B8A986F8D1},
    {"dronecan.protocol.CanStats", 343, false, 0xCE080CAE3CA33C75},
    {"dronecan.protocol.GlobalTime", 344, false, 0xA55177448A490F33},
    {"uavcan.protocol.enumeration.Indication", 380, false, 0x884CB63050A84F35},
    {"uavcan.protocol.dynamic_node_id.server.Discovery", 390, false, 0x821AE2F525F69F21},
    {"uavcan.equipment.ahrs.Solution", 1000, false, 0x72A63A3C6F41FA9B},
    {"uavcan.equipment.ahrs.MagneticFieldStrength", 1001, false, 0xE2A7D4A9460BC2F2},
    {"uavcan.equipment.ahrs.MagneticFieldStrength2", 1002, false, 0xB6AC0C442430297E},
    {"uavcan.equipment.ahrs.RawIMU", 1003, false, 0x8280632C40E574B5},
    {"uavcan.equipment.actuator.ArrayCommand", 1010, false, 0xD8A7486238EC3AF3},
    {"uavcan.equipment.actuator.Status", 1011, false, 0x5E9BBA44FAF1EA04},
    {"uavcan.equipment.air_data.TrueAirspeed", 1020, false, 0x306F69E0A591AFAA},
    {"uavcan.equipment.air_data.IndicatedAirspeed", 1021, false, 0x0A1892D72AB8945F},
    {"uavcan.equipment.air_data.AngleOfAttack", 1025, false, 0xD5513C3F7AFAC74E},
    {"uavcan.equipment.air_data.Sideslip", 1026, false, 0x7B48E55FCFF42A57},
    {"uavcan.equipment.air_data.RawAirData", 1027, false, 0xC77DF38BA122F5DA},
    {"uavcan.equipment.air_data.StaticPressure", 1028, false, 0xCDC7C43412BDC89A},
    {"uavcan.equipment.air_data.StaticTemperature", 1029, false, 0x49272A6477D96271},
    {"uavcan.equipment.esc.RawCommand", 1030, false, 0x217F5C87D7EC951D},
    {"uavcan.equipment.esc.RPMCommand", 1031, false, 0xCE0F9F621CF7E70B},
    {"dronecan.sensors.hygrometer.Hygrometer", 1032, false, 0xCEB308892BF163E8},
    {"uavcan.equipment.esc.Status", 1034, false, 0xA9AF28AEA2FBB254},
    {"uavcan.equipment.esc.StatusExtended", 1036, false, 0x02DC203C50960EDC},
    {"uavcan.equipment.camera_gimbal.AngularCommand", 1040, false, 0x4AF6E57B2B2BE29C},
    {"uavcan.equipment.camera_gimbal.GEOPOICommand", 1041, false, 0x9371428A92F01FD6},
    {"dronecan.sensors.magnetometer.MagneticFieldStrengthHiRes", 1043, false, 0x3053EBE3D750286F},
    {"uavcan.equipment.camera_gimbal.Status", 1044, false, 0xB9F127865BE0D61E},
    {"dronecan.sensors.rpm.RPM", 1045, false, 0x140707C09274F6E7},
    {"uavcan.equipment.range_sensor.Measurement", 1050, false, 0x68FFFE70FC771952},
    {"uavcan.equipment.gnss.Fix", 1060, false, 0x54C1572B9E07F297},
    {"uavcan.equipment.gnss.Auxiliary", 1061, false, 0x9BE8BDC4C3DBBFD2},
    {"uavcan.equipment.gnss.RTCMStream", 1062, false, 0x1F56030ECB171501},
    {"uavcan.equipment.gnss.Fix2", 1063, false, 0xCA41E7000F37435F},
    {"uavcan.equipment.hardpoint.Command", 1070, false, 0xA1A036268B0C3455},
    {"uavcan.equipment.hardpoint.Status", 1071, false, 0x624A519D42553D82},
    {"uavcan.equipment.indication.BeepCommand", 1080, false, 0xBE9EA9FEC2B15D52},
    {"uavcan.equipment.indication.LightsCommand", 1081, false, 0x2031D93C8BDD1EC4},
    {"uavcan.equipment.power.PrimaryPowerSupplyStatus", 1090, false, 0xBBA05074AD757480},
    {"uavcan.equipment.power.CircuitStatus", 1091, false, 0x8313D33D0DDDA115},
    {"uavcan.equipment.power.BatteryInfo", 1092, false, 0x249C26548A711966},
    {"uavcan.equipment.safety.ArmingStatus", 1100, false, 0x8700F375556A8003},
    {"uavcan.equipment.device.Temperature", 1110, false, 0x70261C28A94144C6},
    {"uavcan.equipment.ice.reciprocating.Status", 1120, false, 0xD38AA3EE75537EC6},
    {"uavcan.equipment.ice.FuelTankStatus", 1129, false, 0x286B4A387BA84BC4},
    {"dronecan.sensors.rc.RCInput", 1140, false, 0x771555E596AAB4CF},
    {"uavcan.navigation.GlobalNavigationSolution", 2000, false, 0x463B10CCCBE51C3D},
    {"uavcan.tunnel.Broadcast", 2010, false, 0x5AA2D4D9CF4B1E85},
    {"uavcan.tunnel.SerialConfig", 2011, false, 0x4237AACEE87E82AD},
    {"uavcan.tunnel.Targetted", 3001, false, 0xB138E7EA72A2A2E9},
    {"uavcan.protocol.debug.KeyValue", 16370, false, 0xE02F25D6E0C98AE0},
    {"dronecan.protocol.FlexDebug", 16371, false, 0xECA60382FF038F39},
    {"uavcan.protocol.debug.LogMessage", 16383, false, 0xD654A48E0C049D75},
    {"uavcan.protocol.GetNodeInfo", 1, true, 0xEE468A8121C46A9E},
    {"uavcan.protocol.GetDataTypeInfo", 2, true, 0x1B283338A7BED2D8},
    {"uavcan.protocol.GetTransportStats", 4, true, 0xBE6F76A7EC312B04},
    {"uavcan.protocol.RestartNode", 5, true, 0x569E05394A3017F0},
    {"uavcan.protocol.AccessCommandShell", 6, true, 0x59276B5921C9246E},
    {"uavcan.protocol.param.ExecuteOpcode", 10, true, 0x3B131AC5EB69D2CD},
    {"uavcan.protocol.param.GetSet", 11, true, 0xA7B622F939D1A4D5},
    {"uavcan.protocol.enumeration.Begin", 15, true, 0x196AE06426A3B5D8},
    {"uavcan.protocol.dynamic_node_id.server.AppendEntries", 30, true, 0x8032C7097B48A3CC},
    {"uavcan.protocol.dynamic_node_id.server.RequestVote", 31, true, 0xCDDE07BB89A56356},
    {"uavcan.protocol.file.BeginFirmwareUpdate", 40, true, 0xB7D725DF72724126},
    {"uavcan.protocol.file.GetInfo", 45, true, 0x5004891EE8A27531},
    {"uavcan.protocol.file.GetDirectoryEntryInfo", 46, true, 0x8C46E8AB568BDA79},
    {"uavcan.protocol.file.Delete", 47, true, 0x78648C99170B47AA},
    {"uavcan.protocol.file.Read", 48, true, 0x8DCDCA939F33F678},
    {"uavcan.protocol.file.Write", 49, true, 0x515AA1DC77E58429},
    {"uavcan.tunnel.Call", 63, true, 0xDB11EDC510502658},
    {"dronecan.remoteid.SecureCommand", 64, true, 0x126A47C9C17A8BD7},
});
// clang-format on

static_assert(std::ranges::is_sorted(types, {}, order));

} // namespace

std::span<const DataType> standard_types() {
  return types;
}

const DataType* find_standard_type(Kind kind, std::uint16_t data_type_id) {
  const Order wanted{kind != Kind::message, data_type_id};
  const auto it = std::ranges::lower_bound(types, wanted, {}, order);
  return it != types.end() && order(*it) == wanted ? &*it : nullptr;
}

} // namespace blactl::dronecan
