// A simulated servo on the bench: what is measured is how it is simulated, and it is left as it
// was, whenever somebody interrupts.

#include "blactl/dronecan/allocator.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/change/carry_out.hpp"
#include "blactl/fleet/characterize/characterization.hpp"
#include "blactl/sim/scenario/facts.hpp"

#include "support.hpp"
#include "unit/state/processes.hpp"

#include <nlohmann/json.hpp>

#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

/// Writes to one register that never reach the servo: it holds what it held.
struct Deafness {
  std::string name;            ///< "0x38"
  int first = 0, last = 1'000; ///< the writes that it misses; the first is 1
  int written = 0;

  /// The last frame of such a write, which its name ends; what is only read fits into one frame.
  [[nodiscard]] bool misses(const can::Frame& frame) {
    const std::size_t size = frame.size;
    const bool is_end = size == 3 && (frame.data[2] & 0xC0U) == 0x40U;
    const bool is_one = is_end && !name.empty() && frame.data[0] == std::uint8_t(name[2]) &&
                        frame.data[1] == std::uint8_t(name[3]);
    return is_one && ++written >= first && written <= last;
  }
};

/// Passes frames on; the n-th of them, and perhaps a later one, brings a Ctrl-C.
class Interrupted final : public can::Bus {
 public:
  explicit Interrupted(std::unique_ptr<sim::PrivateBus> bus) : bus_(std::move(bus)) {}

  [[nodiscard]] std::string_view name() const override { return bus_->name(); }

  [[nodiscard]] Result<bool> send(const can::Frame& frame) override {
    if (watched) {
      least = std::min(least, servo().shaft().angle);
      most = std::max(most, servo().shaft().angle);
    }
    can::Frame passed = frame;
    if (deafness.misses(frame)) {
      passed.data[1] = 0; // which its CRC tells
      spoilt = frame;
    }
    auto taken = bus_->send(passed);
    if (taken && *taken && (++sent == at || sent == again)) {
      raise(SIGINT);
      signalled = bus_->now();
    }
    return taken;
  }

  [[nodiscard]] std::optional<can::BusEvent> receive() override {
    auto event = bus_->receive();
    auto* echo = event ? std::get_if<can::Sent>(&*event) : nullptr;
    if (echo != nullptr && spoilt && echo->frame.id == spoilt->id && echo->frame.size == 3) {
      echo->frame = *std::exchange(spoilt, std::nullopt);
    }
    return event;
  }

  [[nodiscard]] Result<void> filter(std::span<const can::Filter> filters) override {
    return bus_->filter(filters);
  }

  [[nodiscard]] bool echoes() const override { return true; }

  [[nodiscard]] int descriptor() const override { return -1; }

  [[nodiscard]] Time now() const override { return bus_->now(); }

  [[nodiscard]] WallTime wall() const override { return bus_->wall(); }

  [[nodiscard]] Time idle_until(Time deadline) override { return bus_->idle_until(deadline); }

  [[nodiscard]] const sim::Servo& servo() const { return *bus_->simulator().servos().front(); }

  int sent = 0, at = -1, again = -1;
  bool watched = false; ///< where the shaft is, at each frame
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  std::int64_t most = std::numeric_limits<std::int64_t>::min();
  Time signalled{};
  Deafness deafness;
  std::optional<can::Frame> spoilt; ///< as it was, until its echo

 private:
  std::unique_ptr<sim::PrivateBus> bus_;
};

constexpr std::uint8_t dynamic_id = 42;

/// Whoever asks.
class OneId final : public dronecan::AllocationTable {
 public:
  [[nodiscard]] bool serves(dronecan::Bytes) const override { return true; }

  [[nodiscard]] std::optional<NodeId> assign(const dronecan::UniqueId&, NodeId) override {
    return NodeId(dynamic_id);
  }
};

/// What a servo holds of what is to be given back.
struct Memory {
  std::map<bla::Address, std::int64_t> ram, rom;
};

