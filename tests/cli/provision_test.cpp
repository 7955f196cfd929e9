// The station of a production line, and its ledger.

#include "catch.hpp"
#include "line.hpp"
#include "run.hpp"
#include "scene.hpp"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

using namespace blactl::test;

TEST_CASE("one servo after the other is numbered, configured, proven and recorded") {
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 30},
                                          {.serial = 102, .from = 40, .to = 70},
                                          {.serial = 103, .from = 80, .to = 110, .node_id = 55},
                                          {.serial = 101, .from = 120, .to = 130}}),
                                    {"--count", "4", "--station", "A", "--operator", "Sato"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 11; pass 2 12; pass 3 13; skip 1 11");
  CHECK(run.result.status == 0);
  CHECK(run.last["counts"]["pass"] == 3);
  CHECK(run.last["counts"]["skip"] == 1);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& record = run.records[i];
    CHECK(record["serial_number"] == 101 + i);
    CHECK(record["station"] == "A");
    CHECK(record["station_seq"] == i + 1);
    CHECK(record["operator"] == "Sato");
    CHECK(record["node_id"] == (i < 2 ? 0 : 55));
    CHECK(record["node_id_after"] == 11 + i);
    CHECK(record["attempt"] == 1);
    CHECK(record["changed_count"] == 3);
    CHECK(record["config_sha256"].get<std::string>().size() == 64);
    CHECK(record["model"] == "BLA21-12U-AB");
  }
  CHECK(run.records[0]["config_sha256"] != run.records[1]["config_sha256"]); // the IDs differ
  CHECK(run.records[0]["record_id"] != run.records[1]["record_id"]);
}

TEST_CASE("another unit on the node ID of the one before is no second one") {
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 20, .node_id = 1},
                                          {.serial = 102, .from = 25, .to = 45, .node_id = 1},
                                          {.serial = 103, .from = 50, .to = 70, .node_id = 1}}),
                                    {"--count", "3"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 11; pass 2 12; pass 3 13");
}

TEST_CASE("what must not pass does not, and says why") {
  struct Wrong {
    std::string told;
    Visit visit;
    int status;
  };

  const auto wrong = GENERATE(
      Wrong{"fail model_mismatch", {.serial = 1, .from = 1, .to = 60, .model = "BLA34-12U-AB"}, 9},
      Wrong{"fail firmware_too_old",
            {.serial = 1, .from = 1, .to = 60, .more = {{"firmware_version", 1200}}},
            9},
      Wrong{"fail duplicate_unique_id",
            {.serial = 1,
             .from = 1,
             .to = 60,
             .node_id = 5,
             .more = {{"unique_id", "00000000000000000000000000000000"}}},
            9});
  const Provisioned run = provision(line({wrong.visit}), {"--count", "1"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == wrong.told);
  CHECK(run.result.status == wrong.status);
  REQUIRE(run.records.size() == 1);
  CHECK(run.records[0]["serial_number"] == 1);
  CHECK(run.records[0]["static_node_id"] != 11); // nothing was written
}

TEST_CASE("two servos at once are put off, and their label waits") {
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 12, .node_id = 7},
                                          {.serial = 102, .from = 1, .to = 14, .node_id = 8},
                                          {.serial = 101, .from = 20, .to = 60}}),
                                    {"--count", "1", "--label", "-"}, {.stdin_text = "101\n"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "error several_servos; pass 1 11");
  CHECK(run.records[1]["label"] == "101");
  CHECK(run.result.status == 6);
}

TEST_CASE("a servo that is pulled early is done again, with the same IDs") {
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 5, .node_id = 7},
                                          {.serial = 101, .from = 15, .to = 60}}),
                                    {"--count", "1"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "error not_back; pass 1 11");
  CHECK(run.records[1]["attempt"] == 2);
}

