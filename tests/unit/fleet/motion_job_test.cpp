// A simulated servo that is commanded: what it is told, how often, and how that ends.

#include "blactl/fleet/change/carry_out.hpp"
#include "blactl/fleet/change/write_job.hpp"
#include "blactl/fleet/motion/motion_job.hpp"
#include "blactl/fleet/motion/motion_run.hpp"

#include "support.hpp"
#include "unit/sim/motion_rig.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace at = bla::address;

namespace {

constexpr const char* free_servo =
    R"({"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 1,
        "rom": {"soft_start": "off", "speed_torque_control": "on"}})";

std::string servos(const std::string& events = "") {
  return std::string(R"("servos": [)") + free_servo + "]" +
         (events.empty() ? "" : ", \"events\": [" + events + "]");
}

/// One command from the plan to its end.
struct CommandBench {
  explicit CommandBench(const std::string& members = servos()) : scene(members) {
    scene.grow_old();
  }

  MotionPlan planned(const char* motion, Duration duration = 2s) {
    CommandWanted wanted{.duration = duration};
    if (motion != nullptr) {
      wanted.target = assignments({motion}).front();
    }
    auto plan = plan_command(
        wanted,
        scene.read(11, [&](const Servo& servo) { return registers_to_command(wanted, servo); }),
        profiles());
    INFO((plan ? "" : plan.error().message));
    REQUIRE(plan);
    return *plan;
  }

  Commanded run(const MotionPlan& plan,
                const std::function<bool(const MotionSample&)>& sampled = {}) {
    scene.sent.clear();
    return command(*scene.session, plan, {.sampled = sampled});
  }

  /// What the servo holds now.
  [[nodiscard]] std::int64_t read(const char* name) const {
    const Snapshot snapshot = scene.read(11, registers({name}));
    const auto raw = snapshot.raw(parameter(name).address);
    REQUIRE(raw);
    return *raw;
  }

  /// A message of node 40.
  void hear(const dronecan::DataType& type, const dronecan::Payload& payload) const {
    scene.roster().receive(
        {.header = {.kind = dronecan::Kind::message, .data_type_id = type.id, .source = NodeId(40)},
         .payload = payload.bytes(),
         .at = scene.session->now()});
  }

  /// How many writes to this register went out.
  [[nodiscard]] std::size_t writes() const {
    return static_cast<std::size_t>(std::ranges::count_if(scene.sent, [](const can::Frame& frame) {
      const auto header = dronecan::decode_id(frame.id);
      // A read is one frame, a write three: the middle one is neither the first nor the last.
      const unsigned place = frame.data[frame.size - 1U] >> 6U;
      return header && header->data_type_id == GetSet::type.id && place == 0;
    }));
  }

  Scene scene;
};

} // namespace

TEST_CASE("an angle is commanded, reached and held") {
  CommandBench bench;
  const MotionPlan plan = bench.planned("command_angle=45deg");
  const Commanded ended = bench.run(plan);
  CHECK_FALSE(ended.broken);
  CHECK_FALSE(ended.result.error);
  CHECK(ended.result.is_ended);
  CHECK_FALSE(ended.result.held);
  CHECK_FALSE(judge_motion(plan, ended.result));
  CHECK(bench.writes() > ended.result.commands); // and its end
  CHECK(ended.result.commands >= 20);            // every 100 ms
  CHECK(ended.result.samples.size() >= 190);
  CHECK(bench.read("command_angle") == 450);
  const StepResponse response = step_response(plan, ended.result);
  REQUIRE(response.settled);
  CHECK(*response.settled < 500ms);
  CHECK(response.overshoot_decideg <= 10);
}

TEST_CASE("a process that reads all of its frames late comes to an end") {
  CommandBench bench;
  const MotionPlan plan = bench.planned("command_angle=45deg", 500ms);
  MotionJob job(bench.scene.roster(), plan,
                {.now = [&] { return bench.scene.session->now() + 300ms; }});
  const Time begin = bench.scene.session->now();
  bench.scene.run(job);
  CHECK(job.result().has_commanded());
  CHECK(bench.scene.session->now() - begin < 10s);
}

