#include "blactl/fleet/change/plan.hpp"

#include "support.hpp"

#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
namespace at = bla::address;

namespace {

Wanted set(const std::vector<std::string>& texts, bool save = false) {
  return {.assignments = assignments(texts),
          .restart = save ? std::optional(RestartKind::save) : std::nullopt};
}

const Wanted save{.restart = RestartKind::save};
const Wanted restart{.restart = RestartKind::restart};
const Wanted erase{.erase = true};
const Wanted erase_keeping_ids{.erase = true, .keep_ids = true};
const Wanted erase_and_save{.erase = true, .restart = RestartKind::save};

std::vector<int> needed(const Wanted& wanted, const Servo& servo = bla21()) {
  const auto registers = registers_needed(wanted, servo);
  REQUIRE(registers);
  std::vector<int> addresses;
  for (const bla::Parameter* each : *registers) {
    addresses.push_back(each->address.value());
  }
  return addresses;
}

Code refusal(const Wanted& wanted, const bla::Values& held = {}, const Servo& servo = bla21()) {
  const auto plan = try_plan(wanted, held, servo);
  REQUIRE_FALSE(plan);
  CHECK_FALSE(plan.error().message.empty());
  CHECK_FALSE(plan.error().hint.empty());
  return plan.error().code;
}

Servo unknown_model() {
  Servo servo = bla21();
  servo.identity = bla::Identity(profiles(), {99, 1, 1400, 55555});
  return servo;
}

bool asks(const Plan& plan, std::string_view words) {
  return question(std::vector{plan}).find(words) != std::string::npos;
}

std::string question_of(const Plan& plan) {
  return question(std::vector{plan});
}

} // namespace

TEST_CASE("what is written is read before, with what tells whether it moves the shaft") {
  CHECK(needed(set({"reverse=on"})) == std::vector{0x23});
  CHECK(needed(set({"angle_limit_cw=90deg"})) ==
        std::vector{0x38, 0x08, 0x00, 0x36, 0x37, 0x39}); // and whether it cuts off PWM
  CHECK(needed(set({"angle_limit_cw=90deg", "angle_limit_ccw=-90deg"})) ==
        std::vector{0x38, 0x39, 0x08, 0x00, 0x36, 0x37}); // each once
  CHECK(needed(set({"temperature_limit_high=60"})) == std::vector{0x3E, 0x3F, 0x0B, 0x1A});
  CHECK(needed(set({"voltage_limit_low=9V"})) == std::vector{0x41, 0x40, 0x0C, 0x1A});
  CHECK(needed(set({"command_speed=100rpm"})) ==
        std::vector{0x01, 0x25, 0x02, 0x26}); // does it take it, and what stops it?
}

TEST_CASE("the unit of 0x36 hangs on 0x37, which is read beside it") {
  CHECK(needed(set({"pwm_output_range=90deg"})) ==
        std::vector{0x36, 0x37, 0x19, 0x38, 0x39, 0x3A, 0x3B});
  CHECK(needed(set({"pwm_output_range=90deg", "pwm_mode=angle"})) ==
        std::vector{0x36, 0x37, 0x19, 0x38, 0x39, 0x3A, 0x3B, 0x25});
}

TEST_CASE("where ROM is written or RAM erased the whole configuration is read") {
  auto configuration = needed(save);
  CHECK(configuration.size() == 35);
  CHECK(configuration.back() == 0x1A); // whether ROM was read
  CHECK(needed(restart) == configuration);
  configuration.pop_back();
  CHECK(needed(erase) == configuration);
  const auto with_change = needed(set({"angle_limit_cw=90deg"}, true));
  CHECK(with_change.size() == 35 + 2); // and the angle, and the command
  CHECK(with_change.front() == 0x38);
}

TEST_CASE("what this servo refuses whatever it holds is refused before it is read") {
  CHECK(refusal(set({"angle_limit_cw=90deg"}), {}, unknown_model()) == Code::no_profile);
  Servo old = bla21();
  old.identity = bla::Identity(profiles(), {61, 1, 1010, 12050});
  CHECK(refusal(set({"pwm_mode=angle"}), {}, old) == Code::unsupported);
}

