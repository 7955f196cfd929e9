#include "blactl/bla/assignment.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"

using namespace blactl;
using namespace blactl::bla;
using test::built_in;

namespace {

Error refused(std::string_view text) {
  const auto assignment = parse_assignment(built_in(), text);
  INFO(text);
  REQUIRE_FALSE(assignment);
  CHECK_FALSE(assignment.error().hint.empty());
  return assignment.error();
}

std::string code_of(std::string_view text) {
  return std::string(name(refused(text).code));
}

std::expected<std::vector<Assignment>, std::vector<Error>> all(std::vector<std::string> texts) {
  return parse_assignments(built_in(), texts);
}

} // namespace

TEST_CASE("PARAM=VALUE is read by name and by address") {
  const auto by_name = parse_assignment(built_in(), "angle-limit-CW=90deg");
  REQUIRE(by_name);
  CHECK(by_name->parameter->address == Address(0x38));
  CHECK(by_name->named == NamedBy::name);
  CHECK(by_name->value.raw == 900);
  CHECK(by_name->text == "angle-limit-CW=90deg");
  const auto by_address = parse_assignment(built_in(), "0x38=900");
  REQUIRE(by_address);
  CHECK(by_address->named == NamedBy::address);
  CHECK(by_address->value.raw == 900);
  CHECK(parse_assignment(built_in(), "0x20=brake")->value.raw == 2);
  CHECK(make_assignment(built_in(), "servo_id", "7")->value.raw == 7);
}

TEST_CASE("what every servo refuses is refused at once, with the code of the contract") {
  CHECK(code_of("angle_limit_cw") == "usage");
  CHECK(code_of("angle_limit_cw=") == "usage");
  CHECK(code_of("angle_limit_cw=90") == "usage");
  CHECK(code_of("angle_limit_cw=90.05deg") == "usage");
  CHECK(code_of("angle_limit_cw==90deg") == "usage");
  CHECK(code_of("torque_output=yes") == "usage");
  CHECK(code_of("torque_output=3") == "out_of_range");
  CHECK(code_of("origin=180deg") == "out_of_range");
  CHECK(code_of("=5") == "unknown_parameter");
  CHECK(code_of("angle=5") == "unknown_parameter");
  CHECK(code_of("0x60=1") == "unknown_parameter");
  CHECK(code_of("0xFF=1") == "unknown_parameter");
  CHECK(code_of("0x28=1") == "unsupported");
  CHECK(code_of("0x49=1") == "unsupported");
  CHECK(code_of("bootloader=0") == "unsupported");
  CHECK(code_of("current_angle=0deg") == "read_only");
  CHECK(code_of("0x50=61") == "read_only");
  CHECK(code_of("firmware_version=nonsense") == "read_only");
}

TEST_CASE("no register that can only be read, and no reserved address, is ever assigned",
          "[requirement-79]") {
  const auto check = [](std::initializer_list<std::pair<int, int>> ranges, const char* code) {
    for (const auto& [first, last] : ranges) {
      for (int address = first; address <= last; ++address) {
        CHECK(code_of(Address(static_cast<std::uint8_t>(address)).name() + "=0") == code);
      }
    }
  };
  check({{0x08, 0x0C}, {0x18, 0x1B}, {0x50, 0x53}, {0x58, 0x5C}}, "read_only");
  check({{0x03, 0x07},
         {0x0D, 0x0F},
         {0x13, 0x17},
         {0x1C, 0x1F},
         {0x28, 0x29},
         {0x2B, 0x2B},
         {0x42, 0x43},
         {0x47, 0x48},
         {0x4A, 0x4F},
         {0x54, 0x57},
         {0x5D, 0x5F}},
        "unsupported");
}

TEST_CASE("operations lead to their commands") {
  CHECK(refused("initialize=1").code == Code::unsupported);
  CHECK(refused("initialize=1").hint == "use `blactl erase`");
  CHECK(refused("0x11=1").hint == "use `blactl restart`");
  CHECK(refused("write_rom=save").hint == "use `blactl save`");
}

TEST_CASE("only what some model takes gets through") {
  CHECK(code_of("0x2A=6") == "out_of_range");
  CHECK(parse_assignment(built_in(), "0x2A=7"));
  CHECK(parse_assignment(built_in(), "0x2A=120"));
  CHECK(code_of("0x2A=121") == "out_of_range");
  CHECK(refused("overcurrent_limit=12.1A").message ==
        "overcurrent_limit=12.1A: outside of the range 0.7A to 12.0A");
  CHECK(code_of("0x34=99") == "out_of_range");
  CHECK(parse_assignment(built_in(), "0x34=0")); // the range of models without PWM input
  CHECK(parse_assignment(built_in(), "0x34=100"));
  CHECK(code_of("command_speed=301rpm") == "out_of_range");
}

