#include "blactl/bla/cross_check.hpp"
#include "blactl/bla/fault_bits.hpp"
#include "blactl/bla/parameter.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::bla;
using test::built_in;
using test::parameter;

namespace {

/// What a servo holds in the registers that may_move() looks at.
const Values at_rest{
    {address::current_angle, 450},      {address::command_angle, 450},
    {address::angle_limit_cw, 1500},    {address::angle_limit_ccw, -1500},
    {address::current_temperature, 40}, {address::current_voltage, 120},
    {address::fault_warning, 0},        {address::fault_notice, 1 << 20}}; // no PWM at the input

Values with(Address address, std::int64_t raw) {
  Values values = at_rest;
  values[address] = raw;
  return values;
}

bool moves(Address address, std::int64_t requested, const Values& now) {
  static const Identity nobody;
  return may_move({address, requested, now, now, nobody});
}

bool moves(const char* name, std::int64_t requested, const Values& now = at_rest) {
  return moves(parameter(name).address, requested, now);
}

/// Whether writing a register moves the servo: whatever the value and state, never, or it depends.
enum class Moves : std::uint8_t { always, never, depends };

struct Row {
  std::uint8_t address;
  Moves moves;
  bool by_values = false; ///< of other registers: what is not known is the worst
};

using enum Moves;

/// Every register that can be written (tables 3-1 to 3-8), and contract, section 4.
const std::vector<Row> table{
    {0x00, always},
    {0x01, always},
    {0x02, always},
    {0x20, always}, // torque_output
    {0x21, never},  // soft_start
    {0x22, never},  // smoothing
    {0x23, always}, // reverse
    {0x24, always}, // extended_angle
    {0x25, always}, // speed_torque_control
    {0x26, always}, // timeout_action
    {0x27, always}, // timeout_time
    {0x2A, never},  // overcurrent_limit
    {0x2C, never},  // gains
    {0x2D, never},
    {0x2E, never},
    {0x2F, never},
    {0x30, never},
    {0x31, never},
    {0x32, never},
    {0x33, never},
    {0x34, depends, true}, // PWM mapping: is there PWM?
    {0x35, depends, true},
    {0x36, depends, true},
    {0x37, depends, true},
    {0x38, depends, true}, // angle limits: where is the shaft, where to?
    {0x39, depends, true},
    {0x3A, never}, // speed limits
    {0x3B, never},
    {0x3C, depends}, // torque limits: 0 lets go
    {0x3D, depends},
    {0x3E, depends, true}, // temperature limits: does one hold the motor
                           // off?
    {0x3F, depends, true},
    {0x40, depends, true}, // voltage limits
    {0x41, depends, true},
    {0x44, always}, // origin
    {0x45, never},  // IDs
    {0x46, never},
};

/// The states of a servo: at rest, hot, with PWM, and one of which nothing is known.
std::vector<Values> states() {
  return {at_rest, with(address::current_temperature, 99), with(address::fault_notice, 0),
          with(address::current_angle, -1799), Values{}};
}

} // namespace

TEST_CASE("the table has every register that can be written, and none beside") {
  std::vector<std::uint8_t> writable;
  for (const Parameter& each : built_in().registers()) {
    if (each.writable() && each.address < Address(0x49) &&
        (each.address < Address(0x10) || each.address > Address(0x12))) {
      writable.push_back(each.address.value());
    }
  }
  std::vector<std::uint8_t> listed;
  for (const Row& row : table) {
    listed.push_back(row.address);
  }
  CHECK(listed == writable);
}

TEST_CASE("what can move the shaft or let go of the load is asked, whatever value and state") {
  for (const Row& row : table) {
    INFO(Address(row.address).name());
    for (const Values& now : states()) {
      for (const std::int64_t requested : {-1, 0, 1, 1000}) {
        const bool asked = moves(Address(row.address), requested, now);
        CHECK((asked || row.moves != Moves::always));
        CHECK((!asked || row.moves != Moves::never));
      }
    }
  }
}

TEST_CASE("what is needed for the judgement and is not known counts as the worst") {
  for (const Row& row : table) {
    INFO(Address(row.address).name());
    CHECK(moves(Address(row.address), 10, {}) == (row.by_values || row.moves == Moves::always));
  }
}

TEST_CASE("an angle limit is asked if the shaft stands beyond it") {
  CHECK(moves("angle_limit_cw", 449));
  CHECK_FALSE(moves("angle_limit_cw", 450));
  CHECK_FALSE(moves("angle_limit_cw", 900));
  CHECK(moves("angle_limit_ccw", 451));
  CHECK_FALSE(moves("angle_limit_ccw", 450));
  CHECK_FALSE(moves("angle_limit_ccw", -900));
}

