#include "blactl/sim/bus/simulator.hpp"

#include "unit/sim/support.hpp"

#include <map>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using testing::scenario;

namespace {

/// Hears everything.
struct Log final : Medium::Listener {
  void heard(const can::Frame& frame, Time at) override {
    lines.push_back(fmt::format("{:06} {}", at.time_since_epoch().count(), testing::text(frame)));
    frames.push_back(frame);
  }

  void sent(const can::Frame& frame, Time at) override {
    lines.push_back(
        fmt::format("{:06} sent {}", at.time_since_epoch().count(), testing::text(frame)));
  }

  void bus_off(Time) override {}

  std::vector<std::string> lines;
  std::vector<can::Frame> frames;
};

std::vector<std::string> run(const Scenario& what, Duration duration) {
  Simulator simulator(what, Time{});
  Log log;
  (void)simulator.attach(log, 10);
  simulator.advance_to(Time{} + duration);
  return log.lines;
}

constexpr std::string_view mixed = R"("seed": {}, "servos": [
    {{"model": "BLA21-12U-AB", "node_id": 11}}, {{"model": "BLA15-06U-A0"}},
    {{"model": "BLA34-28U-AB"}}, {{"model": "BLA21-06U-A0", "node_id": 12}}])";

/// Frames of one data type, by source.
std::map<int, int> count(const std::vector<can::Frame>& frames, std::uint16_t type) {
  std::map<int, int> counts;
  for (const can::Frame& frame : frames) {
    const auto header = dronecan::decode_id(frame.id);
    if (header && header->kind == dronecan::Kind::message && header->data_type_id == type) {
      ++counts[header->source.value()];
    }
  }
  return counts;
}

} // namespace

TEST_CASE("the same seed gives the same frames to the microsecond, another one others") {
  const auto first = run(scenario(fmt::format(mixed, 3)), 10s);
  CHECK(first.size() > 400);
  CHECK(first == run(scenario(fmt::format(mixed, 3)), 10s));
  CHECK(first != run(scenario(fmt::format(mixed, 4)), 10s));
}

TEST_CASE("the same seed gives the same faults of the wire and of what devices send") {
  constexpr std::string_view faulty = R"("seed": {}, "wire": {{"loss": 0.02, "duplication": 0.02,
      "errors": 0.02, "bit_flips": 0.02, "burst_interval": "1s", "burst_length": "2ms"}},
      "servos": [{{"model": "BLA21-12U-AB", "node_id": 11, "sending": {{"jitter": "3ms"}}}},
                 {{"model": "BLA15-06U-A0"}}, {{"model": "BLA34-28U-AB"}}])";
  const auto first = run(scenario(fmt::format(faulty, 3)), 10s);
  CHECK(first.size() > 200);
  CHECK(first == run(scenario(fmt::format(faulty, 3)), 10s));
  CHECK(first != run(scenario(fmt::format(faulty, 4)), 10s));
}

