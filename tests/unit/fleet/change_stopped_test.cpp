// What becomes of a servo when another one has failed, and that is to stop all others.

#include "blactl/fleet/change/change_job.hpp"

#include "support.hpp"

#include <cstddef>
#include <optional>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using dronecan::ExecuteOpcode;

namespace {

/// One servo whose change is stopped when this stage of it begins, as another servo fails then.
struct Stopped {
  explicit Stopped(const Wanted& wanted, std::optional<ChangeStage> fails_at, bool stops = true)
      : scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
                             "rom": {"angle_limit_cw": "90deg"}}])") {
    scene.live(3s);
    plan = plans_for(scene, wanted, {11}).front();
    pace.stops_at_failure = stops;
    pace.has_failed = !fails_at;
    ChangeJob job(scene.roster(), profiles(), plan,
                  {.come_back = 5s, .pace = &pace, .entered = [&](const Servo&, ChangeStage stage) {
                     stages.push_back(stage);
                     pace.has_failed = pace.has_failed || stage == fails_at;
                   }});
    scene.run(job);
    result = job.result();
  }

  [[nodiscard]] std::size_t opcodes() const { return scene.requests(ExecuteOpcode::type, 11); }

  Scene scene;
  Plan plan;
  RestartPace pace;
  std::vector<ChangeStage> stages;
  ChangeResult result;
};

const Wanted save{.restart = RestartKind::save};
const Wanted erase_and_save{.erase = true, .restart = RestartKind::save};

Wanted set_and_save() {
  return {.assignments = assignments({"reverse=on"}), .restart = RestartKind::save};
}

/// It has begun, and is told so.
void check_stopped_halfway(const ChangeResult& result) {
  CHECK(result.was_begun);
  CHECK_FALSE(result.is_done());
  CHECK_FALSE(result.saved);
  REQUIRE(result.error);
  CHECK(result.error->code == Code::state);
  CHECK(result.error->node_id == 11);
}

} // namespace

TEST_CASE("a servo to which nothing was sent when another one fails has no error of its own") {
  const Stopped stopped(save, std::nullopt);
  CHECK_FALSE(stopped.result.was_begun);
  CHECK_FALSE(stopped.result.is_done());
  CHECK_FALSE(stopped.result.error);
  CHECK(stopped.opcodes() == 0);
  CHECK(stopped.stages == std::vector{ChangeStage::end});
}

TEST_CASE("a servo that is written to when another one fails is not saved, and that is told") {
  const Stopped stopped(set_and_save(), ChangeStage::write);
  check_stopped_halfway(stopped.result);
  CHECK(stopped.result.changes[0].status == ChangeStatus::written);
  CHECK(stopped.opcodes() == 0);
}

TEST_CASE("what an ERASE has left is read also when another servo fails, and not saved") {
  const Stopped stopped(erase_and_save, ChangeStage::erase);
  check_stopped_halfway(stopped.result);
  CHECK(stopped.stages == std::vector{ChangeStage::erase, ChangeStage::read, ChangeStage::end});
  CHECK(stopped.result.values_read > 30);
  CHECK(stopped.opcodes() == 1);
}

TEST_CASE("a failure that is not to stop the others stops none, and one that comes too late") {
  const auto fails_at = GENERATE(std::optional(ChangeStage::write),
                                 std::optional(ChangeStage::read), std::optional<ChangeStage>());
  const Stopped going_on(set_and_save(), fails_at, fails_at == ChangeStage::read);
  CHECK(going_on.result.is_done());
  CHECK(going_on.result.saved);
  CHECK_FALSE(going_on.result.error);
}
