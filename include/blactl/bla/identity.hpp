#pragma once
// A servo's model, how certain it is, and what may be written to it (requirements 85-93).

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::bla {

/// The servo's identification registers; empty if it did not answer.
struct Readings {
  std::optional<std::int64_t> model_number;     ///< 0x50
  std::optional<std::int64_t> serial_number;    ///< 0x51
  std::optional<std::int64_t> firmware_version; ///< 0x52
  std::optional<std::int64_t> hardware_version; ///< 0x53
};

/// The models that agree with the readings. The series follows from 0x50, the voltage class from
/// the thousands of 0x53, the suffix from its last three digits (010: A0, 050: AB); 0x53 "changes
/// with the production period" (4.43), so digits that are in no profile leave several candidates.
class Identity {
 public:
  Identity() = default;
  Identity(const Profiles& profiles, const Readings& readings);
  /// Takes the user's word for the model (--profile). It fills what the servo's own answers leave
  /// open, for reading only: writing is allowed by the answers alone. Errors: model_mismatch
  /// against a successful identification.
  [[nodiscard]] Result<void> assume(const Profile& profile);

  [[nodiscard]] const Readings& readings() const { return readings_; }

  /// The model if only one fits; else the user's; else null.
  [[nodiscard]] const Profile* profile() const;

  /// Whether there is one candidate, with exactly the 0x53 that table 3-12 lists for it.
  [[nodiscard]] bool certain() const { return certain_; }

  /// "BLA21-12U-AB"; the part common to all candidates ("BLA21-12U", "BLA21"); empty: unknown.
  [[nodiscard]] std::string model() const;

  /// The register as described by the model, for reading and display; the union of all models if
  /// the candidates differ or there are none. Null: none of them has it.
  [[nodiscard]] const Parameter* parameter(Address address) const;

  [[nodiscard]] bool is_setting(Address address) const {
    const Parameter* known = parameter(address);
    return known != nullptr && known->is_setting();
  }

  /// Whether this servo's firmware has the register. Unknown firmware: assumed.
  [[nodiscard]] bool has(const Parameter& parameter) const;

  /// The given registers as far as this servo has them, in the same order.
  [[nodiscard]] std::vector<const Parameter*> registers(std::span<const Address> addresses) const;

  /// The settings (4.11: what the profile marks as saved), as far as this servo has them, by
  /// address.
  [[nodiscard]] std::vector<const Parameter*> configuration() const;

  /// Their values after ERASE (4.9). Errors: no_profile, if the model is not known well enough.
  [[nodiscard]] Result<Values> factory_defaults() const;

  /// Checks that this servo takes commands by PWM, as far as its model is known. Errors:
  /// unsupported (firmware, no PWM input).
  [[nodiscard]] Result<void> check_pwm_input() const;

  /// Checks that this model has the register and, in the group pwm, accepts values, as far as the
  /// model is known; without a PWM input `raw` may still be what it holds, 0 (table 3-12). Errors:
  /// unsupported.
  [[nodiscard]] Result<void> check_takes(const Parameter& parameter,
                                         std::optional<std::int64_t> raw = {}) const;

  /// Checks that `raw` may be sent to `address` of this servo: never on a guess of the model, never
  /// to a register that firmware or model lack, never outside the range. Errors: no_profile
  /// (unknown model; or candidates disagree about this register), unsupported (the model or its
  /// firmware lacks it, no PWM input), read_only, out_of_range.
  [[nodiscard]] Result<void> may_write(Address address, std::int64_t raw) const;

 private:
  [[nodiscard]] Result<void> check_model(const Parameter& parameter, std::int64_t raw) const;
  [[nodiscard]] Result<void> check_support(const Parameter& parameter) const;

  const Profiles* profiles_ = nullptr;
  Readings readings_;
  std::vector<const Profile*> candidates_;
  bool class_known_ = false;  ///< the thousands of 0x53 match a profile
  bool suffix_known_ = false; ///< so are its last three digits
  bool certain_ = false;
  const Profile* assumed_ = nullptr;
};

} // namespace blactl::bla