TEST_CASE("a wider angle limit is asked if it lets a command go on that is still there") {
  Values held = with(address::command_angle, 1700); // the shaft waits at 150 deg
  held[address::current_angle] = 1500;
  CHECK(moves("angle_limit_cw", 1501, held));
  CHECK(moves("angle_limit_cw", 1799, held));
  CHECK_FALSE(moves("angle_limit_cw", 1500, held)); // as it is
  CHECK_FALSE(moves("angle_limit_ccw", -1799, held));
  held[address::command_angle] = -1700;
  held[address::current_angle] = -1500;
  CHECK(moves("angle_limit_ccw", -1501, held));
  CHECK_FALSE(moves("angle_limit_ccw", -1500, held));
  CHECK_FALSE(moves("angle_limit_cw", 1799, held));
  held[address::command_angle] = 0; // nothing waits
  CHECK_FALSE(moves("angle_limit_ccw", -1799, held));
  held[address::command_angle] = not_active;
  CHECK_FALSE(moves("angle_limit_ccw", -1799, held));
}

TEST_CASE("an angle limit is asked where the command or the limit of now is not known") {
  for (const Address unknown : {address::command_angle, address::angle_limit_cw}) {
    Values held = at_rest;
    held.erase(unknown);
    CHECK(moves("angle_limit_cw", 1600, held));
  }
}

TEST_CASE("a protection that holds the motor off is asked before it is ended") {
  struct Case {
    const char* name;
    std::int64_t warning, ending, tripping;
  };

  // At 40 degrees and 12.0 V.
  const auto each = GENERATE(values<Case>({
      {"temperature_limit_high", fault::temperature_high, 41, 40},
      {"temperature_limit_low", fault::temperature_low, 39, 40},
      {"voltage_limit_high", fault::voltage_high, 121, 120},
      {"voltage_limit_low", fault::voltage_low, 119, 120},
  }));
  INFO(each.name);
  const Values held = with(address::fault_warning, each.warning);
  CHECK(moves(each.name, each.ending, held));
  CHECK(moves(each.name, each.tripping, held));
  CHECK_FALSE(moves(each.name, each.ending)); // none is active
  const std::int64_t others = ~each.warning;
  CHECK_FALSE(moves(each.name, each.ending, with(address::fault_warning, others)));
  Values unknown = at_rest;
  unknown.erase(address::fault_warning);
  CHECK(moves(each.name, each.ending, unknown));
}

TEST_CASE("a torque limit is asked if it is 0") {
  for (const char* name : {"torque_limit_cw", "torque_limit_ccw"}) {
    for (const Values& now : states()) {
      CHECK(moves(name, 0, now));
      CHECK_FALSE(moves(name, 1, now));
      CHECK_FALSE(moves(name, -1, now));
    }
  }
}

TEST_CASE("a limit of temperature or voltage is asked if it trips at once") {
  CHECK(moves("temperature_limit_high", 40));
  CHECK_FALSE(moves("temperature_limit_high", 41));
  CHECK(moves("temperature_limit_low", 40));
  CHECK_FALSE(moves("temperature_limit_low", 39));
  CHECK(moves("voltage_limit_high", 120));
  CHECK_FALSE(moves("voltage_limit_high", 121));
  CHECK(moves("voltage_limit_low", 120));
  CHECK_FALSE(moves("voltage_limit_low", 119));
}

TEST_CASE("the PWM mapping is asked if there is PWM at the input") {
  for (const char* name : {"pwm_neutral", "pwm_range", "pwm_output_range", "pwm_mode"}) {
    INFO(name);
    CHECK_FALSE(moves(name, 1));
    CHECK(moves(name, 1, with(address::fault_notice, 1 << 21))); // a pulse, but too short
    CHECK(moves(name, 1, with(address::fault_notice, 0)));
  }
}

