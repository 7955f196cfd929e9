#pragma once
// The data types of the BLA specification (section 2.3), by hand from their DSDL. Each has encode()
// to a payload and decode() from one. encode() limits values too large for their field, as DSDL's
// `saturated` demands: integers, finite floats (NaN and infinities pass), names, arrays. decode()
// refuses a payload that is too short, contradicts itself or has an array beyond its limit, and
// ignores trailing bytes. Strings from the bus keep their bytes unchanged.

#include "blactl/dronecan/ids.hpp"
#include "blactl/dronecan/payload.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace blactl::dronecan {

using Bytes = std::span<const std::uint8_t>;

/// IEEE 754 binary16 as the DroneCAN libraries convert it: halves round away from zero, overflow
/// becomes infinity, every NaN 0x7FFF. (intentional: IEEE's round-half-to-even differs by one.)
[[nodiscard]] std::uint16_t to_float16(float value);
[[nodiscard]] float from_float16(std::uint16_t bits);

enum class Health : std::uint8_t { ok, warning, error, critical };
enum class Mode : std::uint8_t {
  operational = 0,
  initialization = 1,
  maintenance = 2,
  software_update = 3,
  offline = 7,
};

/// "ok", "warning", "error", "critical".
[[nodiscard]] std::string_view name(Health health);

/// "operational", "initialization", "maintenance", "software_update", "offline"; empty for the
/// values that the standard reserves.
[[nodiscard]] std::string_view name(Mode mode);

/// uavcan/protocol/341.NodeStatus.uavcan
struct NodeStatus {
  static constexpr DataType type{"uavcan.protocol.NodeStatus", 341, false, 0x0F0868D0C1A7C6F1};
  std::uint32_t uptime_s = 0;
  Health health = Health::ok;
  Mode mode = Mode::operational; ///< 4..6 are reserved and pass unchanged
  std::uint8_t sub_mode = 0;
  std::uint16_t vendor_status = 0;

  [[nodiscard]] Payload encode() const;
  [[nodiscard]] static std::optional<NodeStatus> decode(Bytes payload);

  friend bool operator==(const NodeStatus&, const NodeStatus&) = default;
};

/// uavcan/protocol/1.GetNodeInfo.uavcan
struct GetNodeInfo {
  static constexpr DataType type{"uavcan.protocol.GetNodeInfo", 1, true, 0xEE468A8121C46A9E};

  struct Request {
    [[nodiscard]] Payload encode() const { return {}; }

    /// The request is empty; Futaba's table 2-5 prints one byte: any length is accepted.
    [[nodiscard]] static std::optional<Request> decode(Bytes) { return Request{}; }

    friend bool operator==(const Request&, const Request&) = default;
  };

  struct Response {
    NodeStatus status{};
    std::uint8_t software_major = 0, software_minor = 0, optional_field_flags = 0;
    std::uint32_t vcs_commit = 0;
    std::uint64_t image_crc = 0;
    std::uint8_t hardware_major = 0, hardware_minor = 0;
    UniqueId unique_id{};
    std::vector<std::uint8_t> certificate{}; ///< 0..255 bytes
    std::string name{};                      ///< 0..80 bytes, foreign

    [[nodiscard]] Payload encode() const;
    [[nodiscard]] static std::optional<Response> decode(Bytes payload);

    friend bool operator==(const Response&, const Response&) = default;
  };
};

/// uavcan/protocol/dynamic_node_id/1.Allocation.uavcan
struct Allocation {
  static constexpr DataType type{"uavcan.protocol.dynamic_node_id.Allocation", 1, false,
                                 0x0B2A812620A11D40};
  std::uint8_t node_id = 0; ///< 7 bits; 0: any (request), not yet (answer)
  bool first_part_of_unique_id = false;
  std::uint8_t size = 0; ///< of unique_id, 0..16
  UniqueId unique_id{};

  [[nodiscard]] Payload encode() const;
  [[nodiscard]] static std::optional<Allocation> decode(Bytes payload);

  friend bool operator==(const Allocation&, const Allocation&) = default;
};

/// uavcan/protocol/5.RestartNode.uavcan
struct RestartNode {
  static constexpr DataType type{"uavcan.protocol.RestartNode", 5, true, 0x569E05394A3017F0};
  static constexpr std::uint64_t magic = 0xACCE551B1E; ///< 40 bits (table 2-9 misprints uint32)

  struct Request {
    std::uint64_t magic_number = magic;
    [[nodiscard]] Payload encode() const;
    [[nodiscard]] static std::optional<Request> decode(Bytes payload);

    friend bool operator==(const Request&, const Request&) = default;
  };

  struct Response {
    bool ok = false;
    [[nodiscard]] Payload encode() const;
    [[nodiscard]] static std::optional<Response> decode(Bytes payload);

    friend bool operator==(const Response&, const Response&) = default;
  };
};

