#include "blactl/base/text.hpp"
#include "blactl/bla/value.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"

#include <limits>

using namespace blactl;
using namespace blactl::bla;

namespace {

/// What blactl makes of a value given by name: "900", "0/mode 1", or "[code] message | hint".
std::string by(NamedBy named, std::string_view parameter, std::string_view text) {
  const auto value = parse_value(test::parameter(parameter), named, text);
  if (!value) {
    return '[' + std::string(name(value.error().code)) + "] " + value.error().message + " | " +
           value.error().hint;
  }
  return std::to_string(value->raw) +
         (value->pwm_mode ? "/mode " + std::to_string(*value->pwm_mode) : "");
}

std::string by_name(std::string_view parameter, std::string_view text) {
  return by(NamedBy::name, parameter, text);
}

std::string by_address(std::string_view parameter, std::string_view text) {
  return by(NamedBy::address, parameter, text);
}

std::string code_of(std::string_view parameter, std::string_view text) {
  const auto value = parse_value(test::parameter(parameter), NamedBy::name, text);
  REQUIRE_FALSE(value);
  CHECK_FALSE(value.error().message.empty());
  CHECK_FALSE(value.error().hint.empty());
  return std::string(name(value.error().code));
}

} // namespace

TEST_CASE("values with a unit are exact") {
  CHECK(by_name("angle_limit_cw", "90deg") == "900");
  CHECK(by_name("angle_limit_cw", "179.9deg") == "1799");
  CHECK(by_name("angle_limit_cw", "179.90deg") == "1799");
  CHECK(by_name("angle_limit_cw", "90°") == "900");
  CHECK(by_name("angle_limit_cw", "-22.5°") == by_name("angle_limit_cw", "-22.5deg"));
  CHECK(by_name("angle_limit_cw", "0179.9000000000000000000000000deg") == "1799");
  CHECK(by_name("angle_limit_ccw", "-45.5deg") == "-455");
  CHECK(by_name("angle_limit_ccw", "-0.0deg") == "0");
  CHECK(by_name("voltage_limit_high", "24.0V") == "240");
  CHECK(by_name("overcurrent_limit", "6.3A") == "63");
  CHECK(by_name("torque_limit_cw", "80%") == "80");
  CHECK(by_name("angle_boost", "2.5%") == "25");
  CHECK(by_name("pwm_neutral", "1520us") == "1520");
  CHECK(by_name("speed_limit_cw", "60rpm") == "60");
  CHECK(by_name("speed_limit_cw", "60.0rpm") == "60");
  CHECK(by_name("temperature_limit_low", "-40degC") == "-40");
}

TEST_CASE("three time units serve every time register") {
  CHECK(by_name("timeout_time", "1500ms") == "1500");
  CHECK(by_name("timeout_time", "1.5s") == "1500");
  CHECK(by_name("timeout_time", "2000us") == "2");
  CHECK(by_name("pwm_neutral", "1.52ms") == "1520");
  CHECK(by_name("pwm_neutral", "0.00152s") == "1520");
  CHECK(code_of("timeout_time", "1500us") == "usage");
  CHECK(code_of("timeout_time", "0.0005s") == "usage");
  CHECK(code_of("pwm_neutral", "1.5205ms") == "usage");
}

TEST_CASE("raw is the register's number, by name and by address") {
  CHECK(by_name("angle_limit_cw", "900raw") == "900");
  CHECK(by_name("angle_limit_ccw", "-900raw") == "-900");
  CHECK(by_address("angle_limit_cw", "900raw") == "900");
  CHECK(by_name("torque_output", "1raw") == "1");
  CHECK(code_of("angle_limit_cw", "90.5raw") == "usage");
  CHECK(code_of("angle_limit_cw", "90.0raw") == "usage");
}

TEST_CASE("a bare integer is the register's number by address") {
  CHECK(by_address("angle_limit_cw", "900") == "900");
  CHECK(by_address("pwm_output_range", "700") == "700");
  CHECK(by_address("angle_limit_cw", "90.5").starts_with("[usage]"));
}

