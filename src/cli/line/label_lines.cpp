#include "cli/line/label_lines.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace blactl::cli {

LabelLines::LabelLines(fleet::Session& session, Source source)
    : session_(session), source_(source) {
  listen();
}

LabelLines::~LabelLines() {
  if (source_ == Source::stdin_itself) {
    session_.on_input(-1, {});
  }
}

void LabelLines::listen() {
  if (source_ == Source::stdin_itself && !ended_) {
    session_.on_input(STDIN_FILENO, [this] { read(); });
  }
}

void LabelLines::read() {
  std::array<char, longest> buffer{};
  const auto count = ::read(STDIN_FILENO, buffer.data(), buffer.size());
  if (count > 0) {
    text_.append(buffer.data(), static_cast<std::size_t>(count));
  } else if (count == 0 || (errno != EINTR && errno != EAGAIN)) {
    ended_ = true;
  }
  if (ended_ || text_.size() >= longest) { // as many wait in the pipe
    session_.on_input(-1, {});
  }
}

namespace {

bool is_blank_line(std::string_view line) {
  return line.find_first_not_of(" \t\r") == std::string_view::npos;
}

} // namespace

std::size_t LabelLines::waiting() const {
  std::size_t count = 0;
  std::string_view rest = text_;
  for (auto end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
    count += is_blank_line(rest.substr(0, end)) ? 0U : 1U;
    rest.remove_prefix(end + 1);
  }
  return count;
}

std::string_view LabelLines::unfinished() const {
  const std::string_view text = text_;
  return text.substr(text.rfind('\n') + 1); // npos + 1 is 0
}

std::string
LabelLines::take_out_unless(const std::function<bool(const std::string& line)>& is_label) {
  std::string last, kept;
  std::string_view rest = text_;
  for (auto end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
    const std::string line(rest.substr(0, end));
    rest.remove_prefix(end + 1);
    if (is_blank_line(line) || is_label(line)) {
      kept += line + '\n';
    } else {
      last = line;
    }
  }
  text_ = kept.append(rest);
  return last;
}

void LabelLines::type(std::string_view text) {
  constexpr char backspace = '\b', end_of_input = '\x04';
  for (const char key : text) {
    if (key == backspace) {
      text_.resize(text_.size() - (unfinished().empty() ? 0 : 1));
    } else if (key == end_of_input) {
      ended_ = ended_ || unfinished().empty();
    } else {
      text_ += key;
    }
  }
}

bool LabelLines::is_ready() const {
  return ended_ || text_.find('\n') != std::string::npos || text_.size() >= longest;
}

std::optional<std::string> LabelLines::take_line() {
  const auto end = text_.find('\n');
  const bool is_last = ended_ && !text_.empty();
  if (end == std::string::npos && !is_last && text_.size() < longest) {
    return std::nullopt;
  }
  const std::size_t size = std::min(end, std::min(text_.size(), longest));
  std::string line = text_.substr(0, size);
  text_.erase(0, end == size ? size + 1 : size);
  ++number_;
  listen();
  return line;
}

std::optional<std::string> LabelLines::next() {
  for (;;) {
    auto line = take_line();
    if (!line || !is_blank_line(*line)) {
      return line;
    }
  }
}

} // namespace blactl::cli
