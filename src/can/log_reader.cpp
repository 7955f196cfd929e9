#include "blactl/can/log_reader.hpp"

#include "blactl/base/system_error.hpp"
#include "blactl/can/replay_texts.hpp"

#include "can/log/log_format.hpp"
#include "can/log_input.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <span>
#include <utility>

namespace blactl::can {
namespace {

/// The size of one read and of the longest line: candump's longest (64 bytes of CAN FD with their
/// text) has some 300 characters.
constexpr std::size_t block_size = 64 << 10;

/// The most empty lines, and pieces of an endless line, that one call of next() skips: some tens of
/// milliseconds. A few KiB of gzip may hold gigabytes.
constexpr std::size_t most_passed_over = 1024;

Error unreadable(const std::string& name, int error) {
  return {Code::bad_file, say<texts::log_unreadable>(name, system_reason(error)),
          say<texts::log_unreadable_hint>()};
}

/// The fault of the input after `lines` lines, if any.
std::optional<Error> fault_of(const LogInput& input, const std::string& name, std::uint64_t lines) {
  switch (input.fault()) {
  case LogInput::Fault::unreadable: return unreadable(name, input.error_number());
  case LogInput::Fault::cut_off:
    return Error{Code::bad_file, say<texts::log_cut_off>(name, lines),
                 say<texts::log_damaged_hint>()};
  case LogInput::Fault::damaged:
    return Error{Code::bad_file, say<texts::log_damaged>(name, lines),
                 say<texts::log_damaged_hint>()};
  case LogInput::Fault::none: break;
  }
  return std::nullopt;
}

} // namespace

Result<std::unique_ptr<LogReader>> LogReader::open(const std::string& path) {
  const bool is_stdin = path == "-";
  const std::string name = is_stdin ? say<texts::standard_input>() : printable(path);
  const int descriptor = is_stdin ? fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1)
                                  : ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) {
    return std::unexpected(unreadable(name, errno));
  }
  auto input = std::make_unique<LogInput>(descriptor);
  struct stat status{};
  if (fstat(descriptor, &status) != 0) {
    return std::unexpected(unreadable(name, errno));
  }
  if (S_ISDIR(status.st_mode)) {
    return std::unexpected(unreadable(name, EISDIR));
  }
  return std::unique_ptr<LogReader>(new LogReader(std::move(input), name));
}

LogReader::LogReader(std::unique_ptr<LogInput> input, std::string name)
    : input_(std::move(input)), format_(std::make_unique<LogFormat>()), name_(std::move(name)),
      buffer_(block_size) {}

LogReader::~LogReader() = default;

int LogReader::descriptor() const {
  return input_->descriptor();
}

std::optional<LogLine> LogReader::next() {
  passed_over_ = 0;
  has_paused_ = false;
  while (const auto text = take_line()) {
    ++line_number_;
    const bool is_long = std::exchange(in_long_line_, false);
    if (!is_long) {
      if (auto line = format_->parse(*text)) {
        return line;
      }
    }
    if (is_long || !text->starts_with('#')) { // a comment
      count_bad();
    }
    ++passed_over_;
  }
  return std::nullopt;
}

void LogReader::count_bad() {
  if (bad_lines_++ == 0) {
    first_bad_line_ = line_number_;
  }
}

std::optional<std::string_view> LogReader::take_line() {
  while (!ended_) {
    const std::string_view unread(buffer_.data() + begin_, end_ - begin_);
    const auto size = unread.find('\n', searched_);
    if (size != std::string_view::npos) {
      begin_ += size + 1;
      searched_ = 0;
      return unread.substr(0, size);
    }
    searched_ = unread.size();
    if (input_->ended()) {
      return take_last_line();
    }
    if (passed_over_ >= most_passed_over) {
      has_paused_ = true;
      return std::nullopt;
    }
    if (!read_more()) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

/// The rest of the file: its last line may lack a line end.
std::optional<std::string_view> LogReader::take_last_line() {
  const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
  error_ = fault_of(*input_, name_, line_number_);
  begin_ = end_;
  searched_ = 0;
  // A partial line may look like a complete one.
  ended_ = error_ || (rest.empty() && !in_long_line_);
  return ended_ ? std::nullopt : std::optional(rest);
}

/// Returns whether anything changed: bytes came, or the file ended.
bool LogReader::read_more() {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
            buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
  end_ -= std::exchange(begin_, 0);
  if (end_ == buffer_.size()) {
    in_long_line_ = true;
    end_ = searched_ = 0;
    ++passed_over_;
  }
  const auto size = input_->read(std::span(buffer_).subspan(end_));
  end_ += size;
  return size > 0 || input_->ended();
}

} // namespace blactl::can
