#include "blactl/fleet/live/fault_watch.hpp"

#include "support.hpp"

#include <array>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

constexpr std::array both{NodeId(11), NodeId(12)};

/// 11 and 12; the second one never answers.
Scene scene_with_a_mute_servo() {
  return Scene(R"("servos": [{"model": "BLA15-06U-A0", "node_id": 11},
                             {"model": "BLA15-06U-A0", "node_id": 12, "faults": {"mute": true}}])");
}

} // namespace

TEST_CASE("a servo that does not answer holds up no look at another") {
  const Scene scene = scene_with_a_mute_servo();
  scene.grow_old();
  FaultWatch watch(*scene.session, profiles(), both, {}, 500ms);
  const Time begin = scene.session->now();
  for (int looks = 0; looks < 2; ++looks) { // 12 is asked for 1.5 s
    const auto seen = watch.next();
    REQUIRE(seen);
    REQUIRE(seen->size() == 1);
    CHECK(seen->front().snapshot.servo.id == NodeId(11));
    CHECK(seen->front().errors.empty());
  }
  CHECK(scene.session->now() - begin >= 500ms);
  CHECK(scene.session->now() - begin < 1s);
  bool told = false;
  while (!told && scene.session->now() - begin < 5s) {
    const auto seen = watch.next();
    REQUIRE(seen);
    told = seen->front().snapshot.servo.id == NodeId(12);
    CHECK(seen->front().errors.empty() == !told);
  }
  CHECK(told);
}

TEST_CASE("a silence of two seconds is told once, before its read has ended") {
  const Scene scene(R"("servos": [{"model": "BLA15-06U-A0", "node_id": 11, "serial_number": 1}],
                       "events": [{"at": "12s", "servo": 1, "happens": "power_off"},
                                  {"at": "15s", "servo": 1, "happens": "power_on"}])");
  const Time off = scene.session->now() - Scene::start_time + 12s;
  scene.grow_old();
  FaultWatch watch(*scene.session, profiles(), std::array{NodeId(11)}, {}, 500ms);
  std::vector<Time> told;
  while (scene.session->now() < off + 8s) {
    const auto seen = watch.next();
    REQUIRE(seen);
    if (!seen->front().has_answered()) {
      CHECK(seen->front().snapshot.servo.id == NodeId(11));
      told.push_back(scene.session->now());
    }
  }
  REQUIRE(told.size() == 1);
  CHECK(told.front() > off + 1800ms);
  CHECK(told.front() <= off + 2s);
}

TEST_CASE("when one of two servos under one node ID is taken off, the watch reads the other") {
  const Scene scene(R"("servos": [{"model": "BLA15-06U-A0", "node_id": 11, "serial_number": 1},
                                  {"model": "BLA15-06U-A0", "node_id": 11, "serial_number": 2}],
                       "events": [{"at": "8s", "servo": 2, "happens": "power_off"}])");
  const Time begin = scene.session->now();
  scene.grow_old();
  FaultWatch watch(*scene.session, profiles(), std::array{NodeId(11)}, {}, 500ms);
  std::optional<Code> first;
  std::optional<Code> last;
  while (scene.session->now() - begin < 30s) {
    const auto seen = watch.next();
    REQUIRE(seen);
    REQUIRE(seen->size() == 1);
    const auto& errors = seen->front().errors;
    last = errors.empty() ? std::nullopt : std::optional(errors.front().code);
    first = first ? first : last;
  }
  CHECK(first == Code::duplicate_node_id);
  CHECK(last == std::nullopt);
}

TEST_CASE("a watch that ends leaves no look behind") {
  const Scene scene = scene_with_a_mute_servo();
  {
    FaultWatch watch(*scene.session, profiles(), both, {}, 500ms);
    REQUIRE(watch.next());
    CHECK(scene.session->node().jobs() == 1);
  }
  CHECK(scene.session->node().jobs() == 0);
}
