// When a servo sends NodeStatus and actuator.Status by itself (section 2.2), and when it does not.

#include "unit/sim/servo_rig.hpp"

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using testing::bla21;
using testing::only;
using testing::Rig;
using testing::uptimes;

namespace {

using Uptimes = std::vector<std::pair<std::uint32_t, unsigned>>;

std::string with(const std::string& members) {
  return std::string(bla21) + ", " + members;
}

std::size_t count(const std::vector<can::Frame>& frames, const dronecan::DataType& type) {
  return only(frames, type.id).size();
}

/// Modes of the NodeStatus among `frames`.
std::vector<unsigned> modes(const std::vector<can::Frame>& frames) {
  std::vector<unsigned> out;
  for (const can::Frame& one : only(frames, dronecan::NodeStatus::type.id)) {
    out.push_back(one.data[4] >> 3U & 7U);
  }
  return out;
}

} // namespace

TEST_CASE("requirement 3: the first NodeStatus comes at once, or up to a second after the start",
          "[requirement-3][unproven]") {
  Rig at_once(bla21);
  CHECK(uptimes(at_once.heard) == Uptimes{{0, 0}});
  Rig later(with(R"("behaviour": {"first_node_status": "700ms"})"), 700ms);
  CHECK(uptimes(later.heard).empty());
  CHECK_FALSE(only(later.heard, dronecan::ActuatorStatus::type.id).empty());  // that is not late
  CHECK(uptimes(later.bench.run(2150ms)) == Uptimes{{0, 0}, {1, 1}, {2, 2}}); // one a second
  CHECK(later.restart_node() == "ok");
  CHECK(uptimes(later.bench.run(700ms)).empty());
  CHECK(uptimes(later.bench.run(150ms)) == Uptimes{{0, 0}});
  Rig last(with(R"("behaviour": {"first_node_status": "1s"})"), 1s);
  CHECK(uptimes(last.heard).empty());
  CHECK(uptimes(last.bench.run(150ms)) == Uptimes{{1, 0}});
}

TEST_CASE("requirement 39: with a new ID the delay of the first NodeStatus counts from there",
          "[requirement-39][unproven]") {
  Rig rig(R"("model": "BLA21-12U-AB", "behaviour": {"first_node_status": "1s"})");
  rig.allocate(33);
  CHECK(uptimes(rig.bench.run(999ms)).empty());
  CHECK(uptimes(rig.bench.run(1ms)).size() == 1);
}

TEST_CASE("requirement 23: mode 1 is never seen, or once under a new ID",
          "[requirement-23][unproven]") {
  using Modes = std::vector<unsigned>;
  const auto after_allocation = [](const char* shows) {
    Rig rig(
        fmt::format(R"("model": "BLA21-12U-AB", "behaviour": {{"assignment_shows": {}}})", shows));
    rig.allocate(33);
    return modes(rig.bench.run(2s));
  };
  CHECK(after_allocation("false") == Modes{0, 0, 0});
  CHECK(after_allocation("true") == Modes{1, 0, 0});
  Rig own_id(with(R"("behaviour": {"assignment_shows": true})"));
  CHECK(modes(own_id.heard) == Modes{0});
}

TEST_CASE("faults: a servo may never send NodeStatus, or actuator.Status, but answers") {
  for (const bool node_status : {true, false}) {
    Rig rig(with(fmt::format(R"("faults": {{"{}": true}})",
                             node_status ? "no_node_status" : "no_actuator_status")));
    const auto check = [&](const std::vector<can::Frame>& frames) {
      CHECK((count(frames, dronecan::NodeStatus::type) == 0) == node_status);
      CHECK((count(frames, dronecan::ActuatorStatus::type) == 0) != node_status);
    };
    check(rig.heard);
    check(rig.bench.run(3s));
    CHECK(rig.read("0x38") == 1799);
    CHECK(rig.opcode(dronecan::ExecuteOpcode::save) == "ok");
    check(rig.settle());
    CHECK(rig.servo.rom_writes() == 1);
  }
}
