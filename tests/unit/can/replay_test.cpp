#include "blactl/can/loop.hpp"
#include "blactl/can/replay.hpp"

#include "catch.hpp"
#include "gzip.hpp"
#include "scratch_file.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;
using blactl::can::test::ScratchFile;

namespace {

constexpr std::string_view two_interfaces = "(1436509052.000000)  can0 00000001#11\n"
                                            "what is this\n"
                                            "(1436509052.500000) vcan0 20000040#0000000000000000\n"
                                            "(1436509053.000000) vcan0 123##4112233\n"
                                            "(1436509062.000001) vcan0 00000002#22\n";

std::unique_ptr<ReplayBus> open(const ScratchFile& file) {
  auto bus = ReplayBus::open(file.path(), "replay:x");
  REQUIRE(bus);
  return std::move(*bus);
}

} // namespace

TEST_CASE("a log gives its frames in their order at their times, then its end, once") {
  const ScratchFile file(two_interfaces);
  const auto bus = open(file);
  CHECK(bus->name() == "replay:x");
  CHECK(bus->is_replay());
  CHECK(bus->now() == Time{});
  const auto heard = bus->receive();
  const auto& received = std::get<Received>(heard.value());
  CHECK(received.frame.id == 1);
  CHECK(received.at == Time{});
  CHECK(received.wall == WallTime(1436509052s));
  const auto off = bus->receive();
  CHECK(std::get<BusFault>(off.value()).kind == FaultKind::bus_off);
  CHECK(std::get<BusFault>(off.value()).at == Time{500ms});
  const auto last = bus->receive();
  CHECK(std::get<Received>(last.value()).frame.id == 2);
  CHECK(std::get<Received>(last.value()).at == Time{10s + 1us});
  CHECK(bus->now() == Time{10s + 1us});
  CHECK(bus->wall() == WallTime(1436509062s + 1us));
  CHECK(std::holds_alternative<Ended>(bus->receive().value()));
  CHECK_FALSE(bus->receive());
  CHECK(bus->reader().bad_lines() == 1);
  CHECK(bus->reader().first_bad_line() == 2);
}

TEST_CASE("a loop plays ten seconds of a log without waiting for them") {
  const ScratchFile file(two_interfaces);
  Loop loop(open(file));
  std::vector<std::size_t> kinds;
  do {
    kinds.push_back(loop.next(never).index());
  } while (kinds.back() != Event(Ended{}).index());
  CHECK(kinds.size() == 4);
  CHECK(loop.now() == Time{10s + 1us});
}

TEST_CASE("a log takes no frames") {
  const ScratchFile file(two_interfaces);
  const auto bus = open(file);
  const auto sent = bus->send({.id = 1});
  REQUIRE_FALSE(sent);
  CHECK(sent.error().code == Code::usage);
  CHECK(bus->filter(std::vector<Filter>{{1, 1}}));
}

TEST_CASE("a file without a frame is no log") {
  for (const auto* text : {"", "hello\nworld\n", "{\"schema\": 1}", "(1.0) can0 123##4112233\n"}) {
    const ScratchFile file(text);
    const auto bus = open(file);
    const auto event = bus->receive();
    const auto& gone = std::get<Gone>(event.value());
    CHECK(gone.error.code == Code::bad_file);
    CHECK(gone.error.message.find(file.path()) != std::string::npos);
    CHECK_FALSE(bus->receive());
  }
}

TEST_CASE("a log that cannot be opened is an interface that cannot be opened") {
  const auto bus = ReplayBus::open("/nonexistent/log", "replay:/nonexistent/log");
  REQUIRE_FALSE(bus);
  CHECK(bus.error().code == Code::interface);
}

TEST_CASE("a packed log that is cut off gives its frames, and then a bad file") {
  const std::string packed = blactl::test::gzipped(two_interfaces);
  const ScratchFile file(packed.substr(0, packed.size() - 8)); // all but checksum and size
  const auto bus = open(file);
  std::vector<std::size_t> kinds;
  std::optional<BusEvent> event;
  while ((event = bus->receive()) && !std::holds_alternative<Gone>(*event)) {
    kinds.push_back(event->index());
  }
  CHECK(kinds.size() == 3);
  REQUIRE(event);
  const Error& error = std::get<Gone>(*event).error;
  CHECK(error.code == Code::bad_file);
  CHECK(error.message.find(file.path()) != std::string::npos);
}

TEST_CASE("a loop passes over what is no frame, however much of it there is") {
  std::string text;
  for (int i = 0; i < 20'000; ++i) {
    text += "(1436509053.000000) vcan0 123##4112233\n";
  }
  const ScratchFile file(text + std::string(two_interfaces));
  Loop loop(open(file));
  CHECK(std::holds_alternative<Received>(loop.next(never)));
}
