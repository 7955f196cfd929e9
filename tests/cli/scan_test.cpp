#include "catch.hpp"
#include "scene.hpp"

#include <algorithm>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

nlohmann::json scan(const Scene& scene, const Arguments& more = {}) {
  Arguments arguments{"scan", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return json(scene.run(arguments).out);
}

const std::vector<std::string> head{"node_id",         "unique_id", "model",
                                    "serial_number",   "servo_id",  "firmware_version",
                                    "hardware_version"};

} // namespace

TEST_CASE("scan lists every node in ascending order with exactly the keys of the contract") {
  const Result result =
      three_servos().foreign(5, {{"name", "org.example.gps"}}).run({"scan", "--json"});
  CHECK(result.status == 0);
  CHECK(result.err.empty());
  const auto document = ordered_json(result.out);
  CHECK(keys(document) == std::vector<std::string>{"schema", "command", "interface", "exit_status",
                                                   "nodes", "pending", "conflicts", "allocators",
                                                   "commanders", "counts", "errors"});
  CHECK(document["schema"] == "blactl/1");
  CHECK(document["command"] == "scan");
  CHECK(document["interface"].get<std::string>().starts_with("sim:/"));
  CHECK(document["exit_status"] == 0);
  CHECK(document["counts"] == nlohmann::ordered_json{{"nodes", 4}, {"failed", 0}, {"servos", 3}});
  REQUIRE(document["nodes"].size() == 4);
  auto expected = head;
  expected.insert(expected.end(), {"static_node_id", "model_certain", "info", "warnings"});
  std::vector<int> ids;
  for (const auto& node : document["nodes"]) {
    CHECK(keys(node) == expected);
    CHECK(keys(node["info"]) == std::vector<std::string>{"name", "uptime_s", "mode", "health",
                                                         "vendor_status", "software_version",
                                                         "hardware_version"});
    ids.push_back(node["node_id"]);
  }
  CHECK(ids == std::vector{5, 11, 12, 13});
}

TEST_CASE("scan tells of a servo what its registers hold", "[requirement-177]") {
  const Scene scene = Scene().servo("BLA21-12U-AB", 11,
                                    {{"servo_id", 7},
                                     {"serial_number", 240900558},
                                     {"unique_id", "00112233445566778899aabbccddeeff"}});
  const auto node = scan(scene)["nodes"][0];
  CHECK(node["unique_id"] == "00112233445566778899aabbccddeeff");
  CHECK(node["model"] == "BLA21-12U-AB");
  CHECK(node["model_certain"] == true);
  CHECK(node["serial_number"] == 240900558);
  CHECK(node["servo_id"] == 7);
  CHECK(node["static_node_id"] == 11);
  CHECK(node["firmware_version"] == 1400);
  CHECK(node["hardware_version"] == 12050);
  CHECK(node["info"]["name"] == "jp.co.futaba.bla21");
  CHECK(node["info"]["mode"] == "operational");
  CHECK(node["info"]["health"] == "ok");
  CHECK(node["info"]["vendor_status"] == 0);
  CHECK(node["warnings"].empty());
}

TEST_CASE("scan tells nobody of servos that wait where none was heard to") {
  CHECK_FALSE(contains(three_servos().run({"scan"}).out, "may wait"));
}

TEST_CASE("a servo that is gone is offline and does not count, live and from a recording") {
  const Bench bench;
  const std::string file = bench.file("gone.json", R"({"schema": "blactl-scenario/1",
      "clock": "virtual",
      "servos": [{"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1, "serial_number": 1},
                 {"model": "BLA21-12U-AB", "node_id": 12, "servo_id": 2, "serial_number": 2}],
      "events": [{"at": "2s", "servo": 1, "happens": "power_off"}]})");
  const std::string log = (bench.folder() / "gone.log").string();
  const Result live = bench.run(
      {"-i", "sim:" + file, "scan", "--listen", "10", "--expect", "2", "--json", "--record", log});
  CHECK(live.status == 4);
  const Result replayed = bench.run({"-i", "replay:" + log, "scan", "--json"});
  for (const Result& result : {live, replayed}) {
    const auto document = json(result.out);
    CHECK(document["nodes"][0]["info"]["mode"] == "offline");
    CHECK(document["nodes"][1]["info"]["mode"] == "operational");
    CHECK(document["counts"]["servos"] == 1);
    CHECK(
        contains(document["nodes"][0]["warnings"][0].get<std::string>(), "has not been heard for"));
  }
}

TEST_CASE("a long scan shows on a terminal how far it is") {
  const Result result = three_servos().run({"scan", "--listen", "5"}, {.terminal = true});
  CHECK(contains(result.err, "listening, 4 of 5 s; nodes: 3"));
}

