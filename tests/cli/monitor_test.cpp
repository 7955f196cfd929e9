// blactl monitor as a stream: what a pipe gets, and what it costs the bus.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

using Lines = std::vector<nlohmann::ordered_json>;

Lines lines_of(const Result& result) {
  Lines lines;
  std::size_t at = 0;
  while (at < result.out.size()) {
    const std::size_t end = result.out.find('\n', at);
    lines.push_back(nlohmann::ordered_json::parse(result.out.substr(at, end - at)));
    at = end + 1;
  }
  return lines;
}

/// The samples of one servo: the last line is none.
Lines samples_of(const Lines& lines, int node_id) {
  Lines out;
  for (const auto& line : lines) {
    if (line.contains("node_id") && line["node_id"] == node_id) {
      out.push_back(line);
    }
  }
  return out;
}

std::size_t count(const std::string& text, std::string_view part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

} // namespace

TEST_CASE("a pipe gets a line a sample, with the keys of the contract") {
  const Result result = three_servos().run({"monitor", "--json", "--count", "4"});
  INFO(result.err);
  CHECK(result.status == 0);
  CHECK(result.err.empty());
  const Lines lines = lines_of(result);
  REQUIRE(lines.size() == 13);
  const Lines samples = samples_of(lines, 12);
  REQUIRE(samples.size() == 4);
  CHECK(keys(samples.back()) ==
        std::vector<std::string>{"time", "node_id", "unique_id", "model", "serial_number",
                                 "servo_id", "firmware_version", "hardware_version", "angle_deg",
                                 "speed_rpm", "torque_pct", "temperature_c", "voltage_v", "mode",
                                 "health", "fault_summary", "stale"});
  CHECK(samples.back()["model"] == "BLA15-06U-A0");
  CHECK(samples.back()["angle_deg"] == 0.0);
  CHECK(samples.back()["speed_rpm"] == 0);
  CHECK(samples.back()["fault_summary"] == 0);
  CHECK(samples.back()["mode"] == "operational");
  CHECK(samples.back()["stale"] == false);
  CHECK(samples[1]["time"].get<double>() - samples[0]["time"].get<double>() == Approx(0.5));
  CHECK(lines.back()["exit_status"] == 0);
  CHECK(lines.back()["counts"]["nodes"] == 3);
  CHECK(lines.back()["counts"]["samples"] == 4);
}

TEST_CASE("as text and as CSV the same stands below a header") {
  const Result csv = three_servos().run({"monitor", "--csv", "--count", "3", "-n", "11"});
  CHECK(csv.out.starts_with("time,node_id,unique_id,model,serial_number,servo_id,firmware_version,"
                            "hardware_version,angle_deg,"));
  CHECK(count(csv.out, "\n") == 4);
  CHECK(contains(csv.out, ",operational,ok,"));
  const Result text = three_servos().run(
      {"monitor", "--count", "3", "-n", "11", "--fields", "voltage_v,angle_deg"});
  CHECK(text.out.starts_with("TIME           NODE      deg     V\n"));
  CHECK(count(text.out, "\n") == 4);
}

TEST_CASE("the lines of text are in words, and fit on 80 columns") {
  for (const auto* language : {"en", "ja"}) {
    const Result text = three_servos().run({"monitor", "--count", "6", "--lang", language});
    INFO(text.out);
    CHECK_FALSE(contains(text.out, "_"));
    CHECK(contains(text.out, std::string(language) == "en" ? "  ok\n" : "  正常\n"));
    std::istringstream lines(text.out);
    for (std::string line; std::getline(lines, line);) {
      CHECK(line.size() <= (std::string(language) == "en" ? 80 : 110)); // bytes
    }
  }
}

TEST_CASE("what is not shown is not asked for") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  REQUIRE(three_servos()
              .run(bench, {"monitor", "--fields", "angle_deg", "--duration", "5", "--rate", "10",
                           "--record", log})
              .status == 0);
  const Result trace = bench.run({"trace", log, "--type", "GetSet", "--kind", "request"});
  CHECK(contains(trace.out, "0x50"));
  CHECK_FALSE(contains(trace.out, "0x08"));
  CHECK_FALSE(contains(trace.out, "0x09"));
  CHECK_FALSE(contains(trace.out, "0x0C"));
}

TEST_CASE("questions take no more than their share of the bus") {
  Scene scene;
  for (int id = 1; id <= 40; ++id) {
    scene.servo("BLA21-12U-AB", id);
  }
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  REQUIRE(
      scene.run(bench, {"monitor", "--rate", "20", "--duration", "10", "--record", log}).status ==
      0);
  const Result trace = bench.run({"trace", log, "--type", "GetSet", "--kind", "request"});
  const std::size_t reads = count(trace.out, "\n");
  CHECK(reads > 1500);
  CHECK(reads < 1876 + 40 * 10); // 533 bits each: 10 % of 10 s; and the identification
}

