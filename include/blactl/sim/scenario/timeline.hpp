#pragma once
// What happens at set times, whatever the frames do.

#include "blactl/base/time.hpp"
#include "blactl/sim/scenario/world_change.hpp"
#include "blactl/sim/servo/mishap.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace blactl::sim {

/// How the clients of a simulated bus hang on it.
enum class ClientLink : std::uint8_t {
  joined,
  cut,     ///< the cable is pulled: nobody hears or acknowledges them
  bus_off, ///< their controllers leave the bus for a moment, and lose what they wanted to send
};

/// "joined", "cut", "bus_off"; empty: none of them.
[[nodiscard]] std::optional<ClientLink> parse_client_link(std::string_view word);

struct TimedEvent {
  Duration at{};                      ///< after power-on
  std::int64_t serial_number = 0;     ///< of the servos that it happens to; 0: to the clients
  std::vector<WorldChange> changes{}; ///< around those servos
  std::optional<Mishap> mishap{};     ///< of those servos, after the changes
  ClientLink clients = ClientLink::joined;
};

/// Gives events out when they are due.
class Timeline {
 public:
  /// `events`: in any order; those of one time happen in theirs.
  Timeline(std::vector<TimedEvent> events, Time power_on);

  /// Of the next event; `never` if there is none.
  [[nodiscard]] Time next() const;

  /// The next event if it is due; else null. Valid as long as this is.
  [[nodiscard]] const TimedEvent* take(Time now);

 private:
  std::vector<TimedEvent> events_;
  Time power_on_;
  std::size_t taken_ = 0;
};

} // namespace blactl::sim
