#include "base/json_syntax.hpp"

#include "blactl/base/text.hpp"
#include "blactl/base/texts.hpp"

#include <algorithm>
#include <optional>

namespace blactl::json {
namespace {

constexpr std::string_view blanks = " \t\r\n";

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// What a message of the parser means wherever it says so; the first that fits.
struct Meaning {
  std::string_view part; ///< of the message
  std::string (*text)();
};

constexpr Meaning meanings[]{
    {"unexpected end of input", [] { return say<texts::json_ends_early>(); }},
    {"ill-formed UTF-8", [] { return say<texts::json_bad_utf8>(); }},
    {"missing closing quote", [] { return say<texts::json_open_string>(); }},
    {"control character U+000A", [] { return say<texts::json_open_string>(); }},
    {"control character U+000D", [] { return say<texts::json_open_string>(); }},
    {"control character", [] { return say<texts::json_control_character>(); }},
    {"invalid string", [] { return say<texts::json_bad_escape>(); }},
    {"expected ':'", [] { return say<texts::json_colon_missing>(); }},
};

/// Whether a character is part of a number or a bare word.
bool is_of_word(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         c == '.' || c == '+' || c == '-';
}

/// Where the word around a place begins.
std::size_t word_begin(std::string_view text, std::size_t place) {
  while (place > 0 && is_of_word(text[place]) && is_of_word(text[place - 1])) {
    --place;
  }
  return place;
}

/// The word around a place, or the one character there.
std::string_view word_at(std::string_view text, std::size_t place) {
  std::string_view rest = text.substr(word_begin(text, place));
  const auto end =
      static_cast<std::size_t>(std::ranges::find_if_not(rest, is_of_word) - rest.begin());
  return rest.substr(0, end > 0 ? end : std::max<std::size_t>(utf8_length(rest), 1));
}

/// The place of a comma with nothing but blanks between it and `place`.
std::optional<std::size_t> comma_before(std::string_view text, std::size_t place) {
  const std::size_t last = text.substr(0, place).find_last_not_of(blanks);
  return last != std::string_view::npos && text[last] == ',' ? std::optional(last) : std::nullopt;
}

/// Whether another value or key stands where a comma should.
bool lacks_comma(std::string_view text, std::size_t place, std::string_view what) {
  const bool is_inside =
      contains(what, "parsing object - unexpected") || contains(what, "parsing array - unexpected");
  const bool begins = contains("\"[{", text.substr(place, 1));
  const std::size_t begin = word_begin(text, place);
  const bool is_apart =
      is_of_word(text[place]) && begin > 0 && contains(blanks, text.substr(begin - 1, 1));
  return is_inside && (begins || is_apart);
}

std::string reason_at(std::string_view text, std::size_t place, std::string_view token,
                      std::string_view what) {
  constexpr std::size_t longest = 40;
  const std::string word(word_at(text, place).substr(0, longest));
  if (word == "/" || word == "#") {
    return say<texts::json_comment>();
  }
  if (word == "'" || contains(what, "parsing object key")) {
    return say<texts::json_double_quotes>();
  }
  if (lacks_comma(text, place, what)) {
    const bool is_short_string = text[place] == '"' && token.size() <= longest;
    return say<texts::json_comma_missing>(is_short_string ? std::string(token) : word);
  }
  return say<texts::json_unexpected>(word);
}

SyntaxFault fault_at(std::string_view text, std::size_t place, std::string reason) {
  const auto before = text.substr(0, place);
  return {1 + static_cast<std::size_t>(std::ranges::count(before, '\n')), std::move(reason)};
}

} // namespace

SyntaxFault explain_syntax(std::string_view text, std::size_t taken, std::string_view token,
                           std::string_view what) {
  std::size_t place = std::min(taken, text.size());
  place -= place > 0 ? 1 : 0;
  for (const Meaning& meaning : meanings) {
    if (text.empty() || contains(what, meaning.part)) {
      return fault_at(text, place, meaning.text());
    }
  }
  const bool is_number = contains(what, "number");
  if (is_number && place > 0 && !is_of_word(text[place])) { // it looked one further
    --place;
  }
  const auto comma = text[place] == ']' || text[place] == '}' ? comma_before(text, place)
                                                              : std::optional<std::size_t>();
  return comma ? fault_at(text, *comma, say<texts::json_trailing_comma>())
               : fault_at(text, place, reason_at(text, place, token, what));
}

} // namespace blactl::json
