#include "catch.hpp"
#include "run.hpp"
#include "scene.hpp"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

Scene numbered_servos() {
  return Scene()
      .servo("BLA21-12U-AB", 11, {{"servo_id", 1}})
      .servo("BLA21-12U-AB", 12, {{"servo_id", 2}});
}

std::vector<std::string> found(const Result& result) {
  std::vector<std::string> all;
  const auto document = json(result.out); // lives as long as the loop needs it
  for (const auto& finding : document["findings"]) {
    all.push_back(finding["code"]);
  }
  return all;
}

using Codes = std::vector<std::string>;

std::string scenario_of_one() {
  return R"({"schema": "blactl-scenario/1", "clock": "virtual",
             "servos": [{"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1}]})";
}

void write_file(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
}

std::ptrdiff_t names_in(const std::filesystem::path& folder) {
  return std::distance(std::filesystem::directory_iterator(folder), {});
}

/// A line of a log as candump shows it on a screen without stamps: "can0  1E0181FF   [1]  C0".
std::string on_screen(const std::string& line) {
  const std::string frame = line.substr(line.rfind(' ') + 1);
  const std::size_t hash = frame.find('#');
  std::string bytes;
  for (std::size_t i = hash + 1; i < frame.size(); i += 2) {
    bytes += ' ' + frame.substr(i, 2);
  }
  return "  can0  " + frame.substr(0, hash) + "   [" + std::to_string(bytes.size() / 3) + "] " +
         bytes + '\n';
}

} // namespace

TEST_CASE("doctor finds nothing on a bus that is well, and says what it looked at") {
  const Result result = numbered_servos().run({"doctor"});
  INFO(result.out << result.err);
  CHECK(result.status == 0);
  CHECK(contains(result.out, "servos: 2, other nodes: 0"));
  CHECK(contains(result.out, "% busy"));
  CHECK(contains(result.out, "nothing is wrong, as far as it was heard"));
}

TEST_CASE("doctor's document has the nodes' heads and the findings with the keys of the contract") {
  Scene scene = numbered_servos();
  scene.servo("BLA21-12U-AB", 13, {{"servo_id", 2}, {"firmware_version", 1300}});
  const Result result = scene.run({"doctor", "-j"});
  CHECK(result.status == 8);
  const auto document = ordered_json(result.out);
  CHECK(document["nodes"].size() == 3);
  CHECK(keys(document["nodes"][0]) ==
        std::vector<std::string>{"node_id", "unique_id", "model", "serial_number", "servo_id",
                                 "firmware_version", "hardware_version"});
  REQUIRE(found(result) == Codes{"duplicate_servo_id", "firmware_defect"});
  CHECK(keys(document["findings"][1]) ==
        std::vector<std::string>{"code", "level", "node_id", "text", "fix"});
  CHECK(document["findings"][1]["level"] == "notice");
  CHECK(document["findings"][1]["node_id"] == 13);
}

TEST_CASE("doctor does not say that all is well with a servo that is not there") {
  const std::string absent = GENERATE("55", "11,55", "serial:999", "uid:ffff");
  const Result result = numbered_servos().run({"doctor", "-n", absent, "--json"});
  CHECK(result.status == 4);
  CHECK(codes(result) == std::vector<std::string>{"not_found"});
}

TEST_CASE("doctor names conflicts, the worst first, and who has no node ID") {
  Scene scene = numbered_servos();
  scene.servo("BLA21-12U-AB", 12, {{"serial_number", 9}, {"servo_id", 3}});
  scene.servo("BLA21-12U-AB", 0, {{"serial_number", 10}, {"servo_id", 4}});
  const Result result = scene.run({"doctor", "-j"});
  CHECK(result.status == 8);
  const auto all = found(result);
  REQUIRE(all.size() >= 2);
  CHECK(all.front() == "duplicate_node_id");
  CHECK(all.back() == "no_node_id");
}

TEST_CASE("what doctor says of a node ID in RAM is true, and both of its commands work as typed") {
  const std::string keep = "blactl -i sim: save -n 11",
                    take_back = "blactl -i sim: set -n 11 static_node_id=11";
  const auto& [typed, id] = GENERATE_COPY(table<std::string, int>({{keep, 30}, {take_back, 11}}));
  const Bench bench;
  const Background sim(bench, {"sim", bench.file("s.json", scenario_of_one())});
  const auto run = [&](const std::string& words) {
    Arguments arguments;
    std::istringstream line("-i sim: " + words);
    for (std::string word; line >> word;) {
      arguments.push_back(word);
    }
    return bench.run(arguments);
  };
  REQUIRE(run("set -n 11 static_node_id=30 -y").status == 0);
  const auto document = json(run("doctor -j").out);
  const auto& finding = document["findings"].at(0);
  CHECK(finding["code"] == "static_node_id");
  CHECK(finding["text"] == "0x46 of node 11 is 30 in RAM: whether ROM holds that too, which counts "
                           "after a restart, is not known");
  CHECK(finding["fix"] == "make it permanent: " + keep + "; or take it back: " + take_back);
  REQUIRE(run(typed.substr(std::string("blactl -i sim: ").size()) + " -y").status == 0);
  CHECK(run("restart -n " + std::to_string(id) + " -y").status == 0);
  CHECK(found(run("doctor -j")).empty());
}

TEST_CASE("the command for units that wait for a node ID touches nobody else") {
  const Bench bench;
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 5, {{"serial_number", 5}, {"servo_id", 1}})
                          .servo("BLA21-12U-AB", 6, {{"serial_number", 6}, {"servo_id", 2}})
                          .servo("BLA21-12U-AB", 0, {{"serial_number", 7}, {"servo_id", 3}})
                          .servo("BLA21-12U-AB", 0, {{"serial_number", 8}, {"servo_id", 4}});
  const Background sim(bench, {"sim", scene.write(bench)});
  const auto document = json(bench.run({"-i", "sim:", "doctor", "-j"}).out);
  const auto& finding = document["findings"].at(0);
  REQUIRE(finding["code"] == "no_node_id");
  const std::string fix = finding["fix"];
  INFO(fix);
  std::istringstream line(fix.substr(fix.find("alloc --static")));
  Arguments arguments{"-i", "sim:", "-y"};
  for (std::string word; line >> word;) {
    arguments.push_back(word);
  }
  const Result typed = bench.run(arguments);
  INFO(typed.out << typed.err);
  CHECK(typed.status == 0);
  std::vector<std::string> now;
  const auto scanned = json(bench.run({"-i", "sim:", "scan", "-j"}).out);
  for (const auto& node : scanned["nodes"]) {
    now.push_back(node["node_id"].dump() + ' ' + node["serial_number"].dump());
  }
  CHECK(now == std::vector<std::string>{"5 5", "6 6", "11 7", "12 8"});
}

