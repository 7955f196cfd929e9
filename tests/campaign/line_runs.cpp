#include "line_runs.hpp"

#include "campaign.hpp"
#include "line_judge.hpp"
#include "line_watch.hpp"
#include "told.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <initializer_list>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>

namespace blactl::campaign {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;
using Kind = Disturbance::Kind;

std::vector<json> records_of(const std::string& out) {
  std::vector<json> all;
  std::istringstream lines(out);
  for (std::string line; std::getline(lines, line);) {
    json record = json::parse(line, nullptr, false);
    if (!record.is_discarded() && record.contains("record_id")) {
      all.push_back(std::move(record));
    }
  }
  return all;
}

/// One line as it happens.
class Playing {
 public:
  Playing(const Line& line, const std::filesystem::path& folder)
      : line_(line), folder_(folder), world_(line.episode.scenario, folder),
        story_{
            .line = line, .shifts = {}, .powered = {}, .ledger = {}, .given = {}, .scrapped = {}} {
    add_spans(line.episode.scenario["events"], Time{});
  }

  [[nodiscard]] LineStory play(const std::vector<Disturbance>& disturbances) {
    constexpr std::size_t most = 8;
    for (std::size_t i = 0; i < most && (i == 0 || world_.now() < line_.end()); ++i) {
      const bool is_disturbed = i < disturbances.size();
      work(line_.visits, is_disturbed ? disturbances[i] : Disturbance{},
           line_.has_count ? line_.visits.size() : 0);
      world_.pass(story_.shifts.back().is_cut() ? 3s : 1s);
    }
    if (line_.end() > world_.now()) {
      world_.pass(line_.end() - world_.now());
    }
    scrap();
    come_once_more();
    story_.ledger = records_of(run({"ledger"}).out);
    require(run({"ledger", "--check"}).status == 0, "ledger --check is not content");
    check_table();
    story_.given = read_counters(folder_ / "blactl/simulated/counters.db");
    return std::move(story_);
  }

 private:
  [[nodiscard]] Outcome run(std::vector<std::string> words) {
    const Command command{.words = std::move(words)};
    return world_.run(command);
  }

  void work(const std::vector<Visit>& visits, const Disturbance& disturbance, std::size_t count,
            bool is_calm = false) {
    Shift shift{.disturbance = disturbance,
                .visits = visits,
                .is_calm = is_calm,
                .is_redo = is_calm && line_.is_done_anew,
                .count = count,
                .begin = world_.now(),
                .end = {},
                .outcome = {},
                .told = {}};
    Command command{.words = {"provision", "recipe.json", "-y", "--idle-timeout", "40"},
                    .fleet = line_.recipe};
    const auto add = [&](std::initializer_list<std::string> words) {
      command.words.insert(command.words.end(), words);
    };
    if (count > 0) {
      add({"--count", std::to_string(count)});
    }
    if (shift.is_redo) {
      add({"--redo", "--reason", "again"});
    }
    if (line_.has_labels) {
      add({"--label", "-"});
    }
    LineWatch watch(world_, visits, line_.has_labels);
    const bool is_disturbed = disturbance.kind != Kind::none;
    shift.outcome = world_.run(
        command, is_disturbed ? std::span(&shift.disturbance, 1) : std::span<Disturbance>(),
        [&](auto bus) { return watch.around(std::move(bus)); });
    shift.told = watch.told(shift.outcome.out);
    shift.end = world_.now();
    story_.shifts.push_back(std::move(shift));
  }

  /// When servos have power, from there on.
  void add_spans(const json& events, Time base) {
    for (const json& servo : line_.episode.scenario["servos"]) {
      const std::int64_t serial = servo["serial_number"];
      auto& spans = story_.powered[serial];
      for (Span& span : spans) { // the scenario before has ended
        span.to = std::min(span.to, base);
      }
      std::erase_if(spans, [&](const Span& span) { return span.from >= base && base > Time{}; });
      const auto more = powered(events, serial, base);
      spans.insert(spans.end(), more.begin(), more.end());
    }
  }

  /// Of those that have passed, and are still on the line.
  void scrap() {
    const auto records = records_of(run({"ledger"}).out);
    for (const json& record : records) {
      const auto last =
          std::ranges::find_if(records.rbegin(), records.rend(), [&](const json& each) {
            return each["unique_id"] == record["unique_id"] && each["verdict"] != "skip";
          });
      if (line_.has_scrap && *last == record && record["verdict"] == "pass") {
        const Outcome done = run({"ledger", "--scrap", record["record_id"].get<std::string>(),
                                  "--reason", "worn", "-y"});
        require(done.status == 0, "cannot be scrapped: " + done.err);
        story_.scrapped = record;
        return;
      }
    }
  }

  /// Everything that went wrong has ended: one unit after the other, the spare first.
  void come_once_more() {
    const json& servos = line_.episode.scenario["servos"];
    const Time base = world_.now() + 5s; // World::repair()
    Time now = base + 4s;
    std::vector<Visit> visits;
    const auto visit = [&](std::int64_t serial) {
      visits.push_back(
          {.serials = {serial}, .span = {now, now + 20s}, .label = std::to_string(serial)});
      now += 26s;
    };
    if (line_.spare != 0) {
      visit(line_.spare);
    }
    for (const json& servo : servos) {
      if (servo["serial_number"] != line_.spare) {
        visit(servo["serial_number"]);
      }
    }
    const json events = comings(visits, servos, base);
    world_.repair(events);
    add_spans(events, base);
    work(visits, {}, visits.size(), /*is_calm=*/true);
  }

