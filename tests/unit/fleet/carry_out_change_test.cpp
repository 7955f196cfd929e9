// What has become of servos that were done, or needed nothing, while others were changed.

#include "blactl/fleet/change/change.hpp"

#include "recorded_change.hpp"

#include <string>
#include <string_view>
#include <tuple>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

const Wanted restart{.restart = RestartKind::restart};

std::string texts_of(const GoalResult& result) {
  std::string all;
  for (const Error& error : result.errors) {
    all += error.message + "\n";
  }
  return all;
}

bool says(const GoalResult& result, std::string_view words) {
  return texts_of(result).find(words) != std::string::npos;
}

/// A servo of which it is known what RAM holds, or also ROM, and another one that is changed.
struct Bystander {
  explicit Bystander(bool is_proven, std::string_view more = "")
      : scene(scene_of({servo_at(11), servo_at(12)}) + std::string(more)),
        history(stores.history("apply")),
        change(*scene.session, profiles(), {.manner = {.proofs = &history}}) {
    scene.live(3s);
    command(scene, stores, "apply", {saved_goal(11, {"angle_limit_cw=90deg"})});
    REQUIRE(change
                .prepare({is_proven ? saved_goal(11, {"angle_limit_cw=90deg"}, Evidence::restart)
                                    : goal(11, {"angle_limit_cw=90deg"}, Evidence::ram),
                          goal(12, {"reverse=on"})})
                .empty());
    REQUIRE(change.results()[0].need == Need::nothing);
    REQUIRE(change.results()[0].rom_proven.value_or(false) == is_proven);
  }

  /// The bystander's result, after the other servo was changed.
  const GoalResult& carry_out() {
    REQUIRE(change.carry_out().empty());
    CHECK(change.results()[1].is_done);
    return change.results()[0];
  }

  Stores stores;
  Scene scene;
  History history;
  Change change;
};

constexpr const char* other_hot =
    R"(, "events": [{"at": "9s", "servo": 11, "world": {"temperature": "120degC"}}])";

} // namespace

TEST_CASE("a servo that needs nothing is asked once more after others were changed, only then") {
  Scene scene(scene_of({servo_at(11), servo_at(12)}));
  scene.live(3s);
  const Goal held = goal(11, {"reverse=off"}, Evidence::ram);
  std::vector<Goal> goals{held};
  const auto [changes, is_armed, asked] =
      GENERATE(std::tuple(false, false, 0), std::tuple(true, true, 0), std::tuple(true, false, 1));
  if (changes) {
    goals.push_back(goal(12, {"reverse=on"}));
  }
  Change change(*scene.session, profiles(), {});
  REQUIRE(change.prepare(goals).empty());
  const std::size_t before = scene.requests(GetNodeInfo::type, 11);
  if (is_armed) { // while a question was answered
    arm(scene.roster(), scene.session->now());
  }
  CHECK(change.carry_out().empty() == !is_armed);
  CHECK(scene.requests(GetNodeInfo::type, 11) - before == static_cast<std::size_t>(asked));
  CHECK(change.results()[0].is_done);
}

TEST_CASE("a servo whose ROM was proven, and that is not as healthy since, is read once more") {
  Bystander hot(true, other_hot);
  hot.scene.live(3s);
  REQUIRE(hot.scene.member(11).status->health == dronecan::Health::warning);
  SECTION("it holds its goal") {
    CHECK(hot.carry_out().is_done);
  }
  SECTION("it holds something else, which nobody was heard to write") {
    elsewhere(hot.scene, 11, {.assignments = assignments({"angle_limit_cw=45deg"})});
    const GoalResult& result = hot.carry_out();
    CHECK_FALSE(result.is_done);
    CHECK(says(result, "what was in RAM only"));
  }
  SECTION("it has restarted, too: that is the reason, whatever it holds") {
    elsewhere(hot.scene, 11, restart);
    elsewhere(hot.scene, 11, {.assignments = assignments({"angle_limit_cw=45deg"})});
    const GoalResult& result = hot.carry_out();
    CHECK_FALSE(result.is_done);
    CHECK(says(result, "since its ROM was proven"));
  }
}

