#include "blactl/can/candump.hpp"

#include "catch.hpp"
#include "scene.hpp"
#include "tap.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

using namespace blactl::test;
using blactl::can::Frame;

namespace {

/// The frames of a log, of which every line must be complete.
std::vector<Frame> frames(const std::string& log) {
  std::vector<Frame> found;
  std::istringstream lines(log);
  CHECK(log.ends_with('\n'));
  for (std::string text; std::getline(lines, text);) {
    const auto line = blactl::can::parse_line(text);
    INFO(text);
    REQUIRE(line);
    REQUIRE(line->kind == blactl::can::LogLine::Kind::frame);
    CHECK(line->interface == "sim");
    found.push_back(line->frame);
  }
  return found;
}

/// Everything on the bus of a running sim.
class Witness {
 public:
  explicit Witness(const Bench& bench) : bus_(join(bench)) {}

  const std::vector<Frame>& hear() {
    while (const auto event = bus_->receive()) {
      const auto* received = std::get_if<blactl::can::Received>(&*event);
      REQUIRE(received != nullptr);
      frames_.push_back(received->frame);
    }
    return frames_;
  }

 private:
  std::unique_ptr<blactl::can::SimBus> bus_;
  std::vector<Frame> frames_;
};

/// A log of `command` on the bus of three servos, made in `bench`.
std::string record(const Bench& bench, Arguments command, const Scene& scene = three_servos()) {
  const std::string log = bench.folder() / "bus.log";
  command.insert(command.end(), {"--record", log});
  const Result result = scene.run(bench, command);
  INFO(result.err);
  CHECK(result.status == 0);
  return log;
}

std::string message(std::uint32_t id, std::string_view data) {
  std::ostringstream line;
  line << "(1436509052.000000) can0 " << std::hex << std::uppercase << id << '#' << data << '\n';
  return line.str();
}

/// Two frames of actuator.Status of node 42, which tells that it is an actuator and no more.
const std::string actuator =
    message(0x1403F32A, "1F76030038FF7F80") + message(0x1403F32A, "00BD1160");

} // namespace

TEST_CASE("get on a recording gives what get on the bus gave") {
  const Bench bench;
  const std::string log = bench.folder() / "bus.log";
  const Result live = three_servos().run(bench, {"get", "--all", "--json", "--record", log});
  REQUIRE(live.status == 0);
  const Result replayed = bench.run({"-i", "replay:" + log, "get", "--all", "--json"});
  CHECK(replayed.status == 0);
  CHECK(replayed.err.empty());
  auto before = json(live.out);
  const auto after = json(replayed.out);
  CHECK(after["interface"] == "replay:" + log);
  before["interface"] = after["interface"];
  CHECK(before == after);
  CHECK(before["nodes"].size() == 3);
}

TEST_CASE("get finds its servos in a recording by every form of -n, and reads standard input") {
  const Bench bench;
  const std::string log = record(bench, {"get", "--all"});
  for (const auto* list : {"12", "servo:2", "model:BLA15", "11-13"}) {
    const Result got = bench.run({"-i", "replay:" + log, "get", "-n", list, "servo_id", "-j"});
    CHECK(got.status == 0);
    CHECK(json(got.out)["nodes"].size() == (std::string_view(list) == "11-13" ? 3 : 1));
  }
  const Result piped =
      bench.run({"-i", "replay:-", "get", "-n", "12", "servo_id"}, {.stdin_text = content(log)});
  CHECK(piped.status == 0);
  CHECK(contains(piped.out, "servo_id   2"));
  CHECK(bench.run({"-i", "replay:" + log, "get", "-n", "12", "servo_id", "--listen-only"}).status ==
        0);
}

TEST_CASE("scan on a recording finds the same nodes, and the tool that asked them") {
  const Bench bench;
  const std::string log = bench.folder() / "bus.log";
  const Scene scene = three_servos().foreign(40);
  const Result live = scene.run(bench, {"scan", "--json", "--record", log});
  REQUIRE(live.status == 0);
  const Result replayed = bench.run({"-i", "replay:" + log, "scan", "--json"});
  CHECK(replayed.status == 0);
  CHECK(replayed.err.empty());
  const auto before = json(live.out)["nodes"];
  auto after = json(replayed.out)["nodes"];
  REQUIRE(after.size() == before.size() + 1);
  const auto& tool = after.back();
  CHECK(tool["node_id"] == 127);
  for (const auto* key : {"unique_id", "model", "serial_number", "servo_id", "static_node_id"}) {
    CHECK(tool[key].is_null());
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    auto expected = before[i];
    auto found = after[i];
    expected.erase("info"); // uptime runs on
    found.erase("info");
    CHECK(found == expected);
  }
}

