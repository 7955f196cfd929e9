#pragma once
// Carries a command to the shaft of one servo out, from its proof to its end.

#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/motion/command_job.hpp"

#include <functional>
#include <optional>

namespace blactl::fleet {

/// How a servo is commanded.
struct CommandManner {
  Patience patience{};
  bool while_driven = false;
  /// Told of every sample; false: nobody reads them any more, and it is brought to its end.
  std::function<bool(const CommandSample&)> sampled{};
  std::function<void()> ending{}; ///< it was interrupted, and is brought to its end
};

struct Commanded {
  CommandResult result;
  std::optional<Error> broken{}; ///< why the session ended in between
};

/// Why an ArrayCommand may reach another servo, too: all that were heard are asked for their servo
/// ID. Empty: the servo ID of this one is unique, as far as the bus was heard. Errors:
/// duplicate_servo_id (two have it, one did not tell its own, or a unit waits for a node ID); those
/// that end a session.
[[nodiscard]] std::optional<Error> refuse_servo_id(Session& session, const bla::Profiles& profiles,
                                                   const CommandPlan& plan,
                                                   const Identification::Options& options);

/// Why it must not be commanded now, as far as the bus was heard. Errors: as forbidden().
[[nodiscard]] std::optional<Error> refuse_to_command(const Session& session,
                                                     const CommandPlan& plan, bool while_driven);

/// Commands it until its time is over, and brings it to its end, also where it is interrupted.
[[nodiscard]] Commanded command(Session& session, const CommandPlan& plan,
                                const CommandManner& manner);

} // namespace blactl::fleet