TEST_CASE("a speed and a torque end with 0, and the shaft stands") {
  for (const char* motion : {"command_speed=-60rpm", "command_torque=20%"}) {
    CommandBench bench;
    const MotionPlan plan = bench.planned(motion, 500ms);
    const Commanded ended = bench.run(plan);
    CHECK_FALSE(ended.result.error);
    CHECK(ended.result.is_ended);
    CHECK_FALSE(judge_motion(plan, ended.result));
    CHECK(bench.writes() > ended.result.commands); // and the 0
    CHECK(bench.read(plan.parameter->name.c_str()) == 0);
    CHECK(bench.read("current_speed") == 0);
    CHECK(std::abs(*ended.result.samples.back().speed) <= 2);
  }
}

TEST_CASE("what was sampled is the trajectory of the servo, to the resolution of its registers") {
  CommandBench bench;
  const MotionPlan plan = bench.planned("command_angle=120deg", 1s);
  const Commanded ended = bench.run(plan);
  REQUIRE(ended.result.samples.size() > 90);
  // The same motor without a bus. A write is on the bus for 0.4 ms, a question for 0.13 ms.
  constexpr Duration write_time = 400us, margin = 500us;
  constexpr Duration start = 10s;
  sim::testing::MotionRig rig(R"("model": "BLA21-12U-AB",
      "rom": {"soft_start": "off", "speed_torque_control": "on", "timeout_action": "hold"})");
  rig.run(start);
  std::vector<std::int64_t> angles; // one every 100 us
  constexpr Duration grid = 100us;
  bool is_commanded = false;
  for (Duration now{}; now < 1200ms; now += grid) {
    if (!is_commanded && now >= write_time) {
      is_commanded = true;
      rig.write(at::command_angle, 1200);
    }
    angles.push_back(rig.angle());
    rig.run(grid);
  }
  std::size_t moving = 0;
  for (const MotionSample& sample : ended.result.samples) {
    REQUIRE(sample.angle);
    const auto first = std::max<std::int64_t>((sample.after - margin) / grid, 0);
    const auto last = std::min<std::int64_t>((sample.after + margin) / grid + 1,
                                             static_cast<std::int64_t>(angles.size()) - 1);
    const auto [least, most] =
        std::minmax_element(angles.begin() + first, angles.begin() + last + 1);
    INFO(sample.after.count() << " us: " << *sample.angle << ", " << *least << " to " << *most);
    CHECK(*sample.angle >= *least - 1);
    CHECK(*sample.angle <= *most + 1);
    moving += *sample.angle > 10 && *sample.angle < 1150 ? 1U : 0U;
  }
  CHECK(moving >= 10); // on the way, not only at its ends
}

TEST_CASE("no command waits longer than half of the servo's timeout, whatever is not answered",
          "[requirement-149]") {
  // Answers are 30 ms late: reads block the way of commands.
  const std::string slow = R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
      "behaviour": {"answer_delay": "30ms"},
      "rom": {"soft_start": "off", "timeout_time": "200ms"}}])";
  CommandBench bench(slow);
  const MotionPlan plan = bench.planned("command_angle=45deg", 1s);
  const Commanded ended = bench.run(plan);
  CHECK_FALSE(ended.result.error);
  CHECK(ended.result.commands >= 1000 / 80); // 0.4 of 200 ms
}

TEST_CASE("lost frames and late answers keep no command, and no end, from coming") {
  for (const char* trouble : {R"("wire": {"loss": 0.05})", R"("wire": {"loss": 0.2})"}) {
    for (int seed = 1; seed <= 20; ++seed) {
      CommandBench bench(servos() + ", " + trouble + ", \"seed\": " + std::to_string(seed));
      const auto needed = [](const Servo& servo) {
        return registers_to_command({.target = assignments({"command_angle=45deg"}).front()},
                                    servo);
      };
      auto plan = plan_command(
          {.target = assignments({"command_angle=45deg"}).front(), .duration = 50ms + 10ms * seed},
          bench.scene.read(11, needed), profiles());
      if (plan) { // else too much was lost before
        const Commanded ended = bench.run(*plan);
        CHECK((ended.result.is_ended || ended.result.error));
      }
    }
  }
}

