#pragma once
// Restarts servos and sees them come back: recognition under whatever node ID, and node IDs for
// those that have none of their own.

#include "blactl/fleet/restart_job.hpp"
#include "blactl/fleet/session.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

struct RestartPlan {
  RestartKind kind = RestartKind::save;
  Duration stagger{};                  ///< between the requests to two servos
  std::optional<Duration> come_back{}; ///< empty: 5 s, and 2 s for each that will ask for an ID
  Patience patience;
  /// Nobody else of this machine allocates on the interface: this process may.
  bool may_allocate = false;
};

/// How the restart of one servo ended.
struct Restarted {
  const Member* before = nullptr;
  Member* after = nullptr; ///< null: not back, see `error`
  std::optional<Error> error{};
  Duration duration{};
  bool is_sent = false; ///< the request left this machine, or may have
};

/// Sends each servo its request and waits for all of them; a servo that asks for a node ID gets the
/// one it had, unless another allocator is heard. The servos have been identified. If the session
/// ends in between, `error` of each tells how far it was, and `broken` why.
struct RestartResult {
  std::vector<Restarted> servos;
  std::optional<Error> broken{};
  std::optional<dronecan::NodeId> other_allocator{};
};

[[nodiscard]] RestartResult restart(Session& session, std::span<Member* const> servos,
                                    const RestartPlan& plan);

/// Whether this servo will have to ask for a node ID when it starts, as far as is known.
[[nodiscard]] bool will_ask_for_id(const Member& servo, RestartKind kind);

} // namespace blactl::fleet
