// blactl pwm-config of the built binary.

#include "catch.hpp"
#include "scene.hpp"

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

const std::vector<std::string> mapping_keys{
    "neutral_us",   "range_us", "output_range_raw",  "mode",       "unit",  "pulse_min_us",
    "pulse_max_us", "input",    "fallback_after_ms", "cut_off_us", "points"};

} // namespace

TEST_CASE("pwm-config has exactly the keys of the contract, in their order") {
  const Result result = three_servos().run({"pwm-config", "-n", "11", "-j"});
  CHECK(result.status == 0);
  auto expected =
      std::vector<std::string>{"node_id",  "unique_id",        "model",           "serial_number",
                               "servo_id", "firmware_version", "hardware_version"};
  expected.insert(expected.end(), mapping_keys.begin(), mapping_keys.end());
  const auto node = ordered_json(result.out)["nodes"][0];
  CHECK(keys(node) == expected);
  CHECK(node["pulse_min_us"] == 820);
  CHECK(node["pulse_max_us"] == 2220);
  CHECK(node["unit"] == "deg");
  CHECK(node["input"] == "none");
  CHECK(node["fallback_after_ms"] == 1000);
  CHECK(node["points"].front().dump() == R"({"pulse_us":820,"command":-70.0})");
  CHECK(node["points"].back().dump() == R"({"pulse_us":2220,"command":70.0})");
}

TEST_CASE("the mapping is changed as a whole, and shown before and after") {
  const Result result =
      three_servos().run({"pwm-config", "-n", "11", "--preset", "3", "--save", "-y", "-j"});
  CHECK(result.status == 0);
  const auto node = ordered_json(result.out)["nodes"][0];
  CHECK(node["pulse_min_us"] == 500);
  CHECK(node["before"]["pulse_min_us"] == 820);
  CHECK(keys(node["before"]) == mapping_keys);
  CHECK(node["saved"] == true);
  REQUIRE(node["changes"].size() == 4);
  CHECK(node["changes"][0]["after"] == 1000);
  CHECK(node["changes"][3]["status"] == "unchanged");
}

TEST_CASE("every way to say the same mapping gives the same changes") {
  const auto changes = [](const Arguments& more) {
    Arguments arguments{"pwm-config", "-n", "11", "-j"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result result = three_servos().run(arguments);
    INFO(result.err);
    CHECK(result.status == 0);
    return json(result.out)["nodes"][0]["points"].dump();
  };
  const auto preset = changes({"--preset", "4"});
  CHECK(preset == changes({"--neutral", "1520us", "--range", "700us", "--output", "150rpm",
                           "--mode", "speed"}));
  CHECK(preset == changes({"--endpoints", "820us:-150rpm,2220us:150rpm"}));
}

TEST_CASE("what is at the input is told as the new mapping sees it, or not at all") {
  const Bench bench;
  const nlohmann::json scenario{
      {"schema", "blactl-scenario/1"},
      {"clock", "virtual"},
      {"servos", {{{"model", "BLA21-12U-AB"}, {"node_id", 11}, {"serial_number", 7}}}},
      {"events", {{{"at", "100ms"}, {"servo", 7}, {"world", {{"pulse", "1900us"}}}}}}};
  const std::string interface = "sim:" + bench.file("s.json", scenario.dump());
  const auto node = [&](const char* more) {
    const Result result =
        bench.run({"-i", interface, "pwm-config", "--range", "100us", "-y", "-j", more});
    return json(result.out)["nodes"][0];
  };
  const auto changed = node("-q");
  CHECK(changed["before"]["input"] == "ok");
  CHECK(changed["input"] != "ok");
  CHECK(changed["input"].is_string());
  const auto planned = node("--dry-run");
  CHECK(planned["before"]["input"] == "ok");
  CHECK(planned["input"].is_null());
}

TEST_CASE("--dry-run changes nothing and shows both mappings") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  const Result dry =
      bench.run({"-i", "sim:", "pwm-config", "-n", "11", "--output", "140deg", "--dry-run"});
  CHECK(dry.status == 8);
  CHECK(contains(dry.out, "before   820 us -70.0 deg, 1520 us 0.0 deg, 2220 us 70.0 deg"));
  CHECK(contains(dry.out, "140.0 deg"));
  const Result now = bench.run({"-i", "sim:", "pwm-config", "-n", "11", "-j"});
  CHECK(json(now.out)["nodes"][0]["output_range_raw"] == 700);
}