TEST_CASE("what scan does not know of a foreign node is null") {
  const auto node = scan(three_servos().foreign(40, {{"name", "org.example.gps"}}))["nodes"][3];
  CHECK(node["node_id"] == 40);
  CHECK(node["info"]["name"] == "org.example.gps");
  for (const auto* key : {"model", "serial_number", "servo_id", "firmware_version",
                          "hardware_version", "static_node_id"}) {
    INFO(key);
    CHECK(node[key].is_null());
  }
}

TEST_CASE("scan warns of old firmware, faults and a model that it cannot be sure of",
          "[requirement-85][requirement-92]") {
  const auto warning = [](const nlohmann::json& servo) {
    return scan(Scene().servo("BLA21-12U-AB", 11, servo))["nodes"][0]["warnings"][0]
        .get<std::string>();
  };
  CHECK(contains(warning({{"firmware_version", 1300}}), "firmware 1.300 may stall"));
  CHECK(contains(warning({{"ram", {{"fault_warning", 16}}}}), "health: warning"));
  CHECK(contains(warning({{"ram", {{"fault_failure", 1}}}}), "health: error"));
  CHECK(contains(warning({{"hardware_version", 59050}}), "hardware version 59050 is not in table"));
  CHECK(contains(warning({{"model_number", 99}}), "no profile fits"));
}

TEST_CASE("scan shows who waits for a node ID, commands and says armed") {
  const Scene scene =
      three_servos()
          .servo("BLA21-12U-AB", 0,
                 {{"unique_id", "a1b2c3d4e5f60718293a4b5c6d7e8f90"}, {"servo_id", 9}})
          .foreign(40, {{"commands", {{"servo_ids", {1}}}}, {"armed", true}});
  const auto document = scan(scene);
  REQUIRE(document["pending"].size() == 1);
  CHECK(keys(nlohmann::ordered_json(document["pending"][0])) ==
        std::vector<std::string>{"unique_id_prefix"});
  CHECK(document["pending"][0]["unique_id_prefix"] == "a1b2c3d4e5f6");
  CHECK(document["commanders"] == nlohmann::json{40});
  CHECK(document["allocators"].empty());
  const Result text = scene.run({"scan"});
  CHECK(text.status == 0);
  CHECK(contains(text.out, "! waits for a node ID: unique ID a1b2c3d4e5f6…\n"));
  CHECK(contains(text.out, "! more servos may wait than were heard"));
  CHECK(contains(text.out, "! node 40 commands servos\n"));
  CHECK(contains(text.out, "! node 40 says armed\n"));
}

TEST_CASE("two servos with one node ID are a conflict, and both are listed", "[requirement-179]") {
  const Scene scene = three_servos().servo("BLA21-12U-AB", 11, {{"servo_id", 4}});
  const Result result = scene.run({"scan", "--json"});
  CHECK(result.status == 9);
  const auto document = json(result.out);
  REQUIRE(document["nodes"].size() == 4);
  CHECK(document["counts"]["servos"] == 4);
  for (const std::size_t index : {0U, 1U}) {
    const auto& twin = document["nodes"][index];
    CHECK(twin["node_id"] == 11);
    CHECK(twin["unique_id"].get<std::string>().size() == 32);
    for (const auto* key : {"model", "serial_number", "servo_id", "firmware_version",
                            "hardware_version", "static_node_id", "info"}) {
      INFO(key);
      CHECK(twin[key].is_null());
    }
  }
  CHECK(document["nodes"][0]["unique_id"] != document["nodes"][1]["unique_id"]);
  REQUIRE(document["conflicts"].size() == 1);
  const auto conflict = ordered_json(result.out)["conflicts"][0];
  CHECK(keys(conflict) == std::vector<std::string>{"code", "node_ids", "text"});
  CHECK(conflict["code"] == "duplicate_node_id");
  CHECK(conflict["node_ids"] == nlohmann::ordered_json{11});
  CHECK(document["errors"][0]["code"] == "duplicate_node_id");
  CHECK(document["errors"][0]["node_id"] == 11);
  CHECK(contains(document["errors"][0]["hint"].get<std::string>(), "connect one of them alone"));
  const Result text = scene.run({"scan"});
  CHECK(contains(text.out, "BLA34-28U-AB"));
  CHECK(contains(text.out, "! two units use node ID 11: uid:"));
}