TEST_CASE("labels are compared, and tell IDs") {
  const Provisioned run =
      provision(line({{.serial = 101, .from = 1, .to = 30},
                      {.serial = 102, .from = 40, .to = 70},
                      {.serial = 103, .from = 80, .to = 110}}),
                {"--label", "-"},
                {.stdin_text = "101\nnonsense\n\n999\n"
                               R"({"serial_number": 103, "servo_id": 7, "work_order": "W9"})"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 11; fail label_mismatch; pass 7 12");
  CHECK(run.records[1]["parameter"] == "serial_number");
  CHECK(run.records[1]["expected"] == 999);
  CHECK(run.records[1]["actual"] == 102);
  CHECK(run.records[2]["work_order"] == "W9");
  CHECK(run.result.status == 6);
  CHECK(contains(run.result.err, "nonsense"));
}

TEST_CASE("a unit may fail so often, and a run of failures ends the run") {
  std::vector<Visit> visits;
  for (int i = 0; i < 3; ++i) {
    visits.push_back({.serial = 101, .from = 1 + 40.0 * i, .to = 30 + 40.0 * i});
  }
  SECTION("the unit") {
    visits[0].more = {{"faults", {{"rom_write_fails", true}}}};
    const Provisioned run = provision(line(visits), {"--count", "3", "--max-attempts", "2"});
    INFO(run.result.out << run.result.err);
    CHECK(run.told() == "fail mismatch; fail mismatch; fail attempts");
    CHECK(run.records[0]["parameter"] == "angle_limit_cw");
    CHECK(run.records[0]["expected"] == 450);
    CHECK(run.records[1]["attempt"] == 2);
  }
  SECTION("the run") {
    visits[0].model = "BLA34-12U-AB";
    const Provisioned run = provision(line(visits), {"--stop-after", "2"});
    INFO(run.result.out << run.result.err);
    CHECK(run.told() == "fail model_mismatch; fail model_mismatch");
  }
}

TEST_CASE("a run that waits in vain ends, and says what is missing") {
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 30}}),
                                    {"--count", "2", "--idle-timeout", "60"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 11");
  CHECK(run.result.status == 4);
  CHECK(provision(line({{.serial = 101, .from = 1, .to = 30}}), {"--idle-timeout", "60"})
            .result.status == 0);
}

TEST_CASE("a result that cannot be written is a failure, in every format") {
  const Bench bench;
  const Scene scene = line({{.serial = 101, .from = 1, .to = 30}});
  for (const char* format : {"--json", "--csv", "--quiet"}) {
    INFO(format);
    const Result result = scene.run(
        bench, {"provision", bench.file("recipe.json", line_recipe), "-y", "--count", "1", format},
        {.stdout_file = "/dev/full"});
    CHECK(result.status == 1);
    CHECK(codes(result) == std::vector<std::string>{"io"});
  }
}

TEST_CASE("a lamp is told what happens, and a disk that is full is told in the end") {
  const Bench bench;
  const Scene scene = line({{.serial = 101, .from = 1, .to = 30}});
  const std::string file = (bench.folder() / "events").string();
  Arguments arguments{"provision", bench.file("recipe.json", line_recipe), "-y", "--count", "1",
                      "--events"};
  arguments.push_back(file);
  REQUIRE(scene.run(bench, arguments).status == 0);
  std::string all;
  for (const auto& event : json_lines(content(file))) {
    all += event["event"].get<std::string>() + " ";
    CHECK(event["time"].is_number());
  }
  CHECK(all == "waiting recognised working pass ");
  arguments.back() = "/dev/full";
  CHECK(scene.run(bench, arguments).status == 1);
  arguments.back() = "-";
  CHECK(scene.run(bench, arguments).status == 2);
}

TEST_CASE("the frames of a servo that did not pass are kept, named by its record") {
  const Bench bench;
  const Scene scene = line({{.serial = 101, .from = 1, .to = 30},
                            {.serial = 102, .from = 40, .to = 60, .model = "BLA34-12U-AB"},
                            {.serial = 103, .from = 70, .to = 90}});
  const std::string folder = (bench.folder() / "logs" / "line").string();
  const Result result = scene.run(bench, {"provision", bench.file("recipe.json", line_recipe), "-y",
                                          "--count", "3", "--json", "--logs", folder});
  const auto records = json_lines(result.out);
  REQUIRE(records.size() == 4);
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  const std::string failed = records[1]["record_id"].get<std::string>() + ".log";
  CHECK(names == std::set<std::string>{failed, "present.log"});
  const Result replayed = bench.run({"-i", "replay:" + folder + "/" + failed, "scan", "--json"});
  std::set<nlohmann::json> serials; // that of our own node is null
  const auto document = json(replayed.out);
  for (const auto& node : document["nodes"]) {
    serials.insert(node["serial_number"]);
  }
  CHECK(serials == std::set<nlohmann::json>{nullptr, 102});
  CHECK(scene
            .run(bench, {"provision", bench.file("recipe.json", line_recipe), "-y", "--logs",
                         folder, "--record", folder + "/x.log"})
            .status == 2);
  CHECK(scene
            .run(bench, {"provision", bench.file("recipe.json", line_recipe), "-y", "--logs",
                         "/dev/null/x"})
            .status == 1);
}

