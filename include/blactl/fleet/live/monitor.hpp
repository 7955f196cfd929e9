#pragma once
// The present state of servos: their messages, and the registers read from them in turn.

#include "blactl/bla/faults.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/target.hpp"
#include "blactl/fleet/live/poll_job.hpp"
#include "blactl/fleet/live/turn_watch.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace blactl::fleet {

/// The monitored quantities of a servo.
enum class LiveField : std::uint8_t { angle, speed, torque, temperature, voltage, faults };
inline constexpr std::size_t live_fields = 6;

/// The register of a field: 0x08-0x0C and 0x18.
[[nodiscard]] bla::Address address_of(LiveField field);

/// The value of a register, and the time of that value.
struct LiveValue {
  std::int64_t raw = 0;
  Time at{};
};

/// The servo's limits for a field (0x38-0x41); empty: unknown.
struct LiveLimits {
  std::optional<std::int64_t> low{}, high{};
};

struct LiveServo {
  Servo servo{}; ///< as identified or overheard; `id` always
  std::array<std::optional<LiveValue>, live_fields> values{};
  std::array<const bla::Parameter*, live_fields> parameters{}; ///< as defined by its model
  std::array<LiveLimits, live_fields> limits{};                ///< as far as they were read
  std::vector<bla::Fault> faults{};                            ///< as far as known, the worst first
  std::optional<dronecan::NodeStatus> status{};                ///< told in the last offline_time
  Time first_heard{}, last_heard{};
  std::uint32_t restarts = 0;                  ///< of this unit, as far as heard
  std::optional<dronecan::NodeId> former_id{}; ///< its earlier node ID
  bool is_gone = false;                        ///< not heard for offline_time
  bool is_doubled = false; ///< two units send under its ID: no values of either are shown
  bool is_stale = false;   ///< a value is overdue or missing, or it may be another unit's
  bool has_turned = false; ///< if watched: its shaft was turned, see TurnWatch

  [[nodiscard]] const std::optional<LiveValue>& value(LiveField field) const {
    return values[static_cast<std::size_t>(field)];
  }

  [[nodiscard]] const bla::Parameter* parameter(LiveField field) const {
    return parameters[static_cast<std::size_t>(field)];
  }
};

/// Monitors servos for its lifetime. Angles come from actuator.Status, which every BLA servo sends
/// ten times a second (degrees are its field times 100; errata C10); the rest, and what that cannot
/// represent exactly, is read in turn. Without a node ID of our own, and on a recording, only
/// transfers on the bus are used: responses to others, too. After a silence in which another unit
/// may have come, nothing is shown as a servo's until it has told its unique ID again.
class Monitor final : private dronecan::Service {
 public:
  /// The share of the bus for requests and responses, at most.
  static constexpr int share_percent = 10;

  struct Options {
    Identification::Options identification;
    std::vector<LiveField> fields;                    ///< to be read
    Duration period = std::chrono::milliseconds(500); ///< of a sample
    bool watches_turns = false;                       ///< LiveServo::has_turned
    /// Called once per period; on a recording by its own time, and at its end.
    std::function<void(Time now)> sample{};
  };

  /// `session` and `profiles` outlive this.
  Monitor(Session& session, const bla::Profiles& profiles, Targets targets, Options options);
  ~Monitor() override;
  Monitor(const Monitor&) = delete;
  Monitor(Monitor&&) = delete;
  Monitor& operator=(const Monitor&) = delete;
  Monitor& operator=(Monitor&&) = delete;

  /// The servos that are selected and were heard, by node ID, in their state at `now`.
  [[nodiscard]] std::vector<LiveServo> servos(Time now) const;

  /// Errors for selected servos that are not among them: not_found; not_recorded; timeout, if a
  /// named one has fallen silent;
  /// duplicate_node_id, if a servo that was never met may be one of two under an ID. If all are
  /// selected: an error if there is none.
  [[nodiscard]] std::vector<Error> missing(Time now) const;

  /// Reads the limits of this servo as well; empty: of none.
  void watch_limits(std::optional<dronecan::NodeId> id) { limits_of_ = id; }

 private:
  /// The data heard from one node.
  struct Watched {
    std::map<bla::Address, LiveValue> values{};
    std::optional<dronecan::UniqueId> unique_id{}; ///< overheard
    std::string name{};
    TurnWatch turns{};
    std::optional<Time> status_at{}; ///< of its last actuator.Status
    bool is_far = false;             ///< beyond the exact range of actuator.Status
    std::uint32_t boot = 0;          ///< the run of the servo (roster) that all this belongs to
    std::optional<dronecan::UniqueId> unit{}; ///< who answered GetNodeInfo last
    Time unit_at{};                           ///< and when
    std::uint32_t first_boot = 0;             ///< the first run of that unit
    std::unique_ptr<PollJob> poll{};
  };

  void receive(const dronecan::Transfer& transfer) override;

  [[nodiscard]] Time next_deadline() const override { return due_; }

  void advance(Time now) override;

  void meet(Watched& node, const Member& member);
  void take_angle(Watched& node, const dronecan::Transfer& transfer);
  static void tell_angle(Watched& node, std::int64_t decideg, Time at);
  void take_register(Watched& node, const dronecan::Transfer& transfer);
  void forget_past_faults(Watched& node);
  void attend(dronecan::NodeId id);
  void plan_rounds();
  [[nodiscard]] bool asks() const;
  [[nodiscard]] bool needs_angle(const Watched& node) const;
  [[nodiscard]] std::optional<PollPlan> further(dronecan::NodeId id, const Watched& node) const;
  [[nodiscard]] bool is_meant(const Member& member, const Watched& node) const;
  [[nodiscard]] bool is_met(const Selector& selector) const;
  [[nodiscard]] Servo servo(const Member& member, const Watched& node) const;
  [[nodiscard]] LiveServo live(const Member& member, const Watched& node, Time now) const;
  [[nodiscard]] bool is_stale(const LiveServo& servo, Time now) const;

  Session& session_;
  const bla::Profiles& profiles_;
  Targets targets_;
  Options options_;
  PollPlan plan_;
  Time due_; ///< the next sample
  std::map<dronecan::NodeId, Watched> nodes_;
  std::set<std::string> met_;                 ///< selectors that have matched a servo so far
  std::optional<dronecan::NodeId> limits_of_; ///< see watch_limits()
};

} // namespace blactl::fleet
