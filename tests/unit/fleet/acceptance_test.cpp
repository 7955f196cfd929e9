#include "blactl/base/sha256.hpp"
#include "blactl/bla/config_sha256.hpp"
#include "blactl/fleet/line/line_record.hpp"

#include "catch.hpp"
#include "fleet/line/acceptance.hpp"
#include "unit/fleet/support.hpp"

#include <string>
#include <string_view>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

/// What a simulated servo of this model says of itself: firmware 1.400, serial number 7.
Servo a_unit(std::string_view model = "BLA21-12U-AB") {
  const Scene scene(
      fmt::format(R"("servos": [{{"model": "{}", "node_id": 11, "serial_number": 7}}])", model));
  return scene.read(11, registers({"servo_id"})).servo;
}

Recipe recipe_of(std::string_view more = R"("firmware_min": 1400, "set": {"servo_id": 1})") {
  const auto recipe = parse_recipe(
      fmt::format(R"({{"schema": "blactl-recipe/1", "name": "a", "model": "BLA21-12U", {}}})",
                  more),
      "recipe.json", profiles());
  INFO((recipe ? "" : recipe.error().message));
  REQUIRE(recipe);
  return *recipe;
}

Label label_of(std::string_view line) {
  const auto label = parse_label(line, 1, profiles());
  REQUIRE(label);
  return *label;
}

std::string code_of(const std::optional<Error>& error) {
  return error ? std::string(name(error->code)) : "";
}

std::vector<std::string> texts_of(const std::vector<bla::Assignment>& set) {
  std::vector<std::string> all;
  for (const bla::Assignment& each : set) {
    all.push_back(fmt::format("{}={}", each.parameter->name, each.value.raw));
  }
  return all;
}

} // namespace

TEST_CASE("a unit is what the recipe and the label say, or it is put aside") {
  const Servo unit = a_unit();
  const Label right = label_of("7"), wrong = label_of("8"), none = label_of("{}");
  CHECK(code_of(check_unit(unit, recipe_of(), nullptr, profiles())).empty());
  CHECK(code_of(check_unit(unit, recipe_of(), &right, profiles())).empty());
  CHECK(code_of(check_unit(unit, recipe_of(), &none, profiles())).empty());
  CHECK(code_of(check_unit(unit, recipe_of(), &wrong, profiles())) == "label_mismatch");
  const Recipe newer = recipe_of(R"("firmware_min": 1401, "set": {})");
  const auto old = check_unit(unit, newer, &right, profiles());
  CHECK(code_of(old) == "firmware_too_old");
  CHECK(old->message == "its firmware is 1.400, the recipe needs 1.401 or later");
  CHECK(old->node_id == 11);
  CHECK(code_of(check_unit(a_unit("BLA15-12U-A0"), recipe_of(), &right, profiles())) ==
        "model_mismatch");
  CHECK(code_of(check_unit(a_unit("BLA21-28U-AB"), recipe_of(), &right, profiles())) ==
        "model_mismatch");
}

TEST_CASE("what a unit did not tell is not taken for right") {
  const Servo silent;
  CHECK(code_of(check_unit(silent, recipe_of(), nullptr, profiles())) == "model_mismatch");
  Servo unit = a_unit();
  bla::Readings readings = unit.identity.readings();
  readings.firmware_version.reset();
  readings.serial_number.reset();
  unit.identity = bla::Identity(profiles(), readings);
  CHECK(code_of(check_unit(unit, recipe_of(), nullptr, profiles())) == "timeout");
  const Label label = label_of("7");
  CHECK(code_of(check_unit(unit, recipe_of(R"("set": {})"), &label, profiles())) == "timeout");
}

TEST_CASE("IDs are those of the label, else of the counters, else of the recipe") {
  const Recipe recipe = recipe_of(R"("set": {"servo_id": {"first": 1, "last": 8, "at_end": "again"},
      "static_node_id": 50, "angle_limit_cw": "45deg"})");
  const auto counted = ids_wished(recipe, nullptr);
  REQUIRE(counted.size() == 1);
  CHECK(counted[0].parameter == "servo_id");
  CHECK_FALSE(counted[0].value);
  CHECK(counted[0].last == 8);
  CHECK(counted[0].begins_again);
  CHECK(texts_of(*settings_for(recipe, counted, std::vector<std::int64_t>{5}, profiles())) ==
        std::vector<std::string>{"angle_limit_cw=450", "servo_id=5", "static_node_id=50"});

  const Label label = label_of(R"({"servo_id": 3, "static_node_id": 12})");
  const auto told = ids_wished(recipe, &label);
  REQUIRE(told.size() == 2);
  CHECK(told[0].value == 3);
  CHECK(told[1].value == 12);
  CHECK(texts_of(*settings_for(recipe, told, std::vector<std::int64_t>{3, 12}, profiles())) ==
        std::vector<std::string>{"angle_limit_cw=450", "servo_id=3", "static_node_id=12"});
}

TEST_CASE("the digest of a configuration can be made again by anybody") {
  const bla::Values values{{bla::Address(0x2A), 120}, {bla::Address(0x39), -1800}};
  CHECK(bla::config_sha256(values) == sha256("0x2A=120\n0x39=-1800\n"));
  CHECK(bla::config_sha256({}) == sha256(""));
}

TEST_CASE("a notice may leave the line, a warning or a failure may not") {
  const auto values = [](std::int64_t notice, std::int64_t warning, std::int64_t failure) {
    const std::int64_t summary =
        (notice != 0 ? 1 << 16 : 0) | (warning != 0 ? 1 << 8 : 0) | (failure != 0 ? 1 : 0);
    return bla::Values{{bla::Address(0x18), summary},
                       {bla::Address(0x19), notice},
                       {bla::Address(0x1A), warning},
                       {bla::Address(0x1B), failure}};
  };
  CHECK(fault_bits(values(0, 0, 0), profiles()).empty());
  CHECK_FALSE(check_faults(values(0, 0, 0), profiles(), NodeId(11)));
  CHECK(fault_bits(values(0x100, 0, 0), profiles()) == "0x19.8");
  CHECK_FALSE(check_faults(values(0x100, 0, 0), profiles(), NodeId(11)));
  CHECK(fault_bits(values(0x100, 0x10, 0), profiles()) == "0x1A.4;0x19.8");
  const auto warned = check_faults(values(0x100, 0x10, 0), profiles(), NodeId(11));
  CHECK(code_of(warned) == "faults");
  CHECK(warned->message == "it has faults: 0x1A.4;0x19.8");
  CHECK(code_of(check_faults(values(0, 0, 2), profiles(), NodeId(11))) == "faults");
}

TEST_CASE("a unit that said nothing of itself has nothing of it in its record") {
  state::LedgerRecord record;
  enter(record, Servo());
  CHECK_FALSE(record.model);
  CHECK_FALSE(record.unique_id);
  CHECK_FALSE(record.serial_number);
}
