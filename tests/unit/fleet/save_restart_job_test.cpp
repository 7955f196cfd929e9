#include "blactl/fleet/change/save_restart_job.hpp"

#include "support.hpp"

#include <map>
#include <string>
#include <tuple>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using dronecan::Allocation;
using dronecan::ExecuteOpcode;
using dronecan::Mode;
using dronecan::NodeStatus;
using dronecan::RestartNode;

namespace {

/// A job without a bus: what the servo says is heard by the roster and then told to the job, as a
/// session does it. Time is told by hand.
class Bench {
 public:
  explicit Bench(RestartKind kind = RestartKind::save, Duration start_in = {},
                 std::optional<NodeId> expected = std::nullopt)
      : kind_(kind), job(prepare(), servo,
                         {.kind = kind,
                          .start = now + start_in,
                          .come_back = 5s,
                          .patience = {500ms, 2},
                          .pace = &pace,
                          .expected = expected,
                          .expected_free_since = now}) {}

  /// Another node writes 1 to register `address` of servo 11.
  void other_writes(bla::Address address) {
    const dronecan::GetSet::Request request{.index = address.value(), .value = std::int64_t{1}};
    hear(service(dronecan::Kind::request, dronecan::GetSet::type, 40, 11, request.encode(), id()));
  }

  /// What the job does next, after this outcome of its last step.
  std::string next(Outcome outcome) {
    outcome.at = outcome.asked = now;
    step = job.next(outcome);
    ++steps[text(step)];
    return text(step);
  }

  std::string start() { return next(Script::start()); }

  std::string timed_out() {
    REQUIRE(step.request() != nullptr);
    now += step.request()->timeout;
    return next(Script::timed_out());
  }

  /// The pause is over because of its time.
  std::string time_is_over() {
    now = until();
    return next({Outcome::Kind::woken, {}, {}});
  }

  /// To the end of the job; nobody answers.
  void wait_in_vain() {
    while (!step.is_end()) {
      step.pause() != nullptr ? time_is_over() : timed_out();
    }
  }

  /// Whom the job asks.
  [[nodiscard]] NodeId asked() const {
    REQUIRE(step.request() != nullptr);
    return step.request()->server;
  }

  [[nodiscard]] Time until() const {
    REQUIRE(step.pause() != nullptr);
    return step.pause()->until;
  }

  /// Whether the job wakes now, as a node asks it after each transfer.
  [[nodiscard]] bool wakes() const {
    return step.pause() != nullptr && step.pause()->ready && step.pause()->ready();
  }

  std::string wake() {
    REQUIRE(wakes());
    return next({Outcome::Kind::woken, {}, {}});
  }

  std::string answer_ok(bool ok = true) {
    return next(script_.answer(kind_ == RestartKind::save
                                   ? ExecuteOpcode::Response{.ok = ok}.encode()
                                   : RestartNode::Response{.ok = ok}.encode()));
  }

  /// The answer to GetNodeInfo of a unit that started then.
  std::string info(std::uint8_t unit, Time started, Mode mode = Mode::operational) {
    const auto payload = node_info(unit, started, mode).encode();
    hear(service(dronecan::Kind::response, GetNodeInfo::type, asked().value(), 127, payload, id()));
    return next(script_.answer(payload));
  }

  /// As far as the request, which is not answered yet.
  std::string send() {
    REQUIRE(start() == "GetNodeInfo");
    return info(1, boot);
  }

  void hear_status(std::uint8_t source, Time started, Mode mode = Mode::operational) {
    hear(message(NodeStatus::type, source, status(started, mode).encode(), id()));
  }

  /// A unit that started then is heard, asked (UnitJob), and answers.
  void recognize(std::uint8_t source, std::uint8_t unit, Time started,
                 Mode mode = Mode::operational) {
    hear_status(source, started, mode);
    roster.learn(NodeId(source), node_info(unit, started, mode), now);
  }

  /// Servo 11 restarted, was asked (UnitJob) and answers; no NodeStatus has come yet.
  void recognize_by_answer(Time started, Mode mode) {
    const auto info = node_info(1, started, mode);
    hear(service(dronecan::Kind::response, GetNodeInfo::type, 11, 127, info.encode(), id()));
    roster.learn(NodeId(11), info, now);
  }