TEST_CASE("a servo without a PWM input is refused") {
  for (const Arguments& more :
       {Arguments{}, Arguments{"--preset", "1"}, Arguments{"--output", "0deg"}}) {
    Arguments arguments{"pwm-config", "-n", "12"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result result = three_servos().run(arguments);
    CHECK(result.status == 2);
    CHECK(codes(result) == std::vector<std::string>{"unsupported"});
  }
}

TEST_CASE("what contradicts itself or cannot be held is refused before any frame, with a way on") {
  struct Case {
    Arguments arguments;
    const char* said;
  };

  const Case cases[]{
      {{"--preset", "1", "--output", "70deg"}, "one of three ways"},
      {{"--preset", "1", "--output", "70deg"},
       "\n  for example --preset 1, or --range 700us --output 70deg\n"},
      {{"--preset", "5"}, "between 1 and 4"},
      {{"--mode", "speed"}, "--mode speed without --output"},
      {{"--mode", "fast"},
       "--mode fast: unknown word, this parameter takes angle (0) or speed (1)\n"},
      {{"--mode", "fast", "--output", "70deg"},
       "--mode fast: unknown word, this parameter takes angle (0) or speed (1)\n"},
      {{"--mode", "speed", "--output", "70deg"},
       "--output 70deg: with --mode speed the unit is rpm\n"
       "  type --output 70rpm, or --mode angle --output 70.0deg\n"},
      {{"--mode", "angle", "--output", "400rpm"},
       "the unit is deg\n  type --mode speed --output 400rpm\n"}, // 400 deg there is not
      {{"--output", "400deg"},
       "--output 400.0deg: outside of the range 0.0deg to 360.0deg\n"
       "  models with a PWM input take 0.0deg to 360.0deg\n"},
      {{"--output", "-60deg,70deg"}, "one positive value"},
      {{"--output", "70"}, "unit"},
      {{"--output", "70.05deg"}, "steps of 0.1deg"},
      {{"--output=-70deg"}, "range"},
      {{"--neutral", "1520.5us"}, "steps of 1us"},
      {{"--endpoints", "500us:-70deg,1501us:70deg"}, "1502us"},
      {{"--endpoints", "500us:-60deg,1500us:70deg"}, "symmetric"},
      {{"--endpoints", "1000us:0deg,2000us:90deg"},
       "--neutral 1000us --range 1000us --output 90.0deg"},
      {{"--endpoints", "1us:-70deg,3us:70deg"},
       "--endpoints, neutral 2us: outside of the range 100us to 10000us\n"
       "  the nearest that is possible: --endpoints 90us:-70.0deg,110us:70.0deg\n"},
      {{"--endpoints", "500us:-70.05deg,1500us:70.05deg"},
       "--endpoints, -70.05deg: the register counts in steps of 0.1deg\n"
       "  type -70.0deg or -70.1deg\n"},
      {{"--endpoints", "500us:-400deg,1500us:300deg"},
       "--endpoints, -400.0deg: outside of the range -360.0deg to 360.0deg\n"},
      {{"--endpoints", "9223372036854775807us:-70deg,9223372036854775806us:70deg"},
       "--endpoints, 9223372036854775807us: outside of the range 0us to 20000us\n"},
      {{"--output", "70rpm"},
       "node 11: --output 70rpm: this servo has --mode angle, the unit is deg\n"
       "  type --output 70.0deg, or --mode speed --output 70rpm\n"},
      {{"--save"}, "nothing to change"},
  };
  for (const Case& each : cases) {
    Arguments arguments{"pwm-config", "-n", "11"};
    arguments.insert(arguments.end(), each.arguments.begin(), each.arguments.end());
    const Result result = three_servos().run(arguments);
    INFO(each.arguments.back() << "\n" << result.err);
    CHECK(result.status == 2);
    CHECK(contains(result.err, each.said));
    CHECK(result.out.empty());
  }
}

TEST_CASE("in speed mode it is told that pulses move nothing while speed control is off") {
  const auto said = [](const char* control) {
    return Scene()
        .servo("BLA21-12U-AB", 11,
               {{"ram", {{"pwm_mode", "speed"}, {"speed_torque_control", control}}}})
        .run({"pwm-config"})
        .out;
  };
  CHECK(contains(said("off"), "pulses have no effect while speed_torque_control is off"));
  CHECK_FALSE(contains(said("on"), "have no effect"));
}

TEST_CASE("limits that cut the mapping off are told, and so are commands that PWM speed lacks") {
  const auto servo = Scene().servo("BLA21-12U-AB", 11, {{"ram", {{"angle_limit_cw", "30deg"}}}});
  const Result shown = servo.run({"pwm-config"});
  CHECK(contains(shown.out, "above 1820 us it stays at 30.0 deg"));
  CHECK(contains(shown.out, "48.0 deg, limited to 30.0 deg"));
  const Result speed = servo.run({"pwm-config", "--preset", "4", "-j"});
  CHECK(json(speed.out)["nodes"][0]["warnings"][0]["code"] == "pwm_needs_switch");
}

TEST_CASE("the plot draws what the servo does, and tells its signs") {
  const auto plot = [](const nlohmann::json& ram) {
    return Scene()
        .servo("BLA21-12U-AB", 11, {{"ram", ram}})
        .run({"pwm-config"}, {.env = {{"LC_ALL", "C"}}})
        .out;
  };
  const auto row_of = [](const std::string& text, const std::string& label) {
    const auto begin = text.find("  " + label + ' ', text.find("\n\n"));
    return text.substr(begin, text.find('\n', begin) - begin);
  };
  const std::string whole = plot({{"pwm_neutral", "1520us"}});
  CHECK(contains(row_of(whole, "70.0 deg"), "*"));
  CHECK_FALSE(contains(whole, "within the limits"));
  SECTION("the end that a limit cuts off is not reached, however near it is") {
    const std::string cut = plot({{"angle_limit_cw", "66deg"}});
    CHECK_FALSE(contains(row_of(cut, "70.0 deg"), "*"));
    CHECK(contains(row_of(cut, "70.0 deg"), "."));
    CHECK(contains(cut, "* within the limits   . what the limits cut off\n"));
  }
  SECTION("no pulse is shorter than 0") {
    const std::string early = plot({{"pwm_neutral", "500us"}, {"angle_limit_ccw", "-60deg"}});
    CHECK_FALSE(contains(row_of(early, "-70.0 deg"), "*"));
    CHECK_FALSE(contains(early, "-100 us"));
    CHECK_FALSE(contains(early, "it stays at")); // 0 us is -50 deg
  }
}

TEST_CASE("the plot is drawn with what the terminal can show") {
  const auto plot = [](const char* locale) {
    return three_servos().run({"pwm-config", "-n", "11"}, {.env = {{"LC_ALL", locale}}}).out;
  };
  CHECK(contains(plot("C.UTF-8"), "●"));
  CHECK_FALSE(contains(plot("C"), "●"));
  CHECK(contains(plot("C"), "*"));
  CHECK(longest_line(plot("C")) <= 80);
}

TEST_CASE("--svg draws one servo, as a whole or not at all") {
  CHECK(contains(three_servos().run({"pwm-config", "-n", "11", "--svg", "-"}).err,
                 "--svg needs a file: standard output is for data\n  for example --svg "
                 "mapping.svg\n"));
  const Bench bench;
  const std::string file = (bench.folder() / "map.svg").string();
  const Result drawn = three_servos().run(bench, {"pwm-config", "-n", "11", "--svg", file});
  CHECK(drawn.status == 0);
  CHECK(drawn.err == "blactl: the drawing is in " + file + '\n');
  CHECK(three_servos().run(bench, {"pwm-config", "-q", "-n", "11", "--svg", file}).err.empty());
  const std::string other = bench.file("fleet.json", "{}");
  CHECK(three_servos().run(bench, {"pwm-config", "-n", "11", "--svg", other}).status == 2);
  CHECK(content(other) == "{}");
  const std::string svg = content(file);
  CHECK(svg.starts_with("<?xml"));
  CHECK(svg.ends_with("</svg>\n"));
  CHECK(contains(svg, "2220 us"));
  const Result two = three_servos().run(bench, {"pwm-config", "-n", "11,13", "--svg", file});
  CHECK(two.status == 2);
  CHECK(two.out.empty());
  CHECK(content(file) == svg);
  const std::string folder = (bench.folder() / "none").string();
  const Result nowhere =
      three_servos().run(bench, {"pwm-config", "-n", "11", "--svg", folder + "/map.svg"});
  CHECK(nowhere.status == 1);
  CHECK(codes(nowhere) == std::vector<std::string>{"io"});
  CHECK_FALSE(std::filesystem::exists(folder));
}

TEST_CASE("a drawing that could not be kept is refused before anything is changed") {
  const Bench bench;
  const std::string file = (bench.folder() / "none" / "map.svg").string();
  const Result result =
      three_servos().run(bench, {"pwm-config", "-n", "11", "--preset", "2", "-y", "--svg", file,
                                 "--record", (bench.folder() / "bus.log").string()});
  CHECK(result.status == 1);
  CHECK(codes(result) == std::vector<std::string>{"io"});
  CHECK(result.out.empty());
  CHECK_FALSE(std::filesystem::exists(bench.folder() / "bus.log")); // it did not even join
}
