#include "line_ledger.hpp"

#include "told.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace blactl::campaign {

using nlohmann::json;

namespace {

std::string name_of(const json& record) {
  return fmt::format("record {} of {}", record["station_seq"].dump(),
                     record["serial_number"].dump());
}

} // namespace

bool is_verdict(const json& record, std::string_view verdict) {
  return record["verdict"] == verdict;
}

bool is_interrupted(const json& record) {
  return record["code"] == "interrupted";
}

std::string unit_in(const json& record) {
  return record["unique_id"].is_null() ? "" : record["unique_id"].get<std::string>();
}

void hold(const json& record, bool truth, std::string_view what) {
  require(truth, fmt::format("{}: {}", name_of(record), what));
}

void LineLedger::check() const {
  check_records();
  check_ids();
  check_scrapped();
}

// The ledger.

/// Those of this unit before that one.
std::vector<const json*> LineLedger::before(const json& record) const {
  std::vector<const json*> all;
  for (const json& each : story_.ledger) {
    if (unit_in(each) == unit_in(record) && each["station_seq"] < record["station_seq"]) {
      all.push_back(&each);
    }
  }
  return all;
}

std::size_t LineLedger::failed_before(const json& record) const {
  std::size_t failed = 0;
  for (const json* each : before(record)) {
    const bool is_new = is_verdict(*each, "pass") || is_verdict(*each, "scrap");
    const bool counts = is_verdict(*each, "fail") && (*each)["code"] != "attempts";
    failed = is_new ? 0 : failed + (counts ? 1 : 0);
  }
  return failed;
}

bool LineLedger::is_finished_before(const json& record) const {
  bool is_finished = false;
  for (const json* each : before(record)) {
    const bool says_nothing = is_verdict(*each, "skip") || (*each)["code"] == "attempts";
    const bool is_its_own = (*each)["serial_number"] == record["serial_number"]; // not a doublet's
    is_finished = says_nothing ? is_finished : is_verdict(*each, "pass") && is_its_own;
  }
  return is_finished;
}

void LineLedger::check_records() const {
  std::int64_t number = 0;
  for (const json& record : story_.ledger) {
    require(record["station_seq"] == number + 1,
            fmt::format("number {} follows {}", record["station_seq"].dump(), number));
    ++number;
    if (is_verdict(record, "skip")) {
      hold(record, is_finished_before(record), "skipped, and not finished");
    }
    if (is_verdict(record, "pass")) {
      const auto all = before(record);
      const auto tried = std::ranges::count_if(all, [](const json* each) {
        return !is_verdict(*each, "skip") && !is_verdict(*each, "scrap");
      });
      hold(record, record["attempt"] == tried + 1, "another attempt");
      check_told_once(record);
    }
  }
}

/// But by a run that was cut, each is told.
void LineLedger::check_told_once(const json& record) const {
  const auto times = [&](const Shift& shift) {
    return std::ranges::count_if(shift.told, [&](const ToldRecord& told) {
      return told.record["record_id"] == record["record_id"];
    });
  };
  std::ptrdiff_t told = 0;
  bool may_be_untold = false;
  for (const Shift& shift : story_.shifts) {
    told += times(shift);
    may_be_untold = may_be_untold || (shift.is_cut() && shift.includes(record));
  }
  hold(record, told == 1 || (told == 0 && may_be_untold), fmt::format("told {} times", told));
}

// IDs.

void LineLedger::check_ids() const {
  for (const std::string& parameter : {std::string("servo_id"), std::string("static_node_id")}) {
    if (line_.recipe["set"].contains(parameter)) {
      check_given_once(parameter);
      check_none_left_out(parameter);
    }
  }
}

/// By what the servos held as they passed.
void LineLedger::check_given_once(const std::string& parameter) const {
  const json& counter = line_.recipe["set"][parameter];
  std::map<std::string, std::int64_t> held; // by unit
  std::map<std::int64_t, std::size_t> holders;
  for (const json& record : story_.ledger) {
    const std::string unit = unit_in(record);
    if (is_verdict(record, "scrap") && held.contains(unit)) {
      --holders[held.extract(unit).mapped()];
    }
    if (!is_verdict(record, "pass")) {
      continue;
    }
    const std::int64_t id = record[parameter];
    hold(record, !held.contains(unit) || held[unit] == id,
         fmt::format("it had another {}", parameter));
    holders[id] += held.emplace(unit, id).second ? 1U : 0U;
    hold(record, holders[id] <= laps(counter),
         fmt::format("{} {} was given more than once", parameter, id));
  }
}

/// How many units may have one ID.
std::size_t LineLedger::laps(const json& counter) const {
  if (!counter.contains("at_end") || counter["at_end"] == "stop") {
    return 1;
  }
  const auto size = static_cast<std::size_t>(
      (counter["last"].get<std::int64_t>() - counter["first"].get<std::int64_t>()) /
          counter.value("step", 1) +
      1);
  const std::size_t anew = story_.scrapped.is_null() ? 0 : 1; // it counts as another unit
  return (line_.episode.scenario["servos"].size() + anew + size - 1) / size;
}

/// One that nobody has was given to a unit that has a record.
void LineLedger::check_none_left_out(const std::string& parameter) const {
  const json& counter = line_.recipe["set"][parameter];
  std::map<std::int64_t, std::int64_t> last; // by lap: the greatest that was counted
  std::set<std::pair<std::int64_t, std::int64_t>> known;
  for (const GivenId& each : story_.given) {
    if (each.parameter != parameter) {
      continue;
    }
    known.emplace(each.lap, each.value);
    if (each.is_counted) {
      last[each.lap] = std::max(last[each.lap], each.value);
    }
    const bool has_record =
        each.unique_id.empty() || std::ranges::any_of(story_.ledger, [&](const json& record) {
          return unit_in(record) == each.unique_id;
        });
    require(has_record, fmt::format("{} {} is of a unit without a record", parameter, each.value));
  }
  for (const auto& [lap, greatest] : last) {
    for (std::int64_t id = counter["first"]; id < greatest; id += counter.value("step", 1)) {
      require(known.contains({lap, id}), fmt::format("{} {} was left out", parameter, id));
    }
  }
}

/// The next unit that gets an ID gets that of the one that was taken out; one that came before has
/// its own.
void LineLedger::check_scrapped() const {
  const json& scrapped = story_.scrapped;
  const auto& last = story_.shifts.back().told;
  if (scrapped.is_null()) {
    return;
  }
  const auto spare = std::ranges::find_if(last, [&](const ToldRecord& told) {
    return told.record["serial_number"] == line_.spare && is_verdict(told.record, "pass");
  });
  const bool is_plain = std::ranges::none_of(
      line_.recipe["set"], [](const json& value) { return value.contains("at_end"); });
  const auto came_before = [&](const Shift& shift) {
    return std::ranges::any_of(shift.told, [&](const ToldRecord& told) {
      return told.record["serial_number"] == line_.spare;
    });
  };
  const bool has_own =
      std::ranges::any_of(story_.shifts.begin(), std::prev(story_.shifts.end()), came_before);
  if (spare == last.end() || !is_plain || has_own) {
    return;
  }
  for (const char* parameter : {"servo_id", "static_node_id"}) {
    hold(spare->record,
         !line_.recipe["set"].contains(parameter) ||
             spare->record[parameter] == scrapped[parameter],
         fmt::format("it did not get the {} that was free", parameter));
  }
}

} // namespace blactl::campaign
