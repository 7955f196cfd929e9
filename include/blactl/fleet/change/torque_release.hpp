#pragma once
// Lets go of shafts so that a hand can turn them, and gives them their torque back.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/carry_out.hpp"
#include "blactl/fleet/change/plan.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

/// What is wanted of a servo that is let go: 0x20 off, in RAM only.
[[nodiscard]] Wanted wanted_to_let_go(const bla::Profiles& profiles);

/// How servos got their torque back: what 0x20 holds in the end says so, as far as they answer.
struct GivenBack {
  std::vector<dronecan::NodeId> servos; ///< were let go, and hold again what they held
  std::vector<std::string> notes;       ///< what else happened to those that hold what they held
  std::vector<Error> errors; ///< of those that do not, or do not answer, with what to type
};

/// Servos that were let go, one after the other or all at once. Torque that comes on discards what
/// was commanded before: the shaft holds where it is, after a speed or torque it stands (BLA spec
/// rev 1.11, 4.13).
class TorqueRelease {
 public:
  /// Both references outlive this.
  TorqueRelease(Session& session, const bla::Profiles& profiles,
                Identification::Options identification)
      : session_(session), profiles_(profiles), identification_(identification) {}

  /// Reads 0x20 once more: a person takes time to say yes. Errors: state: it is not what the plan
  /// rests on; what keeps a servo from being read.
  [[nodiscard]] std::vector<Error> look_again(std::span<const Plan> plans);

  /// Carries out plans for wanted_to_let_go(), once. Whom a write may have reached is to get its
  /// torque back, however this ended; of the others it is watched whether they keep theirs.
  [[nodiscard]] CarriedOut let_go(std::span<const Plan> plans, const Manner& manner);

  /// Those that are to get their torque back, ascending.
  [[nodiscard]] std::vector<dronecan::NodeId> servos() const;

  /// Those that proved to have none now, ascending.
  [[nodiscard]] std::vector<dronecan::NodeId> loose() const;

  /// What is recorded of the change in `history` is taken back with it. Nothing is written to a
  /// servo that restarted since (its ROM has decided), that another node has set, or that
  /// forbidden() names. A signal that comes first meanwhile does not end it, within the grace of
  /// the session; a second one does.
  [[nodiscard]] GivenBack give_back(bool while_driven, History* history);

  /// In place of that, where nothing may be sent any more: what is to be said.
  [[nodiscard]] GivenBack give_up();

 private:
  enum class State : std::uint8_t {
    untouched, ///< nothing was written to it
    let_go,
    given,
    left, ///< it is not ours any more
  };

  struct Held {
    Servo servo;             ///< as it was planned
    std::int64_t output = 0; ///< 0x20 before
    std::uint32_t boot = 0;  ///< when it had been let go
    bool is_loose = false;
    State state = State::untouched;
    std::optional<Error> error{}; ///< why it is not given back
  };

  [[nodiscard]] std::vector<Snapshot> read(std::span<const dronecan::NodeId> ids);
  void try_to_give_back(bool while_driven);
  [[nodiscard]] GivenBack conclude(History* history);
  [[nodiscard]] bool tell(const Held& held, const Snapshot& now, GivenBack& given) const;
  [[nodiscard]] bool tell_unread(const Held& held, const Error& why, GivenBack& given) const;
  [[nodiscard]] std::optional<Plan> judge(Snapshot now, Held& held, bool while_driven) const;
  [[nodiscard]] std::optional<std::string> what_happened(const Held& held,
                                                         const Snapshot& now) const;
  [[nodiscard]] std::vector<Held*> pending();
  [[nodiscard]] std::vector<dronecan::NodeId>
  ids_of(const std::function<bool(const Held& held)>& which) const;
  [[nodiscard]] const bla::Parameter& parameter() const;
  [[nodiscard]] std::string shown(std::int64_t output) const;
  [[nodiscard]] Error not_given_back(const Held& held, const Error& reason) const;
  [[nodiscard]] Error error_of(const Held& held, std::string message, const Error& reason) const;

  Session& session_;
  const bla::Profiles& profiles_;
  Identification::Options identification_;
  std::vector<Held> held_;
  Time since_{}; ///< when they were let go
};

} // namespace blactl::fleet
