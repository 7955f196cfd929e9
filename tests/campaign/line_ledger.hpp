#pragma once
// Whether the records of a line belong together: their numbers, and the IDs that were given.

#include "line_story.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::campaign {

[[nodiscard]] bool is_verdict(const nlohmann::json& record, std::string_view verdict);
[[nodiscard]] bool is_interrupted(const nlohmann::json& record);

/// Its unique ID; empty: it has none.
[[nodiscard]] std::string unit_in(const nlohmann::json& record);

/// Throws Lie, with the name of the record, unless `truth`.
void hold(const nlohmann::json& record, bool truth, std::string_view what);

class LineLedger {
 public:
  /// The story outlives this.
  explicit LineLedger(const LineStory& story) : story_(story), line_(story.line) {}

  /// How often this unit had failed before this record, since it was finished or scrapped.
  [[nodiscard]] std::size_t failed_before(const nlohmann::json& record) const;
  [[nodiscard]] bool is_finished_before(const nlohmann::json& record) const;

  /// Throws Lie.
  void check() const;

 private:
  [[nodiscard]] std::vector<const nlohmann::json*> before(const nlohmann::json& record) const;
  void check_records() const;
  void check_told_once(const nlohmann::json& record) const;
  void check_ids() const;
  void check_given_once(const std::string& parameter) const;
  [[nodiscard]] std::size_t laps(const nlohmann::json& counter) const;
  void check_none_left_out(const std::string& parameter) const;
  void check_scrapped() const;

  const LineStory& story_;
  const Line& line_;
};

} // namespace blactl::campaign
