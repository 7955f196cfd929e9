#include "catch.hpp"
#include "fleet.hpp"
#include "run.hpp"
#include "scene.hpp"
#include "tap.hpp"

#include <nlohmann/json.hpp>

#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

Scene dynamic_servos(int count) {
  Scene scene;
  for (int i = 1; i <= count; ++i) {
    scene.servo("BLA21-12U-AB", 0, {{"serial_number", i}});
  }
  return scene;
}

/// Of servos that ask for a node ID, with these serial numbers.
std::string scenario(const Bench& bench, int count, int first = 1) {
  nlohmann::json servos = nlohmann::json::array();
  for (int i = first; i < first + count; ++i) {
    servos.push_back({{"model", "BLA21-12U-AB"}, {"node_id", 0}, {"serial_number", i}});
  }
  return bench.file(
      "s" + std::to_string(first) + ".json",
      nlohmann::json{{"schema", "blactl-scenario/1"}, {"clock", "virtual"}, {"servos", servos}}
          .dump());
}

nlohmann::json entries(const Bench& bench, const Arguments& more = {}) {
  Arguments arguments{"-i", "sim:", "alloc", "--list", "-j"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return json(bench.run(arguments).out)["entries"];
}

/// The events of a stream, without what a unit is.
std::vector<std::string> events(const Result& result) {
  std::vector<std::string> all;
  for (const auto& line : json_lines(result.out)) {
    if (line.contains("event")) {
      all.push_back(line["event"].get<std::string>());
    }
  }
  return all;
}

/// A unique ID that ends like this.
std::string uid(int number) {
  return "0011223344556677889900aabbccdd" + std::string(number < 10 ? "0" : "") +
         std::to_string(number);
}

const std::string unit = "00112233445566778899aabbccddeeff";

} // namespace

TEST_CASE("alloc --once gives every servo that asks an ID of its own, and tells how it ends") {
  const Result result = dynamic_servos(3).run({"alloc", "--once", "-j"});
  INFO(result.out << result.err);
  CHECK(result.status == 0);
  std::set<int> ids;
  for (const auto& line : json_lines(result.out)) {
    if (line.contains("event") && line["event"] == "assigned") {
      ids.insert(line["node_id"].get<int>());
      CHECK(line["unique_id"].get<std::string>().size() == 32);
      CHECK(line["time"].is_number());
    }
  }
  CHECK(ids == std::set<int>{123, 124, 125});
  const auto last = json_lines(result.out).back();
  CHECK(last["counts"]["assigned"] == 3);
  CHECK(last["counts"]["failed"] == 0);
  CHECK(contains(result.err, "nobody has asked for 3 s"));
}

TEST_CASE("Ctrl-C is the usual end of alloc, and no error") {
  const Bench bench;
  const std::string interface = "sim:" + Scene().servo("BLA21-12U-AB", 11).write(bench);
  for (const bool as_json : {false, true}) {
    Arguments arguments{"-i", interface, "alloc"};
    if (as_json) {
      arguments.emplace_back("-j");
    }
    Background alloc(bench, arguments, {}, "free: ");
    const Result ended = alloc.stop(SIGINT);
    INFO(ended.err);
    CHECK(ended.status == 130);
    CHECK(codes(ended).empty());
    if (as_json) {
      CHECK(json_lines(ended.out).back()["exit_status"] == 130);
      CHECK(json_lines(ended.out).back()["errors"].empty());
    }
  }
  Background once(bench, {"-i", interface, "alloc", "--count", "5"}, {}, "free: ");
  CHECK(codes(once.stop(SIGINT)).front() == "interrupted");
}

TEST_CASE("a bus on which nobody asks is no failure, unless so many were expected") {
  const Result nobody = three_servos().run({"alloc", "--once", "--wait", "2"});
  CHECK(nobody.status == 0);
  CHECK(contains(nobody.err, "nobody has asked for 2 s"));
  const Result expected = three_servos().run({"alloc", "--once", "--count", "2", "--wait", "2"});
  CHECK(expected.status == 4);
  CHECK(codes(expected) == std::vector<std::string>{"not_found"});
}

TEST_CASE("--count ends as soon as so many have their ID") {
  const Result result = dynamic_servos(3).run({"alloc", "--count", "2"});
  CHECK(result.status == 0);
  CHECK(contains(result.out, "gets node ID 125, new in the table"));
  CHECK_FALSE(contains(result.out, "gets node ID 123"));
}

TEST_CASE("a unit has its ID for ever: the next command gives the same, and the table shows it") {
  const Bench bench;
  const std::string file = scenario(bench, 2);
  const auto run = [&](const Arguments& arguments) {
    const Background sim(bench, {"sim", file});
    return bench.run(arguments);
  };
  const Result first = run({"-i", "sim:", "alloc", "--once", "--range", "30-40", "-j"});
  REQUIRE(first.status == 0);
  const auto given = entries(bench);
  REQUIRE(given.size() == 2);
  CHECK(given[0]["node_id"] == 39);
  CHECK(given[1]["node_id"] == 40);
  const Result again = run({"-i", "sim:", "alloc", "--once", "-j"});
  CHECK(json_lines(again.out).back()["counts"]["kept"] == 2);
  CHECK(json_lines(again.out).back()["counts"]["assigned"] == 0);
  CHECK(entries(bench) == given);
  CHECK(json(bench.run({"alloc", "--list", "-j"}).out)["entries"].empty()); // of real servos
}

