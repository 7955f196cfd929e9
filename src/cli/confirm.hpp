#pragma once
// Questions to the user at the terminal.

#include "cli/context.hpp"

#include <string_view>

namespace blactl::cli {

/// Asks `question` unless --yes was given; an open bus is served meanwhile. `option`: where --yes
/// is not enough, the option that is. Errors: not_confirmed (no terminal, or any answer but yes),
/// and those of the session.
[[nodiscard]] Result<void> confirm(std::string_view question, Context& context,
                                   std::string_view option = {});

/// Shows `text` to the user at the terminal and waits for Enter; the bus is served meanwhile.
/// Errors: those of the session.
[[nodiscard]] Result<void> wait_for_enter(std::string_view text, Context& context);

} // namespace blactl::cli
