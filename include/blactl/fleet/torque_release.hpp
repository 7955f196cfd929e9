#pragma once
// Lets go of shafts so that a hand can turn them, and gives them their torque back.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/carry_out.hpp"
#include "blactl/fleet/plan.hpp"
#include "blactl/fleet/session.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

/// What is wanted of a servo that is let go: 0x20 off, in RAM only.
[[nodiscard]] Wanted wanted_to_let_go(const bla::Profiles& profiles);

/// How servos got their torque back.
struct GivenBack {
  std::vector<dronecan::NodeId> servos; ///< hold again what they held
  std::vector<std::string> notes;       ///< whose torque is not ours to give back any more, and why
  std::vector<Error> errors;            ///< of those that are still without it, with what to type
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

  /// Carries out plans for wanted_to_let_go(). Whom a write may have reached is to get its torque
  /// back, however this ended.
  [[nodiscard]] CarriedOut let_go(std::span<const Plan> plans, const Manner& manner);

  /// Those that are to get their torque back, ascending.
  [[nodiscard]] std::vector<dronecan::NodeId> servos() const;

  /// What is recorded of the change in `history` is taken back with it. Nothing is written to a
  /// servo that restarted (its ROM has decided), that another node has set, or that forbidden()
  /// names. A signal that comes first meanwhile does not end it, within the grace of the session; a
  /// second one does.
  [[nodiscard]] GivenBack give_back(bool while_driven, History* history);

  /// In place of that, where nothing may be sent any more: what is to be said.
  [[nodiscard]] GivenBack give_up();

 private:
  enum class State : std::uint8_t { let_go, given, left };

  struct Held {
    Servo servo;
    std::int64_t output = 0; ///< 0x20 before
    State state = State::let_go;
    std::string note{};           ///< why it is left
    std::optional<Error> error{}; ///< why it is not given back
  };

  void try_to_give_back(bool while_driven);
  [[nodiscard]] GivenBack conclude(History* history) const;
  [[nodiscard]] std::optional<Plan> judge(Snapshot now, Held& held, bool while_driven) const;
  [[nodiscard]] Wanted wanted_back(const Held& held) const;
  [[nodiscard]] std::vector<Held*> pending();
  [[nodiscard]] Error not_given_back(const Held& held, const Error& reason) const;

  Session& session_;
  const bla::Profiles& profiles_;
  Identification::Options identification_;
  std::vector<Held> held_;
};

} // namespace blactl::fleet