  /// Asked by somebody else, servo 11 answers, whenever it started.
  void hear_info(Time started) {
    hear(service(dronecan::Kind::response, GetNodeInfo::type, 11, 127,
                 node_info(1, started, Mode::operational).encode(), id()));
  }

  void hear(const std::vector<can::Frame>& frames) {
    for (const can::Frame& frame : frames) {
      roster.hear(frame, now);
      receiver_.receive(frame, now);
    }
  }

  [[nodiscard]] Code error() const {
    REQUIRE(job.error());
    return job.error()->code;
  }

  [[nodiscard]] std::string message_of_error() const {
    REQUIRE(job.error());
    return job.error()->message;
  }

  Time now{1000s};
  RestartPace pace{.distance = 3s};
  const Time boot = now - 100s; ///< of the servo before its restart

 private:
  Roster& prepare() {
    hear_status(11, boot);
    roster.learn(servo, node_info(1, boot, Mode::operational));
    return roster;
  }

  [[nodiscard]] NodeStatus status(Time started, Mode mode) const {
    return {.uptime_s = static_cast<std::uint32_t>(
                std::chrono::duration_cast<std::chrono::seconds>(now - started).count()),
            .mode = mode};
  }

  [[nodiscard]] GetNodeInfo::Response node_info(std::uint8_t unit, Time started, Mode mode) const {
    return {.status = status(started, mode), .unique_id = {unit}, .name = "servo"};
  }

  dronecan::TransferId id() { return id_++ % dronecan::transfer_id_modulus; }

  RestartKind kind_;
  Script script_;
  dronecan::TransferId id_ = 0;

 public:
  Roster roster{NodeId(127), profiles()};

 private:
  dronecan::Receiver receiver_{
      8,
      {},
      {.transfer = [this](const dronecan::Transfer& transfer) { roster.receive(transfer); },
       .signature = [](dronecan::Kind kind, std::uint16_t type) -> std::optional<std::uint64_t> {
         const auto* known = dronecan::find_type(kind, type);
         return known != nullptr ? std::optional(known->signature) : std::nullopt;
       }}};

 public:
  Servo servo{.id = NodeId(11), .unique_id = dronecan::UniqueId{1}, .since = now, .is_servo = true};
  SaveRestartJob job;
  dronecan::Step step = std::nullopt;
  std::map<std::string, int> steps; ///< how often the job did what
};

} // namespace

TEST_CASE("a servo saves, goes, comes back and is recognised", "[requirement-48][requirement-58]") {
  Bench bench;
  CHECK(bench.start() == "GetNodeInfo");
  CHECK_FALSE(bench.job.must_finish());
  CHECK_FALSE(bench.job.is_sent());
  CHECK(bench.info(1, bench.boot) == "ExecuteOpcode");
  REQUIRE(bench.step.request() != nullptr);
  const auto request = ExecuteOpcode::Request::decode(bench.step.request()->payload.bytes());
  REQUIRE(request);
  CHECK(request->opcode == ExecuteOpcode::save);
  CHECK(bench.step.request()->retries == 0); // whatever the patience for other questions
  CHECK(bench.job.must_finish());
  CHECK(bench.job.is_sent());
  CHECK(bench.answer_ok() == "pause");
  CHECK_FALSE(bench.wakes());
  bench.now += 200ms;
  bench.hear_status(11, bench.now);
  CHECK_FALSE(bench.wakes()); // it may be another servo
  bench.recognize(11, 1, bench.now);
  CHECK(bench.job.must_finish());
  CHECK(bench.wake() == "nothing");
  CHECK(bench.job.returned() == NodeId(11));
  CHECK_FALSE(bench.job.error());
  CHECK(bench.job.duration() == 200ms);
  CHECK_FALSE(bench.job.must_finish());
}

TEST_CASE("a restart is asked for with its magic number, once", "[requirement-42]") {
  Bench bench(RestartKind::restart);
  CHECK(bench.send() == "RestartNode");
  const auto request = RestartNode::Request::decode(bench.step.request()->payload.bytes());
  REQUIRE(request);
  CHECK(request->magic_number == 0xACCE551B1E);
  CHECK(bench.step.request()->retries == 0);
  CHECK(bench.answer_ok() == "pause");
  bench.now += 200ms;
  bench.recognize(11, 1, bench.now);
  CHECK(bench.wake() == "nothing");
  CHECK(bench.job.returned() == NodeId(11));
}