TEST_CASE("what a recording lacks is one error for each servo, and what it has is shown") {
  const Bench bench;
  const std::string log = record(bench, {"scan"});
  const Result got = bench.run({"-i", "replay:" + log, "get", "-n", "11"});
  CHECK(got.status == 4);
  CHECK(codes(got) == std::vector<std::string>{"not_recorded"});
  CHECK(contains(got.err, "node 11: not in the recording: command_angle, "));
  CHECK(contains(
      got.err, " more\n  only what was asked is recorded, and counts until a restart or a change; "
               "for all of it: blactl get --all --record FILE\n"));
  CHECK(got.err.size() < 500);
  CHECK(contains(got.out, "serial_number     240900001"));

  const Result all = bench.run({"-i", "replay:" + log, "get", "angle_limit_cw", "-j"});
  CHECK(all.status == 4);
  CHECK(json(all.out)["errors"].size() == 3);
  CHECK(json(all.out)["nodes"].size() == 3);
  CHECK(json(all.out)["nodes"][0]["serial_number"] == 240900001);

  CHECK(bench.run({"-i", "replay:" + log, "get", "-n", "11", "serial_number"}).status == 0);
}

TEST_CASE("what was erased after it was read is not told from a recording") {
  const Bench bench;
  const std::string log = record(bench, {"get", "-n", "11", "angle_limit_cw"});
  const Arguments get{"-i", "replay:" + log, "get", "-n", "11", "angle_limit_cw", "-j"};
  CHECK(bench.run(get).status == 0);
  const std::string text = content(log);
  const std::size_t last = text.rfind('(');
  std::ofstream(log, std::ios::app) << text.substr(last, text.find("sim", last) - last)
                                    << "sim 1E0A8BE4#01000000000000C0\n"; // ERASE by node 100
  const Result erased = bench.run(get);
  CHECK(erased.status == 4);
  CHECK(json(erased.out)["nodes"][0]["params"].empty());
  CHECK(json(erased.out)["errors"][0]["code"] == "not_recorded");
}

TEST_CASE("nodes that a recording does not tell more of are listed, and cannot be read") {
  const Bench bench;
  const std::string log = bench.file("bus.log", actuator);
  const Result scan = bench.run({"-i", "replay:" + log, "scan", "--json"});
  CHECK(scan.status == 0);
  const auto nodes = json(scan.out)["nodes"];
  REQUIRE(nodes.size() == 1);
  CHECK(nodes[0]["node_id"] == 42);
  CHECK(nodes[0]["unique_id"].is_null());
  CHECK(nodes[0]["info"].is_null());
  const Result heard = bench.run({"-i", "replay:" + log, "get"});
  CHECK(heard.status == 4);
  CHECK(codes(heard) == std::vector<std::string>{"not_recorded"});
  CHECK(contains(heard.err, "node 42 is in the recording, but not what it is"));
  const Result absent = bench.run({"-i", "replay:" + log, "get", "-n", "43"});
  CHECK(absent.status == 4);
  CHECK(codes(absent) == std::vector<std::string>{"not_recorded"});
  CHECK(contains(absent.err, "node 43 is not in the recording"));
  const Result japanese = bench.run({"-i", "replay:" + log, "get", "-n", "43", "--lang", "ja"});
  CHECK(contains(japanese.err, "ノード 43 は記録にありません"));
}

TEST_CASE("a log takes no writes") {
  const Bench bench;
  const std::string log = bench.file("bus.log", actuator);
  for (const Arguments& command :
       {Arguments{"set", "-n", "42", "servo_id=3"}, {"set", "servo_id=3", "--dry-run"}, {"sim"}}) {
    Arguments arguments{"-i", "replay:" + log};
    arguments.insert(arguments.end(), command.begin(), command.end());
    const Result result = bench.run(arguments);
    CHECK(result.status == 2);
    CHECK(codes(result) == std::vector<std::string>{"usage"});
    CHECK(contains(result.err, "is a log: nothing can be sent to it\n  give the interface"));
  }
}