namespace {

/// A servo of this model and firmware.
Identity servo_of(const char* model = "BLA21-12U-AB", std::int64_t firmware = 1400) {
  const Profile& profile = *built_in().matching(model).front();
  return {built_in(), {profile.model_number, 1, firmware, profile.hardware_version}};
}

/// What a servo holds by default, at rest.
Values configured(const Identity& servo) {
  Values values = *servo.factory_defaults();
  values.insert(at_rest.begin(), at_rest.end());
  values[address::command_speed] = not_active;
  values[address::command_torque] = not_active;
  return values;
}

struct Case {
  const char* code;
  const char* name; ///< of the register that is changed
  std::int64_t requested;
  bool fires;
  std::vector<std::pair<const char*, std::int64_t>> beside{}; ///< held, or changed with it
  const char* model = "BLA21-12U-AB";
  std::int64_t firmware = 1400;
};

const std::vector<Case> cases{
    {"control_off", "command_speed", 60, true},
    {"control_off", "command_torque", 0, true},
    {"control_off", "command_speed", 60, false, {{"speed_torque_control", 1}}},
    {"control_off", "command_angle", 60, false},

    {"no_stop", "command_speed", 60, true, {{"timeout_action", 0}}},
    {"no_stop", "command_torque", -1, true, {{"timeout_action", 0}}},
    {"no_stop", "command_speed", 0, false, {{"timeout_action", 0}}}, // it stops
    {"no_stop", "command_speed", 60, false, {{"timeout_action", 2}}},
    {"no_stop", "command_angle", 60, false, {{"timeout_action", 0}}}, // it ends at the angle
    {"no_stop", "timeout_action", 0, true, {{"command_speed", 60}}},
    {"no_stop", "timeout_action", 0, true, {{"command_torque", 20}}},
    {"no_stop", "timeout_action", 0, false, {{"command_speed", 0}}},
    {"no_stop", "timeout_action", 0, false}, // none is active
    {"no_stop", "timeout_action", 1, false, {{"command_speed", 60}}},

    {"temperature_limits_reversed",
     "temperature_limit_high",
     20,
     true,
     {{"temperature_limit_low", 20}}},
    {"temperature_limits_reversed",
     "temperature_limit_low",
     20,
     true,
     {{"temperature_limit_high", 20}}},
    {"temperature_limits_reversed",
     "temperature_limit_low",
     19,
     false,
     {{"temperature_limit_high", 20}}},
    {"voltage_limits_reversed", "voltage_limit_high", 100, true, {{"voltage_limit_low", 101}}},
    {"voltage_limits_reversed", "voltage_limit_high", 100, false, {{"voltage_limit_low", 99}}},
    {"voltage_limits_reversed", "voltage_limit_low", 100, true, {{"voltage_limit_high", 100}}},

    {"pwm_cut_off", "pwm_output_range", 1400, true, {{"angle_limit_cw", 1399}}},
    {"pwm_cut_off", "pwm_output_range", 1400, true, {{"angle_limit_ccw", -1399}}},
    {"pwm_cut_off", "pwm_output_range", 1400, false, {{"angle_limit_cw", 1400}}},
    {"pwm_cut_off", "angle_limit_cw", 699, true, {{"pwm_output_range", 700}}},
    {"pwm_cut_off", "angle_limit_ccw", -700, false, {{"pwm_output_range", 700}}},
    {"pwm_cut_off", "pwm_mode", 0, true, {{"pwm_output_range", 1800}}},
    {"pwm_cut_off", "angle_limit_cw", 10, false, {{"pwm_mode", 1}, {"pwm_output_range", 150}}},
    {"pwm_cut_off", "angle_limit_cw", 10, false, {}, "BLA15-06U-A0"}, // it has no PWM input

    {"pwm_needs_switch", "pwm_mode", 1, true},
    {"pwm_needs_switch", "pwm_mode", 1, false, {{"speed_torque_control", 1}}},
    {"pwm_needs_switch", "pwm_mode", 0, false},
    {"pwm_needs_switch", "speed_torque_control", 0, true, {{"pwm_mode", 1}}},
    {"pwm_needs_switch", "speed_torque_control", 1, false, {{"pwm_mode", 1}}},

    {"pwm_speed_limited",
     "pwm_output_range",
     151,
     true,
     {{"pwm_mode", 1}, {"speed_limit_cw", 150}}},
    {"pwm_speed_limited",
     "pwm_output_range",
     150,
     false,
     {{"pwm_mode", 1}, {"speed_limit_cw", 150}}},
    {"pwm_speed_limited",
     "speed_limit_ccw",
     -99,
     true,
     {{"pwm_mode", 1}, {"pwm_output_range", 100}}},
    {"pwm_speed_limited",
     "speed_limit_ccw",
     -100,
     false,
     {{"pwm_mode", 1}, {"pwm_output_range", 100}}},
    {"pwm_speed_limited", "speed_limit_cw", 10, false}, // the mode is angle

    {"no_motion", "angle_limit_cw", 0, true, {{"angle_limit_ccw", 0}}},
    {"no_motion", "angle_limit_cw", 0, false},
    {"no_motion", "pwm_range", 10, false},
    {"no_motion", "pwm_output_range", 0, true},

    {"pwm_below_zero", "pwm_range", 1521, true},
    {"pwm_below_zero", "pwm_range", 1520, false},
    {"pwm_below_zero", "pwm_neutral", 699, true},
    {"pwm_below_zero", "pwm_neutral", 700, false},

    {"dead_band_zero", "angle_dead_band", 0, true},
    {"dead_band_zero", "angle_dead_band", 1, false},

    {"near_supply", "voltage_limit_high", 124, true}, // of 12.0 V
    {"near_supply", "voltage_limit_high", 125, false},
    {"near_supply", "voltage_limit_high", 120, false}, // that trips: it is asked
    {"near_supply", "voltage_limit_low", 116, true},
    {"near_supply", "voltage_limit_low", 115, false},

    {"servo_id_of_all", "servo_id", 0, true},
    {"servo_id_of_all", "servo_id", 1, false},
    {"timeout_short", "timeout_time", 99, true},
    {"timeout_short", "timeout_time", 100, false},

    {"leave_at_default", "speed_p_gain", 7, true},
    {"leave_at_default", "angle_p_gain", 7, false},

    {"hard_start", "soft_start", 0, true},
    {"hard_start", "torque_output", 0, true, {{"soft_start", 0}}},
    {"hard_start", "soft_start", 0, false, {{"torque_output", 1}}},
    {"hard_start", "soft_start", 1, false},
    {"hard_start", "torque_output", 0, false},

    {"low_speed_stall", "command_speed", 10, true, {}, "BLA21-12U-AB", 1300},
    {"low_speed_stall", "speed_torque_control", 1, true, {}, "BLA15-06U-A0", 1300},
    {"low_speed_stall", "pwm_mode", 1, true, {}, "BLA21-12U-AB", 1300},
    {"low_speed_stall", "pwm_mode", 0, false, {}, "BLA21-12U-AB", 1300},
    {"low_speed_stall", "command_speed", 0, false, {}, "BLA21-12U-AB", 1300},
    {"low_speed_stall", "command_speed", 10, false},
    {"low_speed_stall", "pwm_mode", 1, false, {}, "BLA34", 1500},

    {"limits_without_effect", "speed_limit_cw", 5, true},
    {"limits_without_effect", "torque_limit_ccw", -10, true},
    {"limits_without_effect", "speed_limit_cw", 5, false, {{"speed_torque_control", 1}}},
    {"limits_without_effect", "speed_limit_cw", 5, false, {}, "BLA21-12U-AB", 1010},
    {"limits_without_effect", "speed_limit_cw", 300, false}, // as from the factory
    {"limits_without_effect", "speed_limit_cw", 300, true, {}, "BLA15-06U-A0"},
    {"limits_without_effect", "speed_torque_control", 0, true, {{"torque_limit_cw", 99}}},
    {"limits_without_effect", "speed_torque_control", 0, false},
    {"limits_without_effect", "speed_torque_control", 1, false, {{"torque_limit_cw", 99}}},
    {"limits_without_effect", "command_angle", 60, true, {{"speed_limit_ccw", -20}}},
    {"limits_without_effect", "command_angle", 60, false},

    {"always_asked", "torque_output", 1, true},
    {"always_asked", "smoothing", 0, false},
    {"soft_start_ends", "torque_output", 1, true, {{"command_angle", 0}}}, // it is at 45.0 deg
    {"soft_start_ends", "torque_output", 1, false, {{"command_angle", 0}, {"current_angle", -10}}},
    {"soft_start_ends", "torque_output", 1, false, {{"command_angle", 450}}},
    {"soft_start_ends", "torque_output", 1, false, {{"command_angle", 0}, {"soft_start", 0}}},
    {"soft_start_ends", "torque_output", 0, false, {{"command_angle", 0}, {"torque_output", 1}}},
    {"pulled_back", "angle_limit_cw", 449, true}, // it is at 45.0 deg
    {"pulled_back", "angle_limit_cw", 450, false},
    {"let_go_on",
     "angle_limit_cw",
     1600,
     true,
     {{"command_angle", 1550}, {"angle_limit_cw", 1500}}},
    {"let_go_on", "angle_limit_cw", 1600, false},
    {"no_torque", "torque_limit_cw", 0, true, {{"speed_torque_control", 1}}},
    {"no_torque", "torque_limit_cw", 1, false, {{"speed_torque_control", 1}}},
    {"no_torque", "torque_limit_cw", 0, false}, // the limits are switched off
    {"no_torque", "torque_limit_cw", 0, true, {}, "BLA21-12U-AB", 1010}, // it has no switch
    {"no_torque", "speed_torque_control", 1, true, {{"torque_limit_ccw", 0}}},
    {"no_torque", "speed_torque_control", 1, false},
    {"no_torque", "speed_torque_control", 0, false, {{"torque_limit_ccw", 0}}},
    {"no_torque_later", "torque_limit_ccw", 0, true},
    {"no_torque_later", "torque_limit_ccw", -1, false},
    {"no_torque_later", "torque_limit_ccw", 0, false, {{"speed_torque_control", 1}}},
    {"temperature_trips", "temperature_limit_high", 40, true}, // it is at 40 degC
    {"temperature_trips", "temperature_limit_high", 41, false},
    {"temperature_released", "temperature_limit_high", 41, true, {{"fault_warning", 1 << 8}}},
    {"temperature_released", "temperature_limit_high", 40, true, {{"fault_warning", 1 << 8}}},
    {"temperature_released", "temperature_limit_high", 39, false, {{"fault_warning", 1 << 8}}},
    {"temperature_released", "temperature_limit_high", 41, false},
    {"voltage_trips", "voltage_limit_low", 120, true}, // it is at 12.0 V
    {"voltage_trips", "voltage_limit_low", 119, false},
    {"voltage_released", "voltage_limit_low", 119, true, {{"fault_warning", 1 << 11}}},
    {"voltage_released", "voltage_limit_low", 119, false, {{"fault_warning", 1 << 10}}},
    {"pwm_present", "pwm_neutral", 1500, true, {{"fault_notice", 0}}},
    {"pwm_present", "pwm_neutral", 1500, false},
};

/// The codes of the checks that the change of a case meets.
std::vector<std::string_view> codes_met(const Case& each) {
  const Identity servo = servo_of(each.model, each.firmware);
  Values before = configured(servo);
  for (const auto& [name, raw] : each.beside) {
    before[parameter(name).address] = raw;
  }
  Values after = before;
  const Address address = parameter(each.name).address;
  after[address] = each.requested;
  std::vector<std::string_view> codes;
  for (const CheckKind kind : {CheckKind::refusal, CheckKind::question, CheckKind::warning}) {
    for (const CrossCheck* check : met(kind, {address, each.requested, before, after, servo})) {
      codes.push_back(check->code);
    }
  }
  return codes;
}

} // namespace

