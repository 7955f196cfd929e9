#include "cli/output/reporter.hpp"

#include "cli/texts.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace blactl::cli {
namespace {

/// Writes everything or tells why not; false if the reader has left.
Result<bool> write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(descriptor, text.data(), text.size());
    if (written < 0) {
      if (errno == EINTR) {
        continue;
      }
      if (errno == EPIPE) {
        return false;
      }
      return fail(Code::io, say<texts::stdout_failed>(std::strerror(errno)),
                  say<texts::stdout_failed_hint>());
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// stderr that cannot be written has nobody to tell.
void write_stderr(std::string_view text) {
  if (!write_all(STDERR_FILENO, text)) {
    return;
  }
}

} // namespace

bool Reporter::has_terminal() {
  return isatty(STDIN_FILENO) != 0 && isatty(STDERR_FILENO) != 0;
}

bool Reporter::use_colour() const {
  if (options_.colour != Colour::automatic) {
    return options_.colour == Colour::always;
  }
  const char* no_colour = std::getenv("NO_COLOR");
  return (no_colour == nullptr || *no_colour == '\0') && isatty(STDERR_FILENO) != 0;
}

void Reporter::note(std::string_view text) const {
  if (!options_.quiet) {
    write_stderr(fmt::format("blactl: {}\n", text));
  }
}

void Reporter::detail(std::string_view text) const {
  if (options_.verbosity > 0) {
    write_stderr(fmt::format("blactl: {}\n", text));
  }
}

void Reporter::error(const Error& error) const {
  const bool colour = use_colour();
  std::string text = fmt::format("blactl: {}[{}]{} {}\n", colour ? "\x1b[1;31m" : "",
                                 name(error.code), colour ? "\x1b[0m" : "", error.message);
  if (!error.hint.empty()) {
    text += fmt::format("  {}\n", error.hint);
  }
  write_stderr(text);
}

void Reporter::ask(std::string_view question) const {
  write_stderr(question);
}

Result<void> Reporter::data(std::string_view text) const {
  const auto written = stream(text);
  return written ? Result<void>() : std::unexpected(written.error());
}

Result<bool> Reporter::stream(std::string_view text) const {
  return write_all(STDOUT_FILENO, text);
}

Result<bool> Reporter::offer(std::string_view line) const {
  // A pipe that can be written takes PIPE_BUF bytes, and a line is shorter.
  pollfd room{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
  if (poll(&room, 1, 0) == 0) {
    return false;
  }
  if (const auto written = data(line); !written) {
    return std::unexpected(written.error());
  }
  return true;
}

std::string Reporter::render(const Report& report) const {
  switch (options_.format) {
  case Format::json: return render_json(report);
  case Format::csv: return report.csv ? report.csv() : std::string();
  case Format::text: return report.text ? report.text() : std::string();
  }
  return {};
}

int Reporter::finish(const Report& report) const {
  const auto written = data(render(report));
  for (const Error& error : report.errors) {
    this->error(error);
  }
  if (!written) {
    // A stream has failed with the same before, and said so.
    if (std::ranges::find(report.errors, Code::io, &Error::code) == report.errors.end()) {
      error(written.error());
    }
    return exit_status(written.error().code);
  }
  return report.exit_status();
}

} // namespace blactl::cli
