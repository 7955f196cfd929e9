// A servo as a node: what it sends, hears and answers; its IDs; how it comes back.

#include "blactl/sim/bus/simulator.hpp"
#include "blactl/sim/servo/world.hpp"

#include "unit/sim/servo_rig.hpp"

#include <cstdlib>

using namespace blactl;
using namespace blactl::sim;
using namespace blactl::sim::testing;
using namespace std::chrono_literals;
using bla::address::angle_limit_cw;
using bla::address::command_angle;

namespace {

/// A client that keeps all frames.
class Log final : public Medium::Listener {
 public:
  void heard(const can::Frame& frame, Time) override { frames.push_back(frame); }

  void sent(const can::Frame&, Time) override {}

  void bus_off(Time) override {}

  std::vector<can::Frame> frames;
};

std::string with(const char* members) {
  return std::string(bla21) + ", " + members;
}

std::vector<can::Frame> message(std::uint16_t type, std::uint64_t signature, std::uint8_t priority,
                                dronecan::Bytes payload) {
  return dronecan::segment({dronecan::Kind::message, priority, type, dronecan::NodeId(99), {}, 0},
                           0, signature, payload);
}

/// Of the first GetNodeInfo answer among frames; empty: there is none.
std::optional<dronecan::GetNodeInfo::Response> info_in(const std::vector<can::Frame>& frames) {
  std::optional<dronecan::GetNodeInfo::Response> info;
  dronecan::Receiver receiver(
      4, dronecan::NodeId(127),
      {[&](const dronecan::Transfer& transfer) {
         if (transfer.header.kind == dronecan::Kind::response && !info) {
           info = dronecan::GetNodeInfo::Response::decode(transfer.payload);
         }
       },
       {},
       [](dronecan::Kind kind, std::uint16_t type) -> std::optional<std::uint64_t> {
         const auto* known = dronecan::find_type(kind, type);
         return known != nullptr ? std::optional(known->signature) : std::nullopt;
       }});
  for (const can::Frame& frame : frames) {
    receiver.receive(frame, Time{});
  }
  return info;
}

} // namespace

TEST_CASE("requirement 2: a servo sends extended frames only, under any node ID",
          "[requirement-2]") {
  for (const unsigned id : {1U, 64U, 125U, 127U}) {
    Rig rig(fmt::format(R"("model": "BLA21-12U-AB", "node_id": {})", id));
    REQUIRE_FALSE(rig.heard.empty());
    for (const can::Frame& one : rig.heard) {
      CHECK(one.extended);
      CHECK((one.id & 0x7FU) == id);
    }
  }
}

TEST_CASE("requirement 2: a servo does not hear frames of standard format and remote frames",
          "[requirement-2]") {
  Rig rig(bla21);
  can::Frame request = frame("1E018BFF#C1");
  request.extended = false;
  CHECK(rig.bench.ask({request}).empty());
  request.id &= 0x7FFU;
  CHECK(rig.bench.ask({request}).empty());
  can::Frame remote = frame("1E018BFF#C1");
  remote.remote = true;
  CHECK(rig.bench.ask({remote}).empty());
  CHECK_FALSE(rig.bench.ask({frame("1E018BFF#C1")}).empty());
}

TEST_CASE("requirement 9: data type IDs and signatures are those of section 2.3",
          "[requirement-9]") {
  struct Row {
    dronecan::Kind kind;
    std::uint16_t id;
    std::uint64_t signature;
  };

  using enum dronecan::Kind;
  for (const Row& row :
       {Row{request, 1, 0xee468a8121c46a9e}, Row{message, 1, 0x0b2a812620a11d40},
        Row{request, 5, 0x569e05394a3017f0}, Row{request, 10, 0x3b131ac5eb69d2cd},
        Row{request, 11, 0xa7b622f939d1a4d5}, Row{message, 341, 0x0f0868d0c1a7c6f1},
        Row{message, 1010, 0xd8a7486238ec3af3}, Row{message, 1011, 0x5e9bba44faf1ea04}}) {
    INFO(row.id);
    const dronecan::DataType* type = dronecan::find_type(row.kind, row.id);
    REQUIRE(type != nullptr);
    CHECK(type->signature == row.signature);
  }
}