TEST_CASE("a servo of an unknown model is neither saved nor restarted nor erased") {
  for (const Wanted& wanted : {save, restart, erase, erase_and_save}) {
    CHECK(refusal(wanted, {}, unknown_model()) == Code::no_profile);
  }
}

TEST_CASE("a servo whose model is known in part is not erased: its defaults are not known") {
  Servo servo = bla21();
  servo.identity = bla::Identity(profiles(), {61, 1, 1400, 99'999});
  REQUIRE(servo.identity.model() == "BLA21");
  const auto refused = try_plan(erase, {}, servo);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == Code::no_profile);
  CHECK(refused.error().node_id == 11);
  CHECK_FALSE(refused.error().hint.empty());
  CHECK(try_plan(save, {}, servo)); // needs no default
}

TEST_CASE("a servo that could not be read has no plan, but the reason why") {
  const Wanted wanted = set({"reverse=on"});
  const auto registers = registers_needed(wanted, bla21());
  Snapshot snapshot = snapshot_of(bla21(), *registers);
  SECTION("not identified") {
    snapshot.error = Error{Code::not_found, "away"};
    CHECK(make_plan(wanted, snapshot, profiles()).error().code == Code::not_found);
  }
  SECTION("one register without an answer") {
    snapshot.readings[0].raw = std::unexpected(Error{Code::timeout, "mute"});
    CHECK(make_plan(wanted, snapshot, profiles()).error().code == Code::timeout);
  }
}

TEST_CASE("a mere restart rests on no register: one that could not be read does not hinder it") {
  for (const Wanted& wanted : {restart, save, erase}) {
    const auto registers = registers_needed(wanted, bla21());
    Snapshot snapshot = snapshot_of(bla21(), *registers);
    snapshot.readings[0].raw = std::unexpected(Error{Code::timeout, "mute"});
    const auto plan = make_plan(wanted, snapshot, profiles());
    CHECK(plan.has_value() == (wanted.restart == RestartKind::restart));
  }
  Snapshot unknown = snapshot_of(bla21(), {});
  unknown.error = Error{Code::timeout, "gone"};
  CHECK_FALSE(make_plan(restart, unknown, profiles()));
}

TEST_CASE("0x36 in a unit that the servo's 0x37 does not take is refused, and says of which node") {
  const auto wanted = set({"pwm_output_range=90deg"});
  const auto refused = try_plan(wanted, {{at::pwm_mode, 1}});
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == Code::usage);
  CHECK(refused.error().node_id == 11);
  CHECK(try_plan(wanted, {{at::pwm_mode, 0}}));
  // Beside it, the new mode counts.
  CHECK(try_plan(set({"pwm_output_range=90deg", "pwm_mode=angle"}), {{at::pwm_mode, 1}}));
}

TEST_CASE("a change says from what to what; what is held already is not sent") {
  const Plan plan = plan_for(set({"angle_limit_cw=90deg", "reverse=on"}), {{at::reverse, 1}});
  REQUIRE(plan.changes.size() == 2);
  CHECK(plan.changes[0].is_planned());
  CHECK(plan.changes[0].before == 1799);
  CHECK(plan.changes[0].requested == 900);
  CHECK_FALSE(plan.changes[0].after);
  CHECK(plan.changes[1].status == ChangeStatus::unchanged);
  CHECK(plan.changes[1].before == 1);
  CHECK(plan.changes[1].after == 1);
  CHECK(plan.acts());
  CHECK(plan.expected.empty()); // RAM is proven change by change
}

TEST_CASE("a plan without anything to do does nothing, moves nothing and asks nothing") {
  const Plan plan = plan_for(set({"reverse=on"}), {{at::reverse, 1}});
  CHECK_FALSE(plan.acts());
  CHECK_FALSE(plan.waits_for_driver());
  CHECK(question_of(plan).empty());
}

TEST_CASE("after a save the servo holds what it held, and what was changed") {
  const Plan plan =
      plan_for(set({"angle_limit_cw=90deg"}, true), {{at::servo_id, 7}, {at::reverse, 1}});
  CHECK(plan.expected.size() == 34);
  CHECK(plan.expected.at(at::angle_limit_cw) == 900);
  CHECK(plan.expected.at(at::servo_id) == 7);
  CHECK(plan.expected.at(at::reverse) == 1);
  CHECK(plan_for(save, {{at::servo_id, 7}}).expected.at(at::servo_id) == 7);
}

