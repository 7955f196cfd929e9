// The built binary on an slcan adapter: a pseudo terminal with simulated servos behind it.

#include "blactl/bla/profile.hpp"
#include "blactl/sim/bus/private_bus.hpp"
#include "blactl/sim/scenario/scenario.hpp"

#include "catch.hpp"
#include "run.hpp"
#include "scene.hpp"
#include "unit/can/slcan_adapter.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace blactl::test;
using blactl::can::test::Dialect;
using blactl::can::test::SlcanAdapter;

namespace can = blactl::can;
namespace bla = blactl::bla;
namespace sim = blactl::sim;

namespace {

/// On the clock of the machine.
std::unique_ptr<can::Bus> servos_of(std::string_view text) {
  static const auto profiles = bla::Profiles::load(std::nullopt);
  const auto scenario = sim::parse_scenario(text, "slcan_test", profiles.value());
  if (!scenario) {
    throw std::runtime_error(scenario.error().message);
  }
  return std::make_unique<sim::PrivateBus>("slcan_test", *scenario);
}

/// Servo 11, a BLA21.
std::unique_ptr<can::Bus> bus_of_one_servo() {
  return servos_of(R"({
    "schema": "blactl-scenario/1", "clock": "real",
    "servos": [{"model": "BLA21-12U-AB", "node_id": 11}]
  })");
}

std::string interface(const SlcanAdapter& adapter, const std::string& options = {}) {
  return "slcan:" + adapter.path() + options;
}

/// One request is asked more often than usual: the servo has just been powered, and the adapter is
/// a thread on a busy machine.
Arguments patient(const std::string& interface, Arguments command) {
  Arguments arguments{"-i", interface, "--timeout", "0.5", "--retries", "20"};
  std::ranges::move(command, std::back_inserter(arguments));
  return arguments;
}

bool is_frame(const std::string& line) {
  return line.starts_with('T');
}

std::string data_file(const std::string& name) {
  std::ifstream in(BLACTL_TEST_DATA "/" + name);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// How one job of eight servos ends, and what ROM of each holds.
std::vector<std::string> end_of_job(const Bench& bench, const std::string& interface) {
  const auto run = [&](Arguments command) {
    return bench.run(patient(interface, std::move(command)), {.timeout = 120s});
  };
  const Result applied = run({"apply", BLACTL_TEST_DATA "/fleets/eight.json", "-y", "-j"});
  INFO(applied.err);
  CHECK(applied.status == 0);
  std::vector<std::string> ends;
  const auto document = json(applied.out);
  for (const auto& node : document["nodes"]) {
    for (const auto* key : {"name", "status", "saved", "verified_after_restart", "node_id_after"}) {
      ends.push_back(key + node[key].dump());
    }
  }
  CHECK(run({"restart", "-n", "all", "-y"}).status == 0); // RAM is what ROM holds
  const auto held = json(run({"export"}).out);
  for (const auto& servo : held["servos"]) {
    ends.push_back(servo["match"].dump() + servo["set"].dump());
  }
  return ends;
}

} // namespace

TEST_CASE("slcan: parameters are read and written through every kind of adapter") {
  const std::vector<std::pair<Dialect, std::string>> cases{
      {can::test::starter_kit(), "?open=plain"},
      {can::test::starter_kit(), ""},
      {can::test::lawicel(), ""},
      {can::test::lawicel(), "?open=s8&baud=115200"},
      {can::test::canable(), ""},
      {can::test::canable(), "?open=s8&ack=none"},
      {can::test::ardupilot(), ""},
      {can::test::fixed_rate(), ""},
      {can::test::noisy(), "?gap=1"},
  };
  for (const auto& [dialect, options] : cases) {
    const Bench bench;
    SlcanAdapter adapter(dialect, bus_of_one_servo());
    INFO(adapter.path() + options + " " + std::to_string(&dialect - &cases.front().first));
    const std::string name = interface(adapter, options);
    const Result set = bench.run(patient(name, {"set", "-n", "11", "angle_limit_cw=90deg"}));
    INFO(set.err);
    CHECK(set.status == 0);
    const Result get = bench.run(patient(name, {"get", "-n", "11", "angle_limit_cw", "-j"}));
    INFO(get.err);
    REQUIRE(get.status == 0);
    CHECK(json(get.out)["nodes"][0]["params"][0]["raw"] == 900);
    CHECK(json(get.out)["interface"] == interface(adapter));
    const auto lines = adapter.lines();
    CHECK(std::ranges::none_of(lines, [](const std::string& line) {
      return is_frame(line) && line.size() < 12; // not one in pieces
    }));
  }
}