  /// IDs on the bench are borrowed.
  void check_table() {
    const Outcome list = run({"alloc", "--list"});
    require(list.status == 0 && list.document.value("entries", json::array()).empty(),
            "a servo of the line is in the allocation table: " + list.out);
  }

  const Line& line_;
  const std::filesystem::path& folder_;
  World world_;
  LineStory story_;
};

std::string text_of(const LineStory& story) {
  std::string text;
  for (const Shift& shift : story.shifts) {
    text += shift.outcome.err.empty() ? "" : shift.outcome.err + "\n";
    text += fmt::format("  run from {} s, {} {}{}: {}\n", (shift.begin - Time{}) / 1s,
                        name(shift.disturbance.kind), shift.disturbance.number,
                        shift.disturbance.lasts ? " on" : "", shift.outcome.status);
    for (const ToldRecord& told : shift.told) {
      const json& r = told.record;
      text += fmt::format("    {:7.2f} s {} {} {} {} {} {}\n",
                          std::chrono::duration<double>(told.at - Time{}).count(),
                          r["station_seq"].dump(), r["serial_number"].dump(), r["verdict"].dump(),
                          r["code"].dump(), r["servo_id"].dump(), r["static_node_id"].dump());
    }
  }
  return text;
}

std::string plan_of(const Line& line) {
  std::string text = "  " + line.recipe["set"].dump() + "\n ";
  for (const std::string& fault : line.episode.faults) {
    text += " " + fault;
  }
  text += "\n";
  for (const Visit& visit : line.visits) {
    text += fmt::format("  {:7.2f} s to {:7.2f} s:",
                        std::chrono::duration<double>(visit.span.from - Time{}).count(),
                        std::chrono::duration<double>(visit.span.to - Time{}).count());
    for (const std::int64_t serial : visit.serials) {
      text += " " + line.servo(serial).dump();
    }
    text += (line.has_labels ? " label " + visit.label : "") + "\n";
  }
  return text;
}

/// A patient station gets everything right in spite of one such frame.
bool is_borne(Kind kind) {
  return kind == Kind::request_lost || kind == Kind::frame_lost || kind == Kind::frame_doubled ||
         kind == Kind::frame_corrupted;
}

bool have_all_passed(const Shift& shift) {
  return shift.told.size() == shift.visits.size() &&
         std::ranges::all_of(
             shift.told, [](const ToldRecord& told) { return told.record["verdict"] == "pass"; });
}

} // namespace

/// Frames, calls or writes of its first run where nothing goes wrong.
std::size_t LineRuns::places_of(const Line& line, Kind kind) const {
  const Folder folder(folder_);
  Playing playing(line, folder_);
  const LineStory story = playing.play({{.kind = kind, .number = Disturbance::no_number}});
  return story.shifts.front().disturbance.seen;
}

void LineRuns::judged(const std::string& name, const Line& line,
                      const std::vector<Disturbance>& disturbances,
                      const std::function<void(const LineStory&)>& check) {
  const Folder folder(folder_);
  counts_.runs += 1;
  std::string happened;
  try {
    Playing playing(line, folder_);
    const LineStory story = playing.play(disturbances);
    happened = text_of(story);
    for (const json& record : story.ledger) {
      counts_.records[fmt::format(
          "{} {}", record["verdict"].get<std::string>(),
          record["code"].is_null() ? "" : record["code"].get<std::string>())] += 1;
    }
    judge_line(story);
    check(story);
  } catch (const std::exception& fault) {
    counts_.lies += 1;
    tell_(fmt::format("{}: {}\n{}{}", name, fault.what(), plan_of(line), happened));
    return;
  }
  if (is_verbose_) {
    tell_(fmt::format("{}\n{}{}", name, plan_of(line), happened));
  }
}

void LineRuns::play(std::uint64_t seed) {
  const Line line = make_line(seed);
  judged(fmt::format("line {}", seed), line, line.disturbances, [](const LineStory&) {});
}

void LineRuns::play_each(std::uint64_t seed, const Sweep& sweep) {
  constexpr Kind kinds[]{Kind::killed,          Kind::computer_off, Kind::call_failed,
                         Kind::request_lost,    Kind::frame_lost,   Kind::frame_doubled,
                         Kind::frame_corrupted, Kind::frame_late,   Kind::frame_of_other};
  constexpr std::size_t least_runs = 4;
  const Line line = make_calm_line(seed);
  std::size_t turn = 0;
  for (const Kind kind : kinds) {
    const std::size_t places = places_of(line, kind);
    const std::size_t step = std::min(sweep.step, std::max<std::size_t>(places / least_runs, 1));
    Chance chance(places, name(kind));
    const auto first = static_cast<std::size_t>(chance.whole(1, static_cast<std::int64_t>(step)));
    for (std::size_t number = first; number <= places; number += step) {
      if (turn++ % sweep.jobs != sweep.job || (sweep.until_found && counts_.lies > 0)) {
        continue;
      }
      sweep.begins();
      judged(fmt::format("line {} with {} {}", seed, name(kind), number), line,
             {{.kind = kind, .number = number}}, [&](const LineStory& story) {
               require(!is_borne(kind) || have_all_passed(story.shifts.front()),
                       "one frame was in its way");
             });
    }
  }
}

} // namespace blactl::campaign