TEST_CASE("armed before the request leaves: the servo is neither saved nor restarted") {
  const auto kind = GENERATE(RestartKind::save, RestartKind::restart);
  Bench bench(kind);
  bench.send();
  REQUIRE(bench.step.request()->may_leave);
  CHECK(bench.step.request()->may_leave(bench.now));
  arm(bench.roster, bench.now);
  CHECK_FALSE(bench.step.request()->may_leave(bench.now));
  CHECK(bench.next(Script::withheld()) == "nothing");
  CHECK(bench.error() == Code::armed);
  CHECK_FALSE(bench.job.is_sent());
  CHECK_FALSE(bench.job.may_have_happened());
  CHECK(bench.pace.leaving.empty());
}

TEST_CASE("armed before the second request leaves: the first one was not carried out") {
  Bench bench;
  bench.send();
  CHECK(bench.next(Script::timed_out()) == "pause");
  bench.now += 2s;
  CHECK(bench.time_is_over() == "GetNodeInfo");
  CHECK(bench.info(1, bench.boot) == "ExecuteOpcode");
  arm(bench.roster, bench.now);
  CHECK(bench.next(Script::withheld()) == "nothing");
  CHECK(bench.error() == Code::armed);
  CHECK(bench.job.is_sent());
  CHECK(bench.job.has_run_on());
  CHECK_FALSE(bench.job.may_have_happened());
}

TEST_CASE("nothing is sent before its time") {
  Bench bench(RestartKind::save, 3s);
  CHECK(bench.start() == "pause");
  CHECK(bench.until() == bench.now + 3s);
  CHECK_FALSE(bench.job.must_finish());
  CHECK(bench.time_is_over() == "GetNodeInfo");
}

TEST_CASE("requests to several servos keep their distance, whatever delays one of them") {
  Bench bench;
  CHECK(bench.start() == "GetNodeInfo");
  bench.pace.next = bench.now + 2s; // another job has sent its request a second ago
  CHECK(bench.info(1, bench.boot) == "pause");
  CHECK(bench.until() == bench.now + 2s);
  CHECK_FALSE(bench.job.is_sent());
  CHECK(bench.time_is_over() == "GetNodeInfo"); // it may be another servo by now
  CHECK(bench.info(1, bench.boot) == "ExecuteOpcode");
  CHECK(bench.pace.next == bench.now + 3s);
}

TEST_CASE("a servo whose restart would not show is given time to grow old") {
  Bench bench;
  CHECK(bench.start() == "GetNodeInfo");
  const Time young = bench.now - 1s;
  CHECK(bench.info(1, young) == "pause");
  CHECK(bench.until() == bench.now + 1s);
  CHECK_FALSE(bench.job.is_sent());
  CHECK(bench.time_is_over() == "GetNodeInfo");
  CHECK(bench.info(1, young) == "ExecuteOpcode");
}

TEST_CASE("a servo that restarts again and again is not waited for without end") {
  Bench bench(RestartKind::restart);
  std::string said = bench.start();
  int pauses = 0;
  while (said == "GetNodeInfo" && pauses < 10) {
    said = bench.info(1, bench.now - 1s);
    if (said == "pause") {
      ++pauses;
      said = bench.time_is_over();
    }
  }
  CHECK(pauses == 4);
  CHECK(said == "nothing");
  REQUIRE(bench.job.error());
  CHECK(bench.job.error()->code == Code::state);
}

