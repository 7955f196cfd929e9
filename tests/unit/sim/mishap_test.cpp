// What a scenario lets happen to a servo at set times: power that goes, a CPU that restarts.

#include "blactl/sim/bus/simulator.hpp"

#include "sim/servo/names.hpp"
#include "unit/sim/servo_rig.hpp"

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using testing::bla21;
using testing::Frames;
using testing::Rig;
using testing::scenario;
using testing::uptimes;

TEST_CASE("a servo that loses power forgets RAM and comes back from ROM with uptime 0",
          "[requirement-45][requirement-17]") {
  Rig rig(bla21);
  CHECK(rig.write("0x38", 900) == 900);
  rig.bench.run(3s);
  rig.servo.suffer(Mishap::power_off, rig.bench.now());
  CHECK(rig.bench.run(10s).empty());
  CHECK_FALSE(rig.read("0x38"));
  rig.servo.suffer(Mishap::power_on, rig.bench.now());
  CHECK(uptimes(rig.bench.run(200ms)) == std::vector<std::pair<std::uint32_t, unsigned>>{{0, 0}});
  CHECK(rig.read("0x38") == 1799);
  CHECK(rig.read("0x1B") == 0);
  CHECK(rig.told() == Frames{"restart 11"});
}

TEST_CASE("power that comes while it is there, or goes while it is gone, changes nothing") {
  Rig rig(bla21);
  rig.servo.suffer(Mishap::power_on, rig.bench.now());
  CHECK(rig.read("0x38") == 1799);
  rig.servo.suffer(Mishap::power_off, rig.bench.now());
  rig.servo.suffer(Mishap::power_off, rig.bench.now());
  rig.servo.suffer(Mishap::watchdog_error, rig.bench.now()); // nothing runs
  CHECK(rig.bench.run(1s).empty());
  CHECK(rig.told() == Frames{"restart 11"});
}

TEST_CASE("requirement 167: events restart the CPU, and 0x1B tells why until the next start",
          "[requirement-167][requirement-170]") {
  for (const auto& [word, bit] :
       {std::pair{"clock_error", fault::clock}, std::pair{"watchdog_error", fault::watchdog},
        std::pair{"ram_error", fault::memory}}) {
    Simulator simulator(
        scenario(fmt::format(R"("servos": [{{"model": "BLA21-12U-AB", "node_id": 11}},
                                           {{"model": "BLA21-12U-AB", "node_id": 12}}],
            "events": [{{"at": "1s", "servo": 240900001, "happens": "{}"}},
                       {{"at": "5s", "servo": 240900001, "happens": "power_off"}},
                       {{"at": "6s", "servo": 240900001, "happens": "power_on"}}])",
                             word)),
        Time{});
    Servo& servo = *simulator.servos().front();
    const auto failures = [&](Duration at) {
      simulator.advance_to(Time{} + at);
      servo.look(simulator.now());
      return servo.registers().value(bla::Address(0x1B));
    };
    CHECK(failures(900ms) == 0);
    CHECK(failures(2s) == bit);
    CHECK(servo.node_id() == dronecan::NodeId(11));
    CHECK(failures(7s) == 0);
    CHECK(simulator.servos().back()->registers().value(bla::Address(0x1B)) == 0);
  }
}

TEST_CASE("a start that could not read ROM runs on initial values, the next one reads it") {
  Rig rig(R"("model": "BLA21-12U-AB", "node_id": 11, "rom": {"angle_limit_cw": "90deg"})");
  CHECK(rig.read("0x38") == 900);
  rig.servo.suffer(Mishap::rom_error, rig.bench.now());
  const auto value = [&](std::uint8_t address) {
    return rig.servo.registers().value(bla::Address(address));
  };
  CHECK(value(0x38) == 1799);
  CHECK(value(0x1A) == fault::rom_unreadable);
  rig.servo.suffer(Mishap::power_off, rig.bench.now());
  rig.servo.suffer(Mishap::power_on, rig.bench.now());
  CHECK(value(0x38) == 900);
}

TEST_CASE("requirement 170: after a restart by itself the motor turns", "[requirement-170]") {
  Rig rig(bla21);
  rig.servo.suffer(Mishap::watchdog_error, rig.bench.now());
  rig.settle();
  CHECK(rig.read("0x1B") == fault::watchdog);
  CHECK(rig.write("0x00", 450) == 450);
  rig.bench.run(900ms);
  CHECK(std::abs(rig.read("0x08").value_or(0) - 450) <= 5);
}

TEST_CASE("an event may change the world and let something happen, in this order") {
  Simulator simulator(scenario(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}],
      "events": [{"at": "1s", "servo": 240900001, "world": {"voltage": "9.5V"},
                  "happens": "power_off"},
                 {"at": "2s", "servo": 240900001, "happens": "power_on"}])"),
                      Time{});
  simulator.advance_to(Time{} + 1500ms);
  const Servo& servo = *simulator.servos().front();
  CHECK_FALSE(servo.world().powers());
  CHECK(servo.world().supply_decivolt == 95);
  simulator.advance_to(Time{} + 3s);
  CHECK(servo.node_id() == dronecan::NodeId(11));
}