TEST_CASE("a servo that turns out not to be meant is not asked any more") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11, {{"serial_number", 1}})
                          .servo("BLA15-06U-A0", 12, {{"serial_number", 2}})
                          .servo("BLA21-12U-AB", 13, {{"serial_number", 3}});
  const auto servos_asked = [&](const char* targets) {
    const Result result =
        scene.run(bench, {"monitor", "--json", "-n", targets, "--duration", "5", "--record", log});
    INFO(result.err);
    CHECK(result.status == 0);
    std::map<int, std::size_t> asked;
    for (const auto& line : json_lines(bench.run({"trace", log, "--json"}).out)) {
      if (line.value("kind", "") == "request" && line["destination"].is_number()) {
        ++asked[line["destination"].get<int>()];
      }
    }
    for (const auto& [id, count] : asked) {
      INFO("node " << id << ": " << count);
      CHECK((count <= 6) == samples_of(lines_of(result), id).empty()); // 6 identify it
    }
    return asked.size();
  };
  CHECK(servos_asked("model:BLA21") == 3);
  CHECK(servos_asked("serial:2") == 3);
  CHECK(servos_asked("13") == 1);
  CHECK(servos_asked("13,serial:2") == 3);
}

TEST_CASE("who is not meant is looked at again when it restarts") {
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11, {{"serial_number", 1}})
                          .servo("BLA15-06U-A0", 12, {{"serial_number", 2}})
                          .event(2, "power_off", "3s")
                          .servo("BLA15-06U-A0", 12, {{"serial_number", 3}})
                          .joins(3, "4s");
  const Result result = scene.run({"monitor", "--json", "-n", "serial:3", "--duration", "10"});
  const Lines lines = lines_of(result);
  CHECK(samples_of(lines, 11).empty());
  REQUIRE_FALSE(samples_of(lines, 12).empty());
  CHECK(samples_of(lines, 12).front()["serial_number"] == 3);
  CHECK(samples_of(lines, 12).back()["voltage_v"] == 7.4);
}

TEST_CASE("--listen-only sends nothing and shows what servos send by themselves") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  const Result result = three_servos().run(
      bench, {"--listen-only", "monitor", "--json", "--count", "3", "--record", log});
  CHECK(result.status == 0);
  const Lines samples = samples_of(lines_of(result), 11);
  REQUIRE(samples.size() == 3);
  CHECK(samples.back()["angle_deg"] == 0.0);
  CHECK(samples.back()["voltage_v"] == nullptr);
  CHECK(samples.back()["model"] == nullptr);
  CHECK(samples.back()["health"] == "ok");
  CHECK(bench.run({"trace", log, "--kind", "request"}).out.empty());
}

TEST_CASE("an angle that actuator.Status rounds is read from its register", "[requirement-109]") {
  const Fleet fleet(Scene().servo(
      "BLA21-12U-AB", 11,
      {{"rom",
        {{"soft_start", "off"}, {"angle_limit_cw", "2000deg"}, {"timeout_action", "hold"}}}}));
  REQUIRE(fleet.run({"set", "-n", "11", "command_angle=1234.5deg", "-y"}).status == 0);
  const auto last_angle = [&fleet](const Arguments& more) {
    Arguments arguments{"monitor", "--json", "--duration", "10"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return samples_of(lines_of(fleet.run(arguments)), 11).back()["angle_deg"].get<double>();
  };
  const double read = last_angle({});
  CHECK(read == Approx(static_cast<double>(fleet.ram("11", "current_angle")) / 10));
  CHECK(last_angle({"--listen-only"}) == Approx(1234.4)); // all that a float16 can tell
  CHECK(read != Approx(1234.4));
}

TEST_CASE("a recording tells the same as the bus did") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  REQUIRE(
      three_servos().run(bench, {"monitor", "--json", "--duration", "5", "--record", log}).status ==
      0);
  const Result result = bench.run({"-i", "replay:" + log, "monitor", "--json"});
  INFO(result.err);
  CHECK(result.status == 0);
  const Lines samples = samples_of(lines_of(result), 13);
  REQUIRE(samples.size() >= 9);
  CHECK(samples.back()["model"] == "BLA34-28U-AB");
  CHECK(samples.back()["voltage_v"] == 28.0);
  CHECK(samples.back()["stale"] == false);
}

TEST_CASE("--duration and --count end a recording, too") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  REQUIRE(three_servos().run(bench, {"monitor", "--duration", "5", "--record", log}).status == 0);
  const auto samples = [&](const char* option, const char* value) {
    const Result result = bench.run({"-i", "replay:" + log, "monitor", "--json", option, value});
    return samples_of(lines_of(result), 11).size();
  };
  CHECK(samples("--duration", "2") == 4);
  CHECK(samples("--count", "3") == 3);
}