TEST_CASE("where one frame in ten is lost it is still seen whether the shaft stands") {
  for (int seed = 1; seed <= 20; ++seed) {
    INFO(seed);
    CommandBench bench(servos() + R"(, "wire": {"loss": 0.1}, "seed": )" + std::to_string(seed));
    const CommandWanted wanted{.target = assignments({"command_angle=45deg"}).front(),
                               .duration = 1s};
    const Patience patience{.retries = 12};
    const auto needed = [&](const Servo& servo) { return registers_to_command(wanted, servo); };
    const auto read = take_snapshots(*bench.scene.session, profiles(), std::array{NodeId(11)},
                                     {.patience = patience}, needed);
    REQUIRE(read.servos.size() == 1);
    const auto plan = plan_command(wanted, read.servos.front(), profiles());
    REQUIRE(plan);
    const Commanded ended = command(*bench.scene.session, *plan, {.patience = patience});
    INFO((ended.result.error ? ended.result.error->message : ""));
    CHECK_FALSE(ended.result.error);
    CHECK(ended.result.is_ended);
  }
}

TEST_CASE("a servo that was unplugged is no success, and is not said to be stopped") {
  CommandBench bench(servos(R"({"at": "11s", "servo": 1, "happens": "power_off"})"));
  const Commanded ended = bench.run(bench.planned("command_speed=30rpm", 10s));
  CHECK(ended.result.has_commanded());
  REQUIRE(ended.result.error);
  CHECK(ended.result.error->code == Code::timeout);
  CHECK_FALSE(ended.result.is_ended);
  CHECK(ended.result.samples.back().after < 4s);
}

TEST_CASE("a servo that restarted is brought to its end, and told to run by what it holds now") {
  const std::string held = R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
      "serial_number": 1, "rom": {"soft_start": "off", "speed_torque_control": "on",
      "timeout_action": "hold"}, "ram": {"timeout_action": "off"},
      "faults": {"restart_after_answer": [{"to": "write", "number": 5}]}}])";
  CommandBench bench(held);
  const MotionPlan plan = bench.planned("command_speed=30rpm", 10s);
  const Commanded ended = bench.run(plan);
  REQUIRE(ended.result.error);
  CHECK(ended.result.has_restarted);
  if (ended.result.is_ended) { // else it was silent for too long
    CHECK(bench.read("command_speed") == 0);
    CHECK(bench.read("current_speed") == 0);
    CHECK(after_commands(plan, ended.result).find("(hold)") != std::string::npos);
  }
}

TEST_CASE("a shaft that was moved since the question is not commanded") {
  for (const char* motion : {static_cast<const char*>(nullptr), "command_angle=10deg"}) {
    CommandBench bench(servos(R"({"at": "11s", "servo": 1, "world": {"hand": "90deg"}})"));
    const MotionPlan plan = bench.planned(motion);
    bench.scene.live(2s);
    const Commanded ended = bench.run(plan);
    REQUIRE(ended.result.error);
    CHECK(ended.result.error->code == Code::state);
    CHECK_FALSE(ended.result.has_commanded());
    CHECK(bench.writes() == 0);
  }
}

TEST_CASE("where its time is too short it was not reached, wherever the shaft runs on to") {
  for (const Duration duration : {20ms, 60ms, 100ms, 120ms, 140ms, 160ms}) {
    CommandBench bench;
    const MotionPlan plan = bench.planned("command_angle=90deg", duration);
    const Commanded ended = bench.run(plan);
    CHECK(ended.result.is_ended);
    const std::int64_t stays = ended.result.held.value_or(900);
    CHECK(bench.read("command_angle") == stays);
    CHECK(std::abs(bench.read("current_angle") - stays) <= 10);
    CHECK(judge_motion(plan, ended.result).has_value() == ended.result.held.has_value());
  }
}

