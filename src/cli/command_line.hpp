#pragma once
// From arguments to plain structs. Only command_line.cpp knows the parser.

#include "blactl/base/error.hpp"
#include "blactl/base/text.hpp"

#include "cli/commands.hpp"

#include <expected>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// A command line without a fault.
struct Invocation {
  Shared shared{};
  const Command* command = nullptr;      ///< null: none, which only --help and the like allow
  std::shared_ptr<const void> options{}; ///< of the command, for its action
};

/// What can be told before anything is parsed: every failure of a command line with --json prints
/// a document, and is coloured as --color says.
[[nodiscard]] Shared peek(std::span<const std::string> arguments);
/// The command that is meant; null: unknown.
[[nodiscard]] const Command* peek_command(std::span<const std::string> arguments);
[[nodiscard]] Language peek_language(std::span<const std::string> arguments);

/// Errors: usage; every fault of the command line, but where --help or --version asks for a text.
[[nodiscard]] std::expected<Invocation, std::vector<Error>>
parse(std::span<const std::string> arguments,
      std::span<const Command* const> commands = all_commands());

} // namespace blactl::cli
