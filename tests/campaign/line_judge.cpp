#include "line_judge.hpp"

#include "line_ledger.hpp"
#include "line_shift.hpp"
#include "settings.hpp"
#include "told.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace blactl::campaign {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;
using Kind = Disturbance::Kind;

constexpr std::uint8_t warnings_at = 0x1A, failures_at = 0x1B, firmware_at = 0x52;

/// What a servo may do in the last moment without a station that knows.
constexpr Duration last_moment = 500ms;

class OneLine {
 public:
  explicit OneLine(const LineStory& story) : story_(story), line_(story.line), ledger_(story) {}

  void judge() const {
    for (const Shift& shift : story_.shifts) {
      for (std::size_t i = 0; i < shift.told.size(); ++i) {
        check_recorded(shift.told[i].record);
        check_unit(shift, shift.told[i]);
        check_codes(shift, shift.told[i]);
        if (is_verdict(shift.told[i].record, "pass")) {
          check_pass(shift, shift.told[i]);
        }
        if (i > 0) {
          check_taken_off(shift, shift.told[i - 1], shift.told[i]);
        }
      }
      judge_shift(story_, shift);
    }
    ledger_.check();
  }

 private:
  [[nodiscard]] bool has_any_of(const std::set<std::string>& kinds) const {
    return std::ranges::any_of(line_.episode.faults,
                               [&](const std::string& kind) { return kinds.contains(kind); });
  }

  // What was told is in the ledger, as it was told.

  void check_recorded(const json& record) const {
    const auto found = std::ranges::find_if(
        story_.ledger, [&](const json& each) { return each["record_id"] == record["record_id"]; });
    hold(record, found != story_.ledger.end(), "told, and not in the ledger");
    hold(record, *found == record, "another one in the ledger");
  }

  // It is of a unit that was there.

  void check_unit(const Shift& shift, const ToldRecord& told) const {
    const json& record = told.record;
    hold(record, record["model"] != "", "a model without a name");
    if (record["unique_id"].is_null()) {
      hold(record, !is_verdict(record, "pass") && !is_verdict(record, "skip"), "of nobody");
      return;
    }
    const auto found = std::ranges::find_if(told.states, [&](const auto& servo) {
      return servo.second.unique_id == unit_in(record) &&
             (record["serial_number"].is_null() || record["serial_number"] == servo.first);
    });
    hold(record, found != told.states.end(), "no servo has this unique ID and serial number");
    const auto& [serial, state] = *found;
    hold(record, is_interrupted(record) || story_.has_power(serial, begin_of(told) - 4s, told.at),
         "its servo was not on the bench");
    hold(record, record["model"].is_null() || record["model"] == line_.servo(serial)["model"],
         "another model");
    hold(record,
         record["firmware_version"].is_null() ||
             record["firmware_version"] == state.ram.at(firmware_at),
         "another firmware");
    const bool is_whole = is_verdict(record, "pass") || is_verdict(record, "skip");
    hold(record, !is_whole || !record["serial_number"].is_null(), "no serial number");
    if (is_whole && !line_.is_doublet(serial)) {
      check_alone(shift, told, serial);
    }
  }

  /// Of two that are there from the beginning on none is done.
  void check_alone(const Shift& shift, const ToldRecord& told, std::int64_t serial) const {
    static const std::set<std::string> silent{
        "mute",   "no_node_status", "no_actuator_status", "loss",
        "bursts", "never_returns",  "return_delay",       "cut",
        "errors", "bit_flips"};
    if ((has_any_of(silent) && !shift.is_calm) || shift.disturbance.kind != Kind::none) {
      return;
    }
    for (const auto& [other, spans] : story_.powered) {
      const bool was_there = std::ranges::any_of(spans, [&](const Span& span) {
        return span.from + 300ms <= begin_of(told) && span.to >= told.at;
      });
      hold(told.record, other == serial || !was_there,
           fmt::format("{} was on the bench as well", other));
    }
  }

  // Codes that nothing but the servo itself may bring.

  void check_codes(const Shift&, const ToldRecord& told) const {
    const json& record = told.record;
    const std::string code = record["code"].is_null() ? "" : record["code"].get<std::string>();
    hold(record, code.empty() == (is_verdict(record, "pass") || is_verdict(record, "skip")),
         "a code, or none");
    hold(record, code != "internal", "an exception");
    if (record["serial_number"].is_null() || record["unique_id"].is_null()) {
      return;
    }
    const std::int64_t serial = record["serial_number"];
    const ServoState& state = told.states.at(serial);
    const auto label = label_in(record);
    if (code == "model_mismatch") {
      hold(record, line_.servo(serial)["model"] != line_.recipe["model"], "its model is right");
    } else if (code == "firmware_too_old") {
      hold(record, state.ram.at(firmware_at) < line_.recipe.value("firmware_min", 0),
           "its firmware is new enough");
    } else if (code == "label_mismatch") {
      hold(record, label && ((*label)["serial_number"] != serial || label->contains("servo_id")),
           "its label is right");
    } else if (code == "duplicate_unique_id") {
      hold(record, line_.is_doublet(serial), "no other has its unique ID");
    } else if (code == "attempts") {
      hold(record, ledger_.failed_before(record) >= 3, "it has not failed so often");
    } else if (code == "counter_end") {
      hold(record,
           !line_.recipe["set"]["servo_id"].contains("at_end") ||
               line_.recipe["set"].contains("static_node_id"),
           "the counter begins again");
    }
  }

  // A pass is true by the servo's memory.

