#pragma once
// Why a text is no JSON, in words for people: the parser has its own, in English only.

#include <cstddef>
#include <string>
#include <string_view>

namespace blactl::json {

struct SyntaxFault {
  std::size_t line = 0; ///< the first is 1
  std::string reason;   ///< in the language of the session; it may hold foreign text
};

/// `taken`: how many characters of `text` the parser had taken; `token`, `what`: the last token and
/// the message of nlohmann's exception.
[[nodiscard]] SyntaxFault explain_syntax(std::string_view text, std::size_t taken,
                                         std::string_view token, std::string_view what);

} // namespace blactl::json