TEST_CASE("what is not certainly the servo that is meant gets no request") {
  Bench bench;
  CHECK(bench.start() == "GetNodeInfo");
  SECTION("another servo") {
    CHECK(bench.info(2, bench.now - 10s) == "nothing");
    CHECK(bench.error() == Code::state);
  }
  SECTION("another unit beside it, which has run as long") {
    CHECK(bench.info(2, bench.boot) == "nothing");
    CHECK(bench.error() == Code::duplicate_node_id);
  }
  SECTION("one that does not answer") {
    CHECK(bench.timed_out() == "nothing");
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
  CHECK_FALSE(bench.job.must_finish());
  CHECK(bench.job.returned() == std::nullopt);
  CHECK(bench.job.duration() == 0s);
  CHECK(bench.job.error()->node_id == 11);
}

TEST_CASE("a servo that refuses is not asked twice") {
  Bench bench(GENERATE(RestartKind::save, RestartKind::restart));
  bench.send();
  const Time sent = bench.now;
  CHECK(bench.answer_ok(false) == "pause");
  CHECK(bench.time_is_over() == "GetNodeInfo");
  CHECK(bench.info(1, sent - 100s) == "nothing"); // it has run on
  CHECK(bench.error() == Code::refused);
  CHECK(bench.job.returned() == std::nullopt);
  CHECK_FALSE(bench.job.must_finish());
}

TEST_CASE("a servo that refuses and restarts all the same is followed") {
  Bench bench(GENERATE(RestartKind::save, RestartKind::restart));
  bench.send();
  const Time sent = bench.now;
  CHECK(bench.answer_ok(false) == "pause");
  CHECK(bench.job.must_finish());
  bench.now = sent + 700ms;
  bench.recognize(11, 1, sent + 200ms);
  CHECK(bench.wake() == "nothing");
  CHECK(bench.job.returned() == NodeId(11));
  CHECK(bench.job.may_have_happened());
  CHECK_FALSE(bench.job.error());
}

TEST_CASE("a lost answer: the servo that is seen to restart is not asked again") {
  Bench bench;
  bench.send();
  const Time sent = bench.now;
  CHECK(bench.timed_out() == "pause");
  CHECK(bench.until() >= sent + 1s); // room for a ROM write and a start
  CHECK(bench.job.must_finish());
  SECTION("at once") {
    bench.now = sent + 700ms;
    bench.recognize(11, 1, sent + 200ms);
    CHECK(bench.wake() == "nothing");
  }
  SECTION("while the answer was waited for") {
    bench.recognize(11, 1, sent + 200ms);
    CHECK(bench.time_is_over() == "nothing");
  }
  SECTION("when it is asked how it is") {
    CHECK(bench.time_is_over() == "GetNodeInfo");
    CHECK(bench.info(1, sent + 200ms) == "nothing"); // its uptime tells
  }
  SECTION("when it is asked how it is, and is still starting") {
    CHECK(bench.time_is_over() == "GetNodeInfo");
    CHECK(bench.info(1, sent + 200ms, Mode::initialization) == "pause");
    bench.hear_status(11, sent + 200ms);
    CHECK(bench.wake() == "nothing");
  }
  SECTION("after a long silence") {
    CHECK(bench.time_is_over() == "GetNodeInfo");
    CHECK(bench.timed_out() == "pause");
    bench.now = sent + 4s;
    bench.recognize(11, 1, bench.now);
    CHECK(bench.wake() == "nothing");
  }
  CHECK(bench.steps["ExecuteOpcode"] == 1);
  CHECK(bench.job.returned() == NodeId(11));
  CHECK_FALSE(bench.job.error());
}

TEST_CASE(
    "a lost request: the servo that lives on as before is asked once more, and no third time") {
  Bench bench;
  bench.send();
  bench.timed_out();
  CHECK(bench.time_is_over() == "GetNodeInfo");
  CHECK(bench.info(1, bench.boot) == "ExecuteOpcode");
  CHECK(bench.step.request()->retries == 0);
  SECTION("with success") {
    const Duration waited = bench.job.duration(); // since the first request
    CHECK(waited >= 1500ms);
    CHECK(bench.answer_ok() == "pause");
    bench.now += 200ms;
    bench.recognize(11, 1, bench.now);
    CHECK(bench.wake() == "nothing");
    CHECK(bench.job.returned() == NodeId(11));
    CHECK(bench.job.duration() == waited + 200ms);
  }
  SECTION("with silence") {
    const Time sent = bench.now;
    CHECK(bench.answer_ok() == "pause");
    bench.wait_in_vain();
    CHECK(bench.error() == Code::not_back);
    CHECK(bench.now == sent + 5s); // from the second request on
  }
  SECTION("in vain") {
    CHECK(bench.timed_out() == "pause");
    CHECK(bench.time_is_over() == "GetNodeInfo");
    CHECK(bench.info(1, bench.boot) == "nothing");
    CHECK(bench.error() == Code::timeout);
    CHECK(bench.job.returned() == std::nullopt);
  }
  CHECK(bench.steps["ExecuteOpcode"] == 2);
}

TEST_CASE("without proof that nothing happened nothing is repeated") {
  Bench bench;
  bench.send();
  bench.timed_out();
  CHECK(bench.time_is_over() == "GetNodeInfo");
  SECTION("silence is no proof") {
    CHECK(bench.timed_out() == "pause");
    bench.wait_in_vain();
    CHECK(bench.error() == Code::not_back);
    CHECK(bench.message_of_error().find("not known") != std::string::npos);
  }
  SECTION("nor is another servo under its ID") {
    CHECK(bench.info(2, bench.now - 1s) == "pause");
  }
  SECTION("nor is another servo beside it") {
    CHECK(bench.info(2, bench.boot) == "nothing");
    CHECK(bench.error() == Code::duplicate_node_id);
  }
  SECTION("nor is a servo that restarted in the meantime and answers now") {
    CHECK(bench.info(1, bench.now - 1s) == "nothing");
    CHECK(bench.job.returned() == NodeId(11));
  }
  CHECK(bench.steps["ExecuteOpcode"] == 1);
}

TEST_CASE("a request that may still leave this machine is not sent beside another one") {
  Bench bench;
  bench.send();
  bench.now += 1s;
  CHECK(bench.next(Script::not_sent()) == "pause");
  CHECK(bench.job.is_sent());
  CHECK(bench.job.must_finish());
  CHECK(bench.time_is_over() == "GetNodeInfo");
  CHECK(bench.info(1, bench.boot) == "nothing");
  CHECK(bench.steps["ExecuteOpcode"] == 1);
  CHECK(bench.error() == Code::no_acknowledge); // the servo is not to blame
}

TEST_CASE("a servo that lives is not said to be gone") {
  Bench bench;
  bench.send();
  bench.timed_out();
  bench.time_is_over();
  CHECK(bench.timed_out() == "pause"); // GetNodeInfo is lost as well
  bench.now += 1s;
  bench.hear_status(11, bench.boot); // but it goes on as if nothing had been
  CHECK_FALSE(bench.wakes());
  bench.wait_in_vain();
  CHECK(bench.error() == Code::timeout);
  CHECK(bench.message_of_error().find("gone") == std::string::npos);
}

TEST_CASE("a servo that confirms and does not restart is found out") {
  Bench bench(GENERATE(RestartKind::save, RestartKind::restart));
  bench.send();
  const Time sent = bench.now;
  CHECK(bench.answer_ok() == "pause");
  SECTION("by what it sends") {
    bench.now += 4s;
    bench.hear_status(11, bench.boot);
    CHECK_FALSE(bench.wakes());
    bench.wait_in_vain();
  }
  SECTION("by its answer, where it sends nothing") {
    while (bench.now < sent + 4s) {
      CHECK(bench.time_is_over() == "GetNodeInfo");
      CHECK(bench.info(1, bench.boot) == "pause");
    }
    bench.wait_in_vain();
  }
  CHECK(bench.error() == Code::state);
  CHECK(bench.job.returned() == std::nullopt);
}

TEST_CASE("a servo that is heard and does not answer is not said to have run on") {
  Bench bench;
  bench.send();
  const Time sent = bench.now;
  CHECK(bench.answer_ok() == "pause");
  while (bench.now < sent + 4s) {
    bench.hear(message(dronecan::ActuatorStatus::type, 11, dronecan::ActuatorStatus{}.encode()));
    bench.time_is_over();
    bench.timed_out();
  }
  bench.wait_in_vain();
  CHECK(bench.error() == Code::not_back);
  CHECK_FALSE(bench.job.has_run_on());
  CHECK(bench.message_of_error().find("does not answer") != std::string::npos);
}

TEST_CASE("a servo that is back and not in operation is said to be back") {
  Bench bench(GENERATE(RestartKind::save, RestartKind::restart));
  bench.send();
  const Time sent = bench.now;
  CHECK(bench.answer_ok() == "pause");
  while (!bench.step.is_end()) {
    bench.step.pause() != nullptr ? bench.time_is_over()
                                  : bench.info(1, sent + 200ms, Mode::initialization);
  }
  CHECK(bench.error() == Code::not_back);
  CHECK(bench.message_of_error().find("not operational") != std::string::npos);
}

TEST_CASE("a servo that never returns is not_back, with what is known of its ROM") {
  const RestartKind kind = GENERATE(RestartKind::save, RestartKind::restart);
  Bench bench(kind);
  bench.send();
  CHECK(bench.answer_ok() == "pause");
  bench.wait_in_vain();
  CHECK(bench.error() == Code::not_back);
  CHECK(bench.job.duration() == 5s);
  CHECK((bench.message_of_error().find("ROM") != std::string::npos) == (kind == RestartKind::save));
  CHECK_FALSE(bench.job.must_finish());
}

TEST_CASE("a servo that waits for a node ID is said to do so") {
  Bench bench;
  bench.send();
  bench.answer_ok();
  const bool is_ours = GENERATE(true, false);
  Allocation request{.first_part_of_unique_id = true, .size = 6, .unique_id = {1}};
  request.unique_id[5] = is_ours ? 0 : 7;
  bench.hear(message(Allocation::type, 0, request.encode()));
  bench.wait_in_vain();
  CHECK(bench.error() == Code::not_back);
  CHECK((bench.job.error()->hint.find("allocator") != std::string::npos) == is_ours);
}

TEST_CASE("a servo is found again under another node ID") {
  Bench bench;
  bench.send();
  bench.answer_ok();
  bench.now += 300ms;
  bench.recognize(19, 2, bench.now); // another one
  CHECK_FALSE(bench.wakes());
  bench.recognize(20, 1, bench.now);
  CHECK(bench.wake() == "nothing");
  CHECK(bench.job.returned() == NodeId(20));
}

TEST_CASE("the ID that a servo had before, and left, is not its return") {
  Bench bench;
  bench.recognize(20, 1, bench.boot - 100s); // where it was two restarts ago
  bench.now += 10s;
  bench.send();
  CHECK(bench.answer_ok() == "pause");
  CHECK_FALSE(bench.wakes());
  bench.now += 300ms;
  bench.recognize(11, 1, bench.now);
  CHECK(bench.wake() == "nothing");
  CHECK(bench.job.returned() == NodeId(11));
}

TEST_CASE("another servo under its ID is not its return") {
  Bench bench;
  bench.send();
  bench.answer_ok();
  bench.now += 300ms;
  bench.recognize(11, 2, bench.now);
  CHECK_FALSE(bench.wakes());
  bench.wait_in_vain();
  CHECK(bench.error() == Code::not_back);
}

TEST_CASE("a servo is back when it is in operation") {
  Bench bench;
  bench.send();
  bench.answer_ok();
  bench.now += 300ms;
  const Time restarted = bench.now;
  SECTION("after NodeStatus said that it starts") {
    bench.recognize(11, 1, restarted, Mode::initialization);
  }
  SECTION("after it was asked before its first NodeStatus") {
    bench.recognize_by_answer(restarted, Mode::initialization);
  }
  CHECK_FALSE(bench.wakes());
  bench.now += 1s;
  bench.hear_status(11, restarted);
  CHECK(bench.wake() == "nothing");
  CHECK(bench.job.returned() == NodeId(11));
}

TEST_CASE("restarts before the request are not the one that was asked for") {
  Bench bench;
  bench.start();
  bench.recognize(11, 1, bench.now - 50s); // seen only now, and before it was identified
  CHECK(bench.roster.member(NodeId(11)).boots == 1);
  CHECK(bench.info(1, bench.now - 50s) == "ExecuteOpcode");
  CHECK(bench.answer_ok() == "pause");
  CHECK_FALSE(bench.wakes());
}

TEST_CASE("a job that is cancelled after its request does not claim that nothing was sent") {
  Bench bench;
  bench.send();
  const bool is_confirmed = GENERATE(true, false);
  if (is_confirmed) {
    bench.answer_ok();
  }
  CHECK(bench.next(Script::cancelled()) == "nothing");
  CHECK(bench.error() == Code::interrupted);
  CHECK(bench.message_of_error().find("not known") != std::string::npos);
  CHECK(bench.job.is_sent());
  CHECK_FALSE(bench.job.must_finish());
}

TEST_CASE("SAVE keeps what is in RAM now: without proof that it is what was read, none is sent") {
  Bench bench;
  const Time read = bench.now;
  bench.now += 10s; // of looking on, and of asking a person
  CHECK(bench.start() == "GetNodeInfo");
  const Duration later = GENERATE(0ms, 100ms, 3000ms);
  CHECK(bench.info(1, read + later) == "GetNodeInfo");
  CHECK(bench.info(1, read + later) == "nothing");
  CHECK(bench.job.is_unproven());
  CHECK_FALSE(bench.job.error());
  CHECK_FALSE(bench.job.is_sent());
  CHECK_FALSE(bench.job.must_finish());
  CHECK(bench.job.duration() == 0s);
}

TEST_CASE("SAVE is sent where the uptime proves that the servo ran on") {
  Bench bench;
  const Time read = bench.now;
  bench.now += 10s;
  CHECK(bench.start() == "GetNodeInfo");
  CHECK(bench.info(1, read - 2s) == "ExecuteOpcode");
  CHECK_FALSE(bench.job.is_unproven());
}

TEST_CASE("what another node has written since is not saved") {
  Bench bench;
  bench.now += 10s;
  CHECK(bench.start() == "GetNodeInfo");
  bench.other_writes(bla::address::smoothing);
  CHECK(bench.info(1, bench.boot) == "nothing");
  CHECK(bench.job.is_unproven());
  CHECK_FALSE(bench.job.is_sent());
}

TEST_CASE("no servo is sent to an ID that another unit has taken since the change began") {
  Bench bench(RestartKind::save, 4s, NodeId(20));
  CHECK(bench.start() == "pause");
  bench.now += 2s;
  bench.hear_status(20, bench.now);
  CHECK(bench.time_is_over() == "GetNodeInfo");
  CHECK(bench.info(1, bench.boot) == "nothing");
  CHECK(bench.error() == Code::duplicate_node_id);
  CHECK(bench.job.error()->node_id == 11);
  CHECK_FALSE(bench.job.is_sent());
}

TEST_CASE("a mere restart needs no proof of what RAM holds") {
  Bench bench(RestartKind::restart);
  bench.now += 10s;
  CHECK(bench.start() == "GetNodeInfo");
  CHECK(bench.info(1, bench.now - 5s) == "RestartNode");
  CHECK_FALSE(bench.job.is_unproven());
}

TEST_CASE("a servo that sends nothing by itself is called, and is back when it answers") {
  Bench bench(GENERATE(RestartKind::save, RestartKind::restart));
  bench.send();
  const Time sent = bench.now;
  CHECK(bench.answer_ok() == "pause");
  CHECK(bench.until() == sent + 1500ms); // room for a ROM write and a start
  CHECK(bench.time_is_over() == "GetNodeInfo");
  CHECK(bench.asked() == NodeId(11));
  CHECK(bench.step.request()->timeout == 500ms); // as patient as with every question
  CHECK(bench.step.request()->retries == 0);
  CHECK(bench.job.must_finish());
  SECTION("at once") {
    CHECK(bench.info(1, sent + 200ms) == "nothing");
  }
  SECTION("at the second call") {
    CHECK(bench.timed_out() == "pause");
    CHECK(bench.until() == bench.now + 1s);
    CHECK(bench.time_is_over() == "GetNodeInfo");
    CHECK(bench.info(1, sent + 2s) == "nothing");
  }
  SECTION("when it is in operation") {
    CHECK(bench.info(1, sent + 200ms, Mode::initialization) == "pause");
    CHECK_FALSE(bench.wakes());
    CHECK(bench.time_is_over() == "GetNodeInfo");
    CHECK(bench.info(1, sent + 200ms) == "nothing");
  }
  CHECK(bench.job.returned() == NodeId(11));
  CHECK_FALSE(bench.job.error());
}

TEST_CASE("a silent servo is called where it will be as well") {
  Bench bench(RestartKind::save, {}, NodeId(20));
  bench.send();
  const Time sent = bench.now;
  CHECK(bench.answer_ok() == "pause");
  CHECK(bench.time_is_over() == "GetNodeInfo");
  CHECK(bench.asked() == NodeId(20));
  SECTION("it is there") {
    CHECK(bench.info(1, sent + 200ms) == "nothing");
    CHECK(bench.job.returned() == NodeId(20));
  }
  SECTION("it is where it was") {
    CHECK(bench.timed_out() == "pause");
    CHECK(bench.time_is_over() == "GetNodeInfo");
    CHECK(bench.asked() == NodeId(11));
    CHECK(bench.info(1, sent + 200ms) == "nothing");
    CHECK(bench.job.returned() == NodeId(11));
  }
  SECTION("somebody else is there") {
    CHECK(bench.info(2, sent - 100s) == "nothing");
    CHECK(bench.error() == Code::duplicate_node_id);
    CHECK(bench.job.error()->node_id == 20);
  }
}

TEST_CASE("who has run for longer at the ID that the servo will have is another unit") {
  Bench bench(RestartKind::save, {}, NodeId(20));
  bench.send();
  SECTION("heard before SAVE is confirmed") {
    bench.now += 1ms;
    bench.hear_status(20, bench.now - 5000s);
    CHECK(bench.answer_ok() == "nothing");
  }
  SECTION("heard while the servo is awaited") {
    CHECK(bench.answer_ok() == "pause");
    bench.now += 300ms;
    CHECK_FALSE(bench.wakes());
    bench.hear_status(20, bench.now - 2s);
    CHECK(bench.wake() == "nothing");
  }
  CHECK(bench.error() == Code::duplicate_node_id);
  CHECK(bench.job.error()->node_id == 20);
  CHECK(bench.job.returned() == std::nullopt);
}

TEST_CASE("a restart before the request that shows late is not the one that was asked for") {
  Bench bench;
  bench.send();
  CHECK(bench.timed_out() == "pause");
  bench.hear_status(11, bench.now - 90s); // it started 10 s later than was thought
  CHECK(bench.roster.member(NodeId(11)).boots == 1);
  CHECK_FALSE(bench.wakes());
  CHECK(bench.time_is_over() == "GetNodeInfo");
  CHECK(bench.info(1, bench.now - 90s) == "ExecuteOpcode"); // SAVE was not carried out
}

TEST_CASE("the servo itself is no other unit at the ID that it will have") {
  Bench bench(RestartKind::save, {}, NodeId(20));
  bench.send();
  const Time sent = bench.now;
  CHECK(bench.answer_ok() == "pause");
  bench.now += 1500ms;
  bench.recognize(20, 1, sent + 100ms);
  CHECK(bench.wake() == "nothing");
  CHECK_FALSE(bench.job.error());
  CHECK(bench.job.returned() == NodeId(20));
}

TEST_CASE("where a servo will be after a mere restart is not certain: others may be there") {
  Bench bench(RestartKind::restart, {}, NodeId(20));
  bench.send();
  CHECK(bench.answer_ok() == "pause");
  bench.now += 300ms;
  bench.hear_status(20, bench.now - 5000s);
  CHECK_FALSE(bench.wakes());
}

TEST_CASE("a start that somebody else tells on its ID is not that of the servo") {
  Bench bench(GENERATE(RestartKind::save, RestartKind::restart));
  bench.send();
  bench.answer_ok();
  bench.now += 30ms;
  bench.hear_status(11, bench.now); // a unit that was just switched on
  bench.hear_info(bench.boot);      // the servo has not gone
  CHECK(bench.wake() == "nothing");
  CHECK(bench.error() == Code::duplicate_node_id);
  CHECK(bench.job.returned() == std::nullopt);
}

TEST_CASE("a servo that answers for the last time before it goes is not back") {
  Bench bench;
  bench.send();
  bench.answer_ok();
  bench.hear_status(11, bench.now - 200ms); // its age tells no two starts apart
  bench.hear_info(bench.now - 2s);
  CHECK_FALSE(bench.wakes());
  bench.now += 900ms;
  bench.recognize(11, 1, bench.now);
  CHECK(bench.wake() == "nothing");
  CHECK(bench.job.returned() == NodeId(11));
}

TEST_CASE("a servo on whose ID another unit shows is not said to be back") {
  const auto id = GENERATE(as<std::uint8_t>{}, 11, 20); // its own ID, and the one it will have
  Bench bench(RestartKind::save, {}, NodeId(20));
  bench.send();
  CHECK(bench.answer_ok() == "pause");
  bench.now += 300ms;
  bench.roster.mark_doubled(NodeId(id), {1}, {2});
  CHECK(bench.wake() == "nothing");
  CHECK(bench.error() == Code::duplicate_node_id);
  CHECK(bench.job.error()->node_id == id);
  CHECK(bench.message_of_error().find("uid:02") != std::string::npos);
  CHECK(bench.job.returned() == std::nullopt);
  CHECK(bench.job.is_sent());
  CHECK_FALSE(bench.job.must_finish());
}

TEST_CASE("nothing is sent to an ID that two units have") {
  Bench bench(GENERATE(RestartKind::save, RestartKind::restart));
  CHECK(bench.start() == "GetNodeInfo");
  bench.roster.mark_doubled(NodeId(11), {1}, {2});
  CHECK(bench.info(1, bench.boot) == "nothing");
  CHECK(bench.error() == Code::duplicate_node_id);
  CHECK_FALSE(bench.job.is_sent());
}
