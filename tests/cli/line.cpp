#include "line.hpp"

#include "catch.hpp"

#include <cmath>
#include <set>

namespace blactl::test {

const std::string line_recipe = R"({
  "schema": "blactl-recipe/1", "name": "aileron", "model": "BLA21-12U-AB", "firmware_min": 1400,
  "set": {
    "servo_id": {"first": 1, "last": 8, "at_end": "again"},
    "static_node_id": {"first": 11, "last": 18, "at_end": "again"},
    "angle_limit_cw": "45.0deg"
  }
})";

namespace {

std::string at(double second) {
  return std::to_string(std::lround(second * 1000)) + "ms";
}

} // namespace

Scene line(const std::vector<Visit>& visits) {
  Scene scene;
  std::set<int> known;
  for (const Visit& visit : visits) {
    if (known.insert(visit.serial).second) {
      nlohmann::json more = visit.more;
      more["serial_number"] = visit.serial;
      scene.servo(visit.model, visit.node_id, more).joins(visit.serial, at(visit.from));
    } else {
      scene.event(visit.serial, "power_on", at(visit.from));
    }
    scene.event(visit.serial, "power_off", at(visit.to));
  }
  return scene;
}

Provisioned provision(const Scene& scene, const Arguments& more, const Options& options,
                      const std::string& recipe) {
  const Bench bench;
  Arguments arguments{"provision", bench.file("recipe.json", recipe), "-y", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  Provisioned run;
  run.result = scene.run(bench, arguments, options);
  run.records = json_lines(run.result.out);
  REQUIRE_FALSE(run.records.empty());
  run.last = run.records.back();
  run.records.pop_back();
  return run;
}

} // namespace blactl::test
