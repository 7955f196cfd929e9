// A vehicle that is armed, or a servo that another node begins to drive, while a command runs:
// nothing that changes a servo leaves after that, and the end says how far it came.

#include "blactl/can/candump.hpp"

#include "catch.hpp"
#include "scene.hpp"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

constexpr int other = 40;
constexpr std::uint32_t arming_status = 1100;
constexpr std::uint32_t array_command = 1010;

/// The data type of a message from the other node; 0: no such message.
std::uint32_t message_type(std::uint32_t id) {
  return (id & 0xFFU) == other ? (id >> 8U) & 0xFFFFU : 0;
}

/// A request to save, erase or restart, or the beginning of one that writes: reading takes one
/// frame.
bool changes_a_servo(const blactl::can::Frame& frame) {
  constexpr std::uint32_t service_request = 0x8080;
  if ((frame.id & service_request) != service_request) {
    return false;
  }
  const std::uint32_t type = (frame.id >> 16U) & 0xFFU;
  const std::uint8_t tail = frame.data[frame.size - 1];
  const bool is_start = (tail & 0x80U) != 0;
  const bool is_whole = (tail & 0xC0U) == 0xC0U;
  return type == 10 || type == 5 || (type == 11 && is_start && !is_whole);
}

/// How many requests that change a servo left.
struct Sent {
  int before = 0; ///< the vehicle was armed, or the servo driven
  int after = 0;
};

Sent count(const std::string& log) {
  Sent sent;
  bool is_over = false;
  std::istringstream lines(log);
  for (std::string text; std::getline(lines, text);) {
    const auto line = blactl::can::parse_line(text);
    if (!line) {
      FAIL(text);
    }
    const auto& frame = line->frame;
    const std::uint32_t type = message_type(frame.id);
    is_over = is_over || (type == arming_status && frame.data[0] != 0) || type == array_command;
    (is_over ? sent.after : sent.before) += changes_a_servo(frame) ? 1 : 0;
  }
  return sent;
}

Scene servos() {
  Scene scene;
  for (const int id : {11, 12, 13}) {
    scene.servo("BLA21-12U-AB", id, {{"servo_id", id - 10}});
  }
  return scene;
}

struct Ended {
  Result result;
  Sent sent;
};

/// The command, on a bus where node 40 begins after a time; `begins` is empty: never. "FILE" stands
/// for a fleet file by which the three servos exchange their node IDs, and get another limit.
Ended run(Arguments arguments, const nlohmann::json& begins, int after_ms) {
  const Bench bench;
  Scene scene = servos();
  if (!begins.empty()) {
    nlohmann::json node = begins;
    node["begins"] = std::to_string(after_ms) + "ms";
    scene.foreign(other, node);
  }
  nlohmann::json entries = nlohmann::json::array();
  for (const int number : {1, 2, 3}) {
    entries.push_back(
        {{"name", "servo " + std::to_string(number)},
         {"match", {{"serial_number", 240900000 + number}}},
         {"set", {{"static_node_id", 11 + number % 3}, {"angle_limit_cw", "90deg"}}}});
  }
  const nlohmann::json file{{"schema", "blactl-fleet/1"}, {"servos", entries}};
  std::ranges::replace(arguments, "FILE", bench.file("fleet.json", file.dump()));
  const std::string log = bench.folder() / "bus.log";
  arguments.insert(arguments.begin(), {"--record", log});
  Ended ended{scene.run(bench, arguments), {}};
  ended.sent = count(content(log));
  return ended;
}

} // namespace

