#include "blactl/fleet/safety.hpp"

#include "support.hpp"

#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

/// A servo whose registers were read as `set` reads them.
class Reader {
 public:
  Reader(std::string_view others, std::string_view servo)
      : scene(fmt::format(R"("servos": [{{"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 3,
                             "ram": {{{}}}}}]{})",
                          servo, others),
              Session::Hearing::commands),
        values(scene.roster(), scene.member(11), profiles(), {}, plan()) {
    scene.run(values);
    scene.live(1100ms);
  }

  explicit Reader(std::string_view servo = "") : Reader("", servo) {}

  [[nodiscard]] std::optional<Error> forbids(const std::vector<Change>& changes,
                                             bool while_driven = false) const {
    return forbidden(*scene.session, changes, values, while_driven);
  }

  Scene scene;
  ReadJob values;

 private:
  static ReadJob::Plan plan() {
    return [](const Member& servo) -> Result<std::vector<const bla::Parameter*>> {
      std::vector<const bla::Parameter*> wanted;
      for (const char* name :
           {"current_angle", "current_temperature", "current_voltage", "fault_notice"}) {
        wanted.push_back(servo.identity.parameter(parameter(name).address));
      }
      return wanted;
    };
  }
};

Change change(const char* name, std::int64_t requested,
              ChangeStatus status = ChangeStatus::planned) {
  Change change;
  change.parameter = &parameter(name);
  change.requested = requested;
  change.status = status;
  return change;
}

constexpr const char* armed_node =
    R"(, "foreign": [{"kind": "node", "node_id": 30, "armed": true}])";
constexpr const char* driving_node =
    R"(, "foreign": [{"kind": "node", "node_id": 30, "commands": {"servo_ids": [3]}}])";

} // namespace

TEST_CASE("what can move the shaft or let go of the load is asked, whatever the value") {
  const Reader reader;
  for (const char* name :
       {"command_angle", "command_speed", "command_torque", "torque_output", "reverse",
        "extended_angle", "timeout_action", "timeout_time", "origin"}) {
    INFO(name);
    CHECK(may_move(change(name, 0), reader.values));
    CHECK(may_move(change(name, 1), reader.values));
    CHECK(values_needed(parameter(name).address).empty());
  }
}

TEST_CASE("what cannot move anything is not asked") {
  const Reader reader;
  for (const char* name : {"soft_start", "smoothing", "angle_p_gain", "servo_id", "static_node_id",
                           "speed_limit_cw", "overcurrent_limit"}) {
    INFO(name);
    CHECK_FALSE(may_move(change(name, 0), reader.values));
  }
}

TEST_CASE("an angle limit is asked if the shaft stands beyond it") {
  const Reader reader(R"("current_angle": "45deg", "soft_start": "off")");
  CHECK(may_move(change("angle_limit_cw", 449), reader.values));
  CHECK_FALSE(may_move(change("angle_limit_cw", 450), reader.values));
  CHECK_FALSE(may_move(change("angle_limit_cw", 900), reader.values));
  CHECK(may_move(change("angle_limit_ccw", 451), reader.values));
  CHECK_FALSE(may_move(change("angle_limit_ccw", -900), reader.values));
}

TEST_CASE("a torque limit is asked if it is 0") {
  const Reader reader;
  for (const char* name : {"torque_limit_cw", "torque_limit_ccw"}) {
    CHECK(may_move(change(name, 0), reader.values));
    CHECK_FALSE(may_move(change(name, 1), reader.values));
    CHECK_FALSE(may_move(change(name, -1), reader.values));
  }
}

TEST_CASE("a limit of temperature or voltage is asked if it trips at once") {
  const Reader reader(R"("current_temperature": 40, "current_voltage": "12V")");
  CHECK(may_move(change("temperature_limit_high", 40), reader.values));
  CHECK_FALSE(may_move(change("temperature_limit_high", 41), reader.values));
  CHECK(may_move(change("temperature_limit_low", 40), reader.values));
  CHECK_FALSE(may_move(change("temperature_limit_low", 39), reader.values));
  CHECK(may_move(change("voltage_limit_high", 120), reader.values));
  CHECK_FALSE(may_move(change("voltage_limit_high", 121), reader.values));
  CHECK(may_move(change("voltage_limit_low", 120), reader.values));
  CHECK_FALSE(may_move(change("voltage_limit_low", 119), reader.values));
}