TEST_CASE("two servos with one servo ID are a conflict", "[requirement-179]") {
  const Result result = Scene()
                            .servo("BLA21-12U-AB", 11, {{"servo_id", 4}})
                            .servo("BLA21-12U-AB", 12, {{"servo_id", 4}})
                            .run({"scan", "--json"});
  CHECK(result.status == 9);
  const auto document = json(result.out);
  CHECK(document["conflicts"][0]["code"] == "duplicate_servo_id");
  CHECK(document["conflicts"][0]["node_ids"] == nlohmann::json{11, 12});
  CHECK(contains(document["errors"][0]["hint"].get<std::string>(), "blactl set -n 12 servo_id="));
}

TEST_CASE("a servo that does not answer in the end is not said to be there") {
  const nlohmann::json scenario{
      {"schema", "blactl-scenario/1"},
      {"clock", "virtual"},
      {"servos", {{{"model", "BLA21-12U-AB"}, {"node_id", 11}, {"serial_number", 7}}}},
      {"events", {{{"at", "900ms"}, {"servo", 7}, {"world", {{"plugged", "off"}}}}}}};
  const Bench bench;
  const Result result =
      bench.run({"-i", "sim:" + bench.file("s.json", scenario.dump()), "scan", "--expect", "1"});
  CHECK(result.status == 4);
  CHECK(contains(result.out, "offline"));
  CHECK_FALSE(contains(result.out, "operational"));
  CHECK(contains(result.out, "does not answer any more"));
}

TEST_CASE("scan fails with 4 where there is nobody, or fewer servos than expected") {
  const Result nobody = Scene().servo("BLA21-12U-AB", 0).run({"scan"});
  CHECK(nobody.status == 4);
  CHECK(codes(nobody) == std::vector<std::string>{"not_found"});
  CHECK(contains(nobody.err, "no node was heard on sim:/"));
  CHECK(contains(nobody.err, "\n  servos wait for a node ID: `blactl alloc --once`"));
  CHECK(contains(nobody.err, ": blactl alloc --static -n all --range "));

  CHECK(three_servos().foreign(40).run({"scan", "--expect", "3"}).status == 0);
  const Result few = three_servos().foreign(40).run({"scan", "--expect", "4"});
  CHECK(few.status == 4);
  CHECK(codes(few) == std::vector<std::string>{"not_found"});
  CHECK(contains(few.err, "servos found: 3, expected: 4\n  is every servo powered"));
  CHECK(contains(few.out, "BLA34-28U-AB"));
}

TEST_CASE("a servo that is heard but mute is a timeout, and no foreign node") {
  const Scene scene =
      three_servos().servo("BLA21-12U-AB", 14, {{"servo_id", 4}, {"faults", {{"mute", true}}}});
  const Result result = scene.run({"scan"});
  CHECK(result.status == 6);
  CHECK(codes(result) == std::vector<std::string>{"timeout"});
  CHECK(
      contains(result.err, "node 14 is on the bus but does not answer\n  check supply and cable"));
  CHECK(contains(result.out, "14    unknown"));
  CHECK_FALSE(contains(result.out, "not a BLA servo"));
  const auto node = scan(scene)["nodes"][3];
  CHECK(node["unique_id"].is_null());
  CHECK(node["info"]["name"].is_null());
  CHECK(node["info"]["mode"] == "operational");
}

TEST_CASE("-n narrows what scan lists") {
  const auto document = scan(three_servos(), {"-n", "model:BLA34"});
  REQUIRE(document["nodes"].size() == 1);
  CHECK(document["nodes"][0]["node_id"] == 13);
}

TEST_CASE("scan --listen-only sends nothing and lists what it hears") {
  const Result result = three_servos().run({"scan", "--listen-only", "--json"});
  CHECK(result.status == 0);
  const auto document = json(result.out);
  CHECK(document["nodes"].size() == 3);
  CHECK(document["nodes"][0]["unique_id"].is_null());
}

TEST_CASE("scan --csv has one row a node below its columns") {
  const Result result = three_servos().run({"scan", "--csv"});
  CHECK(result.status == 0);
  CHECK(result.out.starts_with("node_id,unique_id,model,serial_number,servo_id,firmware_version,"
                               "hardware_version,static_node_id,model_certain,name,uptime_s,mode,"
                               "health,vendor_status,software_version,warnings\n11,"));
  CHECK(contains(result.out, ",BLA15-06U-A0,240900002,2,1400,6010,12,true,jp.co.futaba.bla15,"));
}

TEST_CASE("scan -n says that nobody matches, not that nobody is there") {
  const Result result = three_servos().run({"scan", "-n", "99"});
  CHECK(result.status == 4);
  CHECK(contains(result.err, "matches -n 99"));
}