TEST_CASE("a restart that nobody saw is found out in the end") {
  CommandBench bench(servos(R"({"at": "11s", "servo": 1, "happens": "power_off"},
                               {"at": "11.1s", "servo": 1, "happens": "power_on"})"));
  const MotionPlan plan = bench.planned("command_angle=0deg", 1500ms);
  const Commanded ended = bench.run(plan);
  REQUIRE(ended.result.has_commanded());
  const auto& error = ended.result.error;
  REQUIRE(error);
  CHECK((error->code == Code::state || error->code == Code::timeout));
}

TEST_CASE("when the vehicle is armed nothing more is written") {
  CommandBench bench;
  const MotionPlan plan = bench.planned("command_speed=30rpm");
  std::size_t writes = 0;
  const Commanded ended = bench.run(plan, [&](const MotionSample& sample) {
    if (sample.after > 500ms && writes == 0) {
      writes = bench.writes();
      bench.hear(dronecan::ArmingStatus::type, dronecan::ArmingStatus{255}.encode());
    }
    return true;
  });
  REQUIRE(ended.result.error);
  CHECK(ended.result.error->code == Code::armed);
  CHECK_FALSE(ended.result.is_ended);
  CHECK(bench.writes() == writes);
  CHECK(bench.read("command_speed") == 30); // its own timeout lets go of it
}

TEST_CASE(
    "when a second unit comes to its ID nothing is said of a restart, nor to type what fails") {
  CommandBench bench;
  const MotionPlan plan = bench.planned("command_speed=30rpm");
  std::size_t writes = 0;
  const Commanded ended = bench.run(plan, [&](const MotionSample& sample) {
    if (sample.after > 500ms && writes == 0) {
      writes = bench.writes();
      bench.scene.roster().mark_doubled(NodeId(11), *plan.servo().unique_id, {});
    }
    return true;
  });
  REQUIRE(ended.result.error);
  CHECK(ended.result.error->code == Code::duplicate_node_id);
  CHECK(ended.result.error->message.find("restarted") == std::string::npos);
  CHECK(ended.result.error->hint.find("cut its supply") != std::string::npos);
  CHECK(ended.result.error->hint.find("blactl set") == std::string::npos);
  CHECK_FALSE(ended.result.is_ended);
  CHECK(bench.writes() == writes);
}

TEST_CASE("when an autopilot begins to command it, it is left to that") {
  CommandBench bench;
  const MotionPlan plan = bench.planned("command_speed=30rpm");
  std::size_t writes = 0;
  const Commanded ended = bench.run(plan, [&](const MotionSample& sample) {
    if (sample.after > 500ms && writes == 0) {
      writes = bench.writes();
      bench.hear(dronecan::ArrayCommand::type,
                 dronecan::ArrayCommand{{{.actuator_id = 0, .command_type = 1}}}.encode());
    }
    return true;
  });
  REQUIRE(ended.result.error);
  CHECK(ended.result.error->code == Code::driven);
  CHECK(bench.writes() == writes);
}

TEST_CASE("a setting that changed since the question is not commanded upon") {
  CommandBench bench;
  const MotionPlan plan = bench.planned("command_angle=45deg");
  const auto change =
      plans_for(bench.scene, {.assignments = assignments({"angle_limit_cw=20deg"})}, {11});
  WriteJob write(bench.scene.roster(), change.front().before.servo, change.front().changes, {});
  bench.scene.run(write);
  const Commanded ended = bench.run(plan);
  REQUIRE(ended.result.error);
  CHECK(ended.result.error->code == Code::state);
  CHECK_FALSE(ended.result.has_commanded());
  CHECK(bench.writes() == 0);
}

TEST_CASE("where the reader has left, it comes to its end, and holds where it is") {
  CommandBench bench;
  const MotionPlan plan = bench.planned("command_angle=170deg");
  const Commanded ended =
      bench.run(plan, [](const MotionSample& sample) { return sample.after < 60ms; });
  CHECK_FALSE(ended.result.error);
  CHECK(ended.result.is_ended);
  CHECK(ended.result.is_cut);
  CHECK_FALSE(judge_motion(plan, ended.result));
  REQUIRE(ended.result.held);
  CHECK(*ended.result.held < 1700);
  CHECK(*ended.result.held > 0);
  CHECK(bench.read("command_angle") == *ended.result.held);
}

TEST_CASE("a shaft that does not do what it is told is no success") {
  struct Case {
    const char* motion;
    const char* says;
  };

  for (const Case& each :
       {Case{"command_angle=45deg", "was to be at 45.0 deg"},
        Case{"command_speed=60rpm", "did not come to half"}, Case{nullptr, "did not move"}}) {
    CommandBench bench(servos(R"({"at": "1s", "servo": 1, "world": {"stuck": "on"}})"));
    const MotionPlan plan = bench.planned(each.motion);
    const Commanded ended = bench.run(plan);
    CHECK(ended.result.is_ended);
    const auto differs = judge_motion(plan, ended.result);
    REQUIRE(differs);
    CHECK(differs->code == Code::mismatch);
    CHECK(differs->message.find(each.says) != std::string::npos);
  }
}

TEST_CASE("a shaft that stands where angles wrap does not turn") {
  CHECK(between(0, 0) == 0);
  CHECK(between(10, -20) == 30);
  CHECK(between(1799, -1800) == 1);
  CHECK(between(-1799, 1799) == 2);
  CHECK(between(0, 1800) == 1800);
  CHECK(between(3601, 1) == 0); // 0x24: beyond a turn

  CommandBench bench;
  MotionPlan plan = bench.planned(nullptr);
  plan.course = {{0s, 1749}, {500ms, 1799}};
  MotionResult result;
  result.samples.assign(20, {.target = 1799, .angle = -1800}); // noise of its register
  const auto differs = judge_motion(plan, result);
  REQUIRE(differs);
  CHECK(differs->message.find("did not move") != std::string::npos);
}

TEST_CASE("a shaft that nothing holds is not said to be held") {
  const std::string members = R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
      "serial_number": 1, "rom": {"soft_start": "off", "torque_output": "off"},
      "ram": {"torque_output": "on"}}], "events": [
      {"at": "11.5s", "servo": 1, "happens": "power_off"},
      {"at": "11.6s", "servo": 1, "happens": "power_on"}])";
  CommandBench bench(members);
  const MotionPlan plan = bench.planned("command_angle=5deg", 3s);
  const Commanded ended = bench.run(plan);
  REQUIRE(ended.result.error);
  CHECK(ended.result.error->code != Code::mismatch);
  if (ended.result.is_ended) { // else it was silent for too long
    CHECK_FALSE(holds(plan, ended.result));
    CHECK(ended.result.error->message.find("torque_output is off") != std::string::npos);
  }
  CHECK(bench.read("torque_output") == 1);
}