TEST_CASE("a file that is no log of ours, or another station's, is not replaced by present.log") {
  const Bench bench;
  const std::filesystem::path folder = bench.folder() / "logs";
  std::filesystem::create_directories(folder);
  const std::string present = (folder / "present.log").string();
  const Scene scene = line({{.serial = 101, .from = 1, .to = 30}});
  const Arguments command{
      "provision",    bench.file("recipe.json", line_recipe), "-y", "--count", "1", "--logs",
      folder.string()};
  SECTION("it is something else") {
    std::ofstream(present) << "the notes of a person\n";
    const Result refused = scene.run(bench, command);
    CHECK(refused.status == 2);
    CHECK(contains(refused.err, "present.log"));
    CHECK(content(present) == "the notes of a person\n");
  }
  SECTION("another station writes it") {
    std::ofstream(present) << "(1700000000.000000) can0 1001557F#00\n";
    const int other = open(present.c_str(), O_RDONLY | O_CLOEXEC);
    REQUIRE(flock(other, LOCK_EX | LOCK_NB) == 0);
    const Result refused = scene.run(bench, command);
    close(other);
    CHECK(refused.status == 9);
    CHECK(codes(refused) == std::vector<std::string>{"busy"});
    CHECK(contains(content(present), "1001557F#00"));
  }
  SECTION("it is that of a run that has ended") {
    std::ofstream(present) << "(1700000000.000000) can0 1001557F#00\n";
    CHECK(scene.run(bench, command).status == 0);
    CHECK_FALSE(contains(content(present), "1001557F#00"));
  }
}

TEST_CASE("a node ID that the recipe gives is not that of the station itself") {
  const Scene scene = line({{.serial = 101, .from = 1, .to = 30}});
  for (const char* own : {"11", "18"}) {
    const Provisioned run = provision(scene, {"--local-node-id", own, "--count", "1"});
    INFO(run.result.out << run.result.err);
    CHECK(run.result.status == 2);
    CHECK(run.records.empty());
    CHECK(contains(run.result.err, "11-18"));
    CHECK(contains(run.result.err, "leave out --local-node-id"));
  }
  for (const char* own : {"10", "19", "127"}) {
    CHECK(provision(scene, {"--local-node-id", own, "--count", "1"}).told() == "pass 1 11");
  }
}

TEST_CASE("provision refuses what it could not do, before anything is opened") {
  const Scene scene = line({{.serial = 101, .from = 1, .to = 30}});
  CHECK(provision(scene, {"--redo"}).result.status == 2);
  CHECK(provision(scene, {"--reason", "x"}).result.status == 2);
  CHECK(provision(scene, {"--label", "file"}).result.status == 2);
  CHECK(provision(scene, {"-n", "11"}).result.status == 2);
  CHECK(provision(scene, {"--profile", "BLA21-12U-AB"}).result.status == 2);
  CHECK(provision(scene, {"--range", "126-127"}).result.status != 0);
  const Bench bench;
  const Result unasked =
      scene.run(bench, {"provision", bench.file("recipe.json", line_recipe), "--count", "1"});
  CHECK(unasked.status == 7);
}

TEST_CASE("the ledger lists, filters, scraps, checks and is copied") {
  const Hall hall({{.serial = 101, .from = 1, .to = 20}, {.serial = 102, .from = 25, .to = 3000}});
  const Result run = hall.provision({"--count", "2"});
  INFO(run.out << run.err);
  REQUIRE(run.status == 0);
  const auto records = hall.ledger();
  REQUIRE(records.size() == 2);
  auto lines = json_lines(run.out);
  lines.pop_back();
  CHECK(records == lines);
  CHECK(hall.ledger({"--serial", "102"}) == std::vector{records[1]});
  CHECK(hall.ledger({"--station", "B"}).empty());
  CHECK(hall.ledger({"--verdict", "fail"}).empty());
  CHECK(hall.ledger({"--since", records[1]["time"].get<std::string>()}).back() == records[1]);
  CHECK(hall.ledger({"--until", "2020-01-01T00:00:00Z"}).empty());
  CHECK(hall.run({"ledger", "--since", "yesterday"}).status == 2);
  CHECK(hall.run({"ledger", "--check"}).status == 0);

  const std::string passed = records[0]["record_id"];
  CHECK(hall.run({"ledger", "--scrap", passed}).status == 2);
  CHECK(hall.run({"ledger", "--scrap", "none", "--reason", "x", "-y"}).status == 4);
  CHECK(hall.run({"ledger", "--scrap", passed, "--reason", "bent horn"}).status == 7);
  const Result scrapped = hall.run({"ledger", "--scrap", passed, "--reason", "bent horn", "-y"});
  CHECK(scrapped.status == 0);
  CHECK(hall.run({"ledger", "--scrap", passed, "--reason", "again", "-y"}).out == scrapped.out);
  const auto scrap = hall.ledger({"--verdict", "scrap"});
  REQUIRE(scrap.size() == 1);
  CHECK(scrap[0]["refers_to"] == passed);
  CHECK(scrap[0]["reason"] == "bent horn");
  CHECK(scrap[0]["serial_number"] == 101);

  const std::string copy = (hall.bench().folder() / "copy.db").string();
  CHECK(hall.run({"ledger", "--backup", copy}).status == 0);
  CHECK(hall.run({"ledger", "--backup", copy}).status == 2);
  CHECK(hall.run({"ledger", "--check", "--serial", "1"}).status == 2);
  CHECK(contains(hall.run({"ledger", "--csv"}).out, "record_id,time,start_time,verdict,code,"));
}

