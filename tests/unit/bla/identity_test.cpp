#include "blactl/bla/identity.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"

#include <algorithm>
#include <vector>

using namespace blactl;
using namespace blactl::bla;
using test::built_in;

namespace {

constexpr std::int64_t firmware = 1400;

Identity identify(std::optional<std::int64_t> model_number,
                  std::optional<std::int64_t> hardware_version,
                  std::optional<std::int64_t> firmware_version = firmware) {
  return {built_in(), {model_number, 123'456'789, firmware_version, hardware_version}};
}

std::string answer(const Identity& identity, std::uint8_t address, std::int64_t raw) {
  const auto result = identity.may_write(Address(address), raw);
  if (!result) {
    CHECK_FALSE(result.error().message.empty());
    CHECK_FALSE(result.error().hint.empty());
  }
  return result ? "yes" : std::string(name(result.error().code));
}

const Profile& model(std::string_view name) {
  return test::model(name);
}

} // namespace

TEST_CASE("each model is known with certainty by its own numbers",
          "[requirement-85][requirement-86]") {
  for (const Profile& profile : built_in().all()) {
    const Identity identity = identify(profile.model_number, profile.hardware_version);
    CHECK(identity.profile() == &profile);
    CHECK(identity.certain());
    CHECK(identity.model() == profile.model);
    CHECK(identity.parameter(Address(0x2A)) == profile.find(Address(0x2A)));
    CHECK(identity.parameter(Address(0x28)) == nullptr);
  }
}

