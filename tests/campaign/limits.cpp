#include "limits.hpp"

#include <fstream>
#include <stdexcept>

namespace blactl::campaign {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

std::vector<std::vector<std::string>> rows_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(file, line); // the names of the columns
  while (std::getline(file, line)) {
    rows.push_back(cells_of(line));
  }
  if (rows.empty()) {
    throw std::runtime_error("cannot read " + path);
  }
  return rows;
}

std::uint8_t address_of(const std::string& text) {
  return static_cast<std::uint8_t>(std::stoul(text, nullptr, 16));
}

/// Whether "BLA21", "12U" and "AB" have a row of the table; "*" stands for every one.
bool is_meant(const std::vector<std::string>& row, const std::string& model) {
  const std::string series = model.substr(0, 5);
  const std::string variant = model.substr(6, 3);
  const std::string suffix = model.substr(10, 2);
  return row[0] == series && (row[1] == "*" || row[1] == variant) &&
         (row[2] == "*" || row[2] == suffix);
}

} // namespace

LimitTable::LimitTable(const std::string& folder) {
  const auto common = rows_of(folder + "/parameters.csv");
  const auto special = rows_of(folder + "/model_parameters.csv");
  for (const auto* model :
       {"BLA15-06U-A0", "BLA15-12U-A0", "BLA21-06U-A0", "BLA21-06U-AB", "BLA21-12U-A0",
        "BLA21-12U-AB", "BLA21-28U-A0", "BLA21-28U-AB", "BLA34-12U-AB", "BLA34-28U-AB"}) {
    auto& known = models_[model];
    for (const auto& row : common) {
      if (row[5] == "RW" && row[11] == "yes" && !row[8].empty()) {
        known[address_of(row[0])] = {std::stoll(row[8]), std::stoll(row[9]), std::stoll(row[7])};
      }
    }
    for (const auto& row : special) {
      if (is_meant(row, model) && !row[5].empty() && address_of(row[3]) >= 0x20) {
        known[address_of(row[3])] = {std::stoll(row[5]), std::stoll(row[6]), std::stoll(row[4])};
      }
    }
    known.erase(0x45);
    known.erase(0x46);
  }
}

const LimitTable& limits() {
  static const LimitTable table(BLACTL_TEST_DATA "/spec");
  return table;
}

} // namespace blactl::campaign
