// Exact decimal arithmetic on integers: no value is ever rounded.

#include "blactl/bla/value.hpp"

#include "blactl/base/letter_case.hpp"
#include "blactl/bla/profile.hpp"

#include "bla/texts.hpp"
#include "bla/words.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

namespace blactl::bla {
namespace {

/// A unit that a person may type: raw = number * times / per.
struct TypedUnit {
  std::string_view name;
  std::int64_t times = 1;
  std::int64_t per = 1;
  std::optional<std::int64_t> pwm_mode{};
};

/// The accepted units; the one in which the register is shown comes first.
std::vector<TypedUnit> typed_units(const Parameter& parameter) {
  switch (parameter.unit) {
  case Unit::none:
  case Unit::year:
  case Unit::month:
  case Unit::day:
  case Unit::hour:
  case Unit::minute: return {};
  case Unit::microsecond: return {{"us", 1, 1}, {"ms", 1'000, 1}, {"s", 1'000'000, 1}};
  case Unit::millisecond: return {{"ms", 1, 1}, {"s", 1'000, 1}, {"us", 1, 1'000}};
  case Unit::deg_or_rpm: return {{"deg", parameter.steps_per_unit, 1, 0}, {"rpm", 1, 1, 1}};
  default: return {{name(parameter.unit), parameter.steps_per_unit, 1}};
  }
}

/// The parts of `[-]digits[.digits]unit`.
struct Number {
  bool negative = false;
  std::string_view whole;    ///< without leading zeros
  std::string_view fraction; ///< without trailing zeros
  bool has_point = false;
  std::string_view unit; ///< everything after the digits
};

std::size_t count_digits(std::string_view text) {
  return std::min(text.find_first_not_of("0123456789"), text.size());
}

/// Empty if `text` does not begin like a number.
std::optional<Number> split(std::string_view text) {
  Number number;
  if (text.starts_with('-')) {
    number.negative = true;
    text.remove_prefix(1);
  }
  number.whole = text.substr(0, count_digits(text));
  if (number.whole.empty()) {
    return std::nullopt;
  }
  text.remove_prefix(number.whole.size());
  if (text.starts_with('.')) {
    number.has_point = true;
    text.remove_prefix(1);
    number.fraction = text.substr(0, count_digits(text));
    if (number.fraction.empty()) {
      return std::nullopt;
    }
    text.remove_prefix(number.fraction.size());
  }
  number.unit = text == "°" ? name(Unit::deg) : text;
  number.whole.remove_prefix(std::min(number.whole.find_first_not_of('0'), number.whole.size()));
  number.fraction = number.fraction.substr(0, number.fraction.find_last_not_of('0') + 1);
  return number;
}

/// A magnitude in register steps: the exact one, or the next below if the register is too coarse.
struct Steps {
  std::int64_t floor = 0;
  bool exact = true;
};

/// Empty: beyond 64 bits.
std::optional<Steps> to_steps(const Number& number, std::int64_t times, std::int64_t per) {
  // No unit is finer than a millionth of another, so further decimals only make it inexact.
  constexpr std::size_t most_decimals = 6;
  const std::string_view fraction = number.fraction.substr(0, most_decimals);
  std::int64_t value = 0;
  for (const std::string_view digits : {number.whole, fraction}) {
    for (const char digit : digits) {
      if (__builtin_mul_overflow(value, 10, &value) ||
          __builtin_add_overflow(value, digit - '0', &value)) {
        return std::nullopt;
      }
    }
  }
  if (__builtin_mul_overflow(value, times, &value)) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < fraction.size(); ++i) {
    per *= 10;
  }
  return Steps{value / per, value % per == 0 && fraction.size() == number.fraction.size()};
}

std::int64_t with_sign(const Number& number, std::int64_t magnitude) {
  return number.negative ? -magnitude : magnitude;
}

/// "on (0), off (1) or brake (2)".
std::string list_choices(const Parameter& parameter) {
  std::vector<std::string> words;
  words.reserve(parameter.choices.size());
  for (const Choice& choice : parameter.choices) {
    words.push_back(fmt::format("{} ({})", choice.word, choice.raw));
  }
  return either(words);
}

std::string decimal(std::int64_t raw, std::int64_t steps_per_unit) {
  if (steps_per_unit == 1) {
    return std::to_string(raw);
  }
  const std::int64_t whole = raw / steps_per_unit;
  const std::int64_t rest = raw % steps_per_unit;
  const bool negative = raw < 0;
  return fmt::format("{}{}.{}", negative ? "-" : "", negative ? -whole : whole,
                     negative ? -rest : rest);
}

/// Parses one value; its members share the context of all refusals.
class ValueParser {
 public:
  ValueParser(const Parameter& parameter, NamedBy named, std::string_view text)
      : parameter_(parameter), named_(named), text_(text) {}

  [[nodiscard]] Result<TypedValue> parse() const {
    const auto number = split(text_);
    if (!number) {
      return parameter_.choices.empty() ? not_a_number() : word();
    }
    auto value = number->unit.empty()    ? bare(*number)
                 : number->unit == "raw" ? whole(*number)
                                         : with_unit(*number);
    const bool chosen =
        !value || parameter_.choices.empty() || parameter_.choice(value->raw) != nullptr;
    return chosen ? value
                  : fail(Code::out_of_range,
                         say<texts::value_no_choice>(assignment(), list_choices(parameter_)),
                         example());
  }

 private:
  /// "angle_limit_cw=90", as it was typed.
  [[nodiscard]] std::string assignment() const { return parameter_.name + '=' + printable(text_); }

  [[nodiscard]] std::string example() const { return example_text(parameter_); }

  [[nodiscard]] Result<TypedValue> not_a_number() const {
    return fail(Code::usage, say<texts::value_not_a_number>(assignment()),
                say<texts::value_grammar>(example()));
  }

  [[nodiscard]] Result<TypedValue> exactly(const Number& number, const TypedUnit& unit) const {
    const auto steps = to_steps(number, unit.times, unit.per);
    if (!steps) {
      return fail(Code::out_of_range, say<texts::value_beyond_64_bits>(assignment()), example());
    }
    return steps->exact ? TypedValue{with_sign(number, steps->floor), unit.pwm_mode}
                        : too_fine(number, *steps, unit);
  }

  [[nodiscard]] Result<TypedValue> word() const {
    for (const Choice& choice : parameter_.choices) {
      if (same_word(choice.word, text_)) {
        return TypedValue{choice.raw, std::nullopt};
      }
    }
    return fail(Code::usage, say<texts::value_unknown_word>(assignment(), list_choices(parameter_)),
                example());
  }

  /// A register number.
  [[nodiscard]] Result<TypedValue> whole(const Number& number) const {
    if (number.has_point) {
      return fail(Code::usage, say<texts::value_not_whole>(assignment()), example());
    }
    return exactly(number, TypedUnit{});
  }

  /// Digits alone: by address the register number, by name units, and only where these are the
  /// same.
  [[nodiscard]] Result<TypedValue> bare(const Number& number) const {
    const auto units = typed_units(parameter_);
    if (units.empty() || (named_ == NamedBy::address && !number.has_point)) {
      return whole(number);
    }
    if (!number.has_point && units.front().times == 1 && units.front().per == 1) {
      return whole(number);
    }
    return unit_missing(number, units);
  }

  /// Offers what the digits may have meant, each with its other spelling.
  [[nodiscard]] Result<TypedValue> unit_missing(const Number& number,
                                                const std::vector<TypedUnit>& units) const {
    const TypedUnit& unit = units.front();
    const auto value = exactly(number, unit);
    if (!value) {
      return value;
    }
    const std::string typed = parameter_.name + '=' + std::string(text_);
    std::vector<std::string> ways{fmt::format("{}{} ({}raw)", typed, unit.name, value->raw)};
    if (!number.has_point && parameter_.unit == Unit::deg_or_rpm) {
      ways.push_back(fmt::format("{0}rpm ({1}raw)", typed, text_));
    } else if (!number.has_point) {
      const std::int64_t raw = value->raw / unit.times;
      ways.push_back(
          fmt::format("{}raw ({}{})", typed, value_text(parameter_, raw), unit_text(parameter_)));
    }
    return fail(Code::usage, say<texts::value_without_unit>(assignment()),
                say<texts::value_type>(either(ways)));
  }

  [[nodiscard]] Result<TypedValue> with_unit(const Number& number) const {
    const auto units = typed_units(parameter_);
    const auto unit = std::ranges::find(units, number.unit, &TypedUnit::name);
    return unit == units.end() ? wrong_unit(number, units) : exactly(number, *unit);
  }

  [[nodiscard]] Result<TypedValue> wrong_unit(const Number& number,
                                              const std::vector<TypedUnit>& units) const {
    const bool looks_like_unit = number.unit == "%" || std::ranges::all_of(number.unit, [](char c) {
                                   return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
                                 });
    if (!looks_like_unit) {
      return not_a_number();
    }
    if (units.empty()) {
      return fail(Code::usage, say<texts::value_has_no_unit>(assignment()), example());
    }
    std::vector<std::string> names;
    names.reserve(units.size());
    for (const TypedUnit& unit : units) {
      names.emplace_back(unit.name);
    }
    return fail(Code::usage, say<texts::value_wrong_unit>(assignment(), number.unit, either(names)),
                example());
  }

  [[nodiscard]] Result<TypedValue> too_fine(const Number& number, const Steps& steps,
                                            const TypedUnit& unit) const {
    const std::int64_t below = with_sign(number, steps.floor);
    const std::int64_t above = with_sign(number, steps.floor + 1);
    const auto mode = unit.pwm_mode;
    const auto type = [&](std::int64_t raw) {
      return parameter_.name + '=' + input_text(parameter_, raw, mode);
    };
    return fail(Code::usage,
                say<texts::value_too_fine>(assignment(), input_text(parameter_, 1, mode)),
                say<texts::value_type>(either({type(below), type(above)})));
  }

  const Parameter& parameter_;
  NamedBy named_;
  std::string_view text_;
};

} // namespace

Result<TypedValue> parse_value(const Parameter& parameter, NamedBy named, std::string_view text) {
  return ValueParser(parameter, named, text).parse();
}

std::string example_text(const Parameter& parameter) {
  const auto raw = parameter.default_raw ? parameter.default_raw : parameter.max;
  const Parameter::Example any{raw.value_or(0), {}};
  const Parameter::Example example = parameter.default_raw ? any : parameter.example.value_or(any);
  // 0x36 is in deg in its factory setting.
  const std::string typed = parameter.name + '=' + input_text(parameter, example.raw, 0);
  return example.model.empty() ? say<texts::assignment_example>(typed)
                               : say<texts::assignment_example_of>(typed, example.model);
}

Result<void> check_range(const Parameter& parameter, std::int64_t raw,
                         std::optional<std::int64_t> pwm_mode) {
  if (!parameter.min || !parameter.max || (raw >= *parameter.min && raw <= *parameter.max)) {
    return {};
  }
  const std::string value = parameter.name + '=' + input_text(parameter, raw, pwm_mode);
  const std::string min = input_text(parameter, *parameter.min, pwm_mode);
  const std::string max = input_text(parameter, *parameter.max, pwm_mode);
  if (min == max) {
    return fail(Code::out_of_range, say<texts::value_only_one>(value, min),
                say<texts::value_type>(parameter.name + '=' + min));
  }
  return fail(Code::out_of_range, say<texts::value_out_of_range>(value, min, max),
              say<texts::value_range_hint>(min, max));
}

std::string value_text(const Parameter& parameter, std::int64_t raw,
                       std::optional<std::int64_t> pwm_mode) {
  if (parameter.can_be_inactive && raw == not_active) {
    return {};
  }
  const bool tenths = parameter.unit != Unit::deg_or_rpm || pwm_mode == 0;
  return decimal(raw, tenths ? parameter.steps_per_unit : 1);
}

std::string_view unit_text(const Parameter& parameter, std::optional<std::int64_t> pwm_mode) {
  if (parameter.unit != Unit::deg_or_rpm) {
    return name(parameter.unit);
  }
  return pwm_mode == 0 ? name(Unit::deg) : pwm_mode == 1 ? name(Unit::rpm) : "";
}

std::string input_text(const Parameter& parameter, std::int64_t raw,
                       std::optional<std::int64_t> pwm_mode) {
  if (const Choice* choice = parameter.choice(raw)) {
    return choice->word;
  }
  const bool mode_open =
      parameter.unit == Unit::deg_or_rpm && unit_text(parameter, pwm_mode).empty();
  if (mode_open || (parameter.can_be_inactive && raw == not_active)) {
    return std::to_string(raw) + "raw";
  }
  return fmt::format("{}{}", value_text(parameter, raw, pwm_mode), unit_text(parameter, pwm_mode));
}

std::string display(const Parameter& parameter, std::int64_t raw,
                    std::optional<std::int64_t> pwm_mode) {
  if (parameter.can_be_inactive && raw == not_active) {
    return say<texts::value_not_active>();
  }
  if (const Choice* choice = parameter.choice(raw)) {
    return choice->word;
  }
  if (parameter.address == address::firmware_version ||
      parameter.address == address::hardware_version) {
    return firmware_text(raw);
  }
  const std::string_view unit = unit_text(parameter, pwm_mode);
  const std::string value = value_text(parameter, raw, pwm_mode);
  const bool is_part_of_date = parameter.unit >= Unit::year; // its name says which part
  return unit.empty() || is_part_of_date ? value : fmt::format("{} {}", value, unit);
}

std::string register_text(const Parameter& parameter, std::int64_t raw,
                          std::optional<std::int64_t> pwm_mode) {
  const std::string number = std::to_string(raw);
  std::string meaning = display(parameter, raw, pwm_mode);
  const bool inactive = parameter.can_be_inactive && raw == not_active;
  return inactive || meaning == number ? meaning : fmt::format("{}  ({})", number, meaning);
}

bool unit_depends_on_mode(const Parameter& parameter) {
  return parameter.unit == Unit::deg_or_rpm;
}

std::string default_text(const Parameter& parameter) {
  return parameter.default_raw ? display(parameter, *parameter.default_raw, pwm_angle_mode)
                               : std::string();
}

} // namespace blactl::bla
