#pragma once
// Aligned columns of text, on a page of any width.

#include "cli/output/page.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// A header and rows of the same number of cells; columns are as wide as their widest cell. Columns
/// that do not fit beside the others go below them, in further, indented lines of each row: nothing
/// is cut or left out but the header of a column that has such lines for itself.
class Table {
 public:
  explicit Table(std::vector<std::string> header) : has_header_(true), rows_{std::move(header)} {}

  /// A table without a header.
  Table() = default;

  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

  /// Adds a line of any length below the last row, from the second column on.
  void add_below(std::string line) { below_[rows_.size() - 1].push_back(std::move(line)); }

  /// Whether all columns fit beside each other.
  [[nodiscard]] bool fits(std::string_view indent, const Page& page) const;

  /// The table; every line begins with `indent` and ends with a line break, without trailing
  /// blanks.
  [[nodiscard]] std::string text(std::string_view indent = "", const Page& page = {}) const;

 private:
  using Row = std::vector<std::string>;

  /// Columns beside each other.
  struct Line {
    std::size_t first = 0, end = 0;
  };

  [[nodiscard]] std::vector<std::size_t> widths() const;
  [[nodiscard]] static std::vector<Line> layout(const std::vector<std::size_t>& widths,
                                                std::size_t indent, std::size_t page_width);

  bool has_header_ = false;
  std::vector<Row> rows_;                                 ///< including the header
  std::map<std::size_t, std::vector<std::string>> below_; ///< by row
};

/// One record of comma-separated values (RFC 4180), with its line break.
[[nodiscard]] std::string csv_line(const std::vector<std::string>& cells);

} // namespace blactl::cli
