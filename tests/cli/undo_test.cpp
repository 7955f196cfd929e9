// undo: servos go back to what they held before they were changed.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

Result undo(const Fleet& fleet, const Arguments& more = {}, const Options& options = {}) {
  Arguments arguments{"undo", "-y", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return fleet.run(arguments, options);
}

void set(const Fleet& fleet, const Arguments& more) {
  Arguments arguments{"set", "-y"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Result result = fleet.run(arguments);
  INFO(result.err);
  REQUIRE(result.status == 0);
}

} // namespace

TEST_CASE("undo goes back in RAM, and in ROM only where that was changed; twice is as before") {
  Fleet fleet(three_servos());
  const bool saves = GENERATE(false, true);
  set(fleet, saves ? Arguments{"-n", "11", "angle_limit_cw=45deg", "--save"}
                   : Arguments{"-n", "11", "angle_limit_cw=45deg"});
  const Result undone = undo(fleet);
  INFO(undone.err);
  CHECK(undone.status == 0);
  const auto node = json(undone.out)["nodes"][0];
  CHECK(node["status"] == "changed");
  CHECK(node["saved"] == saves);
  CHECK(node["changes"][0]["after"] == 1799);
  CHECK(contains(undone.err, "takes back what `set` changed at 20"));
  CHECK(fleet.ram("11", "angle_limit_cw") == 1799);
  REQUIRE(undo(fleet).status == 0);
  CHECK(fleet.ram("11", "angle_limit_cw") == 450);
  CHECK(fleet.rom("11", "angle_limit_cw") == (saves ? 450 : 1799));
  CHECK(fleet.rom_writes() == (saves ? 3 : 0));
}

TEST_CASE(
    "without -n undo is about the servos of the last command, with it about the last of each") {
  Fleet fleet(three_servos());
  set(fleet, {"-n", "11", "smoothing=off"});
  set(fleet, {"-n", "12,13", "smoothing=off"});
  const bool names = GENERATE(false, true);
  const Result undone = names ? undo(fleet, {"-n", "11,13"}) : undo(fleet);
  INFO(undone.err);
  CHECK(undone.status == 0);
  CHECK(fleet.ram("11", "smoothing") == (names ? 1 : 0));
  CHECK(fleet.ram("12", "smoothing") == (names ? 0 : 1));
  CHECK(fleet.ram("13", "smoothing") == 1);
}

TEST_CASE("every command that changes servos can be taken back") {
  Fleet fleet(three_servos());
  const Document before = fleet.exported();
  const auto [arguments, saves] =
      GENERATE(std::pair(Arguments{"erase", "-n", "11", "--keep-ids"}, 0),
               std::pair(Arguments{"erase", "-n", "12", "--keep-ids"}, 0), // it has no PWM input
               std::pair(Arguments{"pwm-config", "-n", "11", "--neutral", "1500us"}, 0),
               std::pair(Arguments{"alloc", "--static", "-n", "11", "--id", "30"}, 2));
  set(fleet, {"-n", "11", "servo_id=9", "angle_limit_cw=45deg", "pwm_neutral=1490us"});
  const Document changed = fleet.exported();
  Arguments all = arguments;
  all.emplace_back("-y");
  REQUIRE(fleet.run(all).status == 0);
  const Result undone = undo(fleet);
  INFO(undone.err);
  CHECK(undone.status == 0);
  CHECK(fleet.run({"diff", fleet.file(changed)}).status == 0);
  CHECK(fleet.rom_writes() == saves);
}

TEST_CASE("undo of a saved change brings back what ROM held, not a trial in RAM before it") {
  Fleet fleet(three_servos());
  set(fleet, {"-n", "11", "static_node_id=30", "angle_limit_cw=45deg"});
  const auto arguments = GENERATE(
      Arguments{"set", "-n", "11", "static_node_id=31", "angle_limit_cw=90deg", "--save", "-y"},
      Arguments{"erase", "-n", "11", "--save", "-y"});
  REQUIRE(fleet.run(arguments).status == 0);
  const Result undone = undo(fleet);
  INFO(undone.err);
  CHECK(undone.status == 0);
  for (const char* name : {"static_node_id", "angle_limit_cw"}) {
    const std::int64_t held = name == std::string("static_node_id") ? 11 : 1799;
    CHECK(fleet.ram("11", name) == held);
    CHECK(fleet.rom("11", name) == held);
  }
}

TEST_CASE("node IDs that were exchanged are exchanged back in one undo") {
  Fleet fleet(three_servos());
  const Document before = fleet.exported();
  Document document = before;
  for (const auto* id : {"static_node_id", "servo_id"}) {
    std::swap(document["servos"][0]["set"][id], document["servos"][1]["set"][id]);
  }
  const Result exchanged = fleet.apply(document);
  REQUIRE(exchanged.status == 0);
  CHECK(json(exchanged.out)["nodes"][0]["node_id"] == 11); // not the ID in between
  CHECK(json(exchanged.out)["nodes"][1]["node_id"] == 12);
  const Result undone = undo(fleet);
  INFO(undone.err);
  CHECK(undone.status == 0);
  CHECK(fleet.run({"diff", fleet.file(before)}).status == 0);
  REQUIRE(undo(fleet).status == 0);
  CHECK(fleet.run({"diff", fleet.file(document)}).status == 0);
}

TEST_CASE("undo --dry-run and --no-save do no more than they say") {
  Fleet fleet(three_servos());
  set(fleet, {"-n", "11", "smoothing=off", "--save"});
  CHECK(undo(fleet, {"--dry-run"}).status == 8);
  CHECK(fleet.ram("11", "smoothing") == 0);
  const Result undone = undo(fleet, {"--no-save"});
  CHECK(undone.status == 0);
  CHECK(json(undone.out)["nodes"][0]["saved"] == false);
  CHECK(fleet.ram("11", "smoothing") == 1);
  CHECK(fleet.rom("11", "smoothing") == 0);
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("undo --list shows what is recorded, the newest first, without a bus") {
  Fleet fleet(three_servos());
  CHECK(fleet.run({"undo", "--list"}).out == "no change is recorded\n");
  set(fleet, {"-n", "11,12", "smoothing=off"});
  REQUIRE(undo(fleet, {"-n", "12"}).status == 0);
  const auto snapshots = json(fleet.run({"undo", "--list", "--json"}).out)["snapshots"];
  REQUIRE(snapshots.size() == 3);
  CHECK(snapshots[0]["command"] == "undo");
  CHECK(snapshots[1]["command"] == "set");
  CHECK(snapshots[0]["changed_count"] == 1);
  CHECK(snapshots[0]["changes"] == nlohmann::json::parse(R"([{"address": "0x22",
      "name": "smoothing", "before": 0, "after": 1}])"));
  CHECK(snapshots[1]["changes"][0]["before"] == 1);
  CHECK(snapshots[1]["changes"][0]["after"] == 0);
  CHECK(snapshots[0]["saved"] == false);
  CHECK(keys(ordered_json(snapshots[0].dump())).size() == 7);
  CHECK(snapshots[1]["number"] == snapshots[2]["number"]); // one number a command
  CHECK(snapshots[0]["number"] > snapshots[1]["number"]);
  CHECK(contains(fleet.run({"undo", "--list"}).out, "smoothing"));
  check_error(fleet.run({"undo", "--list", "-n", "11"}), 2, "usage", "--list goes with no other");
  check_error(fleet.run({"undo", "--list", "--to", "1"}), 2, "usage", "--list goes with no other");
}

TEST_CASE("undo --to goes back before a command, on every servo that was changed since") {
  Fleet fleet(three_servos());
  set(fleet, {"-n", "11", "soft_start=off"});
  set(fleet, {"-n", "11,12", "angle_limit_cw=45deg", "--save"});
  const auto number = json(fleet.run({"undo", "--list", "--json"}).out)["snapshots"][0]["number"];
  set(fleet, {"-n", "11", "angle_limit_cw=50deg"});
  set(fleet, {"-n", "13", "smoothing=off"});
  const std::string to = std::to_string(number.get<int>());
  SECTION("of all") {
    CHECK(undo(fleet, {"--to", to, "--dry-run"}).status == 8);
    const Result undone = undo(fleet, {"--to", to});
    INFO(undone.err);
    CHECK(undone.status == 0);
    CHECK(contains(undone.err, "takes back all changes since before command " + to));
    CHECK(fleet.rom("11", "angle_limit_cw") == 1799);
    CHECK(fleet.ram("11", "soft_start") == 0); // by an earlier command, which SAVE has kept
    CHECK(fleet.rom("12", "angle_limit_cw") == 1799);
    CHECK(fleet.ram("13", "smoothing") == 1);
    REQUIRE(undo(fleet).status == 0); // is a change, too
    CHECK(fleet.rom("12", "angle_limit_cw") == 450);
    CHECK(fleet.ram("13", "smoothing") == 0);
  }
  SECTION("of one") {
    REQUIRE(undo(fleet, {"--to", to, "-n", "12"}).status == 0);
    CHECK(fleet.rom("12", "angle_limit_cw") == 1799);
    CHECK(fleet.ram("11", "angle_limit_cw") == 500);
    CHECK(fleet.ram("13", "smoothing") == 0);
  }
  SECTION("what a restart has taken before ROM was changed stays out") {
    set(fleet, {"-n", "13", "timeout_time=500ms"});
    const Options elsewhere{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
    REQUIRE(fleet.run({"restart", "-n", "13", "-y"}, elsewhere).status == 0);
    set(fleet, {"-n", "13", "timeout_time=2s"});
    REQUIRE(fleet.run({"restart", "-n", "13", "-y"}, elsewhere).status == 0);
    set(fleet, {"-n", "13", "reverse=on", "--save"});
    REQUIRE(undo(fleet, {"--to", to, "-n", "13"}).status == 0);
    CHECK(fleet.rom("13", "reverse") == 0);
    CHECK(fleet.rom("13", "smoothing") == 1);
  }
  SECTION("of a servo that has changed too often since") {
    const Arguments more{"set", "-n", "13", "-y", "angle_p_gain=50"};
    for (int i = 0; i < 102; ++i) {
      Arguments each = more;
      each.back() = "angle_p_gain=" + std::to_string(50 + i % 2);
      REQUIRE(fleet.run(each).status == 0);
    }
    check_error(undo(fleet, {"--to", to}), 4, "not_found", "was changed a hundred times since");
  }
  SECTION("that is not recorded") {
    check_error(undo(fleet, {"--to", "99"}), 4, "not_found", "no command with the number 99");
  }
}

TEST_CASE("a change of which nothing is left does not stand in front of the one before it") {
  Fleet fleet(three_servos());
  set(fleet, {"-n", "11", "smoothing=off"});
  set(fleet, {"-n", "11", "angle_limit_cw=45deg"});
  set(fleet, {"-n", "11", "angle_limit_cw=179.9deg"});
  REQUIRE(undo(fleet).status == 0);
  CHECK(fleet.ram("11", "angle_limit_cw") == 450);
  const Options elsewhere{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
  const Arguments restart{"restart", "-n", "11", "-y"};
  REQUIRE(fleet.run(restart, elsewhere).status == 0); // all of it is gone
  set(fleet, {"-n", "11", "smoothing=off", "angle_limit_cw=45deg"});
  REQUIRE(fleet.run(restart, elsewhere).status == 0);
  const Result nothing = undo(fleet);
  CHECK(statuses(nothing) == std::vector<std::string>{"unchanged"});
  const auto snapshots = json(fleet.run({"undo", "--list", "--json"}).out)["snapshots"];
  CHECK(snapshots.size() == 4);
  CHECK(snapshots[0]["command"] == "undo");
}

TEST_CASE("where nothing is recorded, or a servo is missing, undo writes nothing") {
  Fleet fleet(three_servos().servo("BLA21-12U-AB", 20, {{"faults", {{"return_delay", "600s"}}}}));
  check_error(undo(fleet), 4, "not_found", "no change of a servo is recorded");
  set(fleet, {"-n", "11", "smoothing=off"});
  check_error(undo(fleet, {"-n", "12"}), 4, "not_found", "no change of node 12 is recorded");
  set(fleet, {"-n", "12,20", "smoothing=off"});
  REQUIRE(fleet.run({"restart", "-n", "20", "-y"}).status == 4);
  check_error(undo(fleet), 4, "not_found", "which `restart` changed, is not on the bus");
  CHECK(fleet.ram("12", "smoothing") == 0);
  CHECK(undo(fleet, {"-n", "12"}).status == 0);
  CHECK(fleet.ram("12", "smoothing") == 1);
}

TEST_CASE("one servo that fails stops itself only, and can be undone again") {
  Fleet fleet(three_servos().servo("BLA21-12U-AB", 20,
                                   {{"servo_id", 4}, {"faults", {{"refuse_opcodes", true}}}}));
  set(fleet, {"-n", "11", "smoothing=off", "--save"});
  set(fleet, {"-n", "20", "smoothing=off"});
  const Result undone = undo(fleet, {"-n", "11,20"});
  INFO(undone.err);
  CHECK(undone.status == 0);
  REQUIRE(fleet.run({"set", "-n", "11,20", "-y", "smoothing=off", "--save"}).status == 6);
  const Result failed = undo(fleet);
  INFO(failed.err);
  CHECK(failed.status == 0); // where ROM was not changed it is not saved either
  CHECK(statuses(failed) == std::vector<std::string>{"changed", "changed"});
  CHECK(fleet.ram("20", "smoothing") == 1);
}

TEST_CASE("a state folder that cannot be written is a note for undo; a damaged history an error") {
  Fleet fleet(three_servos());
  set(fleet, {"-n", "11", "smoothing=off"});
  const auto folder = fleet.bench().folder() / "state/blactl/simulated";
  const bool is_damaged = GENERATE(false, true);
  std::ofstream(folder / (is_damaged ? "snapshots.db" : "proofs.db"), std::ios::trunc)
      << "no database";
  const Result undone = undo(fleet);
  INFO(undone.err);
  CHECK(undone.status == (is_damaged ? 2 : 0));
  CHECK(contains(undone.err, is_damaged ? "not a blactl change history" : "not recorded"));
  CHECK(fleet.ram("11", "smoothing") == (is_damaged ? 0 : 1));
}

TEST_CASE("undo after a save puts ROM back, too: what was set before it has become lasting") {
  const Fleet fleet(three_servos());
  REQUIRE(fleet.apply(fleet.exported()).status == 0);
  REQUIRE(fleet.run({"set", "-n", "11", "angle_limit_cw=70.0deg"}).status == 0);
  SECTION("by apply") {
    Document document = fleet.exported();
    const Result saved = fleet.apply(document);
    CHECK(statuses(saved) == std::vector<std::string>{"changed", "unchanged", "unchanged"});
  }
  SECTION("by save") {
    REQUIRE(fleet.run({"save", "-n", "11", "-y"}).status == 0);
  }
  const Result undone = fleet.run({"undo", "-n", "11", "-y"});
  INFO(undone.err);
  CHECK(undone.status == 0);
  CHECK(fleet.ram("11", "angle_limit_cw") == 1799);
  CHECK(fleet.rom("11", "angle_limit_cw") == 1799);
}

TEST_CASE("undo takes back the IDs of a trial that an erase has kept, and saved") {
  const Fleet fleet(three_servos());
  const auto servo_id = fleet.rom("11", "servo_id");
  REQUIRE(fleet.run({"set", "-n", "11", "servo_id=77"}).status == 0);
  REQUIRE(fleet.run({"erase", "-n", "11", "--keep-ids", "--save", "-y"}).status == 0);
  REQUIRE(fleet.rom("11", "servo_id") == 77);
  SECTION("both at once") {
    CHECK(fleet.run({"undo", "--to", "1", "-y"}).status == 0);
  }
  SECTION("one after the other") {
    CHECK(fleet.run({"undo", "-y"}).status == 0);
    CHECK(fleet.run({"undo", "-y"}).status == 0);
  }
  CHECK(fleet.ram("11", "servo_id") == servo_id);
  CHECK(fleet.rom("11", "servo_id") == servo_id);
}

TEST_CASE("undo of a unit that there is twice is refused") {
  const nlohmann::json same = {{"unique_id", "00112233445566778899aabbccddeeff"}};
  nlohmann::json second = same;
  second["serial_number"] = 2;
  Fleet fleet(
      Scene().servo("BLA21-12U-AB", 11, same).servo("BLA21-12U-AB", 12, second).joins(2, "10s"));
  REQUIRE(fleet.run({"set", "-n", "11", "smoothing=off", "--save", "-y"}).status == 0);
  REQUIRE(fleet.run({"scan", "--listen", "10"}).status == 9);
  check_error(fleet.run({"undo", "-y"}), 9, "duplicate_unique_id", "nodes 11, 12 have the same");
  CHECK(fleet.rom_writes() == 1);
}

TEST_CASE("undo of a change that another tool has taken back leaves no record of its own") {
  Fleet fleet(three_servos());
  const Options other{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
  set(fleet, {"-n", "11", "angle_p_gain=30", "--save"});
  set(fleet, {"-n", "11", "smoothing=off", "--save"});
  REQUIRE(fleet.run({"set", "-n", "11", "smoothing=on", "--save", "-y"}, other).status == 0);
  CHECK(statuses(undo(fleet)) == std::vector<std::string>{"unchanged"});
  REQUIRE(fleet.run({"set", "-n", "11", "timeout_time=700ms", "--save", "-y"}, other).status == 0);
  CHECK(statuses(undo(fleet)) == std::vector<std::string>{"changed"});
  CHECK(fleet.rom("11", "angle_p_gain") != 30);
  CHECK(fleet.ram("11", "timeout_time") == 700);
}

TEST_CASE("undo of a value whose unit another tool has changed brings back the unit, too") {
  Fleet fleet(three_servos());
  const Options other{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
  const std::int64_t before = fleet.ram("11", "pwm_output_range");
  set(fleet, {"-n", "11", "pwm_output_range=90deg"});
  REQUIRE(fleet.run({"set", "-n", "11", "0x37=1", "0x36=90rpm", "-y"}, other).status == 0);
  REQUIRE(undo(fleet, {"-n", "11"}).status == 0);
  CHECK(fleet.ram("11", "pwm_output_range") == before);
  CHECK(fleet.ram("11", "pwm_mode") == 0);
}

TEST_CASE("undo brings back what a restart took from RAM, where only a proof told of it") {
  Fleet fleet(three_servos());
  const Options other{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
  REQUIRE(fleet.run({"save", "-n", "11", "-y"}).status == 0);
  REQUIRE(fleet.run({"set", "-n", "11", "angle_limit_cw=90deg", "-y"}, other).status == 0);
  REQUIRE(fleet.run({"restart", "-n", "11", "-y"}).status == 0);
  CHECK(fleet.ram("11", "angle_limit_cw") == 1799);
  CHECK(undo(fleet, {"-n", "11"}).status == 0);
  CHECK(fleet.ram("11", "angle_limit_cw") == 900);
}

TEST_CASE(
    "undo of a saved change brings back what a proof knows of ROM, not another tool's trial") {
  Fleet fleet(three_servos());
  const Options other{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
  REQUIRE(fleet.run({"save", "-n", "11", "-y"}).status == 0);
  REQUIRE(fleet.run({"set", "-n", "11", "angle_limit_cw=90deg", "-y"}, other).status == 0);
  REQUIRE(fleet.run({"set", "-n", "11", "angle_limit_cw=45deg", "--save", "-y"}).status == 0);
  CHECK(undo(fleet, {"-n", "11"}).status == 0);
  CHECK(fleet.ram("11", "angle_limit_cw") == 1799);
  CHECK(fleet.rom("11", "angle_limit_cw") == 1799);
}

TEST_CASE("undo of a saved change takes back a named value that RAM alone had held before it") {
  Fleet fleet(three_servos());
  set(fleet, {"-n", "11", "angle_limit_cw=45deg"});
  set(fleet, {"-n", "11", "angle_limit_cw=45deg", "reverse=on", "--save"});
  CHECK(undo(fleet, {"-n", "11"}).status == 0);
  CHECK(fleet.ram("11", "reverse") == 0);
  CHECK(fleet.rom("11", "angle_limit_cw") == 1799);
}

TEST_CASE("undo takes back a SAVE that found its values in RAM already") {
  Fleet fleet(three_servos());
  const auto values_in_rom = [&] {
    CHECK(fleet.run({"restart", "-n", "11,12", "-y"}).status == 0);
    return std::pair(fleet.ram("11", "angle_p_gain"), fleet.ram("12", "angle_p_gain"));
  };
  const auto before = values_in_rom();
  SECTION("after a trial of its own, and for another servo, too") {
    set(fleet, {"-n", "11", "angle_p_gain=9"});
    set(fleet, {"-n", "11,12", "angle_p_gain=9", "--save"});
  }
  SECTION("of a trial that another computer has made") {
    set(fleet, {"-n", "11,12", "angle_p_gain=8", "--save"});
    set(fleet, {"-n", "11", "angle_p_gain=" + std::to_string(before.first), "--save"});
    set(fleet, {"-n", "12", "angle_p_gain=" + std::to_string(before.second), "--save"});
    const Options other{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
    REQUIRE(fleet.run({"set", "-n", "11", "angle_p_gain=9", "-y"}, other).status == 0);
    const bool is_named = GENERATE(true, false);
    is_named ? set(fleet, {"-n", "11,12", "angle_p_gain=9", "--save"})
             : static_cast<void>(fleet.run({"save", "-n", "11", "-y"}));
  }
  CHECK(undo(fleet).status == 0);
  CHECK(values_in_rom() == before);
}

TEST_CASE("a characterize that has put everything back is nothing to undo") {
  Fleet fleet(Scene().servo("BLA21-12U-AB", 11));
  REQUIRE(fleet.run({"characterize", "-n", "11", "-y"}).status == 0);
  check_error(undo(fleet), 4, "not_found", "no change of a servo is recorded");
}

TEST_CASE("undo puts nothing into ROM that was in RAM only") {
  const Fleet fleet(Scene().servo("BLA21-12U-AB", 11, {{"rom", {{"angle_p_gain", 60}}}}));
  const auto value_in_rom = [&] {
    CHECK(fleet.run({"restart", "-n", "11", "-y"}).status == 0);
    return fleet.ram("11", "angle_p_gain");
  };
  const auto does = [&](const Arguments& command) {
    const Result result = fleet.run(command);
    INFO(command.front() << ": " << result.err);
    CHECK(result.status == 0);
  };
  does({"set", "-n", "11", "angle_p_gain=9", "-y"});
  SECTION("a trial that was taken back before SAVE") {
    does({"set", "-n", "11", "angle_p_gain=60", "-y"});
    does({"save", "-n", "11", "-y"});
    does({"undo", "-y"});
    CHECK(value_in_rom() == 60);
  }
  SECTION("a trial after a trial") {
    does({"set", "-n", "11", "angle_p_gain=7", "-y"});
    does({"save", "-n", "11", "-y"});
    does({"undo", "-y"});
    CHECK(value_in_rom() == 60);
  }
}

TEST_CASE(
    "undo takes back an apply that succeeded at the second try, and nothing done in between") {
  const Fleet fleet(
      Scene()
          .servo("BLA21-12U-AB", 11, {{"serial_number", 1}, {"faults", {{"ignore_opcodes", 2}}}})
          .servo("BLA21-12U-AB", 12, {{"serial_number", 2}})
          .servo("BLA21-12U-AB", 13, {{"serial_number", 3}}));
  Document wanted = fleet.exported();
  wanted["servos"].erase(2);
  for (auto& servo : wanted["servos"]) {
    servo["set"]["angle_p_gain"] = 33;
  }
  REQUIRE(fleet.apply(wanted).status == 6);
  REQUIRE(fleet.run({"set", "-n", "13", "angle_p_gain=60", "--save", "-y"}).status == 0);
  SECTION("both of its servos") {
    REQUIRE(fleet.apply(wanted).status == 0);
    REQUIRE(fleet.run({"undo", "-y"}).status == 0);
    CHECK(fleet.rom("11", "angle_p_gain") != 33);
    CHECK(fleet.rom("12", "angle_p_gain") != 33);
  }
  SECTION("but not one that another command has changed since") {
    REQUIRE(fleet.run({"set", "-n", "12", "angle_p_gain=44", "--save", "-y"}).status == 0);
    REQUIRE(fleet.apply(wanted, {"-n", "11"}).status == 0);
    REQUIRE(fleet.run({"undo", "-y"}).status == 0);
    CHECK(fleet.rom("11", "angle_p_gain") != 33);
    CHECK(fleet.rom("12", "angle_p_gain") == 44);
  }
  CHECK(fleet.rom("13", "angle_p_gain") == 60);
}

TEST_CASE("undo of a change in RAM that another tool has saved since puts ROM back, too") {
  const Fleet fleet(three_servos());
  const Options other{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
  set(fleet, {"-n", "11", "angle_limit_cw=45deg"});
  REQUIRE(fleet.run({"monitor", "-n", "11", "--duration", "20"}).status == 0);
  REQUIRE(fleet.run({"save", "-n", "11", "-y"}, other).status == 0);
  const Result undone = undo(fleet);
  INFO(undone.out << undone.err);
  CHECK(undone.status == 0);
  CHECK(json(undone.out)["nodes"][0]["saved"] == true);
  CHECK(fleet.rom("11", "angle_limit_cw") == 1799);
}
