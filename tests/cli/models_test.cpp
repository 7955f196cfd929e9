#include "catch.hpp"
#include "scene.hpp"

#include <filesystem>
#include <map>
#include <utility>

using namespace blactl::test;

TEST_CASE("models lists every built-in model without any bus") {
  const Result result = run({"models"});
  CHECK(result.status == 0);
  CHECK(result.err.empty());
  for (const char* model :
       {"BLA15-06U-A0", "BLA15-12U-A0", "BLA21-06U-A0", "BLA21-06U-AB", "BLA21-12U-A0",
        "BLA21-12U-AB", "BLA21-28U-A0", "BLA21-28U-AB", "BLA34-12U-AB", "BLA34-28U-AB"}) {
    CHECK(contains(result.out, model));
  }
  CHECK(contains(result.out, "61 / 12.050              with PWM input\n"));
  CHECK(contains(result.out, "62 / 6.010               without PWM input\n"));
}

TEST_CASE("models --json has exactly the keys of the contract, in their order") {
  const Result result = run({"models", "--json"});
  CHECK(result.status == 0);
  const auto document = ordered_json(result.out);
  CHECK(keys(document) == std::vector<std::string>{"schema", "command", "interface", "exit_status",
                                                   "models", "fault_bits", "firmware",
                                                   "cross_checks", "counts", "errors"});
  CHECK(document["interface"].is_null());
  REQUIRE(document["models"].size() == 10);
  for (const auto& model : document["models"]) {
    CHECK(keys(model) == std::vector<std::string>{"model", "series", "voltage_class", "suffix",
                                                  "pwm", "model_number", "hardware_version",
                                                  "parameters"});
    for (const auto& parameter : model["parameters"]) {
      CHECK(keys(parameter) == std::vector<std::string>{"address", "name", "name_en", "name_ja",
                                                        "vendor_label", "group", "access", "unit",
                                                        "scale", "default", "min", "max", "saved",
                                                        "min_firmware", "enumeration", "section",
                                                        "see", "meaning_en", "meaning_ja"});
      CHECK_FALSE(std::string(parameter["meaning_en"]).empty());
      CHECK_FALSE(std::string(parameter["meaning_ja"]).empty());
      for (const auto& choice : parameter["enumeration"]) {
        CHECK(keys(choice) == std::vector<std::string>{"raw", "word", "text_en", "text_ja"});
      }
      const std::string access = parameter["access"];
      CHECK((access == "R" || access == "W" || access == "RW"));
      CHECK(parameter["address"] != "0x03"); // reserved
    }
  }
  REQUIRE_FALSE(document["fault_bits"].empty());
  for (const auto& bit : document["fault_bits"]) {
    CHECK(keys(bit) == std::vector<std::string>{"register", "bit", "level", "group", "code",
                                                "pwm_only", "latched", "vendor_only", "text_en",
                                                "text_ja", "condition_en", "condition_ja",
                                                "action_en", "action_ja", "output_off"});
  }
}

TEST_CASE("models MODEL PARAM narrows to one register of one model") {
  const auto document = json(run({"models", "BLA21-12U-AB", "0x2A", "-j"}).out);
  REQUIRE(document["models"].size() == 1);
  REQUIRE(document["models"][0]["parameters"].size() == 1);
  const auto parameter = document["models"][0]["parameters"][0];
  CHECK(parameter["name"] == "overcurrent_limit");
  CHECK(parameter["unit"] == "A");
  CHECK(parameter["scale"] == 0.1);
  CHECK(parameter["default"] == 63);
  CHECK(parameter["min"] == 35);
  CHECK(parameter["max"] == 70);
  CHECK(parameter["saved"] == true);
  CHECK(parameter["min_firmware"] == 1100);
  CHECK(parameter["enumeration"].empty());

  const Result text = run({"models", "BLA21-12U-AB2", "overcurrent-limit"});
  CHECK(text.status == 0);
  CHECK(contains(text.out, "firmware 1.100 or later"));
  CHECK(contains(text.out, "  6.3 A    3.5 .. 7.0 A  BLA21-12U-AB\n"));
}

TEST_CASE("a model's beginning is enough") {
  CHECK(json(run({"models", "bla21-12", "-j"}).out)["models"].size() == 2);
  CHECK(json(run({"models", "all", "0x38", "-j"}).out)["models"].size() == 10);
}

