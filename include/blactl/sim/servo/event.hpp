#pragma once
// Events inside a simulated servo that its frames do not show.

#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"

#include <cstdint>
#include <functional>
#include <string_view>

namespace blactl::sim {

struct ServoEvent {
  enum class Kind : std::uint8_t {
    rom_write, ///< the silence of a ROM write is over
    restart,   ///< the servo goes down
    erase,     ///< RAM holds the defaults
    allocated, ///< an allocator has assigned an ID
  };

  Kind kind = Kind::rom_write;
  Time at;
  dronecan::UniqueId unique_id{};
  std::int64_t serial_number = 0;
  dronecan::NodeId node_id;     ///< its ID at the time of the event; for `allocated` the new one
  std::uint32_t rom_writes = 0; ///< since power-on, this one included
};

/// "rom_write", "restart", "erase", "allocated".
[[nodiscard]] constexpr std::string_view name(ServoEvent::Kind kind) {
  switch (kind) {
  case ServoEvent::Kind::rom_write: return "rom_write";
  case ServoEvent::Kind::restart: return "restart";
  case ServoEvent::Kind::erase: return "erase";
  case ServoEvent::Kind::allocated: return "allocated";
  }
  return {};
}

/// Called at once; must not call back into the simulator.
using EventSink = std::function<void(const ServoEvent&)>;

} // namespace blactl::sim