/// uavcan/protocol/param/10.ExecuteOpcode.uavcan
struct ExecuteOpcode {
  static constexpr DataType type{"uavcan.protocol.param.ExecuteOpcode", 10, true,
                                 0x3B131AC5EB69D2CD};
  static constexpr std::uint8_t save = 0, erase = 1;

  struct Request {
    std::uint8_t opcode = save;
    std::int64_t argument = 0; ///< 48 bits, signed
    [[nodiscard]] Payload encode() const;
    [[nodiscard]] static std::optional<Request> decode(Bytes payload);

    friend bool operator==(const Request&, const Request&) = default;
  };

  struct Response {
    std::int64_t argument = 0; ///< 48 bits, signed
    bool ok = false;
    [[nodiscard]] Payload encode() const;
    [[nodiscard]] static std::optional<Response> decode(Bytes payload);

    friend bool operator==(const Response&, const Response&) = default;
  };
};

/// uavcan/protocol/param/11.GetSet.uavcan. BLA servos use Empty and integers only; the other kinds
/// exist so that foreign nodes can be decoded.
struct GetSet {
  static constexpr DataType type{"uavcan.protocol.param.GetSet", 11, true, 0xA7B622F939D1A4D5};
  using Empty = std::monostate;

  /// uavcan/protocol/param/Value.uavcan; the boolean is a uint8 of which any value but 0 is true.
  using Value = std::variant<Empty, std::int64_t, float, bool, std::string>;
  /// uavcan/protocol/param/NumericValue.uavcan
  using NumericValue = std::variant<Empty, std::int64_t, float>;

  struct Request {
    std::uint16_t index = 0; ///< 13 bits; ignored if a name is given
    Value value{};           ///< Empty: read
    std::string name{};      ///< 0..92 bytes
    [[nodiscard]] Payload encode() const;
    [[nodiscard]] static std::optional<Request> decode(Bytes payload);

    friend bool operator==(const Request&, const Request&) = default;
  };

  struct Response {
    Value value{}; ///< Empty: refused, or no such parameter
    Value default_value{};
    NumericValue max_value{}, min_value{};
    std::string name{}; ///< foreign
    [[nodiscard]] Payload encode() const;
    [[nodiscard]] static std::optional<Response> decode(Bytes payload);

    friend bool operator==(const Response&, const Response&) = default;
  };
};

/// uavcan/equipment/actuator/1010.ArrayCommand.uavcan with uavcan/equipment/actuator/Command.uavcan
struct ArrayCommand {
  static constexpr DataType type{"uavcan.equipment.actuator.ArrayCommand", 1010, false,
                                 0xD8A7486238EC3AF3};
  static constexpr std::size_t max_commands = 15;

  struct Command {
    std::uint8_t actuator_id = 0;  ///< the servo ID 0x45; 255: every servo
    std::uint8_t command_type = 0; ///< 0 unitless, 1 position, 2 force, 3 speed (table 2-21)
    float value = 0;               ///< float16 on the wire

    friend bool operator==(const Command&, const Command&) = default;
  };

  std::vector<Command> commands{}; ///< at most 15; more are not encoded

  [[nodiscard]] Payload encode() const;
  [[nodiscard]] static std::optional<ArrayCommand> decode(Bytes payload);

  friend bool operator==(const ArrayCommand&, const ArrayCommand&) = default;
};

/// uavcan/equipment/actuator/1011.Status.uavcan: 8 bytes, hence always two frames.
struct ActuatorStatus {
  static constexpr DataType type{"uavcan.equipment.actuator.Status", 1011, false,
                                 0x5E9BBA44FAF1EA04};
  std::uint8_t actuator_id = 0;      ///< the servo ID 0x45
  float position = 0;                ///< deg / 100 on BLA servos (DSDL says rad; errata C10)
  float force = 0;                   ///< unused by BLA servos
  float speed = 0;                   ///< unused by BLA servos
  std::uint8_t power_rating_pct = 0; ///< 7 bits; 127: unknown

  [[nodiscard]] Payload encode() const;
  [[nodiscard]] static std::optional<ActuatorStatus> decode(Bytes payload);

  friend bool operator==(const ActuatorStatus&, const ActuatorStatus&) = default;
};

/// uavcan/equipment/safety/1100.ArmingStatus.uavcan
struct ArmingStatus {
  static constexpr DataType type{"uavcan.equipment.safety.ArmingStatus", 1100, false,
                                 0x8700F375556A8003};
  static constexpr std::uint8_t disarmed = 0, fully_armed = 255;
  std::uint8_t status = disarmed;

  [[nodiscard]] Payload encode() const;
  [[nodiscard]] static std::optional<ArmingStatus> decode(Bytes payload);

  friend bool operator==(const ArmingStatus&, const ArmingStatus&) = default;
};

/// The type with this ID among those above; null: none of them.
[[nodiscard]] const DataType* find_type(Kind kind, std::uint16_t data_type_id);

} // namespace blactl::dronecan
