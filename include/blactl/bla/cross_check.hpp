#pragma once
// What a change asks for beyond its range: one table for every command that writes (contract,
// section 4).

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
  const Values& before; ///< what the servo holds and measures now
  const Values& after;  ///< the same with all changes of the plan
  const Identity& servo;
};

/// What comes of it: it is not done at all, only after a yes, or with a word beside it.
enum class CheckKind : std::uint8_t { refusal, question, warning };
[[nodiscard]] std::string_view name(CheckKind kind);

/// Of the check that needs no reason: the question says it.
inline constexpr std::string_view always_asked = "always_asked";

struct CrossCheck {
  std::string_view code;
  CheckKind kind;
  std::span<const Address> of;    ///< a change of these is judged
  std::span<const Address> needs; ///< by these too
  /// A question counts what is not known as the worst; the others need to know.
  bool (*fires)(const Proposal& change);
  Text reason;               ///< without arguments
  std::string_view remedy{}; ///< what a refused change needs first: "speed_torque_control=on"

  [[nodiscard]] bool is_about(Address address) const;
};

/// All of them: refusals, questions, warnings.
[[nodiscard]] std::span<const CrossCheck> cross_checks();

/// The registers whose values they need to judge a change of `address`.
[[nodiscard]] std::vector<Address> values_needed(Address address);

/// Those of `kind` that this change meets, in the order of the table.
[[nodiscard]] std::vector<const CrossCheck*> met(CheckKind kind, const Proposal& change);

/// Whether it can move the shaft or let go of the load: it meets a question.
[[nodiscard]] bool may_move(const Proposal& change);

} // namespace blactl::bla
