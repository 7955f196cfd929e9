#include "blactl/fleet/change/survey.hpp"
#include "blactl/fleet/change/write_job.hpp"

#include "support.hpp"

#include <signal.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
namespace at = bla::address;

namespace {

Wanted wanted(const char* assignment) {
  return {.assignments = assignments({assignment})};
}

/// What others said of their IDs.
struct Heard {
  /// A servo that is there, with these IDs in RAM.
  void servo(std::uint8_t id, std::int64_t servo_id, std::int64_t static_node_id) {
    survey.holders[NodeId(id)] = dronecan::UniqueId{id};
    survey.servos.push_back({NodeId(id), dronecan::UniqueId{id}, servo_id, static_node_id});
  }

  [[nodiscard]] std::optional<Error> conflict(const Plan& plan) const {
    return conflict(std::vector{plan}, plan);
  }

  [[nodiscard]] std::optional<Error> conflict(const std::vector<Plan>& plans,
                                              const Plan& plan) const {
    return fleet::conflict(survey, plans, plan);
  }

  Survey survey;
};

std::optional<Code> code(const std::optional<Error>& error) {
  return error ? std::optional(error->code) : std::nullopt;
}

constexpr const char* bus = R"(
    "servos": [{"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1},
               {"model": "BLA21-12U-AB", "node_id": 12, "servo_id": 2}],
    "foreign": [{"kind": "node", "node_id": 30}])";

/// Afterwards the servo is another node with its next restart.
void give(const Scene& scene, std::uint8_t id, std::int64_t static_node_id) {
  const RegisterChange change{.parameter = &parameter("static_node_id"),
                              .requested = static_node_id};
  WriteJob job(scene.roster(), scene.identify(id), {change}, {});
  scene.run(job);
  REQUIRE(job.changes()[0].status == ChangeStatus::written);
}

Survey ask_all(const Scene& scene, const std::vector<Plan>& plans) {
  auto asked = survey(*scene.session, profiles(), plans, {}, nullptr);
  REQUIRE(asked);
  return *asked;
}

} // namespace

TEST_CASE("plans that give no ID cost nothing") {
  const Scene scene(bus);
  const Plan plan = plan_for(wanted("smoothing=off"), {}, scene.identify(11));
  const std::size_t sent = scene.sent.size();
  const Survey found = ask_all(scene, {plan});
  CHECK(found.holders.empty());
  CHECK(found.servos.empty());
  CHECK(scene.sent.size() == sent);
  CHECK_FALSE(conflict(found, std::vector{plan}, plan));
}

TEST_CASE("who gives an ID asks its holder, and all servos for theirs in RAM") {
  const Scene scene(bus);
  scene.grow_old();
  give(scene, 12, 25);
  const Plan plan = plan_for(wanted("static_node_id=30"), {}, scene.identify(11));
  const Survey found = ask_all(scene, {plan});
  CHECK(found.holders.contains(NodeId(30)));
  CHECK(scene.requests(GetNodeInfo::type, 30) == 1);
  CHECK(scene.requests(GetSet::type, 30) == 0);
  REQUIRE(found.servos.size() == 2);
  CHECK(found.servos[0].id == NodeId(11));
  CHECK(found.servos[0].servo_id == 1);
  CHECK(found.servos[1].id == NodeId(12));
  CHECK(found.servos[1].servo_id == 2);
  CHECK(found.servos[1].static_node_id == 25);
  CHECK(code(conflict(found, std::vector{plan}, plan)) == Code::duplicate_node_id);
  const auto gives = [&](const char* assignment) {
    const Plan other = plan_for(wanted(assignment), {}, scene.identify(11));
    return code(conflict(ask_all(scene, {other}), std::vector{other}, other));
  };
  CHECK(gives("static_node_id=12") == Code::duplicate_node_id);
  CHECK(gives("static_node_id=25") == Code::duplicate_node_id);
  CHECK_FALSE(gives("static_node_id=40")); // nobody is there
  CHECK_FALSE(gives("static_node_id=11")); // its own
  CHECK(gives("servo_id=2") == Code::duplicate_servo_id);
  CHECK_FALSE(gives("servo_id=3"));
}

