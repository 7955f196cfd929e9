#pragma once
// Who stands beside a station while it works: scans the labels, and remembers what the servos held
// at the moment when a record was told.

#include "line.hpp"
#include "world.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace blactl::campaign {

/// A record as it was told.
struct ToldRecord {
  nlohmann::json record;
  Time at;
  States states; ///< of all servos at that moment
};

/// Of one run; standard input is its own meanwhile.
class LineWatch {
 public:
  LineWatch(World& world, const std::vector<Visit>& visits, bool has_labels);
  ~LineWatch();
  LineWatch(const LineWatch&) = delete;
  LineWatch& operator=(const LineWatch&) = delete;

  /// A bus that lets it look on.
  [[nodiscard]] std::unique_ptr<can::Bus> around(std::unique_ptr<can::Bus> bus);

  /// What was told, in all that the run printed.
  [[nodiscard]] std::vector<ToldRecord> told(const std::string& out);

  /// Sees what is new.
  void look();

 private:
  void take(const std::string& line);
  void scan();

  World& world_;
  const std::vector<Visit>& visits_;
  int labels_ = -1;      ///< where they are written to
  std::size_t next_ = 0; ///< visit
  std::size_t open_ = 0; ///< labels that no record has used up
  std::size_t seen_ = 0; ///< of the output
  std::string rest_;     ///< of a line
  std::vector<ToldRecord> told_;
};

} // namespace blactl::campaign
