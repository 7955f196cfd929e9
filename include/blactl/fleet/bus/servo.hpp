#pragma once
// A handle to one servo: which unit it is, and where it was found.

#include "blactl/base/time.hpp"
#include "blactl/bla/identity.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"

#include <cstdint>
#include <optional>
#include <span>
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
  /// False: a file does not tell its node ID, and `id` only stands for it in this process.
  bool id_is_known = true;
};

/// Whether an uptime that was told at `now` proves that the unit has run since then: it counts
/// whole seconds, and a clock may be wrong by some percent. False is no proof of a restart.
[[nodiscard]] bool has_run_since(Time since, std::uint32_t uptime_s, Time now);

/// "10, 11, 12"
[[nodiscard]] std::string id_list(std::span<const dronecan::NodeId> ids);

/// Finds out by uptimes whether a unit has started anew since then. Uptimes count whole seconds, so
/// the moment matters: where the answer comes at once, a whole number of seconds later, for a unit
/// that has started anew is younger than that. Where answers take longer, as much earlier as they
/// do, and every uptime narrows down when the unit may have started.
class UptimeCheck {
 public:
  explicit UptimeCheck(Time since) : since_(since) {}

  enum class Verdict : std::uint8_t { ran_on, restarted, unclear };

  /// What an uptime means that was asked for and told at these moments.
  [[nodiscard]] Verdict judge(std::uint32_t uptime_s, Time asked, Time told);

  /// The next moment to ask at, where the answer is as late as the last one was.
  [[nodiscard]] Time next(Time now);

 private:
  Time since_;
  Time earliest_start_{};           ///< the unit that told the last uptime started after that
  Duration delay_{};                ///< of the last answer, against when it was to be asked for
  std::optional<Time> asking_at_{}; ///< what next() said
};

} // namespace blactl::fleet