TEST_CASE("a bare integer by name serves where the register counts whole units") {
  CHECK(by_name("speed_limit_cw", "60") == "60");
  CHECK(by_name("torque_limit_ccw", "-80") == "-80");
  CHECK(by_name("timeout_time", "1000") == "1000");
  CHECK(by_name("pwm_neutral", "1520") == "1520");
  CHECK(by_name("temperature_limit_low", "-40") == "-40");
  CHECK(by_name("angle_p_gain", "40") == "40");
  CHECK(by_name("servo_id", "7") == "7");
  CHECK(by_name("speed_dead_band", "600") == "600");
  CHECK(code_of("angle_p_gain", "40.0") == "usage");
  CHECK(code_of("speed_limit_cw", "60.0") == "usage");
}

TEST_CASE("a bare number by name is refused where the register counts tenths") {
  for (const char* parameter :
       {"command_angle", "overcurrent_limit", "angle_dead_band", "angle_boost", "pwm_output_range",
        "angle_limit_cw", "angle_limit_ccw", "voltage_limit_high", "voltage_limit_low", "origin"}) {
    INFO(parameter);
    CHECK(code_of(parameter, "90") == "usage");
    CHECK(code_of(parameter, "90.0") == "usage");
  }
  CHECK(by_name("angle_limit_cw", "90") ==
        "[usage] angle_limit_cw=90: the unit is missing | "
        "type angle_limit_cw=90deg (900raw) or angle_limit_cw=90raw (9.0deg)");
  CHECK(by_name("voltage_limit_low", "3.5") ==
        "[usage] voltage_limit_low=3.5: the unit is missing | "
        "type voltage_limit_low=3.5V (35raw)");
  CHECK(by_name("origin", "-45") == "[usage] origin=-45: the unit is missing | "
                                    "type origin=-45deg (-450raw) or origin=-45raw (-4.5deg)");
  CHECK(by_name("pwm_output_range", "70") ==
        "[usage] pwm_output_range=70: the unit is missing | "
        "type pwm_output_range=70deg (700raw) or pwm_output_range=70rpm (70raw)");
}

TEST_CASE("0x36 takes degrees or rpm, and says which 0x37 that needs") {
  CHECK(by_name("pwm_output_range", "70deg") == "700/mode 0");
  CHECK(by_name("pwm_output_range", "70.0deg") == "700/mode 0");
  CHECK(by_name("pwm_output_range", "150rpm") == "150/mode 1");
  CHECK(by_name("pwm_output_range", "700raw") == "700");
  CHECK(code_of("pwm_output_range", "70.5rpm") == "usage");
}

TEST_CASE("what a register cannot hold exactly is refused with the neighbours") {
  CHECK(by_name("angle_limit_cw", "90.05deg") ==
        "[usage] angle_limit_cw=90.05deg: the register counts in steps of 0.1deg | "
        "type angle_limit_cw=90.0deg or angle_limit_cw=90.1deg");
  CHECK(by_name("angle_limit_ccw", "-90.05deg") ==
        "[usage] angle_limit_ccw=-90.05deg: the register counts in steps of 0.1deg | "
        "type angle_limit_ccw=-90.0deg or angle_limit_ccw=-90.1deg");
  CHECK(by_name("angle_limit_cw", "0.00000000000000000000000000001deg") ==
        "[usage] angle_limit_cw=0.00000000000000000000000000001deg: "
        "the register counts in steps of 0.1deg | "
        "type angle_limit_cw=0.0deg or angle_limit_cw=0.1deg");
  CHECK(by_name("timeout_time", "1500us") ==
        "[usage] timeout_time=1500us: the register counts in steps of 1ms | "
        "type timeout_time=1ms or timeout_time=2ms");
  CHECK(code_of("angle_limit_cw", "90.05") == "usage");
}