TEST_CASE("what another node begins while a command runs ends it before the next write") {
  const auto begins = GENERATE(nlohmann::json{{"armed", true}},
                               nlohmann::json{{"commands", {{"servo_ids", {255}}}}});
  const Arguments command =
      GENERATE(Arguments{"restart", "-n", "all", "--stagger", "2", "-y", "--json"},
               Arguments{"save", "-n", "all", "--stagger", "2", "-y", "--json"},
               Arguments{"erase", "-n", "all", "--keep-ids", "--save", "-y", "--json"},
               Arguments{"set", "-n", "all", "angle_limit_cw=90deg", "angle_dead_band=0.5deg",
                         "--save", "-y", "--json"},
               Arguments{"apply", "FILE", "-y", "--json"});
  INFO(command.front());
  const Ended whole = run(command, {}, 0);
  REQUIRE(whole.result.status == 0);
  int ended_early = 0;
  for (int after_ms = 1'000; after_ms < 16'000; after_ms += 750) {
    INFO(after_ms);
    const Ended ended = run(command, begins, after_ms);
    INFO(ended.result.out);
    CHECK(ended.sent.after == 0);
    const bool is_whole = ended.sent.before == whole.sent.before;
    CHECK((ended.result.status == 0) == is_whole);
    if (!is_whole) {
      CHECK(contains(ended.result.out,
                     begins.contains("armed") ? R"("code": "armed")" : R"("code": "driven")"));
      ended_early += ended.sent.before > 0 ? 1 : 0;
    }
  }
  if (command.front() == "set" || command.front() == "erase") {
    return; // all its writes leave within less than the step
  }
  CHECK(ended_early > 0);
}

TEST_CASE("characterize leaves a servo as it is once another node drives it") {
  int ended_early = 0;
  for (int after_ms = 1'500; after_ms < 15'000; after_ms += 1'350) {
    INFO(after_ms);
    const Ended ended = run({"characterize", "-n", "11", "-y", "--json"},
                            {{"commands", {{"servo_ids", {1}}, {"rate", 50}}}}, after_ms);
    INFO(ended.result.out << ended.result.err);
    CHECK(ended.sent.after == 0);
    if (ended.result.status != 0) {
      CHECK(ended.result.status == 9);
      CHECK(contains(ended.result.out, R"("code": "driven")"));
      ended_early += ended.sent.before > 0 ? 1 : 0;
    }
  }
  CHECK(ended_early > 3);
}

TEST_CASE("where the vehicle is armed between the writes and SAVE, the end says what is in RAM") {
  const Arguments save_slowly{"set",       "-n", "all", "smoothing=off", "--save",
                              "--stagger", "2",  "-y",  "--json"};
  const Ended ended = run(save_slowly, {{"armed", true}}, 3'000);
  CHECK(ended.result.status == 6);
  CHECK(ended.sent.after == 0);
  const auto document = json(ended.result.out);
  CHECK(document["nodes"][0]["saved"] == true);
  CHECK(document["nodes"][2]["saved"] == false);
  CHECK(document["nodes"][2]["changes"][0]["status"] == "written");
  CHECK(document["errors"].back()["node_id"] == 13);
  CHECK(document["errors"].back()["message"] ==
        "node 13 was written in RAM, in part or whole, and is not saved: node 40 says that the "
        "vehicle is armed: nothing is written while it is");
}

TEST_CASE("a restart that brings back a servo ID which another node commands is refused") {
  const Bench bench;
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11, {{"servo_id", 3}})
                          .foreign(other, {{"commands", {{"servo_ids", {3}}, {"rate", 20}}}});
  const Background sim(bench, {"sim", scene.write(bench)});
  REQUIRE(bench.run({"-i", "sim:", "set", "-n", "11", "servo_id=7", "-y"}).status == 0);
  const Result back = bench.run({"-i", "sim:", "restart", "-n", "11", "-y"});
  check_error(back, 9, "driven", "node 40 commands servo ID 3, which node 11 would have then");
  CHECK(bench.run({"-i", "sim:", "restart", "-n", "11", "-y", "--while-driven"}).status == 0);
}

TEST_CASE("apply and undo change nothing of a servo that another node drives, in RAM either") {
  const nlohmann::json drives{
      {"kind", "autopilot"},
      {"commands", {{"servo_ids", {1}}, {"type", 1}, {"value", 0.1}, {"rate", 50}}}};
  const Bench bench;
  const std::string file = bench.file("fleet.json", R"({"schema": "blactl-fleet/1", "servos": [
      {"name": "a", "match": {"servo_id": 1}, "set": {"smoothing": "off"}}]})");
  const Scene driven = Scene().servo("BLA21-12U-AB", 11, {{"servo_id", 1}}).foreign(other, drives);
  const Result refused = driven.run(bench, {"apply", file, "-y", "--no-save"});
  CHECK(refused.status == 9);
  CHECK(codes(refused) == std::vector<std::string>{"driven"});
  CHECK(driven.run(bench, {"apply", file, "-y", "--no-save", "--while-driven"}).status == 0);
}