TEST_CASE("slcan: one job of eight servos ends as on the simulated bus") {
  const Bench bench;
  SlcanAdapter adapter(can::test::canable(), servos_of(data_file("scenarios/eight.json")));
  const auto ends = end_of_job(bench, interface(adapter));
  const Background sim(bench,
                       {"sim", "--clock", "virtual", BLACTL_TEST_DATA "/scenarios/eight.json"});
  CHECK(ends.size() == 8 * (5 + 1));
  CHECK(ends == end_of_job(bench, "sim:"));
}

TEST_CASE("slcan: servos are found however long the adapter took to open") {
  const Bench bench;
  SlcanAdapter adapter(can::test::canable(), bus_of_one_servo());
  const Result scan = bench.run(patient(interface(adapter), {"scan", "-j"}));
  INFO(scan.err);
  CHECK(scan.status == 0);
  CHECK(json(scan.out)["nodes"][0]["node_id"] == 11);
  const Result search = bench.run(patient(interface(adapter), {"get", "servo_id", "-j"}));
  INFO(search.err);
  CHECK(search.status == 0);
  adapter.wait_for([](const auto& lines) { return lines.back() == "C"; });
}

TEST_CASE("slcan: an adapter with a fixed bit rate is noted, unless -q") {
  const Bench bench;
  SlcanAdapter adapter(can::test::fixed_rate(), bus_of_one_servo());
  const Result told = bench.run(patient(interface(adapter), {"get", "-n", "11", "servo_id"}));
  CHECK(told.status == 0);
  CHECK(contains(told.err, "its bit rate is presumably fixed"));
  const Result quiet =
      bench.run(patient(interface(adapter), {"-q", "get", "-n", "11", "servo_id"}));
  CHECK(quiet.err.empty());
}

TEST_CASE("slcan: an adapter that refuses everything is exit 3 with a way out") {
  const Bench bench;
  const SlcanAdapter adapter(can::test::stubborn(), bus_of_one_servo());
  const Result result = bench.run(patient(interface(adapter), {"scan"}));
  CHECK(result.status == 3);
  CHECK(codes(result) == std::vector<std::string>{"interface"});
  CHECK(contains(result.err, "?open=plain\""));
}

TEST_CASE("slcan: an adapter without servos behind it is no answer") {
  const Bench bench;
  const SlcanAdapter adapter(can::test::canable());
  const Result result = bench.run({"-i", interface(adapter), "get", "-n", "11"});
  CHECK(result.status == 4);
}

TEST_CASE(
    "slcan: what is wrong with an adapter is told by what it does, never as a missing servo") {
  struct Case {
    Dialect dialect;
    int status;
    std::string code, message, hint;
  };

  const std::vector<Case> cases{
      {can::test::canable(), 4, "not_found", "no data came from the adapter at ", "?open=plain"},
      {can::test::wrong_baud(), 3, "interface", "baud is not slcan", "?baud=115200"},
      {can::test::garbled(), 3, "interface", "baud is not slcan", "?baud=115200"},
      {can::test::satellite_receiver(), 3, "interface", "sends text that is not slcan",
       "is it a CAN adapter?"},
      {can::test::telemetry(), 3, "interface", "speaks MAVLink", "CAN_SLCAN_CPORT"},
      {can::test::closed(), 3, "interface", "refuses to open its CAN channel", "?open=plain"},
      {can::test::listening(), 3, "interface", "refuses to send", "does anybody acknowledge"},
      {can::test::lawicel(), 4, "not_found", "", "is the supply on, and the bit rate"},
  };
  for (const auto& [dialect, status, code, message, hint] : cases) {
    for (const Arguments& command :
         {Arguments{"scan"}, {"get", "-n", "11"}, {"save", "-n", "11"}}) {
      const Bench bench;
      const SlcanAdapter adapter(dialect);
      INFO(message + " " + command.front());
      Arguments arguments{"-i", interface(adapter)};
      std::ranges::copy(command, std::back_inserter(arguments));
      const Result result = bench.run(arguments);
      INFO(result.err);
      CHECK(result.status == status);
      CHECK(codes(result) == std::vector<std::string>{code});
      CHECK(contains(result.err, message));
      CHECK(contains(result.err, hint));
    }
  }
}

