#pragma once
// Reads a log line by line, from a file or a pipe of any length, plain or packed by gzip: one of
// candump, of Vector (ASC) or of PEAK (TRC 1.1 to 2.1), told by its content.

#include "blactl/base/error.hpp"
#include "blactl/can/log_line.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::can {

class LogFormat;
class LogInput;

/// Uses one buffer, and some more memory to unpack a log. Lines that begin with # are comments;
/// other lines that are not of the log's format are skipped and counted.
class LogReader {
 public:
  /// `path`: a file, or `-` for standard input. Errors: bad_file.
  [[nodiscard]] static Result<std::unique_ptr<LogReader>> open(const std::string& path);

  ~LogReader();
  LogReader(const LogReader&) = delete;
  LogReader& operator=(const LogReader&) = delete;

  /// The next line that the format has (also those of CAN FD and remarks, as LogLine::Kind::other).
  /// Its strings are valid until the next call. Empty: see ended() and has_paused(). Never waits: a
  /// pipe may have nothing yet.
  [[nodiscard]] std::optional<LogLine> next();

  /// Nothing more comes; error() is set if the log ended too early.
  [[nodiscard]] bool ended() const { return ended_; }

  /// next() returned empty though there is more: it limits how much it skips per call, so that the
  /// user can interrupt it.
  [[nodiscard]] bool has_paused() const { return has_paused_; }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  /// Becomes readable when more may have come.
  [[nodiscard]] int descriptor() const;

  /// The name for messages: the path, or "standard input".
  [[nodiscard]] const std::string& name() const { return name_; }

  /// The number of the line last returned by next(), from 1.
  [[nodiscard]] std::uint64_t line_number() const { return line_number_; }

  /// The number of lines that are not of the format, and where the first of them is.
  [[nodiscard]] std::uint64_t bad_lines() const { return bad_lines_; }

  [[nodiscard]] std::uint64_t first_bad_line() const { return first_bad_line_; }

 private:
  LogReader(std::unique_ptr<LogInput> input, std::string name);

  [[nodiscard]] std::optional<std::string_view> take_line();
  [[nodiscard]] std::optional<std::string_view> take_last_line();
  [[nodiscard]] bool read_more();
  void count_bad();

  std::unique_ptr<LogInput> input_;
  std::unique_ptr<LogFormat> format_;
  std::string name_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0; ///< bytes read and not yet returned
  std::size_t searched_ = 0;        ///< bytes after begin_ known to hold no line end
  bool ended_ = false;
  bool in_long_line_ = false; ///< its beginning did not fit and was discarded
  bool has_paused_ = false;
  std::size_t passed_over_ = 0; ///< lines and pieces of lines, by the current next()
  std::optional<Error> error_;
  std::uint64_t line_number_ = 0;
  std::uint64_t bad_lines_ = 0;
  std::uint64_t first_bad_line_ = 0;
};

} // namespace blactl::can
