#include "blactl/dronecan/types.hpp"

#include "catch.hpp"
#include "scene.hpp"
#include "tap.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>

using namespace blactl::test;

namespace {

const Arguments get_servo_id{"-i", "sim:", "get", "-n", "11", "servo_id"};

/// Asks a question, and holds its node ID until it is answered.
const Arguments asking{"-i", "sim:", "--color", "never", "set", "-n", "11", "torque_output=off"};
constexpr std::string_view question = "Go on?";

/// Holds a node ID for longer than any test needs it; only one process at a time may write.
const Arguments listening{"-i", "sim:", "scan", "--listen", "15"};

using blactl::dronecan::ExecuteOpcode;

void order(Visitor& visitor, std::uint8_t opcode) {
  visitor.ask(ExecuteOpcode::type, ExecuteOpcode::Request{.opcode = opcode}.encode());
}

} // namespace

TEST_CASE("sim says ready when clients may come, and ends with the signal") {
  const Bench bench;
  Background sim(bench, {"sim"});
  CHECK(bench.run(get_servo_id).status == 0);
  const Result ended = sim.stop(SIGTERM);
  CHECK(ended.status == 143);
  CHECK(ended.out == "ready\n");
  CHECK(contains(ended.err, "simulated servos: 3 (Ctrl-C ends)"));
  CHECK(Background(bench, {"sim"}).stop(SIGINT).status == 130);
}

TEST_CASE("sim --json is a stream of ready and the end") {
  const Bench bench;
  Background sim(bench, {"sim", "--json"}, {}, R"({"event":"ready"})");
  const Result ended = sim.stop(SIGTERM);
  CHECK(ended.status == 143);
  const auto lines = json_lines(ended.out);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0] == nlohmann::json{{"event", "ready"}});
  CHECK(lines[1]["schema"] == "blactl/1");
  CHECK(lines[1]["command"] == "sim");
  CHECK(lines[1]["exit_status"] == 143);
  CHECK(lines[1]["errors"].is_array());
}

TEST_CASE("sim prints what happens to its servos, a line each, as it happens") {
  const Bench bench;
  Background sim(bench, {"sim"});
  Visitor visitor(bench, 11);
  order(visitor, ExecuteOpcode::erase);
  sim.expect("  erase  serial 240900001  node 11  count 0\n");
  order(visitor, ExecuteOpcode::save);
  sim.expect("  rom_write  serial 240900001  node 11  count 1\n");
  sim.expect("  restart  serial 240900001  node 11  count 1\n");
  const Result ended = sim.stop();
  CHECK(ended.status == 143);
  CHECK(ended.out.starts_with("ready\n"));
  CHECK(std::ranges::count(ended.out, '\n') == 4);
}

TEST_CASE("sim --json prints events as objects, with Unix time") {
  const Bench bench;
  const std::string scenario = bench.file("scenario.json", R"({"schema": "blactl-scenario/1",
      "servos": [{"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 240900558,
                  "unique_id": "00112233445566778899aabbccddeeff"}]})");
  Background sim(bench, {"sim", scenario, "--json"}, {}, R"({"event":"ready"})");
  Visitor visitor(bench, 11);
  order(visitor, ExecuteOpcode::save);
  sim.expect(R"("event":"restart")");
  const Result ended = sim.stop();
  const auto lines = json_lines(ended.out);
  REQUIRE(lines.size() == 4);
  CHECK(lines[0] == nlohmann::json{{"event", "ready"}});
  CHECK(contains(ended.out,
                 R"(,"event":"rom_write","unique_id":"00112233445566778899aabbccddeeff",)"
                 R"("serial_number":240900558,"node_id":11,"count":1})"));
  CHECK(lines[1]["time"] <= lines[2]["time"]);
  const auto now =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch());
  CHECK(lines[1]["time"].get<double>() > now.count() - 100);
  CHECK(lines[1]["time"].get<double>() < now.count() + 1);
  CHECK(lines[3]["counts"].empty());
}

TEST_CASE("a sim whose output nobody wants to read any more goes on") {
  const Bench bench;
  Background sim(bench, {"sim"}, {.leave_after = "ready\n"});
  Visitor visitor(bench, 11);
  for (const std::uint8_t opcode : {ExecuteOpcode::erase, ExecuteOpcode::erase}) {
    order(visitor, opcode);
  }
  order(visitor, ExecuteOpcode::save);
  CHECK(bench.run({"-i", "sim:", "get", "-n", "12", "servo_id"}).status == 0);
  const Result ended = sim.stop();
  CHECK(ended.status == 143);
  CHECK(codes(ended).empty());
}

