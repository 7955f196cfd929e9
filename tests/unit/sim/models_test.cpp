// All variants of table 3-12 and all firmware versions of chapter 5, as servos on the bench.

#include "blactl/sim/servo/world.hpp"

#include "unit/sim/servo_rig.hpp"

#include <set>

using namespace blactl;
using namespace blactl::sim;
using namespace blactl::sim::testing;
using namespace std::chrono_literals;

namespace {

constexpr std::array firmware_versions{1010, 1100, 1200, 1300, 1400, 1500};

/// A model of table 3-12: 0x50, 0x53, and whether it has a PWM input.
struct Variant {
  const char* model;
  std::int64_t model_number, hardware_version;
  bool pwm;
};

constexpr std::array variants{
    Variant{"BLA15-06U-A0", 62, 6010, false},  Variant{"BLA15-12U-A0", 62, 12010, false},
    Variant{"BLA21-06U-A0", 61, 6010, false},  Variant{"BLA21-12U-A0", 61, 12010, false},
    Variant{"BLA21-28U-A0", 61, 28010, false}, Variant{"BLA21-06U-AB", 61, 6050, true},
    Variant{"BLA21-12U-AB", 61, 12050, true},  Variant{"BLA21-28U-AB", 61, 28050, true},
    Variant{"BLA34-12U-AB", 86, 12050, true},  Variant{"BLA34-28U-AB", 86, 28050, true},
};

/// A register that came with a firmware (chapter 5).
struct Gated {
  const char* name;
  std::int64_t since;
};

constexpr std::array gated{Gated{"0x25", 1100}, Gated{"0x2A", 1100}, Gated{"0x2F", 1200},
                           Gated{"0x34", 1100}, Gated{"0x35", 1100}, Gated{"0x36", 1100},
                           Gated{"0x37", 1100}};

std::string setup(const char* model, std::int64_t firmware, const char* more = "") {
  return fmt::format(
      R"("model": "{}", "node_id": 11, "firmware_version": {}, "answer_delay": 0 {})", model,
      firmware, more);
}

} // namespace

TEST_CASE("requirements 87, 95: every variant with every firmware says what it is",
          "[requirement-87][requirement-95]") {
  REQUIRE(variants.size() == profiles().all().size());
  for (const Variant& variant : variants) {
    for (const int firmware : firmware_versions) {
      INFO(variant.model << " " << firmware);
      Rig rig(setup(variant.model, firmware));
      CHECK(rig.read("0x50") == variant.model_number);
      CHECK(rig.read("0x53") == variant.hardware_version);
      CHECK(rig.read("0x52") == firmware);
      CHECK_FALSE(only(rig.heard, dronecan::ActuatorStatus::type.id).empty());
    }
  }
}

TEST_CASE("requirement 93: a register that the firmware lacks can neither be read nor written",
          "[requirement-93][unproven]") {
  for (const Variant& variant : variants) {
    for (const int firmware : firmware_versions) {
      Rig rig(setup(variant.model, firmware));
      Rig zero(setup(variant.model, firmware, R"(, "behaviour": {"gated_reads": "zero"})"));
      for (const Gated& gate : gated) {
        INFO(variant.model << " " << firmware << " " << gate.name);
        const bool exists = firmware >= gate.since;
        CHECK(rig.read(gate.name).has_value() == exists);
        CHECK(rig.write(gate.name, 0).has_value() == exists);
        CHECK(zero.read(gate.name).has_value());
        CHECK((exists || zero.read(gate.name) == 0));
        CHECK(zero.write(gate.name, 0).has_value() == exists);
      }
    }
  }
}

TEST_CASE("requirement 93: without 0x25 speed and torque commands stay inactive",
          "[requirement-93]") {
  Rig old(setup("BLA21-12U-A0", 1010));
  const auto before = old.read("0x01");
  CHECK(old.write("0x01", 60) == before);
  Rig newer(setup("BLA21-12U-A0", 1100));
  CHECK(newer.write("0x25", 1) == 1);
  CHECK(newer.write("0x01", 60) == 60);
}

TEST_CASE("requirement 88: only variants with a B in their suffix obey pulses",
          "[requirement-88]") {
  for (const Variant& variant : variants) {
    INFO(variant.model);
    Rig rig(setup(variant.model, 1500));
    World world = rig.servo.world();
    world.pulse_us = 1870; // half of 0x35 above 0x34: half of 0x36, 35.0 deg
    rig.servo.surround(world, rig.bench.now());
    rig.bench.run(3s);
    rig.servo.look(rig.bench.now());
    CHECK((rig.ram(bla::address::command_angle) == 350) == variant.pwm);
  }
}

TEST_CASE("requirement 89: without PWM 0x34 to 0x37 answer 0 and take nothing else",
          "[requirement-89]") {
  for (const Variant& variant : variants) {
    Rig rig(setup(variant.model, 1500));
    for (const char* name : {"0x34", "0x35", "0x36", "0x37"}) {
      INFO(variant.model << " " << name);
      if (!variant.pwm) {
        CHECK(rig.read(name) == 0);
        CHECK(rig.write(name, 1) == 0);
        CHECK(rig.write(name, 0) == 0);
      }
    }
    CHECK((rig.read("0x34") == 1520) == variant.pwm);
  }
}

TEST_CASE("requirement 94: the production date is five registers", "[requirement-94]") {
  Rig rig(setup("BLA21-12U-AB", 1400, R"(, "ram": {"production_year": 2020, "production_month": 6,
      "production_day": 22, "production_hour": 15, "production_minute": 30})"));
  CHECK(rig.read("0x58") == 2020);
  CHECK(rig.read("0x59") == 6);
  CHECK(rig.read("0x5A") == 22);
  CHECK(rig.read("0x5B") == 15);
  CHECK(rig.read("0x5C") == 30);
  CHECK_FALSE(rig.write("0x58", 2021));
}

TEST_CASE("requirement 95: every unit of a model has a serial number of its own",
          "[requirement-95]") {
  std::string servos;
  for (int i = 0; i < 20; ++i) {
    servos += (i == 0 ? "" : ", ") + std::string(R"({"model": "BLA21-12U-AB"})");
  }
  std::set<std::int64_t> serials;
  for (const ServoSetup& one : scenario(fmt::format(R"("servos": [{}])", servos)).servos) {
    serials.insert(one.serial_number);
  }
  CHECK(serials.size() == 20);
}
