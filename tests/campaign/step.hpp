#pragma once
// One command of an episode, and what happened in the servos while it ran.

#include "episode.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace blactl::campaign {

/// A client's clock against a servo's; less than the shortest start takes.
inline constexpr Duration tolerance = std::chrono::milliseconds(30);

/// On a wire without faults, frames that this client had queued before it heard another one may
/// follow it for so long, at most.
inline constexpr Duration on_its_way = std::chrono::milliseconds(4);

/// After this a servo that has started has sent its first NodeStatus, and some more.
inline constexpr Duration settled = std::chrono::seconds(3);

struct Step {
  const Episode& episode;
  const Command& command;
  Outcome outcome;
  States before, after;
  Time begin, end;
  std::vector<sim::ServoEvent> events;
  std::optional<States>
      tried{}; ///< before the first of the runs that broke off, which this repeats

  [[nodiscard]] std::string model(std::int64_t serial) const;

  /// All node IDs that a servo had.
  [[nodiscard]] std::set<std::uint8_t> node_ids(std::int64_t serial) const;

  /// When it restarted.
  [[nodiscard]] std::vector<Time> restarts(std::int64_t serial) const;

  [[nodiscard]] std::uint32_t rom_writes(std::int64_t serial) const {
    return after.at(serial).rom_writes - before.at(serial).rom_writes;
  }

  /// Whether -n, or the fleet file, takes it in.
  [[nodiscard]] bool means(std::int64_t serial) const;

  /// Whether RAM may be another than what the command could know in its last moment: the servo
  /// restarted, or another tool changed it, when nothing of it could be heard any more.
  [[nodiscard]] bool changed_unheard(std::int64_t serial) const;

  /// Whether another tool changed it when nothing of it could be heard any more.
  [[nodiscard]] bool is_written_unheard(std::int64_t serial) const;

  /// Whether another tool may have written to it while the command ran.
  [[nodiscard]] bool has_other_writer(std::int64_t serial) const;

  /// Whether one of these may have been a SAVE or an ERASE.
  [[nodiscard]] bool is_saved_by_other(std::int64_t serial) const;

  /// Whether it shares its node ID with another, or its unique ID.
  [[nodiscard]] bool is_doubled(std::int64_t serial) const;

  /// The same as far as it can be heard: a unit that is mute, or shares its node ID, cannot tell
  /// its unique ID.
  [[nodiscard]] bool shows_doubled(std::int64_t serial) const;

  [[nodiscard]] bool shares_node_id(std::int64_t serial) const;

  /// Others with its unique ID.
  [[nodiscard]] std::vector<std::int64_t> copies(std::int64_t serial) const;

  [[nodiscard]] bool shares_with_foreign(std::int64_t serial) const;

  /// When something may come to it, or go, that is no order of the command.
  [[nodiscard]] std::vector<Time> accidents(std::int64_t serial) const;

  /// Whether the client hears what other nodes send to servos.
  [[nodiscard]] bool hears_all() const;

 private:
  [[nodiscard]] std::set<std::string> orders_of_others(std::int64_t serial, Time earliest) const;
  [[nodiscard]] Duration lateness(std::int64_t serial) const;
  [[nodiscard]] Time known_until(std::int64_t serial) const;
  [[nodiscard]] const nlohmann::json& setup(std::int64_t serial) const;
};

/// Whether RAM is like ROM: else `undo` may not know what ROM held.
[[nodiscard]] bool has_no_trials(const States& servos);

/// The time in "500ms" or "3s" of a scenario.
[[nodiscard]] Duration time_in(const nlohmann::json& text);

} // namespace blactl::campaign