TEST_CASE("numbers have one form and no other") {
  for (const char* text :
       {"",         "-",        "+90deg",   "+90",       "--90deg", ".5deg",  "5.deg", "5.",
        "-.5deg",   "90 deg",   " 90deg",   "90deg ",    "1e2deg",  "1e2",    "0x10",  "0x10raw",
        "1,000deg", "1_000deg", "1'000deg", "90.1.1deg", "deg",     "raw",    "inf",   "nan",
        "NaN",      "90d eg",   "９０deg",  "90\xC2",    "90deg\n", "1/2deg", "90\xFF"}) {
    INFO(text);
    CHECK(code_of("angle_limit_cw", text) == "usage");
    CHECK(code_of("angle_p_gain", text) == "usage");
    CHECK(code_of("torque_output", text) == "usage");
  }
  CHECK(by_name("angle_limit_cw", "+90deg") ==
        "[usage] angle_limit_cw=+90deg: not a number | "
        "a number is written [-]digits[.digits]unit, for example angle_limit_cw=179.9deg");
}

TEST_CASE("foreign bytes in a value do not reach the terminal") {
  const std::string text = by_name("angle_limit_cw", "\x1B[31m\xFF");
  CHECK(text.find('\x1B') == std::string::npos);
  CHECK(text.find("\\x1b[31m\\xff") != std::string::npos);
}

TEST_CASE("units are case-sensitive and those of the register") {
  CHECK(code_of("angle_limit_cw", "90DEG") == "usage");
  CHECK(code_of("angle_limit_cw", "90RAW") == "usage");
  CHECK(code_of("voltage_limit_high", "24v") == "usage");
  CHECK(code_of("timeout_time", "1S") == "usage");
  CHECK(code_of("angle_p_gain", "40%") == "usage");
  CHECK(by_name("angle_limit_cw", "90rpm") ==
        "[usage] angle_limit_cw=90rpm: the unit rpm does not fit, this parameter takes deg | "
        "for example angle_limit_cw=179.9deg");
  CHECK(by_name("timeout_time", "1deg") ==
        "[usage] timeout_time=1deg: the unit deg does not fit, this parameter takes ms, s or us | "
        "for example timeout_time=1000ms");
  CHECK(by_name("servo_id", "7deg") ==
        "[usage] servo_id=7deg: this parameter has no unit | for example servo_id=0");
}

TEST_CASE("enumerations take word or number") {
  CHECK(by_name("torque_output", "on") == "0");
  CHECK(by_name("torque_output", "OFF") == "1");
  CHECK(by_name("torque_output", "Brake") == "2");
  CHECK(by_name("torque_output", "2") == "2");
  CHECK(by_address("torque_output", "brake") == "2");
  CHECK(by_name("timeout_action", "hold") == "0");
  CHECK(by_name("pwm_mode", "speed") == "1");
  CHECK(by_name("reverse", "on") == "1");
  CHECK(by_name("torque_output", "free") ==
        "[usage] torque_output=free: unknown word, this parameter takes "
        "on (0), off (1) or brake (2) | for example torque_output=on");
  CHECK(by_name("torque_output", "3") ==
        "[out_of_range] torque_output=3: there is no such setting, this parameter takes "
        "on (0), off (1) or brake (2) | for example torque_output=on");
  for (const char* text : {"true", "false", "yes", "no", "on ", "ＯＮ", "1.0", "1x"}) {
    INFO(text);
    CHECK(code_of("reverse", text) == "usage");
  }
  CHECK(code_of("reverse", "-1") == "out_of_range");
  CHECK(code_of("reverse", "2raw") == "out_of_range");
}

TEST_CASE("numbers beyond 64 bits are out of range, not wrapped") {
  for (const char* text :
       {"9223372036854775808raw", "99999999999999999999raw", "-99999999999999999999raw",
        "922337203685477581deg", "99999999999999999999999999999999deg"}) {
    INFO(text);
    CHECK(code_of("angle_limit_cw", text) == "out_of_range");
  }
  CHECK(code_of("angle_limit_cw", "99999999999999999999") == "out_of_range");
  CHECK(by_address("angle_limit_cw", "99999999999999999999").starts_with("[out_of_range]"));
  CHECK(by_name("angle_limit_cw", "9223372036854775807raw") == "9223372036854775807");
  CHECK(by_name("angle_limit_cw", "000000000000000000000000000090deg") == "900");
}

