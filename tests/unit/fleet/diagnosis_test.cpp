#include "blactl/fleet/doctor/diagnosis.hpp"

#include "support.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using bla::Level;
using can::FaultKind;
using dronecan::ArrayCommand;
using dronecan::NodeStatus;

namespace {

can::Link good_link() {
  return {.name = "can0",
          .kind = "can",
          .is_up = true,
          .queue_length = 10,
          .bit_rate = 1000000,
          .sample_point = 875,
          .restart_after = 100ms,
          .state = can::LinkState::error_active,
          .errors = can::ErrorCounters{0, 0}};
}

std::vector<std::string> codes(const Diagnoses& found) {
  std::vector<std::string> all;
  for (const Diagnosis& diagnosis : found) {
    all.push_back(diagnosis.code);
    CHECK_FALSE(diagnosis.text.empty());
    CHECK_FALSE(diagnosis.fix.empty());
  }
  return all;
}

using Codes = std::vector<std::string>;

/// A roster and what it was told, a frame at a time.
struct Bus {
  void hear(std::uint8_t id, NodeStatus status = {}) {
    const auto number = static_cast<dronecan::TransferId>(statuses[id]++ % 32U);
    for (const can::Frame& frame : message(NodeStatus::type, id, status.encode(), number)) {
      roster.hear(frame, now);
      traffic.hear(frame, now);
    }
    const auto payload = status.encode();
    receive(NodeStatus::type.id, id, payload);
  }

  void receive(std::uint16_t type, std::uint8_t id, const dronecan::Payload& payload) {
    roster.receive(
        {.header = {.kind = dronecan::Kind::message, .data_type_id = type, .source = NodeId(id)},
         .payload = payload.bytes(),
         .at = now});
  }

  /// Heard for 3 s.
  void servo(std::uint8_t id, std::int64_t servo_id, std::int64_t static_node_id) {
    const Time begin = now;
    for (std::uint32_t second = 0; second <= 3; ++second) {
      now = begin + std::chrono::seconds(second);
      hear(id, {.uptime_s = 100 + second});
    }
    now = begin;
    Servo servo = bla21(id);
    servo.identity = bla::Identity(profiles(), {61, 240900500 + id, 1400, 12050});
    servo.servo_id = servo_id;
    servo.static_node_id = static_node_id;
    roster.learn(servo, GetNodeInfo::Response{.unique_id = {id}});
  }

  void command(std::uint8_t source, std::uint8_t servo_id, std::uint8_t type) {
    ArrayCommand command;
    command.commands.push_back({.actuator_id = servo_id, .command_type = type, .value = 0.5F});
    receive(ArrayCommand::type.id, source, command.encode());
  }

  [[nodiscard]] Diagnoses diagnoses(std::span<const Snapshot> limits = {}) const {
    const Findings findings = gather(roster, Targets{}, profiles(), now + 3s);
    return diagnose_nodes(findings, traffic, limits, MotionLook::commanded);
  }

  Roster roster{NodeId(127), profiles()};
  Traffic traffic;
  Time now{1000s};
  std::map<std::uint8_t, unsigned> statuses; ///< sent by each node
};

} // namespace

TEST_CASE("a controller as Futaba asks for it has no finding, and each defect has its own") {
  CHECK(diagnose_link(good_link()).empty());
  const auto with = [](auto change) {
    can::Link link = good_link();
    change(link);
    return codes(diagnose_link(link));
  };
  CHECK(with([](can::Link& link) { link.is_up = false; }) == Codes{"interface_down"});
  CHECK(with([](can::Link& link) { link.bit_rate = 500000; }) == Codes{"bit_rate"});
  CHECK(with([](can::Link& link) { link.sample_point = 750; }) == Codes{"sample_point"});
  CHECK(with([](can::Link& link) { link.sample_point = 866; }).empty());
  CHECK(with([](can::Link& link) { link.restart_after = 0ms; }) == Codes{"no_restart"});
  CHECK(with([](can::Link& link) { link.queue_length = 3; }) == Codes{"short_queue"});
  CHECK(with([](can::Link& link) { link.state = can::LinkState::bus_off; }) == Codes{"bus_off"});
  CHECK(with([](can::Link& link) { link.state = can::LinkState::error_passive; }) ==
        Codes{"error_passive"});
  CHECK(with([](can::Link& link) { link.state = can::LinkState::error_warning; }) ==
        Codes{"error_warning"});
}