TEST_CASE("doctor tells that nothing is heard, and that nobody acknowledges") {
  const Bench bench;
  const std::string empty =
      bench.file("empty.json", R"({"schema": "blactl-scenario/1", "clock": "virtual"})");
  const Result alone = bench.run({"-i", "sim:" + empty, "doctor", "-j"});
  INFO(alone.out << alone.err);
  CHECK(alone.status == 8);
  CHECK_FALSE(found(alone).empty());
}

TEST_CASE("doctor sees who commands a servo that is not there") {
  Scene scene = numbered_servos();
  scene.foreign(100,
                {{"kind", "autopilot"},
                 {"commands", {{"servo_ids", {1, 5}}, {"type", 0}, {"value", 0.1}, {"rate", 20}}}});
  const Result result = scene.run({"doctor", "-j"});
  CHECK(result.status == 8);
  CHECK(found(result) == Codes{"no_such_servo", "commander"});
  CHECK(json(result.out)["findings"][1]["level"] == "notice");
}

TEST_CASE("doctor does not say that nothing is wrong when something kept it from looking") {
  const Bench bench;
  const std::string log = bench.file("no.log", "{}\n");
  const Result bad = bench.run({"-i", "replay:" + log, "doctor"});
  INFO(bad.out << bad.err);
  CHECK(bad.status == 2);
  CHECK_FALSE(contains(bad.out, "nothing is wrong"));
  // Two others have the IDs of tools.
  const Result shared = numbered_servos().foreign(126).foreign(127).run({"doctor"});
  INFO(shared.out << shared.err);
  CHECK(shared.status == 9);
  CHECK_FALSE(contains(shared.out, "nothing is wrong"));
}

