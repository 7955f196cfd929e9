#include "cli/line/record_view.hpp"

#include "blactl/base/json_writer.hpp"

#include "cli/line/texts.hpp"
#include "cli/output/table.hpp"

#include <fmt/format.h>

#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace blactl::cli {

using state::LedgerColumn;
using state::LedgerRecord;

namespace {

/// A measured value, to a tenth, or a time to a millisecond.
std::string digits(const LedgerColumn& column, double value) {
  return column.name == "duration_s" ? fmt::format("{:.3f}", value) : fmt::format("{:.1f}", value);
}

std::string json_line(const LedgerRecord& record) {
  std::string line;
  JsonWriter json(line);
  json.begin_object();
  for (const LedgerColumn& column : state::ledger_columns) {
    json.key(column.name);
    std::visit(
        [&](auto member) {
          const auto& value = record.*member;
          if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, LedgerRecord::Real>) {
            value ? json.number(digits(column, *value)) : json.value(nullptr);
          } else {
            json.value(value);
          }
        },
        column.member);
  }
  json.end_object();
  return line + '\n';
}

std::string cell(const LedgerRecord& record, const LedgerColumn& column) {
  return std::visit(
      [&](auto member) -> std::string {
        const auto& value = record.*member;
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, LedgerRecord::Real>) {
          return value ? digits(column, *value) : std::string();
        } else {
          return value ? fmt::format("{}", *value) : std::string();
        }
      },
      column.member);
}

std::string verdict_word(std::string_view verdict, const Page& page) {
  return verdict == "pass"    ? page.paint(Tone::good, say<texts::line_pass>())
         : verdict == "fail"  ? page.paint(Tone::bad, say<texts::line_fail>())
         : verdict == "error" ? page.paint(Tone::warning, say<texts::line_error>())
         : verdict == "skip"  ? say<texts::line_skip>()
                              : say<texts::line_scrap>();
}

/// "12:00:05  PASS  240900558  BLA21-12U-AB  servo_id 3, static_node_id 13", and why it is none.
std::string text_line(const LedgerRecord& record, const Page& page,
                      const std::optional<Error>& reason) {
  std::string line = fmt::format("{}  {}", record.time.value_or(""),
                                 verdict_word(record.verdict.value_or(""), page));
  const auto add = [&](const std::optional<std::string>& text) {
    line += text && !text->empty() ? "  " + printable(*text) : std::string();
  };
  add(record.serial_number ? std::optional(std::to_string(*record.serial_number)) : record.label);
  add(record.model);
  if (record.verdict == "pass" || record.verdict == "skip") {
    line += record.servo_id ? fmt::format("  servo_id {}", *record.servo_id) : std::string();
    line += record.static_node_id ? fmt::format("  static_node_id {}", *record.static_node_id)
                                  : std::string();
  }
  add(record.code ? std::optional(fmt::format("[{}]", *record.code)) : std::nullopt);
  if (reason) {
    line += " " + printable(reason->message);
    line += reason->hint.empty() ? std::string() : "\n    " + printable(reason->hint);
  }
  return line + '\n';
}

} // namespace

std::string record_line(const LedgerRecord& record, Format format, const Page& page,
                        const std::optional<Error>& reason) {
  if (format == Format::json) {
    return json_line(record);
  }
  if (format == Format::text) {
    return text_line(record, page, reason);
  }
  std::vector<std::string> cells;
  cells.reserve(state::ledger_columns.size());
  for (const LedgerColumn& column : state::ledger_columns) {
    cells.push_back(cell(record, column));
  }
  return csv_line(cells);
}

std::string records_header(Format format) {
  if (format != Format::csv) {
    return {};
  }
  std::vector<std::string> names;
  names.reserve(state::ledger_columns.size());
  for (const LedgerColumn& column : state::ledger_columns) {
    names.emplace_back(column.name);
  }
  return csv_line(names);
}

} // namespace blactl::cli
