#pragma once
// The progress of servos during apply: a list on the terminal for people, a file for programs.

#include "blactl/fleet/change/change.hpp"
#include "blactl/fleet/change/change_job.hpp"

#include "cli/change/event_file.hpp"
#include "cli/context.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

class ApplyWatch {
 public:
  /// Both outlive this. `events` may be null.
  ApplyWatch(Context& context, EventFile* events) : context_(context), events_(events) {}

  /// Takes the plan for each servo.
  void begin(std::span<const fleet::GoalResult> planned);

  void enter(const fleet::Servo& servo, fleet::ChangeStage stage);

  /// Takes the results, in the order of begin(), and removes the list.
  void end(std::span<const fleet::GoalResult> results);

 private:
  struct Line {
    fleet::Servo servo;
    std::string name;
    std::optional<fleet::ChangeStage> stage{}; ///< empty: not started yet
    bool has_work = false;
  };

  void tell(const fleet::Servo& servo, std::string_view stage, std::string_view status);
  void draw();
  void show(const std::string& list);

  Context& context_;
  EventFile* events_;
  std::vector<Line> lines_;
  bool has_reader_ = true;
};

} // namespace blactl::cli