TEST_CASE(
    "a beginning of a unique ID, or a servo ID, that a waiting unit may have, is not taken for "
    "the servo that is there") {
  const Bench bench;
  Scene scene;
  const std::string waiting = "a1b20000000000000000000000000001";
  const std::string there = "a1b50000000000000000000000000002";
  scene.servo("BLA21-12U-AB", 0, {{"servo_id", 1}, {"unique_id", waiting}});
  scene.servo("BLA21-12U-AB", 20, {{"servo_id", 1}, {"unique_id", there}});
  const Background sim(bench, {"sim", scene.write(bench)});
  for (const auto* selector : {"uid:a1", "servo:1"}) {
    const Result assigned = bench.run(
        {"-i", "sim:", "alloc", "--static", "--assign", std::string(selector) + "=11", "-y", "-j"});
    INFO(selector << ' ' << assigned.err);
    CHECK(assigned.status == 2);
  }
}

TEST_CASE("a servo that waits is meant by the beginning of its unique ID, and is counted once") {
  Scene scene;
  scene.servo("BLA21-12U-AB", 0, {{"unique_id", "a1b20000000000000000000000000001"}});
  scene.servo("BLA21-12U-AB", 20, {{"unique_id", "c1b50000000000000000000000000002"}});
  for (const Arguments& whom :
       {Arguments{"-n", "uid:a1b2", "--id", "11"}, Arguments{"--assign", "uid:a1b2=11"}}) {
    Arguments arguments{"alloc", "--static", "-y", "-j"};
    arguments.insert(arguments.end(), whom.begin(), whom.end());
    const Result done = scene.run(arguments);
    INFO(done.err);
    CHECK(done.status == 0);
  }
}

TEST_CASE("alloc takes the beginning of a unique ID bare, where it means one servo") {
  Scene scene;
  const std::string first = "a1b20000000000000000000000000001";
  const std::string second = "a1b50000000000000000000000000002";
  scene.servo("BLA21-12U-AB", 11, {{"unique_id", first}});
  scene.servo("BLA21-12U-AB", 12, {{"unique_id", second}});
  scene.servo("BLA21-12U-AB", 13, {{"unique_id", "00130000000000000000000000000003"}});
  const auto assign = [&](const std::string& whom) {
    return scene.run({"alloc", "--static", "--assign", whom + "=20", "-y", "-j"});
  };
  const std::vector<std::pair<const char*, std::string>> cases{
      {"a1b2", first},
      {"A1B5", second},
      {"0013", "00130000000000000000000000000003"},
      {"12", second}, // a node ID stays one
  };
  for (const auto& [whom, meant] : cases) {
    const Result done = assign(whom);
    INFO(whom << ' ' << done.err);
    REQUIRE(done.status == 0);
    CHECK(json_lines(done.out).front()["unique_id"] == meant);
  }
  const Result both = assign("a1b");
  check_error(both, 2, "usage", "a1b");
  CHECK(contains(both.err, "uid:" + first));
  CHECK(contains(both.err, "uid:" + second));
  check_error(assign("a1b7"), 4, "not_found", "a1b7");
  check_error(assign("200"), 2, "usage", "200 does not name one servo");
  check_error(assign(first + "0"), 2, "usage", "does not name one servo");
}

TEST_CASE(
    "-n with a beginning that a waiting unit may have is refused, its whole unique ID is not") {
  Scene scene;
  scene.servo("BLA21-12U-AB", 0, {{"unique_id", "a1b20000000000000000000000000001"}});
  scene.servo("BLA21-12U-AB", 20, {{"unique_id", "a1b50000000000000000000000000002"}});
  const Result refused = scene.run({"set", "-n", "uid:a1", "smoothing=off", "-y", "-j"});
  check_error(refused, 2, "usage", "waits for a node ID");
  CHECK(contains(refused.err, "a1b50000000000000000000000000002 (20)"));
  CHECK(scene.run({"alloc", "--assign", "uid:a1=30", "--once", "-j"}).status == 2);
  CHECK(scene.run({"set", "-n", "uid:a1b5", "smoothing=off", "-y", "-j"}).status == 0);
}