TEST_CASE("a command that RAM alone takes is not expected of ROM") {
  const Plan plan = plan_for(set({"command_angle=10deg", "reverse=on"}, true));
  CHECK_FALSE(plan.expected.contains(at::command_angle));
  CHECK(plan.expected.at(at::reverse) == 1);
}

TEST_CASE("what a mere restart brings nobody knows: nothing is expected") {
  CHECK(plan_for(restart).expected.empty());
}

TEST_CASE("an erased servo holds the defaults of its model, its IDs included") {
  for (const Wanted& wanted : {erase, erase_and_save}) {
    const Plan plan = plan_for(wanted, {{at::servo_id, 7}, {at::static_node_id, 11}});
    CHECK(plan.changes.empty());
    CHECK(plan.expected == *bla21().identity.factory_defaults());
    CHECK(plan.expected.at(at::servo_id) == 0);
    CHECK(plan.acts());
    CHECK(plan.waits_for_driver());
  }
}

TEST_CASE("kept IDs are written again after ERASE; what is 0 is 0 by itself") {
  const Plan both = plan_for(erase_keeping_ids, {{at::servo_id, 7}, {at::static_node_id, 11}});
  REQUIRE(both.changes.size() == 2);
  CHECK(both.changes[0].parameter->address == at::servo_id);
  CHECK(both.changes[0].requested == 7);
  CHECK(both.changes[0].before == 0);
  CHECK(both.changes[0].is_planned());
  CHECK(both.changes[1].parameter->address == at::static_node_id);
  CHECK(both.changes[1].requested == 11);
  CHECK(both.expected.at(at::servo_id) == 7);
  CHECK(both.expected.at(at::static_node_id) == 11);
  CHECK(both.expected.at(at::angle_limit_cw) == 1799);
  CHECK(plan_for(erase_keeping_ids, {{at::servo_id, 7}}).changes.size() == 1);
  CHECK(plan_for(erase_keeping_ids).changes.empty());
}

TEST_CASE("a static node ID that must not be written is not kept over an ERASE") {
  const auto id = GENERATE(126, 127);
  CHECK(refusal(erase_keeping_ids, {{at::static_node_id, id}}) == Code::out_of_range);
}

TEST_CASE("what stops a shaft is written first") {
  const Plan plan =
      plan_for(set({"timeout_action=hold", "command_speed=0rpm", "torque_output=on"}),
               {{at::command_speed, 20}, {at::torque_output, 1}, {at::speed_torque_control, 1}});
  REQUIRE(plan.changes.size() == 3);
  CHECK(plan.changes[0].parameter->address == at::command_speed);
}

TEST_CASE("a torque of 0 stops a shaft, too, and one that is held already stops nothing") {
  const auto order = [](std::int64_t held) {
    const Plan plan = plan_for(set({"timeout_action=hold", "command_torque=0%"}),
                               {{at::command_torque, held}, {at::speed_torque_control, 1}});
    std::vector<bla::Address> addresses;
    for (const RegisterChange& change : plan.changes) {
      addresses.push_back(change.parameter->address);
    }
    return addresses;
  };
  CHECK(order(20) == std::vector{at::command_torque, at::timeout_action});
  CHECK(order(0) == std::vector{at::timeout_action, at::command_torque});
}

TEST_CASE("the command that a servo discards as its output goes on is written after that") {
  const Plan plan = plan_for(set({"command_angle=40deg", "torque_output=on"}),
                             {{at::command_angle, 400}, {at::torque_output, 1}});
  REQUIRE(plan.changes.size() == 2);
  CHECK(plan.changes[1].parameter->address == at::command_angle);
  CHECK(plan.changes[1].is_planned());
  const Plan on = plan_for(set({"command_angle=40deg", "torque_output=on"}),
                           {{at::command_angle, 400}, {at::torque_output, 0}});
  CHECK_FALSE(on.acts());
}

