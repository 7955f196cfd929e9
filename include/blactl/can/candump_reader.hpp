#pragma once
// Reads a candump log line by line, from a file or a pipe of any length, plain or packed by gzip.

#include "blactl/base/error.hpp"
#include "blactl/can/candump.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::can {

class LogInput;

/// One buffer is all the memory it takes, and some more where a log is unpacked. Lines that begin
/// with # are comments; others that are not candump's are passed over and counted.
class CandumpReader {
 public:
  /// `path`: a file, or `-` for standard input. Errors: bad_file.
  [[nodiscard]] static Result<std::unique_ptr<CandumpReader>> open(const std::string& path);

  ~CandumpReader();
  CandumpReader(const CandumpReader&) = delete;
  CandumpReader& operator=(const CandumpReader&) = delete;

  /// The next line of a frame (also those of CAN FD and remarks, as LogLine::Kind::other). Its
  /// strings are valid until the next call. Empty: see ended() and has_paused(). Never waits: a
  /// pipe may have nothing yet.
  [[nodiscard]] std::optional<LogLine> next();

  /// Nothing more comes; error() tells if there should have been more.
  [[nodiscard]] bool ended() const { return ended_; }

  /// next() gave nothing though there is more: it passes over so much at a time and no more, so
  /// that somebody can end it.
  [[nodiscard]] bool has_paused() const { return has_paused_; }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  /// Can be read when more may have come.
  [[nodiscard]] int descriptor() const;

  /// As a person names it: the path, or "standard input".
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Of the line that next() gave last, from 1.
  [[nodiscard]] std::uint64_t line_number() const { return line_number_; }

  /// Lines that are none of candump's, and the number of the first of them.
  [[nodiscard]] std::uint64_t bad_lines() const { return bad_lines_; }

  [[nodiscard]] std::uint64_t first_bad_line() const { return first_bad_line_; }

 private:
  CandumpReader(std::unique_ptr<LogInput> input, std::string name);

  [[nodiscard]] std::optional<std::string_view> take_line();
  [[nodiscard]] std::optional<std::string_view> take_last_line();
  [[nodiscard]] bool read_more();
  void count_bad();

  std::unique_ptr<LogInput> input_;
  std::string name_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0; ///< what was read and not given yet
  std::size_t searched_ = 0;        ///< how far behind begin_ there is no line end
  bool ended_ = false;
  bool in_long_line_ = false; ///< its beginning had no room and is gone
  bool has_paused_ = false;
  std::size_t passed_over_ = 0; ///< lines and pieces of lines, by the next() that runs
  std::optional<Error> error_;
  std::uint64_t line_number_ = 0;
  std::uint64_t bad_lines_ = 0;
  std::uint64_t first_bad_line_ = 0;
};

} // namespace blactl::can