TEST_CASE("models refuses what it does not know") {
  const Result model = run({"models", "BLA99"});
  CHECK(model.status == 2);
  CHECK(contains(model.err, "[usage] there is no model 'BLA99'\n  the models are BLA15-06U-A0, "));
  const Result parameter = run({"models", "BLA21", "angel_limit_cw"});
  CHECK(parameter.status == 2);
  CHECK(contains(parameter.err, "[unknown_parameter] angel_limit_cw: there is no such parameter\n"
                                "  did you mean angle_limit_cw"));
}

TEST_CASE("models speaks both languages, with the same names") {
  CHECK(contains(run({"models", "BLA21-12U-AB"}).out, "angle_limit_cw"));
  const Result japanese = run({"models", "BLA21-12U-AB", "--lang", "ja"});
  CHECK(contains(japanese.out, "angle_limit_cw"));
  CHECK(contains(japanese.out, "現在角度"));
  CHECK(run({"models", "-j", "--lang", "ja"}).out == run({"models", "-j"}).out);
}

TEST_CASE("a model of --profile-dir is known to models and to the servos that are it") {
  const Bench bench;
  std::filesystem::copy(std::filesystem::path(BLACTL_PROFILES) / "BLA34.json", bench.folder());
  const Result result = bench.run({"models", "BLA34", "--profile-dir", bench.folder(), "-j"});
  CHECK(result.status == 0);
  CHECK(json(result.out)["models"].size() == 2);
}

TEST_CASE("a range names only the words that the model takes") {
  const Result result = run({"models", "BLA21-12U", "pwm_mode"});
  CHECK(contains(result.out, "  -        without PWM input  BLA21-12U-A0\n"));
  CHECK(contains(result.out, "  angle    angle, speed       BLA21-12U-AB\n"));
}

TEST_CASE("models MODEL tells of a fault register what its bits mean and what to do") {
  const Result warnings = run({"models", "BLA21-12U-AB", "0x1A"});
  CHECK(warnings.status == 0);
  CHECK(contains(warnings.out,
                 "bit 8: Temperature upper limit [temperature_high], holds the output off\n"
                 "      [0x0B] Current Temperature at or above [0x3E] Operation "
                 "Temperature Upper Limit\n      Reduce load or check 0x3E"));
  CHECK(contains(warnings.out, "[rom_corrupt], stays until the next start\n"));
  CHECK(contains(run({"models", "all", "0x19"}).out, "[pwm_missing], models with a PWM input"));
  CHECK(contains(run({"models", "all", "0x1B"}).out, "bit 9: Watchdog [watchdog]"));
  CHECK(contains(run({"models", "all", "0x18"}).out,
                 "  bit 25: 0x1A has a warning about something else (bits 24-31)\n"
                 "  bit 26: 0x1B has a failure about something else (bits 24-31)\n"
                 "  `blactl faults` tells which.\n"));
  CHECK(contains(run({"models", "BLA21", "0x1A", "--lang", "ja"}).out, "制限温度上限"));
}

TEST_CASE("models --json has the bits of all four registers, and the firmware history") {
  const auto document = json(run({"models", "-j"}).out);
  std::map<std::string, int> bits;
  for (const auto& bit : document["fault_bits"]) {
    ++bits[bit["register"]];
    CHECK(bit["code"].is_null() == (bit["register"] == "0x18"));
  }
  CHECK(bits == std::map<std::string, int>{{"0x18", 12}, {"0x19", 9}, {"0x1A", 9}, {"0x1B", 8}});
  REQUIRE(document["firmware"].size() == 6);
  CHECK(document["firmware"][5]["version"] == 1500);
  CHECK(document["firmware"][5]["shipments"][0]["models"] == "BLA34-**U-AB1");
  CHECK(document["firmware"][5]["shipments"][0]["until"].is_null());
}

TEST_CASE("models MODEL tells which firmware mends what, and when it was shipped") {
  const Result result = run({"models", "BLA21-12U-AB"});
  CHECK(contains(result.out, "1.400     2024-06 ..          Fixed: servo stalled"));
  CHECK(contains(result.out, "1.200     2022-05 .. 2023-12  [0x2F] angle control boost"));
  CHECK_FALSE(contains(result.out, "BLA34"));
}