TEST_CASE("what is assigned by hand is given; what is forgotten is free") {
  const Bench bench;
  const std::string file = scenario(bench, 1);
  {
    const Background sim(bench, {"sim", file});
    REQUIRE(bench.run({"-i", "sim:", "alloc", "--once"}).status == 0);
  }
  const std::string uid = entries(bench)[0]["unique_id"];
  const Background sim(bench, {"sim", file});
  const Result moved =
      bench.run({"-i", "sim:", "alloc", "--assign", "uid:" + uid + "=21", "--count", "1"});
  CHECK(moved.status == 0);
  CHECK(contains(moved.out, "gets node ID 21, as the table says"));
  CHECK(bench.run({"-i", "sim:", "alloc", "--forget", uid}).status == 0);
  CHECK(entries(bench).empty());
  const Result gone = bench.run({"-i", "sim:", "alloc", "--forget", uid});
  CHECK(gone.status == 4);
  CHECK(codes(gone) == std::vector<std::string>{"not_found"});
}

TEST_CASE("faults of a file are told one a line, indented") {
  const Bench bench;
  const std::string file =
      bench.file("bad.json", "{\"schema\": \"blactl-allocations/2\",\n\"entries\": 1}");
  const Result result = bench.run({"alloc", "--import", file});
  CHECK(result.status == 2);
  CHECK(contains(result.err, "must be \"blactl-allocations/1\", not \"blactl-allocations/2\"\n"
                             "    " +
                                 file + ":2: /entries: must be an array"));
}

TEST_CASE("a table goes to another machine as a file, whole or not at all") {
  const Bench bench;
  const std::string file =
      bench.file("table.json", R"({"schema": "blactl-allocations/1", "entries": [
        {"unique_id": "00112233445566778899aabbccddeeff", "node_id": 21},
        {"unique_id": "10112233445566778899AABBCCDDEEFF", "node_id": 22,
         "time": "2026-11-21t09:15:00.5+01:00"}]})");
  const Result imported = bench.run({"alloc", "--import", file});
  INFO(imported.err);
  CHECK(imported.status == 0);
  CHECK(contains(imported.out, "entries taken over from "));
  const std::string out = (bench.folder() / "out.json").string();
  CHECK(bench.run({"alloc", "--export", out}).status == 0);
  CHECK(bench.run({"alloc", "--export", out}).status == 0); // its like is replaced
  const std::string other_file = bench.file("wing.json", R"({"schema": "blactl-fleet/1"})");
  check_error(bench.run({"alloc", "--export", other_file, "--json"}), 2, "usage",
              "is there, and is no allocation table");
  const Result printed = bench.run({"alloc", "--export", "-"});
  std::ifstream stream(out);
  std::ostringstream content;
  content << stream.rdbuf();
  CHECK(printed.out == content.str());
  const auto document = nlohmann::json::parse(content.str());
  CHECK(document["schema"] == "blactl-allocations/1");
  CHECK(document["entries"][1]["unique_id"] == "10112233445566778899aabbccddeeff");
  const Bench other;
  CHECK(other.run({"alloc", "--import", out}).status == 0);
  CHECK(json(other.run({"alloc", "--list", "-j"}).out)["entries"].size() == 2);
  SECTION("a file with faults changes nothing, and every fault is named") {
    const std::string bad = bench.file("bad.json",
                                       R"({"schema": "blactl-allocations/1", "entries": [
          {"unique_id": "00", "node_id": 21}, {"unique_id": ")" +
                                           unit + R"(", "node_id": 126},
          {"unique_id": ")" + unit + R"(", "node_id": 5, "name": 1}]})");
    const Result refused = bench.run({"alloc", "--import", bad});
    CHECK(refused.status == 2);
    for (const char* place :
         {"/entries/0:", "/entries/1/node_id:", "/entries/2:", "/entries/2/name:"}) {
      CHECK(contains(refused.err, place));
    }
    CHECK(json(bench.run({"alloc", "--list", "-j"}).out)["entries"].size() == 2);
  }
  SECTION("a time that is none, and a unique ID that no unit has, are faults") {
    const std::string bad =
        bench.file("bad.json", R"({"schema": "blactl-allocations/1", "entries": [
          {"unique_id": "20112233445566778899aabbccddeeff", "node_id": 30, "time": "yesterday"},
          {"unique_id": "00000000000000000000000000000000", "node_id": 31}]})");
    const Result refused = bench.run({"alloc", "--import", bad});
    CHECK(refused.status == 2);
    CHECK(contains(refused.err, "/entries/0/time:"));
    CHECK(contains(refused.err, "/entries/1:"));
  }
  SECTION("an ID that another unit has is a conflict, and nothing is taken over") {
    const std::string taken =
        bench.file("taken.json", R"({"schema": "blactl-allocations/1", "entries": [
          {"unique_id": "20112233445566778899aabbccddeeff", "node_id": 30},
          {"unique_id": "30112233445566778899aabbccddeeff", "node_id": 21}]})");
    const Result refused = bench.run({"alloc", "--import", taken});
    CHECK(refused.status == 9);
    CHECK(codes(refused) == std::vector<std::string>{"duplicate_node_id"});
    CHECK(json(bench.run({"alloc", "--list", "-j"}).out)["entries"].size() == 2);
  }
}