TEST_CASE("requirement 5: allocation requests have priority 24, and end with the node ID",
          "[requirement-5]") {
  Simulator simulator(scenario(R"("servos": [{"model": "BLA21-12U-AB"}],
      "foreign": [{"kind": "autopilot", "node_id": 10, "allocates": true}])"),
                      Time{});
  Log log;
  (void)simulator.attach(log, 10);
  simulator.advance_to(Time{} + 10s);
  REQUIRE(simulator.servos()[0]->node_id() == dronecan::NodeId(125));
  std::size_t requests = 0;
  for (const can::Frame& one : log.frames) {
    const auto header = dronecan::decode_id(one.id);
    if (header->source == dronecan::anonymous) {
      ++requests;
      CHECK(header->priority == 24);
    }
  }
  CHECK(requests >= 3);
  log.frames.clear();
  simulator.advance_to(Time{} + 20s);
  CHECK(only(log.frames, dronecan::Allocation::type.id).empty());
}

TEST_CASE("requirement 6: a running servo hears no messages but ArrayCommand", "[requirement-6]") {
  Rig rig(bla21);
  dronecan::Allocation allocation;
  allocation.node_id = 50;
  allocation.size = 16;
  allocation.unique_id = rig.servo.unique_id();
  rig.bench.deliver(message(dronecan::Allocation::type.id, dronecan::Allocation::type.signature, 24,
                            allocation.encode().bytes()));
  rig.bench.run(2s);
  CHECK(rig.servo.node_id() == dronecan::NodeId(11));

  dronecan::ArrayCommand array;
  array.commands.push_back({.actuator_id = 1, .command_type = 1, .value = 0.45F});
  const auto payload = array.encode();
  const std::int64_t before = rig.ram(command_angle);
  REQUIRE(before != 450);
  for (const std::uint16_t type :
       std::initializer_list<std::uint16_t>{0, 5, 341, 1000, 1009, 1011, 1030, 1100, 16383}) {
    INFO(type);
    rig.bench.deliver(message(type, dronecan::ArrayCommand::type.signature, 16, payload.bytes()));
    rig.bench.run(1ms);
    CHECK(rig.ram(command_angle) == before);
  }
  rig.bench.deliver(message(1010, dronecan::ArrayCommand::type.signature, 16, payload.bytes()));
  rig.bench.run(1ms);
  CHECK(rig.ram(command_angle) == 450);
}

TEST_CASE("requirements 7, 8: four services are served, no other is answered",
          "[requirement-7][requirement-8]") {
  Rig rig(bla21);
  for (unsigned service = 0; service <= 0xFF; ++service) {
    const auto id = static_cast<std::uint16_t>(service);
    if (id == 1 || id == 5 || id == 10 || id == 11) {
      continue;
    }
    INFO(service);
    const dronecan::Header header{dronecan::Kind::request, 30, id, dronecan::NodeId(127),
                                  dronecan::NodeId(11),    0};
    CHECK(rig.bench.ask(dronecan::segment(header, 0, 0, {})).empty());
    CHECK(rig.bench.ask(dronecan::segment(header, 1, 0, std::array<std::uint8_t, 7>{})).empty());
  }
  CHECK_FALSE(rig.bench.ask({frame("1E018BFF#C1")}).empty());
  CHECK(rig.read("0x50") == 61);
  CHECK(rig.restart_node(0) == "refused");
  CHECK(rig.opcode(dronecan::ExecuteOpcode::erase) == "ok");
}

TEST_CASE("requirement 10: values of several bytes begin with the least significant one",
          "[requirement-10]") {
  Rig rig(bla21);
  const auto answer = rig.get_set(0, {}, "0x34"); // 1520 = 0x05F0
  REQUIRE(answer.size() == 3);
  CHECK(answer[0].substr(13, 6) == "01F005"); // behind the transfer CRC: the tag, then the value
}