TEST_CASE("angles are not asked for where they are not shown") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  const Scene scene =
      Scene().servo("BLA21-12U-AB", 11, {{"faults", {{"no_actuator_status", true}}}});
  for (const char* field : {"voltage_v", "angle_deg"}) {
    REQUIRE(scene
                .run(bench,
                     {"monitor", "-n", "11", "--fields", field, "--duration", "5", "--record", log})
                .status == 0);
    const Result trace = bench.run({"trace", log, "--type", "GetSet", "--kind", "request"});
    CHECK(contains(trace.out, "0x08") == (std::string_view(field) == "angle_deg"));
  }
}

TEST_CASE("a servo that loses its supply is stale, then offline, and comes back as itself",
          "[requirement-26]") {
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11, {{"serial_number", 7}})
                          .event(7, "power_off", "3s")
                          .event(7, "power_on", "8s");
  const Result result = scene.run({"monitor", "--json", "--duration", "12"});
  INFO(result.err);
  const Lines samples = samples_of(lines_of(result), 11);
  const auto mode_at = [&](std::size_t half_seconds) { return samples.at(half_seconds)["mode"]; };
  CHECK(mode_at(4) == "operational");
  CHECK(mode_at(14) == "offline");
  CHECK(samples.at(14)["stale"] == true);
  CHECK(samples.back()["mode"] == "operational");
  CHECK(samples.back()["stale"] == false);
}

TEST_CASE("of two servos under one node ID nothing is told but that") {
  const Result result = Scene()
                            .servo("BLA21-12U-AB", 11, {{"serial_number", 1}})
                            .servo("BLA21-12U-AB", 11, {{"serial_number", 2}})
                            .run({"monitor", "--json", "--duration", "5"});
  CHECK(result.status == 9);
  const Lines samples = samples_of(lines_of(result), 11);
  for (const char* key : {"unique_id", "model", "serial_number", "servo_id", "firmware_version",
                          "hardware_version", "angle_deg"}) {
    INFO(key);
    CHECK(samples.back()[key] == nullptr);
  }
  CHECK(samples.back()["stale"] == true);
  CHECK(codes(result) == std::vector<std::string>{"duplicate_node_id"});
}

TEST_CASE("when one of two servos under one node ID is taken off, monitor shows the other") {
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11, {{"serial_number", 1}})
                          .servo("BLA21-12U-AB", 11, {{"serial_number", 2}})
                          .event(2, "power_off", "8s");
  const Result result = scene.run({"monitor", "--json", "--duration", "30"});
  INFO(result.err);
  CHECK(result.status == 0);
  const Lines samples = samples_of(lines_of(result), 11);
  CHECK(samples.at(14)["serial_number"] == nullptr);
  CHECK(samples.at(14)["stale"] == true);
  CHECK(samples.back()["serial_number"] == 1);
  CHECK(samples.back()["stale"] == false);
}

TEST_CASE("a selector may mean one of two servos under one node ID") {
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11, {{"serial_number", 1}})
                          .servo("BLA21-12U-AB", 11, {{"serial_number", 2}})
                          .servo("BLA21-12U-AB", 12, {{"serial_number", 3}});
  for (const char* target : {"serial:1", "serial:2", "serial:9", "serial:1,serial:2"}) {
    const Result result = scene.run({"monitor", "--json", "--duration", "3", "-n", target});
    INFO(target);
    CHECK(result.status == 9);
    CHECK(codes(result) == std::vector<std::string>{"duplicate_node_id"});
    CHECK(samples_of(lines_of(result), 12).empty());
  }
  CHECK(scene.run({"monitor", "--duration", "3", "-n", "serial:3"}).status == 0);
}

TEST_CASE("who was never heard is missing in the end") {
  const auto status = [](const char* targets) {
    const Result result =
        three_servos().run({"monitor", "--json", "--duration", "3", "-n", targets});
    const bool is_missing = codes(result) == std::vector<std::string>{"not_found"};
    CHECK(is_missing == (result.status != 0));
    return result.status;
  };
  CHECK(status("99") == 4);
  CHECK(status("serial:77") == 4);
  CHECK(status("model:BLA56") == 4);
  CHECK(status("11,99") == 6);
  CHECK(status("11,serial:77") == 6);
  CHECK(status("all,11") == 0);
  const Result restarts = Scene() // just before the end
                              .servo("BLA21-12U-AB", 11, {{"serial_number", 1}})
                              .event(1, "power_off", "2s")
                              .event(1, "power_on", "2.5s")
                              .run({"monitor", "--duration", "2.9", "-n", "serial:1"});
  CHECK(restarts.status == 0);
  const Result nobody = Scene().foreign(40).run({"monitor", "--json", "--duration", "3"});
  check_error(nobody, 4, "not_found", "nodes on the bus: 40");
}

