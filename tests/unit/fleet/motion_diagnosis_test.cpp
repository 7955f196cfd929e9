#include "blactl/bla/fault_bits.hpp"
#include "blactl/fleet/doctor/motion.hpp"

#include "support.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using bla::Level;
using dronecan::ArrayCommand;

namespace at = bla::address;
namespace fault = bla::fault;

namespace {

using Codes = std::vector<std::string>;

constexpr std::uint8_t unitless = 0, position = 1, force = 2, speed = 3;

Servo servo_of(const bla::Profile& profile, std::int64_t firmware) {
  Servo servo = bla21(11);
  servo.identity = bla::Identity(
      profiles(), {profile.model_number, 240900500, firmware, profile.hardware_version});
  servo.servo_id = 1;
  return servo;
}

/// What was heard for three seconds, and what a servo with servo ID 1 as node 11 holds.
struct Case {
  Servo servo = servo_of(model("BLA21-12U-AB"), 1400);
  bla::Values held{{at::command_speed, bla::not_active},
                   {at::command_torque, bla::not_active},
                   {at::fault_notice, fault::pwm_missing}};
  Roster roster{NodeId(127), profiles()};
  Time now{1000s};
  bool is_long_enough = true;
  bla::Values rom{}; ///< as far as known

  Case() { roster.learn(servo, GetNodeInfo::Response{.unique_id = {11}}); }

  void receive(dronecan::Kind kind, const dronecan::DataType& type, std::uint8_t by,
               const dronecan::Payload& payload, std::uint8_t to = 0) {
    roster.receive({.header = {.kind = kind,
                               .data_type_id = type.id,
                               .source = NodeId(by),
                               .destination = NodeId(to)},
                    .payload = payload.bytes(),
                    .at = now});
  }

  void commanded(std::uint8_t servo_id, std::uint8_t type, std::initializer_list<float> values,
                 Duration period = 100ms, std::uint8_t by = 100) {
    for (const float value : values) {
      now += period;
      receive(
          dronecan::Kind::message, ArrayCommand::type, by,
          ArrayCommand{{{.actuator_id = servo_id, .command_type = type, .value = value}}}.encode());
    }
  }

  void written(bla::Address reg, std::int64_t raw, std::uint8_t to = 11) {
    receive(dronecan::Kind::request, GetSet::type, 90,
            GetSet::Request{.value = raw, .name = reg.name()}.encode(), to);
  }

  [[nodiscard]] Diagnoses look(MotionLook how = MotionLook::named) const {
    auto heard = commands_to(servo, roster, now);
    heard.is_long_enough = is_long_enough;
    return diagnose_motion(snapshot_of(servo, registers_of_motion(servo), held), heard, profiles(),
                           how, rom);
  }

  [[nodiscard]] Codes codes(MotionLook how = MotionLook::named) const {
    Codes all;
    for (const Diagnosis& found : look(how)) {
      CHECK_FALSE(found.text.empty());
      CHECK_FALSE(found.fix.empty());
      CHECK(found.node == NodeId(11));
      all.push_back(found.code);
    }
    return all;
  }

  [[nodiscard]] Codes obstacles() const { return codes(MotionLook::commanded); }

  [[nodiscard]] Diagnosis only() const {
    const auto found = look();
    REQUIRE(found.size() == 1);
    return found.front();
  }
};

/// Commanded as it should be.
struct Followed : Case {
  Followed() { commanded(1, position, {0.1F, 0.2F, -0.3F}); }
};

} // namespace

TEST_CASE("a commanded servo as from the factory has no finding, whatever its model") {
  for (const bla::Profile& profile : profiles().all()) {
    for (const std::int64_t firmware : {1010, 1100, 1200, 1300, 1400, 1500}) {
      INFO(profile.model << ' ' << firmware);
      Followed good;
      good.servo = servo_of(profile, firmware);
      good.held[at::fault_notice] = profile.pwm ? fault::pwm_missing : 0;
      good.held[at::fault_summary] = profile.pwm ? 1 << 16 : 0;
      CHECK(good.codes() == Codes{});
      CHECK(good.obstacles() == Codes{});
      good.held[at::speed_torque_control] = 1;
      CHECK(good.codes() == Codes{});
    }
  }
}

