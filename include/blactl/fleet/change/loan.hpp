#pragma once
// A change with its way back: one setting of several servos is changed in RAM for a time, and given
// back at the end, after Ctrl-C and after a restart.

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

/// 0x20 off, so that a hand can turn the shaft. Torque that comes on discards what was commanded
/// before: the shaft holds where it is, after a speed or torque it stands (BLA spec
/// rev 1.11, 4.13).
[[nodiscard]] bla::Assignment torque_off(const bla::Profiles& profiles);

/// How servos got back what they held: what the register holds in the end decides, as far as they
/// answer.
struct GivenBack {
  std::vector<dronecan::NodeId> servos; ///< were changed, and hold again what they held
  std::vector<std::string> notes;       ///< what else happened to those that hold what they held
  std::vector<Error> errors; ///< of those that do not, or do not answer, with what to type
};

/// First prepare(), then take(); in the end give_back() or give_up().
class Loan {
 public:
  /// Both references outlive this. `borrowed`: what each servo holds for the time being.
  Loan(Session& session, const bla::Profiles& profiles, bla::Assignment borrowed,
       Change::Options options);

  /// Errors: as Change::prepare().
  [[nodiscard]] std::vector<Error> prepare(std::span<const dronecan::NodeId> servos);

  /// The change itself: its notes, its question, and its results.
  [[nodiscard]] const Change& change() const { return change_; }

  /// Reads the register once more: a person takes time to say yes. Errors: state: it is not what
  /// the plan rests on; why a servo could not be read.
  [[nodiscard]] std::vector<Error> look_again();

  /// Changes them, once. Whom a write may have reached is to be given back, however this ended; of
  /// the others it is watched whether they keep what they hold. Errors: as Change::carry_out().
  [[nodiscard]] std::vector<Error> take();

  /// Those that are to be given back, ascending.
  [[nodiscard]] std::vector<dronecan::NodeId> servos() const;

  /// Those that are proven to hold what was borrowed, ascending.
  [[nodiscard]] std::vector<dronecan::NodeId> taken() const;

  /// What is recorded of the change is taken back with it. Nothing is written to a servo that
  /// restarted since (its ROM has decided), that another node has set, or that the guard names. A
  /// signal that comes first meanwhile does not end it, within the grace of the session; a second
  /// one does.
  [[nodiscard]] GivenBack give_back();

  /// In place of that, where nothing may be sent any more: the errors that are due.
  [[nodiscard]] GivenBack give_up();

 private:
  enum class State : std::uint8_t {
    untouched, ///< nothing was written to it
    borrowed,
    given,
    left, ///< it is not ours any more
  };

  struct Held {
    Servo servo;             ///< as it was planned
    std::int64_t before = 0; ///< what the register held
    std::uint32_t boot = 0;  ///< when it had been changed
    bool is_taken = false;
    State state = State::untouched;
    std::optional<Error> error{}; ///< why it is not given back
  };

  [[nodiscard]] std::vector<Snapshot> read(std::span<const dronecan::NodeId> ids);
  void try_to_give_back();
  [[nodiscard]] GivenBack conclude();
  [[nodiscard]] bool tell(const Held& held, const Snapshot& now, GivenBack& given) const;
  [[nodiscard]] bool tell_unread(const Held& held, const Error& why, GivenBack& given) const;
  [[nodiscard]] std::optional<Goal> judge(const Snapshot& now, Held& held) const;
  [[nodiscard]] std::optional<std::string> what_happened(const Held& held,
                                                         const Snapshot& now) const;
  [[nodiscard]] std::vector<Held*> pending();
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
  Time since_{}; ///< when they were changed
};

} // namespace blactl::fleet
