#pragma once
// A register of a BLA servo as the specification describes it (tables 3-1 to 3-12).

#include "blactl/bla/address.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::bla {

/// The value of 0x00-0x02 while another kind of command is active (4.1): never shown or sent.
inline constexpr std::int64_t not_active = 555'555'555;

enum class Group : std::uint8_t {
  command,
  status,
  operation,
  fault,
  config,
  control,
  pwm,
  limit,
  option,
  product,
  production,
};

[[nodiscard]] std::string_view name(Group group);
[[nodiscard]] std::optional<Group> find_group(std::string_view word);

/// All groups, in the order of their addresses.
[[nodiscard]] std::span<const Group> all_groups();

enum class Access : std::uint8_t { read, write, read_write };

/// "R", "W", "RW".
[[nodiscard]] std::string_view name(Access access);

/// The unit for people; registers count whole units or tenths.
enum class Unit : std::uint8_t {
  none,
  deg,
  rpm,
  percent,
  ampere,
  volt,
  microsecond,
  millisecond,
  deg_celsius,
  deg_or_rpm, ///< 0x36: tenths of a degree if 0x37 = 0, else rpm
  year,
  month,
  day,
  hour,
  minute,
};

/// The unit as typed and shown: "deg", "%", "us", "degC"; "" for none; "deg/rpm" for 0x36, which
/// accepts either.
[[nodiscard]] std::string_view name(Unit unit);

/// One word of an enumeration register.
struct Choice {
  std::int64_t raw = 0;
  std::string word; ///< as typed: "off", "brake"
  std::string text_en, text_ja;
  friend bool operator==(const Choice&, const Choice&) = default;
};

/// How the 64-bit integer of GetSet is narrowed to the register (vendor program's casts).
struct Width {
  std::uint8_t bits = 32;
  bool is_signed = true;
  friend bool operator==(Width, Width) = default;

  /// The register's number in the low bits of `wire`, sign-extended if signed.
  [[nodiscard]] std::int64_t narrow(std::int64_t wire) const;
  /// Whether narrow() loses nothing: `wire` is a number of this width, with or without a sign.
  [[nodiscard]] bool holds(std::int64_t wire) const;
  /// The least and the greatest value of this width.
  [[nodiscard]] std::int64_t lowest() const;
  [[nodiscard]] std::int64_t highest() const;
};

/// One register of one model.
struct Parameter {
  Address address;
  std::string name; ///< "angle_limit_cw"
  Group group = Group::command;
  std::string name_en, name_ja, vendor_label;
  Access access = Access::read;
  Unit unit = Unit::none;
  std::int64_t steps_per_unit = 1; ///< 10 if the register counts tenths (0x36: of a degree)
  Width width;
  std::optional<std::int64_t> default_raw, min, max; ///< register numbers
  bool saved = false;                                ///< kept by SAVE (4.11)
  bool per_model = false;                            ///< table 3-12 gives its default and range
  bool by_voltage_class = false;                     ///< they depend on the voltage class
  bool by_suffix = false;                            ///< they depend on the suffix
  std::optional<std::int64_t> min_firmware;          ///< the 0x52 that introduced it
  std::vector<Choice> choices;                       ///< empty: a number
  bool can_be_inactive = false;                      ///< 0x00-0x02: not_active is possible
  std::string section;                               ///< of the specification: "4.20"
  std::string meaning_en, meaning_ja;                ///< in a sentence or two
  std::vector<Address> see;                          ///< related registers

  /// An example value if the models differ in the default: one that all accept, or one model's.
  struct Example {
    std::int64_t raw = 0;
    std::string model; ///< empty: every model accepts it
    friend bool operator==(const Example&, const Example&) = default;
  };

  std::optional<Example> example;
  friend bool operator==(const Parameter&, const Parameter&) = default;

  [[nodiscard]] bool readable() const { return access != Access::write; }

  [[nodiscard]] bool writable() const { return access != Access::read; }

  /// Whether SAVE keeps it and ERASE sets its default (4.9, 4.11): it changes by itself only when
  /// the servo restarts, and files hold it.
  [[nodiscard]] bool is_setting() const { return saved && readable() && writable(); }

  [[nodiscard]] bool exists_in(std::int64_t firmware) const {
    return !min_firmware || firmware >= *min_firmware;
  }

  [[nodiscard]] const Choice* choice(std::int64_t raw) const;

  /// The number of units in one step is 1 / steps_per_unit: "0.1" or "1".
  [[nodiscard]] std::string_view scale() const { return steps_per_unit == 10 ? "0.1" : "1"; }
};

/// Whether a name, an explanation or a word of this register, in either language, has this in it;
/// letters of either case.
[[nodiscard]] bool mentions(const Parameter& parameter, std::string_view text);

} // namespace blactl::bla
