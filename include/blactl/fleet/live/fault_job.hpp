#pragma once
// Reads the faults of one or several servos.

#include "blactl/bla/faults.hpp"
#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/session.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// The faults of a servo at one time: 0x18-0x1B, and the values behind their bits.
struct FaultState {
  Snapshot snapshot;
  std::vector<bla::Fault> faults;         ///< the worst first
  std::optional<dronecan::Health> health; ///< of its NodeStatus
  std::vector<Error> errors;              ///< why it is incomplete; empty: complete

  /// The value of one of 0x18-0x1B; empty: unknown.
  [[nodiscard]] std::optional<std::int64_t> fault_register(bla::Address reg) const;

  /// The worst level; empty: no bit is known to be set.
  [[nodiscard]] std::optional<bla::Level> worst() const;

  /// The level that NodeStatus reports although all registers were read without a bit of it (Table
  /// 2-18 has no such state); empty: the registers explain it, or it reports none. unproven: a
  /// notice explains a warning.
  [[nodiscard]] std::optional<bla::Level> unexplained_health() const;

  /// Whether it is there, though it may have refused a register.
  [[nodiscard]] bool has_answered() const;

  /// The registers related to a fault, as far as they were read.
  [[nodiscard]] std::vector<Reading> values_of(const bla::Fault& fault) const;
};

/// Whether a fault of at least this level is known, or reported by NodeStatus.
[[nodiscard]] bool has_found(const FaultState& servo, bla::Level level);

/// Reads 0x18, and if it shows faults the registers behind it. If NodeStatus reports more than
/// that, all four registers are read once more. On a recording all four are looked for; where they
/// contradict each other, or NodeStatus, the present faults are not_recorded.
class FaultJob final : public dronecan::Job {
 public:
  /// `session` outlives the job, `profiles` its state too.
  FaultJob(Session& session, const bla::Profiles& profiles, dronecan::NodeId id,
           const Identification::Options& options);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  /// Valid once the job has ended.
  [[nodiscard]] const FaultState& state() const { return state_; }

 private:
  void look(std::span<const bla::Address> first);
  [[nodiscard]] dronecan::Step judge(Time now);

  Session& session_;
  const bla::Profiles& profiles_;
  Identification::Options options_;
  std::optional<ReadJob> read_;
  bool is_second_ = false; ///< the second read, of all four registers
  FaultState state_;
};

/// The faults of several servos, in the order asked.
struct FaultStates {
  std::vector<FaultState> servos;
  std::optional<Error> broken; ///< the error that ended the session early
};

/// Reads the faults of several servos at once. `profiles` outlives the states.
[[nodiscard]] FaultStates read_faults(Session& session, const bla::Profiles& profiles,
                                      std::span<const dronecan::NodeId> servos,
                                      const Identification::Options& options);

} // namespace blactl::fleet
