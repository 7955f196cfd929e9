#include "cli/run.hpp"

#include "cli/command_line.hpp"
#include "cli/context.hpp"
#include "cli/help.hpp"
#include "cli/output/reporter.hpp"
#include "cli/repeat_interface.hpp"
#include "cli/texts.hpp"

#include <unistd.h>

#include <exception>
#include <optional>
#include <tuple>
#include <utility>

namespace blactl::cli {
namespace {

constexpr std::string_view version_text = "blactl " BLACTL_VERSION "\n";

/// Prints text on stdout that is not a report: help and version.
int print(const Reporter& reporter, std::string_view text) {
  const auto printed = reporter.data(text);
  if (!printed) {
    reporter.error(printed.error());
    return exit_status(printed.error().code);
  }
  return 0;
}

/// Ends a command without its own report, with these errors.
int refuse(std::span<const std::string> arguments, std::vector<Error> faults) {
  Report report;
  if (const Command* command = peek_command(arguments)) {
    report.command = command->name;
    report.is_stream = command->traits.streams;
  }
  report.errors = std::move(faults);
  return Reporter(peek(arguments).output).finish(report);
}

int carry_out(const Invocation& invocation, const Reporter& reporter, const BusOpener& opener) {
  for (const Origin& origin : invocation.shared.from_environment) {
    reporter.detail(
        say<texts::from_environment>(origin.option, printable(origin.value), origin.variable));
  }
  Context context(invocation.shared, reporter, opener);
  const Command& command = *invocation.command;
  Report report = command.action.run(invocation.options.get(), context);
  report.command = command.name;
  if (report.signal == 0) { // it may have come before the command had a session
    report.signal = context.signal();
  }
  context.explain_silence(report);
  context.explain_file(report);
  context.tell_losses(report);
  for (Error& error : report.errors) {
    repeat_interface(error.hint, invocation.shared);
  }
  for (Target& target : report.targets) {
    for (Error& error : target.errors) {
      repeat_interface(error.hint, invocation.shared);
    }
  }
  return reporter.finish(report);
}

/// Not even memory is left to report it.
int fail_in_silence() {
  constexpr std::string_view text = "blactl: [internal] out of memory\n";
  std::ignore = ::write(STDERR_FILENO, text.data(), text.size());
  return exit_status(Code::internal);
}

int understand_and_run(std::span<const std::string> arguments, const BusOpener& opener) {
  set_language(peek_language(arguments));
  // before the parser is built: scripts ask for it often
  if (arguments.size() == 1 && (arguments[0] == "--version" || arguments[0] == "-V")) {
    return print(Reporter({}), version_text);
  }
  auto invocation = parse(arguments);
  if (!invocation) {
    return refuse(arguments, std::move(invocation.error()));
  }
  const Reporter reporter(invocation->shared.output);
  if (invocation->shared.help) {
    return print(reporter, help(invocation->command, terminal_width()));
  }
  if (invocation->shared.version) {
    return print(reporter, version_text);
  }
  if (invocation->shared.dump_cli) {
    return print(reporter, dump_cli());
  }
  return carry_out(*invocation, reporter, opener);
}

} // namespace

int guarded(std::span<const std::string> arguments, const std::function<int()>& work) noexcept {
  try {
    std::string what;
    try {
      return work();
    } catch (const std::exception& exception) {
      what = printable(exception.what());
    } catch (...) {
      what = say<texts::unknown_exception>();
    }
    return refuse(arguments, {{Code::internal, say<texts::own_fault>(what),
                               say<texts::own_fault_hint>(), std::nullopt}});
  } catch (...) {
    return fail_in_silence();
  }
}

int run(std::span<const std::string> arguments, const BusOpener& opener) {
  return guarded(arguments, [&] { return understand_and_run(spelled_out(arguments), opener); });
}

} // namespace blactl::cli