TEST_CASE("on a terminal of 80 columns scan breaks no line, and leaves nothing out") {
  const Scene scene =
      three_servos().foreign(40, {{"name", "org.example.a.rather.long.name.of.a.gps"}});
  const Bench bench;
  for (const Arguments& command : {Arguments{"scan"},
                                   {"scan", "--lang", "ja"},
                                   {"get"},
                                   {"get", "--lang", "ja"},
                                   {"set", "-n", "11", "smoothing=off", "timeout_time=1.5s", "-y"},
                                   {"set", "-n", "11", "smoothing=off", "-y", "--lang", "ja"}}) {
    const Options terminal{.terminal = true, .terminal_stdout = true, .columns = 80};
    const Result shown = scene.run(bench, command, terminal);
    INFO(shown.out);
    CHECK(longest_line(without_colour(shown.out)) <= 80);
  }
  const auto unique_id = scan(scene)["nodes"][0]["unique_id"].get<std::string>();
  const Options terminal{.terminal = true, .terminal_stdout = true, .columns = 80};
  CHECK(contains(scene.run(bench, {"scan"}, terminal).out, "    " + unique_id));
  CHECK(longest_line(scene.run(bench, {"scan"}).out) > 80);
}

TEST_CASE("on a terminal of 80 columns a servo is a line of scan, with as much of its unique ID as "
          "tells it") {
  const Bench bench;
  const Scene scene =
      three_servos()
          .servo("BLA21-12U-AB", 14,
                 {{"unique_id", "00112233440000000000000000000001"}, {"servo_id", 14}})
          .servo("BLA21-12U-AB", 15,
                 {{"unique_id", "00112233445000000000000000000002"}, {"servo_id", 15}});
  for (const char* language : {"en", "ja"}) {
    const Options terminal{.terminal = true, .terminal_stdout = true, .columns = 80};
    const Result shown = scene.run(bench, {"scan", "--lang", language}, terminal);
    INFO(shown.out);
    const std::string plain = without_colour(shown.out);
    CHECK(std::ranges::count(plain, '\n') == 6);
    CHECK(longest_line(plain) <= 80);
    CHECK(contains(plain, " 00112233440\n"));
    CHECK(contains(plain, " 00112233445\n"));
  }
  const Options wide{.terminal = true, .terminal_stdout = true, .columns = 120};
  CHECK(contains(scene.run(bench, {"scan"}, wide).out, " 00112233440000000000000000000001"));
  CHECK(contains(scene.run(bench, {"scan"}).out, " 00112233440000000000000000000001\n"));
  CHECK(scene.run(bench, {"get", "-n", "uid:00112233440", "servo_id"}).status == 0);
}

TEST_CASE("scan tells a warning of several servos once") {
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11, {{"servo_id", 1}, {"firmware_version", 1100}})
                          .servo("BLA21-12U-AB", 12, {{"servo_id", 2}, {"firmware_version", 1100}});
  const Result result = scene.run({"scan"});
  INFO(result.out);
  CHECK(contains(result.out, "\n! 11, 12: "));
  CHECK_FALSE(contains(result.out, "\n! 12: "));
  const auto scanned = scan(scene);
  REQUIRE(scanned["nodes"].size() == 2);
  for (const auto& node : scanned["nodes"]) {
    CHECK_FALSE(node["warnings"].empty());
  }
}

TEST_CASE("scan says in the user's language how a servo is") {
  const Scene scene =
      Scene().servo("BLA21-12U-AB", 12, {{"ram", {{"temperature_limit_high", "20degC"}}}});
  CHECK(contains(scene.run({"scan"}).out, "  warning  "));
  const Result japanese = scene.run({"scan", "--lang", "ja"});
  INFO(japanese.out);
  CHECK(contains(japanese.out, "  警告  "));
  CHECK(contains(japanese.out, "健康状態: 警告"));
  CHECK_FALSE(contains(japanese.out, "warning"));
  CHECK(contains(scene.run({"doctor", "--lang", "ja"}).out, "健康状態は「警告」です"));
}

TEST_CASE("states are coloured on a terminal, as --color says") {
  const Scene scene = three_servos();
  const Options terminal{.terminal_stdout = true};
  CHECK(contains(scene.run({"scan"}, terminal).out, "\x1b[32mok\x1b[0m"));
  CHECK_FALSE(contains(scene.run({"scan", "--color", "never"}, terminal).out, "\x1b"));
  CHECK_FALSE(contains(scene.run({"scan"}).out, "\x1b"));
  CHECK(contains(scene.run({"set", "-n", "11", "smoothing=off", "-y", "--color", "always"}).out,
                 "\x1b[32mwritten\x1b[0m"));
}
