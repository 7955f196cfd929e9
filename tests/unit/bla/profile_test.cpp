#include "blactl/bla/profile.hpp"

#include "bla/embedded_profiles.hpp"
#include "catch.hpp"
#include "unit/bla/built_in.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

using namespace blactl;
using namespace blactl::bla;
using test::built_in;

namespace {

std::vector<std::string> matching(std::string_view text) {
  std::vector<std::string> models;
  for (const Profile* profile : built_in().matching(text)) {
    models.push_back(profile->model);
  }
  return models;
}

Error refused(std::string_view text) {
  const auto found = built_in().find(text);
  REQUIRE_FALSE(found);
  return found.error();
}

} // namespace

TEST_CASE("the binary holds the files of profiles/ byte by byte") {
  CHECK(embedded_profiles().size() == 4);
  for (const EmbeddedProfile& profile : embedded_profiles()) {
    std::ifstream file(BLACTL_PROFILES "/" + std::string(profile.file), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    CHECK_FALSE(text.empty());
    CHECK(profile.text == text);
  }
}

TEST_CASE("parameters are found by address and by name, in either case") {
  for (const char* text : {"0x38", "0X38", "angle_limit_cw", "angle-limit-cw", "ANGLE_LIMIT-cw"}) {
    const auto found = built_in().find(text);
    REQUIRE(found);
    CHECK((*found)->address == Address(0x38));
  }
  for (const Parameter& parameter : built_in().registers()) {
    CHECK(*built_in().find(parameter.name) == &parameter);
    CHECK(*built_in().find(parameter.address.name()) == &parameter);
    CHECK(built_in().find(parameter.address) == &parameter);
  }
}

TEST_CASE("reserved addresses are unsupported, what lies beyond is unknown") {
  std::size_t reserved = 0;
  for (int value = 0; value <= 0xFF; ++value) {
    const Address address(static_cast<std::uint8_t>(value));
    if (built_in().find(address) != nullptr) {
      continue;
    }
    const Error error = refused(address.name());
    CHECK(error.code == (value < 0x60 ? Code::unsupported : Code::unknown_parameter));
    reserved += value < 0x60 ? 1 : 0;
  }
  CHECK(reserved == 37);
  CHECK(refused("0x03").message ==
        "0x03 is a reserved address: blactl neither reads nor writes it");
}

TEST_CASE("an unknown name is answered with the nearest") {
  const std::string list_hint =
      "`blactl get` lists the parameters of your servo, `blactl models all` those of every model";
  CHECK(refused("angel_limit_cw").code == Code::unknown_parameter);
  CHECK(refused("angel_limit_cw").message == "angel_limit_cw: there is no such parameter");
  CHECK(refused("angel_limit_cw").hint == "did you mean angle_limit_cw or angle_limit_ccw?");
  CHECK(refused("smothing").hint == "did you mean smoothing?");
  CHECK(refused("node_id").hint == "did you mean static_node_id?");
  CHECK(refused("pwm").hint == "did you mean pwm_mode, pwm_range or pwm_neutral?");
  CHECK(refused("xyzzy").hint == list_hint);
  CHECK(refused("").hint == list_hint);
  CHECK(refused("0x2").code == Code::unknown_parameter);
  CHECK(refused(std::string(100'000, 'a')).code == Code::unknown_parameter);
  CHECK(refused("\x1B[2J").message == "\\x1b[2J: there is no such parameter");
}

TEST_CASE("labels of the vendor's program and names of the specification lead to the parameter") {
  CHECK(refused("Limit Angle CW").hint == "did you mean angle_limit_cw?");
  CHECK(refused("limit_angle_cw").hint == "did you mean angle_limit_cw?");
  CHECK(refused("Actuator ID").hint == "did you mean servo_id?");
  CHECK(refused("PWMIN_PulseWidth_Neutral").hint == "did you mean pwm_neutral?");
  CHECK(refused("原点位置").hint == "did you mean origin?");
  CHECK(refused("The Origin Point").hint == "did you mean origin?");
}

TEST_CASE("models are meant by name, beginning and label") {
  CHECK(matching("BLA21-12U-AB") == std::vector<std::string>{"BLA21-12U-AB"});
  CHECK(matching("bla21-12u-ab") == std::vector<std::string>{"BLA21-12U-AB"});
  CHECK(matching("BLA21-12U-AB2") == std::vector<std::string>{"BLA21-12U-AB"});
  CHECK(matching("BLA15-06U-A01") == std::vector<std::string>{"BLA15-06U-A0"});
  CHECK(matching("BLA21-12U") == std::vector<std::string>{"BLA21-12U-A0", "BLA21-12U-AB"});
  CHECK(matching("BLA34").size() == 2);
  CHECK(matching("BLA").size() == 10);
  CHECK(matching("BLA21-12U-ABX").empty());
  CHECK(matching("BLA21-12U-AB22").empty());
  CHECK(matching("BLA99").empty());
  CHECK(matching("").empty());
}

TEST_CASE("the registers hold the union of the ranges of all models that let them be written") {
  const Parameter& current = *built_in().find(Address(0x2A));
  CHECK(current.min == 7);
  CHECK(current.max == 120);
  CHECK_FALSE(current.default_raw);
  CHECK(current.by_voltage_class);
  const Parameter& neutral = *built_in().find(Address(0x34));
  CHECK(neutral.min == 100); // not 0: where there is no PWM input, nothing can be written
  CHECK(neutral.max == 10'000);
  CHECK(neutral.default_raw == 1520);
  CHECK(neutral.by_suffix);
  const Parameter& speed = *built_in().find(Address(0x01));
  CHECK(speed.min == -300);
  CHECK(speed.max == 300);
  CHECK(speed.default_raw == 0);
}

TEST_CASE("levels have the words of the contract") {
  CHECK(name(Level::notice) == "notice");
  CHECK(name(Level::warning) == "warning");
  CHECK(name(Level::failure) == "failure");
}

TEST_CASE("firmware versions are shown as the specification writes them", "[requirement-91]") {
  CHECK(firmware_text(1400) == "1.400");
  CHECK(firmware_text(1010) == "1.010");
  CHECK(firmware_text(12005) == "12.005");
}