TEST_CASE("ten minutes of everything that can go wrong are the same to the microsecond") {
  /// Counts and mixes what it hears, with the times.
  struct Digest final : Medium::Listener {
    void mix(std::uint64_t word) { value = (value ^ word) * 0x100000001B3; }

    void heard(const can::Frame& frame, Time at) override {
      ++count;
      mix(static_cast<std::uint64_t>(at.time_since_epoch().count()));
      mix(frame.id);
      for (const std::uint8_t byte : frame.payload()) {
        mix(byte);
      }
    }

    void sent(const can::Frame& frame, Time at) override { heard(frame, at); }

    void bus_off(Time at) override {
      mix(static_cast<std::uint64_t>(at.time_since_epoch().count()));
    }

    std::uint64_t value = 0xCBF29CE484222325;
    std::size_t count = 0;
  };

  const auto run = [](int seed) {
    Simulator simulator(
        scenario(fmt::format(R"("seed": {}, "wire": {{"loss": 0.01, "duplication": 0.01,
      "errors": 0.01, "bit_flips": 0.01, "burst_interval": "5s", "burst_length": "5ms"}},
      "servos": [
        {{"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1, "sending": {{"jitter": "3ms",
          "late_answers": 0.1, "late_by": "1s", "double_answers": 0.1}}}},
        {{"model": "BLA15-06U-A0", "faults": {{"lose_opcode_answers": 3, "return_delay": "2s"}}}},
        {{"model": "BLA34-28U-AB", "node_id": 12, "faults": {{"power_loss_in_save": "20ms"}}}},
        {{"model": "BLA21-06U-A0", "node_id": 12}}],
      "foreign": [{{"kind": "autopilot", "node_id": 100, "allocates": true,
          "commands": {{"servo_ids": [1], "value": 0.5, "rate": 20}}}},
        {{"kind": "gnss", "node_id": 101}}, {{"kind": "babbler", "node_id": 102, "load": 0.02}}],
      "events": [{{"at": "60s", "servo": 240900001, "world": {{"voltage": "2V"}}}},
        {{"at": "70s", "servo": 240900001, "world": {{"voltage": "12V", "load": "30%"}}}},
        {{"at": "90s", "clients": "cut"}}, {{"at": "95s", "clients": "joined"}},
        {{"at": "99s", "clients": "bus_off"}}])",
                             seed)),
        Time{});
    Digest digest;
    const auto port = simulator.attach(digest, 10);
    for (int minute = 0; minute < 10; ++minute) {
      for (const char* order : {"1E0A8BFF#00000000000000C1", "1E0A8CFF#00000000000000C2"}) {
        simulator.send(port, testing::frame(order));
      }
      simulator.advance_to(simulator.now() + 60s);
    }
    return std::pair(digest.value, digest.count);
  };
  const auto first = run(3);
  CHECK(first.second > 50'000);
  CHECK(run(3) == first);
}

TEST_CASE("a wire that loses every frame carries none") {
  CHECK(run(scenario(R"("wire": {"loss": 1}, "servos": [{"model": "BLA21-12U-AB", "node_id": 1}])"),
            10s)
            .empty());
}

TEST_CASE("the same seed gives the same restarts, allocations and events") {
  const auto life = [](int seed) {
    std::vector<std::string> lines;
    Simulator simulator(scenario(fmt::format(mixed, seed)), Time{}, [&](const ServoEvent& event) {
      lines.push_back(fmt::format("{:06} {} {}", event.at.time_since_epoch().count(),
                                  name(event.kind), event.serial_number));
    });
    Log log;
    const auto port = simulator.attach(log, 10);
    for (const char* order : {"1E0A8BFF#00000000000000C1", "1E058CFF#1E1B55CEACC1"}) {
      simulator.advance_to(simulator.now() + 1s);
      simulator.send(port, testing::frame(order));
    }
    simulator.advance_to(simulator.now() + 3s);
    CHECK(lines.size() == 3);
    CHECK(simulator.servos().size() == 4);
    CHECK(simulator.servos()[0]->rom_writes() == 1);
    CHECK(simulator.servos()[3]->rom_writes() == 0);
    lines.insert(lines.end(), log.lines.begin(), log.lines.end());
    return lines;
  };
  const auto first = life(3);
  CHECK(first == life(3));
  CHECK(first != life(4));
}

TEST_CASE("requirement 54: on the bus nothing of a saving servo follows its answer for 50 ms",
          "[requirement-54]") {
  Simulator simulator(scenario(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11},
                                             {"model": "BLA15-06U-A0", "node_id": 12}])"),
                      Time{});
  Log log;
  const auto port = simulator.attach(log, 10);
  simulator.advance_to(Time{} + 1s);
  log.lines.clear();
  log.frames.clear();
  simulator.send(port, testing::frame("1E0A8BFF#00000000000000C1"));
  simulator.advance_to(simulator.now() + 50ms);
  long after_answer = -1;
  for (const can::Frame& one : log.frames) {
    const bool from_servo = (one.id & 0x7FU) == 11;
    after_answer += from_servo && (after_answer >= 0 || one.id == 0x1E0A7F8B) ? 1 : 0;
  }
  CHECK(after_answer == 0);
}

TEST_CASE("time that passes in small steps brings the same as in one") {
  Simulator simulator(scenario(fmt::format(mixed, 3)), Time{});
  Log log;
  (void)simulator.attach(log, 10);
  for (Time at{}; at <= Time{} + 3s; at += 37us) {
    simulator.advance_to(at);
  }
  simulator.advance_to(Time{} + 3s);
  CHECK(log.lines == run(scenario(fmt::format(mixed, 3)), 3s));
}