TEST_CASE("the PWM mapping is asked if there is PWM at the input") {
  const Reader without(R"("fault_notice": 1048576)"); // bit 20: no input
  const Reader with(R"("fault_notice": 2097152)");    // bit 21: pulse too short
  for (const char* name : {"pwm_neutral", "pwm_range", "pwm_output_range", "pwm_mode"}) {
    INFO(name);
    CHECK_FALSE(may_move(change(name, 1), without.values));
    CHECK(may_move(change(name, 1), with.values));
    CHECK(values_needed(parameter(name).address) == std::vector{parameter("fault_notice").address});
  }
}

TEST_CASE("what is needed for the judgement is known, and asked if it could not be read") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])");
  ReadJob nothing(scene.roster(), scene.identify(11), profiles(), {},
                  [](const Member&) { return std::vector<const bla::Parameter*>{}; });
  scene.run(nothing);
  for (const char* name :
       {"angle_limit_cw", "angle_limit_ccw", "temperature_limit_high", "temperature_limit_low",
        "voltage_limit_high", "voltage_limit_low", "pwm_neutral"}) {
    INFO(name);
    CHECK(values_needed(parameter(name).address).size() == 1);
    CHECK(may_move(change(name, 10), nothing));
  }
}

TEST_CASE("only a change that is to be written needs the bus to be watched") {
  CHECK(needs_watch(std::vector{change("soft_start", 1)}));
  CHECK_FALSE(needs_watch(std::vector{change("soft_start", 1, ChangeStatus::unchanged)}));
  CHECK_FALSE(needs_watch({}));
}

TEST_CASE("on a quiet bus nothing is forbidden") {
  const Reader reader;
  CHECK_FALSE(reader.forbids({change("torque_output", 1), change("static_node_id", 20)}));
}

TEST_CASE("while the vehicle is armed nothing is written, whatever the options") {
  const Reader reader(armed_node, "");
  const auto error = reader.forbids({change("soft_start", 1)}, true);
  REQUIRE(error);
  CHECK(error->code == Code::armed);
  CHECK(error->node_id == 11);
  CHECK(error->message.find("30") != std::string::npos);
  CHECK_FALSE(reader.forbids({change("soft_start", 1, ChangeStatus::unchanged)}));
  CHECK_FALSE(reader.forbids({}));
}

TEST_CASE("while another node drives the servo it is not moved, unless that is wanted") {
  const Reader reader(driving_node, "");
  const auto error = reader.forbids({change("torque_output", 1)});
  REQUIRE(error);
  CHECK(error->code == Code::driven);
  CHECK_FALSE(reader.forbids({change("torque_output", 1)}, true));
  CHECK_FALSE(reader.forbids({change("soft_start", 1)})); // moves nothing
}

TEST_CASE("nothing is written to a doubled node ID") {
  Reader reader;
  reader.scene.roster().mark_doubled(NodeId(11));
  const auto error = reader.forbids({change("soft_start", 1)}, true);
  REQUIRE(error);
  CHECK(error->code == Code::duplicate_node_id);
}

TEST_CASE("a static node ID that another node has is not given") {
  const Reader reader(R"(, "foreign": [{"kind": "node", "node_id": 30}])", "");
  const auto error = reader.forbids({change("static_node_id", 30)});
  REQUIRE(error);
  CHECK(error->code == Code::out_of_range);
  CHECK_FALSE(reader.forbids({change("static_node_id", 11)})); // its own
  CHECK_FALSE(reader.forbids({change("static_node_id", 0)}));  // dynamic
  CHECK_FALSE(reader.forbids({change("static_node_id", 30, ChangeStatus::unchanged)}));
}