TEST_CASE("each cross-check fires where it must, and nowhere else") {
  for (const Case& each : cases) {
    INFO(each.code << " " << each.name << "=" << each.requested);
    const auto codes = codes_met(each);
    CHECK((std::ranges::find(codes, each.code) != codes.end()) == each.fires);
  }
}

TEST_CASE("of each cross-check a case is tested that fires, and one that does not") {
  for (const CrossCheck& check : cross_checks()) {
    INFO(check.code);
    for (const bool fires : {true, false}) {
      CHECK(std::ranges::any_of(
          cases, [&](const Case& each) { return each.code == check.code && each.fires == fires; }));
    }
  }
}

TEST_CASE("what a cross-check looks at is read first") {
  for (const Case& each : cases) {
    INFO(each.code << " " << each.name);
    const auto needed = values_needed(parameter(each.name).address);
    for (const auto& [name, raw] : each.beside) {
      const Address address = parameter(name).address;
      const bool looks = each.fires && address != parameter(each.name).address;
      CHECK((!looks || std::ranges::find(needed, address) != needed.end()));
    }
  }
}

TEST_CASE("what is not known makes a warning or a refusal of nothing") {
  const Identity nobody;
  for (const CrossCheck& check : cross_checks()) {
    INFO(check.code);
    for (const Address address : check.of) {
      const bool fires = check.fires({address, 500, {}, {}, nobody});
      CHECK((!fires || check.kind == CheckKind::question));
    }
  }
}

TEST_CASE("a cross-check has its own code, and a reason in both languages") {
  std::set<std::string_view> codes;
  for (const CrossCheck& check : cross_checks()) {
    INFO(check.code);
    CHECK(codes.insert(check.code).second);
    CHECK_FALSE(std::string_view(check.reason.en).empty());
    CHECK_FALSE(std::string_view(check.reason.ja).empty());
    CHECK(check.remedy.empty() ==
          (check.kind != CheckKind::refusal || check.code.ends_with("_reversed")));
  }
}
