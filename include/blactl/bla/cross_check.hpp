#pragma once
// Checks of a change beyond its range: one table for every command that writes (contract, section
// 4).

#include "blactl/base/text.hpp"
#include "blactl/bla/identity.hpp"
#include "blactl/bla/values.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace blactl::bla {

/// A change of one register, among all changes of a plan.
struct Proposal {
  Address address;
  std::int64_t requested = 0;
  const Values& before; ///< present settings and measured values of the servo
  const Values& after;  ///< the same with all changes of the plan
  const Identity& servo;
};

/// The consequence: the change is refused, needs confirmation, or is made with a warning.
enum class CheckKind : std::uint8_t { refusal, question, warning };
[[nodiscard]] std::string_view name(CheckKind kind);

/// The name of the check without a reason: the question itself gives it.
inline constexpr std::string_view always_asked = "always_asked";

struct CrossCheck {
  std::string_view code;
  CheckKind kind;
  std::span<const Address> of;    ///< a change of these is checked
  std::span<const Address> needs; ///< these values are used, too
  /// Questions assume the worst of unknown values; the others fire only on known ones.
  bool (*fires)(const Proposal& change);
  Text reason;               ///< without arguments
  std::string_view remedy{}; ///< what a refused change needs first: "speed_torque_control=on"

  [[nodiscard]] bool is_about(Address address) const;
};

/// All cross-checks: refusals, questions, warnings.
[[nodiscard]] std::span<const CrossCheck> cross_checks();

/// The registers whose values are needed to check a change of `address`.
[[nodiscard]] std::vector<Address> values_needed(Address address);

/// The checks of `kind` that fire for this change, in the order of the table.
[[nodiscard]] std::vector<const CrossCheck*> met(CheckKind kind, const Proposal& change);

/// Whether the change can move the shaft or release the load: a question fires.
[[nodiscard]] bool may_move(const Proposal& change);

} // namespace blactl::bla
