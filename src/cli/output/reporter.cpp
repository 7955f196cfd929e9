#include "cli/output/reporter.hpp"

#include "blactl/base/system_error.hpp"

#include "cli/texts.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <utility>

namespace blactl::cli {
namespace {

/// Writes everything or returns the error; false if the reader has left.
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
      return fail(Code::io, say<texts::stdout_failed>(system_reason(errno)),
                  say<texts::stdout_failed_hint>());
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// An unwritable stderr cannot be reported.
void write_stderr(std::string_view text) {
  if (!write_all(STDERR_FILENO, text)) {
    return;
  }
}

/// Clears the line of the cursor (ECMA-48, EL).
constexpr std::string_view clear_line = "\r\x1b[K";

} // namespace

bool Reporter::has_terminal() {
  return isatty(STDIN_FILENO) != 0 && isatty(STDERR_FILENO) != 0;
}

namespace {

/// Whether the terminal does nothing but print characters.
bool is_dumb() {
  const char* type = std::getenv("TERM"); // NOLINT(concurrency-mt-unsafe): nobody sets it
  return type != nullptr && std::string_view(type) == "dumb";
}

} // namespace

bool Reporter::use_colour(int descriptor) const {
  if (options_.colour != Colour::automatic) {
    return options_.colour == Colour::always;
  }
  const char* no_colour = std::getenv("NO_COLOR");
  return (no_colour == nullptr || *no_colour == '\0') && isatty(descriptor) != 0 && !is_dumb();
}

namespace {

/// Whether the locale of this process uses UTF-8.
bool has_unicode() {
  for (const char* variable : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(variable); // NOLINT(concurrency-mt-unsafe): nobody sets it
    if (value != nullptr && *value != '\0') {
      const std::string_view locale = value;
      return locale.find("UTF-8") != std::string_view::npos ||
             locale.find("utf8") != std::string_view::npos;
    }
  }
  return false;
}

} // namespace

Page Reporter::page(int descriptor) const {
  constexpr std::size_t usual = 80;
  constexpr std::size_t usual_height = 24;
  constexpr std::size_t least = 40;
  Page page{.colour = use_colour(descriptor), .unicode = has_unicode()};
  if (isatty(descriptor) != 0) {
    winsize size{};
    const bool known = ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    page.width = known ? std::max<std::size_t>(size.ws_col, least) : usual;
    page.height = known && size.ws_row > 1 ? size.ws_row : usual_height;
  }
  return page;
}

Page Reporter::page() const {
  return page(STDOUT_FILENO);
}

void Reporter::clear_progress() const {
  if (std::exchange(has_progress_, false)) {
    write_stderr(clear_line);
  }
}

/// Takes the list away (ECMA-48, CPL and ED).
std::string Reporter::clear_list() const {
  const auto lines = std::ranges::count(list_, '\n');
  return lines > 0 ? fmt::format("\x1b[{}F\x1b[J", lines) : std::string();
}

void Reporter::print(std::string_view text) const {
  if (held_ != nullptr) {
    *held_ += text;
    return;
  }
  clear_progress();
  // On one terminal the text would be written into the list.
  const bool is_in_the_way = !list_.empty() && isatty(STDERR_FILENO) != 0;
  const std::string list = is_in_the_way ? list_ : std::string();
  write_stderr(is_in_the_way ? clear_list() + std::string(text) + list : std::string(text));
}

void Reporter::progress(std::string_view text) const {
  const Page page = this->page(STDERR_FILENO);
  if (options_.quiet || page.width == Page::unlimited || is_dumb()) {
    return;
  }
  const std::string line = wrap(text, page.width - 1, 0, 0); // a full line would move the cursor
  has_progress_ = true;
  write_stderr(std::string(clear_line) + line.substr(0, line.find('\n')));
}

void Reporter::note(std::string_view text) const {
  if (!options_.quiet) {
    print(page(STDERR_FILENO).fit(fmt::format("blactl: {}\n", text)));
  }
}

void Reporter::detail(std::string_view text) const {
  if (options_.verbosity > 0 && !options_.quiet) {
    print(page(STDERR_FILENO).fit(fmt::format("blactl: {}\n", text)));
  }
}

namespace {

/// The faults of a file stand a line each: those behind the first are indented.
std::string message_of(const Error& error) {
  std::string out;
  for (const char c : error.message) {
    out += c;
    out += c == '\n' && error.code == Code::bad_file ? "    " : "";
  }
  return out;
}

} // namespace

void Reporter::error(const Error& error) const {
  const Page page = this->page(STDERR_FILENO);
  const std::string code = page.paint(Tone::bad, fmt::format("[{}]", name(error.code)));
  std::string text = page.fit(fmt::format("blactl: {} {}\n", code, message_of(error)));
  if (!error.hint.empty()) {
    text += page.fit_hint("  " + error.hint) + '\n';
  }
  print(text);
}

void Reporter::ask(std::string_view question) const {
  print(page(STDERR_FILENO).fit(question));
}

Result<void> Reporter::data(std::string_view text) const {
  const auto written = stream(text);
  return written ? Result<void>() : std::unexpected(written.error());
}

Result<bool> Reporter::stream(std::string_view text) const {
  clear_progress();
  return write_all(STDOUT_FILENO, text);
}

bool Reporter::has_screen() const {
  return options_.format != Format::json && isatty(STDOUT_FILENO) != 0;
}

Result<bool> Reporter::show(std::string_view list) const {
  const std::string up = clear_list();
  list_ = page().cut(list);
  return stream(up + list_);
}

/// A pipe that can be written takes PIPE_BUF bytes, and a line is shorter.
bool Reporter::has_room() {
  pollfd room{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
  return poll(&room, 1, 0) != 0;
}

Result<bool> Reporter::offer(std::string_view line) const {
  if (!has_room()) {
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
  case Format::text: return report.text ? page().fit(report.text(page())) : std::string();
  }
  return {};
}

int Reporter::finish(const Report& report) const {
  list_.clear(); // it stays as it is
  const auto written = data(render(report));
  const std::vector<Error> errors = report.all_errors();
  for (const Error& error : errors) {
    this->error(error);
  }
  if (!written) {
    // A stream has failed with the same before, and said so.
    if (std::ranges::find(errors, Code::io, &Error::code) == errors.end()) {
      error(written.error());
    }
    return exit_status(written.error().code);
  }
  return report.exit_status();
}

} // namespace blactl::cli