std::string text(const Memory& memory) {
  std::string out;
  for (const auto& [address, raw] : memory.ram) {
    out += fmt::format("{}={} ", address.name(), raw);
  }
  for (const auto& [address, raw] : memory.rom) {
    out += fmt::format("rom {}={} ", address.name(), raw);
  }
  return out;
}

/// Where 0x00 rules it makes no difference whether 0x01 and 0x02 are 0 or not active.
Memory without_idle_commands(Memory memory) {
  for (const bla::Address address : {bla::address::command_speed, bla::address::command_torque}) {
    std::int64_t& raw = memory.ram[address];
    const bool rules = memory.ram.at(bla::address::command_angle) == bla::not_active;
    raw = !rules && raw == bla::not_active ? 0 : raw;
  }
  return memory;
}

/// One servo, BLA21-12U-AB at 11 unless `members` says otherwise, that has run for some time.
class Rig {
 public:
  explicit Rig(const std::string& members = "", const std::string& more = "") {
    const std::string model =
        members.find("\"model\"") == std::string::npos ? R"("model": "BLA21-12U-AB", )" : "";
    const std::string id =
        members.find("\"node_id\"") == std::string::npos ? R"("node_id": 11)" : "";
    const std::string comma = id.empty() || members.empty() ? "" : ", ";
    const auto scenario =
        sim::parse_scenario(fmt::format(R"({{"schema": "blactl-scenario/1", "clock": "virtual",
                        "servos": [{{{}{}{}{}}}]{}}})",
                                        model, id, comma, members, more),
                            "test.json", profiles());
    INFO((scenario ? "" : scenario.error().message));
    REQUIRE(scenario);
    auto interrupted =
        std::make_unique<Interrupted>(std::make_unique<sim::PrivateBus>("sim:", *scenario));
    bus = interrupted.get();
    auto opened = Session::open(std::move(interrupted), state::LocalNodeId::unshared({}),
                                Session::Hearing::all, profiles());
    REQUIRE(opened);
    session = std::move(*opened);
    OneId table;
    dronecan::Allocator allocator(session->node(), table);
    session->attach(allocator);
    REQUIRE(session->live_until(session->now() + 5s));
    session->detach(allocator);
  }

  [[nodiscard]] Memory memory() const {
    Memory memory;
    const sim::Memory& registers = bus->servo().registers();
    for (std::uint8_t value = 0; value <= 0x46; ++value) {
      const bla::Address address(value);
      const bla::Parameter* parameter = registers.existing(address);
      if (parameter != nullptr && (parameter->saved || parameter->group == bla::Group::command)) {
        memory.ram[address] = registers.value(address);
      }
      if (parameter != nullptr && parameter->saved) {
        memory.rom[address] = registers.rom_value(address);
      }
    }
    return memory;
  }

  /// What it holds, as the command looks at it before its question.
  [[nodiscard]] Snapshot look(std::uint8_t id = 11) const {
    const std::vector ids{NodeId(id)};
    auto snapshots = take_snapshots(*session, profiles(), ids, {}, registers_to_characterize);
    REQUIRE_FALSE(snapshots.broken);
    INFO((snapshots.servos[0].first_error() ? snapshots.servos[0].first_error()->message : ""));
    REQUIRE_FALSE(snapshots.servos[0].first_error());
    return snapshots.servos[0];
  }

  [[nodiscard]] Characterization measure(std::uint8_t id = 11) const {
    return characterize(*session, profiles(), look(id), {.may_allocate = true});
  }

  void set(const char* assignment) const {
    const Wanted wanted{.assignments = assignments({assignment})};
    auto plan = make_plan(
        wanted,
        take_snapshots(*session, profiles(), std::vector{NodeId(11)}, {},
                       [&](const Servo& servo) { return registers_needed(wanted, servo); })
            .servos[0],
        profiles());
    REQUIRE(plan);
    REQUIRE(carry_out(*session, profiles(), std::span(&*plan, 1), {}).servos[0].is_done());
  }

  Interrupted* bus = nullptr; ///< of the session
  std::unique_ptr<Session> session;
};

