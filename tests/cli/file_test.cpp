// -i file:FLEET.json: reading commands answered from a fleet file.

#include "catch.hpp"
#include "scene.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

/// Two servos, of which the second has no node ID, and settings for all of a model.
constexpr const char* wing = R"({
  "schema": "blactl-fleet/1",
  "common": {"smoothing": "on"},
  "servos": [
    {
      "name": "left aileron",
      "match": {"serial_number": 240900558, "model": "BLA21-12U-AB"},
      "set": {"servo_id": 3, "static_node_id": 11, "angle_limit_cw": "45.0deg"},
      "about": {"firmware_version": 1400, "hardware_version": 12050}
    },
    {
      "name": "right aileron",
      "match": {"unique_id": "88ace781674b4cac255e706b7426bd30"},
      "set": {"servo_id": 4, "static_node_id": 0}
    },
    {"name": "the others", "match": {"model": "BLA15"}, "set": {"reverse": "on"}}
  ]
})";

struct Filed {
  [[nodiscard]] Result run(Arguments arguments) const {
    arguments.insert(arguments.begin(), {"-i", "file:" + path});
    return bench.run(arguments);
  }

  Bench bench;
  std::string path = bench.file("wing.json", wing);
};

} // namespace

TEST_CASE("get answers from a fleet file what the file says") {
  const Filed file;
  const Result result = file.run({"get", "-n", "11", "angle_limit_cw", "smoothing", "--json"});
  CHECK(result.status == 0);
  const auto document = json(result.out);
  CHECK(document["interface"] == "file:" + file.path);
  const auto& node = document["nodes"][0];
  CHECK(node["node_id"] == 11);
  CHECK(node["unique_id"] == nullptr);
  CHECK(node["model"] == "BLA21-12U-AB");
  CHECK(node["serial_number"] == 240900558);
  CHECK(node["servo_id"] == 3);
  CHECK(node["firmware_version"] == 1400);
  CHECK(node["params"][0]["raw"] == 450);
  CHECK(node["params"][1]["raw"] == 1);
}

TEST_CASE("what a fleet file does not say is not_recorded") {
  const Filed file;
  const Result result = file.run({"get", "-n", "11", "angle_limit_cw", "angle_limit_ccw"});
  CHECK(result.status == 4);
  CHECK(codes(result) == std::vector<std::string>{"not_recorded"});
  CHECK(contains(result.out, "45.0 deg"));
  CHECK(contains(result.err, "a fleet file holds the settings"));
  check_error(file.run({"get", "-n", "55", "smoothing"}), 4, "not_recorded", "55");
  CHECK(file.run({"faults", "-n", "11"}).status == 4);
  CHECK(file.run({"trace"}).status == 4);
}

TEST_CASE("a servo without a node ID in the file has none in what is told of it") {
  const Filed file;
  const Result result = file.run({"get", "-n", "uid:88ac", "servo_id", "smoothing", "--json"});
  CHECK(result.status == 0);
  const auto node = json(result.out)["nodes"][0];
  CHECK(node["node_id"] == nullptr);
  CHECK(node["unique_id"] == "88ace781674b4cac255e706b7426bd30");
  CHECK(node["model"] == nullptr);
  CHECK(contains(result.err, "right aileron (1)"));
  CHECK(contains(result.err, "skipped: the others"));
  const Result lacking = file.run({"get", "-n", "uid:88ac", "reverse", "--json"});
  CHECK(lacking.status == 4);
  CHECK(json(lacking.out)["errors"][0]["node_id"] == nullptr);
  CHECK(file.run({"get", "-n", "1", "servo_id"}).status == 4); // what messages call it
  const Result table = file.run({"get", "-n", "uid:88ac", "servo_id", "--csv"});
  CHECK(contains(table.out, "\n,88ace781"));
}