TEST_CASE("eight servos load the bus by about 2 percent") {
  std::string servos;
  for (int id = 1; id <= 8; ++id) {
    servos += fmt::format(R"({}{{"model": "BLA21-12U-AB", "node_id": {}}})", id > 1 ? "," : "", id);
  }
  Simulator simulator(scenario(R"("servos": [)" + servos + "]"), Time{});
  Log log;
  (void)simulator.attach(log, 10);
  simulator.advance_to(Time{} + 10s);
  const auto& counters = simulator.medium().counters();
  CHECK(counters.busy > 190ms);
  CHECK(counters.busy < 215ms);
  CHECK(counters.collisions == 0);
  CHECK(counters.frames == log.frames.size());
}

TEST_CASE("a client asks a servo and hears its own frame and the answer") {
  Simulator simulator(scenario(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
                                              "answer_delay": "2ms"}])"),
                      Time{});
  Log log;
  const auto port = simulator.attach(log, 10);
  simulator.advance_to(Time{} + 250ms);
  log.lines.clear();
  const auto request = testing::frame("1E0B8BFF#000030783338C5");
  CHECK(simulator.send(port, request));
  simulator.advance_to(Time{} + 254ms);
  REQUIRE(log.lines.size() >= 4);
  CHECK(log.lines[0].find("sent 1E0B8BFF#000030783338C5") != std::string::npos);
  const auto answered = std::ranges::count_if(log.lines, [](const std::string& line) {
    return line.find("1E0B7F8B#") != std::string::npos;
  });
  CHECK(answered == 3);
}

TEST_CASE("alone among servos that have all powered on, and alone without any") {
  Simulator simulator(scenario(R"("servos": [])"), Time{});
  Log log;
  const auto port = simulator.attach(log, 10);
  CHECK(simulator.send(port, testing::frame("1E018BFF#C2")));
  CHECK(simulator.next_event() == never);
  simulator.advance_to(Time{} + 10s);
  CHECK(log.lines.empty());
}

TEST_CASE("two servos with one node ID both show themselves") {
  Simulator simulator(scenario(R"("servos": [
      {"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1},
      {"model": "BLA15-06U-A0", "node_id": 11, "servo_id": 2}])"),
                      Time{});
  Log log;
  (void)simulator.attach(log, 10);
  simulator.advance_to(Time{} + 2s);
  CHECK(count(log.frames, dronecan::NodeStatus::type.id)[11] == 4);
}

TEST_CASE("both servos of one node ID answer, although their frames collide") {
  Simulator simulator(scenario(R"("servos": [
      {"model": "BLA21-12U-AB", "node_id": 11, "answer_delay": 0},
      {"model": "BLA15-06U-A0", "node_id": 11, "answer_delay": 0}])"),
                      Time{});
  Log log;
  const auto port = simulator.attach(log, 10);
  simulator.advance_to(Time{} + 250ms);
  log.frames.clear();
  simulator.send(port, testing::frame("1E018BFF#C2")); // GetNodeInfo
  simulator.advance_to(Time{} + 300ms);
  std::size_t answers = 0;
  for (const can::Frame& frame : log.frames) {
    const bool first = frame.id == 0x1E017F8B && (frame.payload().back() & 0x80U) != 0;
    answers += first ? 1U : 0U;
  }
  CHECK(simulator.medium().counters().collisions > 0);
  CHECK(answers == 2);
}

TEST_CASE("a foreign node sends NodeStatus, commands and arming, and tells who it is") {
  Simulator simulator(scenario(R"("foreign": [{"kind": "node", "node_id": 30,
      "name": "org.example.fc", "serves_get_set": true, "armed": true,
      "commands": {"servo_ids": [1, 2], "type": 1, "value": 0.45, "rate": 50}}])"),
                      Time{});
  Log log;
  const auto port = simulator.attach(log, 10);
  simulator.advance_to(Time{} + 1990ms);
  CHECK(count(log.frames, dronecan::NodeStatus::type.id)[30] == 2);
  CHECK(count(log.frames, dronecan::ArrayCommand::type.id)[30] == 200); // two frames each
  CHECK(count(log.frames, dronecan::ArmingStatus::type.id)[30] == 2);
  const auto arming = std::ranges::find_if(log.frames, [](const can::Frame& frame) {
    return frame.id == (20U << 24U | 1100U << 8U | 30U);
  });
  REQUIRE(arming != log.frames.end());
  CHECK(arming->data[0] == 255);

  log.frames.clear();
  simulator.send(port, testing::frame("1E0B9EFF#000030783338C1"));
  simulator.send(port, testing::frame("1E019EFF#C1"));
  simulator.advance_to(Time{} + 2010ms);
  const auto holds = [&](std::string_view text) {
    return std::ranges::any_of(log.frames, [&](const can::Frame& frame) {
      return testing::text(frame).starts_with(text);
    });
  };
  CHECK(holds("1E0B7F9E#00000000C1")); // no such parameter
  CHECK(holds("1E017F9E#"));
}