std::string words(const std::optional<FactValue>& value) {
  if (!value) {
    return "not measured";
  }
  const auto* flag = std::get_if<bool>(&*value);
  return flag == nullptr ? std::get<std::string>(*value) : *flag ? "true" : "false";
}

const Fact& fact(const Characterization& measured, std::string_view setting) {
  const auto it = std::ranges::find(measured.facts, setting, &Fact::setting);
  REQUIRE(it != measured.facts.end());
  return *it;
}

/// Finished, and everything as it was.
void check_done(const Characterization& measured) {
  INFO((measured.error ? measured.error->message : ""));
  INFO((measured.not_put_back ? measured.not_put_back->message : ""));
  CHECK(measured.is_done());
}

void check_same(const Rig& rig, const Memory& before) {
  CHECK(text(without_idle_commands(rig.memory())) == text(without_idle_commands(before)));
}

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

std::string literal(const std::string& value) {
  return value == "true" || value == "false" ? value : "\"" + value + "\"";
}

/// The keys of "behaviour" in a schema that is published, each with what it may be.
nlohmann::json behaviour_schema() {
  std::ifstream file(std::string(BLACTL_SCHEMAS) + "/scenario.schema.json");
  REQUIRE(file);
  return nlohmann::json::parse(file)["$defs"]["behaviour"]["properties"];
}

std::vector<std::string> values_of(const nlohmann::json& property) {
  if (property.contains("enum")) {
    return property["enum"];
  }
  if (property.contains("type")) {
    return {"true", "false"};
  }
  const std::string kind = property["allOf"][0]["$ref"];
  return kind.ends_with("missing_read") ? std::vector<std::string>{"fail", "zero"}
                                        : std::vector<std::string>{"30ms", "400ms"};
}

