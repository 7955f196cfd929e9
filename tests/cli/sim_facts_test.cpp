#include "catch.hpp"
#include "scene.hpp"

using namespace blactl::test;

namespace {

/// A servo with a bit of 0x19, once as it is and once with a behaviour of its own.
constexpr std::string_view two_notices = R"({"schema": "blactl-scenario/1", "servos": [
    {"model": "BLA21-12U-AB", "node_id": 11, "ram": {"fault_notice": 256}},
    {"model": "BLA21-12U-AB", "node_id": 12, "ram": {"fault_notice": 256},
     "behaviour": {"notices_warn": false}}]})";

/// The health of the nodes that `scan` sees.
std::vector<std::string> healths(const Bench& bench) {
  std::vector<std::string> found;
  const auto document = json(bench.run({"-i", "sim:", "scan", "--json"}).out);
  for (const auto& node : document["nodes"]) {
    found.push_back(node["info"]["health"]);
  }
  return found;
}

} // namespace

TEST_CASE("sim --facts: servos behave as measured, unless the scenario says otherwise") {
  const Bench bench;
  const std::string scenario = bench.file("scenario.json", two_notices);
  const std::string facts = bench.file("facts.json", R"({"schema": "blactl-facts/1",
      "behaviour": {"notices_warn": true}})");
  {
    const Background sim(bench, {"sim", scenario, "--clock", "virtual"});
    CHECK(healths(bench) == std::vector<std::string>{"ok", "ok"});
  }
  const Background sim(bench, {"sim", scenario, "--facts", facts, "--clock", "virtual"});
  CHECK(healths(bench) == std::vector<std::string>{"warning", "ok"});
}

TEST_CASE("sim --facts goes with the default scenario too") {
  const Bench bench;
  const std::string facts =
      bench.file("facts.json", R"({"schema": "blactl-facts/1", "behaviour": {}})");
  Background sim(bench, {"sim", "--facts", facts});
  CHECK(sim.stop().out == "ready\n");
}

TEST_CASE("sim --facts refuses a faulty file, with every fault's place") {
  const Bench bench;
  const std::string facts = bench.file("facts.json", R"({
  "schema": "blactl-facts/1",
  "behaviour": {"out_of_range": "wrap",
                "colour": "red"}
})");
  const Result result = bench.run({"sim", "--facts", facts});
  CHECK(result.status == 2);
  CHECK(codes(result) == std::vector<std::string>{"bad_file"});
  CHECK(contains(result.err, "facts.json:3: /behaviour/out_of_range: "));
  CHECK(contains(result.err, "facts.json:4: /behaviour/colour: "));
  const auto lines = json_lines(bench.run({"sim", "--facts", facts, "--json"}).out);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0]["errors"][0]["code"] == "bad_file");
}

TEST_CASE("sim --facts refuses what is no facts file") {
  const Bench bench;
  const auto refused = [&](const std::string& file) {
    const Result result = bench.run({"sim", "--facts", file});
    CHECK(result.status == 2);
    CHECK(codes(result) == std::vector<std::string>{"bad_file"});
  };
  refused((bench.folder() / "absent.json").string());
  refused(bench.file("scenario.json", two_notices));
}