TEST_CASE("scan lists the servos of a fleet file, and says nothing of how they are") {
  const Filed file;
  const Result result = file.run({"scan", "--json"});
  CHECK(result.status == 0);
  const auto nodes = json(result.out)["nodes"];
  REQUIRE(nodes.size() == 2);
  for (const auto& node : nodes) {
    CHECK(node["info"] == nullptr);
    CHECK(node["warnings"].size() == (node["model"] == nullptr ? 1 : 0));
  }
  CHECK(file.run({"scan"}).status == 0);
}

TEST_CASE("diff and export take a fleet file for the servos") {
  const Filed file;
  const Result same = file.run({"diff", file.path, "-n", "11"});
  CHECK(same.status == 0);
  CHECK(contains(same.out, "left aileron"));
  check_error(file.run({"diff", file.path, "-n", "1"}), 4, "not_found", "1");
  const std::string params = file.bench.file("wing.param", "0x22,1\n");
  CHECK(file.run({"diff", params, "-n", "11"}).status == 0);
  check_error(file.run({"diff", params}), 2, "usage", "-n uid:88ace781674b4cac255e706b7426bd30");
  CHECK(file.run({"export", "-n", "11"}).status == 4); // not every setting is in it
}

TEST_CASE("what was exported exports again as it was") {
  const Bench bench;
  const std::string path = (bench.folder() / "fleet.json").string();
  REQUIRE(three_servos().run(bench, {"export", path}).status == 0);
  const Result again = bench.run({"-i", "file:" + path, "export"});
  CHECK(again.status == 0);
  std::ifstream in(path);
  const std::string content{std::istreambuf_iterator<char>(in), {}};
  const auto before = ordered_json(content)["servos"];
  const auto after = ordered_json(again.out)["servos"];
  REQUIRE(before.size() == after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    CHECK(before[i]["match"] == after[i]["match"]);
    CHECK(before[i]["set"] == after[i]["set"]);
    auto about = before[i]["about"];
    about.erase("time"); // of this reading it is not known
    CHECK(about == after[i]["about"]);
  }
  CHECK(bench.run({"-i", "file:" + path, "diff", path}).status == 0);
  const Result pwm = bench.run({"-i", "file:" + path, "pwm-config", "-n", "11", "--json"});
  CHECK(json(pwm.out)["nodes"][0]["neutral_us"] == 1520);
  CHECK(json(pwm.out)["nodes"][0]["input"] == nullptr); // what comes in no file tells
}

TEST_CASE("nothing is written to a fleet file") {
  const Filed file;
  for (const Arguments& arguments :
       {Arguments{"set", "-n", "11", "reverse=on"}, Arguments{"save", "-n", "11"},
        Arguments{"restart", "-n", "11"}, Arguments{"erase", "-n", "11", "-y"},
        Arguments{"alloc", "--once"}, Arguments{"wait", "-n", "11"}}) {
    CAPTURE(arguments.front());
    check_error(file.run(arguments), 2, "usage", "is a file: nothing can be sent to it");
  }
  const std::string record = (file.bench.folder() / "bus.log").string();
  for (const Arguments& arguments : {Arguments{"get", "-n", "11", "--record", record},
                                     Arguments{"doctor", "--report", record}}) {
    check_error(file.run(arguments), 2, "usage", "a fleet file holds no frames");
    CHECK_FALSE(std::filesystem::exists(record));
  }
}

TEST_CASE("a fleet file with faults is no interface, and all of them are told") {
  const Bench bench;
  const std::string path = bench.file(
      "bad.json", R"({"schema":"blactl-fleet/1","servos":[{"name":"","match":{},"x":1}]})");
  const Result result = bench.run({"-i", "file:" + path, "get"});
  CHECK(result.status == 2);
  CHECK(codes(result) == std::vector<std::string>{"bad_file"});
  CHECK(contains(result.err, "/servos/0/x: "));
  CHECK(contains(result.err, "/servos/0/match: "));
  check_error(bench.run({"-i", "file:/no/such.json", "get"}), 2, "bad_file", "/no/such.json");
  const std::string empty = bench.file("empty.json", R"({"schema":"blactl-fleet/1","servos":[]})");
  check_error(bench.run({"-i", "file:" + empty, "get"}), 4, "not_found", "no BLA servo");
}
