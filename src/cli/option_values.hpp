#pragma once
// Parses the values of options and arguments exactly, or not at all.

#include "blactl/base/error.hpp"

#include "cli/command.hpp"

#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// Parses all given values of one option, in order; not empty. The last value counts, or all of
/// them if the option takes a list. Checks that need a servo's model or the bus are left to the
/// command. Errors: usage; each is added to `faults`, with `see_help` as its hint if there is no
/// better one.
[[nodiscard]] Value understand(const Option& option, std::span<const std::string> given,
                               const std::string& see_help, std::vector<Error>& faults);

/// "did you mean --node?" for a word similar to one of `known`; else `otherwise`.
[[nodiscard]] std::string did_you_mean(std::string_view typed,
                                       std::span<const std::string_view> known,
                                       std::string otherwise);

} // namespace blactl::cli
