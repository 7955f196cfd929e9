#include "cli/option_values.hpp"

#include "blactl/base/nearest.hpp"
#include "blactl/base/texts.hpp"
#include "blactl/fleet/bus/register_choice.hpp"
#include "blactl/fleet/bus/target.hpp"

#include "cli/interface/scheme.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <ranges>
#include <utility>

namespace blactl::cli {
namespace {

std::optional<Duration> decimal_seconds(std::string_view text) {
  constexpr std::size_t most_digits = 6;
  const auto point = text.find('.');
  const std::string_view whole = text.substr(0, point);
  std::string fraction(point == std::string_view::npos ? "" : text.substr(point + 1));
  const bool digits_only =
      (std::string(whole) + fraction).find_first_not_of("0123456789") == std::string::npos;
  if (whole.empty() || whole.size() > most_digits || fraction.size() > most_digits ||
      !digits_only || (point != std::string_view::npos && fraction.empty())) {
    return std::nullopt;
  }
  fraction.resize(most_digits, '0');
  return Duration(std::strtoll((std::string(whole) + fraction).c_str(), nullptr, 10));
}

std::string in_seconds(Duration duration) {
  return fmt::format("{}", std::chrono::duration<double>(duration).count());
}

/// One value of one option.
class Reading {
 public:
  Reading(const Option& option, const std::string& text, const std::string& see_help, Value& value)
      : option_(option), text_(text), see_help_(see_help), value_(value) {}

  Result<void> take() {
    // an unset variable of a script: -n "$NODE" must not select every servo
    if (text_.empty()) {
      return refuse(say<texts::empty_value>(option_.name));
    }
    switch (option_.kind) {
    case Kind::seconds: return take_seconds();
    case Kind::whole: return take_whole();
    case Kind::word: return take_word(text_);
    case Kind::words: return take_words();
    case Kind::nodes: return just(fleet::parse_targets(text_));
    case Kind::interface: return just(parse_interface(text_));
    case Kind::group: return just(fleet::parse_groups(text_));
    default: return {};
    }
  }

 private:
  std::unexpected<Error> refuse(std::string message, std::string hint = {}) const {
    if (hint.empty()) {
      hint = see_help_;
    }
    return fail(Code::usage, std::move(message), std::move(hint));
  }

  /// Whether it was parsed; its meaning is up to the command.
  template <class T> static Result<void> just(const Result<T>& result) {
    return result ? Result<void>() : std::unexpected(result.error());
  }

  Result<void> take_seconds() {
    const auto [min, max] = option_.seconds;
    const auto duration = decimal_seconds(text_);
    if (!duration || *duration < min || *duration > max) {
      return refuse(option_.value == "HZ"
                        ? say<texts::bad_rate>(option_.name, printable(text_), in_seconds(min),
                                               in_seconds(max))
                        : say<texts::bad_seconds>(option_.name, printable(text_), in_seconds(min),
                                                  in_seconds(max)));
    }
    value_.duration = *duration;
    return {};
  }

  Result<void> take_whole() {
    const auto [min, max] = option_.whole;
    std::uint64_t number{};
    const char* end = text_.data() + text_.size();
    const auto [stop, error] = std::from_chars(text_.data(), end, number);
    if (error != std::errc() || stop != end || number < min || number > max) {
      return refuse(say<texts::bad_number>(option_.name, printable(text_), min, max));
    }
    value_.number = number;
    return {};
  }

  Result<void> take_word(std::string_view word) {
    const auto found = std::ranges::find(option_.words, word);
    if (found != option_.words.end()) {
      value_.number = static_cast<std::uint64_t>(found - option_.words.begin());
      return {};
    }
    std::string known;
    for (const std::string_view each : option_.words) {
      known += (known.empty() ? "" : ", ") + std::string(each);
    }
    return refuse(say<texts::bad_word>(option_.name, printable(word), known),
                  did_you_mean(word, option_.words, see_help_));
  }

  Result<void> take_words() {
    for (const auto part : std::views::split(text_, ',')) {
      if (auto taken = take_word({part.begin(), part.end()}); !taken) {
        return taken;
      }
    }
    return {};
  }

  const Option& option_;
  const std::string& text_;
  const std::string& see_help_;
  Value& value_;
};

} // namespace

std::string did_you_mean(std::string_view typed, std::span<const std::string_view> known,
                         std::string otherwise) {
  std::string words;
  for (const std::string_view word : nearest(typed, known)) {
    words += (words.empty() ? "" : ", ") + std::string(word);
  }
  return words.empty() ? otherwise : say<texts::did_you_mean>(words);
}

Value understand(const Option& option, std::span<const std::string> given,
                 const std::string& see_help, std::vector<Error>& faults) {
  Value value;
  if (option.kind == Kind::flag) {
    value.number = given.size();
    return value;
  }
  const bool is_list = option.repeat == Repeat::list;
  for (const std::string& text : is_list ? given : given.last(1)) {
    if (auto taken = Reading(option, text, see_help, value).take(); !taken) {
      faults.push_back(std::move(taken.error()));
    }
    value.text += value.text.empty() ? text : "," + text;
    value.list.push_back(text);
  }
  return value;
}

} // namespace blactl::cli