TEST_CASE(
    "another servo that comes to the node ID is not commanded, however late it says its name") {
  const auto gap = GENERATE(60, 200, 400, 750);
  INFO(gap);
  const auto at_ms = [](int ms) { return std::to_string(ms) + "ms"; };
  CommandBench bench(R"("servos": [
      {"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 1,
       "rom": {"soft_start": "off", "speed_torque_control": "on"}},
      {"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 2,
       "rom": {"soft_start": "off", "speed_torque_control": "on"},
       "behaviour": {"first_node_status": "950ms"}}], "events": [
      {"at": "0s", "servo": 2, "happens": "power_off"},
      {"at": "11s", "servo": 1, "happens": "power_off"},
      {"at": ")" + at_ms(11000 + gap) +
                     R"(", "servo": 2, "happens": "power_on"}])");
  const Commanded ended = bench.run(bench.planned("command_speed=30rpm", 10s));
  CHECK(ended.result.has_commanded());
  REQUIRE(ended.result.error);
  CHECK(ended.result.error->code == Code::state);
  CHECK(ended.result.error->message.find("another servo") != std::string::npos);
  CHECK_FALSE(ended.result.is_ended);
  bench.scene.grow_old(); // it has told its name
  CHECK(bench.read("current_angle") == 0);
}

