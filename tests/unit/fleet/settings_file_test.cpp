#include "blactl/fleet/files/fleet_diff.hpp"
#include "blactl/fleet/files/fleet_match.hpp"
#include "blactl/fleet/files/settings_file.hpp"

#include "catch.hpp"
#include "unit/fleet/support.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
namespace at = blactl::bla::address;

namespace {

Result<FleetFile> read_as(const std::string& name, std::string_view text) {
  const auto path = std::filesystem::temp_directory_path() / fmt::format("{}-{}", getpid(), name);
  std::ofstream(path) << text;
  auto file = read_settings_file(path, profiles());
  std::filesystem::remove(path);
  return file;
}

FleetFile read_well(const std::string& name, std::string_view text) {
  auto file = read_as(name, text);
  INFO((file ? "" : file.error().message));
  REQUIRE(file);
  return std::move(*file);
}

std::string recipe_for(std::string_view model, std::string_view set, std::string_view more = {}) {
  return fmt::format(
      R"({{"schema": "blactl-recipe/1", "name": "a", "model": "{}",{} "set": {{{}}}}})", model,
      more, set);
}

/// A servo of this model with firmware 1.400.
Servo servo_of(std::uint8_t id, std::string_view model) {
  const bla::Profile* profile = profiles().matching(model).front();
  return {.id = NodeId(id),
          .is_servo = true,
          .identity = bla::Identity(profiles(), {profile->model_number, 240900000 + id, 1400,
                                                 profile->hardware_version})};
}

struct Servos {
  Servos(std::initializer_list<std::pair<std::uint8_t, std::string_view>> servos) {
    for (const auto& [id, model] : servos) {
      roster.learn(servo_of(id, model), std::nullopt);
    }
  }

  Roster roster{dronecan::anonymous, profiles()};
};

FleetMatch match_with(const FleetFile& file, const Servos& servos, std::string_view targets) {
  return match(file, servos.roster, parse_targets(targets).value(), profiles());
}

bool holds(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

} // namespace

TEST_CASE("a file with settings is told by what is in it: a recipe by its schema") {
  const FleetFile recipe = read_well("a.json", recipe_for("BLA21-12U", R"("smoothing": "off")"));
  REQUIRE(recipe.recipe);
  CHECK(recipe.names_nobody());
  CHECK_FALSE(recipe.is_params);
  REQUIRE(recipe.servos.size() == 1);
  CHECK(recipe.servos.front().name.empty());
  CHECK(recipe.servos.front().wish(at::smoothing) == 0);
  CHECK(read_well("a.txt", " " + recipe_for("BLA21", "")).recipe);
  const FleetFile fleet = read_well("a.json", R"({"schema": "blactl-fleet/1", "servos": []})");
  CHECK_FALSE(fleet.names_nobody());
  const FleetFile params = read_well("a.param", "0x22 0\n");
  CHECK(params.is_params);
  CHECK(params.names_nobody());
}

TEST_CASE("a recipe of another version is told as one, with its own faults") {
  std::string text = recipe_for("BLA21", R"("smoothing": "perhaps")");
  text.replace(text.find("/1"), 2, "/2");
  const auto read = read_as("a.json", text);
  REQUIRE_FALSE(read);
  CHECK(read.error().code == Code::bad_file);
  CHECK(holds(read.error().message, "/schema: "));
  CHECK(holds(read.error().message, "blactl-recipe/1"));
  CHECK(holds(read.error().message, "/set/smoothing: "));
  CHECK_FALSE(holds(read.error().message, "servos"));
}

TEST_CASE("a recipe is for every servo that is selected, of its model and firmware only") {
  const FleetFile file =
      read_well("a.json", recipe_for("BLA21-12U", R"("smoothing": 0)", R"("firmware_min": 1400,)"));
  const Servos servos{{11, "BLA21-12U-AB"}, {12, "BLA21-12U-A0"}, {13, "BLA15-12U-A0"}};
  const auto both = match_with(file, servos, "11,12");
  REQUIRE(both.pairs.size() == 2);
  CHECK(both.pairs[0].id == NodeId(11));
  CHECK(both.pairs[1].id == NodeId(12));
  CHECK(both.pairs[1].entry == &file.servos.front());
  CHECK(both.misfits.empty());
  CHECK(both.errors.empty());
  const auto all = match_with(file, servos, "all");
  CHECK(all.pairs.size() == 2);
  REQUIRE(all.misfits.size() == 1);
  CHECK(all.misfits[0].id == NodeId(13));
  CHECK(all.misfits[0].error.code == Code::model_mismatch);
  CHECK(all.misfits[0].error.message ==
        "node 13: it is a BLA15-12U-A0, the recipe is for BLA21-12U");
  const auto entries = unpaired(all, servos.roster, profiles());
  REQUIRE(entries.size() == 1);
  CHECK(entries[0].status == EntryStatus::failed);
  const FleetFile newer =
      read_well("a.json", recipe_for("BLA21-12U", "", R"("firmware_min": 1401,)"));
  const auto old = match_with(newer, servos, "11");
  CHECK(old.pairs.empty());
  REQUIRE(old.misfits.size() == 1);
  CHECK(old.misfits[0].error.code == Code::firmware_too_old);
  CHECK(old.misfits[0].error.node_id == 11);
}

TEST_CASE("an ID in a recipe is for one servo; none of its own is for all") {
  const Servos servos{{11, "BLA21-12U-AB"}, {12, "BLA21-12U-AB"}};
  const FleetFile file = read_well("a.json", recipe_for("BLA21", R"("servo_id": 7)"));
  CHECK(match_with(file, servos, "11").pairs.size() == 1);
  const auto several = match_with(file, servos, "11-12");
  CHECK(several.pairs.empty());
  REQUIRE(several.errors.size() == 1);
  CHECK(several.errors[0].code == Code::usage);
  CHECK(holds(several.errors[0].message, "the same servo_id to 2 servos"));
  const FleetFile dynamic = read_well("a.json", recipe_for("BLA21", R"("static_node_id": 0)"));
  CHECK(match_with(dynamic, servos, "11-12").pairs.size() == 2);
}

TEST_CASE("the IDs of a parameter file are for one servo, for several they are left out") {
  const Servos servos{{11, "BLA21-12U-AB"}, {12, "BLA21-12U-AB"}};
  const FleetFile file = read_well("a.param", "0x22 0\n0x45 0\n0x46 11\n");
  const auto one = match_with(file, servos, "12");
  REQUIRE(one.pairs.size() == 1);
  CHECK(one.pairs[0].entry->wish(at::static_node_id) == 11);
  CHECK(one.ids_left_out.empty());
  const auto several = match_with(file, servos, "11-12");
  CHECK(several.errors.empty());
  CHECK(several.ids_left_out == std::vector<std::string_view>{"servo_id", "static_node_id"});
  REQUIRE(several.pairs.size() == 2);
  for (const auto& pair : several.pairs) {
    CHECK(pair.entry->set.size() == 1);
    CHECK(pair.entry->wish(at::smoothing) == 0);
  }
  const FleetFile none = read_well("a.param", "0x22 0\n");
  CHECK(match_with(none, servos, "all").ids_left_out.empty());
  CHECK(match_with(none, servos, "all").pairs.size() == 2);
  const FleetFile only = read_well("a.param", "0x45 3\n");
  const auto nothing = match_with(only, servos, "all");
  CHECK(nothing.pairs.empty());
  CHECK(nothing.ids_left_out.empty());
  REQUIRE(nothing.errors.size() == 1);
  CHECK(holds(nothing.errors[0].message, "has only IDs"));
}
