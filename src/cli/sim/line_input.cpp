#include "cli/sim/line_input.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <variant>

namespace blactl::cli {
namespace {

/// A background job of a shell would be stopped by reading the terminal.
bool is_in_foreground() {
  return tcgetpgrp(STDIN_FILENO) == getpgrp();
}

} // namespace

LineInput::LineInput(can::Loop& loop) : loop_(loop), is_terminal_(isatty(STDIN_FILENO) != 0) {
  (void)signal(SIGTTIN, SIG_IGN); // between check and read: makes the read fail instead
  look();
}

void LineInput::look() {
  const bool wanted = !ended_ && (!is_terminal_ || is_in_foreground());
  if (wanted == is_watched_) {
    return;
  }
  wanted ? loop_.watch(STDIN_FILENO) : loop_.unwatch(STDIN_FILENO);
  is_watched_ = wanted;
}

void LineInput::handle(const can::Event& event) {
  look();
  const auto* ready = std::get_if<can::Ready>(&event);
  if (!is_watched_ || ready == nullptr || ready->descriptor != STDIN_FILENO) {
    return;
  }
  std::array<char, longest> buffer{};
  const auto size = read(STDIN_FILENO, buffer.data(), buffer.size());
  if (size > 0) {
    text_.append(buffer.data(), static_cast<std::size_t>(size));
  } else if (size == 0 || (errno != EINTR && errno != EAGAIN && errno != EIO)) {
    ended_ = true;
    look();
  }
}

std::optional<std::string> LineInput::next() {
  const auto end = text_.find('\n');
  if (end == std::string::npos && text_.size() < longest && (!ended_ || text_.empty())) {
    return std::nullopt;
  }
  std::string line = text_.substr(0, std::min(end, longest));
  text_.erase(0, line.size() + (end == line.size() ? 1 : 0));
  return line;
}

} // namespace blactl::cli