TEST_CASE("the ends of the range are no finding: +-1 of UNITLESS is +-180 deg") {
  Case whole;
  whole.commanded(1, unitless, {1.0F, -1.0F});
  CHECK(whole.codes() == Codes{});
}

TEST_CASE("unknown values are no reason for a finding") {
  const Followed good;
  Snapshot nothing{.servo = good.servo};
  for (const bla::Parameter* each : registers_of_motion(good.servo)) {
    nothing.readings.push_back({each, fail(Code::not_recorded, "not recorded")});
  }
  CHECK(diagnose_motion(nothing, commands_to(good.servo, good.roster, good.now), profiles(),
                        MotionLook::named, {})
            .empty());
  CHECK(diagnose_motion(nothing, {}, profiles(), MotionLook::named, {}).empty());
}

TEST_CASE("torque_off: off or braking") {
  Followed off;
  off.held[at::torque_output] = 1;
  CHECK(off.codes() == Codes{"torque_off"});
  CHECK(off.obstacles() == Codes{"torque_off"});
  CHECK(off.only().level == Level::warning);
  CHECK(off.only().fix == "stop node 100, then: blactl set -n 11 torque_output=on --save");
  off.held[at::torque_output] = 2;
  CHECK(off.only().text.ends_with("torque_output (0x20) is brake"));
}

TEST_CASE("what is mended is saved, unless it is known to be in RAM only") {
  Followed off;
  off.held[at::torque_output] = 1;
  off.rom = {{at::torque_output, 0}};
  CHECK(off.only().fix.ends_with("blactl set -n 11 torque_output=on"));
  off.rom = {{at::torque_output, 1}};
  CHECK(off.only().fix.ends_with("blactl set -n 11 torque_output=on --save"));
  Followed held;
  held.held[at::speed_torque_control] = 1;
  held.held[at::torque_limit_cw] = 0;
  held.held[at::torque_limit_ccw] = 0;
  held.rom = {{at::torque_limit_cw, 100}, {at::torque_limit_ccw, 0}};
  CHECK(held.only().fix.ends_with("torque_limit_cw=100% torque_limit_ccw=-100% --save"));
}

TEST_CASE("torque_limit_zero and speed_limit_zero, where they act") {
  Followed held;
  held.held[at::torque_limit_cw] = 0;
  held.held[at::speed_limit_ccw] = 0;
  CHECK(held.codes() == Codes{"limits_without_effect"});
  CHECK(held.obstacles() == Codes{});
  held.held[at::speed_torque_control] = 1;
  CHECK(held.codes() == Codes{"torque_limit_zero", "speed_limit_zero"});
  CHECK(held.obstacles() == Codes{"torque_limit_zero", "speed_limit_zero"});
  CHECK(held.look()[0].fix.ends_with("blactl set -n 11 torque_limit_cw=100% --save"));
  CHECK(held.look()[1].fix.ends_with("blactl set -n 11 speed_limit_ccw=-300rpm --save"));
  held.commanded(1, force, {20}); // heeds no speed limit (4.32)
  CHECK(held.codes() == Codes{"torque_limit_zero"});
  held.held[at::torque_limit_ccw] = 0;
  CHECK(held.only().fix.ends_with("torque_limit_cw=100% torque_limit_ccw=-100% --save"));
}

TEST_CASE("what 0x00-0x02 hold tells the command of a servo that nobody is heard to command") {
  Case torque;
  torque.is_long_enough = false;
  torque.held = {{at::command_angle, bla::not_active},
                 {at::command_speed, bla::not_active},
                 {at::command_torque, 20},
                 {at::fault_notice, fault::pwm_missing},
                 {at::speed_torque_control, 1},
                 {at::speed_limit_cw, 0},
                 {at::angle_limit_cw, 0},
                 {at::angle_limit_ccw, 0}};
  CHECK(torque.codes() == Codes{});
  torque.held[at::command_angle] = 0;
  torque.held[at::command_torque] = bla::not_active;
  CHECK(torque.codes() == Codes{"speed_limit_zero", "angle_limits"});
}