TEST_CASE("a gap between the ranges of the models is outside of all of them") {
  // 0x40: 74..120, 120..240, 280..500
  CHECK(parse_assignment(built_in(), "voltage_limit_high=24.0V"));
  CHECK(parse_assignment(built_in(), "voltage_limit_high=28.0V"));
  CHECK(refused("voltage_limit_high=25.0V").code == Code::out_of_range);
  CHECK(refused("voltage_limit_high=25.0V").message ==
        "voltage_limit_high=25.0V: outside of the ranges of all models");
  CHECK(refused("voltage_limit_high=25.0V").hint ==
        "the models take 7.4V to 12.0V, 12.0V to 24.0V, 28.0V to 50.0V or 28.0V to 40.0V");
}

TEST_CASE("the node IDs of tools and the dummy of 0x00-0x02 are never assigned",
          "[requirement-115]") {
  CHECK(code_of("static_node_id=126") == "out_of_range");
  CHECK(code_of("0x46=127") == "out_of_range");
  CHECK(code_of("static_node_id=128") == "out_of_range");
  CHECK(parse_assignment(built_in(), "static_node_id=125"));
  CHECK(parse_assignment(built_in(), "static_node_id=0"));
  CHECK(code_of("command_angle=555555555raw") == "out_of_range");
  CHECK(code_of("0x01=555555555") == "out_of_range");
}

TEST_CASE("a parameter named twice is refused, however it is named") {
  CHECK(all({"servo_id=1", "origin=0deg"})->size() == 2);
  const auto twice = all({"servo_id=1", "0x45=1"});
  REQUIRE_FALSE(twice);
  REQUIRE(twice.error().size() == 1);
  CHECK(twice.error()[0].code == Code::usage);
  CHECK(twice.error()[0].message == "servo_id is given twice");
}

TEST_CASE("0x36 must fit the 0x37 beside it, in either order") {
  CHECK(all({"pwm_output_range=70deg", "pwm_mode=angle"}));
  CHECK(all({"pwm_mode=speed", "pwm_output_range=150rpm"}));
  CHECK(all({"pwm_mode=speed", "pwm_output_range=150raw"}));
  CHECK(all({"pwm_output_range=150rpm"}));
  const auto wrong = all({"pwm_mode=speed", "pwm_output_range=70deg"});
  REQUIRE_FALSE(wrong);
  REQUIRE(wrong.error().size() == 1);
  CHECK(wrong.error()[0].code == Code::usage);
  CHECK(wrong.error()[0].message == "pwm_output_range=70deg: with pwm_mode=speed the unit is rpm");
  CHECK_FALSE(all({"pwm_output_range=150rpm", "0x37=0"}));
  const auto alone = parse_assignment(built_in(), "pwm_output_range=150rpm");
  REQUIRE(alone);
  CHECK(check_pwm_unit(built_in(), *alone, 1));
  CHECK(check_pwm_unit(built_in(), *alone, 0).error().message ==
        "pwm_output_range=150rpm: with pwm_mode=angle the unit is deg");
  CHECK(check_pwm_unit(built_in(), *alone, 0).error().hint ==
        "type pwm_output_range=150.0deg, " // not what the register would make of it
        "or pwm_mode=speed pwm_output_range=150rpm");
  CHECK(wrong.error()[0].hint ==
        "type pwm_output_range=70rpm, or pwm_mode=angle pwm_output_range=70.0deg");
}

TEST_CASE("every fault is told, in the order typed") {
  const auto wrong = all({"nonsense=1", "servo_id=1", "angle_limit_cw=90", "0x45=2", "origin"});
  REQUIRE_FALSE(wrong);
  std::vector<std::string> codes;
  for (const Error& error : wrong.error()) {
    codes.emplace_back(name(error.code));
  }
  CHECK(codes == std::vector<std::string>{"unknown_parameter", "usage", "usage", "usage"});
  CHECK(wrong.error()[3].hint == "for example origin=0.0deg");
}

TEST_CASE("0 is a value of 0x34-0x37: models without a PWM input hold it") {
  for (const char* zero : {"pwm_neutral=0us", "pwm_range=0us", "pwm_output_range=0deg", "0x37=0"}) {
    CHECK(parse_assignment(built_in(), zero));
  }
  CHECK(code_of("pwm_neutral=1us") == "out_of_range");
  CHECK(code_of("pwm_neutral=-1us") == "out_of_range");
}

TEST_CASE("an example is a value that every model takes, or tells the model that takes it") {
  CHECK(refused("overcurrent_limit=x").hint ==
        "a number is written [-]digits[.digits]unit, "
        "for example overcurrent_limit=2.1A for a BLA15-06U-A0");
  CHECK(refused("speed_limit_cw=1V").hint == "for example speed_limit_cw=80rpm");
  CHECK(refused("pwm_neutral=1V").hint == "for example pwm_neutral=1520us");
  CHECK(refused("pwm_range").hint == "for example pwm_range=700us");
}

TEST_CASE("outside of all ranges, the hint tells those that one servo takes") {
  CHECK(refused("overcurrent_limit=12.1A").hint ==
        "the models take 1.0A to 3.0A, 0.7A to 1.5A, 6.0A to 12.0A, 3.5A to 7.0A, 1.6A to 3.2A, "
        "3.5A to 6.3A or 1.6A to 2.4A");
  CHECK(refused("pwm_neutral=99us").hint == "models with a PWM input take 100us to 10000us");
}