TEST_CASE("another allocator is named, nothing is given, and it ends with 9") {
  Scene scene = dynamic_servos(2);
  scene.foreign(100, {{"kind", "autopilot"}, {"allocates", true}});
  const Result result = scene.run({"alloc", "--once", "-j"});
  CHECK(result.status == 9);
  CHECK(codes(result) == std::vector<std::string>{"other_allocator"});
  CHECK(contains(result.err, "node 100 (org.example.autopilot) allocates node IDs as well"));
  CHECK(events(result).empty());
}

TEST_CASE("a unit that joins under an ID that was just given is a conflict, with both unique IDs") {
  for (const char* at : {"3s", "4s", "4500ms"}) {
    INFO(at);
    const Result result =
        Scene()
            .servo("BLA21-12U-AB", 0, {{"serial_number", 1}, {"unique_id", uid(1)}})
            .servo("BLA21-12U-AB", 125, {{"serial_number", 2}, {"unique_id", uid(2)}})
            .joins(2, at)
            .run({"alloc", "--once", "-j"});
    INFO(result.out << result.err);
    CHECK(result.status == 9);
    CHECK(codes(result) == std::vector<std::string>{"duplicate_node_id"});
    CHECK(contains(result.err, uid(1)));
    CHECK(contains(result.err, uid(2)));
    CHECK(events(result) == std::vector<std::string>{"request", "assigned", "conflict"});
  }
}

TEST_CASE("alloc tells of such a conflict once, and goes on for the others") {
  const Result result = Scene()
                            .servo("BLA21-12U-AB", 0, {{"serial_number", 1}})
                            .servo("BLA21-12U-AB", 125, {{"serial_number", 2}})
                            .servo("BLA21-12U-AB", 0, {{"serial_number", 3}})
                            .servo("BLA21-12U-AB", 0, {{"serial_number", 4}})
                            .joins(2, "8s")
                            .joins(3, "14s")
                            .joins(4, "14s")
                            .run({"alloc", "--count", "2", "-j"});
  INFO(result.out << result.err);
  CHECK(result.status == 6); // one of three has a node ID that is not its own
  CHECK(codes(result) == std::vector<std::string>{"duplicate_node_id"});
  CHECK(events(result) == std::vector<std::string>{"request", "assigned", "conflict", "request",
                                                   "assigned", "request", "assigned"});
}

TEST_CASE("an allocator that is heard only while a servo restarts is told of, too") {
  Scene scene;
  scene.servo("BLA21-12U-AB", 0, {{"serial_number", 1}});
  scene.foreign(100, {{"kind", "autopilot"}, {"allocates", true}});
  const Bench bench;
  const Background sim(bench, {"sim", scene.write(bench)});
  REQUIRE(bench.run({"-i", "sim:", "wait", "-n", "serial:1"}).status == 0);
  const Result result = bench.run({"-i", "sim:", "restart", "-n", "serial:1", "-y"});
  INFO(result.out << result.err);
  CHECK(result.status == 0);
  CHECK(contains(result.err, "node 100 allocates node IDs"));
}

TEST_CASE("two allocators of this machine on one bus do not run at once") {
  const Bench bench;
  const Background sim(bench, {"sim", scenario(bench, 1)});
  const Background first(bench, {"-i", "sim:", "alloc", "-j"}, {}, "assigned");
  const Result second = bench.run({"-i", "sim:", "alloc", "--once"});
  CHECK(second.status == 9);
  CHECK(codes(second) == std::vector<std::string>{"busy"});
}

TEST_CASE("a table that cannot be used refuses before the first answer") {
  const Bench bench;
  const Background sim(bench, {"sim", scenario(bench, 1)});
  const std::filesystem::path table = bench.folder() / "state/simulated/allocations.db";
  std::filesystem::create_directories(table.parent_path());
  std::ofstream(table) << "no database";
  const Result foreign =
      bench.run({"-i", "sim:", "alloc", "--once", "-j"},
                {.env = {{"BLACTL_STATE_DIR", (bench.folder() / "state").string()}}});
  CHECK(foreign.status == 2);
  CHECK(codes(foreign) == std::vector<std::string>{"bad_file"});
  CHECK(events(foreign).empty());
  std::ifstream stream(table);
  std::string content;
  std::getline(stream, content);
  CHECK(content == "no database");
  CHECK(bench.run({"-i", "sim:", "alloc", "--once"}).status == 0); // elsewhere
}