// A pipe holds 64 KiB; a script that waited for `ready` may never read on.
TEST_CASE("a sim whose output is not read does not wait for the reader") {
  const Bench bench;
  Background sim(bench, {"sim", "--json"}, {}, R"({"event":"ready"})");
  Visitor visitor(bench, 11);
  constexpr int orders = 700;
  for (int i = 0; i < orders; ++i) {
    order(visitor, ExecuteOpcode::erase);
  }
  const Result ended = sim.stop();
  CHECK(ended.status == 143);
  const auto lines = json_lines(ended.out);
  const auto& dropped = lines.back()["counts"]["events_dropped"];
  CHECK(dropped > 0);
  CHECK(lines.size() + dropped.get<std::size_t>() == orders + 2);
  CHECK(contains(ended.err, "events that nobody read in time"));
}

TEST_CASE("sim keeps what its clients wrote") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  CHECK(bench.run({"-i", "sim:", "set", "-n", "12", "servo_id=77"}).status == 0);
  CHECK(contains(bench.run({"-i", "sim:", "get", "-n", "12", "servo_id"}).out, "servo_id   77"));
}

TEST_CASE("on the virtual clock of sim a minute passes at once") {
  const Bench bench;
  const Background sim(bench, {"sim", "--clock", "virtual"});
  const Result scan = bench.run({"-i", "sim:", "scan", "--listen", "60", "--json"});
  CHECK(scan.status == 0);
  CHECK(json(scan.out)["nodes"][0]["info"]["uptime_s"] >= 59);
}

TEST_CASE("a client that is killed harms neither servos nor other clients") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  Background other(bench, listening, {}, "");
  {
    Background victim(bench, asking, {.terminal = true}, question);
    victim.kill();
  }
  CHECK(bench.run(get_servo_id).status == 0);
  CHECK(other.stop(SIGINT).status == 130);
  CHECK(bench.run(get_servo_id).status == 0);
}

TEST_CASE("a second sim on the same socket is refused, and the first goes on") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  const Result second = bench.run({"sim"});
  CHECK(second.status == 9);
  CHECK(codes(second) == std::vector<std::string>{"busy"});
  CHECK(contains(second.err, "a simulator already serves "));
  CHECK(contains(second.err, "\n  use it with `blactl -i sim: scan`, or stop it with Ctrl-C"));
  CHECK(bench.run(get_servo_id).status == 0);
  const Result document = bench.run({"sim", "--json"});
  CHECK(document.status == 9);
  const auto lines = json_lines(document.out);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0]["errors"][0]["code"] == "busy");
}

TEST_CASE("sims on sockets of their own do not meet") {
  const Bench bench;
  const std::string socket = "sim:" + (bench.folder() / "second").string();
  const Background first(bench, {"sim"});
  const Background second(bench, {"-i", socket, "sim"});
  CHECK(bench.run({"-i", socket, "set", "-n", "11", "servo_id=9"}).status == 0);
  CHECK(contains(bench.run(get_servo_id).out, "servo_id   1"));
}

TEST_CASE("the socket that a killed sim left behind is replaced") {
  const Bench bench;
  {
    Background sim(bench, {"sim"});
    sim.kill();
  }
  CHECK(std::filesystem::exists(bench.folder() / "run" / "blactl" / "sim"));
  const Result left = bench.run(get_servo_id);
  CHECK(left.status == 0);
  CHECK(contains(left.err, "no simulator is running: using a private fresh one"));
  const std::string socket = "sim:" + (bench.folder() / "run" / "blactl" / "sim").string();
  const Result named = bench.run({"-i", socket, "scan"}); // one that was named must be there
  CHECK(named.status == 3);
  CHECK(contains(named.err, "\n  start `blactl sim` in another terminal"));
  const Background sim(bench, {"sim"});
  CHECK(bench.run(get_servo_id).status == 0);
}

TEST_CASE("a session whose simulator ends fails with 3") {
  const Bench bench;
  Background sim(bench, {"sim"});
  Background client(bench, asking, {.terminal = true}, question);
  (void)sim.stop();
  const Result result = client.wait();
  CHECK(result.status == 3);
  CHECK(codes(result) == std::vector<std::string>{"interface"});
  CHECK(contains(result.err, "the simulator of "));
}

TEST_CASE("three at once on one bus: the third finds no node ID of its own") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  const Background first(bench, listening, {}, "");
  const Background second(bench, asking, {.terminal = true}, question);
  const Result third = bench.run(get_servo_id);
  CHECK(third.status == 9);
  CHECK(codes(third) == std::vector<std::string>{"no_local_node_id"});
  CHECK(contains(third.err, std::to_string(first.pid())));
  CHECK(contains(third.err, "\n  wait until one of them ends, or give a free ID"));
  Arguments own = get_servo_id;
  own.insert(own.end(), {"--local-node-id", "99"});
  CHECK(bench.run(own).status == 0);
}

