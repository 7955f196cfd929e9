#pragma once
// The limits of each model, from the tables of the specification and not from the profiles.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace blactl::campaign {

struct Limits {
  std::int64_t min = 0, max = 0;
  std::int64_t factory = 0; ///< the value after ERASE
};

/// Tables 3-1 to 3-12.
class LimitTable {
 public:
  /// `folder`: tests/data/spec.
  explicit LimitTable(const std::string& folder);

  /// By address: the writable settings of "BLA21-12U-AB" that are saved, IDs left out.
  [[nodiscard]] const std::map<std::uint8_t, Limits>& of(const std::string& model) const {
    return models_.at(model);
  }

 private:
  std::map<std::string, std::map<std::uint8_t, Limits>> models_;
};

/// As read from the data of the tests.
[[nodiscard]] const LimitTable& limits();

} // namespace blactl::campaign
