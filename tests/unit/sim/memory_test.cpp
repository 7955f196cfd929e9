#include "blactl/sim/servo/memory.hpp"

#include "unit/sim/support.hpp"

#include <limits>

using namespace blactl;
using namespace blactl::sim;
using bla::Address;
using testing::servo_setup;

namespace {

using Numbers = std::initializer_list<std::uint8_t>;

Memory registers(std::string_view members) {
  return Memory(servo_setup(members));
}

constexpr Address speed_torque_control{0x25};

} // namespace

TEST_CASE("requirement 87: all ten models keep the ranges of their profile", "[requirement-87]") {
  REQUIRE(testing::profiles().all().size() == 10);
  for (const bla::Profile& profile : testing::profiles().all()) {
    Memory ram = registers(fmt::format(R"("model": "{}", "ram": {})", profile.model,
                                       profile.find(speed_torque_control) != nullptr
                                           ? R"({"speed_torque_control": "on"})"
                                           : "{}"));
    for (const bla::Parameter& parameter : profile.parameters) {
      if (parameter.access != bla::Access::read_write) {
        continue;
      }
      INFO(profile.model << " " << parameter.address.name());
      const Address address = parameter.address;
      REQUIRE(parameter.min);
      REQUIRE(parameter.max);
      CHECK(ram.write(address, *parameter.max) == *parameter.max);
      CHECK(ram.read(address) == *parameter.max);
      CHECK(ram.write(address, *parameter.max + 1) == *parameter.max);
      CHECK(ram.write(address, *parameter.min) == *parameter.min);
      CHECK(ram.write(address, *parameter.min - 1) == *parameter.min);
      CHECK(ram.write(address, std::numeric_limits<std::int64_t>::min()) == *parameter.min);
    }
  }
}

TEST_CASE("requirement 78: a value out of range leaves the register as it was",
          "[requirement-78][unproven]") {
  Memory ram = registers(R"("model": "BLA21-12U-AB")");
  CHECK(ram.write(bla::address::angle_limit_cw, 900) == 900);
  CHECK(ram.write(bla::address::angle_limit_cw, -1) == 900);
  CHECK(ram.write(bla::address::angle_limit_cw, 360'000'001) == 900);
  CHECK(ram.read(bla::address::angle_limit_cw) == 900);
}