TEST_CASE("the IDs of a scrapped servo are the next to be given, so that a set is completed") {
  const Hall hall({{.serial = 101, .from = 1, .to = 20},
                   {.serial = 102, .from = 25, .to = 45},
                   {.serial = 103, .from = 50, .to = 70},
                   {.serial = 104, .from = 75, .to = 3000}});
  REQUIRE(hall.provision({"--count", "3"}).status == 0);
  const std::string second = hall.ledger({"--serial", "102"})[0]["record_id"];
  REQUIRE(hall.run({"ledger", "--scrap", second, "--reason", "x", "-y"}).status == 0);
  REQUIRE(hall.provision({"--count", "2"}).status == 0); // the third is still there
  const auto next = hall.ledger({"--serial", "104"});
  REQUIRE(next.size() == 1);
  CHECK(next[0]["servo_id"] == 2);
  CHECK(next[0]["static_node_id"] == 12);
}

TEST_CASE("a name of a station is that of one process, and a servo at work is not scrapped") {
  const Hall hall({{.serial = 101, .from = 1, .to = 20}, {.serial = 102, .from = 25, .to = 3000}});
  REQUIRE(hall.provision({"--count", "1"}).status == 0);
  const std::string passed = hall.ledger()[0]["record_id"];
  {
    const Background station(
        hall.bench(), {"-i", "sim:", "provision", hall.recipe_file(), "-y", "--station", "A"},
        {.terminal = true}, "connect a servo");
    CHECK(hall.provision({"--count", "1"}).status == 9);
  }
  CHECK(hall.run({"ledger", "--scrap", passed, "--reason", "x", "-y"}).status == 0);
}

TEST_CASE("a recipe that has changed, or a unit that was begun anew, is no reason to skip") {
  const Hall hall({{.serial = 101, .from = 1, .to = 3000}});
  REQUIRE(hall.provision({"--count", "1"}).status == 0);
  CHECK(json_lines(hall.provision({"--count", "1"}).out)[0]["verdict"] == "skip");
  {
    Background station(hall.bench(),
                       {"-i", "sim:", "provision", hall.recipe_file(), "-y", "--station", "A",
                        "--redo", "--reason", "x"},
                       {.terminal = true}, "do not take it off");
    station.kill();
  }
  const auto again = json_lines(hall.provision({"--count", "1"}).out);
  CHECK(again[0]["code"] == "interrupted");
  CHECK(again[1]["verdict"] == "pass");
  std::string other = line_recipe;
  other.replace(other.find("45.0deg"), 7, "40.0deg");
  const std::string file = hall.bench().file("other.json", other);
  const Result changed =
      hall.run({"provision", file, "-y", "--json", "--station", "A", "--count", "1"});
  const auto record = json_lines(changed.out)[0];
  CHECK(record["verdict"] == "pass");
  CHECK(record["servo_id"] == 1); // it keeps its IDs
  CHECK(record["changed_count"] == 1);
}