TEST_CASE("a virtual interface lacks nothing") {
  CHECK(diagnose_link({.name = "vcan0", .kind = "vcan", .is_up = true, .queue_length = 1000})
            .empty());
}

TEST_CASE("what mends the bit timing is the command with the right one") {
  can::Link link = good_link();
  link.bit_rate = 250000;
  CHECK(diagnose_link(link).front().fix ==
        "sudo ip link set can0 down; sudo ip link set can0 up type can bitrate 1000000 "
        "sample-point 0.875");
  CHECK(diagnose_link(link).front().level == Level::failure);
}

TEST_CASE("an interface is mended by what it needs, and no more") {
  const auto needs = [](auto change) {
    can::Link link = good_link();
    change(link);
    return can::command(mending(link));
  };
  CHECK(mending(good_link()).is_empty());
  const std::string down = "sudo ip link set can0 down; sudo ip link set can0 up";
  const std::string timing = " type can bitrate 1000000 sample-point 0.875";
  CHECK(needs([](can::Link& link) { link.bit_rate = 500000; }) == down + timing);
  CHECK(needs([](can::Link& link) { link.sample_point = 750; }) == down + timing);
  CHECK(needs([](can::Link& link) { link.restart_after = 0ms; }) ==
        down + " type can restart-ms 100");
  CHECK(needs([](can::Link& link) { link.state = can::LinkState::bus_off; }) == down);
  CHECK(needs([](can::Link& link) { link.queue_length = 3; }) ==
        "sudo ip link set can0 txqueuelen 100");
  CHECK(needs([](can::Link& link) { link.is_up = false; }) == "sudo ip link set can0 up");
  CHECK(needs([](can::Link& link) {
          link.is_up = false;
          link.bit_rate.reset();
        }) == "sudo ip link set can0 up" + timing);
  CHECK(can::command(mending({.name = "vcan0", .kind = "vcan", .queue_length = 1000})) ==
        "sudo ip link set vcan0 up");
  // Nothing mends a cable.
  CHECK(needs([](can::Link& link) { link.state = can::LinkState::error_passive; }) ==
        "sudo ip link set can0");
}

TEST_CASE("the status of an adapter is told by what it means, and foreign speech by its name") {
  CHECK(diagnose_adapter({.status = std::uint8_t{0x40}}, can::ForeignSpeech::none).empty());
  CHECK(codes(diagnose_adapter({.status = std::uint8_t{0xAF}}, can::ForeignSpeech::none)) ==
        Codes{"error_passive", "error_warning", "error_frames", "receive_overflow",
              "transmit_timeout"});
  CHECK(codes(diagnose_adapter({}, can::ForeignSpeech::mavlink)) == Codes{"mavlink"});
  CHECK(codes(diagnose_adapter({}, can::ForeignSpeech::text)) == Codes{"no_slcan"});
}

TEST_CASE("traffic counts bits by sender, and load by time") {
  Traffic traffic;
  CHECK_FALSE(traffic.load_permille());
  const auto frames = message(NodeStatus::type, 11, NodeStatus{}.encode());
  for (int i = 0; i <= 1000; ++i) { // some 120 us of every millisecond
    traffic.hear(frames.front(), Time(i * 1ms));
  }
  CHECK(traffic.frames() == 1001);
  CHECK(traffic.duration() == Duration(1s));
  REQUIRE(traffic.load_permille());
  CHECK(*traffic.load_permille() > 90);
  CHECK(*traffic.load_permille() < 160);
  CHECK(traffic.senders().at(NodeId(11)).statuses == 1001);
  CHECK(diagnose_traffic(traffic, std::nullopt).empty());
}

