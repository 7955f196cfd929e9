#include "cli/run.hpp"

#include "cli/commands.hpp"
#include "cli/context.hpp"
#include "cli/options.hpp"
#include "cli/output/reporter.hpp"

#include <utility>

namespace blactl::cli {
namespace {

/// Plain text on stdout that is no report: help and version.
int print(const Reporter& reporter, std::string_view text) {
  const auto printed = reporter.data(text);
  if (!printed) {
    reporter.error(printed.error());
    return exit_status(printed.error().code);
  }
  return 0;
}

} // namespace

int run(std::span<const std::string> arguments) {
  set_language(peek_language(arguments));
  // Answered before the parser is built: scripts ask for it often.
  if (arguments.size() == 1 && (arguments[0] == "--version" || arguments[0] == "-V")) {
    return print(Reporter({}), "blactl " BLACTL_VERSION "\n");
  }
  const auto invocation = parse(arguments);
  if (!invocation) {
    Report report;
    report.command = peek_command(arguments);
    report.is_stream = is_stream(report.command);
    report.fail(invocation.error());
    return Reporter(peek(arguments).output).finish(report);
  }
  const Reporter reporter(invocation->shared.output);
  if (!invocation->help_text.empty()) {
    return print(reporter, invocation->help_text);
  }
  Context context(invocation->shared, reporter);
  Report report = std::visit([&](const auto& options) { return execute(options, context); },
                             invocation->command);
  report.command = invocation->name;
  if (report.signal == 0) { // it may have come before the command had a session to ask
    report.signal = context.signal();
  }
  context.tell_losses(report);
  return reporter.finish(report);
}

} // namespace blactl::cli