TEST_CASE("values wanted of a servo that is erased first are judged by what ERASE leaves") {
  Wanted wanted = set({"angle_limit_cw=90deg", "reverse=off", "servo_id=5"}, true);
  wanted.erase = wanted.keep_ids = true;
  const Plan plan =
      plan_for(wanted, {{at::angle_limit_cw, 900}, {at::reverse, 1}, {at::servo_id, 7}});
  REQUIRE(plan.changes.size() == 3);
  CHECK(plan.changes[0].is_planned()); // it holds 90 deg now, and not after ERASE
  CHECK(plan.changes[0].before == 1799);
  CHECK(plan.changes[1].status == ChangeStatus::unchanged); // ERASE does it
  CHECK(plan.changes[1].before == 0);
  CHECK(plan.changes[2].requested == 5); // wanted explicitly: 7 is not kept
  CHECK(plan.expected.at(at::angle_limit_cw) == 900);
  CHECK(plan.expected.at(at::servo_id) == 5);
}

TEST_CASE("0x37 is told as it was and as it will be, for those who show 0x36") {
  const Plan plan =
      plan_for(set({"pwm_output_range=90deg", "pwm_mode=angle"}), {{at::pwm_mode, 1}});
  CHECK(plan.mode_before == 1);
  CHECK(plan.mode_after == 0);
  CHECK_FALSE(plan_for(set({"reverse=on"})).mode_before);
}

TEST_CASE("speed and torque are refused while the servo does not take them, and are told why") {
  const bla::Values off{{at::speed_torque_control, 0}};
  const bla::Values on{{at::speed_torque_control, 1}};
  for (const char* command : {"command_speed=100rpm", "command_torque=10%"}) {
    INFO(command);
    CHECK(refusal(set({command}), off) == Code::cross_check);
    CHECK(refusal(set({command, "speed_torque_control=off"}), on) == Code::cross_check);
    CHECK(try_plan(set({command}), on));
    CHECK(try_plan(set({"speed_torque_control=on", command}), off));
  }
  CHECK(try_plan(set({"command_angle=10deg"}), off));
}

TEST_CASE("what the manufacturer advises to leave as it is is warned of, and done",
          "[requirement-175]") {
  const Plan plan = plan_for(set({"speed_p_gain=5", "reverse=on"}));
  CHECK(plan.acts());
  REQUIRE(plan.warnings.size() == 1);
  CHECK(plan.warnings[0].code == "leave_at_default");
  CHECK(plan.warnings[0].text.find("speed_p_gain") != std::string::npos);
  CHECK(plan_for(set({"speed_p_gain=5"}), {{at::speed_p_gain, 5}}).warnings.empty());
  const auto usual = bla21().identity.parameter(at::speed_p_gain)->default_raw;
  REQUIRE(usual);
  const auto back = set({fmt::format("speed_p_gain={}", *usual)});
  CHECK(plan_for(back, {{at::speed_p_gain, 5}}).warnings.empty());
  for (const char* other : {"0x31=5", "0x32=5", "0x33=5"}) {
    const auto warnings = plan_for(set({other})).warnings;
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].code == "leave_at_default");
  }
}

TEST_CASE("limits of speed and torque are warned of once while their switch is off") {
  const Plan plan = plan_for(set({"speed_limit_cw=5rpm", "torque_limit_cw=10%"}));
  REQUIRE(plan.warnings.size() == 1);
  CHECK(plan.warnings[0].code == "limits_without_effect");
  CHECK(plan.warnings[0].text.starts_with("speed_limit_cw=5rpm: "));
  CHECK(plan.warnings[0].text.find("speed_torque_control=on") != std::string::npos);
  CHECK(plan_for(set({"speed_limit_cw=5rpm"}), {{at::speed_torque_control, 1}}).warnings.empty());
  CHECK(plan_for(set({"speed_torque_control=on", "speed_limit_cw=5rpm"})).warnings.empty());
  const Plan off = plan_for(set({"speed_torque_control=off"}),
                            {{at::speed_torque_control, 1}, {at::torque_limit_ccw, -10}});
  REQUIRE(off.warnings.size() == 1);
  CHECK(off.warnings[0].text.starts_with("speed_torque_control=off: "));
}

