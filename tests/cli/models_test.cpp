#include "catch.hpp"
#include "scene.hpp"

#include <filesystem>

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
  CHECK(contains(result.out, "61 / 12050   PWM input\n"));
  CHECK(contains(result.out, "62 / 6010    no PWM input\n"));
}

TEST_CASE("models --json has exactly the keys of the contract, in their order") {
  const Result result = run({"models", "--json"});
  CHECK(result.status == 0);
  const auto document = ordered_json(result.out);
  CHECK(keys(document) == std::vector<std::string>{"schema", "command", "interface", "exit_status",
                                                   "models", "fault_bits", "counts", "errors"});
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
                                                        "min_firmware", "enumeration"});
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
                                                "pwm_only", "text_en", "text_ja", "condition_en",
                                                "condition_ja", "action_en", "action_ja"});
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
  CHECK(contains(text.out, "BLA21-12U-AB  6.3 A    3.5 .. 7.0 A\n"));
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
  CHECK(contains(result.out, "BLA21-12U-A0  angle    angle\n"));
  CHECK(contains(result.out, "BLA21-12U-AB  angle    angle, speed\n"));
}
