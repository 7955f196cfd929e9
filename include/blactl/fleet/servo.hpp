#pragma once
// A handle to one servo: which unit it is, and where it was found.

#include "blactl/base/time.hpp"
#include "blactl/bla/identity.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace blactl::fleet {

/// What a node said of itself when it was identified: plain data, which stays as it was while the
/// bus goes on. A restart or another unit on the ID shows in the roster.
struct Servo {
  dronecan::NodeId id{};
  std::optional<dronecan::UniqueId> unique_id{}; ///< empty: a recording may lack it
  std::uint32_t boot = 0;                        ///< Member::boots when it said so
  Time since{};          ///< when it was first asked with success: all that it said is younger
  std::string name{};    ///< of GetNodeInfo, foreign bytes
  bool is_servo = false; ///< it answered register 0x50
  bla::Identity identity{};
  std::optional<std::int64_t> servo_id{}, static_node_id{};
};

/// Whether an uptime that was told at `now` proves that the unit has run since then: it counts
/// whole seconds, and a clock may be wrong by some percent. False is no proof of a restart.
[[nodiscard]] bool has_run_since(Time since, std::uint32_t uptime_s, Time now);

/// Whole seconds since then: an uptime asked at such a moment is smaller where the unit has started
/// anew since then, and only there.
class UptimeCheck {
 public:
  explicit UptimeCheck(Time since) : since_(since) {}

  /// The next moment to ask at, where an answer takes `round_trip`.
  [[nodiscard]] Time next(Time now, Duration round_trip) const;

  enum class Verdict : std::uint8_t { ran_on, restarted, unclear };

  /// What an uptime means that was asked for and told at these moments.
  [[nodiscard]] Verdict judge(std::uint32_t uptime_s, Time asked, Time told) const;

 private:
  Time since_;
};

} // namespace blactl::fleet
