#include "cli/output/table.hpp"

#include <algorithm>

namespace blactl::cli {
namespace {

constexpr std::size_t gap = 2;

/// The indentation of further lines of a row: below the second column, if the first is as narrow as
/// an address.
std::size_t deeper(const std::vector<std::size_t>& widths) {
  constexpr std::size_t usual = 4, most = 6;
  return widths.front() + gap <= most ? widths.front() + gap : usual;
}

} // namespace

std::vector<std::size_t> Table::widths() const {
  std::vector<std::size_t> widths(rows_.empty() ? 0 : rows_.front().size());
  for (const Row& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], display_width(row[i]));
    }
  }
  return widths;
}

std::vector<Table::Line> Table::layout(const std::vector<std::size_t>& widths, std::size_t indent,
                                       std::size_t page_width) {
  std::vector<Line> lines{{0, 0}};
  std::size_t used = indent;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    const bool begins = lines.back().first == i;
    if (!begins && used + widths[i] > page_width) {
      lines.push_back({i, i});
      used = indent + deeper(widths);
    }
    used += widths[i] + gap;
    lines.back().end = i + 1;
  }
  return lines;
}

bool Table::fits(std::string_view indent, const Page& page) const {
  return layout(widths(), indent.size(), page.width).size() == 1;
}

std::string Table::text(std::string_view indent, const Page& page) const {
  const std::vector<std::size_t> all_widths = widths();
  const std::vector<Line> lines = layout(all_widths, indent.size(), page.width);
  std::string out;
  for (std::size_t number = 0; number < rows_.size(); ++number) {
    const Row& row = rows_[number];
    for (const Line& line : lines) {
      if (has_header_ && number == 0 && line.first > 0 && line.end - line.first == 1) {
        continue;
      }
      std::string text(indent.size() + (line.first > 0 ? deeper(all_widths) : 0), ' ');
      for (std::size_t i = line.first; i < line.end; ++i) {
        text += row[i];
        text.append(all_widths[i] - display_width(row[i]) + gap, ' ');
      }
      text.erase(text.find_last_not_of(' ') + 1);
      if (!text.empty() || line.first == 0) { // further lines need content
        out += text + '\n';
      }
    }
    const auto below = below_.find(number);
    for (const std::string& text :
         below != below_.end() ? below->second : std::vector<std::string>{}) {
      out += indent;
      out += std::string(all_widths.front() + gap, ' ') + text + '\n';
    }
  }
  return out;
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += i == 0 ? "" : ",";
    if (cells[i].find_first_of(",\"\r\n") == std::string::npos) {
      line += cells[i];
      continue;
    }
    line += '"';
    for (const char c : cells[i]) {
      line += c == '"' ? "\"\"" : std::string(1, c);
    }
    line += '"';
  }
  return line + '\n';
}

} // namespace blactl::cli
