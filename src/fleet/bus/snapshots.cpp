#include "blactl/fleet/bus/snapshots.hpp"

#include <list>

namespace blactl::fleet {

Snapshots take_snapshots(Session& session, const bla::Profiles& profiles,
                         std::span<const dronecan::NodeId> servos,
                         const Identification::Options& options, const ReadJob::Choice& choice,
                         ReadJob::Proof proof, const ReadJob::More& more) {
  if (session.is_replay()) {
    proof = ReadJob::Proof::none;
  }
  std::list<ReadJob> jobs;
  std::vector<dronecan::Job*> group;
  for (const dronecan::NodeId id : servos) {
    group.push_back(
        &jobs.emplace_back(session.records(), id, profiles, options, choice, proof, more));
  }
  const auto ran = session.run(group);
  Snapshots snapshots;
  for (const ReadJob& job : jobs) {
    snapshots.servos.push_back(job.snapshot());
  }
  if (!ran) {
    snapshots.broken = ran.error();
  }
  return snapshots;
}

} // namespace blactl::fleet
