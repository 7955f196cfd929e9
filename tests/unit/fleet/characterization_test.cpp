// A simulated servo on the bench: what is measured is how it is simulated.

#include "blactl/sim/scenario/facts.hpp"

#include "characterization_rig.hpp"

#include <cmath>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

/// How a servo must be for its settings to show.
struct Case {
  std::string setting, value; ///< of "behaviour"
  std::string servo = "";     ///< further members
  std::string scene = "";     ///< of the scenario
};

/// Of each setting that a bench can measure all values; times apart.
const std::vector<Case>& cases() {
  const std::string in_place = R"(, "rom": {"soft_start": "off", "torque_output": "off"}, "ram":
      {"current_angle": "45deg"})";
  const std::string held_away = R"(, "events": [{"at": "3s", "servo": 240900001,
      "world": {"hand": "120deg"}}])";
  const std::string aside = R"(, "rom": {"soft_start": "off", "torque_output": "brake",
      "reverse": "on", "origin": "45deg"}, "ram": {"current_angle": "-60deg"}, "servo_id": 3)";
  const std::string restarted = R"(, "events": [{"at": "1s", "servo": 240900001,
      "happens": "watchdog_error"}])";
  const std::string old = R"(, "model": "BLA21-12U-A0", "firmware_version": 1010)";
  static const std::vector<Case> all{
      {"out_of_range", "refuse"},
      {"out_of_range", "clamp"},
      {"out_of_range", "fail"},
      {"reserved_reads", "fail"},
      {"reserved_reads", "zero"},
      {"gated_reads", "fail", old},
      {"gated_reads", "zero", old},
      {"write_only_reads", "fail"},
      {"write_only_reads", "zero"},
      {"index_only_access", "true"},
      {"index_only_access", "false"},
      {"failure_with_name", "true"},
      {"failure_with_name", "false"},
      {"ignores_disabled_commands", "true"},
      {"ignores_disabled_commands", "false"},
      {"answers_save_first", "true"},
      {"answers_save_first", "false"},
      {"array_command_shows", "true"},
      {"array_command_shows", "false"},
      {"start_angle", "present", in_place},
      {"start_angle", "zero", in_place},
      {"unused_fields", "unknown"},
      {"unused_fields", "zero"},
      {"notices_warn", "true"},
      {"notices_warn", "false"},
      {"assignment_shows", "true", R"(, "node_id": 0)"},
      {"assignment_shows", "false", R"(, "node_id": 0)"},
      {"keeps_disabled_command", "true"},
      {"keeps_disabled_command", "false"},
      {"keeps_limited_angle", "true"},
      {"keeps_limited_angle", "false"},
      {"speed_control_before_1100", "false", old},
      {"inclusive_stops", "true"},
      {"inclusive_stops", "false"},
      {"command_at_limit_notifies", "true"},
      {"command_at_limit_notifies", "false"},
      {"array_out_of_range", "ignore"},
      {"array_out_of_range", "clamp"},
      {"obeys_servo_id_0", "true"},
      {"obeys_servo_id_0", "false"},
      {"obeys_servo_id_0", "true", R"(, "servo_id": 7)"},
      {"obeys_servo_id_0", "false", R"(, "servo_id": 7)"},
      {"settings_wait_for_start", "true"},
      {"settings_wait_for_start", "false"},
      {"settings_wait_for_start", "true", aside},
      {"settings_wait_for_start", "false", aside},
      {"reverse_turns_origin", "false"},
      {"reverse_turns_origin", "true", aside},
      {"reverse_turns_origin", "false", aside},
      {"restart_keeps_failures", "true", "", restarted},
      {"restart_keeps_failures", "false", "", restarted},
      {"inclusive_limits", "true"},
      {"inclusive_limits", "false"},
      {"soft_start_shows", "true", "", held_away},
      {"soft_start_shows", "false", "", held_away},
  };
  return all;
}

/// The first value of each setting is its default, but for these switches.
std::string default_of(const std::string& key, const nlohmann::json& property) {
  static const std::set<std::string> on{"index_only_access",
                                        "ignores_disabled_commands",
                                        "answers_save_first",
                                        "array_command_shows",
                                        "array_command_feeds_timeout",
                                        "keeps_disabled_command",
                                        "keeps_limited_angle",
                                        "erase_holds",
                                        "inclusive_limits",
                                        "pwm_end_points_move",
                                        "pwm_yields_to_all",
                                        "output_write_ends_soft_start",
                                        "obeys_servo_id_0"};
  const auto values = values_of(property);
  return values.front() != "true" ? values.front() : on.contains(key) ? "true" : "false";
}

/// Every setting at its default, or at its other value.
std::map<std::string, std::string> all_settings(bool other) {
  std::map<std::string, std::string> all;
  const auto schema = behaviour_schema();
  for (const auto& [key, property] : schema.items()) {
    const std::string usual = default_of(key, property);
    for (const std::string& value : values_of(property)) {
      if (!value.ends_with("ms") && (value == usual) != other) {
        all[key] = value;
      }
    }
  }
  return all;
}

