#pragma once
// Which model a servo is, how sure that is, and what may be written to it (requirements 85-93).

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::bla {

/// What a servo says of itself; empty where it did not answer.
struct Readings {
  std::optional<std::int64_t> model_number;     ///< 0x50
  std::optional<std::int64_t> serial_number;    ///< 0x51
  std::optional<std::int64_t> firmware_version; ///< 0x52
  std::optional<std::int64_t> hardware_version; ///< 0x53
};

/// Every model that agrees with the readings. The series follows from 0x50, the voltage class from
/// the thousands of 0x53, the suffix from its last three digits (010: A0, 050: AB); 0x53 "changes
/// with the production period" (4.43), so digits that no profile lists leave several candidates.
class Identity {
 public:
  Identity() = default;
  Identity(const Profiles& profiles, const Readings& readings);
  /// `profile` is what the user says: --profile. It fills what the servo's own answers leave open,
  /// for reading: what may be written follows from the answers alone.
  /// Errors: model_mismatch against a successful identification.
  [[nodiscard]] Result<void> assume(const Profile& profile);

  [[nodiscard]] const Readings& readings() const { return readings_; }

  /// The model, if nothing else fits; what the user says, if that is left open; else null.
  [[nodiscard]] const Profile* profile() const;

  /// One candidate, and 0x53 is exactly what table 3-12 lists for it.
  [[nodiscard]] bool certain() const { return certain_; }

  /// "BLA21-12U-AB"; what all candidates share ("BLA21-12U", "BLA21"); empty: unknown.
  [[nodiscard]] std::string model() const;

  /// The register as the model describes it, to read and show it; as all models together where the
  /// candidates differ or there are none. Null: no model has it.
  [[nodiscard]] const Parameter* parameter(Address address) const;

  /// Whether this servo's firmware has the register. Unknown firmware: assumed.
  [[nodiscard]] bool has(const Parameter& parameter) const;

  /// Those of these registers that this servo has, in their order.
  [[nodiscard]] std::vector<const Parameter*> registers(std::span<const Address> addresses) const;

  /// The registers that SAVE keeps (0x20-0x46, 4.11), as far as this servo has them, by address.
  [[nodiscard]] std::vector<const Parameter*> configuration() const;

  /// What they hold after ERASE (4.9). Errors: no_profile, where the model is not known well
  /// enough.
  [[nodiscard]] Result<Values> factory_defaults() const;

  /// Whether this servo takes commands by PWM, as far as its model is known.
  /// Errors: unsupported (firmware, no PWM input).
  [[nodiscard]] Result<void> check_pwm_input() const;

  /// Whether this model takes a register of the group pwm, as far as it is known; of others nothing
  /// is said. Errors: unsupported.
  [[nodiscard]] Result<void> check_pwm_input(const Parameter& parameter) const;

  /// Whether `raw` may be sent to `address` of this servo: never on a guess of the model, never
  /// what firmware or model lack, never outside of the range.
  /// Errors: no_profile (unknown model; or candidates disagree about this register),
  /// unsupported (firmware, no PWM input), read_only, out_of_range.
  [[nodiscard]] Result<void> may_write(Address address, std::int64_t raw) const;

 private:
  [[nodiscard]] Result<void> check_model(const Parameter& parameter) const;
  [[nodiscard]] Result<void> check_support(const Parameter& parameter) const;

  const Profiles* profiles_ = nullptr;
  Readings readings_;
  std::vector<const Profile*> candidates_;
  bool class_known_ = false;  ///< the thousands of 0x53 are those of a profile
  bool suffix_known_ = false; ///< so are its last three digits
  bool certain_ = false;
  const Profile* assumed_ = nullptr;
};

} // namespace blactl::bla