TEST_CASE("a limit of a firmware without 0x25 is told as unproven") {
  Followed old;
  old.servo = servo_of(model("BLA15-06U-A0"), 1010);
  old.held[at::torque_limit_cw] = 0;
  CHECK(old.codes() == Codes{"torque_limit_zero"});
  CHECK(old.only().level == Level::notice);
  CHECK(old.only().text.ends_with("only a real servo shows whether the limit acts"));
}

TEST_CASE("limits_without_effect: not those from the factory, while 0x25 is off") {
  Followed slow;
  slow.held[at::speed_limit_cw] = 60;
  CHECK(slow.codes() == Codes{"limits_without_effect"});
  CHECK(slow.only().level == Level::notice);
  CHECK(slow.only().text.ends_with(": speed_limit_cw 60 rpm"));
  CHECK(slow.only().fix.find("speed_torque_control=on") != std::string::npos);
  CHECK(slow.only().fix.ends_with("speed_limit_cw=300rpm --save"));
  CHECK(slow.obstacles() == Codes{});
  slow.held[at::speed_torque_control] = 1;
  CHECK(slow.codes() == Codes{});
}

TEST_CASE("angle_limits: 0 on both sides, or on one") {
  Followed fixed;
  fixed.held[at::angle_limit_ccw] = 0;
  fixed.held[at::angle_limit_cw] = 900;
  CHECK(fixed.codes() == Codes{"angle_limits", "command_beyond_limit"});
  CHECK(fixed.look().front().level == Level::notice);
  CHECK(fixed.obstacles() == Codes{"command_beyond_limit"});
  fixed.held[at::angle_limit_cw] = 0;
  CHECK(fixed.codes() == Codes{"angle_limits"});
  CHECK(fixed.obstacles() == Codes{"angle_limits"});
  CHECK(fixed.only().level == Level::warning);
  CHECK(fixed.only().fix.ends_with("angle_limit_cw=179.9deg angle_limit_ccw=-180.0deg --save"));
  fixed.held[at::speed_torque_control] = 1;
  fixed.commanded(1, speed, {60}); // heeds no angle limit (4.31)
  CHECK(fixed.codes() == Codes{});
}

TEST_CASE("mode_without_effect: speed or torque while 0x25 is off, and unknown types") {
  Case turned;
  turned.commanded(1, speed, {60});
  CHECK(turned.codes() == Codes{"mode_without_effect"});
  CHECK(turned.obstacles() == Codes{"mode_without_effect"});
  CHECK(turned.only().text.starts_with("node 100 commands node 11 by command_speed (0x01)"));
  turned.held[at::speed_torque_control] = 1;
  CHECK(turned.codes() == Codes{});
  turned.servo = servo_of(model("BLA15-06U-A0"), 1010);
  CHECK(turned.codes() == Codes{"mode_without_effect"});
  CHECK(turned.only().level == Level::notice);

  Case pushed;
  pushed.written(at::command_torque, 20);
  CHECK(pushed.codes() == Codes{"mode_without_effect"});
  CHECK(pushed.only().text.starts_with("node 90 commands node 11 by command_torque (0x02)"));

  Case strange;
  strange.commanded(1, 4, {0.5F}); // of a finding of its own
  CHECK(strange.codes() == Codes{});
  strange.commanded(1, 9, {0.5F});
  CHECK(strange.codes() == Codes{"mode_without_effect"});
  strange.commanded(1, position, {NAN});
  CHECK(strange.codes() == Codes{});
}

