#pragma once
// Jobs on a recording: they wait until all of it was heard, and then get their responses at once.

#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/bus/replayed_answers.hpp"

#include <vector>

namespace blactl::fleet {

class ReplayedJobs {
 public:
  /// `roster` outlives this.
  explicit ReplayedJobs(const Roster& roster) : answers_(roster) {}

  /// Takes every transfer of the recording, after the roster.
  void receive(const dronecan::Transfer& transfer) { answers_.receive(transfer); }

  /// See ReplayedAnswers::recall().
  void recall(dronecan::NodeId node, bla::Address address, std::int64_t raw) {
    answers_.recall(node, address, raw);
  }

  /// Begins a job: at once if all has been heard, else later. Jobs and hooks may call it.
  void start(dronecan::Job& job);

  [[nodiscard]] bool finished() const { return finished_; }

  /// The whole recording has been heard.
  void finish();

  /// Nothing more will be heard: waiting jobs are cancelled.
  void cancel();

 private:
  void play(dronecan::Job& job) const;

  ReplayedAnswers answers_;
  std::vector<dronecan::Job*> waiting_;
  bool finished_ = false;
};

} // namespace blactl::fleet