TEST_CASE("doctor finds a servo that answers nothing, as scan does") {
  Scene scene = numbered_servos();
  scene.servo("BLA21-12U-AB", 13, {{"servo_id", 3}, {"faults", {{"mute", true}}}});
  CHECK(scene.run({"scan"}).status == 6);
  const Result result = scene.run({"doctor", "-j"});
  INFO(result.out << result.err);
  CHECK(result.status == 8);
  REQUIRE(found(result) == Codes{"timeout"});
  CHECK(json(result.out)["findings"][0]["node_id"] == 13);
  CHECK(json(result.out)["findings"][0]["level"] == "failure");
}

TEST_CASE("doctor hears nobody on a bus of its own frames only") {
  const Bench bench;
  const std::string empty =
      bench.file("empty.json", R"({"schema": "blactl-scenario/1", "clock": "virtual"})");
  const Result result = bench.run({"-i", "sim:" + empty, "doctor", "-j"});
  CHECK(result.status == 8);
  REQUIRE_FALSE(found(result).empty());
}

TEST_CASE("lost answers are a finding of their own, and nobody is away who is heard") {
  Scene scene = numbered_servos();
  scene.servo("BLA21-12U-AB", 13, {{"servo_id", 3}, {"faults", {{"lose_responses", 2}}}});
  const Result result = scene.run({"doctor", "-j"});
  INFO(result.out << result.err);
  CHECK(result.status == 8);
  REQUIRE(found(result) == Codes{"lost_answers"});
  const std::string text = json(result.out)["findings"][0]["text"];
  CHECK(contains(text, "2 of "));
  CHECK(contains(text, "13"));
}

TEST_CASE("two servos with one serial number are told, and a servo ID is given to stay") {
  Scene scene = numbered_servos();
  scene.servo("BLA21-12U-AB", 13, {{"servo_id", 2}, {"serial_number", 7}});
  scene.servo("BLA21-12U-AB", 14, {{"servo_id", 2}, {"serial_number", 8}});
  const auto servo_ids = json(scene.run({"doctor", "-j"}).out)["findings"];
  REQUIRE(servo_ids.size() == 1);
  CHECK(servo_ids[0]["code"] == "duplicate_servo_id");
  CHECK(servo_ids[0]["fix"] ==
        "nodes 13, 14 each need another ID: blactl set -n 13 servo_id=ID --save");
}

TEST_CASE("in a log the ID of a tool is called that") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  CHECK(numbered_servos().run(bench, {"--record", log, "scan"}).status == 0);
  const Result result = bench.run({"-i", "replay:" + log, "doctor"});
  INFO(result.out << result.err);
  CHECK(contains(result.out, "servos: 2, other nodes: 0, tools (by their ID): 127"));
}

TEST_CASE("of a log whose time runs backwards it is said, and no load that is none") {
  const Bench bench;
  std::string lines;
  for (int second = 9; second > 0; --second) {
    lines += "(170000000" + std::to_string(second) + ".000000) can0 1001550B#010000000000C0\n";
  }
  const Result result = bench.run({"-i", "replay:" + bench.file("back.log", lines), "doctor"});
  INFO(result.out << result.err);
  CHECK(result.status == 8);
  CHECK(contains(result.out, "run backwards"));
  CHECK_FALSE(contains(result.out, "% busy"));
}

TEST_CASE("doctor judges what this user may keep") {
  const Bench bench;
  const std::string file = bench.file("no_folder", "a file where a folder is needed");
  const Result result = bench.run({"-i", "sim:" + numbered_servos().write(bench), "doctor", "-j"},
                                  {.env = {{"BLACTL_STATE_DIR", file}}});
  CHECK(result.status == 8);
  CHECK(found(result) == Codes{"permission"});
}

