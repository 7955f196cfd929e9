#include "blactl/fleet/files/fleet_file.hpp"

#include "catch.hpp"
#include "unit/fleet/support.hpp"

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

/// A file with these entries, one a line from line 3 on.
std::string file(std::initializer_list<const char*> entries, const std::string& common = "{}") {
  std::string text = R"({"schema":"blactl-fleet/1","common":)" + common + ",\n\"servos\":[";
  const char* separator = "\n";
  for (const char* entry : entries) {
    text += separator + std::string(entry);
    separator = ",\n";
  }
  return text + "]}\n";
}

Result<FleetFile> parsed(const std::string& text) {
  return parse_fleet_file(text, "fleet.json", profiles());
}

/// The faults of a file, each without the name of the file.
std::vector<std::string> faults(const std::string& text) {
  const auto read = parsed(text);
  REQUIRE_FALSE(read);
  CHECK(read.error().code == Code::bad_file);
  std::vector<std::string> lines;
  std::string_view rest = read.error().message;
  while (!rest.empty()) {
    const auto line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    REQUIRE(line.starts_with("fleet.json:"));
    lines.emplace_back(line.substr(std::string_view("fleet.json:").size()));
  }
  return lines;
}

/// The one fault of a file.
std::string fault(const std::string& text) {
  const auto all = faults(text);
  REQUIRE(all.size() == 1);
  return all.front();
}

bool begins(const std::string& text, std::string_view beginning) {
  INFO(text);
  return text.starts_with(beginning);
}

Servo a_servo() {
  Servo servo = bla21();
  servo.servo_id = 4;
  return servo;
}

} // namespace

TEST_CASE("a fleet file says which servo holds what, and what is common to all") {
  const auto read = parsed(file(
      {R"({"name":"left","match":{"serial_number":240900558},"set":{"servo_id":3,"0x38":450}})",
       R"({"name":"right","match":{"model":"bla21-12u","node_id":12},"set":{"smoothing":"off"}})"},
      R"({"timeout_time":"500ms","smoothing":"on"})"));
  REQUIRE(read);
  REQUIRE(read->servos.size() == 2);
  const FleetEntry& left = read->servos[0];
  CHECK(left.name == "left");
  CHECK(left.match.serial_number == 240900558);
  CHECK(left.wish(bla::address::servo_id) == 3);
  CHECK(left.wish(bla::address::angle_limit_cw) == 450);
  CHECK(left.wish(bla::address::timeout_time) == 500);
  CHECK(left.wish(bla::address::smoothing) == 1);
  CHECK(left.set.size() == 4);
  const FleetEntry& right = read->servos[1];
  CHECK(right.match.node_id == NodeId(12));
  CHECK(right.wish(bla::address::smoothing) == 0); // its own word goes before the common one
  CHECK_FALSE(right.wish(bla::address::servo_id));
}

TEST_CASE("every fault of a fleet file is named with its line and place: twenty of twenty") {
  std::ifstream in(BLACTL_TEST_DATA "/faulty/fleet.json");
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const auto found = faults(text);
  const std::vector<std::string_view> expected{"3: /servos/0/set/angle_limit_cw: ",
                                               "4: /servos/1/set/angle_limit_cw: ",
                                               "5: /servos/2/set/angle_limt_cw: ",
                                               "6: /servos/3/set/command_angle: ",
                                               "7: /servos/4/set/model_number: ",
                                               "8: /servos/5/set/static_node_id: ",
                                               "9: /servos/6/set/servo_id: ",
                                               "10: /servos/7/set/servo_id: ",
                                               "11: /servos/8/set/smoothing: ",
                                               "12: /servos/9/match/colour: ",
                                               "13: /servos/10/match: ",
                                               "14: /servos/11/match: ",
                                               "15: /servos/12/match: ",
                                               "16: /servos/13: ",
                                               "17: /servos/14/name: ",
                                               "18: /servos/15/match/node_id: ",
                                               "19: /servos/16/set/timeout_time: ",
                                               "20: /servos/17/set/pwm_output_range: ",
                                               "21: /servos/18/match/serial_number: ",
                                               "22: /servos/19: "};
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(begins(found[i], expected[i]));
  }
}