double milliseconds(const std::string& time) {
  return std::stod(time) / (time.ends_with("us") ? 1000 : 1);
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

namespace {

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

namespace {

/// One by chance: every setting, what RAM and ROM hold, a hand on its shaft.
struct RandomServo {
  std::map<std::string, std::string> behaviour;
  std::string members, scene;
};

class RandomServos {
 public:
  explicit RandomServos(unsigned seed) : chance_(seed) {}

  RandomServo next() {
    RandomServo servo;
    std::string is_like;
    for (const auto& [key, property] : schema_.items()) {
      // Half a second an answer is no bench.
      const std::string value = key == "answer_delay" ? "2ms" : one_of(values_of(property));
      servo.behaviour[key] = value;
      is_like += fmt::format(R"({}"{}": {})", is_like.empty() ? "" : ", ", key, literal(value));
    }
    const std::string model = one_of(models_), rom = some_memory(), ram = some_memory();
    servo.members = fmt::format(
        R"("model": "{}", "behaviour": {{{}}}, "rom": {{{}}}, "ram": {{{}}}, "servo_id": {})",
        model, is_like, rom, ram, number(3));
    servo.scene = one_of(scenes_);
    return servo;
  }

  std::size_t number(std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(chance_);
  }

 private:
  std::string one_of(const std::vector<std::string>& all) { return all[number(all.size())]; }

  std::string some_memory() {
    std::string out;
    for (const auto& [name, values] : memory_) {
      if (number(2) == 0) {
        out += fmt::format(R"({}"{}": "{}")", out.empty() ? "" : ", ", name, one_of(values));
      }
    }
    return out;
  }

  std::mt19937 chance_;
  nlohmann::json schema_ = behaviour_schema();
  std::vector<std::string> models_{"BLA15-06U-A0", "BLA21-06U-AB", "BLA21-12U-A0",
                                   "BLA21-28U-AB", "BLA34-12U-AB", "BLA34-28U-AB"};
  std::vector<std::pair<std::string, std::vector<std::string>>> memory_{
      {"angle_limit_cw", {"0deg", "45.5deg", "179.9deg", "400deg"}},
      {"angle_limit_ccw", {"0deg", "-10deg", "-180deg"}},
      {"torque_output", {"on", "off", "brake"}},
      {"soft_start", {"on", "off"}},
      {"reverse", {"on", "off"}},
      {"timeout_action", {"hold", "off", "brake"}},
      {"timeout_time", {"1ms", "800ms", "60000ms"}},
      {"speed_torque_control", {"on", "off"}},
      {"speed_limit_cw", {"0rpm", "30rpm", "70rpm"}},
      {"torque_limit_cw", {"0%", "30%", "100%"}},
      {"origin", {"0deg", "-12.3deg"}},
      {"extended_angle", {"on", "off"}}};
  std::vector<std::string> scenes_{
      "", R"(, "events": [{"at": "2s", "servo": 240900001, "world": {"hand": "-75deg"}}])",
      R"(, "events": [{"at": "2s", "servo": 240900001, "world": {"hand": "30deg"}},
          {"at": "3s", "servo": 240900001, "world": {"hand": "free"}}])"};
};

/// With BLACTL_LONG_TESTS set, for nights.
int this_many(int usual, int at_night) {
  return std::getenv("BLACTL_LONG_TESTS") != nullptr ? at_night : usual;
}

} // namespace

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

TEST_CASE("whatever a servo is like and holds, a Ctrl-C at any moment leaves it so") {
  constexpr std::size_t most_frames = 900; // beyond the end of most
  RandomServos chance(20261124);
  int interrupted = 0;
  const int servos = this_many(60, 2000);
  for (int i = 0; i < servos; ++i) {
    const RandomServo servo = chance.next();
    const auto at = static_cast<int>(chance.number(most_frames));
    INFO(servo.members << servo.scene << " at " << at);
    const Rig rig(servo.members, servo.scene);
    const Memory before = rig.memory();
    const Snapshot looked = rig.look();
    rig.bus->at = rig.bus->sent + at;
    const auto measured = characterize(*rig.session, profiles(), looked, {});
    INFO((measured.not_put_back ? measured.not_put_back->message : ""));
    CHECK_FALSE(measured.not_put_back);
    check_same(rig, before);
    interrupted += measured.error ? 1 : 0;
  }
  CHECK(interrupted > servos / 3);
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

TEST_CASE("what was only in RAM is given back, and ROM keeps its own") {
  const Rig rig(R"("rom": {"soft_start": "off"}, "ram": {"angle_limit_cw": "90deg",
      "torque_output": "brake", "speed_torque_control": "on", "timeout_time": "1500ms"})");
  const Memory before = rig.memory();
  CHECK(before.ram.at(bla::address::angle_limit_cw) == 900);
  check_done(rig.measure());
  CHECK(text(rig.memory()) == text(before));
}

TEST_CASE("a servo that was commanded an angle is commanded it again") {
  const Rig rig;
  rig.set("command_angle=45deg");
  const Memory before = rig.memory();
  CHECK(before.ram.at(bla::address::command_angle) == 450);
  check_done(rig.measure());
  CHECK(text(rig.memory()) == text(before));
}

TEST_CASE("a servo that is commanded to turn is not measured") {
  const Rig rig(R"("rom": {"speed_torque_control": "on"})");
  rig.set("command_speed=20rpm");
  const auto refused = refuse_to_characterize(*rig.session, rig.look(), false);
  REQUIRE(refused);
  CHECK(refused->code == Code::cross_check);
}

TEST_CASE("a Ctrl-C at any moment leaves the servo as it was") {
  const std::string members = GENERATE(
      std::string(), std::string(R"("behaviour": {"soft_start_shows": true, "out_of_range": "clamp",
          "keeps_disabled_command": false, "start_angle": "zero"}, "ram": {"angle_limit_cw": "90deg",
          "current_angle": "100deg"}, "servo_id": 7)"),
      std::string(R"("node_id": 0, "behaviour": {"first_node_status": "1s",
          "answers_save_first": false, "rom_write_time": "300ms"}, "ram": {"reverse": "on"})"));
  const bool is_dynamic = members.find("\"node_id\"") != std::string::npos;
  const std::uint8_t id = is_dynamic ? dynamic_id : 11;
  const auto frames = [&] {
    const Rig rig(members);
    (void)rig.look(id);
    const int begun = rig.bus->sent;
    check_done(rig.measure(id));
    return rig.bus->sent - begun;
  }();
  CHECK(frames > 200);
  // By frames of ours: no other moment is another to the servo.
  const int step = this_many(5, 1);
  for (int at = 1; at <= frames; at += step) {
    const Rig rig(members);
    const Memory before = rig.memory();
    const Snapshot looked = rig.look(id);
    rig.bus->at = rig.bus->sent + at;
    const auto measured = characterize(*rig.session, profiles(), looked, {.may_allocate = true});
    INFO(members << ": at frame " << at << " of " << frames);
    INFO((measured.not_put_back ? measured.not_put_back->message : ""));
    CHECK_FALSE(measured.not_put_back);
    CHECK(text(rig.memory()) == text(before));
    if (rig.session->signal() != 0 && measured.error) { // in the end it changes nothing any more
      CHECK(measured.error->code == Code::interrupted);
      CHECK(rig.session->now() - rig.bus->signalled <= put_back_time);
    }
  }
}

