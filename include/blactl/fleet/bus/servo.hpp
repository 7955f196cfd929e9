#pragma once
// A handle to one servo: its unit, and its node ID when found.

#include "blactl/base/time.hpp"
#include "blactl/bla/identity.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace blactl::fleet {

/// The facts about a node when it was identified: plain data, which does not change while the bus
/// goes on. A restart or another unit on the ID shows in the roster.
struct Servo {
  dronecan::NodeId id{};
  std::optional<dronecan::UniqueId> unique_id{}; ///< empty: a recording may lack it
  std::uint32_t boot = 0;                        ///< Member::boots at that time
  Time since{};          ///< the first successful request: all facts are newer
  bool is_young = false; ///< uptime 0 at that time: a restart since may not show
  std::string name{};    ///< of GetNodeInfo, untrusted bytes
  bool is_servo = false; ///< it responded to register 0x50
  bla::Identity identity{};
  std::optional<std::int64_t> servo_id{}, static_node_id{};
  /// False: a file has no node ID for it, and `id` is a placeholder in this process.
  bool id_is_known = true;
};

/// Whether this servo has told another serial number than this one: then it is another unit,
/// whatever its unique ID. False also where one of them is unknown.
[[nodiscard]] inline bool has_other_serial(const Servo& servo, std::optional<std::int64_t> serial) {
  const auto own = servo.identity.readings().serial_number;
  return own && serial && own != serial;
}

/// Whether an uptime received at `now` proves that the unit has run since then: it counts whole
/// seconds, and a clock may be wrong by some percent. False does not prove a restart.
[[nodiscard]] bool has_run_since(Time since, std::uint32_t uptime_s, Time now);

/// "10, 11, 12"
[[nodiscard]] std::string id_list(std::span<const dronecan::NodeId> ids);

/// Decides by uptimes whether a unit has restarted since a moment. Uptimes count whole seconds, so
/// the time of the request matters: with immediate responses, a whole number of seconds later, as
/// the uptime of a restarted unit is smaller then. With slow responses, earlier by the same delay;
/// every uptime narrows down the possible start of the unit.
class UptimeCheck {
 public:
  explicit UptimeCheck(Time since) : since_(since) {}

  enum class Verdict : std::uint8_t { ran_on, restarted, unclear };

  /// Judges an uptime requested and received at these moments.
  [[nodiscard]] Verdict judge(std::uint32_t uptime_s, Time asked, Time told);

  /// The next time for a request, if the response is as late as the last one.
  [[nodiscard]] Time next(Time now);

 private:
  Time since_;
  Time earliest_start_{};           ///< the unit of the last uptime started after that
  Duration delay_{};                ///< of the last response, relative to the intended request
  std::optional<Time> asking_at_{}; ///< the last result of next()
};

} // namespace blactl::fleet
