#pragma once
// What is found while a servo is measured.

#include "blactl/fleet/characterize/characterization.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::fleet {

class TestBench;

class Notes {
 public:
  /// Of every open question nothing is known but why.
  Notes();

  void found(std::string_view setting, FactValue value) { fact(setting).value = std::move(value); }

  /// Not measured, because of that; what was found before stays.
  void leave(std::string_view setting, std::string reason) {
    fact(setting).reason = std::move(reason);
  }

  void observe(std::string what, std::string value) {
    observations_.push_back({std::move(what), std::move(value)});
  }

  void describe(NodeInfo info) { info_ = std::move(info); }

  /// Answers that never came, although the servo was there.
  void lose_answer() { ++lost_answers_; }

  [[nodiscard]] bool has_lost_answers() const { return lost_answers_ > 0; }

  [[nodiscard]] const std::optional<FactValue>& value(std::string_view setting) {
    return fact(setting).value;
  }

  /// All of it.
  [[nodiscard]] Characterization result() && {
    Characterization all;
    all.facts = std::move(facts_);
    all.observations = std::move(observations_);
    all.info = std::move(info_);
    return all;
  }

 private:
  [[nodiscard]] Fact& fact(std::string_view setting);

  std::vector<Fact> facts_;
  std::vector<Observation> observations_;
  std::optional<NodeInfo> info_;
  int lost_answers_ = 0;
};

/// One measurement: what it needs it looks at first, what it sets is put back after it. Errors end
/// the measuring; what it cannot find out it leaves.
using Measurement = Result<void> (*)(TestBench& bench, Notes& notes);

/// What only reads.
[[nodiscard]] std::span<const Measurement> measurements_of_answers();

/// What writes to RAM while the output is off.
[[nodiscard]] std::span<const Measurement> measurements_at_rest();

/// Starts: each leaves the servo as ROM has it.
[[nodiscard]] Result<void> measure_starts(TestBench& bench, Notes& notes);

/// How often it is told to restart, the save not counted.
inline constexpr int restarts_measured = 3;

} // namespace blactl::fleet