TEST_CASE("what is asked of alloc wrongly is refused with all faults, and nothing is sent") {
  const std::vector<std::pair<Arguments, std::string>> cases{
      {{"alloc", "--range", "10"}, "--range 10: not a range of node IDs"},
      {{"alloc", "--range", "99-10"}, "not a range of node IDs"},
      {{"alloc", "--range", "1-126"}, "not a range of node IDs"},
      {{"alloc", "--assign", unit}, "SELECTOR=ID is needed"},
      {{"alloc", "--assign", "11-12=21"}, "11-12 does not name one servo"},
      {{"alloc", "--assign", unit + "=126"}, "node ID 126 cannot be allocated"},
      {{"alloc", "--assign", unit + "=21", "--assign", unit + "=22"}, "was given before"},
      {{"alloc", "--forget", "serial:x"}, "serial:x does not name one servo"},
      {{"alloc", "--list", "--once"}, "--once and --list do not go together"},
      {{"alloc", "--import", "a", "--export", "b"}, "--export and --import do not go together"},
      {{"alloc", "--listen-only"}, "alloc"},
  };
  for (const auto& [arguments, said] : cases) {
    const Result result = three_servos().run(arguments);
    INFO(result.err);
    CHECK(result.status == 2);
    CHECK(contains(result.err, said));
    CHECK(codes(result).front() == (said.find("node ID 126") == 0 ? "out_of_range" : "usage"));
  }
}

namespace {

/// 11, 12 and 13, which can be named by these unique IDs. `servo_ids`: 1 gives each its own.
Scene named_servos(int servo_ids = 0) {
  Scene scene;
  for (int i = 1; i <= 3; ++i) {
    scene.servo("BLA21-12U-AB", 10 + i,
                {{"serial_number", i}, {"unique_id", uid(i)}, {"servo_id", servo_ids * i}});
  }
  return scene;
}

/// What a stream says is static now: the unit's last digits and its node ID.
std::vector<std::pair<std::string, int>> made_static(const Result& result,
                                                     const char* event = "made_static") {
  std::vector<std::pair<std::string, int>> all;
  for (const auto& line : json_lines(result.out)) {
    if (line.contains("event") && line["event"] == event) {
      all.emplace_back(line["unique_id"].get<std::string>().substr(30), line["node_id"]);
    }
  }
  return all;
}

using Made = std::vector<std::pair<std::string, int>>;

} // namespace

TEST_CASE("alloc --static makes the IDs that servos have permanent, or gives one another") {
  const Result all = named_servos().run({"alloc", "--static", "-n", "all", "-y", "-j"});
  INFO(all.err);
  CHECK(all.status == 0);
  CHECK(made_static(all).empty()); // they have them by their ROM, as a restart shows
  CHECK(made_static(all, "kept") == Made{{"01", 11}, {"02", 12}, {"03", 13}});
  const auto counts = json_lines(all.out).back()["counts"];
  CHECK(counts["made_static"] == 0);
  CHECK(counts["kept"] == 3);
  const Result one =
      named_servos().run({"alloc", "--static", "-n", "12", "--id", "50", "-y", "-j"});
  CHECK(one.status == 0);
  CHECK(made_static(one) == Made{{"02", 50}});
}

TEST_CASE("alloc --static lets servos exchange and rotate their IDs by way of a free one") {
  const Result swapped = named_servos(1).run(
      {"alloc", "--static", "--assign", uid(1) + "=12", "--assign", uid(2) + "=11", "-y", "-j"});
  INFO(swapped.err);
  CHECK(swapped.status == 0);
  CHECK(made_static(swapped) == Made{{"02", 11}, {"01", 12}});
  CHECK(contains(swapped.err, "node 11 makes way for others"));
  CHECK_FALSE(contains(swapped.err, "the same servo ID")); // of who has moved meanwhile
  const Result rotated =
      named_servos().run({"alloc", "--static", "--assign", uid(1) + "=12", "--assign",
                          uid(2) + "=13", "--assign", uid(3) + "=11", "-y", "-j"});
  CHECK(rotated.status == 0);
  CHECK(made_static(rotated) == Made{{"03", 11}, {"02", 13}, {"01", 12}});
}

TEST_CASE("alloc --static gives a servo that asks for an ID one, and then its static one") {
  Scene scene = named_servos();
  scene.servo("BLA21-12U-AB", 0, {{"serial_number", 4}, {"unique_id", uid(4)}});
  const Result result = scene.run(
      {"alloc", "--static", "--assign", uid(4) + "=12", "--assign", uid(2) + "=40", "-y", "-j"});
  INFO(result.err);
  CHECK(result.status == 0);
  CHECK(made_static(result) == Made{{"02", 40}, {"04", 12}});
}

TEST_CASE("alloc --static keeps its IDs in the table, where no other unit gets them") {
  const Bench bench;
  const Background sim(bench, {"sim", named_servos().write(bench)});
  REQUIRE(bench.run({"-i", "sim:", "alloc", "--static", "-n", "11", "--id", "20", "-y"}).status ==
          0);
  const auto kept = entries(bench);
  REQUIRE(kept.size() == 1);
  CHECK(kept[0]["node_id"] == 20);
  // A wish takes over what the table promised to a unit that is away, and says so.
  REQUIRE(bench
              .run({"-i", "sim:", "alloc", "--assign", uid(9) + "=30", "--count", "1", "--once",
                    "--wait", "2"})
              .status == 4);
  const Result taken =
      bench.run({"-i", "sim:", "alloc", "--static", "-n", "12", "--id", "30", "-y"});
  CHECK(taken.status == 0);
  CHECK(contains(taken.err, "node ID 30 was given to uid:" + uid(9)));
  CHECK(entries(bench).back()["unique_id"] == uid(2));
}