TEST_CASE("stamps that run backwards tell no duration, whatever the order of a few frames") {
  const auto frame = message(NodeStatus::type, 11, NodeStatus{}.encode()).front();
  Traffic traffic;
  traffic.hear(frame, Time(3s));
  traffic.hear(frame, Time(5s));
  for (const auto at : {3s, 5s, 4s}) {
    traffic.stamp(WallTime(at));
  }
  CHECK(traffic.duration() == Duration(2s));
  CHECK(diagnose_traffic(traffic, std::nullopt).empty());
  traffic.stamp(WallTime(3s));
  CHECK_FALSE(traffic.load_permille());
  CHECK(codes(diagnose_traffic(traffic, std::nullopt)) == Codes{"time_backwards"});
}

TEST_CASE("a silent bus, foreign frames, a full bus and error frames are told apart") {
  CHECK(codes(diagnose_traffic({}, std::nullopt)) == Codes{"silent"});
  Traffic alone;
  alone.hear_own(message(NodeStatus::type, 127, NodeStatus{}.encode()).front(), Time(1s));
  CHECK(codes(diagnose_traffic(alone, std::nullopt)) == Codes{"silent"});
  const Error reason{Code::not_found, "this port carries MAVLink", "another port", std::nullopt};
  CHECK(diagnose_traffic({}, reason).front().text == "this port carries MAVLink");
  Traffic foreign;
  foreign.hear({.id = 0x123, .extended = false, .size = 2}, Time(1s));
  CHECK(codes(diagnose_traffic(foreign, std::nullopt)) == Codes{"standard_frames"});
  Traffic full;
  const auto frames = message(NodeStatus::type, 11, NodeStatus{}.encode());
  for (int i = 0; i < 100; ++i) {
    full.hear(frames.front(), Time(i * 120us));
  }
  CHECK(codes(diagnose_traffic(full, std::nullopt)) == Codes{"bus_load"});
  const std::vector<std::pair<FaultKind, std::string>> kinds{
      {FaultKind::bus_off, "bus_off"},
      {FaultKind::error_passive, "error_passive"},
      {FaultKind::error_warning, "error_warning"},
      {FaultKind::no_acknowledge, "no_acknowledge"},
      {FaultKind::transmit_timeout, "transmit_timeout"},
      {FaultKind::receive_overflow, "receive_overflow"},
      {FaultKind::protocol, "error_frames"}};
  for (const auto& [kind, code] : kinds) {
    Traffic traffic;
    traffic.hear(frames.front(), Time(1s));
    traffic.hear(can::BusFault{kind, Time(1s)});
    CHECK(codes(diagnose_traffic(traffic, std::nullopt)) == Codes{code});
  }
  Traffic recovered;
  recovered.hear(frames.front(), Time(1s));
  recovered.hear(can::BusFault{FaultKind::error_active, Time(1s)});
  CHECK(diagnose_traffic(recovered, std::nullopt).empty());
}

TEST_CASE("servos as they should be have no finding") {
  Bus bus;
  bus.servo(11, 1, 11);
  bus.servo(12, 2, 0);
  CHECK(bus.diagnoses().empty());
}

