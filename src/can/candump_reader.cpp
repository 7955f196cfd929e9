#include "blactl/can/candump_reader.hpp"

#include "blactl/base/system_error.hpp"
#include "blactl/can/replay_texts.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace blactl::can {
namespace {

/// What is read at a time, and the longest line: the longest of candump (64 bytes of CAN FD with
/// their text) has some 300.
constexpr std::size_t block_size = 64 << 10;

Error unreadable(const std::string& name, int error) {
  return {Code::bad_file, say<texts::log_unreadable>(name, system_reason(error)),
          say<texts::log_unreadable_hint>()};
}

} // namespace

Result<std::unique_ptr<CandumpReader>> CandumpReader::open(const std::string& path) {
  const bool is_stdin = path == "-";
  const std::string name = is_stdin ? say<texts::standard_input>() : printable(path);
  const int descriptor = is_stdin ? fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1)
                                  : ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) {
    return std::unexpected(unreadable(name, errno));
  }
  std::unique_ptr<CandumpReader> reader(new CandumpReader(descriptor, name));
  struct stat status{};
  if (fstat(descriptor, &status) != 0) {
    return std::unexpected(unreadable(name, errno));
  }
  if (S_ISDIR(status.st_mode)) {
    return std::unexpected(unreadable(name, EISDIR));
  }
  return reader;
}

CandumpReader::CandumpReader(int descriptor, std::string name)
    : descriptor_(descriptor), name_(std::move(name)), buffer_(block_size) {}

CandumpReader::~CandumpReader() {
  close(descriptor_);
}

std::optional<LogLine> CandumpReader::next() {
  while (const auto text = take_line()) {
    ++line_number_;
    if (std::exchange(in_long_line_, false)) {
      count_bad();
      continue;
    }
    if (auto line = parse_line(*text)) {
      return line;
    }
    if (!text->starts_with('#')) { // a comment
      count_bad();
    }
  }
  return std::nullopt;
}

void CandumpReader::count_bad() {
  if (bad_lines_++ == 0) {
    first_bad_line_ = line_number_;
  }
}

/// The next line without its end; the last one of a file may have none.
std::optional<std::string_view> CandumpReader::take_line() {
  for (;;) {
    const std::string_view unread(buffer_.data() + begin_, end_ - begin_);
    const auto size = unread.find('\n', searched_);
    if (size != std::string_view::npos) {
      begin_ += size + 1;
      searched_ = 0;
      return unread.substr(0, size);
    }
    searched_ = unread.size();
    if (!ended_ && read_more()) {
      continue;
    }
    if (!ended_ || (unread.empty() && !in_long_line_)) {
      return std::nullopt;
    }
    begin_ = end_;
    searched_ = 0;
    return unread;
  }
}

/// Whether something changed: bytes came, or the file ended.
bool CandumpReader::read_more() {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
            buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
  end_ -= std::exchange(begin_, 0);
  if (end_ == buffer_.size()) {
    in_long_line_ = true;
    end_ = searched_ = 0;
  }
  // Whoever gave us a pipe may read from it too: its mode is not ours to change, so it is asked
  // whether it has something.
  pollfd readable{descriptor_, POLLIN, 0};
  if (poll(&readable, 1, 0) <= 0) {
    return false;
  }
  const auto size = read(descriptor_, buffer_.data() + end_, buffer_.size() - end_);
  if (size < 0 && (errno == EINTR || errno == EAGAIN)) {
    return false;
  }
  if (size < 0) {
    error_ = unreadable(name_, errno);
  }
  ended_ = size <= 0;
  end_ += static_cast<std::size_t>(std::max<ssize_t>(size, 0));
  return true;
}

} // namespace blactl::can
