// A setting that only one series has, and no built-in profile.

#include "blactl/fleet/bus/register_choice.hpp"
#include "blactl/fleet/bus/replayed_answers.hpp"
#include "blactl/fleet/change/undo.hpp"
#include "blactl/fleet/files/fleet_file.hpp"
#include "blactl/fleet/files/params_file.hpp"
#include "blactl/fleet/files/recipe.hpp"

#include "support.hpp"

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using dronecan::Kind;

namespace {

constexpr bla::Address own_address{0x47};

/// The built-in profiles, and BLA21 with my_param at 0x47: 7 from the factory, 0 to 9.
const bla::Profiles& with_own() {
  static const bla::Profiles loaded = [] {
    std::ifstream file(BLACTL_PROFILES "/BLA21.json", std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::string_view before = "\"parameters\": {";
    REQUIRE(text.find(before) != std::string::npos);
    text.insert(text.find(before) + before.size(), R"(
      "0x47": {"name": "my_param", "group": "option", "name_en": "Mine", "name_ja": "独自",
               "access": "RW", "width": "uint8", "default": 7, "min": 0, "max": 9,
               "saved": true},)");
    std::string folder = (std::filesystem::temp_directory_path() / "blactl-own-XXXXXX").string();
    REQUIRE(mkdtemp(folder.data()) != nullptr);
    std::ofstream(folder + "/BLA21.json") << text;
    auto profiles = bla::Profiles::load(folder);
    std::filesystem::remove_all(folder);
    REQUIRE(profiles);
    return std::move(*profiles);
  }();
  return loaded;
}

Servo servo(std::int64_t model_number, std::int64_t hardware_version) {
  Servo known{.id = NodeId(11), .is_servo = true};
  known.identity = bla::Identity(with_own(), {model_number, 240900558, 1400, hardware_version});
  return known;
}

Servo owner() {
  return servo(61, 12050);
}

Servo other() {
  return servo(62, 6010);
}

Wanted wish(const std::string& text) {
  auto assignments = bla::parse_assignments(with_own(), std::array{text});
  REQUIRE(assignments);
  return {.assignments = std::move(*assignments)};
}

std::string fleet_text(const std::string& set) {
  return R"({"schema": "blactl-fleet/1", "servos": [
    {"name": "one", "match": {"serial_number": 240900558}, "set": )" +
         set + "}]}";
}

} // namespace

TEST_CASE("a servo whose profile has the register is asked for it, another is refused") {
  const auto choice = RegisterChoice::parse(with_own(), std::array<std::string, 1>{"my_param"}, {});
  REQUIRE(choice);
  CHECK(choice->registers_of(owner()).front()->address == own_address);
  CHECK(choice->refusals(owner()).empty());
  CHECK(choice->registers_of(other()).empty());
  REQUIRE(choice->refusals(other()).size() == 1);
  CHECK(choice->refusals(other()).front().code == Code::unsupported);
  CHECK(choice->refusals(other()).front().message.ends_with("has no parameter my_param (0x47)"));
}

TEST_CASE("a change of a register that the servo lacks is refused before it is read") {
  CHECK(registers_needed(wish("my_param=5"), owner()));
  const auto refused = registers_needed(wish("my_param=5"), other());
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == Code::unsupported);
}

TEST_CASE("files hold it as a setting, by name and address") {
  for (const char* set : {R"({"my_param": 5})", R"({"0x47": 5})"}) {
    CHECK(
        parse_fleet_file(fleet_text(set), "f.json", with_own())->servos.front().wish(own_address) ==
        5);
    CHECK_FALSE(parse_fleet_file(fleet_text(set), "f.json", profiles()));
  }
  const auto params = parse_params_file("0x47 5\n0x50 61\n", "p.param", with_own());
  REQUIRE(params);
  CHECK(params->servos.front().wish(own_address) == 5);
  CHECK(params->passed_over == std::vector{bla::address::model_number});
  CHECK_FALSE(parse_params_file("0x47 5\n0x38 900\n", "p.param", profiles()));
}

TEST_CASE("a recipe holds it for a model that has it") {
  const auto recipe = [](const std::string& model) {
    return parse_recipe(R"({"schema": "blactl-recipe/1", "name": "r", "model": ")" + model +
                            R"(", "set": {"my_param": 5}})",
                        "r.json", with_own());
  };
  CHECK(recipe("BLA21"));
  REQUIRE_FALSE(recipe("BLA15"));
  CHECK(recipe("BLA15").error().message.find("has no parameter my_param (0x47)") !=
        std::string::npos);
}

TEST_CASE("what is written to a file has it") {
  Snapshot held{.servo = owner()};
  for (const bla::Parameter* each : registers_to_export(owner())) {
    held.readings.push_back({.parameter = each, .raw = each->default_raw.value_or(0)});
  }
  CHECK(params_file(held, {}).find("\n0x47 7\n") != std::string::npos);
  CHECK(fleet_file(std::array{held}, {}).find("\"my_param\": 7") != std::string::npos);
}

TEST_CASE("undo gives it back where a profile has it, and else says what may be missing") {
  const state::SnapshotEntry entry{.held = {{own_address.value(), 7}}, .saved = true};
  const auto wanted = to_undo(entry, with_own());
  REQUIRE(wanted);
  CHECK(wanted->assignments.front().value.raw == 7);
  const auto refused = to_undo(entry, profiles());
  REQUIRE_FALSE(refused);
  CHECK(refused.error().hint.find("--profile-dir") != std::string::npos);
}

TEST_CASE("two values of it in answers to one question show two units") {
  for (const bla::Profiles* known : {&with_own(), &profiles()}) {
    Roster roster(NodeId(127), *known);
    for (const std::int64_t value : {7, 8}) {
      const GetSet::Response response{.value = value, .name = "0x47"};
      for (const auto& frame :
           service(Kind::response, GetSet::type, 10, 127, response.encode(), 5)) {
        roster.hear(frame, Time(1000s));
      }
    }
    CHECK(roster.is_doubled(NodeId(10)) == (known == &with_own()));
  }
}

TEST_CASE("in a recording ERASE makes history of it") {
  for (const bla::Profiles* known : {&with_own(), &profiles()}) {
    Roster roster(dronecan::anonymous, *known);
    ReplayedAnswers archive(roster);
    const auto hear = [&](Kind kind, const dronecan::DataType& type, std::uint8_t source,
                          std::uint8_t destination, const dronecan::Payload& payload) {
      archive.receive({.header = {.kind = kind,
                                  .data_type_id = type.id,
                                  .source = NodeId(source),
                                  .destination = NodeId(destination)},
                       .payload = payload.bytes(),
                       .at = Time(1h)});
    };
    const auto held = [&] {
      return archive.answer(read_register(NodeId(11), own_address, {})).kind;
    };
    hear(Kind::response, GetSet::type, 11, 127,
         GetSet::Response{.value = std::int64_t{7}, .name = "0x47"}.encode());
    CHECK(held() == Outcome::Kind::answered);
    hear(Kind::request, dronecan::ExecuteOpcode::type, 127, 11,
         dronecan::ExecuteOpcode::Request{.opcode = dronecan::ExecuteOpcode::erase}.encode());
    CHECK((held() == Outcome::Kind::not_recorded) == (known == &with_own()));
  }
}