std::string as_members(const std::map<std::string, std::string>& behaviour) {
  std::string out;
  for (const auto& [key, value] : behaviour) {
    out += fmt::format(R"({}"{}": {})", out.empty() ? "" : ", ", key, literal(value));
  }
  return fmt::format(R"("behaviour": {{{}}})", out);
}

} // namespace

TEST_CASE(
    "every setting that only a real servo could settle is an open question, and has reasons") {
  std::set<std::string> known, asked;
  const auto schema = behaviour_schema();
  for (const auto& [key, property] : schema.items()) {
    known.insert(key);
  }
  for (const OpenQuestion& question : open_questions()) {
    INFO(question.setting);
    CHECK(asked.insert(std::string(question.setting)).second);
    for (const Text& said : {question.what, question.reason}) {
      CHECK(std::string_view(said.en).size() > 5);
      CHECK(std::string_view(said.ja) != said.en);
    }
  }
  CHECK(asked == known);
}

TEST_CASE("each setting is found as it is simulated") {
  for (const Case& wanted : cases()) {
    INFO(wanted.setting << " " << wanted.value);
    const bool is_dynamic = wanted.servo.find("node_id") != std::string::npos;
    const std::uint8_t id = is_dynamic ? dynamic_id : 11;
    const Rig rig(fmt::format(R"("behaviour": {{"{}": {}}}{})", wanted.setting,
                              literal(wanted.value), wanted.servo),
                  wanted.scene);
    const Memory before = rig.memory();
    const auto measured = rig.measure(id);
    check_done(measured);
    CHECK(words(fact(measured, wanted.setting).value) == wanted.value);
    CHECK(text(rig.memory()) == text(before));
  }
}

TEST_CASE("nothing is found that is not so") {
  const auto schema = behaviour_schema();
  for (const auto& [key, property] : schema.items()) {
    for (const std::string& value : values_of(property)) {
      INFO(key << " " << value);
      const Rig rig(fmt::format(R"("behaviour": {{"{}": {}}})", key, literal(value)));
      const Memory before = rig.memory();
      const auto measured = rig.measure();
      check_done(measured);
      const Fact& found = fact(measured, key);
      if (found.value && value.ends_with("ms")) {
        // A ROM write is as exact as starts are alike.
        const double tolerance = key == "rom_write_time" ? 100 : 3;
        CHECK(std::abs(milliseconds(words(found.value)) - milliseconds(value)) <= tolerance);
      } else if (found.value) {
        CHECK(words(found.value) == value);
      } else {
        CHECK(found.reason.size() > 5);
      }
      CHECK(text(rig.memory()) == text(before));
    }
  }
}

TEST_CASE(
    "a servo that is in everything as expected, or in nothing, is told right and left alone") {
  const bool other = GENERATE(false, true);
  const std::string place =
      GENERATE(std::string(), std::string(R"(, "servo_id": 5, "rom": {"soft_start": "off",
          "angle_limit_cw": "90deg", "torque_output": "off"}, "ram": {"current_angle": "30deg",
          "angle_limit_ccw": "-60deg", "speed_torque_control": "on"})"));
  const auto behaviour = all_settings(other);
  const Rig rig(as_members(behaviour) + place);
  const Memory before = rig.memory();
  const auto measured = rig.measure();
  check_done(measured);
  check_same(rig, before);
  std::set<std::string> left;
  for (const Fact& fact : measured.facts) {
    const auto simulated = behaviour.find(std::string(fact.setting));
    INFO(fact.setting << " " << words(fact.value) << " " << fact.reason);
    if (!fact.value) {
      CHECK(fact.reason.size() > 5);
      left.insert(std::string(fact.setting));
    } else if (simulated != behaviour.end()) {
      CHECK(words(fact.value) == simulated->second);
    }
  }
  for (const auto* setting : {"out_of_range", "notices_warn", "inclusive_limits", "inclusive_stops",
                              "settings_wait_for_start"}) {
    INFO(setting);
    CHECK_FALSE(left.contains(setting));
  }
  // Where 0x44 waits for the next start, it does not show whether it turns round.
  CHECK(left.contains("reverse_turns_origin") == other);
  // Nor which servo ID is obeyed where 0x45 waits.
  CHECK(left.contains("obeys_servo_id_0") == other);
}