TEST_CASE(
    "the table tells the IDs that servos have: kept ones, and where one does not take another") {
  const Bench bench;
  Scene scene = named_servos().servo(
      "BLA21-12U-AB", 14,
      {{"serial_number", 4}, {"unique_id", uid(4)}, {"faults", {{"rom_write_fails", true}}}});
  const Background sim(bench, {"sim", scene.write(bench)});
  CHECK(bench.run({"-i", "sim:", "alloc", "--static", "-n", "12", "-y"}).status == 0);
  const auto kept = entries(bench);
  REQUIRE(kept.size() == 1);
  CHECK(kept[0]["node_id"] == 12);
  CHECK(kept[0]["unique_id"] == uid(2));
  const Result failed = bench.run({"-i", "sim:", "alloc", "--static", "--assign", uid(4) + "=12",
                                   "--assign", uid(2) + "=14", "-y"});
  INFO(failed.out << failed.err);
  CHECK(failed.status != 0);
  const auto servos = json(bench.run({"-i", "sim:", "scan", "-j"}).out)["nodes"];
  const auto table = entries(bench);
  CHECK(table.size() == 2);
  for (const auto& entry : table) {
    INFO(entry.dump());
    CHECK(std::ranges::any_of(servos, [&](const nlohmann::json& servo) {
      return servo["node_id"] == entry["node_id"] && servo["unique_id"] == entry["unique_id"];
    }));
  }
}

TEST_CASE("alloc --static refuses before anything is written") {
  struct Case {
    Arguments arguments;
    int status;
    std::string code, said;
  };

  const std::vector<Case> cases{
      {{"alloc", "--static", "-y"}, 2, "usage", "several servos are on the bus"},
      {{"alloc", "--static", "-n", "11", "--id", "12", "-y"},
       9,
       "duplicate_node_id",
       "node 11 would get node ID 12"},
      {{"alloc", "--static", "-n", "11,12", "--id", "20", "-y"}, 2, "usage", "2 servos are meant"},
      {{"alloc", "--static", "-n", "11", "--id", "126", "-y"}, 2, "usage", "--id 126"},
      {{"alloc", "--static", "-n", "55", "-y"}, 4, "not_found", "55"},
      {{"alloc", "--static", "--assign", uid(9) + "=20", "-y"}, 4, "not_found", uid(9)},
      {{"alloc", "--static", "-n", "11"}, 7, "not_confirmed", "torque may come on"},
      {{"alloc", "--static", "-n", "11", "--id", "20"}, 7, "not_confirmed", "torque is on"},
      {{"alloc", "--static", "-n", "11", "--once"}, 2, "usage", "do not go together"},
      {{"alloc", "--static", "-n", "11", "--assign", uid(1) + "=20"},
       2,
       "usage",
       "--node and --assign do not go together"},
      {{"alloc", "-n", "11"}, 2, "usage", "--node needs --static"},
      {{"alloc", "--id", "11"}, 2, "usage", "--id needs --static"},
      {{"--listen-only", "alloc", "--static", "-n", "11"}, 2, "usage", "alloc --static"},
  };
  for (const auto& [arguments, status, code, said] : cases) {
    const Bench bench;
    const Background sim(bench, {"sim", "-j", named_servos().write(bench)});
    Arguments whole{"-i", "sim:"};
    whole.insert(whole.end(), arguments.begin(), arguments.end());
    const Result result = bench.run(whole);
    INFO(said << '\n' << result.err);
    CHECK(result.status == status);
    CHECK(codes(result) == std::vector<std::string>{code});
    CHECK(contains(result.err, said));
    const auto servos = json(bench.run({"-i", "sim:", "get", "0x46", "-j"}).out)["nodes"];
    for (const auto& servo : servos) {
      CHECK(servo["params"][0]["raw"] == servo["node_id"]);
    }
  }
}

TEST_CASE("alloc --static is refused while another node drives a servo, or says armed") {
  Scene driven = named_servos();
  driven.foreign(100,
                 {{"kind", "autopilot"},
                  {"commands", {{"servo_ids", {0}}, {"type", 0}, {"value", 0.1}, {"rate", 50}}}});
  const Result refused = driven.run({"alloc", "--static", "-n", "11", "-y", "-j"});
  CHECK(refused.status == 9);
  CHECK(codes(refused) == std::vector<std::string>{"driven"});
  CHECK(made_static(refused).empty());
  CHECK(driven.run({"alloc", "--static", "-n", "11", "-y", "--while-driven"}).status == 0);
  Scene armed = named_servos();
  armed.foreign(100, {{"kind", "autopilot"}, {"armed", true}});
  CHECK(codes(armed.run({"alloc", "--static", "-n", "11", "-y"})) ==
        std::vector<std::string>{"armed"});
}