TEST_CASE("a servo that needed nothing, and restarts meanwhile, may hold its goal no more") {
  const bool is_proven = GENERATE(false, true);
  Bystander bystander(is_proven);
  elsewhere(bystander.scene, 11, restart);
  const GoalResult& result = bystander.carry_out();
  CHECK_FALSE(result.is_done);
  REQUIRE(codes(result.errors) == std::vector{Code::state});
  CHECK(says(result, is_proven ? "since its ROM was proven" : "what was in RAM only"));
}

TEST_CASE("a servo that restarts after its round, while another one goes to its node ID") {
  const auto [saves, restarts, words] =
      GENERATE(std::tuple(false, true, "what was in RAM only"),
               std::tuple(true, true, "since its ROM was proven"), std::tuple(false, false, ""));
  const Scene scene(scene_of({servo_at(11), servo_at(12, R"(, "faults": {"return_delay": "3s"})"),
                              servo_at(13)}) +
                    (restarts ? R"(, "events": [{"at": "8s", "servo": 11, "happens": "power_off"},
                                  {"at": "8100ms", "servo": 11, "happens": "power_on"}])"
                              : ""));
  scene.live(3s);
  Change change(*scene.session, profiles(), {});
  REQUIRE(
      change
          .prepare({saves ? saved_goal(11, {"reverse=on"}) : goal(11, {"reverse=on"}),
                    saved_goal(12, {"static_node_id=13"}), saved_goal(13, {"static_node_id=14"})})
          .empty());
  std::vector<std::uint32_t> boots; // of it, as each round ended
  CHECK(change.carry_out([&](const IdMove&) { boots.push_back(scene.member(11).boots); }).empty());
  const std::uint32_t before = saves ? 1 : 0;
  REQUIRE(boots == std::vector{before, restarts ? before + 1 : before});
  const GoalResult& result = change.results()[0];
  INFO(texts_of(result));
  CHECK(result.is_done == !restarts);
  CHECK(says(result, words));
  CHECK(result.errors.size() == (restarts ? 1U : 0U));
}

TEST_CASE("a change is done also where its end cannot be recorded, and who asked is told") {
  const Stores stores;
  (void)stores.history("apply"); // the files are there
  const Scene scene(scene_of({servo_at(11)}));
  scene.live(3s);
  History history = stores.history("apply", state::Access::read);
  const bool asks = GENERATE(false, true);
  std::vector<Code> told;
  Manner manner{.history = &history};
  if (asks) {
    manner.end_not_recorded = [&](const Error& error) { told.push_back(error.code); };
  }
  Change change(*scene.session, profiles(), {.manner = manner});
  REQUIRE(change.prepare({saved_goal(11, {"reverse=on"})}).empty());
  CHECK(change.carry_out().empty());
  CHECK(change.results()[0].is_done);
  CHECK(told.size() == (asks ? 2U : 0U)); // of the result of its round, and of the end
}

TEST_CASE("a servo that restarts while the end of the change is recorded holds its goal no more") {
  const Stores stores;
  (void)stores.history("apply"); // the files are there
  const Scene scene(scene_of({servo_at(11), servo_at(12)}));
  scene.live(3s);
  History history = stores.history("apply", state::Access::read); // to know that moment
  std::size_t asked = 0;
  Manner manner{.history = &history};
  manner.end_not_recorded = [&](const Error&) {
    if (scene.requests(GetNodeInfo::type, 11) > asked) { // it was looked at for the last time
      const auto payload = dronecan::NodeStatus{.uptime_s = 0}.encode();
      scene.roster().receive({.header = {.kind = dronecan::Kind::message,
                                         .data_type_id = dronecan::NodeStatus::type.id,
                                         .source = NodeId(11)},
                              .payload = payload.bytes(),
                              .at = scene.session->now()});
    }
  };
  Change change(*scene.session, profiles(), {.manner = manner});
  REQUIRE(
      change.prepare({goal(11, {"reverse=off"}, Evidence::ram), goal(12, {"reverse=on"})}).empty());
  asked = scene.requests(GetNodeInfo::type, 11);
  CHECK(change.carry_out().empty());
  REQUIRE(scene.member(11).boots == 1);
  const GoalResult& result = change.results()[0];
  CHECK_FALSE(result.is_done);
  CHECK(says(result, "what was in RAM only"));
}
