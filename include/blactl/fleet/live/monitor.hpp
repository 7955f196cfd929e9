#pragma once
// Servos as they are now: what they send by themselves, and what is asked of them in turn.

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

/// What is watched of a servo.
enum class LiveField : std::uint8_t { angle, speed, torque, temperature, voltage, faults };
inline constexpr std::size_t live_fields = 6;

/// Where it stands: 0x08-0x0C and 0x18.
[[nodiscard]] bla::Address address_of(LiveField field);

/// What a register held, and when that was told.
struct LiveValue {
  std::int64_t raw = 0;
  Time at{};
};

/// What a servo is told to stay within (0x38-0x41); empty: not known.
struct LiveLimits {
  std::optional<std::int64_t> low{}, high{};
};

/// One servo at one moment.
struct LiveServo {
  Servo servo{}; ///< as it was identified, or as was overheard; `id` always
  std::array<std::optional<LiveValue>, live_fields> values{};
  std::array<const bla::Parameter*, live_fields> parameters{}; ///< as its model has them
  std::array<LiveLimits, live_fields> limits{};                ///< as far as they were asked for
  std::vector<bla::Fault> faults{};             ///< as far as they are known, the worst first
  std::optional<dronecan::NodeStatus> status{}; ///< of its last NodeStatus
  Time first_heard{}, last_heard{};
  std::uint32_t restarts = 0;                  ///< since it was first heard
  std::optional<dronecan::NodeId> former_id{}; ///< it had before
  bool is_gone = false;                        ///< not heard for offline_time
  bool is_doubled = false; ///< two units send under its ID: nothing is told of either
  bool is_stale = false;   ///< something of it is older than it should be, or is not told
  bool has_turned = false; ///< where that is watched: its shaft was turned, see TurnWatch

  [[nodiscard]] const std::optional<LiveValue>& value(LiveField field) const {
    return values[static_cast<std::size_t>(field)];
  }

  [[nodiscard]] const bla::Parameter* parameter(LiveField field) const {
    return parameters[static_cast<std::size_t>(field)];
  }
};

/// Watches servos for as long as it lives. Angles come from actuator.Status, which every BLA servo
/// sends ten times a second (degrees are its field times 100; errata C10); what that cannot tell
/// exactly, and the rest, is asked for in turn. Without a node ID of our own, and on a recording,
/// only what is heard counts: answers to others, too.
class Monitor final : private dronecan::Service {
 public:
  /// The share of the bus that questions and answers take at most.
  static constexpr int share_percent = 10;

  struct Options {
    Identification::Options identification;
    std::vector<LiveField> fields;                    ///< to ask for
    Duration period = std::chrono::milliseconds(500); ///< of a sample
    bool watches_turns = false;                       ///< LiveServo::has_turned
    /// Called once every period; on a recording by its own time, and at its end.
    std::function<void(Time now)> sample{};
  };

  /// `session` and `profiles` outlive this.
  Monitor(Session& session, const bla::Profiles& profiles, Targets targets, Options options);
  ~Monitor() override;
  Monitor(const Monitor&) = delete;
  Monitor(Monitor&&) = delete;
  Monitor& operator=(const Monitor&) = delete;
  Monitor& operator=(Monitor&&) = delete;

  /// The servos that are meant and were heard, by node ID, as they were at `now`.
  [[nodiscard]] std::vector<LiveServo> servos(Time now) const;

  /// Why some that are meant are not among them: not_found; not_recorded; duplicate_node_id, where
  /// one that was never met may be one of two under an ID. Where all are meant: none is there.
  [[nodiscard]] std::vector<Error> missing(Time now) const;

  /// Asks this servo for its limits as well; empty: none.
  void watch_limits(std::optional<dronecan::NodeId> id) { limits_of_ = id; }

 private:
  /// What was heard of one node.
  struct Watched {
    std::map<bla::Address, LiveValue> values{};
    std::optional<dronecan::UniqueId> unique_id{}; ///< overheard
    std::string name{};
    TurnWatch turns{};
    std::optional<Time> status_at{}; ///< of its last actuator.Status
    bool is_far = false;             ///< beyond what that tells exactly
    std::uint32_t boot = 0;          ///< when all this was heard
    std::unique_ptr<PollJob> poll{};
  };

  void receive(const dronecan::Transfer& transfer) override;

  [[nodiscard]] Time next_deadline() const override { return due_; }

  void advance(Time now) override;

  void take_angle(Watched& node, const dronecan::Transfer& transfer);
  static void tell_angle(Watched& node, std::int64_t decideg, Time at);
  void take_register(Watched& node, const dronecan::Transfer& transfer);
  void forget_past_faults(Watched& node);
  void attend(dronecan::NodeId id);
  void plan_rounds();
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
  std::set<std::string> met_;                 ///< selectors that matched a servo at some time
  std::optional<dronecan::NodeId> limits_of_; ///< see watch_limits()
};

} // namespace blactl::fleet