TEST_CASE("doctor tells of a state file that is damaged, wherever in it, and of each of them") {
  const Bench bench;
  const Background sim(bench, {"sim", bench.file("s.json", scenario_of_one())});
  const Arguments doctor{"-i", "sim:", "doctor", "-j"};
  CHECK(bench.run(doctor).status == 0);
  const std::filesystem::path state = bench.folder() / "state/blactl/simulated";
  CHECK_FALSE(std::filesystem::exists(state)); // nothing is made by looking
  REQUIRE(bench.run({"-i", "sim:", "-y", "set", "-n", "11", "reverse=on"}).status == 0);
  CHECK(bench.run(doctor).status == 0);
  const auto files = names_in(state);
  std::string history = content(state / "snapshots.db");
  history.back() = static_cast<char>(history.back() ^ 1); // no command reads this for itself
  write_file(state / "snapshots.db", history);
  write_file(state / "allocations.db", "no database");
  const Result result = bench.run(doctor);
  INFO(result.out << result.err);
  CHECK(result.status == 8);
  REQUIRE(found(result) == Codes{"state_damaged", "state_damaged"});
  const auto findings = json(result.out)["findings"];
  CHECK(findings[0]["level"] == "failure");
  CHECK(findings[0]["node_id"] == nullptr);
  CHECK(contains(findings[0]["text"].get<std::string>(), "allocations.db is not a blactl"));
  CHECK(contains(findings[1]["text"].get<std::string>(), "snapshots.db is damaged"));
  CHECK(contains(findings[1]["fix"].get<std::string>(), "mv " + state.string()));
  CHECK(content(state / "snapshots.db") == history);
  CHECK(names_in(state) == files + 1);
  const Result japanese = bench.run({"-i", "sim:", "doctor", "--lang", "ja"});
  CHECK(contains(japanese.out, "snapshots.db が壊れています"));
  CHECK(contains(japanese.out, "移動して下さい"));
}

TEST_CASE("what a private simulation does not use, doctor does not judge there") {
  const Bench bench;
  write_file(bench.folder() / "state/blactl/allocations.db", "no database");
  const Result result = bench.run({"-i", "sim:" + numbered_servos().write(bench), "doctor", "-j"});
  CHECK(result.status == 0);
}

TEST_CASE("an interface that cannot be opened is an error beside the findings") {
  const Result result = run({"-i", "slcan:/nonexistent", "doctor", "-j"});
  CHECK(result.status == 3);
  CHECK(json(result.out)["findings"].is_array());
  CHECK(json(result.out)["errors"].size() == 1);
}

TEST_CASE("doctor --fix leaves alone what is no interface of this machine, and says so") {
  const Result result = numbered_servos().run({"doctor", "--fix", "-j"});
  INFO(result.out << result.err);
  CHECK(result.status == 0);
  CHECK(contains(result.err, "nothing was changed"));
  CHECK(json(result.out)["fixed"].empty());
}

TEST_CASE("--report is one file that a person reads and replay: answers from") {
  const Bench bench;
  const std::string scenario = numbered_servos().write(bench);
  const std::string file = (bench.folder() / "report.txt").string();
  const Result result = bench.run({"-i", "sim:" + scenario, "doctor", "--report", file});
  INFO(result.err);
  CHECK(result.status == 0);
  CHECK(contains(result.err, "report written to"));
  const std::string text = content(file);
  CHECK(text.starts_with("# report of blactl "));
  for (const char* part : {"# == faults", "# == parameters", "# == allocation table",
                           "# node 11  BLA21-12U-AB", "0x38  angle_limit_cw"}) {
    INFO(part);
    CHECK(contains(text, part));
  }
  const Result held = bench.run({"-i", "replay:" + file, "get", "0x38", "-n", "11,12", "-j"});
  CHECK(held.status == 0);
  CHECK_FALSE(contains(held.err, "lines")); // its comments are no bad lines
  CHECK(json(held.out)["nodes"][1]["params"][0]["raw"] == 1799);
  const Result again = bench.run({"-i", "replay:" + file, "doctor"});
  CHECK(again.status == 0);
  CHECK(contains(again.out, "nothing is wrong"));
}