TEST_CASE("a second Ctrl-C ends at once, and says what is left") {
  const Rig rig;
  const Snapshot looked = rig.look();
  rig.bus->at = rig.bus->sent + 150;
  rig.bus->again = rig.bus->at + 1;
  const auto measured = characterize(*rig.session, profiles(), looked, {});
  REQUIRE(measured.error);
  CHECK(measured.error->code == Code::interrupted);
  REQUIRE(measured.not_put_back);
  CHECK(measured.not_put_back->message.find("not put back") != std::string::npos);
  CHECK(rig.session->now() - rig.bus->signalled <= 10ms);
}

TEST_CASE("what is left is recorded for undo, and nothing where all was put back") {
  for (const bool is_left : {true, false}) {
    const state::test::Folder folder;
    const auto open = [&] { return state::SnapshotStore::open(folder.path, state::Access::write); };
    History history("characterize", open().value(), state::ProofStore::unshared().value());
    const Rig rig;
    const Snapshot looked = rig.look();
    rig.bus->at = is_left ? rig.bus->sent + 150 : -1;
    rig.bus->again = is_left ? rig.bus->at + 1 : -1;
    const auto measured = characterize(*rig.session, profiles(), looked, {.history = &history});
    CHECK(measured.not_put_back.has_value() == is_left);
    const auto entries = open()->entries().value();
    REQUIRE(entries.size() == (is_left ? 1 : 0));
    for (const auto& entry : entries) {
      CHECK(entry.held.at(0x38) == looked.raw(bla::address::angle_limit_cw));
      CHECK_FALSE(entry.saved);
    }
  }
}

TEST_CASE("whenever it restarts by itself it gets back what it held, or that is told") {
  int done = 0, failed = 0;
  for (int number = 60; number <= 400; number += 9) {
    INFO("after answer " << number);
    const Rig rig(fmt::format(R"("behaviour": {{"first_node_status": "1s"}}, "ram":
        {{"angle_limit_cw": "90deg"}}, "faults": {{"restart_after_answer": [{{"number": {}}}]}})",
                              number));
    const Memory before = rig.memory();
    const Snapshot looked = rig.look();
    const auto measured = characterize(*rig.session, profiles(), looked, {});
    CHECK(rig.memory().rom == before.rom);
    CHECK(words(fact(measured, "answers_save_first").value) != "false"); // it does
    if (measured.is_done()) {
      ++done;
      CHECK(text(rig.memory()) == text(before));
    } else {
      ++failed;
      if (!measured.not_put_back) {
        CHECK(rig.memory().ram == before.ram);
      }
    }
  }
  CHECK(done > 0);
  CHECK(failed > 0);
}