TEST_CASE("requirement 20: the unique ID of the allocation is that of GetNodeInfo, for good",
          "[requirement-20]") {
  Simulator simulator(scenario(R"("servos": [{"model": "BLA21-12U-AB",
      "unique_id": "00112233445566778899aabbccddeeff"}],
      "foreign": [{"kind": "autopilot", "node_id": 10, "allocates": true}])"),
                      Time{});
  Log log;
  const auto port = simulator.attach(log, 10);
  const auto ask = [&] {
    log.frames.clear();
    simulator.send(port, frame("1E01FDFF#C1"));
    simulator.advance_to(simulator.now() + 100ms);
    const auto info = info_in(log.frames);
    return info ? std::optional(info->unique_id) : std::nullopt;
  };
  simulator.advance_to(Time{} + 10s);
  std::string parts;
  for (const can::Frame& one : log.frames) {
    if (dronecan::decode_id(one.id)->source == dronecan::anonymous) {
      const std::string payload = text(one).substr(9);
      parts = payload.starts_with("01") ? "" : parts;
      parts += payload.substr(2, payload.size() - 4);
    }
  }
  CHECK(parts == "00112233445566778899AABBCCDDEEFF");
  const dronecan::UniqueId own = simulator.servos()[0]->unique_id();
  CHECK(own[1] == 0x11);
  CHECK(ask() == own);
  const auto restart =
      request(dronecan::RestartNode::type, dronecan::RestartNode::Request{}, 125, 1);
  simulator.send(port, restart.front());
  simulator.advance_to(simulator.now() + 10s);
  simulator.send(port, frame("1E01FDFF#C2"));
  log.frames.clear();
  simulator.advance_to(simulator.now() + 100ms);
  REQUIRE(info_in(log.frames));
  CHECK(info_in(log.frames)->unique_id == own);
}

TEST_CASE("requirement 47: every restart runs the soft start again", "[requirement-47]") {
  const auto turned = [](const char* soft_start) {
    Rig rig(with(fmt::format(R"("rom": {{"soft_start": "{}"}})", soft_start).c_str()));
    rig.bench.run(2s);
    World world = rig.servo.world();
    world.hand_decideg = 450;
    rig.servo.surround(world, rig.bench.now());
    rig.bench.run(500ms);
    CHECK(rig.restart_node() == "ok");
    rig.settle();
    world.hand_decideg.reset();
    rig.servo.surround(world, rig.bench.now());
    rig.bench.run(800ms); // before the communication timeout lets go of the shaft
    rig.servo.look(rig.bench.now());
    return std::abs(rig.ram(bla::address::current_angle) - 450);
  };
  CHECK(turned("on") > 400);
  CHECK(turned("off") < 20);
}

TEST_CASE("requirement 65: a ROM that cannot be read gives the defaults, and 0x1A.15",
          "[requirement-65]") {
  constexpr std::int64_t rom_unreadable = 1 << 15;
  Rig rig(with(R"("rom": {"angle_limit_cw": "90deg"})"));
  CHECK(rig.opcode(dronecan::ExecuteOpcode::save) == "ok");
  rig.bench.run(20ms); // in the middle of the write
  World world = rig.servo.world();
  world.plugged = false;
  rig.servo.surround(world, rig.bench.now());
  rig.bench.run(1s);
  world = rig.servo.world(); // with what it remembers of its start
  world.plugged = true;
  rig.servo.surround(world, rig.bench.now());
  rig.settle();
  rig.servo.look(rig.bench.now());
  CHECK(rig.ram(angle_limit_cw) == 1799); // table 3-8
  CHECK(rig.ram(bla::address::static_node_id) == 0);
  CHECK((rig.ram(bla::Address(0x1A)) & rom_unreadable) != 0);
}

TEST_CASE("requirement 176: servo IDs are 0 to 254, static node IDs 0 to 127",
          "[requirement-176]") {
  Rig rig(bla21);
  for (const std::int64_t id : {0, 1, 254}) {
    CHECK(rig.write("0x45", id) == id);
  }
  CHECK(rig.write("0x45", 255) == 254);
  CHECK(rig.write("0x45", -1) == 254);
  for (const std::int64_t id : {0, 1, 127}) {
    CHECK(rig.write("0x46", id) == id);
  }
  CHECK(rig.write("0x46", 128) == 127);
  CHECK(rig.write("0x46", -1) == 127);
}
