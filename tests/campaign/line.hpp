#pragma once
// A production line: units that come to the bench of a station one after the other, and all that
// goes wrong there, from a seed.

#include "disturbance.hpp"
#include "episode.hpp"
#include "world.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace blactl::campaign {

/// From a time to another one.
struct Span {
  Time from, to;
};

/// Units that are put on the bench, and taken off again.
struct Visit {
  std::vector<std::int64_t> serials;
  Span span;
  std::string label; ///< what is scanned as they come
};

struct Line {
  Episode episode; ///< its servos and what goes wrong with them; it has no steps
  nlohmann::json recipe;
  std::vector<Visit> visits;
  std::vector<Disturbance> disturbances{}; ///< of the first run, the second, …
  std::int64_t spare = 0; ///< the serial number of a unit that comes only in the end; 0: none
  bool has_labels = false;
  bool has_count = false;    ///< --count
  bool has_scrap = false;    ///< a unit that has passed is scrapped in the end
  bool is_done_anew = false; ///< in the end with --redo

  [[nodiscard]] const nlohmann::json& servo(std::int64_t serial) const;

  /// Whether others have its unique ID.
  [[nodiscard]] bool is_doublet(std::int64_t serial) const;

  [[nodiscard]] Time end() const { return visits.back().span.to; }
};

/// What brings these units, and takes them off: of a scenario that begins at `base`.
[[nodiscard]] nlohmann::json comings(const std::vector<Visit>& visits, const nlohmann::json& servos,
                                     Time base);

/// When this servo has power in a scenario with these events, which begins at `base`.
[[nodiscard]] std::vector<Span> powered(const nlohmann::json& events, std::int64_t serial,
                                        Time base);

[[nodiscard]] Line make_line(std::uint64_t seed);

/// One on which nothing goes wrong; `seed` tells whether there are labels.
[[nodiscard]] Line make_calm_line(std::uint64_t seed);

} // namespace blactl::campaign
