#pragma once
// Model profiles: the registers, ranges and faults of each BLA model of table 3-12. Data only.

#include "blactl/base/error.hpp"
#include "blactl/bla/parameter.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::bla {

enum class Level : std::uint8_t { notice, warning, failure };
[[nodiscard]] std::string_view name(Level level);

inline constexpr std::uint8_t fault_register_bits = 32;

/// One bit of 0x19 (notice), 0x1A (warning) or 0x1B (failure), or of their summary 0x18: 4.12.
struct FaultBit {
  Address reg;
  std::uint8_t bit = 0;
  Level level = Level::notice;
  std::string group; ///< hardware, software, communication, other
  std::string code;  ///< contract, section 7: "voltage_low"; empty: a bit of 0x18
  bool pwm_only = false;
  bool latched = false;     ///< shows why the servo restarted, stays until the next start
  bool output_off = false;  ///< its cause holds the motor output off (4.7, 4.8, 4.12)
  bool vendor_only = false; ///< shown by the vendor's program, absent in the specification
  std::string text_en, text_ja, condition_en, condition_ja, action_en, action_ja;
  std::vector<Address> values; ///< related registers: the measured value and its limit
  /// What sets it as well, where the measured value is within its limit; empty: nothing.
  std::string or_condition_en, or_condition_ja;
  std::vector<Address> or_values;
};

/// "hardware", "software", "communication", "other": one byte each in every fault register (4.12).
[[nodiscard]] std::string_view fault_group(std::uint8_t bit);

/// The bit of 0x18 that shows that this bit of the register of `level`, or another of its group, is
/// set (4.12).
[[nodiscard]] std::uint8_t summary_bit(Level level, std::uint8_t bit);

/// One release of the servos' firmware (chapter 5).
struct FirmwareRelease {
  /// The models that left the factory with it, and when: "BLA21-**U-AB2", "2021-10", "2022-04".
  struct Shipment {
    std::string models;
    std::string from, until; ///< year and month; `until` is empty if still shipping

    /// Whether a model is covered: in `models` a star matches any character, and the last character
    /// is a digit of labels that does not distinguish models.
    [[nodiscard]] bool covers(std::string_view model) const;
  };

  std::int64_t version = 0; ///< as in 0x52: 1400 is 1.400
  std::vector<Shipment> shipments;
  std::string changes_en, changes_ja;
};

/// The version as the specification writes it: 1400 is "1.400".
[[nodiscard]] std::string firmware_text(std::int64_t version);

/// One model: series, voltage class and suffix, e.g. BLA21-12U-AB.
struct Profile {
  std::string model;                 ///< "BLA21-12U-AB"
  std::string series;                ///< "BLA21"
  std::string voltage_class;         ///< "12U"
  std::string suffix;                ///< "A0", "AB"
  bool pwm = false;                  ///< has a PWM input
  std::int64_t model_number = 0;     ///< 0x50
  std::int64_t hardware_version = 0; ///< 0x53
  std::vector<Parameter> parameters; ///< ascending by address, without reserved ones

  [[nodiscard]] const Parameter* find(Address address) const;

  /// Whether this model accepts any value for this register.
  [[nodiscard]] bool takes(const Parameter& parameter) const {
    return parameter.writable() && (parameter.group != Group::pwm || pwm);
  }
};

/// All profiles: those built in, and those of a directory, which add to or replace them.
class Profiles {
 public:
  /// Reads the built-in profiles, then every *.json of `directory`, if given, except *.schema.json:
  /// a model there replaces the built-in one of that name, a family there the built-in one. Errors:
  /// bad_file with file, place and reason of every fault.
  [[nodiscard]] static Result<Profiles> load(const std::optional<std::filesystem::path>& directory);

  [[nodiscard]] std::span<const Profile> all() const { return profiles_; }

  [[nodiscard]] std::span<const FaultBit> fault_bits() const { return fault_bits_; }

  /// The bits of 0x18, which summarise the other three registers.
  [[nodiscard]] std::span<const FaultBit> summary_bits() const { return summary_bits_; }

  /// A bit of 0x18-0x1B; null: undocumented.
  [[nodiscard]] const FaultBit* fault_bit(Address reg, std::uint8_t bit) const;

  /// Ascending by version.
  [[nodiscard]] std::span<const FirmwareRelease> firmware() const { return firmware_; }

  /// The releases shipped in this model, from the first to the last: each includes those before it.
  [[nodiscard]] std::vector<const FirmwareRelease*> releases_of(const Profile& profile) const;

  /// The models matching `text`: a full name, its beginning ("BLA21-12U"), or a label with its last
  /// digit ("BLA21-12U-AB2"); letters of either case. Empty: none.
  [[nodiscard]] std::vector<const Profile*> matching(std::string_view text) const;

  /// Every register that some model has, with the union of the ranges of all models in which it is
  /// writable: these refuse values outside; models without a PWM input hold 0 in 0x34-0x37. No
  /// default if models differ. Ascending by address.
  [[nodiscard]] std::span<const Parameter> registers() const { return registers_; }

  [[nodiscard]] const Parameter* find(Address address) const;

  [[nodiscard]] bool is_setting(Address address) const {
    const Parameter* known = find(address);
    return known != nullptr && known->is_setting();
  }

  /// The same register for an unknown model: without range and default.
  [[nodiscard]] const Parameter* find_of_unknown(Address address) const;

  /// The register given by an address ("0x38") or a name ("angle_limit_cw", "angle-limit-cw";
  /// letters of either case in both). Errors: unknown_parameter with the nearest names (vendor's
  /// labels are searched too); unsupported for a reserved address.
  [[nodiscard]] Result<const Parameter*> find(std::string_view text) const;

  /// The built-in models that the directory replaced.
  [[nodiscard]] std::span<const std::string> replaced() const { return replaced_; }

 private:
  std::vector<Profile> profiles_;
  std::vector<FaultBit> fault_bits_;
  std::vector<FaultBit> summary_bits_;
  std::vector<FirmwareRelease> firmware_;
  std::vector<Parameter> registers_;
  std::vector<Parameter> registers_of_unknown_;
  std::vector<std::string> replaced_;
};

} // namespace blactl::bla
