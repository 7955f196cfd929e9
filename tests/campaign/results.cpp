#include "results.hpp"

#include "needless.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::campaign {

using nlohmann::json;

json to_json(const Counts& counts) {
  json alone;
  for (const auto& [fault, ends] : counts.alone) {
    alone[fault] = {ends.good, ends.needless};
  }
  return {{"episodes", counts.episodes},
          {"runs", counts.runs},
          {"repeated", counts.repeated},
          {"servo_seconds", counts.servo_seconds},
          {"ends", counts.ends},
          {"faults", counts.faults},
          {"alone", alone},
          {"lies", counts.lies},
          {"stuck", counts.stuck},
          {"alarms", counts.alarms},
          {"deaf", counts.deaf},
          {"crashes", counts.crashes}};
}

Counts counts_in(const json& told) {
  Counts counts{.episodes = told["episodes"],
                .runs = told["runs"],
                .repeated = told["repeated"],
                .servo_seconds = told["servo_seconds"],
                .ends = told["ends"],
                .faults = told["faults"],
                .alone = {},
                .lies = told["lies"],
                .stuck = told["stuck"],
                .alarms = told["alarms"],
                .deaf = told["deaf"],
                .crashes = told["crashes"]};
  for (const auto& [fault, ends] : told["alone"].items()) {
    counts.alone[fault] = {.good = ends[0], .needless = ends[1]};
  }
  return counts;
}

json to_json(const SweptByKind& swept) {
  json all = json::array();
  for (const auto& [key, one] : swept) {
    all.push_back({key.first, key.second, one.places, one.runs, one.good, one.lies});
  }
  return all;
}

SweptByKind swept_in(const json& told) {
  SweptByKind swept;
  for (const json& one : told) {
    swept[{one[0], one[1]}] = {.places = one[2], .runs = one[3], .good = one[4], .lies = one[5]};
  }
  return swept;
}

std::size_t lies_in(const SweptByKind& swept) {
  std::size_t lies = 0;
  for (const auto& [key, one] : swept) {
    lies += one.lies;
  }
  return lies;
}

std::string summary(const SweptByKind& swept) {
  std::size_t runs = 0;
  std::string text = "| Command | What goes wrong | Places | Runs | Ended 0 | False words |\n"
                     "|---|---|---:|---:|---:|---:|\n";
  for (const auto& [key, one] : swept) {
    runs += one.runs;
    text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", key.first, key.second, one.places,
                        one.runs, one.good, one.lies);
  }
  return text + fmt::format("\n{} runs, {} false words\n", runs, lies_in(swept));
}

namespace {

std::string ends_by_count(const Counts& counts) {
  std::vector<std::pair<std::uint64_t, std::string>> sorted;
  for (const auto& [end, count] : counts.ends) {
    sorted.emplace_back(count, end);
  }
  std::ranges::sort(sorted, std::greater());
  std::string text = "\n| Exit status and errors | Runs |\n|---|---:|\n";
  for (const auto& [count, end] : sorted) {
    text += fmt::format("| {} | {} |\n", end, count);
  }
  return text;
}

std::string faults_by_kind(const Counts& counts) {
  std::string text = "\n| Kind of fault | Episodes | Good commands, it alone | Not 0 | Why |\n"
                     "|---|---:|---:|---|---|\n";
  const auto row = [&](const std::string& name, std::uint64_t episodes, const std::string& kind) {
    const auto found = counts.alone.find(kind);
    const Ends ends = found != counts.alone.end() ? found->second : Ends{};
    std::uint64_t commands = ends.good;
    std::string how;
    for (const auto& [end, count] : ends.needless) {
      commands += count;
      how += fmt::format("{}{}: {}", how.empty() ? "" : ", ", end, count);
    }
    const std::string_view why = how.empty()               ? std::string_view()
                                 : why_not_0(kind).empty() ? "**not explained**"
                                                           : why_not_0(kind);
    text += fmt::format("| {} | {} | {} | {} | {} |\n", name, episodes, commands, how, why);
  };
  row("(none)", 0, "");
  for (const auto& [kind, episodes] : counts.faults) {
    row(kind, episodes, kind);
  }
  return text;
}

} // namespace

std::string summary(const Counts& counts, std::uint64_t first) {
  constexpr double rule_of_three = 3;
  const auto runs = static_cast<double>(std::max<std::uint64_t>(counts.runs, 1));
  std::string text = fmt::format(
      "{} runs in {} episodes from seed {}; {:.0f} hours of simulated servos\n"
      "False words: {}. Crashes: {}. Not converged: {} of {} repetitions after the faults.\n"
      "Servos made to lie: {}, not noticed: {}.\n",
      counts.runs, counts.episodes, first, static_cast<double>(counts.servo_seconds) / 3600,
      counts.lies - counts.stuck, counts.crashes, counts.stuck, counts.repeated, counts.alarms,
      counts.deaf);
  if (counts.lies == 0) {
    text += fmt::format("None in {} runs: below {:.1f} in a million at 95 %.\n", counts.runs,
                        rule_of_three * 1e6 / runs);
  }
  return text + faults_by_kind(counts) + ends_by_count(counts);
}

} // namespace blactl::campaign
