#pragma once
// The results of measuring a servo.

#include "blactl/bla/values.hpp"
#include "blactl/fleet/characterize/characterization.hpp"

#include "fleet/characterize/start_watch.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::fleet {

class TestBench;

class Notes {
 public:
  /// All open questions with their default reasons, none measured.
  Notes();

  void found(std::string_view setting, FactValue value) { fact(setting).value = std::move(value); }

  /// Records why a setting was not measured; an earlier measurement stays.
  void leave(std::string_view setting, std::string reason) {
    fact(setting).reason = std::move(reason);
  }

  void observe(std::string what, std::string value) {
    observations_.push_back({std::move(what), std::move(value)});
  }

  void describe(NodeInfo info) { info_ = std::move(info); }

  /// Counts responses that never came, although the servo was there.
  void lose_answer() { ++lost_answers_; }

  [[nodiscard]] bool has_lost_answers() const { return lost_answers_ > 0; }

  [[nodiscard]] const std::optional<FactValue>& value(std::string_view setting) {
    return fact(setting).value;
  }

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

/// One measurement: it checks its conditions first, and its settings are restored after it. Errors
/// end the characterization; what it cannot determine it leaves open.
using Measurement = Result<void> (*)(TestBench& bench, Notes& notes);

[[nodiscard]] std::span<const Measurement> measurements_of_answers();

/// Measurements that write to RAM while the output is off; the last one switches it on for a
/// moment.
[[nodiscard]] std::span<const Measurement> measurements_at_rest();

// Of these, one room each.
[[nodiscard]] Result<void> measure_array_command(TestBench& bench, Notes& notes);
[[nodiscard]] Result<void> measure_waiting_settings(TestBench& bench, Notes& notes);
[[nodiscard]] Result<void> measure_protection(TestBench& bench, Notes& notes);

/// The bit of 0x19 to 0x1B with this code in the profiles.
[[nodiscard]] std::int64_t bit_of(const TestBench& bench, std::string_view code);

/// Measures starts: each leaves the servo with its ROM settings.
[[nodiscard]] Result<void> measure_starts(TestBench& bench, Notes& notes);

struct StartsSeen {
  std::vector<Start> restarts{};
  bla::Values at_once{}; ///< read as soon as it was back from the first start
  bla::Values rom{};     ///< register values at rest after a start
  std::int64_t failures_before = 0, failures_after = 0; ///< 0x1B before and after the restarts
  bool is_rom_readable = true;                          ///< false: nothing was saved
  std::optional<Start> save{};
};

/// The registers to read as soon as it is back; the angle last, so that it is as of the end of the
/// reads.
[[nodiscard]] std::vector<bla::Address> asked_at_once();

void judge_starts(StartsSeen seen, Notes& notes);

/// The number of measured restarts, not counting the save.
inline constexpr int restarts_measured = 3;

} // namespace blactl::fleet