TEST_CASE("a log that is none, or is not there") {
  const Bench bench;
  const Result missing = bench.run({"-i", "replay:/nonexistent", "scan"});
  CHECK(missing.status == 3);
  CHECK(codes(missing) == std::vector<std::string>{"interface"});
  CHECK(
      contains(missing.err, "\n  give a log of candump -l, blactl --record, Vector (ASC) or PEAK"));
  const Result folder = bench.run({"-i", "replay:" + bench.folder().string(), "scan"});
  CHECK(folder.status == 3);
  const std::string file = bench.file("x.json", "{\n\"schema\": 1\n}\n");
  for (const Arguments& command : {Arguments{"scan"}, {"get"}, {"get", "-n", "11"}}) {
    Arguments arguments{"-i", "replay:" + file};
    arguments.insert(arguments.end(), command.begin(), command.end());
    const Result none = bench.run(arguments);
    CHECK(none.status == 2);
    CHECK(codes(none) == std::vector<std::string>{"bad_file"});
    CHECK(contains(none.err, "contains no frame in the format of candump, "));
  }
  CHECK(bench.run({"-i", "replay:", "scan"}).status == 2);
  const std::string spotty = bench.file("spotty.log", actuator + "\x1b[31mred\n" + actuator);
  const Result noted = bench.run({"-i", "replay:" + spotty, "scan"});
  CHECK(noted.status == 0);
  CHECK(contains(noted.err, "lines skipped because they are not frames: 1, the first is line 3"));
  CHECK(is_fit_for_a_terminal(noted.err));
}

TEST_CASE("what is killed while it records leaves complete lines up to its end") {
  const Bench bench;
  const std::string log = bench.folder() / "bus.log";
  const Background sim(bench, {"sim"});
  Witness witness(bench);
  Background recording(bench, {"-i", "sim:", "scan", "--listen", "60", "--record", log}, {}, "");
  const auto end = std::chrono::steady_clock::now() + 20s;
  const auto wait_until = [&](const auto& holds) {
    while (!holds()) {
      witness.hear();
      REQUIRE(std::chrono::steady_clock::now() < end);
      std::this_thread::sleep_for(10ms);
    }
  };
  wait_until([&] { return std::ranges::count(content(log), '\n') > 100; });
  const std::size_t heard = witness.hear().size();
  const Frame last = witness.hear()[heard - 1];
  blactl::can::LineBuffer buffer;
  const std::string line(blactl::can::format_line(last, {}, "sim", buffer));
  wait_until([&] { return contains(content(log), std::string_view(line).substr(19)); });
  recording.kill();

  // The log is a piece of what the witness heard, without a gap, that reaches `last` at least.
  const auto recorded = frames(content(log));
  const auto& all = witness.hear();
  const auto piece = std::ranges::search(all, recorded);
  REQUIRE_FALSE(piece.empty());
  CHECK(piece.end() - all.begin() >= static_cast<std::ptrdiff_t>(heard));
  CHECK(std::ranges::any_of(recorded, [](const Frame& frame) { return (frame.id & 0x7F) == 127; }));
}

TEST_CASE("a recording that cannot be made stops the command, one that breaks off fails it") {
  const Bench bench;
  const Scene scene = three_servos();
  const Result unmade = scene.run(bench, {"get", "-n", "11", "--record", "/nonexistent/x.log"});
  CHECK(unmade.status == 1);
  CHECK(codes(unmade) == std::vector<std::string>{"io"});
  CHECK(unmade.out.empty());
  const Result full = scene.run(bench, {"get", "-n", "11", "servo_id", "--record", "/dev/full"});
  CHECK(full.status == 1);
  CHECK(codes(full) == std::vector<std::string>{"io"});
  CHECK(contains(full.err, "recording to /dev/full ended early: No space left on device"));
  CHECK(contains(full.out, "servo_id   1"));
}

TEST_CASE("a recording replaces the file, but only once the bus is open") {
  const Bench bench;
  const std::string precious = message(0x1403F32A, "1F76030038FF7F80");
  const std::string file = bench.file("bus.log", precious);
  CHECK(bench.run({"-i", "nosuchcan0", "scan", "--record", file}).status == 3);
  CHECK(content(file) == precious);
  record(bench, {"get", "-n", "11", "servo_id"});
  CHECK_FALSE(contains(content(file), precious));
  const auto mode = std::filesystem::status(file).permissions();
  CHECK((mode & std::filesystem::perms::others_write) == std::filesystem::perms::none);
}