TEST_CASE("the question of a torque limit of 0 tells whether it lets go of the load now") {
  const bla::Values on{{at::speed_torque_control, 1}};
  const std::string now = "(with a torque limit of 0 % the servo lets go of the load";
  const std::string later = "no effect while speed_torque_control (0x25) is off";
  const Plan held_off = plan_for(set({"torque_limit_cw=0%"}));
  CHECK(held_off.waits_for_driver());
  CHECK(asks(held_off, later));
  CHECK_FALSE(asks(held_off, now));
  for (const Plan& lets_go :
       {plan_for(set({"torque_limit_cw=0%"}), on),
        plan_for(set({"torque_limit_cw=0%", "speed_torque_control=on"})),
        plan_for(set({"speed_torque_control=on"}), {{at::torque_limit_ccw, 0}})}) {
    CHECK(asks(lets_go, now));
    CHECK_FALSE(asks(lets_go, later));
  }
  CHECK_FALSE(asks(plan_for(set({"speed_torque_control=on"})), now));
}

TEST_CASE("a plan tells which node ID it gives") {
  const bla::Values held{{at::static_node_id, 20}};
  CHECK(plan_for(set({"static_node_id=20"})).given_node_id() == NodeId(20));
  CHECK(plan_for(set({"static_node_id=20"}), held).given_node_id() == NodeId(20)); // with a restart
  CHECK_FALSE(plan_for(set({"static_node_id=11"})).given_node_id());               // where it is
  CHECK_FALSE(plan_for(set({"static_node_id=0"})).given_node_id());
  CHECK_FALSE(plan_for(set({"reverse=on"}), held).given_node_id());
  CHECK(plan_for(save, held).given_node_id() == NodeId(20)); // RAM has it, ROM will
  CHECK_FALSE(plan_for(restart, held).given_node_id());      // nobody knows
  CHECK_FALSE(plan_for(erase_and_save, held).given_node_id());
  Wanted keeping = erase_keeping_ids;
  keeping.restart = RestartKind::save;
  CHECK(plan_for(keeping, held).given_node_id() == NodeId(20));
}

TEST_CASE("a plan tells which servo ID it gives for good") {
  const bla::Values held{{at::servo_id, 7}};
  CHECK(plan_for(set({"servo_id=7"})).given_servo_id() == 7);
  CHECK_FALSE(plan_for(set({"servo_id=0"}), held).given_servo_id());
  CHECK_FALSE(plan_for(set({"reverse=on"}), held).given_servo_id());
  CHECK(plan_for(save, held).given_servo_id() == 7);
  CHECK(plan_for(set({"reverse=on"}, true), held).given_servo_id() == 7);
  CHECK_FALSE(plan_for(restart, held).given_servo_id());
  Wanted known = restart;
  known.rom_servo_id = 7; // as its ROM is known to hold
  CHECK(plan_for(known, {{at::servo_id, 5}}).given_servo_id() == 7);
  CHECK_FALSE(plan_for(known, held).given_servo_id());
  CHECK_FALSE(plan_for(erase_and_save, held).given_servo_id());
}

TEST_CASE("a command that ROM does not keep is not saved: with SAVE it is refused") {
  const std::vector one{NodeId(11)};
  const auto refused = refuse_together(set({"reverse=on", "command_angle=10deg"}, true), one);
  REQUIRE(refused);
  CHECK(refused->code == Code::usage);
  CHECK(refused->message.find("command_angle") != std::string::npos);
  CHECK_FALSE(refuse_together(set({"command_angle=10deg"}), one));
  CHECK_FALSE(refuse_together(set({"reverse=on"}, true), one));
}

TEST_CASE("one servo ID for several servos is refused: one command would move all") {
  const std::vector one{NodeId(11)};
  const std::vector two{NodeId(11), NodeId(12)};
  const auto refused = refuse_together(set({"servo_id=20"}), two);
  REQUIRE(refused);
  CHECK(refused->code == Code::duplicate_servo_id);
  CHECK_FALSE(refuse_together(set({"servo_id=20"}), one));
  CHECK_FALSE(refuse_together(set({"servo_id=0"}), two));
}

TEST_CASE("one static node ID for several servos is refused, for one it is not") {
  const std::vector one{NodeId(11)};
  const std::vector two{NodeId(11), NodeId(12)};
  const auto refused = refuse_together(set({"static_node_id=20"}), two);
  REQUIRE(refused);
  CHECK(refused->code == Code::duplicate_node_id);
  CHECK(refused->hint.find("11") != std::string::npos);
  CHECK_FALSE(refuse_together(set({"static_node_id=20"}), one));
  CHECK_FALSE(refuse_together(set({"static_node_id=0"}), two)); // each gets one of its own
  CHECK_FALSE(refuse_together(save, two));
}

