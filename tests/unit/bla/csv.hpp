#pragma once
// The tables of the specification as they lie in tests/data/spec.

#include "catch.hpp"

#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace blactl::test {

using Row = std::map<std::string, std::string>;

/// The fields of all records (RFC 4180).
inline std::vector<std::vector<std::string>> split_csv(const std::string& text) {
  std::vector<std::vector<std::string>> records(1, std::vector<std::string>(1));
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && quoted && i + 1 < text.size() && text[i + 1] == '"') {
      records.back().back() += text[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      records.back().emplace_back();
    } else if (c == '\n' && !quoted) {
      records.emplace_back(1);
    } else if (c != '\r' || quoted) {
      records.back().back() += c;
    }
  }
  if (records.back() == std::vector<std::string>(1)) {
    records.pop_back();
  }
  return records;
}

/// The rows of a table by the names of its columns; a shortened file does not pass.
inline std::vector<Row> read_table(const std::string& name, std::size_t expected_rows) {
  std::ifstream file(BLACTL_TEST_DATA "/spec/" + name);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto records = split_csv(text);
  REQUIRE(records.size() == expected_rows + 1);
  std::vector<Row> rows;
  for (std::size_t i = 1; i < records.size(); ++i) {
    REQUIRE(records[i].size() == records[0].size());
    Row row;
    for (std::size_t column = 0; column < records[0].size(); ++column) {
      row[records[0][column]] = records[i][column];
    }
    rows.push_back(row);
  }
  return rows;
}

} // namespace blactl::test
