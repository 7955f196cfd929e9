#include "blactl/fleet/bus/replayed_jobs.hpp"

#include <utility>

namespace blactl::fleet {

using dronecan::Outcome;

void ReplayedJobs::start(dronecan::Job& job) {
  if (finished_) {
    play(job);
  } else {
    waiting_.push_back(&job);
  }
}

void ReplayedJobs::play(dronecan::Job& job) const {
  Outcome outcome;
  for (;;) {
    const dronecan::Step step = job.next(outcome);
    if (step.is_end()) {
      return;
    }
    // On a log a pause ends at once: nothing more will be heard.
    outcome = step.request() != nullptr ? answers_.answer(*step.request())
                                        : Outcome{Outcome::Kind::woken, {}, {}};
  }
}

void ReplayedJobs::finish() {
  finished_ = true;
  for (dronecan::Job* job : std::exchange(waiting_, {})) {
    play(*job);
  }
}

void ReplayedJobs::cancel() {
  finished_ = true;
  for (dronecan::Job* job : std::exchange(waiting_, {})) {
    if (!job->next({})
             .is_end()) { // its first request, to which the end of the session is the outcome
      (void)job->next({Outcome::Kind::cancelled, {}, {}});
    }
  }
}

} // namespace blactl::fleet