TEST_CASE("--report that cannot be written is refused before anything is asked") {
  const Bench bench;
  const std::string scenario = numbered_servos().write(bench);
  CHECK(bench.run({"-i", "sim:" + scenario, "doctor", "--report", "/nonexistent/r"}).status == 1);
  CHECK(bench.run({"-i", "sim:" + scenario, "doctor", "--report", "-"}).status == 2);
  const Result both =
      bench.run({"-i", "sim:" + scenario, "--record", (bench.folder() / "a").string(), "doctor",
                 "--report", (bench.folder() / "b").string()});
  CHECK(both.status == 2);
  CHECK(codes(both) == std::vector<std::string>{"usage"});
}

TEST_CASE("--report replaces a report in either language, and no file of others") {
  const Bench bench;
  const std::string interface = "sim:" + numbered_servos().write(bench);
  const std::string file = (bench.folder() / "report.txt").string();
  for (const char* language : {"en", "ja", "en"}) {
    const Result written =
        bench.run({"-i", interface, "doctor", "--report", file, "--lang", language});
    INFO(written.err);
    CHECK(written.status == 0);
  }
  const std::string other = bench.file("fleet.json", "{}");
  const Result refused = bench.run({"-i", interface, "doctor", "--report", other});
  check_error(refused, 2, "usage", "--report " + other + ": that file is there, and is no log");
  CHECK(content(other) == "{}");
}

TEST_CASE("doctor finds a node whose NodeStatus comes too rarely") {
  const char* period = GENERATE("1500ms", "2500ms", "2900ms");
  Scene scene = numbered_servos();
  scene.foreign(40, {{"status_period", period}, {"actuator_id", 7}});
  const Result result = scene.run({"doctor", "--json"});
  INFO(period << result.out);
  CHECK(found(result) == Codes{"slow_node_status"});
  CHECK(contains(result.out, "node 40 sends NodeStatus " + std::string(period).substr(0, 4)));
}

TEST_CASE("lost frames of NodeStatus are no long period") {
  Scene scene = numbered_servos();
  scene.foreign(40).wire({{"loss", 0.3}});
  CHECK_FALSE(contains(scene.run({"doctor", "--json"}).out, "slow_node_status"));
}

TEST_CASE("a servo shares its ID with an actuator of another make") {
  Scene scene = numbered_servos();
  scene.foreign(40, {{"actuator_id", 2}});
  const Result examined = scene.run({"doctor", "--json"});
  CHECK(found(examined) == Codes{"duplicate_servo_id"});
  CHECK(contains(examined.out, "nodes 12, 40 have the same servo ID 2"));
  CHECK(contains(examined.out, "blactl set -n 12 servo_id=ID --save"));
}

TEST_CASE("a log without stamps tells of a restart, and of no second unit") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11, {{"serial_number", 7}, {"servo_id", 1}})
                          .event(7, "power_off", "3s")
                          .event(7, "power_on", "4s");
  CHECK(scene.run(bench, {"trace", "--duration", "12", "--record", log}).status == 0);
  for (std::size_t every = 2; every < 40; every += 3) { // lines are missing, as on a busy screen
    std::string screen;
    std::istringstream lines(content(log));
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
      screen += ++number % every == 0 ? "" : on_screen(line);
    }
    const std::string name = bench.file("screen.log", screen);
    const Result examined = bench.run({"-i", "replay:" + name, "doctor", "--json"});
    INFO(every << examined.out << examined.err);
    CHECK_FALSE(contains(examined.out, "duplicate_node_id"));
    CHECK(contains(examined.out, "restarted"));
  }
}

TEST_CASE("doctor tells what is true of several servos once") {
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11, {{"servo_id", 1}, {"firmware_version", 1300}})
                          .servo("BLA21-12U-AB", 12, {{"servo_id", 2}, {"firmware_version", 1300}})
                          .servo("BLA21-12U-AB", 13, {{"servo_id", 3}, {"firmware_version", 1300}});
  const Result result = scene.run({"doctor"});
  INFO(result.out);
  CHECK(contains(result.out, "of node 11 may stall"));
  CHECK(contains(result.out, "(likewise nodes 12, 13)"));
  CHECK_FALSE(contains(result.out, "of node 12 may stall"));
  CHECK(json(scene.run({"doctor", "-j"}).out)["findings"].size() >= 3);
}
