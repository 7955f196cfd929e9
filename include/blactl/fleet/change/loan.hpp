#pragma once
// A temporary change: one setting of several servos is changed in RAM for a time, and restored at
// the end, after Ctrl-C and after a restart.

#include "blactl/base/error.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/change.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

/// 0x20 off, so that the shaft can be turned by hand. When torque comes on, earlier commands are
/// discarded: the shaft holds its position; after a speed or torque it stands still (BLA spec rev
/// 1.11, 4.13).
[[nodiscard]] bla::Assignment torque_off(const bla::Profiles& profiles);

/// The result of restoring: the final value of the register decides, if it can be read.
struct GivenBack {
  std::vector<dronecan::NodeId> servos; ///< were changed, and have their former value again
  std::vector<std::string> notes;       ///< other events of servos with their former value
  std::vector<Error> errors;            ///< for all others, with the command to type
};

/// Call prepare(), then take(); in the end give_back() or give_up().
class Loan {
 public:
  /// Both references outlive this. `borrowed`: the temporary value.
  Loan(Session& session, const bla::Profiles& profiles, bla::Assignment borrowed,
       Change::Options options);

  /// Errors: as Change::prepare().
  [[nodiscard]] std::vector<Error> prepare(std::span<const dronecan::NodeId> servos);

  /// The change itself: its notes, its question, and its results.
  [[nodiscard]] const Change& change() const { return change_; }

  /// Reads the register again, as the question may take a while. Errors: state: it differs from the
  /// plan; why a servo could not be read.
  [[nodiscard]] std::vector<Error> look_again();

  /// Changes them, once. Servos that a write may have reached are to be restored, however this
  /// ended; the others are watched for keeping their value. Errors: as Change::carry_out().
  [[nodiscard]] std::vector<Error> take();

  /// Those to be restored, ascending.
  [[nodiscard]] std::vector<dronecan::NodeId> servos() const;

  /// Those proven to hold the temporary value, ascending.
  [[nodiscard]] std::vector<dronecan::NodeId> taken() const;

  /// Restores the servos, and removes the change from the record. Nothing is written to a servo
  /// that restarted since (its ROM has decided), that another node has set, or that the guard
  /// refuses. A first signal meanwhile does not end it, within the grace of the session; a second
  /// one does.
  [[nodiscard]] GivenBack give_back();

  /// Replaces give_back() if nothing may be sent any more: returns the errors.
  [[nodiscard]] GivenBack give_up();

 private:
  enum class State : std::uint8_t {
    untouched, ///< nothing was written to it
    borrowed,
    given,
    left, ///< no longer ours to restore
  };

  struct Held {
    Servo servo;             ///< as planned
    std::int64_t before = 0; ///< the former value
    std::uint32_t boot = 0;  ///< after the change
    bool is_taken = false;
    State state = State::untouched;
    std::optional<Error> error{}; ///< why it is not restored
  };

  [[nodiscard]] std::vector<Snapshot> read(std::span<const dronecan::NodeId> ids);
  void try_to_give_back();
  [[nodiscard]] GivenBack conclude();
  [[nodiscard]] bool tell(const Held& held, const Snapshot& now, GivenBack& given) const;
  [[nodiscard]] bool tell_unread(const Held& held, const Error& why, GivenBack& given) const;
  [[nodiscard]] std::optional<Goal> judge(const Snapshot& now, Held& held) const;
  [[nodiscard]] std::optional<Error> saved_by_another(const Held& held, const Snapshot& now) const;
  [[nodiscard]] std::optional<std::string> what_happened(const Held& held,
                                                         const Snapshot& now) const;
  [[nodiscard]] std::vector<dronecan::NodeId>
  ids_of(const std::function<bool(const Held& held)>& which) const;
  [[nodiscard]] std::optional<std::int64_t> value(const Snapshot& snapshot) const;
  [[nodiscard]] std::string shown(std::int64_t raw) const;
  [[nodiscard]] Error not_given_back(const Held& held, const Error& reason) const;
  [[nodiscard]] Error error_of(const Held& held, std::string message, const Error& reason) const;

  Session& session_;
  const bla::Profiles& profiles_;
  bla::Assignment borrowed_;
  Change::Options options_;
  Change change_;
  std::vector<Held> held_;
  Time since_{}; ///< the time of the change
};

} // namespace blactl::fleet
