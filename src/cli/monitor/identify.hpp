#pragma once
// monitor --identify: servos without torque, so that a hand can turn the one that is looked for.

#include "blactl/fleet/bus/target.hpp"
#include "blactl/fleet/change/loan.hpp"

#include "cli/change/writing_run.hpp"

#include <optional>
#include <vector>

namespace blactl::cli {

class Identify : WritingRun {
 public:
  /// Both references outlive this.
  Identify(Context& context, Report& report) : WritingRun(context, report) {}

  /// Opens the session and takes the torque of the servos that are meant (without -n: all of them),
  /// after a yes. False: the command ends here, and the report says why. In any case end() follows.
  [[nodiscard]] bool begin(fleet::Targets targets);

  /// Gives them their torque back, after a word of warning. `may_ask`: a person sits there and may
  /// be asked to take the hands away.
  void end(bool may_ask);

  /// Those that are meant and kept their torque, as far as is known.
  [[nodiscard]] std::vector<dronecan::NodeId> holding() const;

  /// What went wrong at single servos.
  [[nodiscard]] const std::vector<Error>& errors() const { return errors_; }

 private:
  bool select(const fleet::Targets& targets);
  bool prepare();
  bool stop_at(std::vector<Error> errors);
  bool confirm();
  bool look_again();
  bool let_go();
  [[nodiscard]] bool warn(bool may_ask);
  void conclude(fleet::GivenBack given);

  std::vector<dronecan::NodeId> servos_;
  std::optional<fleet::Loan> loan_;
  std::vector<Error> errors_;
};

} // namespace blactl::cli
