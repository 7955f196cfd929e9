#pragma once
// Columns of text that line up, Japanese characters counted as two cells.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// How many cells of a terminal a UTF-8 text takes.
[[nodiscard]] std::size_t display_width(std::string_view text);

/// A header and rows of the same number of cells; columns are as wide as their widest cell.
class Table {
 public:
  explicit Table(std::vector<std::string> header) : rows_{std::move(header)} {}

  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

  /// Every line begins with `indent` and ends with a line break, without trailing blanks.
  [[nodiscard]] std::string text(std::string_view indent = "") const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// One record of comma-separated values (RFC 4180), with its line break.
[[nodiscard]] std::string csv_line(const std::vector<std::string>& cells);

} // namespace blactl::cli