TEST_CASE("a value outside of the range is refused with the range in units") {
  const auto refused = [](std::string_view parameter, std::int64_t raw) {
    const auto result = check_range(test::parameter(parameter), raw);
    REQUIRE_FALSE(result);
    CHECK(result.error().code == Code::out_of_range);
    return result.error().message + " | " + result.error().hint;
  };
  CHECK(refused("origin", 1800) == "origin=180.0deg: outside of the range -180.0deg to 179.9deg | "
                                   "type a value from -180.0deg to 179.9deg");
  CHECK(refused("timeout_time", 0) == "timeout_time=0ms: outside of the range 1ms to 60000ms | "
                                      "type a value from 1ms to 60000ms");
  const Parameter& neutral = *test::model("BLA21-12U-A0").find(Address(0x34));
  const auto only = check_range(neutral, 1520);
  REQUIRE_FALSE(only);
  CHECK(only.error().message == "pwm_neutral=1520us: only 0us is possible");
  CHECK(check_range(test::parameter("origin"), -1800));
  CHECK(check_range(test::parameter("origin"), 1799));
}

TEST_CASE("values are shown in their unit") {
  const Parameter& angle = test::parameter("angle_limit_cw");
  CHECK(value_text(angle, 900) == "90.0");
  CHECK(value_text(angle, -5) == "-0.5");
  CHECK(value_text(angle, 0) == "0.0");
  CHECK(value_text(angle, -360'000'000) == "-36000000.0");
  CHECK(unit_text(angle) == "deg");
  CHECK(display(angle, 900) == "90.0 deg");
  CHECK(input_text(angle, 900) == "90.0deg");
  CHECK(display(test::parameter("torque_output"), 2) == "brake");
  CHECK(value_text(test::parameter("torque_output"), 2) == "2");
  CHECK(input_text(test::parameter("torque_output"), 2) == "brake");
  CHECK(display(test::parameter("torque_output"), 9) == "9");
  CHECK(display(test::parameter("angle_p_gain"), 40) == "40");
  CHECK(display(test::parameter("torque_limit_cw"), 100) == "100 %");
  CHECK(display(test::parameter("model_number"), 61) == "BLA21");
  CHECK(display(test::parameter("production_year"), 2020) == "2020");
  CHECK(display(test::parameter("firmware_version"), 1400) == "1.400");
  CHECK(value_text(angle, std::numeric_limits<std::int64_t>::max()) == "922337203685477580.7");
  CHECK(value_text(angle, std::numeric_limits<std::int64_t>::min()) == "-922337203685477580.8");
}

TEST_CASE("0x36 is shown by 0x37, else as the register's number") {
  const Parameter& range = test::parameter("pwm_output_range");
  CHECK(display(range, 700) == "700");
  CHECK(display(range, 700, 0) == "70.0 deg");
  CHECK(display(range, 700, 1) == "700 rpm");
  CHECK(input_text(range, 700) == "700raw");
  CHECK(input_text(range, 700, 0) == "70.0deg");
  CHECK(input_text(range, 700, 1) == "700rpm");
}

TEST_CASE("555,555,555 in 0x00-0x02 is never shown as a number", "[requirement-115]") {
  for (const char* parameter : {"command_angle", "command_speed", "command_torque"}) {
    const Parameter& command = test::parameter(parameter);
    CHECK(display(command, not_active) == "not active");
    CHECK(value_text(command, not_active).empty());
    CHECK_FALSE(check_range(command, not_active));
  }
  set_language(Language::japanese);
  CHECK(display(test::parameter("command_angle"), not_active) == "無効 (他種の指令中)");
  set_language(Language::english);
}

TEST_CASE("refusals are told in Japanese too") {
  set_language(Language::japanese);
  const std::string text = by_name("angle_limit_cw", "90");
  set_language(Language::english);
  CHECK(text ==
        "[usage] angle_limit_cw=90: 単位がありません | angle_limit_cw=90deg (900raw) または "
        "angle_limit_cw=90raw (9.0deg) と入力して下さい");
}
