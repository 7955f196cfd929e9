#pragma once
// Numbers of the DroneCAN network: node IDs, data types, priorities.

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <string_view>

namespace blactl::dronecan {

/// A node's address on the bus: 1..127; 0 stands for "anonymous" as a source and "everybody" as a
/// destination (DroneCAN specification 4.1).
class NodeId {
 public:
  static constexpr std::uint8_t max = 127;

  constexpr NodeId() = default;

  constexpr explicit NodeId(std::uint8_t value) : value_(value & max) {}

  [[nodiscard]] constexpr std::uint8_t value() const { return value_; }

  [[nodiscard]] constexpr bool is_unicast() const { return value_ != 0; }

  friend constexpr auto operator<=>(NodeId, NodeId) = default;

 private:
  std::uint8_t value_ = 0;
};

/// Source 0: a node without an ID.
inline constexpr NodeId anonymous{};

/// The 128-bit identity of a unit (GetNodeInfo, dynamic node ID allocation).
using UniqueId = std::array<std::uint8_t, 16>;

/// Whether it is zeros or ones alone, as in memory that was never written: of no unit its own.
[[nodiscard]] constexpr bool is_blank(const UniqueId& unique_id) {
  return std::ranges::all_of(unique_id, [&](std::uint8_t byte) {
    return byte == unique_id.front() && (byte == 0x00 || byte == 0xFF);
  });
}

/// Whether a unique ID begins with these bytes: a request for a node ID tells it in parts.
[[nodiscard]] constexpr bool begins_with(const UniqueId& unique_id,
                                         std::span<const std::uint8_t> beginning) {
  return beginning.size() <= unique_id.size() &&
         std::ranges::equal(std::span(unique_id).first(beginning.size()), beginning);
}

/// Message broadcast, or one direction of a service.
enum class Kind : std::uint8_t { message, request, response };

/// A data type as the transport needs it (DSDL).
struct DataType {
  std::string_view name; ///< "uavcan.protocol.NodeStatus"
  std::uint16_t id;      ///< data type ID: messages 0..65535, services 0..255
  bool service;
  std::uint64_t signature; ///< seeds the transfer CRC
};

/// Transfer priority 0 (highest) .. 31.
using Priority = std::uint8_t;

inline constexpr Priority priority_medium = 16;
/// The vendor's program's priority for GetSet; below all traffic that keeps a vehicle in the air.
inline constexpr Priority priority_service = 30;

} // namespace blactl::dronecan
