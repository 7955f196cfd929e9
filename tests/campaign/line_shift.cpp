#include "line_shift.hpp"

#include "line_ledger.hpp"
#include "told.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace blactl::campaign {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

constexpr std::uint8_t warning_bits = 0x1A, failure_bits = 0x1B, servo_id_at = 0x45,
                       version_at = 0x52;

class OneShift {
 public:
  OneShift(const LineStory& story, const Shift& shift)
      : story_(story), line_(story.line), shift_(shift), ledger_(story) {}

  void judge() const {
    check_end();
    check_begun();
    check_visits();
  }

 private:
  void check_end() const {
    if (shift_.is_cut()) {
      return;
    }
    const json& document = shift_.outcome.document;
    require(document.is_object() && document.contains("exit_status"), "no last object");
    require(document["exit_status"] == shift_.outcome.status, "another exit status in its object");
    std::map<std::string, std::uint64_t> counts;
    bool are_all_good = true;
    for (const ToldRecord& told : shift_.told) {
      if (!is_interrupted(told.record)) {
        ++counts[told.record["verdict"].get<std::string>()];
        are_all_good = are_all_good && told.record["code"].is_null();
      }
    }
    require(are_all_good || shift_.outcome.status != 0, "0, and not all have passed");
    require(shift_.outcome.status != 0 || document["errors"].empty(), "0, and errors");
    check_count(counts);
    for (const auto& [verdict, count] : counts) {
      require(document["counts"].value(verdict, std::uint64_t{0}) == count,
              fmt::format("{} counted of {}", document["counts"].dump(), verdict));
    }
  }

  /// It ends with the last servo: no sooner, if nothing but servos was in its way.
  void check_count(const std::map<std::string, std::uint64_t>& counts) const {
    std::set<std::string> codes; // of records
    std::uint64_t counted = 0;
    for (const ToldRecord& told : shift_.told) {
      const json& code = told.record["code"];
      codes.insert(code.is_null() ? "" : code.get<std::string>());
    }
    for (const auto& [verdict, count] : counts) {
      counted += verdict == "error" ? 0 : count;
    }
    const json errors = shift_.outcome.document["errors"];
    const bool is_by_servos = std::ranges::all_of(errors, [&](const json& error) {
      return codes.contains(error["code"].get<std::string>());
    });
    require(shift_.count == 0 || !is_by_servos || codes.contains("counter_end") ||
                codes.contains("bus_off") || codes.contains("no_acknowledge") ||
                codes.contains("state") || codes.contains("io") || counted == shift_.count,
            fmt::format("it ended after {} of {}", counted, shift_.count));
    require(!shift_.is_calm || codes.contains("counter_end") ||
                shift_.end > shift_.visits.back().span.from,
            "it did not wait for the last one");
  }

  // What a killed run had begun is told.

  void check_begun() const {
    const auto changes = shift_.outcome.record.changes();
    if (!shift_.is_cut() || changes.empty()) {
      return;
    }
    const Time last = changes.back().at;
    if (!shift_.told.empty() && shift_.told.back().at >= last) {
      return;
    }
    std::set<std::string> there;
    for (const auto& [serial, spans] : story_.powered) {
      if (story_.has_power(serial, last - 1s, last)) {
        there.insert(line_.servo(serial)["unique_id"].get<std::string>());
      }
    }
    const bool is_told = std::ranges::any_of(story_.ledger, [&](const json& record) {
      const bool is_its_own = !record["duration_s"].is_null() && shift_.includes(record);
      return there.contains(unit_in(record)) && (is_interrupted(record) || is_its_own);
    });
    require(is_told, "what was begun, and not ended, is not in the ledger");
  }

  // Where nothing goes wrong each visit brings just the record that it must.

  [[nodiscard]] bool is_undisturbed() const {
    return shift_.is_calm ||
           (shift_.disturbance.kind == Disturbance::Kind::none && line_.episode.faults.empty());
  }

