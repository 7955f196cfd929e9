#include "blactl/bla/effect.hpp"
#include "blactl/bla/fault_bits.hpp"
#include "blactl/bla/parameter.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"

#include <cstdint>
#include <optional>
#include <string>
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

bool moves(const char* name, std::int64_t requested, const Values& now = at_rest) {
  return may_move(parameter(name).address, requested, now);
}

/// Whether writing a register moves the servo: whatever the value and state, never, or it depends.
enum class Moves : std::uint8_t { always, never, depends };

struct Row {
  std::uint8_t address;
  Moves moves;
  std::vector<std::uint8_t> needs{};
};

using enum Moves;

/// Every register that can be written (tables 3-1 to 3-8), and contract, section 4.
const std::vector<Row> table{
    {0x00, always},
    {0x01, always, {0x25}}, // speed and torque: does it take them?
    {0x02, always, {0x25}},
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
    {0x34, depends, {0x19}}, // PWM mapping: is there PWM?
    {0x35, depends, {0x19}},
    {0x36, depends, {0x19}},
    {0x37, depends, {0x19}},
    {0x38, depends, {0x08, 0x00, 0x38}}, // angle limits: where is the shaft, where to?
    {0x39, depends, {0x08, 0x00, 0x39}},
    {0x3A, never}, // speed limits
    {0x3B, never},
    {0x3C, depends}, // torque limits: 0 lets go
    {0x3D, depends},
    {0x3E, depends, {0x0B, 0x1A}}, // temperature limits: does one hold the motor off?
    {0x3F, depends, {0x0B, 0x1A}},
    {0x40, depends, {0x0C, 0x1A}}, // voltage limits
    {0x41, depends, {0x0C, 0x1A}},
    {0x44, always}, // origin
    {0x45, never},  // IDs
    {0x46, never},
};

std::vector<Address> addresses(const std::vector<std::uint8_t>& values) {
  std::vector<Address> all;
  for (const std::uint8_t value : values) {
    all.emplace_back(value);
  }
  return all;
}

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
    CHECK(values_needed(Address(row.address)) == addresses(row.needs));
    for (const Values& now : states()) {
      for (const std::int64_t requested : {-1, 0, 1, 1000}) {
        const bool moves = may_move(Address(row.address), requested, now);
        CHECK((moves || row.moves != Moves::always));
        CHECK((!moves || row.moves != Moves::never));
      }
    }
  }
}

TEST_CASE("what is needed for the judgement and is not known counts as the worst") {
  for (const Row& row : table) {
    INFO(Address(row.address).name());
    const bool rests_on_values = !row.needs.empty();
    CHECK(may_move(Address(row.address), 10, {}) ==
          (rests_on_values || row.moves == Moves::always));
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

TEST_CASE(
    "speed and torque are taken only with their control on, and nothing else needs a switch") {
  for (const Row& row : table) {
    INFO(Address(row.address).name());
    const bool needs = row.address == 0x01 || row.address == 0x02;
    CHECK(needs_on(Address(row.address)) ==
          (needs ? std::optional(address::speed_torque_control) : std::nullopt));
  }
}

TEST_CASE("the speed control is what should stay as the manufacturer made it") {
  for (const Row& row : table) {
    INFO(Address(row.address).name());
    const bool stays = should_stay_at_default(Address(row.address));
    CHECK(stays == (row.address >= 0x30 && row.address <= 0x33));
  }
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

TEST_CASE("a restart moves the shaft where torque is on, and softly where that is set") {
  constexpr int on = 0; // 0x20 counts upside down (4.13)
  constexpr int off = 1;
  const auto motion = [](std::int64_t torque, std::int64_t soft) {
    return restart_motion({{address::torque_output, torque}, {address::soft_start, soft}});
  };
  CHECK(motion(on, 0) == RestartMotion::hard);
  CHECK(motion(on, 1) == RestartMotion::soft);
  CHECK(motion(off, 0) == RestartMotion::none);
  CHECK(motion(off, 1) == RestartMotion::none);
  CHECK(restart_motion({{address::torque_output, off}}) == RestartMotion::none);
  CHECK(restart_motion({}) != RestartMotion::none); // it may be on
}