TEST_CASE("slcan: doctor tells what an adapter says of itself, and what it has counted") {
  const Bench bench;
  Dialect dialect = can::test::lawicel();
  dialect.to_status = "F24\r";
  const SlcanAdapter adapter(dialect, bus_of_one_servo());
  const Result doctor = bench.run(patient(interface(adapter), {"doctor", "-j"}));
  INFO(doctor.out << doctor.err);
  CHECK(doctor.status == 8);
  const auto document = json(doctor.out);
  CHECK(document["adapter"]["version"] == "1013");
  CHECK(document["adapter"]["serial_number"] == "A123");
  CHECK(document["adapter"]["status"] == 0x24);
  REQUIRE(document["findings"].size() == 2);
  CHECK(document["findings"][0]["code"] == "error_passive");
  CHECK(document["findings"][1]["code"] == "error_warning");
}

TEST_CASE("slcan: doctor names the adapter; one that tells nothing lacks nothing") {
  const Bench bench;
  const SlcanAdapter known(can::test::ardupilot(), bus_of_one_servo());
  const Result told = bench.run(patient(interface(known), {"doctor"}));
  INFO(told.out << told.err);
  CHECK(told.status == 0);
  CHECK(contains(told.out, interface(known) + ", version 1010, serial number 0123"));
  CHECK(contains(told.out, ", status 00"));
  const SlcanAdapter silent(can::test::canable(), bus_of_one_servo());
  const Result nothing = bench.run(patient(interface(silent), {"doctor"}));
  INFO(nothing.out << nothing.err);
  CHECK(nothing.status == 0);
  CHECK(contains(nothing.out, interface(silent) + "\n"));
}

TEST_CASE("slcan: doctor hears MAVLink and text, beside the error that nothing can be opened") {
  const Bench bench;
  for (const auto& [dialect, code] : {std::pair(can::test::telemetry(), "mavlink"),
                                      std::pair(can::test::satellite_receiver(), "no_slcan")}) {
    const SlcanAdapter adapter(dialect);
    const Result doctor = bench.run({"-i", interface(adapter), "doctor", "-j"});
    INFO(doctor.out << doctor.err);
    CHECK(doctor.status == 3);
    REQUIRE(json(doctor.out)["findings"].size() == 1);
    CHECK(json(doctor.out)["findings"][0]["code"] == code);
  }
}

TEST_CASE("slcan: a port in use names the program and its process") {
  const Bench bench;
  SlcanAdapter adapter(can::test::lawicel(), bus_of_one_servo());
  Background first(bench, patient(interface(adapter), {"-v", "scan", "--listen", "60"}), {}, "");
  adapter.wait_for([](const auto& lines) { return std::ranges::any_of(lines, is_frame); });
  // By another name, and for a command that sends nothing.
  const std::string link = bench.folder() / "adapter";
  std::filesystem::create_symlink(adapter.path(), link);
  for (const std::string& name : {interface(adapter), "slcan:" + link}) {
    const Result second = bench.run({"-i", name, "scan", "--listen-only"});
    CHECK(second.status == 3);
    CHECK(codes(second) == std::vector<std::string>{"interface"});
    CHECK(
        contains(second.err, "is in use by blactl (process " + std::to_string(first.pid()) + ")"));
    CHECK(contains(second.err, "kill " + std::to_string(first.pid())));
  }
  CHECK(first.stop(SIGINT).status == 130);
  const Result after = bench.run(patient("slcan:" + link, {"get", "-n", "11", "servo_id"}));
  INFO(after.err);
  CHECK(after.status == 0);
}

TEST_CASE("slcan: an adapter pulled out in the middle of a command ends it, exit 3") {
  const Bench bench;
  auto adapter = std::make_unique<SlcanAdapter>(can::test::lawicel(), bus_of_one_servo());
  const std::string path = adapter->path();
  Background command(bench, patient(interface(*adapter), {"scan", "--listen", "60"}), {}, "");
  adapter->wait_for([](const auto& lines) { return std::ranges::any_of(lines, is_frame); });
  adapter->unplug();
  const Result result = command.wait();
  CHECK(result.status == 3);
  CHECK(contains(result.err, "the adapter at " + path + " is gone"));
  CHECK(contains(result.err, "\n  plug it in again"));
}