  void check_pass(const Shift& shift, const ToldRecord& told) const {
    const json& record = told.record;
    const std::int64_t serial = record["serial_number"];
    const ServoState& state = told.states.at(serial);
    hold(record, line_.servo(serial)["model"] == line_.recipe["model"], "PASS of another model");
    hold(record, state.ram.at(firmware_at) >= line_.recipe.value("firmware_min", 0),
         "PASS of an old firmware");
    hold(record, story_.has_power(serial, told.at - last_moment, told.at), "PASS, and it has left");
    const json& set = line_.recipe["set"];
    for (const auto& [setting, value] : set.items()) {
      if (value.is_string()) {
        const Setting& known = settings().at(setting);
        check_register(shift, told, known.address, known.values.at(value.get<std::string>()));
      }
    }
    for (const auto& [parameter, address] :
         {std::pair("servo_id", servo_id), std::pair("static_node_id", static_node_id)}) {
      hold(record, state.rom.at(address) == record[parameter],
           fmt::format("PASS, and ROM has another {}", parameter));
      if (set.contains(parameter)) {
        check_id(record, parameter, set[parameter]);
      }
    }
    const auto label = label_in(record);
    hold(record, label.has_value() == line_.has_labels || shift.is_calm, "PASS without a label");
    if (label) {
      hold(record, (*label)["serial_number"] == serial, "PASS with the label of another");
      hold(record, !label->contains("servo_id") || (*label)["servo_id"] == state.rom.at(servo_id),
           "PASS with another ID than that of the label");
    }
    if (!is_upset(serial, told.at)) {
      hold(record, state.ram.at(warnings_at) == 0 && state.ram.at(failures_at) == 0,
           "PASS with faults");
    }
  }

  static void check_id(const json& record, const std::string& parameter, const json& counter) {
    const std::int64_t first = counter["first"], last = counter["last"];
    const std::int64_t step = counter.value("step", 1);
    const std::int64_t id = record[parameter];
    hold(record, id >= first && id <= last && (id - first) % step == 0,
         fmt::format("{} {} is none of its counter", parameter, id));
  }

  /// Whether RAM may have changed in the last moment.
  [[nodiscard]] bool is_upset(std::int64_t serial, Time at) const {
    const bool is_stable = std::ranges::any_of(story_.powered.at(serial), [&](const Span& span) {
      return span.from <= at - last_moment && span.to >= at;
    });
    const json& events = line_.episode.scenario["events"];
    return !is_stable || std::ranges::any_of(events, [&](const json& event) {
      const Time then = Time{} + time_in(event["at"]);
      return event.value("servo", std::int64_t{0}) == serial && then > at - last_moment &&
             then <= at + 1ms;
    });
  }

  void check_register(const Shift& shift, const ToldRecord& told, std::uint8_t address,
                      std::int64_t value) const {
    static const std::set<std::string> others{"other_erases", "other_saves",       "other_restarts",
                                              "other_writes", "other_initializes", "other_repeats"};
    const std::int64_t serial = told.record["serial_number"];
    const ServoState& state = told.states.at(serial);
    hold(told.record, state.rom.at(address) == value,
         fmt::format("PASS, and ROM has {:#04x}={} instead of {}", address, state.rom.at(address),
                     value));
    const bool may_differ = is_upset(serial, told.at) || (has_any_of(others) && !shift.is_calm);
    hold(told.record, may_differ || state.ram.at(address) == value,
         fmt::format("PASS, and RAM has {:#04x}={} instead of {}", address, state.ram.at(address),
                     value));
  }

  // Another unit may come as soon as nobody of the record before is there any more; one that comes
  // beside it is told, and what the station could not judge is done again at once.
  [[nodiscard]] bool may_follow_at_once(const ToldRecord& last, const ToldRecord& next) const {
    static const std::set<json> repeated{"not_back", "interface", "bus_off", "no_acknowledge"};
    const bool is_kept = std::ranges::any_of(story_.powered, [&](const auto& unit) {
      return story_.has_power(unit.first, last.at - last_moment, last.at) &&
             story_.has_power(unit.first, begin_of(next), next.at);
    });
    return !is_kept || next.record.at("code") == "several_servos" ||
           repeated.contains(last.record.at("code"));
  }

  // Between two records of a unit the bench was empty.

  void check_taken_off(const Shift& shift, const ToldRecord& last, const ToldRecord& next) const {
    static const std::set<std::string> silent{
        "mute",    "no_node_status", "no_actuator_status", "loss",
        "bursts",  "never_returns",  "return_delay",       "cut",
        "bus_off", "errors",         "bit_flips",          "slow_rom",
        "jitter"};
    constexpr Duration off = 2500ms;
    if (is_interrupted(last.record) || shift.disturbance.kind != Kind::none ||
        (has_any_of(silent) && !shift.is_calm) || may_follow_at_once(last, next)) {
      return;
    }
    std::vector<Span> spans;
    for (const auto& [serial, own] : story_.powered) {
      std::ranges::copy_if(own, std::back_inserter(spans), [&](const Span& span) {
        return span.to >= last.at && span.from <= begin_of(next);
      });
    }
    std::ranges::sort(spans, {}, &Span::from);
    Time free_since = last.at;
    bool was_empty = false;
    for (const Span& span : spans) {
      was_empty = was_empty || span.from - free_since >= off;
      free_since = std::max(free_since, span.to);
    }
    was_empty = was_empty || begin_of(next) - free_since >= off;
    hold(next.record, was_empty, "the one before was not taken off");
  }

  const LineStory& story_;
  const Line& line_;
  LineLedger ledger_;
};

} // namespace

void judge_line(const LineStory& story) {
  OneLine(story).judge();
}

} // namespace blactl::campaign
