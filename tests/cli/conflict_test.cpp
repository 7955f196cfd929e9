// Who else is on the bus: what `scan` says of it in time, and whom nothing is written to.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

using namespace blactl::test;

namespace {

/// Two units on node ID 11 among others. What one of them has that the other has not is `more`.
Scene twins(const nlohmann::json& more) {
  return three_servos().servo("BLA21-12U-AB", 11, more);
}

/// What a recording holds: one object a transfer.
std::vector<nlohmann::json> transfers(const Bench& bench, const std::string& log) {
  auto lines = json_lines(bench.run({"trace", log, "--json"}).out);
  std::erase_if(lines, [](const nlohmann::json& line) { return !line.contains("type"); });
  return lines;
}

/// Whether the transfer changes its destination.
bool is_write(const nlohmann::json& transfer) {
  if (transfer.value("kind", "") != "request") {
    return false;
  }
  const std::string type = transfer["type"];
  return type == "uavcan.protocol.param.ExecuteOpcode" || type == "uavcan.protocol.RestartNode" ||
         (type == "uavcan.protocol.param.GetSet" && !transfer["fields"]["value"].contains("empty"));
}

/// How many transfers of a run change the node.
std::ptrdiff_t writes_to(const Bench& bench, const std::string& log, int node) {
  return std::ranges::count_if(transfers(bench, log), [node](const nlohmann::json& transfer) {
    return is_write(transfer) && transfer["destination"] == node;
  });
}

} // namespace

TEST_CASE("what is for a model does not leave out two of its servos on one node ID") {
  const Fleet fleet(Scene()
                        .servo("BLA21-12U-AB", 11, {{"serial_number", 240900001}})
                        .servo("BLA21-12U-AB", 11, {{"serial_number", 240900002}})
                        .servo("BLA21-12U-AB", 12, {{"serial_number", 240900003}}));
  const std::string file = fleet.bench().file("model.json",
                                              R"({"schema": "blactl-fleet/1", "servos": [
          {"name": "all", "match": {"model": "BLA21-12U-AB"}, "set": {"smoothing": "on"}}]})");
  for (const Arguments& arguments :
       {Arguments{"apply", file, "-y", "--json"}, Arguments{"diff", file, "--json"}}) {
    check_error(fleet.run(arguments), 9, "duplicate_node_id", "node ID 11");
  }
}

TEST_CASE("two units with one node ID are named within three seconds") {
  const nlohmann::json differences[] = {{{"servo_id", 4}},
                                        {{"servo_id", 1}, {"serial_number", 77}},
                                        {{"faults", {{"no_actuator_status", true}}}}};
  for (const auto& difference : differences) {
    INFO(difference.dump());
    const Bench bench;
    const std::string log = (bench.folder() / "scan.log").string();
    const Result result = twins(difference).run(bench, {"scan", "--json", "--record", log});
    CHECK(result.status == 9);
    CHECK(json(result.out)["conflicts"][0]["node_ids"] == nlohmann::json{11});
    const auto heard = transfers(bench, log);
    REQUIRE(heard.size() > 20);
    CHECK(heard.back()["time"].get<double>() - heard.front()["time"].get<double>() <= 3.0);
  }
}

TEST_CASE("no command writes to a node ID that two units have, and each refuses with its name") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  const std::vector<Arguments> commands{{"set", "smoothing=off"},
                                        {"set", "smoothing=off", "--save"},
                                        {"set", "smoothing=off", "--while-driven"},
                                        {"save"},
                                        {"erase"},
                                        {"erase", "--keep-ids"},
                                        {"restart"},
                                        {"pwm-config", "--neutral", "1600"},
                                        {"characterize"},
                                        {"alloc", "--static"}};
  for (Arguments command : commands) {
    command.insert(command.end(), {"-n", "11", "-y", "--record", log});
    INFO(command.front() << " " << command[1]);
    const Result result = twins({{"servo_id", 4}}).run(bench, command);
    CHECK(result.status == 9);
    CHECK(codes(result) == std::vector<std::string>{"duplicate_node_id"});
    CHECK(contains(result.err, "two units use node ID 11"));
    CHECK(writes_to(bench, log, 11) == 0);
    command[command.size() - 4] = "all"; // some refuse others of them too
    CHECK(twins({{"servo_id", 4}}).run(bench, command).status != 0);
    CHECK(writes_to(bench, log, 11) == 0);
  }
  REQUIRE(twins({{"servo_id", 4}})
              .run(bench, {"set", "-n", "12", "smoothing=off", "--record", log})
              .status == 0);
  CHECK(writes_to(bench, log, 12) == 1); // such a transfer is seen where there is one
}

