#include "blactl/can/loop.hpp"
#include "blactl/can/recorder.hpp"

#include "catch.hpp"
#include "fake_bus.hpp"
#include "scratch_file.hpp"

#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;
using blactl::can::test::FakeBus;
using blactl::can::test::ScratchFile;
using blactl::can::test::Wire;

namespace {

const Frame heard{.id = 0x1401552A, .size = 2, .data = {0x11, 0x22}};
const Frame ours{.id = 0x1E018AFF, .size = 1, .data = {0xC0}};

std::unique_ptr<Recorder> open(Wire& wire, const ScratchFile& file) {
  auto recorder = Recorder::open(std::make_unique<FakeBus>(wire), file.path());
  REQUIRE(recorder);
  return std::move(*recorder);
}

/// Files of this process cannot grow beyond a size for a while: as if the disk were full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t size) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{size, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &now);
    std::signal(SIGXFSZ, SIG_IGN); // NOLINT(cert-err33-c): nothing to restore
  }

  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

} // namespace

TEST_CASE("a recorded bus is as open and as readable as the bus itself") {
  const ScratchFile file;
  Wire wire;
  wire.open = false;
  wire.unreadable = 3;
  const auto recorder = open(wire, file);
  CHECK_FALSE(recorder->is_open());
  CHECK(recorder->send_again_at(recorder->now()) == never);
  CHECK(recorder->unreadable() == 3);
  wire.open = true;
  CHECK(recorder->is_open());
  CHECK(recorder->send_again_at(recorder->now()) == recorder->now() + 1ms);
}

TEST_CASE("a recorder writes what is heard and what is echoed, each line at once") {
  const ScratchFile file("what was there before");
  Wire wire;
  const auto recorder = open(wire, file);
  CHECK(file.text().empty());
  wire.happen(Received{heard, wire.now, WallTime(1436509052s + 1us)});
  CHECK(recorder->receive());
  CHECK(file.text() == "(1436509052.000001) fake 1401552A#1122\n");
  wire.echo = Wire::Echo::by_hand;
  CHECK(recorder->send(ours).value());
  CHECK(std::ranges::count(file.text(), '\n') == 1); // nobody has acknowledged it yet
  wire.happen(Sent{ours, wire.now, WallTime(1436509053s)});
  CHECK(recorder->receive());
  CHECK(file.text().ends_with("\n(1436509053.000000) fake 1E018AFF#C0\n"));
  wire.happen(BusFault{FaultKind::error_passive, wire.now});
  CHECK(recorder->receive());
  CHECK(std::ranges::count(file.text(), '\n') == 2);
  CHECK_FALSE(recorder->error());
}

TEST_CASE("on a bus without echoes a frame is written when it was taken") {
  const ScratchFile file;
  Wire wire;
  wire.echo = Wire::Echo::absent;
  wire.full = 1;
  const auto recorder = open(wire, file);
  CHECK_FALSE(recorder->send(ours).value());
  CHECK(file.text().empty());
  CHECK(recorder->send(ours).value());
  CHECK(file.text() == "(0000001000.000000) fake 1E018AFF#C0\n");
}

TEST_CASE("a recorder writes down everything, and passes on what the filters want") {
  const ScratchFile file;
  Wire wire;
  const auto recorder = open(wire, file);
  CHECK(recorder->filter(std::vector<Filter>{{heard.id, 0x1FFFFFFF}}));
  CHECK(wire.filters.empty());
  Frame other = heard;
  other.id ^= 1U;
  for (const Frame& frame : {other, other, heard, other}) {
    wire.happen(Received{frame, wire.now, WallTime(1436509052s)});
  }
  const auto passed = recorder->receive();
  REQUIRE(passed);
  CHECK(std::get<Received>(*passed).frame == heard);
  CHECK_FALSE(recorder->receive());
  CHECK(std::ranges::count(file.text(), '\n') == 4);
}

TEST_CASE("a recorder is the bus otherwise") {
  const ScratchFile file;
  Wire wire;
  const auto recorder = open(wire, file);
  CHECK(recorder->name() == "fake");
  CHECK(recorder->echoes());
  CHECK(recorder->descriptor() == -1);
  CHECK_FALSE(recorder->is_replay());
  CHECK_FALSE(recorder->wants_to_write());
  CHECK(recorder->now() == wire.now);
  CHECK(recorder->wall() == WallTime(wire.now.time_since_epoch()));
  const Time deadline = wire.now + 1s;
  CHECK(recorder->idle_until(deadline) == deadline);
}

TEST_CASE("a full disk ends the recording with complete lines, and not the bus") {
  const ScratchFile file;
  Wire wire;
  const auto recorder = open(wire, file);
  const auto hear = [&] {
    wire.happen(Received{heard, wire.now, WallTime(1436509052s)});
    return recorder->receive().has_value();
  };
  CHECK(hear());
  const std::string line = file.text();
  {
    const FullDisk full(line.size() + 10); // a part of a line has room
    CHECK(hear());
  }
  REQUIRE(recorder->error());
  CHECK(recorder->error()->code == Code::io);
  CHECK(recorder->error()->message.find(file.path()) != std::string::npos);
  CHECK(file.text() == line);
  CHECK(hear()); // there is room again, but a log with a gap would lie
  CHECK(file.text() == line);
}

TEST_CASE("a device that is full is told, too") {
  Wire wire;
  auto recorder = Recorder::open(std::make_unique<FakeBus>(wire), "/dev/full");
  REQUIRE(recorder);
  wire.hear(heard);
  CHECK((*recorder)->receive());
  CHECK((*recorder)->error()->code == Code::io);
}

TEST_CASE("a file that cannot be made is refused") {
  Wire wire;
  const auto recorder = Recorder::open(std::make_unique<FakeBus>(wire), "/nonexistent/x.log");
  REQUIRE_FALSE(recorder);
  CHECK(recorder.error().code == Code::io);
  CHECK(recorder.error().hint.find("--record") != std::string::npos);
}

TEST_CASE("a log knows its interface by a name that canplayer can map") {
  CHECK(log_interface("vcan0") == "vcan0");
  CHECK(log_interface("sim:") == "sim");
  CHECK(log_interface("sim:/tmp/scene.json") == "scene.json");
  CHECK(log_interface("sim:bench.json") == "sim-bench.json");
  CHECK(log_interface("slcan:/dev/ttyUSB0") == "ttyUSB0");
  CHECK(log_interface("slcan:/dev/ttyUSB0?baud=1000000&open=plain") == "ttyUSB0");
  CHECK(log_interface("mcast:0") == "mcast-0");
  CHECK(log_interface("mcast:0?if=lo") == "mcast-0");
  CHECK(log_interface("replay:-") == "replay");
  CHECK(log_interface("/dev/serial/by-id/usb-Futaba_Adapter_0001") == "usb-Futaba_Adap");
  CHECK(log_interface("a b\tc\xE3\x82\xB5") == "a-b-c");
  CHECK(log_interface("") == "can");
  CHECK(log_interface("://") == "can");
}
