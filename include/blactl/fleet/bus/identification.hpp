#pragma once
// The requests that identify a node: GetNodeInfo, then 0x50-0x53, 0x45 and 0x46.

#include "blactl/bla/profile.hpp"
#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/bus/register_access.hpp"
#include "blactl/fleet/bus/roster.hpp"

#include <optional>
#include <string_view>

namespace blactl::fleet {

/// The node name of this program (GetNodeInfo).
inline constexpr std::string_view own_name = "blactl";

/// Identifies one node as part of a job: feed it outcomes until it has no further request.
class Identification {
 public:
  struct Options {
    Patience patience;
    const bla::Profile* assumed = nullptr; ///< --profile
    bool static_node_id = false;           ///< 0x46 as well
    bool settled = false; ///< not before it has run for a second, so that a restart after it shows
  };

  /// All references outlive this object. Results are entered into `roster`.
  Identification(Roster& roster, dronecan::NodeId id, const bla::Profiles& profiles,
                 Options options);

  /// The next step; the end: done() or failed. The first call's outcome is ignored.
  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome);

  [[nodiscard]] bool done() const { return done_; }

  /// The identified node, when done().
  [[nodiscard]] const Servo& servo() const { return servo_; }

  /// The error of a failure: timeout, not_found, model_mismatch, interrupted, no_acknowledge;
  /// not_recorded if a recording does not show whether it is a servo. Anything else missing in a
  /// recording stays unknown.
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  enum class At : std::uint8_t {
    begin,
    young,
    node_info,
    model_number,
    serial_number,
    firmware_version,
    hardware_version,
    servo_id,
    static_node_id,
    end,
  };

  [[nodiscard]] static bla::Address address_of(At at);
  [[nodiscard]] dronecan::Step begin(Time now);
  [[nodiscard]] dronecan::Step grow(Time started);
  [[nodiscard]] dronecan::Step question(At at);
  [[nodiscard]] dronecan::Step conclude();
  [[nodiscard]] std::optional<Error> undecided() const;
  [[nodiscard]] bool sends_actuator_status() const;
  [[nodiscard]] bool may_be_servo() const;
  [[nodiscard]] bool may_be_of_two() const;
  [[nodiscard]] Error silence_of_model() const;
  void take_node_info(const dronecan::Outcome& outcome);
  void take_register(const dronecan::Outcome& outcome);
  [[nodiscard]] std::optional<std::int64_t>& slot(At at);

  Roster& roster_;
  const bla::Profiles& profiles_;
  Options options_;
  At at_ = At::begin;
  int pauses_ = 0;   ///< to let it grow older
  int silences_ = 0; ///< in the middle of it
  Servo servo_;
  std::optional<dronecan::GetNodeInfo::Response> info_;
  bla::Readings readings_;
  bool recording_lacks_model_ = false;
  bool model_silent_ = false; ///< an actuator did not respond to 0x50
  bool done_ = false;
  std::optional<Error> error_;
};

class IdentifyJob : public dronecan::Job {
 public:
  IdentifyJob(Roster& roster, dronecan::NodeId id, const bla::Profiles& profiles,
              Identification::Options options)
      : identification_(roster, id, profiles, options) {}

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override {
    return identification_.next(outcome);
  }

  [[nodiscard]] const Identification& identification() const { return identification_; }

 private:
  Identification identification_;
};

/// Probes IDs that were not heard: scan runs several at a time, which share one cursor. Responding
/// nodes appear in the roster.
class ProbeJob : public dronecan::Job {
 public:
  /// The last probed ID; 126 and 127 are for tools.
  static constexpr std::uint8_t last = 125;

  /// `cursor`: the ID last probed by any of the jobs, 0 at the beginning.
  ProbeJob(const Roster& roster, std::uint8_t& cursor, Duration timeout)
      : roster_(roster), cursor_(cursor), timeout_(timeout) {}

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

 private:
  const Roster& roster_;
  std::uint8_t& cursor_;
  Duration timeout_;
};

/// Asks a unit that appeared or restarted for its unique ID only.
class UnitJob final : public dronecan::Job {
 public:
  UnitJob(Roster& roster, dronecan::NodeId id, Patience patience)
      : roster_(roster), id_(id), patience_(patience) {}

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  /// Jobs waiting for a unit to come back must not be left half done.
  [[nodiscard]] bool must_finish() const override { return true; }

 private:
  Roster& roster_;
  dronecan::NodeId id_;
  Patience patience_;
};

/// Asks an identified node for its unique ID again: a different response is another unit.
class DoubleCheckJob final : public dronecan::Job {
 public:
  DoubleCheckJob(Roster& roster, const Servo& servo, Patience patience)
      : roster_(roster), servo_(servo), patience_(patience) {}

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  [[nodiscard]] dronecan::NodeId id() const { return servo_.id; }

  [[nodiscard]] bool is_answered() const { return is_answered_; }

 private:
  Roster& roster_;
  Servo servo_;
  Patience patience_;
  bool is_answered_ = false;
};

} // namespace blactl::fleet
