#include "blactl/sim/bus/server.hpp"
#include "blactl/sim/scenario/scenario.hpp"

#include "catch.hpp"
#include "cli/interface/bus_factory.hpp"
#include "cli/interface/scheme.hpp"
#include "unit/bla/built_in.hpp"

#include <poll.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stop_token>
#include <string>
#include <thread>
#include <tuple>

using namespace blactl;
using namespace blactl::cli;

namespace {

std::string kind(std::string_view text) {
  const auto name = parse_interface(text);
  if (!name) {
    return std::string(blactl::name(name.error().code));
  }
  const std::string what = name->is(Behind::simulator)  ? "simulator"
                           : name->is(Behind::scenario) ? "scenario"
                                                        : std::string(name->scheme->name);
  return what + " " + name->rest;
}

Result<OpenBus> open(std::string_view text) {
  const Reporter reporter({});
  return open_bus({.text = text, .profiles = test::built_in(), .reporter = reporter});
}

} // namespace

TEST_CASE("what stands behind -i") {
  CHECK(kind("can0") == "socketcan can0");
  CHECK(kind("socketcan:can0") == "socketcan can0");
  CHECK(kind("slcan:/dev/ttyUSB0?open=plain") == "slcan /dev/ttyUSB0?open=plain");
  CHECK(kind("sim:") == "simulator ");
  CHECK(kind("sim:/run/x.sock") == "simulator /run/x.sock");
  CHECK(kind("sim:bench.json") == "scenario bench.json");
  CHECK(kind("sim:a:b.json") == "scenario a:b.json");
  CHECK(kind("replay:bus.log") == "replay bus.log");
  CHECK(kind("replay:-") == "replay -");
  CHECK(kind("replay:a:b.json") == "replay a:b.json");
  CHECK(kind("replay:") == "usage");
  CHECK(kind("file:fleet.json") == "file fleet.json");
  CHECK(kind("file:-") == "file -");
  CHECK(kind("file:") == "usage");
  CHECK(kind("foo:bar") == "usage");
  CHECK(kind(":") == "usage");
  CHECK(kind("CAN:can0") == "usage");
}

TEST_CASE("a multicast bus has a number from 0 to 255, and an interface if one is named") {
  CHECK(kind("mcast:") == "mcast ");
  CHECK(kind("mcast:0") == "mcast 0");
  CHECK(kind("mcast:255") == "mcast 255");
  CHECK(kind("mcast:7?if=lo") == "mcast 7?if=lo");
  CHECK(kind("mcast:?if=lo") == "mcast ?if=lo");
  CHECK(kind("mcast:1?if=br0.100") == "mcast 1?if=br0.100");
  const auto named = parse_mcast("7?if=lo");
  REQUIRE(named);
  CHECK(named->bus_number == 7);
  CHECK(named->link == "lo");
  for (const char* wrong : {"mcast:256", "mcast:-1", "mcast:+1", "mcast: 1", "mcast:1 ", "mcast:x",
                            "mcast:0x1", "mcast:1?", "mcast:1?if", "mcast:1?if=", "mcast:1?ttl=2",
                            "mcast:1&if=lo", "mcast:1:lo", "mcast:99999999999999999999"}) {
    CAPTURE(wrong);
    const auto name = parse_interface(wrong);
    REQUIRE_FALSE(name);
    CHECK(name.error().code == Code::usage);
    CHECK(name.error().message.find("mcast:N?if=IFACE") != std::string::npos);
    CHECK(name.error().hint.find("-i mcast:0?if=lo") != std::string::npos);
  }
}

TEST_CASE(
    "a kind without its colon is taken for what was meant, and each has an example that is one") {
  for (const Scheme& scheme : schemes) {
    CAPTURE(scheme.example);
    const auto example = parse_interface(scheme.example);
    REQUIRE(example);
    CHECK(example->scheme == &scheme);
    if (!scheme.name.starts_with("socketcan")) {
      const auto bare = parse_interface(scheme.name);
      REQUIRE_FALSE(bare);
      CHECK(bare.error().hint.find("-i " + std::string(scheme.name) + ":") != std::string::npos);
    }
    CHECK(parse_interface("nosuch:1").error().hint.find(scheme.example) != std::string::npos);
  }
}