TEST_CASE("a servo and another node on its node ID are a conflict to every command") {
  const Bench bench;
  for (int seed = 1; seed <= 4; ++seed) {
    const Scene scene = Scene().seed(seed).servo("BLA34-28U-AB", 11).foreign(11);
    for (const Arguments& command : {Arguments{"scan"},
                                     {"get", "angle_limit_cw"},
                                     {"get", "-n", "11"},
                                     {"faults", "-n", "all"},
                                     {"set", "smoothing=off", "-y"},
                                     {"set", "-n", "serial:99", "smoothing=off", "-y"},
                                     {"save", "-n", "all", "-y"},
                                     {"erase", "-n", "11", "-y"},
                                     {"wait", "-n", "all"},
                                     {"wait", "-n", "11", "--wait", "2"},
                                     {"export", "-"},
                                     {"command", "angle=10deg", "-y"},
                                     {"alloc", "--static", "-n", "all", "-y"}}) {
      const Result result = scene.run(bench, command);
      INFO("seed " << seed << " " << command.front() << ": " << result.out << result.err);
      CHECK(result.status == 9);
      CHECK(contains(result.err, "two units use node ID 11"));
    }
  }
}

TEST_CASE("who else acts on the bus is a note where it forbids nothing") {
  const Scene scene =
      Scene()
          .servo("BLA21-12U-AB", 11, {{"servo_id", 4}})
          .servo("BLA21-12U-AB", 12, {{"servo_id", 4}})
          .servo("BLA21-12U-AB", 13)
          .servo("BLA21-12U-AB", 14)
          .foreign(40, {{"kind", "autopilot"}, {"commands", {{"servo_ids", {9}}, {"type", 1}}}});
  const Result result = scene.run({"set", "-n", "all", "smoothing=off"});
  CHECK(result.status == 0);
  for (const char* note :
       {"node 40 commands servos\n", "nodes 11, 12 have the same servo ID 4\n"}) {
    INFO(note << " in " << result.err);
    CHECK(contains(result.err, note));
  }
  CHECK_FALSE(contains(result.err, "servo ID 0"));
  CHECK(scene.run({"save", "-n", "13", "-y"}).status == 0);
}

TEST_CASE(
    "a file that means one of two servos under one node ID is told of both, not that it is away") {
  const Fleet fleet(Scene()
                        .servo("BLA21-12U-AB", 11, {{"serial_number", 1}})
                        .servo("BLA21-12U-AB", 11, {{"serial_number", 2}}));
  const auto match = GENERATE(Document{{"node_id", 11}}, Document{{"serial_number", 1}});
  const Result applied = fleet.apply(
      {{"schema", "blactl-fleet/1"},
       {"servos", {{{"name", "a"}, {"match", match}, {"set", {{"smoothing", "off"}}}}}}});
  INFO(applied.err);
  CHECK(applied.status == 9);
  CHECK(contains(applied.err, "duplicate_node_id"));
  CHECK_FALSE(contains(applied.err, "no servo for"));
}