TEST_CASE("models shows units, also those of the production date") {
  for (const auto& [address, unit] : {std::pair{"0x58", "year"},
                                      {"0x59", "month"},
                                      {"0x5A", "day"},
                                      {"0x5B", "hour"},
                                      {"0x5C", "minute"}}) {
    CHECK(contains(run({"models", "BLA34", address}).out, std::string("unit ") + unit));
    const auto document = json(run({"models", "BLA34", address, "-j"}).out);
    CHECK(document["models"][0]["parameters"][0]["unit"] == unit);
  }
  CHECK(contains(run({"models", "BLA34", "0x38"}).out, "unit deg, in steps of 0.1\n"));
}

TEST_CASE("models says why node IDs within the range are refused") {
  CHECK(contains(run({"models", "BLA34", "static_node_id"}).out,
                 "126 and 127 are reserved for tools"));
}

TEST_CASE("models says of a model without PWM input that it has none") {
  const Result one = run({"models", "BLA15-12U-A0", "0x34"});
  CHECK(contains(one.out, "  -        without PWM input  BLA15-12U-A0\n"));
  CHECK_FALSE(contains(one.out, "10000"));
  CHECK(contains(run({"models", "BLA15-12U-A0"}).out,
                 "pwm_neutral             RW      -           without PWM input"));
}

TEST_CASE("models tells both faults of its arguments") {
  CHECK(codes(run({"models", "BLA99", "foo"})) ==
        std::vector<std::string>{"usage", "unknown_parameter"});
}

TEST_CASE("on a terminal of 80 columns no line of a table is longer") {
  const Options terminal{.terminal = true, .terminal_stdout = true, .columns = 80};
  for (const Arguments& command : {Arguments{"models"},
                                   {"models", "BLA21-12U-AB"},
                                   {"models", "BLA21-12U-AB", "--lang", "ja"},
                                   {"models", "all", "0x1A"},
                                   {"models", "all", "0x19", "--lang", "ja"},
                                   {"models", "all", "0x25"}}) {
    const Result result = run(command, terminal);
    CHECK(longest_line(result.out) <= 80);
    CHECK(is_fit_for_a_terminal(result.out));
  }
  const Result wide = run({"models", "BLA21-12U-AB"});
  CHECK(longest_line(wide.out) > 80);
}

TEST_CASE("models PARAM is the data sheet of a parameter, over all models") {
  const Result sheet = run({"models", "0x2A"});
  CHECK(sheet.status == 0);
  CHECK(run({"models", "overcurrent-limit"}).out == sheet.out);
  CHECK(run({"models", "all", "overcurrent_limit"}).out == sheet.out);
  CHECK(contains(sheet.out, "0x2A  overcurrent_limit  Overcurrent protection Current value\n"
                            "  The highest current that the motor may draw. "));
  CHECK(contains(sheet.out, "  specification: section 4.20\n"));
  CHECK(contains(sheet.out, "  12.0 A   6 .. 12 A     BLA21-06U\n"));
  CHECK(contains(sheet.out, "  2.4 A    1.6 .. 3.2 A  BLA21-28U\n"));
}

TEST_CASE("a parameter's sheet tells what a change meets, and what it works together with") {
  const Result sheet = run({"models", "pwm_mode"});
  CHECK(contains(sheet.out, "  speed (1): "));
  CHECK(contains(sheet.out, "\nWhen it is changed, where this applies:\n  asked first: "));
  CHECK(contains(sheet.out, "  warning: "));
  CHECK(contains(sheet.out, "\nSee also: 0x36 pwm_output_range, 0x25 speed_torque_control\n"));
  CHECK(contains(run({"models", "command_speed"}).out, "  refused: "));
  CHECK(contains(sheet.out, "without PWM input  BLA15, BLA21-**U-A0\n"));
}

TEST_CASE("models all puts the models side by side") {
  const Result all = run({"models", "all"});
  CHECK(all.status == 0);
  const auto differ = all.out.find("Where they differ (default, range, models):\n");
  REQUIRE(differ != std::string::npos);
  CHECK(all.out.find("angle_limit_cw") < differ);
  CHECK(all.out.find("overcurrent_limit") > differ);
  CHECK(contains(run({"models", "BLA34"}).out, "BLA34\nWhat they have in common:\n"));
}