TEST_CASE("what an adapter's options may be is known before it is opened") {
  CHECK(kind("slcan:") == "usage");
  CHECK(kind("slcan:/dev/ttyUSB0?open=maybe") == "usage");
}

TEST_CASE("an unknown kind of interface is refused with examples, harmless to a terminal") {
  const auto name = parse_interface("\x1b[2J:x");
  REQUIRE_FALSE(name);
  CHECK(name.error().message.find('\x1b') == std::string::npos);
  CHECK(name.error().hint.find("can0") != std::string::npos);
}

TEST_CASE("a scenario is a bus of this process alone") {
  const auto file = std::filesystem::temp_directory_path() /
                    ("blactl-bus-factory-" + std::to_string(getpid()) + ".json");
  std::ofstream(file) << R"({"schema": "blactl-scenario/1", "clock": "virtual"})";
  const std::string text = "sim:" + file.string();
  const auto bus = open(text);
  std::filesystem::remove(file);
  REQUIRE(bus);
  CHECK(bus->bus->name() == text);
  CHECK(bus->place.interface.empty());
}

TEST_CASE("processes that reach one simulator by different paths share their node IDs") {
  std::string name = (std::filesystem::temp_directory_path() / "blactl-test-XXXXXX").string();
  REQUIRE(mkdtemp(name.data()) != nullptr);
  const std::filesystem::path folder = name;
  const auto scenario = sim::default_scenario(test::built_in());
  REQUIRE(scenario);
  const auto server = sim::Server::open(folder / "sim", *scenario);
  REQUIRE(server);
  std::filesystem::create_directory_symlink(folder, folder / "link");
  const std::jthread service([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      pollfd readable{(*server)->descriptor(), POLLIN, 0};
      std::ignore = poll(&readable, 1, 10);
      (*server)->service();
    }
  });
  const auto direct = open("sim:" + (folder / "sim").string());
  const auto dots = open("sim:" + (folder / "." / "sim").string());
  const auto link = open("sim:" + (folder / "link" / "sim").string());
  REQUIRE(direct);
  REQUIRE(dots);
  REQUIRE(link);
  CHECK_FALSE(direct->place.interface.empty());
  CHECK(direct->place.interface == dots->place.interface);
  CHECK(direct->place.interface == link->place.interface);
  std::filesystem::remove_all(folder);
}

TEST_CASE("a log and a fleet file are interfaces to which nothing can be sent") {
  CHECK(takes_no_frames("replay:bus.log")->code == Code::usage);
  CHECK(takes_no_frames("file:fleet.json")->code == Code::usage);
  CHECK(open("file:/no/such/fleet.json").error().code == Code::bad_file);
  CHECK_FALSE(takes_no_frames("can0"));
  CHECK_FALSE(takes_no_frames("sim:"));
  CHECK_FALSE(takes_no_frames("foo:bar")); // another error, of parse_interface()
  CHECK(open("replay:/no/such/log").error().code == Code::interface);
}

TEST_CASE("a scenario that cannot be read is a bad file") {
  CHECK(open("sim:/no/such/scenario.json").error().code == Code::bad_file);
}

TEST_CASE("a socket nobody serves is an interface that is not there") {
  CHECK(open("sim:/no/such/socket").error().code == Code::interface);
}

TEST_CASE("a network interface that does not exist is an interface that is not there") {
  CHECK(open("mcast:0?if=nosuchnet0").error().code == Code::interface);
}

TEST_CASE("a CAN interface that does not exist is an interface that is not there") {
  CHECK(open("nosuchcan0").error().code == Code::interface);
  CHECK(open("socketcan:").error().code == Code::usage); // no name
}