  void check_visits() const {
    constexpr Duration enough = 14s, pause = 4s;
    if (!is_undisturbed()) {
      return;
    }
    for (std::size_t i = 0; i < shift_.visits.size(); ++i) {
      const Visit& visit = shift_.visits[i];
      const bool is_first = i == 0 || visit.span.from - shift_.visits[i - 1].span.to >= pause;
      const bool is_seen = shift_.begin + 2s <= visit.span.from &&
                           shift_.end > visit.span.from + enough &&
                           std::ranges::none_of(shift_.told, [&](const ToldRecord& told) {
                             return begin_of(told) < visit.span.from &&
                                    told.at > visit.span.from - pause; // still at the one before
                           });
      if (is_first && is_seen && visit.serials.size() == 1 &&
          visit.span.to - visit.span.from >= enough && !line_.is_doublet(visit.serials.front())) {
        check_visit(visit);
      }
    }
  }

  void check_visit(const Visit& visit) const {
    const std::int64_t serial = visit.serials.front();
    std::vector<const ToldRecord*> own;
    for (const ToldRecord& told : shift_.told) {
      if (!is_interrupted(told.record) && told.at >= visit.span.from &&
          told.at <= visit.span.to + 1s) {
        own.push_back(&told);
      }
    }
    require(own.size() == 1, fmt::format("{} records of a visit of {}", own.size(), serial));
    const json& record = own.front()->record;
    hold(record, record["serial_number"] == serial, fmt::format("{} came", serial));
    const std::string due = due_code(*own.front(), serial);
    const std::string code = record["code"].is_null() ? "" : record["code"].get<std::string>();
    hold(record, due.empty() || code == due || (code.empty() && due == "pass"),
         fmt::format("{} instead of {}", code, due));
  }

  /// Empty: it depends.
  [[nodiscard]] std::string due_code(const ToldRecord& told, std::int64_t serial) const {
    const json& record = told.record;
    const ServoState& state = told.states.at(serial);
    const auto label = label_in(record);
    if (line_.servo(serial)["model"] != line_.recipe["model"]) {
      return "model_mismatch";
    }
    if (state.ram.at(version_at) < line_.recipe.value("firmware_min", 0)) {
      return "firmware_too_old";
    }
    if (label && (*label)["serial_number"] != serial) {
      return "label_mismatch";
    }
    const bool names_other_id =
        label && label->contains("servo_id") && (*label)["servo_id"] != state.rom.at(servo_id_at);
    if (ledger_.is_finished_before(record) && !shift_.is_redo && names_other_id) {
      return "label_mismatch";
    }
    if (ledger_.is_finished_before(record) && !shift_.is_redo) {
      hold(record, is_verdict(record, "skip"), "a finished one was done anew");
      return "pass";
    }
    hold(record, !is_verdict(record, "skip"), "it was skipped, and is not finished");
    if (ledger_.failed_before(record) >= 3) {
      return "attempts";
    }
    if ((label && label->contains("servo_id")) || counters_may_end()) {
      return "";
    }
    return state.ram.at(warning_bits) != 0 || state.ram.at(failure_bits) != 0 ? "faults" : "pass";
  }

  [[nodiscard]] bool counters_may_end() const {
    const auto units = static_cast<std::int64_t>(line_.episode.scenario["servos"].size());
    return std::ranges::any_of(line_.recipe["set"], [&](const json& counter) {
      return counter.is_object() && !counter.contains("at_end") &&
             counter["last"].get<std::int64_t>() - counter["first"].get<std::int64_t>() <
                 units * counter.value("step", 1);
    });
  }

  const LineStory& story_;
  const Line& line_;
  const Shift& shift_;
  LineLedger ledger_;
};

} // namespace

void judge_shift(const LineStory& story, const Shift& shift) {
  OneShift(story, shift).judge();
}

} // namespace blactl::campaign
