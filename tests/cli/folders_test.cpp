// Folders and files of the environment that cannot be used, and simulators that are gone.

#include "catch.hpp"
#include "scene.hpp"

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace blactl::test;

namespace fs = std::filesystem;

namespace {

const Arguments get_servo_id{"-i", "sim:", "get", "-n", "11", "servo_id"};

/// Places that no folder can be made in, by what is wrong with them. One of another user is none
/// where the tests run as root.
std::vector<std::string> unusable_places(const Bench& bench) {
  fs::create_symlink("loop", bench.folder() / "loop");
  std::ofstream(bench.folder() / "file") << "no folder";
  fs::create_directory(bench.folder() / "foreign");
  chmod((bench.folder() / "foreign").c_str(), 0);
  return {(bench.folder() / "loop").string(),
          (bench.folder() / "file").string(),
          (bench.folder() / "foreign").string(),
          bench.folder().string() + "/" + std::string(200, 'x'),
          bench.folder().string() + "/" + std::string(5000, 'x'),
          "relative",
          ""};
}

} // namespace

TEST_CASE("a runtime folder that cannot be used is passed over, by client and simulator") {
  const Bench bench;
  for (const std::string& place : unusable_places(bench)) {
    INFO(place.substr(0, 300));
    const Options options{.env = {{"XDG_RUNTIME_DIR", place}}};
    const Result got = bench.run(get_servo_id, options);
    INFO(got.err);
    CHECK(got.status == 0);
    CHECK(contains(got.err, "no simulator is running"));
    Arguments with_json = get_servo_id;
    with_json.emplace_back("-j");
    CHECK(json(bench.run(with_json, options).out)["exit_status"] == 0);
  }
}

TEST_CASE("state and home folders that cannot be used, or are not set, stop nothing") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  for (const std::string& place : unusable_places(bench)) {
    INFO(place.substr(0, 300));
    for (const std::string name : {"XDG_STATE_HOME", "HOME", "BLACTL_STATE_DIR"}) {
      if (name != "BLACTL_STATE_DIR" || !place.ends_with("foreign")) {
        CHECK(bench.run(get_servo_id, {.env = {{name, place}}}).status == 0);
      }
    }
  }
  CHECK(bench.run(get_servo_id, {.env = {{"HOME", std::nullopt}}}).status == 0);
}

TEST_CASE("a lock file that cannot be opened is told with what to look at, not a crash") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  const fs::path folder = bench.folder() / "run" / "blactl"; // beside the socket
  CHECK(bench.run(get_servo_id).status == 0);
  std::string name;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".127") {
      name = entry.path().string();
    }
  }
  REQUIRE_FALSE(name.empty());
  const std::string second = name.substr(0, name.size() - 3) + "126";
  for (const std::string& file : {name, second}) {
    fs::remove(file);
    fs::create_directory(file);
  }
  const Result refused = bench.run(get_servo_id);
  CHECK(refused.status == 9);
  CHECK(codes(refused) == std::vector<std::string>{"no_local_node_id"});
  CHECK(contains(refused.err, name + " cannot be opened"));
  CHECK(contains(refused.err, "\n  see whose the files are with `ls -ld "));
  fs::remove(second);
  const Result passed = bench.run(get_servo_id);
  CHECK(passed.status == 0);
}

TEST_CASE("a simulator that was killed is no simulator: -i sim: takes a private one") {
  const Bench bench;
  {
    Background sim(bench, {"sim"});
    sim.kill();
    std::ignore = sim.wait();
  }
  REQUIRE(fs::exists(bench.folder() / "run" / "blactl" / "sim"));
  const Result got = bench.run(get_servo_id);
  INFO(got.err);
  CHECK(got.status == 0);
  CHECK(contains(got.err, "no simulator is running"));
  const Background next(bench, {"sim"}); // takes the place over
  const Result served = bench.run(get_servo_id);
  CHECK(served.status == 0);
  CHECK(served.err.empty());
}

TEST_CASE("a second simulator on the same socket is refused, naming the first") {
  const Bench bench;
  const std::string other = "sim:" + (bench.folder() / "other").string();
  for (const Arguments& command : {Arguments{"sim"}, {"-i", other, "sim"}}) {
    const Background first(bench, command);
    const Result second = bench.run(command);
    CHECK(second.status == 9);
    CHECK(codes(second) == std::vector<std::string>{"busy"});
    CHECK(contains(second.err, "a simulator already serves "));
    CHECK(contains(second.err, "process " + std::to_string(first.pid())));
  }
}

TEST_CASE("what is odd in a scenario is noted, by sim and by -i sim:FILE") {
  const Bench bench;
  const std::string file = bench.file("odd.json", R"({
  "schema": "blactl-scenario/1", "clock": "virtual",
  "servos": [
    {"model": "BLA21-12U-AB", "node_id": 11, "firmware_version": 1}
  ]
})");
  const std::string warning = file + ":4: /servos/0/firmware_version: ";
  const Result got = bench.run({"-i", "sim:" + file, "get", "-n", "11", "servo_id"});
  CHECK(got.status == 0);
  CHECK(contains(got.err, "blactl: " + warning));
  CHECK(bench.run({"-q", "-i", "sim:" + file, "get", "-n", "11", "servo_id"}).err.empty());
  Background sim(bench, {"sim", file});
  CHECK(contains(sim.stop().err, "blactl: " + warning));
}
