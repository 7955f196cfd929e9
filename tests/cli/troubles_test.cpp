// What doctor finds: nothing on healthy buses of many kinds, and each planted trouble.

#include "catch.hpp"
#include "scene.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

using Codes = std::set<std::string>;

constexpr const char* unique_id_of_11 = "0000000000000000000000000000000b";

/// The codes of doctor's findings.
Codes found(const Scene& scene) {
  Codes all;
  const auto document = json(scene.run({"doctor", "--json"}).out);
  for (const auto& finding : document["findings"]) {
    all.insert(finding["code"].get<std::string>());
  }
  CHECK(document["errors"].empty());
  return all;
}

/// Servos with node IDs from 1 on, each with a servo ID of its own.
Scene servos(int count, const nlohmann::json& more = {}) {
  static const std::vector<const char*> models{"BLA21-12U-AB", "BLA15-06U-A0", "BLA34-28U-AB"};
  Scene scene;
  for (int id = 1; id <= count; ++id) {
    nlohmann::json keys{{"servo_id", id}};
    keys.update(more.is_null() ? nlohmann::json::object() : more);
    scene.servo(models[static_cast<std::size_t>(id) % models.size()], id, keys);
  }
  return scene;
}

/// Servo 11, which is well, and servo 12.
Scene beside(const nlohmann::json& other, int node_id = 12) {
  nlohmann::json keys{{"servo_id", 12}, {"serial_number", 12}};
  keys.update(other.is_null() ? nlohmann::json::object() : other);
  return Scene()
      .servo("BLA21-12U-AB", 11,
             {{"servo_id", 11}, {"serial_number", 11}, {"unique_id", unique_id_of_11}})
      .servo("BLA21-12U-AB", node_id, keys);
}

Scene two() {
  return beside({});
}

Scene commanded(int servo_id, int type) {
  return two().foreign(
      30,
      {{"commands", {{"servo_ids", {servo_id}}, {"type", type}, {"value", 0.1}, {"rate", 50}}}});
}

struct Bus {
  std::string name;
  Scene scene;
  Codes planted{}; ///< what may be found: it is there
};

std::vector<Bus> healthy() {
  const Codes losses{"lost_answers", "timeout"};
  const nlohmann::json late{{"sending", {{"late_answers", 0.05}, {"late_by", "1500ms"}}}};
  return {
      {"one servo", servos(1)},
      {"one of each make", servos(3)},
      {"a full bus", servos(120)},
      {"frames that come twice", servos(12).wire({{"duplication", 0.5}})},
      {"one frame in a hundred lost", servos(20).wire({{"loss", 0.01}}), losses},
      {"one frame in twenty lost", servos(5).wire({{"loss", 0.05}}), losses},
      {"answers that are 1.5 s late", servos(12, late), losses},
      {"late answers, frames lost and twice",
       servos(30, late).wire({{"loss", 0.02}, {"duplication", 0.3}}), losses},
      {"an allocator at rest, which is disarmed",
       servos(8).foreign(100, {{"kind", "autopilot"}, {"allocates", true}})},
      {"nodes of other makes", servos(8)
                                   .foreign(101, {{"kind", "gnss"}, {"rate", 5}})
                                   .foreign(102, {{"kind", "esc"}, {"index", 0}, {"rate", 50}})
                                   .foreign(103, {{"serves_get_set", true}})},
  };
}

struct Trouble {
  std::string name;
  Scene scene;
  std::string code;
  Codes others{}; ///< what it brings with it
};

std::vector<Trouble> of_units() {
  return {
      {"one node ID twice", beside({}, 11), "duplicate_node_id"},
      {"one servo ID twice", beside({{"servo_id", 11}}), "duplicate_servo_id"},
      {"an actuator of another make has it", two().foreign(30, {{"actuator_id", 12}}),
       "duplicate_servo_id"},
      {"another make has its node ID", two().foreign(12), "duplicate_node_id"},
      {"a copied unit", beside({{"unique_id", unique_id_of_11}}), "duplicate_unique_id"},
      {"a unique ID of zeros", beside({{"unique_id", std::string(32, '0')}}), "no_unique_id"},
      {"a unique ID of ones", beside({{"unique_id", std::string(32, 'f')}}), "no_unique_id"},
      {"one serial number twice", beside({{"serial_number", 11}}), "duplicate_serial_number"},
      {"the node ID of tools", beside({}, 127), "tool_node_id"},
      {"their other one", beside({}, 126), "tool_node_id"},
      {"no node ID", beside({}, 0), "no_node_id"},
      {"an unknown model", beside({{"model_number", 1}}), "unknown_model"},
      {"a firmware that may stall", beside({{"firmware_version", 1200}}), "firmware_defect"},
      {"low voltage", beside({{"ram", {{"current_voltage", "3.5V"}}}}), "health"},
      {"heat", beside({{"ram", {{"current_temperature", "85degC"}}}}), "health"},
      {"a broken motor", beside({{"ram", {{"0x1B", 2}}}}), "health"},
      {"a ROM that was not read", beside({{"ram", {{"0x1A", 1 << 15}}}}), "health"},
  };
}

std::vector<Trouble> of_traffic() {
  return {
      {"a restart", two().event(12, "watchdog_error", "2500ms"), "restarted", {"health"}},
      {"away", two().event(12, "power_off", "900ms"), "offline"},
      {"no answers", beside({{"faults", {{"mute", true}}}}), "timeout"},
      {"no NodeStatus", beside({{"faults", {{"no_node_status", true}}}}), "no_node_status"},
      {"rare NodeStatus", two().foreign(30, {{"status_period", "2500ms"}}), "slow_node_status"},
      {"armed", two().foreign(30, {{"armed", true}}), "armed"},
      {"somebody commands", commanded(11, 1), "commander"},
      {"nobody is commanded", commanded(77, 1), "no_such_servo", {"commander"}},
      {"commands of PWM", commanded(11, 4), "pwm_command", {"commander"}},
      {"lost answers", servos(12).wire({{"loss", 0.1}}), "lost_answers", {"timeout"}},
      {"two allocators",
       beside({}, 0)
           .foreign(30, {{"kind", "autopilot"}, {"allocates", true}})
           .foreign(31, {{"kind", "autopilot"}, {"allocates", true}}),
       "several_allocators"},
      {"a full bus", two().foreign(30, {{"kind", "babbler"}, {"priority", 30}, {"load", 0.8}}),
       "bus_load"},
      {"a cut cable", two().clients("cut", "0s"), "no_acknowledge"},
      {"bus-off", two().clients("bus_off", "1s"), "bus_off"},
  };
}

} // namespace

TEST_CASE("doctor has no finding on a bus that is well, of whatever make-up") {
  for (Bus& bus : healthy()) {
    for (const int seed : {1, 2}) {
      const Codes all = found(bus.scene.seed(seed));
      INFO(bus.name << ", seed " << seed);
      for (const std::string& code : all) {
        INFO(code);
        CHECK(bus.planted.contains(code));
      }
    }
  }
}

TEST_CASE("doctor has the finding of each planted trouble, and no other") {
  const auto troubles = GENERATE(as<std::vector<Trouble> (*)()>{}, of_units, of_traffic)();
  for (const Trouble& trouble : troubles) {
    Codes all = found(trouble.scene);
    INFO(trouble.name);
    CHECK(all.erase(trouble.code) == 1);
    CHECK(std::ranges::includes(trouble.others, all));
  }
}