TEST_CASE("each thing that is wrong with a node is named") {
  Bus bus;
  SECTION("its health") {
    bus.servo(11, 1, 11);
    bus.now += 3s;
    bus.hear(11, {.uptime_s = 103, .health = dronecan::Health::warning});
    bus.now -= 3s;
    CHECK(codes(bus.diagnoses()) == Codes{"health"});
    CHECK(bus.diagnoses().front().fix == "see why: blactl faults -n 11");
  }
  SECTION("another ID after a restart") {
    bus.servo(11, 1, 14);
    CHECK(codes(bus.diagnoses()) == Codes{"static_node_id"});
  }
  SECTION("a restart while it was watched") {
    bus.servo(11, 1, 11);
    bus.now += 3s;
    bus.hear(11, {.uptime_s = 0});
    bus.now -= 3s;
    CHECK(codes(bus.diagnoses()) == Codes{"restarted"});
  }
  SECTION("a mode in which it does nothing") {
    bus.servo(11, 1, 11);
    for (const auto mode : {dronecan::Mode::initialization, dronecan::Mode::maintenance,
                            dronecan::Mode::software_update, dronecan::Mode::offline}) {
      bus.now += 3s;
      bus.hear(11, {.uptime_s = 103, .mode = mode});
      bus.now -= 3s;
      CHECK(codes(bus.diagnoses()) == Codes{"mode"});
    }
  }
  SECTION("a servo that has gone silent, but no tool, which comes and goes") {
    bus.servo(11, 1, 11);
    bus.hear(126);
    bus.now += 3s;
    CHECK(codes(bus.diagnoses()) == Codes{"offline"});
    CHECK(bus.diagnoses().front().node == NodeId(11));
  }
  SECTION("answers that never came, where others did") {
    bus.servo(11, 1, 11);
    bus.servo(12, 2, 12);
    for (int i = 0; i < 40; ++i) {
      bus.traffic.ask(NodeId(11));
      bus.traffic.ask(NodeId(12));
    }
    CHECK(bus.diagnoses().empty());
    bus.traffic.miss_answer(NodeId(12));
    bus.traffic.ask(NodeId(30)); // no servo: it need not answer
    bus.traffic.miss_answer(NodeId(30));
    CHECK(codes(bus.diagnoses()) == Codes{"lost_answers"});
    CHECK(bus.diagnoses().front().text.starts_with("1 of 80 requests to nodes 12 "));
  }
  SECTION("a serial number that two have") {
    bus.servo(11, 1, 11);
    bus.servo(12, 2, 12);
    for (const std::uint8_t id : {std::uint8_t{11}, std::uint8_t{12}}) {
      Servo servo = bus.roster.member(NodeId(id)).servo();
      servo.identity = bla::Identity(profiles(), {61, 240900558, 1400, 12050});
      bus.roster.learn(servo, GetNodeInfo::Response{.unique_id = {id}});
    }
    CHECK(codes(bus.diagnoses()) == Codes{"duplicate_serial_number"});
  }
  SECTION("one servo ID for two") {
    bus.servo(11, 1, 11);
    bus.servo(12, 1, 12);
    CHECK(codes(bus.diagnoses()) == Codes{"duplicate_servo_id"});
  }
}

TEST_CASE("a node without NodeStatus is told after 2.5 s, not before") {
  Bus bus;
  for (int i = 0; i <= 3; ++i) {
    const auto frames = message(ArrayCommand::type, 30, ArrayCommand{}.encode());
    bus.roster.hear(frames.front(), bus.now);
    bus.traffic.hear(frames.front(), bus.now);
    bus.now += 1s;
  }
  bus.now -= 3s; // until now it was heard
  CHECK(codes(bus.diagnoses()) == Codes{"no_node_status"});
}

TEST_CASE("commands to nobody, and of a type that BLA servos do not take") {
  Bus bus;
  bus.servo(11, 1, 11);
  bus.command(10, 1, 0);
  CHECK(codes(bus.diagnoses()) == Codes{"commander"});
  CHECK(bus.diagnoses().front().level == Level::notice);
  bus.command(10, 2, 0);
  CHECK(codes(bus.diagnoses()) == Codes{"commander", "no_such_servo"});
  bus.command(10, 2, 4);
  CHECK(codes(bus.diagnoses()) == Codes{"commander", "no_such_servo", "pwm_command"});
}

TEST_CASE("limits narrower than what UNITLESS reaches are a notice, where it is commanded") {
  Bus bus;
  bus.servo(11, 1, 11);
  const auto limits = [&](std::int64_t cw, std::int64_t ccw) {
    Servo servo = bla21(11);
    servo.servo_id = 1;
    return std::vector<Snapshot>{
        {.servo = servo,
         .readings = {{&parameter("angle_limit_cw"), cw}, {&parameter("angle_limit_ccw"), ccw}}}};
  };
  CHECK(bus.diagnoses(limits(900, -900)).empty()); // nobody commands
  bus.command(10, 1, 0);
  CHECK(codes(bus.diagnoses(limits(900, -900))) == Codes{"commander", "unitless_range"});
  CHECK(codes(bus.diagnoses(limits(1799, -1800))) == Codes{"commander"});
  bus.command(10, 1, 1);
  CHECK(codes(bus.diagnoses(limits(900, -900))) == Codes{"commander"});
}