TEST_CASE("not_commanded: nobody, or too rarely for 0x27") {
  Case alone;
  CHECK(alone.codes() == Codes{"not_commanded"});
  CHECK(alone.obstacles() == Codes{});
  CHECK(alone.only().level == Level::notice);
  CHECK(
      alone.only().text ==
      "node 11 is commanded by nobody, as far as heard; after 1000 ms without a command "
      "(timeout_time): its output is off (timeout_action); by itself it only runs slowly to 0 deg "
      "after a start (soft_start)");
  alone.held[at::timeout_action] = 0;
  alone.held[at::soft_start] = 0;
  CHECK(alone.only().text.ends_with("without a command (timeout_time): it holds (timeout_action)"));
  alone.is_long_enough = false;
  CHECK(alone.codes() == Codes{});

  Case past;
  past.commanded(1, position, {0.1F, 0.1F});
  past.now += 3s;
  CHECK(past.codes() == Codes{"not_commanded"});

  Case rare;
  rare.commanded(1, position, {0.1F, 0.1F, 0.1F}, 1500ms);
  CHECK(rare.codes() == Codes{"not_commanded"});
  CHECK(rare.obstacles() == Codes{"not_commanded"});
  CHECK(rare.only().level == Level::warning);
  CHECK(rare.only().fix.ends_with("blactl set -n 11 timeout_time=3000ms --save"));
  rare.held[at::timeout_action] = 0;
  CHECK(rare.codes() == Codes{});
  rare.held[at::timeout_action] = 2;
  CHECK(rare.codes() == Codes{"not_commanded"});
  rare.commanded(1, position, {0.1F}, 500ms); // some were lost
  CHECK(rare.codes() == Codes{});
}

TEST_CASE("two commanders may fill each other's pauses") {
  Case both;
  for (int i = 0; i < 3; ++i) {
    both.commanded(1, position, {0.1F}, 700ms);
    both.commanded(1, position, {0.1F}, 700ms, 101);
  }
  CHECK(both.codes() == Codes{});
}

TEST_CASE("commanded_other: a servo ID that is not its own") {
  Case other;
  other.commanded(5, position, {0.1F, 0.2F});
  CHECK(other.codes() == Codes{"commanded_other"});
  CHECK(other.obstacles() == Codes{});
  CHECK(other.only().level == Level::warning);
  CHECK(other.only().text ==
        "node 100 commands servo ID 5; node 11 has servo ID 1, which nobody commands");
  CHECK(other.only().fix.ends_with("blactl set -n 11 servo_id=5 --save"));
  Servo second = bla21(12);
  second.servo_id = 5;
  other.roster.learn(second, GetNodeInfo::Response{.unique_id = {12}});
  CHECK(other.codes() == Codes{"commanded_other"});
  CHECK(other.only().level == Level::notice);
  CHECK(other.only().fix == "let it command servo ID 1");
  other.written(at::command_angle, 10, 12);
  CHECK(other.codes() == Codes{"commanded_other"});
  other.commanded(255, position, {0.1F});
  CHECK(other.codes() == Codes{});
}

TEST_CASE(
    "a servo whose ID is unknown is not told to be commanded by nobody, nor which ID it has") {
  Case unknown;
  unknown.servo.servo_id.reset();
  CHECK(unknown.codes() == Codes{"not_commanded"});
  CHECK(unknown.only().fix == "see whether it moves: blactl command -n 11 angle=10deg");
  unknown.commanded(5, position, {0.1F});
  CHECK(unknown.codes() == Codes{});
}

TEST_CASE("pwm_has_no_say: CAN goes first, and pulses that do not count") {
  Followed driven;
  driven.held[at::fault_notice] = 0;
  CHECK(driven.codes() == Codes{"pwm_has_no_say"});
  CHECK(driven.only().level == Level::notice);
  CHECK(driven.obstacles() == Codes{});
  driven.servo = servo_of(model("BLA21-12U-A0"), 1400);
  CHECK(driven.codes() == Codes{});

  Case pulsed;
  pulsed.held[at::fault_notice] = 0;
  CHECK(pulsed.codes() == Codes{}); // it is commanded by them
  pulsed.held[at::pwm_output_range] = 0;
  CHECK(pulsed.codes() == Codes{"pwm_has_no_say"});
  pulsed.held.erase(at::pwm_output_range);
  for (const std::int64_t bit : {fault::pwm_too_short, fault::pwm_too_long}) {
    pulsed.held[at::fault_notice] = bit;
    CHECK(pulsed.codes() == Codes{"pwm_has_no_say"});
  }
  pulsed.held[at::fault_notice] = 0;
  pulsed.held[at::pwm_mode] = 1;
  CHECK(pulsed.codes() == Codes{"mode_without_effect"});
  pulsed.held[at::fault_notice] = fault::pwm_missing;
  CHECK(pulsed.codes() == Codes{"not_commanded"});
}