TEST_CASE("alloc --static writes to neither of two units on one ID, whichever it is asked for") {
  for (const int unit : {1, 2}) {
    const Result result =
        Scene()
            .servo("BLA21-12U-AB", 11, {{"serial_number", 1}, {"unique_id", uid(1)}})
            .servo("BLA21-12U-AB", 11, {{"serial_number", 2}, {"unique_id", uid(2)}})
            .run({"alloc", "--static", "--assign", uid(unit) + "=20", "-y"});
    INFO(result.err);
    CHECK(result.status == 9);
    CHECK(codes(result) == std::vector<std::string>{"duplicate_node_id"});
    CHECK(contains(result.err, uid(1)));
    CHECK(contains(result.err, uid(2)));
  }
}

TEST_CASE("a table on stdout leaves no place for a report in JSON") {
  const Bench bench;
  check_error(bench.run({"-i", "sim:", "alloc", "--export", "-", "--json"}), 2, "usage",
              "both would be on stdout");
}

TEST_CASE("an ID that was to be taken over, and was not, is its former unit's again") {
  const Fleet fleet(Scene().servo("BLA21-12U-AB", 12,
                                  {{"serial_number", 1}, {"faults", {{"refuse_opcodes", true}}}}));
  const std::string away = "00112233445566778899aabbccddeeff";
  Document table{{"schema", "blactl-allocations/1"}, {"entries", Document::array()}};
  table["entries"].push_back({{"unique_id", away}, {"node_id", 20}});
  REQUIRE(fleet.run({"alloc", "--import", fleet.file(table)}).status == 0);
  const Result failed = fleet.run({"alloc", "--static", "-n", "12", "--id", "20", "-y"});
  CHECK(codes(failed) == std::vector<std::string>{"refused"});
  bool is_promised = false;
  const auto list = json(fleet.run({"alloc", "--list", "-j"}).out);
  for (const auto& entry : list["entries"]) {
    is_promised = is_promised || (entry["unique_id"] == away && entry["node_id"] == 20);
  }
  CHECK(is_promised);
}

namespace {

/// The node IDs by serial number, as scan finds them.
std::map<int, int> by_serial(const Bench& bench) {
  std::map<int, int> ids;
  const auto scanned = json(bench.run({"-i", "sim:", "scan", "-j"}).out);
  for (const auto& node : scanned["nodes"]) {
    if (node["serial_number"].is_number()) { // else it is the command before
      ids[node["serial_number"].get<int>()] = node["node_id"].get<int>();
    }
  }
  return ids;
}

} // namespace

TEST_CASE("one command numbers new servos, by serial number, on one robot after the other") {
  const Bench bench;
  for (const int first : {1, 101, 201}) {
    const Background sim(bench, {"sim", scenario(bench, 3, first)});
    const Result result =
        bench.run({"-i", "sim:", "alloc", "--static", "-n", "all", "--range", "11-13", "-y", "-j"});
    INFO(result.out << result.err);
    CHECK(result.status == 0);
    CHECK(by_serial(bench) == std::map<int, int>{{first, 11}, {first + 1, 12}, {first + 2, 13}});
    CHECK(contains(result.err, "which is not on this bus") == (first != 1));
    const Result one = bench.run({"-i", "sim:", "alloc", "--static", "--assign",
                                  "serial:" + std::to_string(first + 1) + "=33", "-y"});
    CHECK(one.status == 0);
    CHECK(by_serial(bench)[first + 1] == 33);
  }
}

TEST_CASE("a servo that waits is told by its serial number, and the others get no static ID") {
  const Bench bench;
  const Background sim(bench, {"sim", scenario(bench, 3)});
  const Result result =
      bench.run({"-i", "sim:", "alloc", "--static", "--assign", "serial:2=20", "-y", "-j"});
  INFO(result.out << result.err);
  CHECK(result.status == 0);
  CHECK(made_static(result).size() == 1);
  CHECK(by_serial(bench)[2] == 20);
  const Result unknown = bench.run({"-i", "sim:", "alloc", "--static", "--assign", "serial:9=21"});
  CHECK(unknown.status == 4);
  CHECK(contains(unknown.err, "no servo on the bus matches serial:9"));
}

TEST_CASE("an ID for the time being is no reason to leave the order of serial numbers") {
  const Bench bench;
  const Background sim(bench, {"sim", scenario(bench, 4)});
  const Result result =
      bench.run({"-i", "sim:", "alloc", "--static", "-n", "all", "--range", "122-125", "-y", "-j"});
  INFO(result.out << result.err);
  CHECK(result.status == 0);
  CHECK(by_serial(bench) == std::map<int, int>{{1, 122}, {2, 123}, {3, 124}, {4, 125}});
}

TEST_CASE("the ID that one servo is to get is nobody's for the time being") {
  for (const int servo : {1, 2, 3}) {
    const Bench bench;
    const Background sim(bench, {"sim", scenario(bench, 3)});
    const Result result = bench.run({"-i", "sim:", "alloc", "--static", "--assign",
                                     "serial:" + std::to_string(servo) + "=125", "-y", "-j"});
    INFO(result.out << result.err);
    CHECK(result.status == 0);
    CHECK(by_serial(bench)[servo] == 125);
  }
}

