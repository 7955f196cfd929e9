#pragma once
// monitor --identify: switches the torque off, so that the wanted servo can be turned by hand.

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

  /// Opens the session and switches off the torque of the selected servos (without -n: all), after
  /// a yes. False: the command ends here, and the report has the reason. end() must follow in any
  /// case.
  [[nodiscard]] bool begin(fleet::Targets targets);

  /// Switches the torque back on, after a warning. `may_ask`: a user is present and may be asked to
  /// take the hands away.
  void end(bool may_ask);

  /// The selected servos that kept their torque, as far as known.
  [[nodiscard]] std::vector<dronecan::NodeId> holding() const;

  /// The errors of single servos.
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
