#pragma once
// The values of options and arguments, from text to what a command takes: exactly, or not at all.

#include "blactl/base/error.hpp"

#include "cli/command.hpp"

#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// Understands everything that was given for one option, in the order given; not empty. The last
/// value holds, or all of them where the option takes a list. What only a servo's model or the bus
/// can tell is left to the command. Errors: usage; every fault is added to `faults`, with
/// `see_help` as its hint where there is no better one.
[[nodiscard]] Value understand(const Option& option, std::span<const std::string> given,
                               const std::string& see_help, std::vector<Error>& faults);

/// "did you mean --node?" for a word that resembles some of `known`; else `otherwise`.
[[nodiscard]] std::string did_you_mean(std::string_view typed,
                                       std::span<const std::string_view> known,
                                       std::string otherwise);

} // namespace blactl::cli