TEST_CASE("whatever a servo is like and holds, nothing wrong is found and nothing stays changed") {
  const int servos = this_many(60, 2000);
  RandomServos chance(20261123);
  std::map<std::string_view, int> found;
  for (int i = 0; i < servos; ++i) {
    const RandomServo servo = chance.next();
    INFO(servo.members << servo.scene);
    const Rig rig(servo.members, servo.scene);
    const Memory before = rig.memory();
    const auto measured = rig.measure();
    check_done(measured);
    check_same(rig, before);
    for (const Fact& fact : measured.facts) {
      const std::string& value = servo.behaviour.at(std::string(fact.setting));
      INFO(fact.setting << " " << words(fact.value));
      if (fact.value && value.ends_with("ms")) {
        const double tolerance = fact.setting == "answer_delay" ? 0.1 : 3;
        CHECK(std::abs(milliseconds(words(fact.value)) - milliseconds(value)) <= tolerance);
      } else if (fact.value) {
        CHECK(words(fact.value) == value);
      }
      found[fact.setting] += fact.value ? 1 : 0;
    }
  }
  for (const auto* often : {"out_of_range", "keeps_disabled_command", "array_command_shows",
                            "notices_warn", "inclusive_limits", "rom_write_time"}) {
    INFO(often << " " << found[often]);
    CHECK(found[often] > servos / 3);
  }
}

TEST_CASE("a servo whose output is off at its start is not moved at all") {
  for (const auto* setting : {"inclusive_stops", "boost_in_dead_band", "reverse_turns_origin"}) {
    INFO(setting);
    const Rig rig(fmt::format(R"("behaviour": {{"{}": true}}, "rom": {{"soft_start": "off",
        "torque_output": "off", "speed_torque_control": "on", "angle_boost": "10%",
        "timeout_time": "1ms"}}, "ram": {{"current_angle": "60deg"}})",
                              setting));
    const std::int64_t there = rig.bus->servo().shaft().angle;
    rig.bus->watched = true;
    const auto measured = rig.measure();
    check_done(measured);
    CHECK(fact(measured, "inclusive_stops").value);
    CHECK(rig.bus->least == there);
    CHECK(rig.bus->most == there);
  }
}

TEST_CASE("a temperature that does not stand still proves nothing about its limit") {
  std::string events;
  for (int i = 0; i < 600; ++i) {
    events += fmt::format(R"({}{{"at": "{}ms", "servo": 240900001,
        "world": {{"temperature": "{}degC"}}}})",
                          i > 0 ? "," : "", 5000 + 55 * i, 25 + i % 2);
  }
  for (const bool inclusive : {false, true}) {
    const Rig rig(fmt::format(R"("behaviour": {{"inclusive_stops": {}}})", inclusive),
                  fmt::format(R"(, "events": [{}])", events));
    const Memory before = rig.memory();
    const auto measured = rig.measure();
    check_done(measured);
    const Fact& found = fact(measured, "inclusive_stops");
    CHECK_FALSE(found.value);
    CHECK(found.reason.find("did not stand still") != std::string::npos);
    CHECK(text(rig.memory()) == text(before));
  }
}

TEST_CASE("the output does not come on for a measurement where pulses could move the shaft") {
  const Rig rig(R"("rom": {"soft_start": "off", "torque_output": "off", "timeout_time": "100ms"})",
                R"(, "events": [{"at": "1s", "servo": 240900001, "world": {"pulse": "1720us"}}])");
  const std::int64_t there = rig.bus->servo().shaft().angle;
  rig.bus->watched = true;
  const auto measured = rig.measure();
  CHECK_FALSE(measured.not_put_back);
  CHECK_FALSE(fact(measured, "inclusive_stops").value);
  CHECK(rig.bus->most == there);
}

TEST_CASE("times are found as they are simulated") {
  const Rig rig(R"("behaviour": {"rom_write_time": "180ms", "boot_time": "90ms",
                                 "first_node_status": "300ms", "answer_delay": "2ms"})");
  const auto measured = rig.measure();
  check_done(measured);
  const std::map<std::string, double> times{
      {"rom_write_time", 180}, {"boot_time", 90}, {"first_node_status", 300}, {"answer_delay", 2}};
  for (const auto& [setting, expected] : times) {
    INFO(setting << " " << words(fact(measured, setting).value));
    REQUIRE(fact(measured, setting).value);
    const double tolerance = setting == "answer_delay" ? 0.05 : 2;
    CHECK(std::abs(milliseconds(words(fact(measured, setting).value)) - expected) <= tolerance);
  }
}

TEST_CASE("the facts file holds what was measured, and sim takes it") {
  const Rig rig(R"("behaviour": {"out_of_range": "clamp", "notices_warn": true,
                                 "rom_write_time": "200ms", "boot_time": "100ms"})");
  const auto measured = rig.measure();
  const std::string file = facts_file(measured, WallTime{}, "9.9");
  INFO(file);
  const auto read = sim::parse_facts(file, "facts.json");
  REQUIRE(read);
  CHECK(read->out_of_range == sim::OutOfRange::clamp);
  CHECK(read->notices_warn);
  CHECK(read->boot_time.value_or(Duration{}) >= 98ms);
  const auto document = nlohmann::json::parse(file);
  for (const Fact& fact : measured.facts) {
    CHECK(document["behaviour"].contains(fact.setting) == fact.value.has_value());
  }
  CHECK(document["about"]["name"] == "jp.co.futaba.bla21");
  CHECK(document["about"]["software"] == "1.40");
  CHECK(document["about"]["model"] == "BLA21-12U-AB");
}
