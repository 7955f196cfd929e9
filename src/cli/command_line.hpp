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

/// A command line without errors.
struct Invocation {
  Shared shared{};
  const Command* command = nullptr;      ///< null: none, with --help and the like only
  std::shared_ptr<const void> options{}; ///< for the command's action
};

/// `blactl` alone, `help [COMMAND]` and `version` are other words for --help, COMMAND --help and
/// --version.
[[nodiscard]] std::vector<std::string> spelled_out(std::span<const std::string> arguments);

/// The shared options that are needed before parsing: with --json every failure of a command line
/// prints a document, coloured by --color.
[[nodiscard]] Shared peek(std::span<const std::string> arguments);
/// The command; null: unknown.
[[nodiscard]] const Command* peek_command(std::span<const std::string> arguments);
[[nodiscard]] Language peek_language(std::span<const std::string> arguments);

/// Errors: usage; all errors of the command line, unless --help or --version is given.
[[nodiscard]] std::expected<Invocation, std::vector<Error>>
parse(std::span<const std::string> arguments,
      std::span<const Command* const> commands = all_commands());

} // namespace blactl::cli
