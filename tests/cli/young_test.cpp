// Servos that have only just been switched on: the normal case, which no command may stumble over.

#include "catch.hpp"
#include "scene.hpp"

#include <algorithm>
#include <chrono>
#include <string>

using namespace blactl::test;

namespace {

/// All of them are switched on when the command begins.
Scene switched_on(int count) {
  Scene scene;
  for (int id = 1; id <= count; ++id) {
    scene.servo("BLA21-12U-AB", id);
  }
  return scene;
}

/// Five settings for each of them.
std::string settings(const Bench& bench, int count) {
  constexpr int first_serial_number = 240900001;
  nlohmann::json servos = nlohmann::json::array();
  for (int i = 0; i < count; ++i) {
    servos.push_back({{"name", "servo " + std::to_string(i)},
                      {"match", {{"serial_number", first_serial_number + i}}},
                      {"set",
                       {{"angle_p_gain", 35},
                        {"angle_d_gain", 30},
                        {"smoothing", "off"},
                        {"angle_dead_band", "0.5deg"},
                        {"torque_limit_cw", "80%"}}}});
  }
  const nlohmann::json file{{"schema", "blactl-fleet/1"}, {"servos", servos}};
  return bench.file("fleet.json", file.dump());
}

/// A servo whose RAM holds something else than its ROM, until it restarts while its uptime is
/// waited for.
Scene restarting() {
  return Scene()
      .servo("BLA21-12U-AB", 11, {{"ram", {{"angle_limit_cw", "90deg"}}}})
      .event(240900001, "watchdog_error", "900ms");
}

/// A hundred servos are much to simulate, for a build with sanitizers above all.
const Options patient{.timeout = std::chrono::seconds(90)};

} // namespace

TEST_CASE("apply changes a whole fleet that has only just been switched on") {
  const int count = GENERATE(60, 120);
  CAPTURE(count);
  const Bench bench;
  const Result applied =
      switched_on(count).run(bench, {"apply", settings(bench, count), "-y", "--json"}, patient);
  INFO(applied.err);
  CHECK(applied.status == 0);
  CHECK(json(applied.out)["counts"]["changed"] == count);
}

TEST_CASE("get -n all reads 120 servos that have only just been switched on") {
  const Result got = switched_on(120).run({"get", "-n", "all", "--json"}, patient);
  INFO(got.err);
  CHECK(got.status == 0);
  CHECK(json(got.out)["nodes"].size() == 120);
}

TEST_CASE("set --save and save keep what 120 servos hold that have only just been switched on") {
  const auto* const command = GENERATE("save", "set");
  CAPTURE(command);
  Arguments arguments{command, "-n", "all", "-y", "--json"};
  if (std::string_view(command) == "set") {
    arguments.insert(arguments.end(), {"smoothing=off", "--save"});
  }
  const Result saved = switched_on(120).run(arguments, patient);
  INFO(saved.err);
  CHECK(saved.status == 0);
}

TEST_CASE("save, set --save and restart find a servo that has only just been switched on") {
  const Scene scene = switched_on(1);
  CHECK(scene.run({"save", "-n", "1", "-y"}).status == 0);
  CHECK(scene.run({"set", "-n", "1", "smoothing=off", "--save", "-y"}).status == 0);
  CHECK(scene.run({"restart", "-n", "1", "-y"}).status == 0);
}

TEST_CASE("a servo that restarts before its uptime can tell that is told to have restarted") {
  const Result saved = restarting().run({"save", "-n", "11", "-y"});
  check_error(saved, 1, "state", "node 11 restarted while it was read");
  const Result got = restarting().run({"get", "-n", "11", "angle_limit_cw", "--json"});
  CHECK(got.status == 0);
  CHECK(json(got.out)["nodes"][0]["params"][0]["raw"] == 1799);
}

TEST_CASE("servos that are just being switched on are waited for, before a bus counts as empty") {
  for (const Arguments& command : {Arguments{"get", "servo_id"},
                                   {"get", "-n", "all", "servo_id"},
                                   {"restart", "-n", "model:BLA21-12U-AB", "-y"}}) {
    const Result got =
        Scene().servo("BLA21-12U-AB", 11, {{"serial_number", 1}}).joins(1, "300ms").run(command);
    INFO(got.err);
    CHECK(got.status == 0);
  }
}
