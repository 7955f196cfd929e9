#pragma once
// Columns of text that line up, on a page of any width.

#include "cli/output/page.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// A header and rows of the same number of cells; columns are as wide as their widest cell. The
/// columns that do not fit beside the others stand below them, in further lines of each row that
/// are indented: nothing is cut, and nothing is left out but the header of a column that has such
/// lines for itself.
class Table {
 public:
  explicit Table(std::vector<std::string> header) : has_header_(true), rows_{std::move(header)} {}

  /// Without a header.
  Table() = default;

  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

  /// A line below the last row, from the second column on, however long it is.
  void add_below(std::string line) { below_[rows_.size() - 1].push_back(std::move(line)); }

  /// Nothing has to stand below.
  [[nodiscard]] bool fits(std::string_view indent, const Page& page) const;

  /// Every line begins with `indent` and ends with a line break, without trailing blanks.
  [[nodiscard]] std::string text(std::string_view indent = "", const Page& page = {}) const;

 private:
  using Row = std::vector<std::string>;

  /// Columns that stand beside each other.
  struct Line {
    std::size_t first = 0, end = 0;
  };

  [[nodiscard]] std::vector<std::size_t> widths() const;
  [[nodiscard]] static std::vector<Line> layout(const std::vector<std::size_t>& widths,
                                                std::size_t indent, std::size_t page_width);

  bool has_header_ = false;
  std::vector<Row> rows_;                                 ///< the header among them
  std::map<std::size_t, std::vector<std::string>> below_; ///< by row
};

/// One record of comma-separated values (RFC 4180), with its line break.
[[nodiscard]] std::string csv_line(const std::vector<std::string>& cells);

} // namespace blactl::cli