TEST_CASE("a hardware version of a later production period still tells class and suffix",
          "[requirement-86]") {
  const Identity suffix_open = identify(61, 12'011);
  CHECK(suffix_open.profile() == nullptr);
  CHECK_FALSE(suffix_open.certain());
  CHECK(suffix_open.model() == "BLA21-12U");
  CHECK(answer(suffix_open, 0x2A, 70) == "yes");
  CHECK(answer(suffix_open, 0x2A, 71) == "out_of_range");
  CHECK(answer(suffix_open, 0x38, 900) == "yes");
  CHECK(answer(suffix_open, 0x34, 1520) == "no_profile");
  CHECK(answer(suffix_open, 0x34, 0) == "no_profile");

  const Identity single = identify(62, 6'011);
  CHECK(single.profile() == &model("BLA15-06U-A0"));
  CHECK_FALSE(single.certain());
  CHECK(answer(single, 0x2A, 30) == "yes");
}

TEST_CASE("an unknown voltage class refuses what hangs on it") {
  const Identity open = identify(61, 24'050);
  CHECK(open.profile() == nullptr);
  CHECK(open.model() == "BLA21");
  for (const int address : {0x2A, 0x40, 0x41}) {
    CHECK(answer(open, static_cast<std::uint8_t>(address), 40) == "no_profile");
  }
  CHECK(answer(open, 0x2C, 40) == "yes");
  CHECK(answer(open, 0x34, 1520) == "yes"); // the suffix is that of the models with PWM input
  const auto refused = open.may_write(Address(0x2A), 63);
  CHECK(refused.error().message ==
        "overcurrent_limit (0x2A) depends on the model, and 0x53=24050 fits more than one: "
        "BLA21-06U-AB, BLA21-12U-AB, BLA21-28U-AB");
  // BLA34: the ranges of 0x30 agree, its defaults do not.
  CHECK(answer(identify(86, 24'050), 0x30, 25) == "no_profile");
  CHECK(answer(identify(61, std::nullopt), 0x2A, 63) == "no_profile");
  CHECK(answer(identify(61, std::nullopt), 0x38, 900) == "yes");
}

TEST_CASE("where candidates differ, a register is shown with the range of all models",
          "[requirement-85]") {
  const Identity open = identify(61, 24'050);
  CHECK(open.parameter(Address(0x2A)) == built_in().find(Address(0x2A)));
  CHECK(open.parameter(Address(0x2C)) == model("BLA21-06U-AB").find(Address(0x2C)));
  const Parameter* unknown = identify(99, 12'050).parameter(Address(0x2C));
  REQUIRE(unknown != nullptr);
  CHECK(unknown->name == built_in().find(Address(0x2C))->name);
  CHECK_FALSE(unknown->default_raw);
  CHECK_FALSE(unknown->min);
  CHECK_FALSE(unknown->max);
  CHECK(Identity().parameter(Address(0x2C)) == nullptr);
}

TEST_CASE("a servo of an unknown model is only read, whatever --profile says") {
  for (const std::optional<std::int64_t> number : {std::optional<std::int64_t>(99), {}}) {
    Identity unknown = identify(number, 12'050);
    CHECK(unknown.profile() == nullptr);
    CHECK(unknown.model().empty());
    CHECK(answer(unknown, 0x38, 900) == "no_profile");
    REQUIRE(unknown.assume(model("BLA21-12U-AB")));
    CHECK(unknown.profile() == &model("BLA21-12U-AB"));
    CHECK(unknown.model() == "BLA21-12U-AB");
    CHECK_FALSE(unknown.certain());
    CHECK(answer(unknown, 0x38, 900) == "no_profile");
  }
  CHECK(identify(99, 12'050).may_write(Address(0x38), 900).error().message ==
        "no profile fits this servo (0x50=99): it is only read");
  CHECK(answer(Identity(), 0x38, 900) == "unsupported");
}

TEST_CASE("--profile fills what is open for reading, and contradicts nothing") {
  Identity open = identify(61, 24'050);
  REQUIRE(open.assume(model("BLA21-12U-AB")));
  CHECK(open.profile() == &model("BLA21-12U-AB"));
  CHECK(answer(open, 0x2A, 63) == "no_profile");
  for (const char* other : {"BLA21-12U-A0", "BLA34-12U-AB"}) {
    Identity identity = identify(61, 24'050);
    const auto refused = identity.assume(model(other));
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == Code::model_mismatch);
  }
  Identity certain = identify(61, 12'050);
  REQUIRE(certain.assume(model("BLA21-12U-AB")));
  CHECK(certain.profile() == &model("BLA21-12U-AB"));
  const auto refused = certain.assume(model("BLA21-28U-AB"));
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == Code::model_mismatch);
  CHECK(refused.error().message == "the servo is BLA21-12U-AB, not BLA21-28U-AB");
}

TEST_CASE("nothing is written that the register does not take", "[requirement-79]") {
  const Identity servo = identify(61, 12'050);
  CHECK(answer(servo, 0x38, 1799) == "yes");
  CHECK(answer(servo, 0x38, -1) == "out_of_range");
  CHECK(answer(servo, 0x08, 0) == "read_only");
  CHECK(answer(servo, 0x51, 0) == "read_only");
  CHECK(answer(servo, 0x28, 0) == "unsupported");
  CHECK(answer(servo, 0x49, 0) == "unsupported");
  CHECK(answer(servo, 0x60, 0) == "unsupported");
  CHECK(answer(servo, 0x46, 125) == "yes");
  CHECK(answer(servo, 0x46, 126) == "out_of_range");
  CHECK(answer(servo, 0x46, 127) == "out_of_range");
  CHECK(answer(servo, 0x00, not_active) == "out_of_range");
  CHECK(answer(servo, 0x02, not_active) == "out_of_range");
}

TEST_CASE("without a PWM input 0x34-0x37 take 0 alone", "[requirement-160]") {
  for (const Profile& profile : built_in().all()) {
    const Identity servo = identify(profile.model_number, profile.hardware_version);
    for (const int address : {0x34, 0x35, 0x36, 0x37}) {
      const std::int64_t raw =
          profile.find(Address(static_cast<std::uint8_t>(address)))->default_raw.value_or(-1);
      INFO(profile.model << ' ' << address);
      CHECK(answer(servo, static_cast<std::uint8_t>(address), raw) == "yes");
      CHECK(answer(servo, static_cast<std::uint8_t>(address), 1) == (!profile.pwm ? "unsupported"
                                                                     : address < 0x36
                                                                         ? "out_of_range" // us
                                                                         : "yes"));
    }
  }
  CHECK(identify(62, 6'010).may_write(Address(0x34), 1).error().message ==
        "BLA15-06U-A0 has no PWM input: pwm_neutral (0x34) can only be 0");
}

TEST_CASE("registers that the firmware lacks are not written", "[requirement-90][requirement-91]") {
  const auto written = [](std::optional<std::int64_t> version) {
    std::string all;
    const Identity servo = identify(61, 12'050, version);
    for (const int value : {0x20, 0x25, 0x2A, 0x2F, 0x34, 0x35, 0x36, 0x37}) {
      const Address address(static_cast<std::uint8_t>(value));
      const Parameter& parameter = *model("BLA21-12U-AB").find(address);
      const bool allowed = servo.may_write(address, *parameter.default_raw).has_value();
      all += allowed ? address.name().substr(2) + ' ' : "";
      // Of unknown firmware all is assumed to be there, to read it.
      CHECK(servo.has(parameter) == (!version || allowed));
    }
    return all;
  };
  CHECK(written(1000) == "20 ");
  CHECK(written(1) == "20 ");
  CHECK(written(1010) == "20 ");
  CHECK(written(1099) == "20 ");
  CHECK(written(1100) == "20 25 2A 34 35 36 37 ");
  CHECK(written(1199) == "20 25 2A 34 35 36 37 ");
  CHECK(written(1200) == "20 25 2A 2F 34 35 36 37 ");
  CHECK(written(65535) == "20 25 2A 2F 34 35 36 37 ");
  CHECK(written(std::nullopt) == "20 ");
  CHECK(answer(identify(61, 12'050, 1010), 0x2F, 0) == "unsupported");
  CHECK(identify(61, 12'050, 1010).may_write(Address(0x2F), 0).error().message ==
        "angle_boost (0x2F) needs firmware 1.200, this servo has 1.010");
}

namespace {

using Addresses = std::vector<int>;

Addresses configuration_of(const Identity& identity) {
  Addresses all;
  for (const Parameter* each : identity.configuration()) {
    all.push_back(each->address.value());
  }
  return all;
}

} // namespace

TEST_CASE("the configuration is what SAVE keeps and can be read and written, by address",
          "[requirement-82][requirement-80][requirement-83]") {
  // Tables 3-5 to 3-8: no gaps of the reserved addresses, nothing below 0x20, not 0x49.
  CHECK(configuration_of(identify(61, 12050)) ==
        Addresses{0x20, 0x21, 0x22, 0x23, 0x24, 0x25, 0x26, 0x27, 0x2A, 0x2C, 0x2D, 0x2E,
                  0x2F, 0x30, 0x31, 0x32, 0x33, 0x34, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3A,
                  0x3B, 0x3C, 0x3D, 0x3E, 0x3F, 0x40, 0x41, 0x44, 0x45, 0x46});
}

TEST_CASE("what a firmware lacks is no part of its configuration", "[requirement-90]") {
  const Addresses all = configuration_of(identify(61, 12050, 1010));
  for (const int absent : {0x25, 0x2A, 0x2F, 0x34, 0x35, 0x36, 0x37}) {
    CHECK(std::ranges::find(all, absent) == all.end());
  }
  CHECK(all.size() == 34 - 7);
}

TEST_CASE("nothing is known of the configuration of nobody") {
  CHECK(configuration_of(Identity()).empty());
  CHECK_FALSE(Identity().factory_defaults());
}

TEST_CASE("the factory defaults are those of the model, one for every register") {
  const Identity servo = identify(61, 12050);
  const auto defaults = servo.factory_defaults();
  REQUIRE(defaults);
  CHECK(defaults->size() == servo.configuration().size());
  CHECK(defaults->at(address::angle_limit_cw) == 1799);
  CHECK(defaults->at(address::servo_id) == 0);
  CHECK(defaults->at(address::static_node_id) == 0);
}

TEST_CASE("a model that is not known well enough has no defaults") {
  const auto defaults = identify(99, 55555).factory_defaults();
  REQUIRE_FALSE(defaults);
  CHECK(defaults.error().code == Code::no_profile);
  CHECK_FALSE(defaults.error().hint.empty());
}