TEST_CASE("models puts those that are named side by side, with one parameter or without") {
  const Result two = run({"models", "BLA15", "BLA34"});
  CHECK(two.status == 0);
  CHECK(contains(two.out, "What they have in common:"));
  CHECK_FALSE(contains(two.out, "BLA21"));
  CHECK(json(run({"models", "BLA15", "BLA34", "-j"}).out)["models"].size() ==
        json(run({"models", "BLA15", "-j"}).out)["models"].size() +
            json(run({"models", "BLA34", "-j"}).out)["models"].size());
  CHECK(contains(run({"models", "angle_limit_cw", "BLA15", "BLA34"}).out, "angle_limit_cw"));
  const Result parameters = run({"models", "angle_limit_cw", "smoothing"});
  CHECK(parameters.status == 2);
  CHECK(contains(parameters.err, "one parameter only: smoothing is another one"));
  CHECK(run({"models", "BLA21", "BLA99"}).status == 2);
}

TEST_CASE("models --search looks into names and explanations, of both languages") {
  const auto found = [](const char* word) {
    std::vector<std::string> names;
    const auto document = json(run({"models", "BLA21-12U-AB", "--search", word, "-j"}).out);
    for (const auto& parameter : document["models"][0]["parameters"]) {
      names.push_back(parameter["name"]);
    }
    return names;
  };
  CHECK(found("Soft") == std::vector<std::string>{"soft_start"});
  CHECK_FALSE(found("slow").empty());
  CHECK_FALSE(found("電圧").empty());
  const Result shown = run({"models", "--search", "soft start"});
  CHECK(shown.status == 0);
  CHECK(contains(shown.out, "soft_start"));
  CHECK_FALSE(contains(shown.out, "angle_limit_cw"));
  const Result nothing = run({"models", "--search", "xyzzy"});
  CHECK(nothing.status == 4);
  CHECK(contains(nothing.err, "no parameter has 'xyzzy' in its name or explanation"));
}

TEST_CASE("groups may be a list") {
  const auto count = [](const char* groups) {
    return json(run({"models", "BLA21-12U-AB", "--group", groups, "-j"})
                    .out)["models"][0]["parameters"]
        .size();
  };
  CHECK(count("limit,pwm") == count("limit") + count("pwm"));
  CHECK(run({"models", "--group", "limit,what"}).status == 2);
  CHECK(run({"models", "--group", "limit,"}).status == 2);
}

TEST_CASE("models has no bus, and says that options about one do nothing") {
  CHECK(run({"models", "-i", "can9", "--retries", "3"}).out == run({"models"}).out);
  CHECK(contains(run({"models", "--help"}).out, "It uses no bus: options about the bus"));
  CHECK_FALSE(contains(run({"get", "--help"}).out, "It uses no bus"));
}

TEST_CASE("who made the servo has one name, and notes of a bit are set off as the language does") {
  const Result english = run({"models", "0x1A"});
  CHECK(contains(english.out, "ask the manufacturer."));
  CHECK_FALSE(contains(english.out, "vendor"));
  CHECK(contains(english.out, "[rom_corrupt], stays until the next start\n"));
  CHECK(contains(run({"models", "0x1A", "--lang", "ja"}).out, "[rom_corrupt]、次回起動時まで"));
}

TEST_CASE("an address and its name are not divided between two lines") {
  const Options terminal{.terminal = true, .terminal_stdout = true, .columns = 80};
  const Result sheet = run({"models", "speed_torque_control"}, terminal);
  CHECK(contains(sheet.out, "0x3A speed_limit_cw"));
  CHECK(contains(sheet.out, "0x3D torque_limit_ccw"));
}

TEST_CASE("models --group shows the parameters of a group") {
  const Result group = run({"models", "BLA34-12U", "--group", "pwm"});
  CHECK(group.status == 0);
  CHECK(contains(group.out, "pwm_neutral"));
  CHECK_FALSE(contains(group.out, "angle_limit_cw"));
  CHECK(contains(run({"models", "--group", "pwm"}).out,
                 "Where they differ (default, range, models):\n"));
  const auto document = json(run({"models", "--group", "pwm", "-j"}).out);
  CHECK(document["models"][0]["parameters"].size() == 4);
  const Result both = run({"models", "0x2A", "--group", "pwm"});
  CHECK(both.status == 2);
  CHECK(contains(both.err, "[usage] a parameter, or --group and --search: not both\n"));
}

TEST_CASE("what is neither a model nor a parameter is refused as what it looks like") {
  CHECK(contains(run({"models", "angel_limit_cw"}).err,
                 "[unknown_parameter] angel_limit_cw: there is no such parameter\n"
                 "  did you mean angle_limit_cw"));
  CHECK(contains(run({"models", "bla7", "0x38"}).err, "[usage] there is no model 'bla7'\n"));
}