TEST_CASE(
    "a value that the model of the entry does not take is a fault, also among the common ones") {
  CHECK(begins(fault(file({R"({"name":"a","match":{"model":"BLA21-12U","serial_number":1},
                              "set":{"voltage_limit_high":"30V"}})"})),
               "4: /servos/0/set/voltage_limit_high: BLA21-12U-"));
  CHECK(
      begins(fault(file({R"({"name":"a","match":{"model":"BLA15"},"set":{"pwm_neutral":1500}})"})),
             "3: /servos/0/set/pwm_neutral: BLA15-"));
  CHECK(
      begins(fault(file({R"({"name":"a","match":{"model":"BLA15"}})"}, R"({"pwm_neutral":1500})")),
             "1: /common/pwm_neutral: BLA15-"));
  CHECK(parsed(file({R"({"name":"a","match":{"model":"BLA21-28U","serial_number":1},
                        "set":{"voltage_limit_high":"30V"}})"})));
}

TEST_CASE("a model without PWM input holds 0 in 0x34-0x37: so may its file") {
  const char* zeros = R"({"pwm_neutral":"0us","pwm_range":0,"0x36":0,"pwm_mode":"angle"})";
  for (const char* model : {"BLA15", "BLA21-12U-A0"}) {
    const std::string entry = R"({"name":"a","match":{"model":")" + std::string(model) + R"("}})";
    CHECK(parsed(file({entry.c_str()}, zeros)));
  }
  CHECK(begins(fault(file({R"({"name":"a","match":{"model":"BLA34"},"set":{"pwm_neutral":0}})"})),
               "3: /servos/0/set/pwm_neutral: BLA34-28U-AB: pwm_neutral=0us: outside of the range "
               "100us to 10000us"));
  CHECK(begins(fault(file({R"({"name":"a","match":{"model":"BLA15"},"set":{"pwm_range":9}})"})),
               "3: /servos/0/set/pwm_range: "));
}

TEST_CASE("two entries must not mean one servo, nor give one ID to two") {
  const char* one = R"({"name":"a","match":{"serial_number":1},"set":{"servo_id":3}})";
  CHECK(begins(fault(file({one, R"({"name":"a","match":{"serial_number":2}})"})),
               "4: /servos/1: this name is also in line 3"));
  CHECK(begins(fault(file({one, R"({"name":"b","match":{"serial_number":1,"node_id":5}})"})),
               "4: /servos/1: the entry in line 3 means the same servo"));
  CHECK(
      begins(fault(file({one, R"({"name":"b","match":{"serial_number":2},"set":{"servo_id":3}})"})),
             "4: /servos/1: servo_id 3 is also given by the entry in line 3"));
  CHECK(begins(fault(file({R"({"name":"a","match":{"model":"BLA21"}})",
                           R"({"name":"b","match":{"model":"BLA21"}})"})),
               "4: /servos/1: the entry in line 3 means the same servo"));
  CHECK(parsed(file({one, R"({"name":"b","match":{"serial_number":2,"node_id":5}})",
                     R"({"name":"c","match":{"serial_number":3,"node_id":5}})"})));
  CHECK(parsed(file({R"({"name":"a","match":{"serial_number":1}})",
                     R"({"name":"b","match":{"serial_number":2}})"},
                    R"({"servo_id":0,"static_node_id":0})")));
}

TEST_CASE("an entry must find its servo again after its own change") {
  CHECK(begins(fault(file({R"({"name":"a","match":{"servo_id":3},"set":{"servo_id":4}})"})),
               "3: /servos/0/set/servo_id: this changes the servo_id"));
  CHECK(begins(fault(file({R"({"name":"a","match":{"node_id":11,"model":"BLA21"},
                              "set":{"static_node_id":12}})"})),
               "4: /servos/0/set/static_node_id: "));
  CHECK(begins(fault(file({R"({"name":"a","match":{"model":"BLA21"},"set":{"servo_id":4}})"})),
               "3: /servos/0/set/servo_id: servo_id for all servos of a model"));
  CHECK(parsed(file({R"({"name":"a","match":{"servo_id":3},"set":{"servo_id":3}})"})));
  CHECK(parsed(file({R"({"name":"a","match":{"serial_number":1,"servo_id":3},
                        "set":{"servo_id":4}})"})));
}

TEST_CASE("all keys of a match must agree with what the servo said") {
  const Servo servo = a_servo();
  const auto means = [&](const Match& match) { return match.means(servo, profiles()); };
  Match match{.unique_id = servo.unique_id,
              .serial_number = 240900558,
              .servo_id = 4,
              .node_id = NodeId(11),
              .model = "BLA21-12U-AB2"};
  CHECK(means(match));
  for (const auto change :
       {+[](Match& m) { m.unique_id = dronecan::UniqueId{9}; },
        +[](Match& m) { m.serial_number = 1; }, +[](Match& m) { m.servo_id = 5; },
        +[](Match& m) { m.node_id = NodeId(12); }, +[](Match& m) { m.model = "BLA21-28U"; }}) {
    Match other = match;
    change(other);
    CHECK_FALSE(means(other));
  }
  CHECK(means({.model = "bla21"}));
  Servo silent = servo; // what it did not say agrees with nothing
  silent.servo_id = std::nullopt;
  CHECK_FALSE(match.means(silent, profiles()));
}

TEST_CASE("what is exported is read as what the servo holds, every register at both ends") {
  for (const bla::Profile& model : profiles().all()) {
    INFO(model.model);
    for (const bool highest : {false, true}) {
      Snapshot snapshot;
      snapshot.servo = a_servo();
      snapshot.servo.identity =
          bla::Identity(profiles(), {model.model_number, 240900558, 1400, model.hardware_version});
      for (const bla::Parameter* parameter : registers_to_export(snapshot.servo)) {
        if (!parameter->is_setting()) {
          continue;
        }
        const bool is_id = parameter->address == bla::address::static_node_id;
        const std::int64_t most = is_id ? 125 : parameter->max.value();
        snapshot.readings.push_back({parameter, highest ? most : parameter->min.value()});
      }
      const std::string text = fleet_file(std::span(&snapshot, 1), {.tool_version = "x"});
      INFO(text);
      const auto read = parsed(text);
      REQUIRE(read);
      REQUIRE(read->servos.size() == 1);
      const FleetEntry& entry = read->servos.front();
      CHECK(entry.match.means(snapshot.servo, profiles()));
      CHECK(entry.about.model == snapshot.servo.identity.model());
      CHECK(entry.about.firmware_version == 1400);
      CHECK(entry.set.size() == snapshot.readings.size());
      for (const Reading& reading : snapshot.readings) {
        INFO(reading.parameter->name);
        CHECK(entry.wish(reading.parameter->address) == *reading.raw);
      }
    }
  }
}