TEST_CASE("what may move the shaft is asked with node, register, before and after") {
  const Plan plan =
      plan_for(set({"angle_limit_cw=90deg", "smoothing=off"}), {{at::current_angle, 1000}});
  CHECK(plan.waits_for_driver());
  CHECK(asks(plan, "node 11: angle_limit_cw 1799  (179.9 deg) -> 900  (90.0 deg)"));
  CHECK_FALSE(asks(plan, "smoothing"));
}

TEST_CASE("what moves nothing is not asked") {
  const Plan plan =
      plan_for(set({"angle_limit_cw=90deg", "smoothing=off"}), {{at::current_angle, 0}});
  CHECK(plan.acts());
  CHECK_FALSE(plan.waits_for_driver());
  CHECK(question_of(plan).empty());
}

TEST_CASE("a save is asked where torque is on, in the words for what will happen") {
  CHECK(question_of(plan_for(save, {{at::torque_output, 1}})).empty());
  const Plan soft = plan_for(save, {{at::torque_output, 0}, {at::soft_start, 1}});
  CHECK(asks(soft, "runs slowly to 0 deg"));
  CHECK_FALSE(asks(soft, "This can move the shaft")); // no register is changed
  const Plan hard = plan_for(save, {{at::torque_output, 0}, {at::soft_start, 0}});
  CHECK(asks(hard, "returns where the shaft is"));
  CHECK(soft.waits_for_driver());
}

TEST_CASE("a mere restart is asked whatever RAM holds: it starts with what ROM holds") {
  for (const std::int64_t torque : {0, 1}) {
    const Plan plan = plan_for(restart, {{at::torque_output, torque}, {at::soft_start, 1}});
    CHECK(asks(plan, "which is not known: torque may come on"));
    CHECK(plan.waits_for_driver());
  }
}

TEST_CASE("a save is asked by what it saves, not by what was there before") {
  const bla::Values torque_on{{at::torque_output, 0}};
  const bla::Values torque_off{{at::torque_output, 1}};
  CHECK_FALSE(asks(plan_for(set({"torque_output=off"}, true), torque_on), "its output drops"));
  CHECK(asks(plan_for(set({"torque_output=on"}, true), torque_off), "its output drops"));
}

TEST_CASE("ERASE is always asked, with the IDs that it takes or keeps", "[requirement-64]") {
  const bla::Values held{{at::servo_id, 7}, {at::static_node_id, 11}};
  const Plan all = plan_for(erase, held);
  CHECK(asks(all, "servo_id 7 -> 0, static_node_id 11 -> 0"));
  const Plan keeping = plan_for(erase_keeping_ids, held);
  CHECK(asks(keeping, "everything but its IDs"));
  CHECK_FALSE(asks(keeping, "-> 0"));
  CHECK_FALSE(asks(keeping, "-> 7")); // that they are written again is no news
}

TEST_CASE("ERASE is asked with what it does to torque, and that ROM may be erased as well") {
  const Plan plan = plan_for(erase, {{at::torque_output, 1}});
  CHECK(asks(plan, "a restart should bring back what ROM holds; but the specification also"));
  CHECK(asks(plan, "node 11: torque comes on"));
  CHECK_FALSE(asks(plan_for(erase, {{at::torque_output, 0}}), "torque comes on")); // it is on
  CHECK_FALSE(asks(plan_for(erase_and_save), "nothing is saved"));
}

TEST_CASE("several servos are one question, with a line for each that it is about") {
  const auto wanted = set({"reverse=on"});
  const std::vector plans{plan_for(wanted, {}, bla21(11)),
                          plan_for(wanted, {{at::reverse, 1}}, bla21(12)),
                          plan_for(wanted, {}, bla21(13))};
  const std::string asked = question(plans);
  CHECK(asked.find("node 11") != std::string::npos);
  CHECK(asked.find("node 12") == std::string::npos);
  CHECK(asked.find("node 13") != std::string::npos);
  CHECK(asked.find("This can move the shaft") == 0);
  CHECK(asked.find("This can move", 1) == std::string::npos);
}