TEST_CASE("a servo ID that another servo's ROM holds is not given, nor brought back by a restart") {
  const Fleet fleet(three_servos());
  const auto ids = [&](const char* node, const char* value, bool saves) {
    Arguments arguments{"set", "-n", node, std::string("servo_id=") + value, "-y"};
    if (saves) {
      arguments.emplace_back("--save");
    }
    return fleet.run(arguments);
  };
  REQUIRE(ids("12", "9", true).status == 0);
  REQUIRE(ids("12", "5", false).status == 0);
  check_error(ids("11", "9", true), 9, "duplicate_servo_id",
              "node 11 would have servo ID 9, which node 12 has in its ROM");
  SECTION("a restart that would bring it back") {
    const Options other{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
    REQUIRE(fleet.run({"set", "-n", "11", "servo_id=9", "--save", "-y"}, other).status == 0);
    check_error(fleet.run({"restart", "-n", "12", "-y"}), 9, "duplicate_servo_id",
                "node 12 would have servo ID 9, which node 11 has");
    CHECK(fleet.run({"save", "-n", "12", "-y"}).status == 0);
    CHECK(fleet.run({"restart", "-n", "12", "-y"}).status == 0);
  }
  SECTION("once the other is saved it is free") {
    REQUIRE(fleet.run({"save", "-n", "12", "-y"}).status == 0);
    CHECK(ids("11", "9", true).status == 0);
  }
}

TEST_CASE("a node ID that another servo's ROM holds, though it runs under another, is not given") {
  const Fleet fleet(
      Scene().servo("BLA21-12U-AB", 11, {{"faults", {{"stays", true}}}}).servo("BLA21-12U-AB", 12));
  CHECK(fleet.run({"set", "-n", "11", "static_node_id=20", "--save", "-y"}).status == 1);
  const bool is_ours = GENERATE(true, false);
  const Options other{.env = {{"BLACTL_STATE_DIR", fleet.file_name("other")}}};
  REQUIRE(fleet.run({"set", "-n", "11", "static_node_id=11", "-y"}, is_ours ? Options() : other)
              .status == 0);
  for (const Arguments& arguments :
       {Arguments{"set", "-n", "12", "static_node_id=20", "-y", "--save", "--json"},
        Arguments{"set", "-n", "12", "static_node_id=20", "-y", "--json"},
        Arguments{"alloc", "--static", "-n", "12", "--id", "20", "-y", "--json"}}) {
    check_error(fleet.run(arguments), 9, "duplicate_node_id",
                "node 12 would have node ID 20, which node 11 has in its ROM");
  }
}

TEST_CASE("a node ID in the ROM of a unit that waits for one, as proven before, is not given") {
  const Fleet fleet(Scene()
                        .servo("BLA21-12U-AB", 11, {{"serial_number", 1}})
                        .servo("BLA21-12U-AB", 12, {{"serial_number", 2}})
                        .event(1, "rom_error", "60s"));
  REQUIRE(fleet.run({"set", "-n", "11", "smoothing=off", "--save", "-y"}).status == 0); // proven
  REQUIRE(fleet.run({"monitor", "-n", "12", "--duration", "70"}).status == 0);
  for (const Arguments& arguments :
       {Arguments{"set", "-n", "12", "static_node_id=11", "-y", "--save", "--json"},
        Arguments{"set", "-n", "12", "static_node_id=11", "-y", "--json"},
        Arguments{"alloc", "--static", "-n", "12", "--id", "11", "-y", "--json"}}) {
    check_error(fleet.run(arguments), 9, "duplicate_node_id",
                "node 12 would have node ID 11, which is in the ROM of a unit that waits for one");
  }
  CHECK(fleet.run({"set", "-n", "12", "static_node_id=20", "-y", "--save"}).status == 0);
}

TEST_CASE(
    "a servo that is exchanged while it is looked for is not taken for the one that is meant") {
  constexpr int meant = 240900001, other = 240900002;
  const std::string selector = GENERATE("serial:240900001", "servo:1");
  int refused = 0;
  for (int gone = 1140; gone < 1190; gone += 2) { // its second reading, when it is no longer young
    for (const int gap : {60, 300}) {
      Scene scene;
      scene.servo("BLA21-12U-AB", 11, {{"serial_number", meant}, {"servo_id", 1}})
          .servo("BLA21-12U-AB", 11, {{"serial_number", other}, {"servo_id", 2}})
          .event(meant, "power_off", std::to_string(gone) + "ms")
          .joins(other, std::to_string(gone + gap) + "ms");
      const Result set = scene.run({"set", "-n", selector, "angle_p_gain=7", "-y", "--json"});
      INFO(selector << ' ' << gone << ' ' << gap << set.out << set.err);
      refused += set.status != 0 ? 1 : 0;
      for (const auto& node : json(set.out)["nodes"]) {
        CHECK_FALSE((set.status == 0 && node["serial_number"] != meant));
      }
    }
  }
  CHECK(refused > 0);
}

TEST_CASE("a servo ID that another servo has come with since is not saved") {
  const Fleet fleet(Scene()
                        .servo("BLA21-12U-AB", 11, {{"serial_number", 1}, {"servo_id", 1}})
                        .servo("BLA21-12U-AB", 12, {{"serial_number", 2}, {"servo_id", 2}})
                        .servo("BLA21-12U-AB", 13, {{"serial_number", 3}, {"servo_id", 40}})
                        .joins(3, "2600ms"));
  const Result applied =
      fleet.apply({{"schema", "blactl-fleet/1"},
                   {"servos",
                    {{{"name", "a"}, {"match", {{"node_id", 11}}}, {"set", {{"smoothing", "off"}}}},
                     {{"name", "b"}, {"match", {{"node_id", 12}}}, {"set", {{"servo_id", 40}}}}}}},
                  {"--stagger", "3"});
  INFO(applied.err);
  CHECK(applied.status == 6);
  CHECK(contains(applied.err, "servo ID 40"));
  CHECK(fleet.rom("12", "servo_id") == 2);
}

TEST_CASE("a servo ID that is heard from a node that does not answer is not given") {
  const Result result =
      Scene()
          .servo("BLA21-12U-AB", 11)
          .servo("BLA21-12U-AB", 12, {{"servo_id", 9}, {"faults", {{"mute", true}}}})
          .run({"set", "-n", "11", "servo_id=9", "--save", "-y"});
  check_error(result, 9, "duplicate_servo_id", "node 11 would have servo ID 9, which node 12 has");
}
