#pragma once
// Carries out a command to the shaft of one servo, from the proof of its unit to its end.

#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/motion/motion_job.hpp"

#include <functional>
#include <optional>

namespace blactl::fleet {

/// Options of a command.
struct MotionManner {
  Patience patience{};
  bool while_driven = false;
  /// Called with every sample; false: they are not read any more, and the command is ended.
  std::function<bool(const MotionSample&)> sampled{};
  std::function<void()> ending{}; ///< called when an interruption begins the end
};

struct Commanded {
  MotionResult result;
  std::optional<Error> broken{}; ///< the error that ended the session early
};

/// Reads the servo IDs of all servos heard, as an ArrayCommand may reach another one, too. Empty:
/// the servo ID of this one is unique, as far as the bus was heard. Errors: duplicate_servo_id (two
/// have it, one did not respond with its own, or a unit waits for a node ID); those that end a
/// session.
[[nodiscard]] std::optional<Error> refuse_servo_id(Session& session, const bla::Profiles& profiles,
                                                   const MotionPlan& plan,
                                                   const Identification::Options& options);

/// The reason why it must not be commanded now, as far as the bus was heard. Errors: those of
/// forbidden().
[[nodiscard]] std::optional<Error> refuse_to_command(const Session& session, const MotionPlan& plan,
                                                     bool while_driven);

/// Commands the servo until its time is over or it is interrupted, and brings it to its end.
[[nodiscard]] Commanded command(Session& session, const MotionPlan& plan,
                                const MotionManner& manner);

} // namespace blactl::fleet