TEST_CASE("a servo that clamps takes the nearest value in range") {
  Memory ram = registers(R"("model": "BLA21-12U-AB", "behaviour": {"out_of_range": "clamp"})");
  CHECK(ram.write(bla::address::angle_limit_cw, -1) == 0);
  CHECK(ram.write(bla::address::timeout_time, 70'000) == 60'000);
}

TEST_CASE("requirements 71, 78: a servo may answer a value out of range with a failure",
          "[requirement-71][requirement-78][unproven]") {
  Memory ram = registers(R"("model": "BLA21-12U-AB", "behaviour": {"out_of_range": "fail"})");
  CHECK(ram.write(bla::address::angle_limit_cw, 900) == 900);
  CHECK_FALSE(ram.write(bla::address::angle_limit_cw, -1));
  CHECK_FALSE(ram.write(Address(0), bla::not_active));
  CHECK(ram.read(bla::address::angle_limit_cw) == 900);
  CHECK(ram.write(Address(1), 60) == 0); // in range, but 0x25 is off: what there is
}

TEST_CASE("requirement 89: without a PWM input 0x34 to 0x37 are 0 and take only 0",
          "[requirement-89]") {
  for (const bla::Profile& profile : testing::profiles().all()) {
    Memory ram = registers(fmt::format(R"("model": "{}")", profile.model));
    for (std::uint8_t a = 0x34; a <= 0x37 && !profile.pwm; ++a) {
      INFO(profile.model);
      CHECK(ram.read(Address(a)) == 0);
      CHECK(ram.write(Address(a), 1) == 0);
      CHECK(ram.write(Address(a), 0) == 0);
    }
    CHECK(profile.pwm == (ram.read(Address(0x34)) != 0));
  }
}

TEST_CASE("requirements 74, 81: reserved, read-only and high addresses and 0x49 refuse writes",
          "[requirement-74][requirement-81]") {
  Memory ram = registers(R"("model": "BLA21-12U-AB")");
  for (const std::uint8_t a :
       Numbers{0x03, 0x07, 0x17, 0x28, 0x42, 0x49, 0x4F, 0x54, 0x5F, 0x60, 0xFF,
               0x08, 0x0C, 0x18, 0x19, 0x1B, 0x50, 0x51, 0x52, 0x53, 0x58, 0x5C}) {
    INFO(Address(a).name());
    CHECK_FALSE(ram.write(Address(a), 0));
    CHECK_FALSE(ram.write(Address(a), 1));
  }
  CHECK(ram.read(bla::address::model_number) == 61);
}

TEST_CASE("requirement 74: reserved and write-only registers do not answer a read, unless told",
          "[requirement-74][unproven]") {
  Memory ram = registers(R"("model": "BLA21-12U-AB")");
  for (const std::uint8_t a :
       Numbers{0x03, 0x17, 0x28, 0x4A, 0x5F, 0x60, 0xFF, 0x10, 0x11, 0x12, 0x49}) {
    INFO(Address(a).name());
    CHECK_FALSE(ram.read(Address(a)));
  }
  Memory zero = registers(R"("model": "BLA21-12U-AB", "behaviour":
      {"reserved_reads": "zero", "write_only_reads": "zero"})");
  CHECK(zero.read(Address(0x03)) == 0);
  CHECK(zero.read(Address(0x12)) == 0);
  CHECK_FALSE(zero.read(Address(0x60)));
}

TEST_CASE("requirement 93: firmware 1010 lacks what came with 1100 and 1200",
          "[requirement-93][unproven]") {
  Memory ram = registers(R"("model": "BLA21-12U-A0", "firmware_version": 1010)");
  for (const std::uint8_t a : Numbers{0x25, 0x2A, 0x2F, 0x34, 0x35, 0x36, 0x37}) {
    INFO(Address(a).name());
    CHECK_FALSE(ram.read(Address(a)));
    CHECK_FALSE(ram.write(Address(a), 0));
  }
  Memory between = registers(R"("model": "BLA21-12U-A0", "firmware_version": 1100)");
  CHECK(between.read(Address(0x25)) == 0);
  CHECK_FALSE(between.read(Address(0x2F)));
  Memory zero = registers(R"("model": "BLA21-12U-A0", "firmware_version": 1010,
                                "behaviour": {"gated_reads": "zero"})");
  CHECK(zero.read(Address(0x2F)) == 0);
}

TEST_CASE("requirement 114: one command at a time, the others are not active",
          "[requirement-114]") {
  Memory ram = registers(R"("model": "BLA21-12U-AB", "ram": {"speed_torque_control": "on"})");
  CHECK(ram.write(Address(1), 60) == 60);
  CHECK(ram.read(Address(0)) == bla::not_active);
  CHECK(ram.read(Address(2)) == bla::not_active);
  CHECK(ram.write(Address(2), -20) == -20);
  CHECK(ram.read(Address(1)) == bla::not_active);
  CHECK(ram.write(Address(0), 450) == 450);
  CHECK(ram.read(Address(2)) == bla::not_active);
  CHECK(ram.write(Address(0), bla::not_active) == 450); // out of every range
}

TEST_CASE("requirement 117: speed and torque are ignored while 0x25 is off, or absent",
          "[requirement-117][unproven]") {
  for (const char* firmware : {"1400", "1010"}) {
    Memory ram =
        registers(fmt::format(R"("model": "BLA21-12U-AB", "firmware_version": {})", firmware));
    CHECK(ram.write(Address(0), 450) == 450);
    CHECK(ram.write(Address(1), 60) == bla::not_active);
    CHECK(ram.read(Address(0)) == 450);
  }
  Memory ram = registers(R"("model": "BLA21-12U-AB",
                               "behaviour": {"ignores_disabled_commands": false})");
  CHECK(ram.write(Address(1), 60) == 60);
}

TEST_CASE("requirement 166: 0x18 is the OR of levels and bytes of 0x19 to 0x1B",
          "[requirement-166]") {
  Memory ram = registers(R"("model": "BLA21-12U-AB",
      "ram": {"0x19": 1048832, "0x1A": 16, "0x1B": 2147483648})");
  CHECK(ram.read(Address(0x19)) == 1048832); // bits 8 and 20
  CHECK(ram.read(Address(0x18)) == (1 << 8 | 1 << 16 | 1 << 1 | 1 << 26));
  CHECK(registers(R"("model": "BLA21-12U-AB")").read(Address(0x18)) == 0);
}

TEST_CASE("a fresh servo has the defaults of its model and a supply inside its limits") {
  for (const bla::Profile& profile : testing::profiles().all()) {
    INFO(profile.model);
    const Memory ram = registers(fmt::format(R"("model": "{}")", profile.model));
    for (const bla::Parameter& parameter : profile.parameters) {
      const bool writable_default = parameter.access == bla::Access::read_write;
      if (writable_default && parameter.default_raw) {
        CHECK(ram.read(parameter.address) == *parameter.default_raw);
      }
    }
    CHECK(ram.read(bla::address::model_number) == profile.model_number);
    CHECK(ram.read(bla::address::hardware_version) == profile.hardware_version);
    CHECK(ram.value(Address(0x0C)) > ram.value(Address(0x41)));
    CHECK(ram.value(Address(0x0C)) < ram.value(Address(0x40)));
  }
}

TEST_CASE("requirements 45, 56, 61: all ten models save, forget and come back as they should",
          "[requirement-45][requirement-56][requirement-61]") {
  for (const bla::Profile& profile : testing::profiles().all()) {
    Memory memory(servo_setup(fmt::format(R"("model": "{}")", profile.model)));
    const auto differs = [](const bla::Parameter& parameter) {
      return parameter.access == bla::Access::read_write && parameter.min != parameter.max;
    };
    const auto other = [](const bla::Parameter& parameter) {
      return parameter.default_raw == parameter.max ? *parameter.min : *parameter.max;
    };
    const auto change_all = [&] {
      for (const bla::Parameter& parameter : profile.parameters) {
        if (differs(parameter)) {
          (void)memory.write(parameter.address, other(parameter));
        }
      }
    };
    const auto all_are = [&](bool changed) {
      for (const bla::Parameter& parameter : profile.parameters) {
        if (differs(parameter) && parameter.saved) {
          INFO(profile.model << " " << parameter.name);
          CHECK(memory.value(parameter.address) ==
                (changed ? other(parameter) : parameter.default_raw));
        }
      }
    };
    change_all();
    all_are(true);
    memory.restart();
    all_are(false);
    change_all();
    memory.save();
    memory.initialize();
    all_are(false);
    memory.restart();
    all_are(true);
    CHECK(memory.read(bla::address::model_number) == profile.model_number);
    CHECK(memory.rom_value(Address(0x60)) == 0);
  }
}

TEST_CASE("0x10 to 0x12 keep nothing and answer what was written") {
  Memory ram = registers(R"("model": "BLA21-12U-AB")");
  for (const Address address :
       {bla::address::initialize, bla::address::reboot, bla::address::write_rom}) {
    CHECK(ram.write(address, 1) == 1);
    CHECK(ram.value(address) == 0);
    CHECK(ram.write(address, 0) == 0);
    CHECK(ram.write(address, 2) == 0);
  }
}