TEST_CASE("one servo named twice is refused, however it is named") {
  const Bench bench;
  const Background sim(bench, {"sim", scenario(bench, 1)});
  REQUIRE(bench.run({"-i", "sim:", "alloc", "--once"}).status == 0);
  for (const char* kind : {"--static", "--once"}) {
    const Result result = bench.run(
        {"-i", "sim:", "alloc", kind, "--assign", "serial:1=20", "--assign", "125=21", "-y"});
    CHECK(result.status == 2);
    CHECK(contains(result.err, "which was named before"));
  }
}

TEST_CASE("a range that is too small is told before anything is permanent") {
  const Bench bench;
  const Background sim(bench, {"sim", scenario(bench, 3)});
  const Result result =
      bench.run({"-i", "sim:", "alloc", "--static", "-n", "all", "--range", "11-12", "-y", "-j"});
  CHECK(result.status == 9);
  CHECK(codes(result) == std::vector<std::string>{"table_full"});
  const auto scanned = json(bench.run({"-i", "sim:", "scan", "-j"}).out);
  REQUIRE(scanned["nodes"].size() == 3);
  for (const auto& node : scanned["nodes"]) {
    CHECK(node["static_node_id"] == 0);
  }
}

TEST_CASE("ways to give IDs exclude each other, and what does not name one servo is refused") {
  const std::vector<Arguments> all{{"--range", "11-12", "--assign", "serial:1=11"},
                                   {"--range", "11-12", "-n", "11", "--id", "12"},
                                   {"--assign", "all=11"},
                                   {"--assign", "11-12=11"},
                                   {"--assign", "serial:1=11", "--assign", "serial:1=12"},
                                   {"--assign", "serial:1=11", "--assign", "serial:2=11"},
                                   {"--range", "12-11"}};
  for (const Arguments& each : all) {
    Arguments arguments{"alloc", "--static", "-y"};
    arguments.insert(arguments.end(), each.begin(), each.end());
    const Result result = three_servos().run(arguments);
    INFO(each.back() << result.err);
    CHECK(result.status == 2);
  }
}

TEST_CASE("a wish for a servo of the bus is entered, unless another node has that ID") {
  const Bench bench;
  const Background sim(bench, {"sim", scenario(bench, 2)});
  REQUIRE(bench.run({"-i", "sim:", "alloc", "--once"}).status == 0);
  const Result wished =
      bench.run({"-i", "sim:", "alloc", "--once", "--wait", "2", "--assign", "serial:1=50"});
  CHECK(wished.status == 0);
  CHECK(contains(wished.err, "gets node ID 50 when it asks"));
  std::set<int> promised;
  for (const auto& entry : entries(bench)) {
    promised.insert(entry["node_id"].get<int>());
  }
  CHECK(promised.contains(50)); // that it has another one now is no reason
  CHECK(bench.run({"-i", "sim:", "alloc", "--once", "--wait", "2"}).status == 0);
  CHECK(entries(bench)[0]["node_id"] == 50);
  const int other = by_serial(bench)[2];
  const Result taken = bench.run({"-i", "sim:", "alloc", "--once", "--wait", "2", "--assign",
                                  "serial:1=" + std::to_string(other)});
  CHECK(taken.status == 9);
  CHECK(codes(taken) == std::vector<std::string>{"duplicate_node_id"});
  CHECK(contains(taken.err, "another node on this bus has it"));
}

TEST_CASE("units leave the table by a beginning, by what the bus tells, or all that are away") {
  const Bench bench;
  {
    const Background sim(bench, {"sim", scenario(bench, 2, 101)});
    REQUIRE(bench.run({"-i", "sim:", "alloc", "--once"}).status == 0);
  }
  const Background sim(bench, {"sim", scenario(bench, 2)});
  REQUIRE(bench.run({"-i", "sim:", "alloc", "--once"}).status == 0);
  REQUIRE(entries(bench).size() == 4);
  CHECK(bench.run({"-i", "sim:", "alloc", "--forget", "absent"}).status == 7);
  REQUIRE(entries(bench).size() == 4);
  CHECK(bench.run({"-i", "sim:", "alloc", "--forget", "absent", "-y"}).status == 0);
  REQUIRE(entries(bench).size() == 2);
  CHECK(bench.run({"-i", "sim:", "alloc", "--forget", "serial:101"}).status == 4);
  CHECK(bench.run({"-i", "sim:", "alloc", "--forget", "serial:1"}).status == 0);
  REQUIRE(entries(bench).size() == 1);
  const std::string digits = entries(bench)[0]["unique_id"];
  CHECK(bench.run({"-i", "sim:", "alloc", "--forget", digits.substr(0, 6)}).status == 0);
  CHECK(entries(bench).empty());
  CHECK(bench.run({"-i", "sim:", "alloc", "--forget", "all", "-y"}).status == 0);
}
