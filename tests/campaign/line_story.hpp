#pragma once
// What happened on a production line, and what of it was recorded.

#include "disturbance.hpp"
#include "line.hpp"
#include "line_watch.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace blactl::campaign {

/// One run of a station.
struct Shift {
  Disturbance disturbance;
  std::vector<Visit> visits; ///< that may come while it runs
  bool is_calm = false;      ///< all servos were repaired, and nothing goes wrong
  bool is_redo = false;
  std::size_t count = 0; ///< --count; 0: none
  Time begin, end;
  Outcome outcome;
  std::vector<ToldRecord> told;

  /// It did not end by itself.
  [[nodiscard]] bool is_cut() const;

  /// Whether this record ended while it ran, by the clock of the simulator.
  [[nodiscard]] bool includes(const nlohmann::json& record) const;
};

/// An ID in the counters.
struct GivenId {
  std::string parameter;
  std::int64_t lap = 0, value = 0;
  bool is_counted = false; ///< by a counter, not by a label
  std::string unique_id;   ///< empty: it was freed
};

[[nodiscard]] std::vector<GivenId> read_counters(const std::filesystem::path& file);

/// All of a line, after its end.
struct LineStory {
  const Line& line;
  std::vector<Shift> shifts;
  std::map<std::int64_t, std::vector<Span>> powered; ///< by serial number
  std::vector<nlohmann::json> ledger;                ///< its records
  std::vector<GivenId> given;
  nlohmann::json
      scrapped{}; ///< the record of the unit that was taken out before the last run; null

  /// Whether this servo had power at some moment from there to then.
  [[nodiscard]] bool has_power(std::int64_t serial, Time from, Time to) const;
};

/// When the work that this record tells of began.
[[nodiscard]] Time begin_of(const ToldRecord& told);

/// Its label, as an object; empty: it has none.
[[nodiscard]] std::optional<nlohmann::json> label_in(const nlohmann::json& record);

} // namespace blactl::campaign
