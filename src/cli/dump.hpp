#pragma once
// The command table as JSON, from which completions and manual are generated.

#include <string>

namespace blactl::cli {

/// `{"schema":"blactl-cli/1","version",…,"options":[…],"commands":[…]}`, texts in both languages;
/// ends with a line break, without hidden options.
[[nodiscard]] std::string dump_cli();

} // namespace blactl::cli
