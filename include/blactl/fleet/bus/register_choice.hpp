#pragma once
// The registers selected by the user, before any servo is known.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/snapshot.hpp"

#include <expected>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::fleet {

/// The groups of these names, comma-separated (contract, section 7). Errors: usage, with the
/// nearest or all names.
[[nodiscard]] Result<std::set<bla::Group>> parse_groups(std::string_view list);

/// The register as defined for this servo; null: it has none.
[[nodiscard]] const bla::Parameter* own_register(const bla::Parameter& parameter,
                                                 const Servo& servo);

/// The reason why a servo has no such register. Errors: unsupported (firmware, no PWM input).
[[nodiscard]] Error lacking(const bla::Parameter& parameter, const Servo& servo);

/// Single registers, groups of them, or all readable ones.
class RegisterChoice {
 public:
  /// Neither names nor groups: all. `profiles` outlives the choice. Errors, all of them, in the
  /// order typed: unknown_parameter, unsupported (reserved, or write-only), usage.
  [[nodiscard]] static std::expected<RegisterChoice, std::vector<Error>>
  parse(const bla::Profiles& profiles, std::span<const std::string> names,
        std::span<const std::string> groups);

  /// Those that this servo has, in the order asked, then by address; 0x37, too, if the unit of
  /// another depends on it.
  [[nodiscard]] std::vector<const bla::Parameter*> registers_of(const Servo& servo) const;

  /// The reasons why selected single registers cannot be read from it: unsupported (firmware).
  [[nodiscard]] std::vector<Error> refusals(const Servo& servo) const;

  /// The selected ones among all readings.
  [[nodiscard]] std::vector<Reading> asked_for(const Snapshot& snapshot) const;

 private:
  [[nodiscard]] bool means(const bla::Parameter& parameter) const;

  [[nodiscard]] bool is_everything() const { return named_.empty() && groups_.empty(); }

  const bla::Profiles* profiles_ = nullptr;
  std::vector<const bla::Parameter*> named_; ///< in the order asked
  std::set<bla::Group> groups_;
};

} // namespace blactl::fleet
