#pragma once
// Messages to people, in English and Japanese.
//
// Texts live in the catalogue, a header per floor (include/blactl/*/texts.hpp), never in the code:
//
//   namespace blactl::texts {
//   inline constexpr Text interface_down{"{} is down", "{} は停止しています"};
//   }
//   fail(Code::interface, say<texts::interface_down>(name), ...)
//
// Both format strings are checked against the arguments at compile time.

#include <fmt/core.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace blactl {

enum class Language : unsigned char { english, japanese };

/// One text of the catalogue: fmt format strings with the same arguments.
struct Text {
  const char* en;
  const char* ja;
};

/// Sets the language of this process, once, before the first message. English until then.
void set_language(Language language);
[[nodiscard]] Language language();

/// The text in the language of this process.
template <const Text& text, class... Args> [[nodiscard]] std::string say(const Args&... args) {
  constexpr fmt::format_string<const Args&...> en{text.en};
  constexpr fmt::format_string<const Args&...> ja{text.ja};
  return language() == Language::japanese ? fmt::format(ja, args...) : fmt::format(en, args...);
}

/// The one of two texts that came with data (a profile) that fits the language of this process.
[[nodiscard]] std::string_view choose(std::string_view en, std::string_view ja);

/// The length of the UTF-8 character at the start of `text`; 0: it is not well-formed (RFC 3629: no
/// overlong forms, no surrogates, nothing above U+10FFFF). `text` is not empty.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

/// Whether a well-formed character must not be shown: C0, DEL and C1 controls, which terminals
/// obey, and characters that are invisible or change the direction of text.
[[nodiscard]] bool is_control(std::string_view character);

/// Makes foreign bytes safe for a terminal, a log line or JSON: valid UTF-8 stays; control
/// characters, escape sequences and broken UTF-8 become \xNN.
[[nodiscard]] std::string printable(std::string_view foreign);

/// As a word of a shell, for a command that is typed as it is shown: quoted where a shell would
/// take it for more than a word. Otherwise as printable().
[[nodiscard]] std::string shell_word(std::string_view foreign);

} // namespace blactl