TEST_CASE("of a recording a servo is chosen by what it said, and who is not in it is told") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  REQUIRE(Scene()
              .servo("BLA21-12U-AB", 11, {{"serial_number", 1}})
              .servo("BLA15-06U-A0", 12, {{"serial_number", 2}})
              .run(bench, {"monitor", "--duration", "3", "--record", log})
              .status == 0);
  const auto replay = [&](const char* targets) {
    return bench.run({"-i", "replay:" + log, "monitor", "--json", "-n", targets});
  };
  for (const char* targets : {"serial:2", "model:BLA15"}) {
    const Result chosen = replay(targets);
    CHECK(chosen.status == 0);
    CHECK_FALSE(samples_of(lines_of(chosen), 12).empty());
    CHECK(samples_of(lines_of(chosen), 11).empty());
  }
  CHECK(codes(replay("99")) == std::vector<std::string>{"not_recorded"});
  CHECK(replay("99").status == 4);
  CHECK(codes(replay("serial:9")) == std::vector<std::string>{"not_found"});
}

TEST_CASE("an interface that goes away is waited for, and servos go on where they are back") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  std::optional<Background> sim(std::in_place, bench, Arguments{"sim"});
  Background monitor(bench, {"-i", "sim:", "monitor", "--json", "--rate", "10", "--record", log},
                     {}, "\"voltage_v\":12.0");
  CHECK(sim->stop().status == 143);
  monitor.expect("waiting for it");
  monitor.expect("\"stale\":true");
  monitor.expect("\"mode\":\"offline\"");
  sim.emplace(bench, Arguments{"sim"});
  monitor.expect("is back");
  const std::size_t so_far = content(log).size();
  CHECK(bench.run({"-i", "sim:", "wait"}).status == 0);
  for (int i = 0; i < 1000 && content(log).size() < so_far + 10'000; ++i) {
    usleep(10'000);
  }
  const Result ended = monitor.stop(SIGINT);
  INFO(ended.err);
  CHECK(ended.status == 130);
  CHECK(codes(ended) == std::vector<std::string>{"interrupted"});
  CHECK(lines_of(ended).size() > 10);
  const Lines samples = samples_of(lines_of(ended), 11);
  CHECK(samples.back()["mode"] == "operational");
  CHECK(samples.back()["voltage_v"] == 12.0);
}

TEST_CASE("an interface that is away in the end is an error, as one that was never there") {
  const Bench bench;
  std::optional<Background> sim(std::in_place, bench, Arguments{"sim", "--json"});
  const std::string socket = (bench.folder() / "blactl" / "sim").string();
  Background monitor(bench, {"-i", "sim:", "monitor", "--json", "--duration", "3"}, {},
                     "\"node_id\"");
  (void)sim->stop();
  const Result ended = monitor.wait();
  CHECK(ended.status == 3);
  CHECK(codes(ended) == std::vector<std::string>{"interface"});
  CHECK(lines_of(ended).back()["exit_status"] == 3);
  check_error(bench.run({"-i", "sim:" + socket, "monitor"}), 3, "interface", "");
}

TEST_CASE("a rate that is out of range is told in Hz") {
  check_error(Scene().run({"monitor", "--rate", "1000"}), 2, "usage",
              "--rate 1000: not a number of Hz between 0.001 and 50");
  const Result japanese = Scene().run({"--lang", "ja", "monitor", "--rate", "0"});
  CHECK(contains(japanese.err, "--rate 0: 0.001～50 Hz の範囲の数値ではありません"));
}

TEST_CASE("monitor waits on an empty bus") {
  const Result result = Scene().run({"monitor", "--json", "--duration", "5"});
  CHECK(result.status == 4);
  CHECK(codes(result) == std::vector<std::string>{"not_found"});
  CHECK(lines_of(result).size() == 1);
}

TEST_CASE("a named servo that falls silent ends monitor with 4, one that is not named does not") {
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11, {{"serial_number", 7}})
                          .servo("BLA21-12U-AB", 12)
                          .event(7, "power_off", "3s");
  const Arguments monitor{"monitor", "--duration", "8", "--json"};
  CHECK(scene.run(monitor).status == 0);
  for (const auto& [named, status] :
       {std::pair("11", 4), std::pair("serial:7", 4), std::pair("11,12", 6)}) { // 6: 12 is there
    Arguments one = monitor;
    one.insert(one.end(), {"-n", named});
    check_error(scene.run(one), status, "timeout", "node 11 does not answer any more");
  }
}