TEST_CASE(
    "a unit that another recipe has changed since, or whose label tells other IDs, is no skip") {
  const Hall hall({{.serial = 101, .from = 1, .to = 3000}});
  REQUIRE(hall.provision({"--count", "1"}).status == 0);
  SECTION("another recipe") {
    std::string other = line_recipe;
    other.replace(other.find("aileron"), 7, "rudder1");
    other.replace(other.find("45.0deg"), 7, "40.0deg");
    const std::string file = hall.bench().file("other.json", other);
    REQUIRE(hall.run({"provision", file, "-y", "--station", "A", "--count", "1"}).status == 0);
    const auto again = json_lines(hall.provision({"--count", "1"}).out)[0];
    CHECK(again["verdict"] == "pass");
    CHECK(again["attempt"] == 2);
    CHECK(again["servo_id"] == 1); // it keeps its IDs
    CHECK(again["changed_count"] == 1);
    CHECK(json_lines(hall.provision({"--count", "1"}).out)[0]["verdict"] == "skip");
  }
  SECTION("a label") {
    const auto labelled = [&](const char* label) {
      return json_lines(hall.run({"provision", hall.recipe_file(), "-y", "--json", "--station", "A",
                                  "--count", "1", "--label", "-"},
                                 {.stdin_text = label})
                            .out)[0];
    };
    CHECK(labelled(R"({"serial_number": 101, "servo_id": 1})")["verdict"] == "skip");
    const auto other = labelled(R"({"serial_number": 101, "servo_id": 7})");
    CHECK(other["verdict"] == "fail");
    CHECK(other["code"] == "label_mismatch");
  }
}

TEST_CASE("undo takes back what provision changed") {
  const Hall hall({{.serial = 101, .from = 1, .to = 3000, .node_id = 20}});
  REQUIRE(hall.run({"wait", "-n", "20"}).status == 0);
  REQUIRE(hall.run({"set", "-n", "20", "smoothing=off", "--save", "-y"}).status == 0);
  REQUIRE(hall.provision({"--count", "1"}).status == 0);
  const Result undone = hall.run({"undo", "-y", "--json"});
  INFO(undone.out << undone.err);
  CHECK(undone.status == 0);
  const Result held =
      hall.run({"get", "-n", "20", "smoothing", "angle_limit_cw", "static_node_id", "--json"});
  const auto params = json(held.out)["nodes"][0]["params"];
  CHECK(params[0]["raw"] == 0); // by set
  CHECK(params[1]["raw"] == 1799);
  CHECK(params[2]["raw"] == 20);
}

TEST_CASE("another unit with the unique ID of one that was here is told, not skipped") {
  const std::string unit = "00112233445566778899aabbccddeeff";
  const Provisioned run =
      provision(line({{.serial = 101, .from = 1, .to = 30, .more = {{"unique_id", unit}}},
                      {.serial = 102, .from = 40, .to = 60, .more = {{"unique_id", unit}}}}),
                {"--count", "2"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 11; fail duplicate_unique_id");
}

TEST_CASE("scrap of a unit that was given no IDs frees none of its twin") {
  const std::string unit = "00112233445566778899aabbccddeeff";
  const Hall hall({{.serial = 101, .from = 1, .to = 30, .more = {{"unique_id", unit}}},
                   {.serial = 102, .from = 40, .to = 60, .more = {{"unique_id", unit}}}});
  [[maybe_unused]] const Result run = hall.provision({"--count", "2"});
  const auto records = hall.ledger();
  REQUIRE(records.size() == 2);
  const std::string failed = records[1]["record_id"];
  const Result refused = hall.run({"ledger", "--scrap", failed, "--reason", "x", "-y", "--json"});
  check_error(refused, 9, "duplicate_unique_id", "serial number 101");
  const std::string passed = records[0]["record_id"];
  CHECK(hall.run({"ledger", "--scrap", passed, "--reason", "x", "-y"}).status == 0);
}

TEST_CASE("what a killed station had begun is told at the next start, and done anew") {
  const Hall hall({{.serial = 101, .from = 1, .to = 3000}});
  {
    Background station(hall.bench(),
                       {"-i", "sim:", "provision", hall.recipe_file(), "-y", "--station", "A"},
                       {.terminal = true}, "do not take it off");
    station.kill();
  }
  const Result check = hall.run({"ledger", "--check"});
  CHECK(check.status == 8);
  CHECK(contains(check.out, "101"));
  CHECK(hall.ledger().empty());
  const Result run = hall.provision({"--count", "1"});
  INFO(run.out << run.err);
  CHECK(run.status == 0); // the old record counts for nothing
  const auto records = hall.ledger();
  REQUIRE(records.size() == 2);
  CHECK(records[0]["verdict"] == "error");
  CHECK(records[0]["code"] == "interrupted");
  CHECK(records[0]["serial_number"] == 101);
  CHECK(records[1]["verdict"] == "pass");
  CHECK(records[1]["attempt"] == 2);
  CHECK(hall.run({"ledger", "--check"}).status == 0);
}