TEST_CASE("a servo that restarts by itself before SAVE is not said to have saved without a word") {
  int told = 0;
  for (int number = 1; number <= 40; ++number) {
    INFO("after GetNodeInfo " << number);
    const Rig rig(fmt::format(
        R"("faults": {{"restart_after_answer": [{{"to": "node_info", "number": {}}}]}})", number));
    const Snapshot looked = rig.look();
    const auto measured = characterize(*rig.session, profiles(), looked, {});
    const Fact& found = fact(measured, "answers_save_first");
    CHECK(words(found.value) != "false"); // it answers first
    CHECK_FALSE(measured.not_put_back);
    told += measured.error || found.reason.find("restarted") != std::string::npos ? 1 : 0;
  }
  CHECK(told > 0);
}

TEST_CASE("a setting that is not given back keeps no other from it, and only it is named") {
  const Rig rig(R"("ram": {"angle_limit_cw": "90deg", "angle_limit_ccw": "-80deg",
      "torque_output": "on", "timeout_time": "1500ms"})");
  const Memory before = rig.memory();
  const Snapshot looked = rig.look();
  rig.bus->deafness = {.name = "0x38", .first = 2};
  const auto measured = characterize(*rig.session, profiles(), looked, {});
  REQUIRE(measured.error);
  REQUIRE(measured.not_put_back);
  INFO(measured.not_put_back->message << " / " << measured.not_put_back->hint);
  CHECK(measured.not_put_back->message.find("not put back: angle_limit_cw (") != std::string::npos);
  CHECK(measured.not_put_back->hint == "to put it back: blactl set -n 11 angle_limit_cw=900raw");
  Memory after = rig.memory();
  after.ram[bla::address::angle_limit_cw] = 900;
  CHECK(text(without_idle_commands(after)) == text(without_idle_commands(before)));
}

TEST_CASE("what ROM gives back when it restarts is put back, although a write was not taken") {
  const Rig rig(R"("rom": {"angle_limit_cw": "90deg"})");
  const Memory before = rig.memory();
  const Snapshot looked = rig.look();
  rig.bus->deafness = {.name = "0x38", .first = 2};
  const auto measured = characterize(*rig.session, profiles(), looked, {});
  CHECK(measured.error);
  INFO((measured.not_put_back ? measured.not_put_back->message : ""));
  CHECK_FALSE(measured.not_put_back);
  check_same(rig, before);
}

TEST_CASE("what to type to put it back names no command to move") {
  for (int at = 60; at <= 420; at += 12) {
    const Rig rig;
    const Snapshot looked = rig.look();
    rig.bus->at = rig.bus->sent + at;
    rig.bus->again = rig.bus->at + 1;
    const auto measured = characterize(*rig.session, profiles(), looked, {});
    const std::string hint = measured.not_put_back ? measured.not_put_back->hint : "";
    INFO("at " << at << ": " << hint);
    CHECK(hint.find("command_") == std::string::npos);
    CHECK(hint.find("555") == std::string::npos);
  }
}

TEST_CASE("the output stays off where it would turn the shaft, and a restart is what to type") {
  int kept_off = 0;
  for (int at = 60; at <= 240; at += 2) {
    const Rig rig(R"("ram": {"speed_torque_control": "on"})");
    const Snapshot looked = rig.look();
    rig.bus->deafness = {.name = "0x01", .first = 3}; // it keeps the speed that it was commanded
    rig.bus->at = rig.bus->sent + at;
    const auto measured = characterize(*rig.session, profiles(), looked, {});
    const auto ram = rig.memory().ram;
    const std::int64_t speed = ram.at(bla::address::command_speed);
    const bool turns = speed != 0 && speed != bla::not_active &&
                       ram.at(bla::address::speed_torque_control) == 1 &&
                       ram.at(bla::address::torque_output) == 0;
    INFO("at " << at);
    CHECK_FALSE(turns);
    if (measured.not_put_back && speed == 10) {
      ++kept_off;
      CHECK(measured.not_put_back->message.find("it would turn: command_speed") !=
            std::string::npos);
      CHECK(measured.not_put_back->hint ==
            "to put it back: blactl restart -n 11 (what was in its RAM only is lost)");
    }
  }
  CHECK(kept_off > 0);
}
