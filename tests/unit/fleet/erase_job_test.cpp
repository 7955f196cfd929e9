#include "blactl/fleet/change/erase_job.hpp"

#include "support.hpp"

#include <string>
#include <utility>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using dronecan::ExecuteOpcode;

namespace {

/// A servo that is identified, without a bus.
struct Bench : Acquaintance {
  std::string next(const Outcome& outcome) {
    step = job.next(outcome);
    return text(step);
  }

  /// As far as the request, which is not answered yet.
  void send() {
    CHECK(next(Script::start()) == "GetNodeInfo");
    CHECK(next(script.info(1)) == "ExecuteOpcode");
  }

  [[nodiscard]] Code error() const {
    REQUIRE(job.error());
    CHECK(job.error()->node_id == 11);
    return job.error()->code;
  }

  Script script;
  EraseJob job{roster, servo, {500ms, 2}};
  dronecan::Step step = std::nullopt;
};

/// What a servo holds, identified again if it restarted.
bla::Values read(const Scene& scene, std::uint8_t id) {
  const Snapshot snapshot = scene.read(id, configuration);
  REQUIRE_FALSE(snapshot.first_error());
  return snapshot.values();
}

} // namespace

TEST_CASE("ERASE is sent once, to the servo that is meant", "[requirement-50]") {
  Bench bench;
  bench.send();
  const auto request = ExecuteOpcode::Request::decode(bench.step.request()->payload.bytes());
  REQUIRE(request);
  CHECK(request->opcode == ExecuteOpcode::erase);
  CHECK(bench.step.request()->server == NodeId(11));
  CHECK(bench.step.request()->retries == 0); // whatever the patience for other questions
  CHECK(bench.job.is_sent());
  CHECK_FALSE(bench.job.is_confirmed());
  CHECK(bench.next(bench.script.answer(ExecuteOpcode::Response{.ok = true}.encode())) == "nothing");
  CHECK(bench.job.is_confirmed());
  CHECK_FALSE(bench.job.error());
}

TEST_CASE("armed before ERASE leaves: it is not sent") {
  Bench bench;
  bench.send();
  REQUIRE(bench.step.request()->may_leave);
  arm(bench.roster, {});
  CHECK_FALSE(bench.step.request()->may_leave({}));
  CHECK(bench.next(Script::withheld()) == "nothing");
  CHECK(bench.error() == Code::armed);
  CHECK_FALSE(bench.job.is_sent());
}

TEST_CASE("a lost answer to ERASE is no error and no confirmation: the registers must tell") {
  Bench bench;
  bench.send();
  CHECK(bench.next(Script::timed_out()) == "nothing");
  CHECK_FALSE(bench.job.is_confirmed());
  CHECK_FALSE(bench.job.error());
}

TEST_CASE("a servo that refuses ERASE, or answers nonsense, has not confirmed it") {
  Bench bench;
  bench.send();
  const auto answer = GENERATE(true, false) ? ExecuteOpcode::Response{.ok = false}.encode()
                                            : dronecan::Payload(std::vector<std::uint8_t>{0xFF});
  CHECK(bench.next(bench.script.answer(answer)) == "nothing");
  CHECK_FALSE(bench.job.error()); // the registers tell
  CHECK(bench.job.is_refused());
  CHECK_FALSE(bench.job.is_confirmed());
}

TEST_CASE("an ERASE that did not leave, or was given up, is told so") {
  Bench bench;
  bench.send();
  const auto [outcome, code] = GENERATE(std::pair(Outcome::Kind::not_sent, Code::no_acknowledge),
                                        std::pair(Outcome::Kind::cancelled, Code::interrupted));
  CHECK(bench.next({outcome, {}, {}}) == "nothing");
  CHECK(bench.error() == code);
  CHECK_FALSE(bench.job.is_confirmed());
}

TEST_CASE("what is not certainly the servo that is meant is not erased") {
  Bench bench;
  CHECK(bench.next(Script::start()) == "GetNodeInfo");
  SECTION("another servo") {
    CHECK(bench.next(bench.script.info(2)) == "nothing");
    CHECK(bench.error() == Code::state);
  }
  SECTION("one that restarted since it was looked at: its RAM holds something else") {
    bench.restart();
    CHECK(bench.next(bench.script.info(1)) == "nothing");
    CHECK(bench.error() == Code::state);
  }
  SECTION("two units on its ID: both would be erased") {
    bench.roster.mark_doubled(NodeId(11), {1}, {2});
    CHECK(bench.next(bench.script.info(1)) == "nothing");
    CHECK(bench.error() == Code::duplicate_node_id);
  }
  SECTION("two units on its ID of which no answer can be read") {
    bench.roster.mark_doubled(NodeId(11), {1}, {2});
    CHECK(bench.next(Script::timed_out()) == "nothing");
    CHECK(bench.error() == Code::duplicate_node_id);
  }
  SECTION("one that does not answer") {
    CHECK(bench.next(Script::timed_out()) == "nothing");
    CHECK(bench.error() == Code::timeout);
  }
  SECTION("one that the question does not reach") {
    CHECK(bench.next(Script::not_sent()) == "nothing");
    CHECK(bench.error() == Code::no_acknowledge);
  }
  SECTION("one that was left alone in time") {
    CHECK(bench.next(Script::cancelled()) == "nothing");
    CHECK(bench.error() == Code::interrupted);
  }
  CHECK_FALSE(bench.job.is_sent());
  CHECK_FALSE(bench.job.is_confirmed());
}

TEST_CASE("an erased servo holds the defaults in its RAM, and stays where it is") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 7,
                             "rom": {"angle_limit_cw": "90deg"}}])");
  const Servo servo = scene.identify(11);
  CHECK(read(scene, 11).at(bla::address::angle_limit_cw) == 900);
  EraseJob job(scene.roster(), servo, {});
  scene.run(job);
  CHECK(job.is_confirmed());
  CHECK(scene.requests(ExecuteOpcode::type, 11) == 1);
  CHECK(read(scene, 11) == *servo.identity.factory_defaults());
  CHECK(scene.member(11).boots == 0);
}

TEST_CASE("an ERASE whose answer is lost is not sent twice, whatever the patience") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
                             "faults": {"lose_opcode_answers": 1}}])");
  EraseJob job(scene.roster(), scene.identify(11), {.timeout = 500ms, .retries = 5});
  scene.run(job);
  CHECK_FALSE(job.is_confirmed());
  CHECK_FALSE(job.error());
  CHECK(scene.requests(ExecuteOpcode::type, 11) == 1);
}