TEST_CASE("fault_holds_off: what is beyond a limit or broken, not what tells of the last restart") {
  Followed held;
  held.held[at::fault_warning] = fault::voltage_low;
  held.held[at::current_voltage] = 38;
  held.held[at::voltage_limit_low] = 40;
  CHECK(held.codes() == Codes{"fault_holds_off"});
  CHECK(held.obstacles() == Codes{"fault_holds_off"});
  CHECK(held.only().level == Level::warning);
  CHECK(held.only().text.find("current_voltage 3.8 V, voltage_limit_low 4.0 V") !=
        std::string::npos);
  held.held[at::current_voltage] = 40;
  CHECK(held.only().level == Level::notice);
  CHECK(held.only().text.ends_with("only a real servo shows it"));
  CHECK(held.obstacles() == Codes{});
  held.held[at::fault_warning] = 0;
  for (const std::int64_t bit : {fault::motor_driver, fault::motor, fault::angle_sensor}) {
    held.held[at::fault_failure] = bit;
    CHECK(held.codes() == Codes{"fault_holds_off"});
    CHECK(held.only().level == Level::failure);
  }
  held.held[at::fault_failure] = fault::restart_failures;
  held.held[at::fault_warning] = fault::restart_warnings | fault::magnet_weak;
  CHECK(held.codes() == Codes{});
}

TEST_CASE("command_beyond_limit: as heard, else as the servo holds it") {
  Case far;
  far.held[at::angle_limit_cw] = 450;
  far.commanded(1, position, {0.1F, 0.9F, -0.2F});
  CHECK(far.codes() == Codes{"command_beyond_limit"});
  CHECK(far.obstacles() == Codes{"command_beyond_limit"});
  CHECK(far.only().text == "node 100 commands node 11 to 90.0 deg (command_angle), beyond "
                           "angle_limit_cw 45.0 deg: it goes to the limit at most");
  CHECK(far.only().fix.ends_with("blactl set -n 11 angle_limit_cw=90.0deg --save"));
  far.commanded(1, speed, {60});
  far.held[at::speed_torque_control] = 1;
  CHECK(far.codes() == Codes{}); // the angles are over
  far.held[at::speed_limit_cw] = 30;
  CHECK(far.codes() == Codes{"command_beyond_limit"});
  far.commanded(1, force, {-60});
  far.held[at::torque_limit_ccw] = -50;
  CHECK(far.codes() == Codes{"command_beyond_limit"});

  Case beyond_range;
  beyond_range.held[at::speed_torque_control] = 1;
  beyond_range.commanded(1, speed, {400});
  CHECK(beyond_range.codes() == Codes{"command_beyond_limit"});
  CHECK(beyond_range.only().fix == "keep the command within the limit");

  Case kept;
  kept.is_long_enough = false;
  kept.held[at::command_angle] = -2700;
  CHECK(kept.codes() == Codes{"command_beyond_limit"});
  CHECK(kept.obstacles() == Codes{});
  kept.held[at::command_angle] = 1800;
  CHECK(kept.codes() == Codes{});
  kept.held[at::command_angle] = bla::not_active;
  CHECK(kept.codes() == Codes{});

  Case told;
  told.held[at::angle_limit_ccw] = -100;
  told.written(at::command_angle, -101);
  CHECK(told.codes() == Codes{"command_beyond_limit"});
  CHECK(told.obstacles() == Codes{"command_beyond_limit"});
}