// The simulator's servos drop a repeated transfer ID for 2 s, as the standard has it: a client that
// began to count anew would not be heard.
TEST_CASE("a hundred commands in a row are all answered") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  int answered = 0;
  for (int i = 0; i < 100; ++i) {
    answered += bench.run(get_servo_id).status == 0 ? 1 : 0;
  }
  CHECK(answered == 100);
}

TEST_CASE("a long scan ends with the signal, and says what it has found") {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Bench bench;
    const Background sim(bench, {"sim"});
    Tap tap(bench);
    Background scan(bench, {"-i", "sim:", "scan", "--listen", "3600", "--json"}, {}, "");
    tap.wait_for(127);
    const Result result = scan.stop(signal);
    CHECK(result.status == 128 + signal);
    const auto document = json(result.out);
    CHECK(document["exit_status"] == 128 + signal);
    CHECK(document["errors"][0]["code"] == "interrupted");
    CHECK(codes(result) == std::vector<std::string>{"interrupted"});
  }
}

TEST_CASE("sim is steered from standard input") {
  const Bench bench;
  Background sim(bench, {"sim", "--clock", "virtual"},
                 {.answers = {{"ready", "240900001 plugged=off\nnonsense\n7 voltage=5V\ndump\n"}}},
                 "bus load");
  const Result scan = bench.run({"-i", "sim:", "scan", "--json"});
  CHECK(scan.status == 0);
  CHECK(json(scan.out)["nodes"].size() == 2);
  const Result ended = sim.stop();
  CHECK(contains(ended.out, "serial 240900001"));
  CHECK(codes(ended) == std::vector<std::string>{"usage", "usage"});
  CHECK(contains(ended.err, "no servo has the serial number 7"));
}

TEST_CASE("sim dumps what RAM and ROM of its servos hold") {
  const Bench bench;
  Background sim(bench, {"sim", "--json", "--clock", "virtual"},
                 {.answers = {{R"("restart")", "dump\n"}}});
  CHECK(
      bench.run({"-i", "sim:", "set", "-n", "11", "angle_limit_cw=90deg", "--save", "-y"}).status ==
      0);
  sim.expect("dumped");
  const auto lines = json_lines(sim.stop().out);
  const auto state = std::ranges::find_if(lines, [](const nlohmann::json& line) {
    return line.value("event", "") == "state" && line.at("serial_number") == 240900001;
  });
  REQUIRE(state != lines.end());
  CHECK(state->at("ram").at("0x38") == 900);
  CHECK(state->at("rom").at("0x38") == 900);
  CHECK(state->at("count") == 1);
  const auto dumped = std::ranges::find_if(
      lines, [](const nlohmann::json& line) { return line.value("event", "") == "dumped"; });
  REQUIRE(dumped != lines.end());
  CHECK(dumped->at("count") == 3);
  CHECK(dumped->at("bus_load") > 0);
  CHECK(dumped->at("bus_load") < 0.5);
}

TEST_CASE("the time of a held bus stands until its clients are there") {
  const Bench bench;
  const Background sim(bench, {"sim", "--clock", "virtual"},
                       {.answers = {{"ready", "hold 2\ndump\n"}}}, "bus load");
  Background first(bench, {"-i", "sim:", "wait", "-n", "11", "--wait", "100"}, {}, "");
  CHECK(bench.run({"-i", "sim:", "get", "-n", "12", "smoothing"}).status == 0);
  CHECK(first.wait().status == 0);
}

TEST_CASE("clients that are cut off are told that nobody acknowledges them") {
  const Bench bench;
  const Background sim(bench, {"sim", "--clock", "virtual"},
                       {.answers = {{"ready", "clients cut\ndump\n"}}}, "bus load");
  const Result got = bench.run({"-i", "sim:", "get", "-n", "11"});
  CHECK(got.status == 3);
  CHECK(codes(got) == std::vector<std::string>{"no_acknowledge"});
}

TEST_CASE("a scenario with faults of the wire does not go onto a real one") {
  const Bench bench;
  for (const char* members : {R"("wire":{"loss":0.1})", R"("events":[{"clients":"cut"}])"}) {
    const Result refused =
        bench.run({"-i", "can0", "sim",
                   bench.file("s.json", R"({"schema":"blactl-scenario/1","servos":[],)" +
                                            std::string(members) + "}")});
    CHECK(refused.status == 2);
    CHECK(codes(refused) == std::vector<std::string>{"usage"});
  }
}
