#include "blactl/fleet/live/fault_watch.hpp"

#include "replugged.hpp"
#include "support.hpp"

#include <array>
#include <memory>
#include <vector>

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

/// A session on servos 1001 and 1002 of node ID 20, whose cable is replugged.
std::unique_ptr<Session> replugged(std::vector<Gap> gaps) {
  auto opened =
      Session::open(std::make_unique<Replugged>(servo_1001, servo_1002, std::move(gaps)),
                    state::LocalNodeId::unshared({}), Session::Hearing::commands, profiles());
  REQUIRE(opened);
  return std::move(*opened);
}

std::optional<std::int64_t> serial_of(const FaultState& state) {
  return state.snapshot.servo.identity.readings().serial_number;
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

TEST_CASE("two servos exchanged on one node ID whose uptimes are equal are not two at once") {
  for (const Duration silence : {300ms, 1000ms, 5000ms}) {
    INFO(silence.count());
    const auto session = replugged({{Time(5s), Time(5s) + silence}});
    FaultWatch watch(*session, profiles(), std::array{NodeId(20)}, {}, 500ms);
    std::optional<std::int64_t> last;
    while (session->now() < Time(7s) + silence) {
      const auto seen = watch.next();
      REQUIRE(seen);
      for (const FaultState& state : *seen) {
        for (const Error& error : state.errors) {
          CHECK(error.code != Code::duplicate_node_id);
        }
        if (state.errors.empty()) {
          last = serial_of(state);
          CHECK(state.faults.size() == (last == 1001 ? 1U : 2U)); // both: no pulse at PWM
        }
      }
    }
    CHECK(last == 1002);
  }
}

TEST_CASE("two exchanges whose units have started at different times are not two at once") {
  auto opened = Session::open(
      std::make_unique<Replugged>(servo_1001,
                                  R"({"model": "BLA21-12U-AB", "node_id": 20, "serial_number": 1002,
              "behaviour": {"boot_time": "3s"}})",
                                  std::vector{Gap{Time(8s), Time(9s)}, Gap{Time(13s), Time(14s)}}),
      state::LocalNodeId::unshared({}), Session::Hearing::commands, profiles());
  REQUIRE(opened);
  FaultWatch watch(**opened, profiles(), std::array{NodeId(20)}, {}, 500ms);
  std::vector<std::int64_t> told;
  while ((*opened)->now() < Time(18s)) {
    const auto seen = watch.next();
    REQUIRE(seen);
    for (const FaultState& state : *seen) {
      for (const Error& error : state.errors) {
        CHECK(error.code != Code::duplicate_node_id);
      }
      const auto serial = state.errors.empty() ? serial_of(state) : std::nullopt;
      if (serial && (told.empty() || told.back() != *serial)) {
        told.push_back(*serial);
      }
    }
  }
  CHECK(told == std::vector<std::int64_t>{1001, 1002, 1001});
}