TEST_CASE("without serves_get_set a foreign node leaves GetSet unanswered") {
  Simulator simulator(scenario(R"("foreign": [{"kind": "node", "node_id": 30}])"), Time{});
  Log log;
  const auto port = simulator.attach(log, 10);
  simulator.send(port, testing::frame("1E0B9EFF#000030783338C1"));
  simulator.advance_to(Time{} + 900ms);
  CHECK(std::ranges::none_of(log.frames,
                             [](const can::Frame& frame) { return frame.id == 0x1E0B7F9E; }));
}

TEST_CASE("what surrounds a servo changes when the scenario says so") {
  Simulator simulator(scenario(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}],
      "events": [{"at": "2s", "servo": 240900001, "world": {"plugged": "on", "voltage": "9.5V"}},
                 {"at": "1s", "servo": 240900001, "world": {"plugged": "off"}}])"),
                      Time{});
  Log log;
  (void)simulator.attach(log, 10);
  simulator.advance_to(Time{} + 1s);
  CHECK(log.frames.size() > 10);
  log.frames.clear();
  simulator.advance_to(Time{} + 2s);
  CHECK(log.frames.size() <= 2); // of the last broadcast before
  simulator.advance_to(Time{} + 3s);
  CHECK(log.frames.size() > 10);
  const Servo& servo = *simulator.servos().front();
  CHECK(servo.world().plugged);
  CHECK(servo.world().supply_decivolt == 95);
}

TEST_CASE("a client whose cable is cut hears nothing, and its frames wait") {
  Simulator simulator(scenario(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11},
                                             {"model": "BLA15-06U-A0", "node_id": 12}],
      "events": [{"at": "1s", "clients": "cut"}, {"at": "3s", "clients": "joined"}])"),
                      Time{});
  Log log;
  const auto port = simulator.attach(log, 10);
  simulator.advance_to(Time{} + 1001ms);
  log.lines.clear();
  simulator.send(port, testing::frame("1E018BFF#C0"));
  simulator.advance_to(Time{} + 2999ms);
  CHECK(log.lines.empty());
  simulator.advance_to(Time{} + 3100ms);
  CHECK(std::ranges::any_of(log.lines, [](const std::string& line) {
    return line.find("sent 1E018BFF#C0") != std::string::npos;
  }));
}

TEST_CASE("a client's bus-off loses what it wanted to send") {
  struct Ear final : Medium::Listener {
    void heard(const can::Frame&, Time) override {}

    void sent(const can::Frame&, Time) override { ++count; }

    void bus_off(Time) override { off = true; }

    int count = 0;
    bool off = false;
  } ear;

  Simulator simulator(scenario(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}],
      "events": [{"at": "1000040us", "clients": "bus_off"}])"),
                      Time{});
  const auto port = simulator.attach(ear, 10);
  simulator.advance_to(Time{} + 1s);
  for (int i = 0; i < 5; ++i) {
    simulator.send(port, testing::frame("1E018BFF#C0")); // the first is on its way by then
  }
  simulator.advance_to(Time{} + 2s);
  CHECK(ear.off);
  CHECK(ear.count == 0);
  simulator.send(port, testing::frame("1E018BFF#C1"));
  simulator.advance_to(Time{} + 3s);
  CHECK(ear.count == 1);
}

TEST_CASE("a node that joins later is silent before") {
  const Scenario later =
      scenario(R"("foreign": [{"kind": "node", "node_id": 30, "joins": "500ms"}])");
  CHECK(run(later, 499ms).empty());
  CHECK(run(later, 501ms).size() == 1);
}