TEST_CASE("the holder of a node ID that is given is named") {
  Heard heard;
  heard.servo(11, 0, 0);
  heard.survey.holders[NodeId(30)] = dronecan::UniqueId{0xAB, 0xCD};
  const auto error = heard.conflict(plan_for(wanted("static_node_id=30")));
  REQUIRE(error);
  CHECK(error->code == Code::duplicate_node_id);
  CHECK(error->node_id == 11);
  CHECK(error->message.find("uid:abcd") != std::string::npos);
  CHECK_FALSE(error->hint.empty());
}

TEST_CASE("an ID whose holder is mute is taken all the same") {
  Heard heard;
  heard.survey.holders[NodeId(30)] = std::nullopt;
  CHECK(code(heard.conflict(plan_for(wanted("static_node_id=30")))) == Code::duplicate_node_id);
  CHECK_FALSE(heard.conflict(plan_for(wanted("static_node_id=31"))));
}

TEST_CASE("the unit itself may answer at the ID that it is given") {
  Heard heard;
  heard.survey.holders[NodeId(30)] = *bla21().unique_id;
  CHECK_FALSE(heard.conflict(plan_for(wanted("static_node_id=30"))));
}

TEST_CASE("an ID that another servo gets with its next restart is taken") {
  Heard heard;
  heard.servo(11, 0, 0);
  heard.servo(12, 4, 20);
  CHECK(code(heard.conflict(plan_for(wanted("static_node_id=20")))) == Code::duplicate_node_id);
  CHECK_FALSE(heard.conflict(plan_for(wanted("static_node_id=4"))));
  CHECK(code(heard.conflict(plan_for(wanted("servo_id=4")))) == Code::duplicate_servo_id);
  CHECK_FALSE(heard.conflict(plan_for(wanted("servo_id=20"))));
}

TEST_CASE("0 is no ID that could be taken") {
  Heard heard;
  heard.servo(11, 3, 11);
  heard.servo(12, 0, 0);
  CHECK_FALSE(heard.conflict(plan_for(wanted("static_node_id=0"), {{at::static_node_id, 11}})));
  CHECK_FALSE(heard.conflict(plan_for(wanted("servo_id=0"), {{at::servo_id, 3}})));
}

TEST_CASE("what another servo said of itself counts as far as its plan leaves it") {
  Heard heard;
  heard.servo(11, 1, 21);
  heard.servo(12, 2, 22);
  const Plan first =
      plan_for({.assignments = assignments({"servo_id=2", "static_node_id=22"})}, {}, bla21(11));
  SECTION("it gives both away") {
    const Plan second =
        plan_for({.assignments = assignments({"servo_id=1", "static_node_id=21"})}, {}, bla21(12));
    CHECK_FALSE(heard.conflict({first, second}, first));
    CHECK_FALSE(heard.conflict({first, second}, second));
  }
  SECTION("it is erased, and has none") {
    const Plan second = plan_for({.erase = true}, {}, bla21(12));
    CHECK_FALSE(heard.conflict({first, second}, first));
  }
  SECTION("it is erased and keeps them") {
    const Plan second = plan_for({.erase = true, .keep_ids = true}, {}, bla21(12));
    CHECK(heard.conflict({first, second}, first));
  }
  SECTION("its plan is about something else") {
    const Plan second = plan_for(wanted("smoothing=off"), {}, bla21(12));
    CHECK(heard.conflict({first, second}, first));
  }
}

TEST_CASE("two plans that give one ID are in conflict, both of them") {
  Heard heard;
  heard.servo(11, 1, 0);
  heard.servo(12, 2, 0);
  const auto [assignment, expected] =
      GENERATE(std::pair("static_node_id=20", Code::duplicate_node_id),
               std::pair("servo_id=5", Code::duplicate_servo_id));
  const std::vector plans{plan_for(wanted(assignment), {}, bla21(11)),
                          plan_for(wanted(assignment), {}, bla21(12))};
  CHECK(code(heard.conflict(plans, plans[0])) == expected);
  CHECK(code(heard.conflict(plans, plans[1])) == expected);
}

TEST_CASE("a session that ends in between leaves no survey") {
  const Scene scene(bus);
  const Plan plan = plan_for(wanted("static_node_id=30"), {}, scene.identify(11));
  REQUIRE(raise(SIGINT) == 0);
  const auto asked = survey(*scene.session, profiles(), std::vector{plan}, {}, nullptr);
  REQUIRE_FALSE(asked);
  CHECK(asked.error().code == Code::interrupted);
}
