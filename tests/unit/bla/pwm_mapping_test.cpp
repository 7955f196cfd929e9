#include "blactl/bla/assignment.hpp"
#include "blactl/bla/identity.hpp"
#include "blactl/bla/pwm_mapping.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"

#include <cstdint>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::bla;
using test::built_in;

namespace {

/// What `texts` ask for ("pwm_neutral=1520us"), as registers hold it.
Values values_of(const std::vector<std::string>& texts) {
  const auto assignments = parse_assignments(built_in(), texts);
  REQUIRE(assignments);
  Values values;
  for (const Assignment& assignment : *assignments) {
    values[assignment.parameter->address] = assignment.value.raw;
  }
  return values;
}

std::string refused(const char* endpoints) {
  const auto values = pwm_from_endpoints(built_in(), endpoints);
  REQUIRE_FALSE(values);
  CHECK(values.error().code == Code::usage);
  return values.error().hint;
}

} // namespace

TEST_CASE("the four examples of the specification have the end points of its figures") {
  struct Example {
    std::int64_t shortest, neutral, longest, output, mode;
  };

  const Example examples[]{{820, 1520, 2220, 700, 0},
                           {820, 1520, 2220, 1400, 0},
                           {500, 1000, 1500, 700, 0},
                           {820, 1520, 2220, 150, 1}};
  for (std::size_t i = 0; i < pwm_presets; ++i) {
    INFO(i);
    const auto mapping = pwm_mapping(values_of(pwm_preset(i + 1)));
    REQUIRE(mapping);
    CHECK(mapping->shortest_us() == examples[i].shortest);
    CHECK(mapping->longest_us() == examples[i].longest);
    CHECK(mapping->mode == examples[i].mode);
    CHECK(mapping->command(examples[i].shortest) == -examples[i].output);
    CHECK(mapping->command(examples[i].neutral) == 0);
    CHECK(mapping->command(examples[i].longest) == examples[i].output);
  }
}

TEST_CASE("the default of a BLA34 is 420 to 2620 us for 110 degrees") {
  const Profile& profile = *built_in().matching("BLA34").front();
  const Identity servo(built_in(), {profile.model_number, 1, 1500, profile.hardware_version});
  const auto mapping = pwm_mapping(*servo.factory_defaults());
  REQUIRE(mapping);
  CHECK(mapping->shortest_us() == 420);
  CHECK(mapping->command(420) == -1100);
  CHECK(mapping->command(1520) == 0);
  CHECK(mapping->command(2620) == 1100);
}

TEST_CASE("a pulse outside of the range is no command") {
  const PwmMapping mapping{1520, 700, 700, 0};
  CHECK_FALSE(mapping.command(819));
  CHECK_FALSE(mapping.command(2221));
  CHECK_FALSE((PwmMapping{1520, 0, 700, 0}.command(1520))); // there is no range at all
}

TEST_CASE("limits cut commands off, at pulses that are told") {
  const PwmMapping mapping{1520, 700, 700, 0, 300, -350};
  CHECK(mapping.cut_off_us() == std::vector<std::int64_t>{1170, 1820});
  CHECK(mapping.limited_command(1820) == 300);
  CHECK(mapping.command(1821) == 301);
  CHECK(mapping.limited_command(1821) == 300);
  CHECK(mapping.limited_command(1000) == -350);
  CHECK(PwmMapping{1520, 700, 700, 0, 700, -700}.cut_off_us().empty());
  CHECK(PwmMapping{1520, 700, 0, 0, 0, 0}.cut_off_us().empty());
  CHECK(PwmMapping{500, 700, 700, 0, 700, -600}.cut_off_us().empty()); // at -100 us
}

TEST_CASE("the pulses worth telling are in order, and each is told once") {
  const PwmMapping mapping{1500, 500, 700, 0, 700, -350};
  CHECK(mapping.points_us() == std::vector<std::int64_t>{1000, 1250, 1500, 2000});
  const PwmMapping narrow{1000, 100, 700, 0};
  CHECK(narrow.points_us() == std::vector<std::int64_t>{900, 1000, 1100});
}

TEST_CASE("a mapping goes through two points, in either order") {
  for (const char* text : {"500us:-70deg,1500us:70deg", "1500us:70deg,500us:-70deg"}) {
    const auto values = pwm_from_endpoints(built_in(), text);
    REQUIRE(values);
    CHECK(values_of(*values) == values_of(pwm_preset(3)));
  }
  const auto speed = pwm_from_endpoints(built_in(), "820us:-150rpm,2220us:150rpm");
  REQUIRE(speed);
  CHECK(values_of(*speed) == values_of(pwm_preset(4)));
}

TEST_CASE("two points that no mapping goes through are refused with the nearest that one does") {
  CHECK(refused("500us:-70deg,1501us:70deg").ends_with("500us:-70.0deg,1502us:70.0deg"));
  CHECK(refused("500us:-60deg,1500us:70deg").ends_with("500us:-70.0deg,1500us:70.0deg"));
  // What the registers cannot hold is not offered.
  CHECK(refused("100us:-70deg,101us:70deg").ends_with("--endpoints 91us:-70.0deg,111us:70.0deg"));
  CHECK(refused("9000us:-70deg,12000us:80deg").ends_with("8500us:-80.0deg,11500us:80.0deg"));
  CHECK(refused("10us:0deg,20us:360deg").ends_with("90us:-360.0deg,110us:360.0deg"));
  CHECK(refused("500us:-70deg,1250us:80deg") ==
        "through both points, for pulses from 450 to 1250 us: "
        "--neutral 850us --range 400us --output 80.0deg");
  CHECK(refused("500us:70deg,1500us:-70deg").find("reverse=on") != std::string::npos);
  for (const char* text :
       {"", "500us", "500us:-70deg", "500us:-70,1500us:70", "500us:-70raw,1500us:70raw",
        "500us:-70deg,1500us:70rpm", "500us:-70deg,500us:70deg", "0.5us:-70deg,1500us:70deg",
        "500us:-70.05deg,1500us:70.05deg", "500us:-70deg,1500us:70deg,2000us:90deg",
        "500deg:-70deg,1500us:70deg", ":,:"}) {
    INFO(text);
    (void)refused(text);
  }
}

TEST_CASE("what is at the input follows from the notices") {
  const auto input = [](std::int64_t notices) {
    return name(*pwm_input({{address::fault_notice, notices}}));
  };
  CHECK(input(0) == "ok");
  CHECK(input(1 << 20) == "none");
  CHECK(input(1 << 21) == "short");
  CHECK(input(1 << 22) == "long");
  CHECK_FALSE(pwm_input({}));
}
