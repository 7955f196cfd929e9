#include "blactl/can/loop.hpp"
#include "blactl/sim/bus/private_bus.hpp"

#include "unit/sim/support.hpp"

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using testing::frame;
using testing::scenario;

namespace {

constexpr const char* one_servo =
    R"("clock": "virtual", "servos": [{"model": "BLA21-12U-AB", "node_id": 11}])";

std::unique_ptr<can::Bus> bus(std::string_view members) {
  return std::make_unique<PrivateBus>("sim:", scenario(members));
}

/// What happens until `deadline`, frames as text.
std::vector<std::string> listen(can::Loop& loop, Duration duration) {
  const Time deadline = loop.now() + duration;
  std::vector<std::string> heard;
  for (;;) {
    const can::Event event = loop.next(deadline);
    if (const auto* received = std::get_if<can::Received>(&event)) {
      heard.push_back(testing::text(received->frame));
    } else if (const auto* sent = std::get_if<can::Sent>(&event)) {
      heard.push_back("sent " + testing::text(sent->frame));
    } else {
      REQUIRE(std::holds_alternative<can::DeadlineReached>(event));
      return heard;
    }
  }
}

} // namespace

TEST_CASE("an hour of virtual time passes at once, and the loop hears every frame of it") {
  can::Loop loop(bus(one_servo));
  const auto began = std::chrono::steady_clock::now();
  std::size_t frames = 0;
  const Time end = loop.now() + 1h;
  for (;;) {
    const can::Event event = loop.next(end);
    if (std::holds_alternative<can::DeadlineReached>(event)) {
      break;
    }
    ++frames;
  }
  CHECK(loop.now() == end);
  CHECK(frames > 3590U * 21);
  CHECK(frames < 3600U * 21 + 22);
  CHECK(std::chrono::steady_clock::now() - began < 60s);
}

TEST_CASE("a request through the loop comes back as an echo and as an answer") {
  can::Loop loop(bus(one_servo));
  (void)listen(loop, 250ms);
  loop.send(frame("1E0B8BFF#000030783338C5"));
  const auto heard = listen(loop, 3ms);
  REQUIRE(heard.size() >= 4);
  CHECK(heard[0] == "sent 1E0B8BFF#000030783338C5");
  CHECK(std::ranges::count_if(
            heard, [](const std::string& line) { return line.starts_with("1E0B7F8B#"); }) == 3);
  CHECK(loop.unsent() == 0);
}

TEST_CASE("what the servos of a private bus hold can be looked at") {
  auto owned = std::make_unique<PrivateBus>("sim:", scenario(one_servo));
  const Simulator& simulator = owned->simulator();
  can::Loop loop(std::move(owned));
  (void)listen(loop, 250ms);
  REQUIRE(simulator.servos().size() == 1);
  const Servo& servo = *simulator.servos()[0];
  loop.send(frame("1E0A8BFF#00000000000000C1"));
  (void)listen(loop, 40ms);
  CHECK(servo.rom_writes() == 0);
  (void)listen(loop, 20ms);
  CHECK(servo.rom_writes() == 1);
  CHECK(servo.registers().rom_value(bla::address::static_node_id) == 11);
}

TEST_CASE("two private buses of one scenario bring the same") {
  can::Loop first(bus(one_servo));
  can::Loop second(bus(one_servo));
  CHECK(listen(first, 2s) == listen(second, 2s));
}

TEST_CASE("alone on the bus a frame waits, and the loop says since when") {
  can::Loop loop(bus(R"("clock": "virtual", "servos": [])"));
  (void)listen(loop, 100ms);
  const Time asked = loop.now();
  loop.send(frame("1E018BFF#C1"));
  CHECK(listen(loop, 500ms).empty());
  CHECK(loop.unsent() == 1);
  CHECK(loop.unacknowledged_since() == asked);
}

TEST_CASE("a filter keeps frames out, time passes all the same") {
  can::Loop loop(bus(one_servo));
  const can::Filter node_status{341U << 8U, 0xFFFF00U | 0x80U};
  REQUIRE(loop.bus().filter({&node_status, 1}));
  const auto heard = listen(loop, 5s);
  CHECK(heard.size() == 5);
  const can::Filter nothing{0, can::extended_id_mask};
  REQUIRE(loop.bus().filter({&nothing, 1}));
  CHECK(listen(loop, 60s).empty());
}

TEST_CASE("virtual wall time starts where records can be compared") {
  can::Loop loop(bus(one_servo));
  CHECK(loop.now() == Time{});
  CHECK(loop.wall() == virtual_epoch);
  (void)listen(loop, 90s);
  CHECK(loop.wall() == virtual_epoch + 90s);
}

TEST_CASE("a frame carries the times of its end") {
  can::Loop loop(bus(one_servo));
  const can::Event event = loop.next(Time{} + 1s);
  const auto* received = std::get_if<can::Received>(&event);
  REQUIRE(received != nullptr);
  CHECK(received->at == loop.now());
  CHECK(received->wall == virtual_epoch + received->at.time_since_epoch());
}

TEST_CASE("on the real clock frames come when they are due") {
  can::Loop loop(bus(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])"));
  const Time began = loop.now();
  const auto heard = listen(loop, 400ms);
  CHECK(loop.now() - began >= 400ms);
  CHECK(loop.now() - began < 2s);
  CHECK(heard.size() >= 4);
  CHECK(heard.size() <= 10);
}

TEST_CASE("ten frames wait, the next is not taken") {
  PrivateBus lonely("sim:", scenario(R"("clock": "virtual", "servos": [])"));
  for (int i = 0; i < 10; ++i) {
    CHECK(*lonely.send(frame("1E018BFF#C1")));
  }
  CHECK_FALSE(*lonely.send(frame("1E018BFF#C1")));
}
