#pragma once
// The snapshots of several servos, read at once.

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/snapshot.hpp"

#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

struct Snapshots {
  std::vector<Snapshot> servos;  ///< in the order asked
  std::optional<Error> broken{}; ///< the error that ended the session early: they are incomplete
};

/// Reads the registers named by `choice` from several servos at once. On a recording nothing is
/// proven, whatever `proof`.
[[nodiscard]] Snapshots take_snapshots(Session& session, const bla::Profiles& profiles,
                                       std::span<const dronecan::NodeId> servos,
                                       const Identification::Options& options,
                                       const ReadJob::Choice& choice,
                                       ReadJob::Proof proof = ReadJob::Proof::moment,
                                       const ReadJob::More& more = {});

} // namespace blactl::fleet