TEST_CASE("by ArrayCommand nobody else is moved on who tells that servo ID, or restarted") {
  const std::string members = R"("servos": [
      {"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 1, "servo_id": 3,
       "rom": {"soft_start": "off"}},
      {"model": "BLA21-12U-AB", "node_id": 12, "serial_number": 2, "servo_id": 3}], "events": [
      {"at": "11.5s", "servo": 2, "happens": "power_off"},
      {"at": "12s", "servo": 2, "happens": "power_on"}])";
  CommandBench bench(members);
  const auto unsaved = plans_for(bench.scene, {.assignments = assignments({"servo_id=4"})}, {12});
  REQUIRE_FALSE(carry_out(*bench.scene.session, profiles(), unsaved, {}).broken);
  MotionPlan plan = bench.planned("command_angle=45deg", 10s);
  plan.by_servo_id = true;
  CHECK_FALSE(refuse_servo_id(*bench.scene.session, profiles(), plan, {}));
  const Commanded ended = bench.run(plan);
  REQUIRE(ended.result.error);
  CHECK(ended.result.error->code == Code::duplicate_servo_id);
  CHECK(ended.result.error->message.find("node 12") != std::string::npos);
  CHECK(ended.result.samples.back().after < 6s);
}

TEST_CASE("no ArrayCommand to a servo ID that takes effect at the next start only") {
  for (const bool waits : {false, true}) {
    CommandBench bench(fmt::format(R"("servos": [{{"model": "BLA21-12U-AB", "node_id": 11,
        "servo_id": 3, "behaviour": {{"settings_wait_for_start": {}}}}}])",
                                   waits));
    const auto unsaved = plans_for(bench.scene, {.assignments = assignments({"servo_id=4"})}, {11});
    REQUIRE_FALSE(carry_out(*bench.scene.session, profiles(), unsaved, {}).broken);
    bench.scene.live(1100ms);
    MotionPlan plan = bench.planned("command_angle=45deg");
    plan.by_servo_id = true;
    const auto refused = refuse_servo_id(*bench.scene.session, profiles(), plan, {});
    CHECK(refused.has_value() == waits);
    CHECK((!waits || refused->message.find("is 4, but it reports 3") != std::string::npos));
  }
}

TEST_CASE("ArrayCommand only where nobody else may obey it") {
  const auto refused = [](const std::string& members) {
    CommandBench bench(members);
    MotionPlan plan = bench.planned("command_angle=45deg");
    return refuse_servo_id(*bench.scene.session, profiles(), plan, {});
  };
  const auto two = [](int servo_id, const std::string& more = "") {
    return std::string(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 3},
        {"model": "BLA21-12U-AB", "node_id": 12, "servo_id": )") +
           std::to_string(servo_id) + more + "}]";
  };
  CHECK_FALSE(refused(two(4)));
  CHECK(refused(two(3))->code == Code::duplicate_servo_id);
  CHECK(refused(two(4, R"(, "faults": {"mute": true})"))->code == Code::duplicate_servo_id);
  const std::string waiting = R"("servos": [
      {"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 3},
      {"model": "BLA21-12U-AB", "node_id": 0, "servo_id": 4}])";
  CHECK(refused(waiting)->code == Code::duplicate_servo_id);
}

TEST_CASE("what a protection has switched off is not held, and not done") {
  const char* motion = GENERATE("command_angle=45deg", "command_torque=20%", "command_speed=30rpm");
  CommandBench bench(
      servos(R"({"at": "12s", "servo": 1, "world": {"voltage": "30V"}})")); // its limit is 20 V
  const MotionPlan plan = bench.planned(motion, 3s);
  const Commanded ended = bench.run(plan);
  INFO(motion << ": " << (ended.result.error ? ended.result.error->message : "no error"));
  REQUIRE(ended.result.protection);
  CHECK(ended.result.protection->known->code == "voltage_high");
  CHECK_FALSE(holds(plan, ended.result));
  REQUIRE(ended.result.error);
  CHECK(ended.result.error->message.find("holds its output off") != std::string::npos);
}

TEST_CASE("a wide dead band does not make an angle reached that is far away") {
  CommandBench bench(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 1,
                        "rom": {"soft_start": "off", "angle_dead_band": "30deg"}}])");
  const MotionPlan plan = bench.planned("command_angle=20deg");
  CHECK_FALSE(is_at(plan, 0, 200));
  CHECK(is_at(plan, 155, 200));
}
