#pragma once
// Events at set times, independent of the traffic.

#include "blactl/base/time.hpp"
#include "blactl/sim/scenario/world_change.hpp"
#include "blactl/sim/servo/mishap.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace blactl::sim {

/// The state of the clients' connection to a simulated bus.
enum class ClientLink : std::uint8_t {
  joined,
  cut,     ///< the cable is pulled: no node receives or acknowledges their frames
  bus_off, ///< their controllers leave the bus for a moment, and drop their queued frames
};

/// "joined", "cut", "bus_off"; empty: none of them.
[[nodiscard]] std::optional<ClientLink> parse_client_link(std::string_view word);

struct TimedEvent {
  Duration at{};                      ///< after power-on
  std::int64_t serial_number = 0;     ///< of the affected servos; 0: the clients
  std::vector<WorldChange> changes{}; ///< to the surroundings of those servos
  std::optional<Mishap> mishap{};     ///< applied to those servos after the changes
  ClientLink clients = ClientLink::joined;
};

/// Gives out events when they are due.
class Timeline {
 public:
  /// `events`: in any order; those of the same time keep theirs.
  Timeline(std::vector<TimedEvent> events, Time power_on);

  /// The time of the next event; `never` if there is none.
  [[nodiscard]] Time next() const;

  /// The next event if it is due; else null. Valid as long as this is.
  [[nodiscard]] const TimedEvent* take(Time now);

 private:
  std::vector<TimedEvent> events_;
  Time power_on_;
  std::size_t taken_ = 0;
};

} // namespace blactl::sim
