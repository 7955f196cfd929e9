#pragma once
// The table of commands. Each is declared in its file of commands/: options, help and action. They
// print only through the reporter, ask only through it, and never exit.

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/output/report.hpp"

#include <span>
#include <string_view>

namespace blactl::cli {

namespace commands {

extern const Command scan, alloc, get, set, save, erase, restart, wait, faults, pwm_config,
    export_servos, // "export" is a keyword of C++
    diff, apply, replace, undo, provision, ledger, monitor, command, trace, doctor, characterize,
    models, sim;

} // namespace commands

/// All commands, in the order of --help.
[[nodiscard]] std::span<const Command* const> all_commands();

/// The command of this name; null: none.
[[nodiscard]] const Command* find_command(std::string_view name);

} // namespace blactl::cli