TEST_CASE("a recording of a recording is a copy, and never of itself") {
  const Bench bench;
  const std::string log = record(bench, {"get", "-n", "11", "servo_id"});
  const std::string before = content(log);
  const std::string copy = bench.folder() / "copy.log";
  CHECK(bench.run({"-i", "replay:" + log, "scan", "--record", copy}).status == 0);
  const auto without_names = [](std::string text) {
    for (const auto* name : {" bus.log ", " scene.json "}) {
      for (auto at = text.find(name); at != std::string::npos; at = text.find(name)) {
        text.replace(at, std::string_view(name).size(), " - ");
      }
    }
    return text;
  };
  CHECK(without_names(content(copy)) == without_names(before));
  const Result itself = bench.run({"-i", "replay:" + log, "scan", "--record", log});
  CHECK(itself.status == 2);
  CHECK(contains(itself.err, "that is the log being read"));
  CHECK(content(log) == before);
}

TEST_CASE("a recording too short for an actuator.Status shows the servo without -n all the same") {
  const Bench bench;
  const std::string log = (bench.folder() / "short.log").string();
  const Scene scene = Scene().servo("BLA15-06U-A0", 12);
  REQUIRE(scene.run(bench, {"get", "-n", "12", "servo_id", "--record", log}).status == 0);
  std::string rest;
  std::istringstream lines(content(log));
  for (std::string line; std::getline(lines, line);) {
    rest += contains(line, "03F30C#") ? "" : line + '\n'; // the actuator.Status of 12
  }
  const std::string cut = bench.file("cut.log", rest);
  for (const Arguments& more : {Arguments{}, {"-n", "all"}, {"-n", "12"}}) {
    Arguments get{"-i", "replay:" + cut, "get", "servo_id", "--json"};
    get.insert(get.end(), more.begin(), more.end());
    const Result replayed = bench.run(get);
    CHECK(replayed.status == 0);
    CHECK(json(replayed.out)["nodes"].size() == 1);
  }
}

TEST_CASE("--record replaces a log, and no other file") {
  const Bench bench;
  const Scene scene = three_servos();
  const std::string log = record(bench, {"scan"});
  CHECK(scene.run(bench, {"scan", "--record", log}).status == 0);
  CHECK(scene.run(bench, {"scan", "--record", bench.file("empty.log", "")}).status == 0);
  const std::string notes = "candidates:\n# 11 is the elevator\n";
  const std::string other = bench.file("notes.txt", notes);
  const std::string scenario = scene.write(bench);
  const std::string before = content(scenario);
  for (const std::string& file : {other, scenario}) {
    const Result refused = bench.run({"-i", "sim:" + scenario, "scan", "--record", file, "-j"});
    INFO(refused.out);
    check_error(refused, 2, "usage", "that file is there, and is no log");
    CHECK(contains(refused.out, "type another file, or remove that one first"));
    CHECK(json(refused.out)["interface"].is_null()); // nothing was opened
  }
  CHECK(content(other) == notes);
  CHECK(content(scenario) == before);
}

TEST_CASE("--record spares the files in which blactl keeps its state, there or not") {
  const Bench bench;
  const std::string state = (bench.folder() / "own").string();
  const Options options{.env = {{"BLACTL_STATE_DIR", state}}};
  const Background sim(bench, {"sim", three_servos().write(bench)});
  REQUIRE(bench.run({"-i", "sim:", "set", "-n", "11", "smoothing=off", "-y"}, options).status == 0);
  const std::string snapshots = state + "/simulated/snapshots.db";
  const std::string before = content(snapshots);
  for (const char* file : {"/simulated/snapshots.db", "/simulated/snapshots.db-wal", "/ledger.db",
                           "/simulated/../counters.db-journal"}) {
    const Result refused = bench.run({"-i", "sim:", "scan", "--record", state + file}, options);
    INFO(file);
    check_error(refused, 2, "usage", "blactl keeps its own records there");
  }
  CHECK(content(snapshots) == before);
  CHECK_FALSE(std::filesystem::exists(state + "/ledger.db"));
  CHECK(bench.run({"-i", "sim:", "scan", "--record", state + "/bus.log"}, options).status == 0);
}