TEST_CASE("slcan: monitor waits for an adapter that was pulled out, and opens it again") {
  const Bench bench;
  const auto port = bench.folder() / "adapter";
  const auto plug_in = [&](Dialect dialect) {
    auto adapter = std::make_unique<SlcanAdapter>(std::move(dialect), bus_of_one_servo());
    std::filesystem::remove(port);
    std::filesystem::create_symlink(adapter->path(), port);
    return adapter;
  };
  auto adapter = plug_in(can::test::lawicel());
  Background monitor(bench, {"-i", "slcan:" + port.string(), "monitor", "--json", "--rate", "10"},
                     {}, "\"voltage_v\":12.0");
  adapter->unplug();
  monitor.expect("waiting for it");
  monitor.expect("\"mode\":\"offline\"");
  adapter = plug_in({.to_open = "\a"}); // it says no
  adapter->wait_for([](const auto& lines) { return lines.size() > 3; });
  adapter->unplug();
  adapter = plug_in(can::test::lawicel());
  monitor.expect("is back");
  adapter->wait_for([](const auto& lines) { return std::ranges::count_if(lines, is_frame) > 30; });
  const Result ended = monitor.stop(SIGTERM);
  INFO(ended.err);
  CHECK(ended.status == 143);
  CHECK(codes(ended) == std::vector<std::string>{"interrupted"});
}

TEST_CASE("slcan: a signal while the adapter is opened ends the command as at any time") {
  const Bench bench;
  for (const int signal : {SIGINT, SIGTERM}) {
    Dialect dialect = can::test::lawicel();
    dialect.to_empty = "";
    dialect.to_close = "";
    SlcanAdapter adapter(dialect);
    Background command(bench, {"-i", interface(adapter), "get", "-n", "11"}, {}, "");
    adapter.wait_for([](const auto& lines) { return !lines.empty(); });
    CHECK(command.stop(signal).status == 128 + signal);
  }
}

TEST_CASE("slcan: what is wrong with the name of the interface is told before anything is opened") {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"slcan:", "the device is missing"},
      {"slcan:/dev/x?speed=1", "there is no option 'speed'"},
      {"slcan:/dev/x?gap=1&gap=2", "gap is given twice"},
      {"slcan:/dev/x?baud=fast", "baud fast: not a rate"},
      {"slcan:/dev/x?open=no", "open no: not one of plain, s8"},
  };
  for (const auto& [name, message] : cases) {
    const Result result = run({"-i", name, "scan"});
    CHECK(result.status == 2);
    CHECK(codes(result) == std::vector<std::string>{"usage"});
    CHECK(contains(result.err, message));
    CHECK(contains(result.err, "baud=1000000&open=plain,s8&ack=auto,none&gap=MS"));
  }
  const Result absent = run({"-i", "slcan:/dev/no-such-port", "scan"});
  CHECK(absent.status == 3);
  CHECK(contains(absent.err, "there is no serial port /dev/no-such-port"));
}

TEST_CASE("slcan: simulated servos join a bus behind an adapter") {
  const Bench bench;
  SlcanAdapter adapter(can::test::lawicel());
  const Background sim(bench, {"-i", interface(adapter), "sim"});
  // actuator.Status comes ten times a second.
  adapter.wait_for([](const auto& lines) { return std::ranges::count_if(lines, is_frame) > 20; });
  CHECK(adapter.lines()[3] == "O");
}

TEST_CASE("slcan: frames that waited while the command was stopped make no second unit of one") {
  const Bench bench;
  std::string servos;
  for (int id = 11; id < 27; ++id) { // more than the port keeps
    servos += std::string(servos.empty() ? "" : ",") + R"({"model": "BLA21-12U-AB", "node_id": )" +
              std::to_string(id) + "}";
  }
  SlcanAdapter adapter(
      can::test::lawicel(),
      servos_of(R"({"schema": "blactl-scenario/1", "clock": "real", "servos": [)" + servos + "]}"));
  Background monitor(bench, {"-i", interface(adapter), "faults", "--watch"}, {}, "node 26");
  std::this_thread::sleep_for(2s);
  REQUIRE(::kill(monitor.pid(), SIGSTOP) == 0);
  std::this_thread::sleep_for(4s);
  REQUIRE(::kill(monitor.pid(), SIGCONT) == 0);
  std::this_thread::sleep_for(3s);
  const Result ended = monitor.stop(SIGINT);
  INFO(ended.out << ended.err);
  CHECK(ended.status == 130);
  CHECK_FALSE(contains(ended.out + ended.err, "two units"));
  CHECK_FALSE(contains(ended.out, "restarted"));
  CHECK_FALSE(contains(ended.out, "gone"));
}
