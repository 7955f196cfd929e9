#include "blactl/fleet/files/fleet_match.hpp"
#include "blactl/fleet/files/params_file.hpp"
#include "blactl/fleet/files/settings_file.hpp"

#include "catch.hpp"
#include "unit/fleet/support.hpp"

#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
namespace at = blactl::bla::address;

namespace {

Result<FleetFile> parsed_params(std::string_view text) {
  return parse_params_file(text, "wing.param", profiles());
}

/// The faults of a file, a line each.
std::string params_faults(std::string_view text) {
  const auto read = parsed_params(text);
  REQUIRE_FALSE(read);
  CHECK(read.error().code == Code::bad_file);
  return read.error().message;
}

bool holds(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("what both tools write is read alike") {
  for (const char* text : {
           "0x38 900\n0x39 -900\n0x2A 63\n",
           "0x38,900\r\n0x39,-900\r\n0x2A,63\r\n",
           "# made by hand\n\n0x38\t900\n  0x39 , -900\n0x2a,63",
           "\xEF\xBB\xBF#x\n0x38 900\n0x39 -900\n0x2A 63",
       }) {
    CAPTURE(text);
    const auto read = parsed_params(text);
    REQUIRE(read);
    CHECK(read->is_params);
    CHECK(read->file == "wing.param");
    CHECK(read->passed_over.empty());
    REQUIRE(read->servos.size() == 1);
    const FleetEntry& entry = read->servos.front();
    CHECK(entry.name.empty());
    CHECK_FALSE(entry.match.means_one());
    REQUIRE(entry.set.size() == 3);
    CHECK(entry.set.front().parameter->address == at::overcurrent_limit);
    CHECK(entry.wish(at::angle_limit_cw) == 900);
    CHECK(entry.wish(at::angle_limit_ccw) == -900);
  }
}

TEST_CASE("the files that are kept as examples are read") {
  for (const std::string name : {"gui_tool.parm", "mission_planner.param"}) {
    CAPTURE(name);
    const auto read =
        read_settings_file(std::string(BLACTL_TEST_DATA) + "/params/" + name, profiles());
    REQUIRE(read);
    CHECK(read->is_params);
    CHECK(read->servos.front().wish(at::angle_limit_cw) == 450);
    CHECK(read->passed_over.size() > 10); // what the servo measures, who it is, what it was told
  }
}

TEST_CASE("what is no setting was saved by a tool with the others, and is passed over") {
  const auto read = parsed_params("0x08 12\n0x00 555555555\n0x38 900\n0x50 61\n0x12 0\n");
  REQUIRE(read);
  CHECK(read->servos.front().set.size() == 1);
  CHECK(read->passed_over == std::vector{bla::Address(0x00), bla::Address(0x08), bla::Address(0x12),
                                         bla::Address(0x50)});
}

TEST_CASE("a parameter file is told all that is wrong with it, each with its line") {
  const std::string told = params_faults("0x38 900\n"
                                         "56 900\n"
                                         "angle_limit_ccw -900\n"
                                         "SERVO1_MIN 1000\n"
                                         "0x39 -90.0\n"
                                         "0x3A 60rpm\n"
                                         "0x38 900\n"
                                         "0x3B\n"
                                         "0x3C 1 2\n"
                                         "0x46 126\n"
                                         "0x28 1\n"
                                         "0x3F 99999\n"
                                         "0x26 7\n"
                                         "0x60 1\n");
  CAPTURE(told);
  CHECK(std::ranges::count(told, '\n') == 12);
  for (const char* line :
       {"wing.param:2: 56: is it 0x56, or the decimal number 56?",
        "wing.param:3: angle_limit_ccw: write the address 0x39",
        "wing.param:4: SERVO1_MIN: no register of a BLA servo",
        "wing.param:5: 0x39: '-90.0' is not a register number",
        "wing.param:6: 0x3A: '60rpm' is not", "wing.param:7: 0x38: this register is also in line 1",
        "wing.param:8: 0x3B: a line must hold", "wing.param:9: 0x3C: a line must hold",
        "wing.param:10: 0x46: ", "wing.param:11: 0x28: ", "wing.param:12: 0x3F: ",
        "wing.param:13: 0x26: ", "wing.param:14: 0x60: no register of a BLA servo"}) {
    CAPTURE(line);
    CHECK(holds(told, line));
  }
}

TEST_CASE("a file without a setting says nothing") {
  for (const char* text : {"", "# nothing\n", "\n\n", "0x50 61\n0x51 240900558\n"}) {
    CHECK(holds(params_faults(text), "no setting of a BLA servo"));
  }
}

TEST_CASE("foreign bytes are no danger to a terminal") {
  CHECK_FALSE(holds(params_faults("0x38 \x1b[2J\n\x1b]0;x\a 1\n"), "\x1b"));
}

TEST_CASE("what is written is read as what the servo holds, every register at both ends") {
  for (const bla::Profile& model : profiles().all()) {
    INFO(model.model);
    for (const bool highest : {false, true}) {
      Snapshot snapshot;
      snapshot.servo.identity =
          bla::Identity(profiles(), {model.model_number, 240900558, 1400, model.hardware_version});
      for (const bla::Parameter* parameter : registers_to_export(snapshot.servo)) {
        if (!parameter->is_setting()) {
          continue;
        }
        const std::int64_t most =
            parameter->address == at::static_node_id ? 125 : parameter->max.value();
        snapshot.readings.push_back({parameter, highest ? most : parameter->min.value()});
      }
      const std::string text = params_file(snapshot, {.tool_version = "x"});
      CHECK(text.starts_with("# " + model.model + " 240900558 blactl x\n0x20 "));
      const auto read = parsed_params(text);
      REQUIRE(read);
      CHECK(read->servos.front().set.size() == snapshot.readings.size());
      for (const Reading& reading : snapshot.readings) {
        INFO(reading.parameter->name);
        CHECK(read->servos.front().wish(reading.parameter->address) == *reading.raw);
      }
    }
  }
}

namespace {

/// A roster of servos with these IDs.
void add_servos(Roster& roster, std::initializer_list<std::uint8_t> ids) {
  for (const std::uint8_t id : ids) {
    roster.learn(Servo{.id = NodeId(id), .is_servo = true}, std::nullopt);
  }
}

} // namespace

TEST_CASE("a parameter file is for the one servo that is named, or that there is") {
  const auto file = parsed_params("0x38 900\n");
  REQUIRE(file);
  Roster roster(dronecan::anonymous, profiles());
  const auto none = match(*file, roster, {}, profiles());
  CHECK(none.pairs.empty());
  REQUIRE(none.errors.size() == 1);
  CHECK(none.errors.front().code == Code::not_found);
  CHECK(match(*file, roster, parse_targets("all").value(), profiles()).errors.size() == 1);
  CHECK(match(*file, roster, parse_targets("11").value(), profiles()).errors.size() == 1);
  add_servos(roster, {11});
  const auto one = match(*file, roster, {}, profiles());
  REQUIRE(one.pairs.size() == 1);
  CHECK(one.pairs.front().id == NodeId(11));
  CHECK(one.pairs.front().entry == &file->servos.front());
  add_servos(roster, {12});
  const auto several = match(*file, roster, {}, profiles());
  CHECK(several.pairs.empty());
  REQUIRE(several.errors.size() == 1);
  CHECK(several.errors.front().code == Code::usage);
  CHECK(holds(several.errors.front().message, "nodes 11, 12"));
  const auto named = match(*file, roster, parse_targets("12").value(), profiles());
  REQUIRE(named.pairs.size() == 1);
  CHECK(named.pairs.front().id == NodeId(12));
  CHECK(named.extra.empty());
}
