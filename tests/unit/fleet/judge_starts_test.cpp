// What starts of a servo show, by times that were observed.

#include "catch.hpp"
#include "fleet/characterize/findings.hpp"

#include <initializer_list>
#include <string>

using namespace blactl;
using namespace blactl::fleet;
using namespace std::chrono_literals;

namespace {

/// Restarts that are silent and send a NodeStatus for so long, and a save like the last of them.
StartsSeen starts(std::initializer_list<std::pair<Duration, Duration>> times) {
  StartsSeen seen;
  Time at{};
  for (const auto& [silence, until_status] : times) {
    at += 5s;
    seen.restarts.push_back({.asked = at,
                             .answered = at,
                             .first = at + silence,
                             .first_status = at + silence + until_status});
  }
  seen.save = seen.restarts.back();
  return seen;
}

Characterization judged(StartsSeen seen) {
  Notes notes;
  judge_starts(std::move(seen), notes);
  return std::move(notes).result();
}

/// Empty: it was left open.
std::optional<FactValue> fact(const Characterization& judged, const std::string& setting) {
  const auto found = std::ranges::find(judged.facts, setting, &Fact::setting);
  REQUIRE(found != judged.facts.end());
  return found->value;
}

} // namespace

TEST_CASE("a first frame of the previous run is corrected by the NodeStatus") {
  auto seen = starts({{90ms, 300ms}, {91ms, 300ms}, {90ms, 301ms}});
  seen.save = Start{.asked = Time(60s),
                    .answered = Time(60s),
                    .first = Time(60s + 700ms), // the first ones were missed
                    .first_status = Time(60s + 590ms)};
  const auto all = judged(std::move(seen));
  CHECK(fact(all, "boot_time") == FactValue("90ms"));
  CHECK(fact(all, "first_node_status") == FactValue("300ms"));
  CHECK(fact(all, "rom_write_time") == FactValue("200ms"));
}

TEST_CASE("starts that differ from each other show no time, and no silence is negative") {
  const auto statuses = judged(starts({{70ms, 30ms}, {65ms, 510ms}, {68ms, 920ms}}));
  CHECK_FALSE(fact(statuses, "first_node_status"));
  CHECK(fact(statuses, "boot_time") == FactValue("68ms"));
  CHECK(fact(statuses, "rom_write_time") == FactValue("0ms"));
  for (const Observation& observation : statuses.observations) {
    INFO(observation.what << ": " << observation.value);
    CHECK(observation.value.find('-') == std::string::npos);
  }
  const auto boots = judged(starts({{70ms, 300ms}, {250ms, 300ms}, {480ms, 300ms}}));
  CHECK_FALSE(fact(boots, "boot_time"));
  CHECK_FALSE(fact(boots, "rom_write_time"));
  CHECK(fact(boots, "first_node_status") == FactValue("300ms"));
}
