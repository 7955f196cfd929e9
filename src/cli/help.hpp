#pragma once
// --help, written from the command table in the language of this process.

#include "cli/command.hpp"
#include "cli/output/page.hpp"

#include <cstddef>
#include <string>

namespace blactl::cli {

/// The columns of the terminal behind stdout; 80 without one.
[[nodiscard]] std::size_t terminal_width();

/// The help of a command, or of the program (null), in lines of at most `width` columns, but not
/// less than 40.
[[nodiscard]] std::string help(const Command* command, std::size_t width);

/// The command table as JSON, from which completions and manual are generated:
/// `{"schema":"blactl-cli/1","version",…,"options":[…],"commands":[…]}`, texts in both languages;
/// ends with a line break, without hidden options.
[[nodiscard]] std::string dump_cli();

} // namespace blactl::cli
