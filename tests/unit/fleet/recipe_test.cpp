#include "blactl/fleet/files/recipe.hpp"

#include "catch.hpp"
#include "unit/fleet/support.hpp"

#include <string>
#include <string_view>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

Result<Recipe> parsed(const std::string& text) {
  return parse_recipe(text, "recipe.json", profiles());
}

/// A recipe whose "set" has these members.
std::string with(std::string_view set) {
  return R"({"schema": "blactl-recipe/1", "name": "aileron", "model": "BLA21-12U",
"firmware_min": 1400, "set": {)" +
         std::string(set) + "}}";
}

/// What is wrong with it, without the name of the file.
std::string fault(const std::string& text) {
  const auto read = parsed(text);
  REQUIRE_FALSE(read);
  CHECK(read.error().code == Code::bad_file);
  INFO(read.error().message);
  CHECK(read.error().message.find('\n') == std::string::npos); // one
  CHECK(read.error().message.starts_with("recipe.json:"));
  return read.error().message.substr(std::string_view("recipe.json:").size());
}

std::vector<std::int64_t> all_of(const Counter& counter, std::size_t most) {
  std::vector<std::int64_t> ids{counter.first};
  while (ids.size() < most) {
    const auto next = counter.after(ids.back());
    if (!next) {
      break;
    }
    ids.push_back(*next);
  }
  return ids;
}

} // namespace

TEST_CASE("a recipe says what every servo of a line holds, and counts its IDs") {
  const auto recipe = parsed(with(R"("static_node_id": {"first": 11, "last": 16, "step": 2},
      "0x45": {"first": 1, "last": 2, "at_end": "again"}, "torque_limit_cw": "40%",
      "angle_limit_cw": "45.0deg")"));
  INFO((recipe ? "" : recipe.error().message));
  REQUIRE(recipe);
  CHECK(recipe->name == "aileron");
  CHECK(recipe->model == "BLA21-12U");
  CHECK(recipe->firmware_min == 1400);
  REQUIRE(recipe->set.size() == 2);
  CHECK(recipe->set[0].parameter->name == "angle_limit_cw");
  CHECK(recipe->set[0].value.raw == 450);
  REQUIRE(recipe->counters.size() == 2);
  CHECK(recipe->counters[0].parameter->name == "servo_id");
  CHECK(all_of(recipe->counters[0], 5) == std::vector<std::int64_t>{1, 2, 1, 2, 1});
  CHECK(recipe->counters[1].parameter->name == "static_node_id");
  CHECK(all_of(recipe->counters[1], 5) == std::vector<std::int64_t>{11, 13, 15});
}

TEST_CASE("the recipe of the examples is one") {
  const auto recipe =
      read_recipe(std::string(BLACTL_TEST_DATA) + "/recipes/aileron.json", profiles());
  INFO((recipe ? "" : recipe.error().message));
  REQUIRE(recipe);
  CHECK(recipe->counters.size() == 2);
  CHECK(recipe->set.size() == 4);
}

TEST_CASE("a recipe needs neither counters nor a firmware version") {
  const auto recipe = parsed(
      R"({"schema": "blactl-recipe/1", "name": "a", "model": "BLA21", "set": {"servo_id": 3}})");
  REQUIRE(recipe);
  CHECK_FALSE(recipe->firmware_min);
  CHECK(recipe->counters.empty());
  CHECK(recipe->set.size() == 1);
}

TEST_CASE("what is wrong with a recipe is told with its line") {
  struct Wrong {
    std::string text;
    std::string_view says;
  };

  const std::string counts = R"("servo_id": {"first": )";
  for (const Wrong& wrong : {
           Wrong{R"({"schema": "blactl-recipe/1", "name": "", "model": "BLA21", "set": {}})",
                 "1: /: \"name\" must not be empty"},
           Wrong{R"({"schema": "blactl-recipe/1", "name": "a", "model": "X", "set": {}})",
                 "1: /: there is no model 'X'"},
           Wrong{with(R"("0x08": 3)"), "2: /set/0x08: "},
           Wrong{with(R"("torque_limit_cw": "140%")"), "2: /set/torque_limit_cw: "},
           Wrong{with(R"("timeout_time": {"first": 1, "last": 2})"),
                 "2: /set/timeout_time: timeout_time is not an ID"},
           Wrong{with(counts + R"(8, "last": 1})"), "2: /set/servo_id: \"last\" is 1, below"},
           Wrong{with(counts + R"(1, "last": 255})"), "2: /set/servo_id: "},
           Wrong{with(counts + R"(1, "last": 2, "step": 0})"), "2: /set/servo_id/step: "},
           Wrong{with(counts + R"(1, "last": 2, "at_end": "go"})"), "2: /set/servo_id/at_end: "},
           Wrong{with(counts + R"(1, "last": 2, "then": 3})"), "2: /set/servo_id/then: "},
           Wrong{with(counts + "1}"), "2: /set/servo_id: "},
           Wrong{with(counts + R"(1, "last": 2}, "0x45": 3)"), "2: /set/servo_id: servo_id is"},
           Wrong{with(R"("static_node_id": {"first": 0, "last": 2})"),
                 "2: /set/static_node_id: 0 is not a static node ID"},
           Wrong{with(R"("static_node_id": {"first": 120, "last": 126})"),
                 "2: /set/static_node_id: "},
       }) {
    INFO(wrong.text);
    const std::string told = fault(wrong.text);
    INFO(told);
    CHECK(told.starts_with(wrong.says));
  }
}

TEST_CASE("what export --recipe makes is a recipe") {
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])");
  const Snapshot servo =
      scene.read(11, [](const Servo& each) -> Result<std::vector<const bla::Parameter*>> {
        return each.identity.configuration();
      });
  const auto recipe = parsed(recipe_file(servo));
  INFO((recipe ? "" : recipe.error().message));
  REQUIRE(recipe);
  CHECK(recipe->model == "BLA21-12U-AB");
  CHECK(recipe->set.size() > 25);
  CHECK(recipe->counters.empty());
}
