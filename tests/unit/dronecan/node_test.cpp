#include "blactl/dronecan/node.hpp"

#include "catch.hpp"
#include "support.hpp"

#include <array>
#include <deque>
#include <memory>
#include <utility>

using namespace blactl;
using namespace blactl::dronecan;
using namespace blactl::dronecan::test;

using Kinds = std::vector<Outcome::Kind>;
using Lines = std::vector<std::string>;

namespace {

/// A node on a bench: what it sends is kept, time is told by hand.
class Bench {
 public:
  explicit Bench(NodeId local = NodeId(127))
      : node(local, local.is_unicast() ? &ids_ : nullptr,
             {.name = "blactl", .unique_id = {0xB1, 0xAC}, .major = 1, .minor = 2},
             {.send = [this](const can::Frame& frame) { frames_.push_back(frame); },
              .transfer =
                  [this](const Transfer& transfer) {
                    if (on_transfer) {
                      on_transfer(transfer);
                    }
                  },
              .error = {},
              .backlog = [this] { return backlog; },
              .withdraw =
                  [this](std::span<const can::Frame> frames) {
                    for (const auto& line : texts(frames)) {
                      withdrawn.push_back(line);
                    }
                  },
              .asked =
                  [this](const Request& request, int tries) {
                    told.push_back(fmt::format("asked {} {}", request.server.value(), tries));
                  },
              .unanswered =
                  [this](const Request& request, int tries) {
                    told.push_back(fmt::format("unanswered {} {}", request.server.value(), tries));
                  }}) {
    node.advance(now);
  }

  /// Lets time pass, in one step.
  void pass(Duration duration) {
    now += duration;
    node.advance(now);
  }

  /// The frames since the last call.
  Lines sent() { return texts(std::exchange(frames_, {})); }

  /// The same, and each comes back as acknowledged.
  Lines sent_and_echoed() {
    const auto frames = std::exchange(frames_, {});
    for (const auto& frame : frames) {
      node.sent(frame, now);
    }
    return texts(frames);
  }

  /// A service answer of `server`.
  void answer(std::uint8_t server, const DataType& type, TransferId id, const Payload& payload,
              std::uint8_t client = 127) {
    const Header header{.kind = Kind::response,
                        .priority = priority_service,
                        .data_type_id = type.id,
                        .source = NodeId(server),
                        .destination = NodeId(client)};
    for (const auto& frame : segment(header, id, type.signature, payload.bytes())) {
      node.receive(frame, now);
    }
  }

  void answer_info(std::uint8_t server, TransferId id) {
    answer(server, GetNodeInfo::type, id, GetNodeInfo::Response{.name = "servo"}.encode());
  }

  /// A message of somebody else.
  void hear_a_status(std::uint8_t source = 30) {
    const Header header{
        .kind = Kind::message, .data_type_id = NodeStatus::type.id, .source = NodeId(source)};
    for (const auto& frame : segment(header, heard_++ % transfer_id_modulus,
                                     NodeStatus::type.signature, NodeStatus{}.encode().bytes())) {
      node.receive(frame, now);
    }
  }

  std::size_t backlog = 0;
  Lines told;      ///< of questions
  Lines withdrawn; ///< frames that shall not leave any more
  std::function<void(const Transfer&)> on_transfer;
  Time now = at(0ms);

 private:
  std::array<TransferIds::Slot, TransferIds::slots> table_{};
  TransferIds ids_{table_};
  std::vector<can::Frame> frames_;
  TransferId heard_ = 0;

 public:
  Node node;
};

Request ask_info(std::uint8_t server, int retries = 2, Duration timeout = 500ms) {
  return {.server = NodeId(server),
          .type = &GetNodeInfo::type,
          .payload = GetNodeInfo::Request{}.encode(),
          .timeout = timeout,
          .retries = retries,
          .accepts = {}};
}

Request ask_register(std::uint8_t server, const char* name, GetSet::Value value = {}) {
  return {.server = NodeId(server),
          .type = &GetSet::type,
          .payload = GetSet::Request{.value = std::move(value), .name = name}.encode(),
          .accepts = [name = std::string(name)](Bytes payload) {
            const auto response = GetSet::Response::decode(payload);
            return response && response->name == name;
          }};
}

/// Goes its steps one after the other and writes down how each ended.
class Talk final : public Job {
 public:
  explicit Talk(std::vector<Step> steps) : steps_(steps.begin(), steps.end()) {}

  Step next(const Outcome& outcome) override {
    outcomes.push_back(outcome.kind);
    payloads.push_back(hex(outcome.payload));
    ended_at = outcome.at;
    if (on_outcome) {
      on_outcome(outcome);
    }
    if (steps_.empty()) {
      return std::nullopt;
    }
    Step step = std::move(steps_.front());
    steps_.pop_front();
    return step;
  }

  [[nodiscard]] bool must_finish() const override { return finishes; }

  Kinds outcomes;
  bool finishes = false; ///< it must not be left half done
  std::vector<std::string> payloads;
  Time ended_at{};
  std::function<void(const Outcome&)> on_outcome;

 private:
  std::deque<Step> steps_;
};

constexpr auto start = Outcome::Kind::start;
constexpr auto answered = Outcome::Kind::answered;
constexpr auto timed_out = Outcome::Kind::timed_out;
constexpr auto not_sent = Outcome::Kind::not_sent;
constexpr auto woken = Outcome::Kind::woken;
constexpr auto cancelled = Outcome::Kind::cancelled;
constexpr auto not_recorded = Outcome::Kind::not_recorded;
constexpr auto withheld = Outcome::Kind::withheld;

} // namespace

TEST_CASE("a question goes out at once, and its answer ends the job") {
  Bench bench;
  Talk talk({ask_info(10)});
  bench.node.start(talk, bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C0"});
  CHECK(bench.node.jobs() == 1);
  bench.pass(2ms);
  bench.answer_info(10, 0);
  CHECK(talk.outcomes == Kinds{start, answered});
  CHECK(talk.payloads.back() == hex(GetNodeInfo::Response{.name = "servo"}.encode().bytes()));
  CHECK(talk.ended_at == bench.now);
  CHECK(bench.node.jobs() == 0);
  CHECK(bench.sent().empty());
}

TEST_CASE("a read and a write of a register are these frames", "[requirement-68]") {
  Bench bench;
  Talk read({ask_register(11, "0x38")});
  Talk write({ask_register(12, "0x38", std::int64_t{900})});
  bench.node.start(read, bench.now);
  CHECK(bench.sent() == Lines{"1E0B8BFF#000030783338C0"});
  bench.node.start(write, bench.now);
  CHECK(bench.sent() ==
        Lines{"1E0B8CFF#B477000184030080", "1E0B8CFF#0000000000307820", "1E0B8CFF#333840"});
}

TEST_CASE("one question is in flight for one server, and the next job waits for its turn") {
  Bench bench;
  Talk first({ask_info(10), ask_info(10)});
  Talk second({ask_info(10)});
  bench.node.start(first, bench.now);
  bench.node.start(second, bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C0"});
  bench.answer_info(10, 0);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C1"}); // one of the two, not both
  bench.answer_info(10, 1);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C2"});
  bench.answer_info(10, 2);
  CHECK(first.outcomes == Kinds{start, answered, answered});
  CHECK(second.outcomes == Kinds{start, answered});
  CHECK(bench.node.jobs() == 0);
}

TEST_CASE("as many servers are busy as there are jobs") {
  Bench bench;
  std::vector<std::unique_ptr<Talk>> talks;
  for (std::uint8_t server = 1; server <= 125; ++server) {
    talks.push_back(std::make_unique<Talk>(std::vector<Step>{ask_info(server), ask_info(server)}));
    bench.node.start(*talks.back(), bench.now);
  }
  CHECK(bench.sent_and_echoed().size() == 125);
  for (std::uint8_t server = 125; server >= 1; --server) { // answers come in any order
    bench.answer_info(server, 0);
    CHECK(bench.sent_and_echoed() == Lines{fmt::format("1E01{:02X}FF#C1", 0x80 | server)});
  }
  for (std::uint8_t server = 1; server <= 125; ++server) {
    bench.answer_info(server, 1);
  }
  CHECK(bench.node.jobs() == 0);
  for (const auto& talk : talks) {
    CHECK(talk->outcomes == Kinds{start, answered, answered});
  }
}

TEST_CASE("an unanswered question is tried again with a new transfer ID each time, then given up") {
  Bench bench;
  Talk talk({ask_info(10, 2)});
  bench.node.start(talk, bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C0"});
  bench.pass(499ms);
  CHECK(bench.sent().empty());
  bench.pass(1ms);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C1"});
  bench.pass(500ms);
  CHECK(bench.sent_and_echoed() == Lines{"1001557F#01000000000000C0", "1E018AFF#C2"});
  CHECK(talk.outcomes == Kinds{start});
  bench.pass(500ms);
  CHECK(talk.outcomes == Kinds{start, timed_out});
  CHECK(bench.sent().empty());
  CHECK(bench.node.jobs() == 0);
  CHECK(bench.told == Lines{"asked 10 1", "unanswered 10 1", "asked 10 2", "unanswered 10 2",
                            "asked 10 3", "unanswered 10 3"});
}

TEST_CASE("a request that may not leave is withheld, and the next job gets its turn") {
  Bench bench;
  bool may_leave = false;
  Request guarded = ask_register(10, "0x38", std::int64_t{900});
  guarded.may_leave = [&](Time now) {
    CHECK(now == bench.now);
    return may_leave;
  };
  Talk talk({guarded, guarded, ask_info(10)});
  Talk other({ask_info(10)});
  bench.node.start(talk, bench.now);
  bench.node.start(other, bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C0"});
  CHECK(talk.outcomes == Kinds{start, withheld, withheld});
  Talk last({guarded});
  bench.node.start(last, bench.now);
  may_leave = true; // it waited for its turn, and is asked for then
  bench.answer_info(10, 0);
  bench.sent_and_echoed();
  may_leave = false;
  bench.answer_info(10, 1);
  CHECK(bench.sent().empty());
  CHECK(last.outcomes == Kinds{start, withheld});
  CHECK(bench.node.jobs() == 0);
}

TEST_CASE("a request that was sent and may not be repeated is unanswered") {
  Bench bench;
  bool may_leave = true;
  Request guarded = ask_register(10, "0x38", std::int64_t{900});
  guarded.may_leave = [&](Time /*now*/) { return may_leave; };
  Talk talk({guarded});
  bench.node.start(talk, bench.now);
  CHECK(bench.sent_and_echoed().size() == 3);
  may_leave = false;
  bench.pass(500ms);
  CHECK(bench.sent().empty());
  CHECK(talk.outcomes == Kinds{start, timed_out});
}

TEST_CASE("without retries a question is asked once") {
  Bench bench;
  Talk talk({ask_info(10, 0)});
  bench.node.start(talk, bench.now);
  CHECK(bench.sent_and_echoed().size() == 1);
  bench.pass(500ms);
  CHECK(talk.outcomes == Kinds{start, timed_out});
  CHECK(bench.sent().empty());
}

TEST_CASE("a late answer to an earlier try is no answer") {
  Bench bench;
  Talk talk({ask_info(10)});
  bench.node.start(talk, bench.now);
  bench.sent_and_echoed();
  bench.pass(500ms);
  bench.sent_and_echoed();
  bench.answer_info(10, 0);
  CHECK(talk.outcomes == Kinds{start});
  bench.answer_info(10, 1);
  CHECK(talk.outcomes == Kinds{start, answered});
}

TEST_CASE("what is not the answer to this question is no answer", "[requirement-12]") {
  Bench bench;
  Talk talk({ask_register(10, "0x38")});
  bench.node.start(talk, bench.now);
  bench.sent_and_echoed();
  const auto value = [](const char* name) {
    return GetSet::Response{.value = std::int64_t{5}, .name = name}.encode();
  };
  SECTION("another transfer ID") {
    bench.answer(10, GetSet::type, 1, value("0x38"));
  }
  SECTION("another server") {
    bench.answer(11, GetSet::type, 0, value("0x38"));
  }
  SECTION("another data type") {
    bench.answer_info(10, 0);
  }
  SECTION("another client") {
    bench.answer(10, GetSet::type, 0, value("0x38"), 126);
  }
  SECTION("another parameter") {
    bench.answer(10, GetSet::type, 0, value("0x39"));
  }
  SECTION("a payload that is no answer at all") {
    bench.answer(10, GetSet::type, 0, Payload(unhex("FF")));
  }
  CHECK(talk.outcomes == Kinds{start});
  CHECK(bench.sent().empty());
  bench.pass(3s); // the strict receiver forgets what it has heard under this transfer ID
  CHECK(bench.sent_and_echoed().back() == "1E0B8AFF#000030783338C1");
  bench.answer(10, GetSet::type, 1, value("0x38"));
  CHECK(talk.outcomes == Kinds{start, answered});
}

TEST_CASE("an answer that comes twice is one answer") {
  Bench bench;
  Talk talk({ask_info(10), ask_info(10)});
  bench.node.start(talk, bench.now);
  bench.sent_and_echoed();
  bench.answer_info(10, 0);
  bench.answer_info(10, 0);
  CHECK(talk.outcomes == Kinds{start, answered});
  CHECK(bench.sent() == Lines{"1E018AFF#C1"});
}

TEST_CASE("the time for an answer counts from the echo of the question's last frame") {
  Bench bench;
  Talk talk({ask_register(12, "0x38", std::int64_t{900})});
  bench.node.start(talk, bench.now);
  const auto frames = bench.sent();
  REQUIRE(frames.size() == 3);
  bench.pass(900ms); // the bus is full
  bench.node.sent(frame(frames[0]), bench.now);
  bench.node.sent(frame(frames[1]), bench.now);
  CHECK(bench.node.next_deadline() == at(1s)); // two of three frames are not the question
  bench.node.sent(frame(frames[2]), bench.now);
  bench.pass(499ms);
  bench.sent(); // our own NodeStatus
  CHECK(talk.outcomes == Kinds{start});
  bench.pass(1ms);
  CHECK(bench.sent().size() == 3); // the second try
}

TEST_CASE("a question that never leaves is not tried again") {
  Bench bench;
  Talk talk({ask_info(10)});
  bench.node.start(talk, bench.now);
  CHECK(bench.sent().size() == 1);
  bench.pass(999ms);
  CHECK(talk.outcomes == Kinds{start});
  bench.pass(1ms);
  CHECK(talk.outcomes == Kinds{start, not_sent});
  CHECK(bench.sent() == Lines{"1001557F#01000000000000C0"}); // our NodeStatus and nothing else
}

TEST_CASE("the echo of another question does not start the time of this one") {
  Bench bench;
  Talk one({ask_info(10)});
  Talk other({ask_info(11)});
  bench.node.start(one, bench.now);
  bench.node.start(other, bench.now);
  bench.node.sent(frame("1E018BFF#C0"), bench.now);
  bench.pass(500ms);
  CHECK(bench.sent() == Lines{"1E018AFF#C0", "1E018BFF#C0", "1E018BFF#C1"});
}

TEST_CASE("a question whose echo was lost is waited for and tried again as if it had come") {
  Bench bench;
  Talk talk({ask_info(10)});
  bench.node.start(talk, bench.now);
  CHECK(bench.sent() == Lines{"1E018AFF#C0"});
  bench.pass(100ms);
  bench.node.echoes_lost(bench.now);
  bench.pass(499ms);
  CHECK(bench.sent().empty());
  bench.pass(1ms);
  CHECK(bench.sent() == Lines{"1E018AFF#C1"});
}

TEST_CASE("cancel_all ends what is asked and what waits, and sends nothing more") {
  Bench bench;
  Talk asked({ask_info(10), ask_info(10)});
  Talk waiting({ask_info(10)});
  bench.node.start(asked, bench.now);
  bench.node.start(waiting, bench.now);
  bench.sent_and_echoed();
  bench.node.cancel_all(bench.now);
  CHECK(asked.outcomes == Kinds{start, cancelled}); // its second question is not asked
  CHECK(waiting.outcomes == Kinds{start, cancelled});
  CHECK(bench.node.jobs() == 0);
  bench.answer_info(10, 0);
  bench.pass(600ms);
  CHECK(bench.sent().empty());
  CHECK(asked.outcomes.size() == 2);
}

TEST_CASE("cancel ends one job; the others go on") {
  Bench bench;
  Talk doomed({ask_info(10), ask_info(10)});
  Talk other({ask_info(11)});
  bench.node.start(doomed, bench.now);
  bench.node.start(other, bench.now);
  bench.sent_and_echoed();
  CHECK(bench.node.is_running(doomed));
  bench.node.cancel(doomed, bench.now);
  CHECK(doomed.outcomes == Kinds{start, cancelled});
  CHECK_FALSE(bench.node.is_running(doomed));
  CHECK(bench.node.is_running(other));
  CHECK(bench.node.jobs() == 1);
  CHECK(bench.sent().empty()); // its second question is not asked
  bench.answer_info(10, 0);    // too late
  bench.answer_info(11, 0);
  CHECK(doomed.outcomes.size() == 2);
  CHECK(other.outcomes == Kinds{start, answered});
}

TEST_CASE("cancel ends a job that pauses, that waits for its turn, that must finish") {
  Bench bench;
  Talk pausing({Pause{}});
  Talk asked({ask_info(10)});
  Talk waiting({ask_info(10)});
  Talk finishing({ask_info(11)});
  finishing.finishes = true;
  for (Talk* talk : {&pausing, &asked, &waiting, &finishing}) {
    bench.node.start(*talk, bench.now);
  }
  bench.sent_and_echoed();
  for (Talk* talk : {&pausing, &waiting, &finishing}) {
    bench.node.cancel(*talk, bench.now);
    CHECK(talk->outcomes == Kinds{start, cancelled});
  }
  CHECK(bench.node.is_running(asked));
  CHECK(bench.node.jobs() == 1);
}

TEST_CASE("a job that is cancelled leaves its server to the one that waits for it") {
  Bench bench;
  Talk doomed({ask_info(10)});
  Talk waiting({ask_info(10)});
  bench.node.start(doomed, bench.now);
  bench.node.start(waiting, bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C0"});
  bench.node.cancel(doomed, bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C1"});
  bench.answer_info(10, 0); // meant for the one that is gone
  CHECK(waiting.outcomes == Kinds{start});
  bench.answer_info(10, 1);
  CHECK(waiting.outcomes == Kinds{start, answered});
}

TEST_CASE("what has not left of a cancelled question leaves no more") {
  Bench bench;
  Talk doomed({ask_register(12, "0x38", std::int64_t{900})});
  bench.node.start(doomed, bench.now);
  const Lines question = bench.sent();
  bench.node.cancel(doomed, bench.now);
  CHECK(bench.withdrawn == question);
}

TEST_CASE("to cancel what never began or has ended does nothing") {
  Bench bench;
  Talk never_begun({ask_info(10)});
  Talk ended({});
  bench.node.start(ended, bench.now);
  bench.node.cancel(never_begun, bench.now);
  bench.node.cancel(ended, bench.now);
  CHECK(never_begun.outcomes.empty());
  CHECK(ended.outcomes == Kinds{start});
  CHECK_FALSE(bench.node.is_running(never_begun));
  CHECK(bench.sent().empty());
}

TEST_CASE("a job may cancel another one, before or behind it, while it is told of an outcome") {
  const bool before = GENERATE(true, false);
  Bench bench;
  Talk doomed({ask_info(10)});
  Talk judge({ask_info(11), ask_info(11)});
  judge.on_outcome = [&](const Outcome& outcome) {
    if (outcome.answered()) {
      bench.node.cancel(doomed, bench.now);
      CHECK_FALSE(bench.node.is_running(doomed));
    }
  };
  bench.node.start(before ? doomed : judge, bench.now);
  bench.node.start(before ? judge : doomed, bench.now);
  bench.sent_and_echoed();
  bench.answer_info(11, 0);
  CHECK(doomed.outcomes == Kinds{start, cancelled});
  CHECK(judge.outcomes == Kinds{start, answered}); // and goes on
  CHECK(bench.sent_and_echoed() == Lines{"1E018BFF#C1"});
  CHECK(bench.node.jobs() == 1);
}

TEST_CASE("a job that is cancelled while it is told of its own outcome does not go on") {
  Bench bench;
  Talk doomed({ask_info(10), ask_info(10), ask_info(10)});
  doomed.on_outcome = [&](const Outcome& outcome) {
    if (outcome.answered()) {
      bench.node.cancel(doomed, bench.now); // its owner gives it up, because of what was heard
    }
  };
  bench.node.start(doomed, bench.now);
  bench.sent_and_echoed();
  bench.answer_info(10, 0);
  CHECK_FALSE(bench.node.is_running(doomed));
  CHECK(bench.node.jobs() == 0);
  CHECK(bench.sent().empty());
}

TEST_CASE("a job that is cancelled may start another one, which is cancelled with it") {
  Bench bench;
  Talk first({ask_info(10)});
  Talk second({ask_info(11)});
  first.on_outcome = [&](const Outcome& outcome) {
    if (outcome.kind == cancelled) {
      bench.node.start(second, bench.now);
    }
  };
  bench.node.start(first, bench.now);
  bench.sent();
  bench.node.cancel_all(bench.now);
  CHECK(second.outcomes == Kinds{start, cancelled});
  CHECK(bench.node.jobs() == 0);
  CHECK(bench.sent().empty());
}

TEST_CASE("a job may start others, for the same server and for another one") {
  Bench bench;
  Talk first({ask_info(10), ask_info(10)});
  Talk same({ask_info(10)});
  Talk other({ask_info(11)});
  first.on_outcome = [&](const Outcome& outcome) {
    if (outcome.answered() && first.outcomes.size() == 2) {
      bench.node.start(same, bench.now);
      bench.node.start(other, bench.now);
    }
  };
  bench.node.start(first, bench.now);
  bench.sent_and_echoed();
  bench.answer_info(10, 0);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C1", "1E018BFF#C0"});
  bench.answer_info(10, 1);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C2"});
  bench.answer_info(10, 2);
  bench.answer_info(11, 0);
  CHECK(same.outcomes == Kinds{start, answered});
  CHECK(other.outcomes == Kinds{start, answered});
  CHECK(bench.node.jobs() == 0);
}

TEST_CASE("a job may start another one when it was timed out") {
  Bench bench;
  Talk first({ask_info(10, 0)});
  Talk second({ask_info(10, 0)});
  first.on_outcome = [&](const Outcome& outcome) {
    if (outcome.kind == timed_out) {
      bench.node.start(second, bench.now);
    }
  };
  bench.node.start(first, bench.now);
  bench.sent_and_echoed();
  bench.pass(500ms);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C1"});
  bench.pass(499ms);
  CHECK(second.outcomes == Kinds{start});
  CHECK(bench.node.jobs() == 1);
}

TEST_CASE("whoever hears a transfer may start a job") {
  Bench bench;
  Talk talk({ask_info(11)});
  bench.on_transfer = [&](const Transfer& transfer) {
    if (transfer.header.source == NodeId(11) && talk.outcomes.empty()) {
      bench.node.start(talk, bench.now);
    }
  };
  bench.node.receive(frame("1001550B#00000000000000C0"), bench.now);
  CHECK(bench.sent() == Lines{"1E018BFF#C0"});
}

TEST_CASE("who listens is told of an answer before the job that asked") {
  Bench bench;
  Talk talk({ask_info(10)});
  std::size_t outcomes_before = 0;
  bench.on_transfer = [&](const Transfer&) { outcomes_before = talk.outcomes.size(); };
  bench.node.start(talk, bench.now);
  bench.sent_and_echoed();
  bench.answer_info(10, 0);
  CHECK(outcomes_before == 1);
}

TEST_CASE("who listens is not told of an answer that nobody waits for") {
  Bench bench;
  Talk talk({ask_info(10)});
  int heard = 0;
  bench.on_transfer = [&](const Transfer&) { ++heard; };
  bench.node.start(talk, bench.now);
  bench.sent_and_echoed();
  bench.answer_info(10, 0);
  CHECK(heard == 1);
  bench.answer_info(11, 0);
  CHECK(heard == 1);
}

TEST_CASE("a job that asks nothing is over at once") {
  Bench bench;
  Talk talk({});
  bench.node.start(talk, bench.now);
  CHECK(talk.outcomes == Kinds{start});
  CHECK(bench.node.jobs() == 0);
  CHECK(bench.sent().empty());
}

TEST_CASE("a step is a question, a pause, or the end") {
  const Step question = ask_info(10);
  CHECK((question.request() != nullptr && question.request()->server == NodeId(10)));
  CHECK_FALSE((question.pause() != nullptr || question.is_end()));
  const Step pause = Pause{.until = at(1s)};
  CHECK((pause.pause() != nullptr && pause.pause()->until == at(1s)));
  CHECK_FALSE((pause.request() != nullptr || pause.is_end()));
  CHECK(Step(std::nullopt).is_end());
  CHECK(Step(std::optional<Request>()).is_end());
  CHECK(Step(std::optional(ask_info(10))).request() != nullptr);
}

TEST_CASE("only an answer is an answer") {
  CHECK(Outcome{.kind = answered, .payload = {}}.answered());
  for (const auto kind : {start, timed_out, not_sent, woken, cancelled, not_recorded}) {
    CHECK_FALSE(Outcome{.kind = kind, .payload = {}}.answered());
  }
}

TEST_CASE("a pause is over at its time, and asks nothing until then") {
  Bench bench;
  Talk talk({Pause{.until = at(900ms)}, ask_info(10)});
  bench.node.start(talk, bench.now);
  CHECK(bench.node.next_deadline() == at(900ms));
  bench.pass(899ms);
  bench.hear_a_status(); // it waits for nothing that could be heard
  CHECK(talk.outcomes == Kinds{start});
  CHECK(bench.node.jobs() == 1);
  CHECK(bench.sent().empty());
  bench.pass(1ms);
  CHECK(talk.outcomes == Kinds{start, woken});
  CHECK(talk.ended_at == at(900ms));
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C0"});
  bench.answer_info(10, 0);
  CHECK(talk.outcomes == Kinds{start, woken, answered});
  CHECK(bench.node.jobs() == 0);
}

TEST_CASE("a pause ends as soon as what it waits for was heard") {
  Bench bench;
  bool is_there = false;
  Talk talk({Pause{.until = at(10s), .ready = [&] { return is_there; }}, ask_info(10)});
  bench.on_transfer = [&](const Transfer& transfer) {
    is_there = is_there || transfer.header.source == NodeId(10);
  };
  bench.node.start(talk, bench.now);
  bench.pass(500ms);
  bench.hear_a_status(30); // not this one
  CHECK(talk.outcomes == Kinds{start});
  bench.pass(100ms);
  bench.hear_a_status(10); // told to those who listen before the job is asked
  CHECK(talk.outcomes == Kinds{start, woken});
  CHECK(talk.ended_at == at(600ms));
  CHECK(bench.sent() == Lines{"1E018AFF#C0"});
}

TEST_CASE("a pause for what is never heard ends at its time") {
  Bench bench;
  Talk talk({Pause{.until = at(700ms), .ready = [] { return false; }}});
  bench.node.start(talk, bench.now);
  bench.pass(699ms);
  bench.hear_a_status();
  CHECK(talk.outcomes == Kinds{start});
  bench.pass(1ms);
  CHECK(talk.outcomes == Kinds{start, woken});
  CHECK(bench.node.jobs() == 0);
}

TEST_CASE("a pause without a time waits for what it waits for alone") {
  Bench bench(anonymous); // whose next deadline is its jobs' alone
  bool is_there = false;
  Talk talk({Pause{.ready = [&] { return is_there; }}});
  bench.node.start(talk, bench.now);
  CHECK(bench.node.next_deadline() == never);
  bench.pass(1h);
  CHECK(talk.outcomes == Kinds{start});
  is_there = true;
  bench.hear_a_status();
  CHECK(talk.outcomes == Kinds{start, woken});
}

TEST_CASE("two pauses one after the other each have their own end") {
  Bench bench;
  unsigned heard = 0;
  Talk talk({Pause{.until = at(10s), .ready = [&] { return heard > 0; }},
             Pause{.until = at(10s), .ready = [&] { return heard > 1; }}});
  bench.on_transfer = [&](const Transfer&) { ++heard; };
  bench.node.start(talk, bench.now);
  bench.hear_a_status();
  CHECK(talk.outcomes == Kinds{start, woken});
  bench.hear_a_status();
  CHECK(talk.outcomes == Kinds{start, woken, woken});
  CHECK(bench.node.jobs() == 0);
}

TEST_CASE("who pauses keeps no server busy") {
  Bench bench;
  Talk pausing({ask_info(10), Pause{.until = at(10s)}});
  Talk waiting({ask_info(10)});
  bench.node.start(pausing, bench.now);
  bench.node.start(waiting, bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C0"});
  bench.answer_info(10, 0);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C1"});
  bench.answer_info(10, 1);
  CHECK(waiting.outcomes == Kinds{start, answered});
  CHECK(pausing.outcomes == Kinds{start, answered});
}

TEST_CASE("the echo and the answer of others do not end a pause") {
  Bench bench;
  Talk pausing({Pause{.until = at(10s)}});
  Talk asking({ask_info(10)});
  bench.node.start(pausing, bench.now);
  bench.node.start(asking, bench.now);
  bench.sent_and_echoed();
  bench.node.echoes_lost(bench.now);
  bench.answer_info(10, 0);
  bench.pass(5s);
  CHECK(pausing.outcomes == Kinds{start});
  CHECK(asking.outcomes == Kinds{start, answered});
}

TEST_CASE("a listener's pause may end; the question behind it is not asked") {
  Bench bench(anonymous);
  Talk talk({Pause{.until = at(1s)}, ask_info(10), ask_info(10)});
  bench.node.start(talk, bench.now);
  bench.pass(1s);
  CHECK(talk.outcomes == Kinds{start, woken, not_sent});
  CHECK(bench.node.jobs() == 0);
  bench.pass(10s);
  CHECK(bench.sent().empty());
  CHECK(talk.outcomes.size() == 3);
}

TEST_CASE("stop ends what may be left half done, and nothing else") {
  Bench bench;
  Talk idle({ask_info(10), ask_info(10)});
  Talk pausing({Pause{.until = at(10s)}});
  Talk writing({ask_info(11), Pause{.until = at(1500ms)}, ask_info(11)});
  writing.finishes = true;
  bench.node.start(idle, bench.now);
  bench.node.start(pausing, bench.now);
  bench.node.start(writing, bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C0", "1E018BFF#C0"});
  bench.pass(10ms);
  bench.node.stop(bench.now);
  CHECK(idle.outcomes == Kinds{start, cancelled}); // its second question is not asked
  CHECK(idle.ended_at == bench.now);
  CHECK(pausing.outcomes == Kinds{start, cancelled});
  CHECK(writing.outcomes == Kinds{start});
  CHECK(bench.node.jobs() == 1);
  bench.answer_info(10, 0);
  CHECK(idle.outcomes.size() == 2); // it hears nothing any more

  bench.answer_info(11, 0); // the other one goes on to its end: pauses, asks, is tried again
  CHECK(writing.outcomes == Kinds{start, answered});
  bench.pass(1490ms);
  CHECK(writing.outcomes == Kinds{start, answered, woken});
  CHECK(bench.sent_and_echoed().back() == "1E018BFF#C1");
  bench.pass(500ms);
  CHECK(bench.sent_and_echoed().back() == "1E018BFF#C2");
  bench.answer_info(11, 2);
  CHECK(writing.outcomes == Kinds{start, answered, woken, answered});
  CHECK(bench.node.jobs() == 0);
}

TEST_CASE("whether a job must finish is asked when it is stopped") {
  Bench bench;
  Talk writing({ask_info(10), ask_info(10)});
  bench.node.start(writing, bench.now);
  bench.sent_and_echoed();
  writing.finishes = true;
  bench.node.stop(bench.now);
  CHECK(writing.outcomes == Kinds{start});
  bench.answer_info(10, 0);
  bench.sent_and_echoed();
  writing.finishes = false;
  bench.node.stop(bench.now);
  CHECK(writing.outcomes == Kinds{start, answered, cancelled});
  CHECK(bench.node.jobs() == 0);
}

TEST_CASE("a job that must finish gets the server that a stopped one kept busy") {
  Bench bench;
  Talk reading({ask_info(10)});
  Talk writing({ask_info(10)});
  writing.finishes = true;
  bench.node.start(reading, bench.now);
  bench.node.start(writing, bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C0"});
  bench.node.stop(bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C1"});
  bench.answer_info(10, 0); // of the question that was stopped
  CHECK(writing.outcomes == Kinds{start});
  bench.answer_info(10, 1);
  CHECK(writing.outcomes == Kinds{start, answered});
}

TEST_CASE("cancel_all ends also what must finish") {
  Bench bench;
  Talk writing({ask_info(10)});
  Talk pausing({Pause{.until = at(10s)}});
  writing.finishes = pausing.finishes = true;
  bench.node.start(writing, bench.now);
  bench.node.start(pausing, bench.now);
  bench.sent_and_echoed();
  bench.node.cancel_all(bench.now);
  CHECK(writing.outcomes == Kinds{start, cancelled});
  CHECK(pausing.outcomes == Kinds{start, cancelled});
  CHECK(bench.node.jobs() == 0);
}

TEST_CASE("a job that is stopped and wants to pause or to ask is over all the same") {
  Bench bench;
  Talk asking({ask_info(10), Pause{.until = at(100ms)}});
  Talk pausing({Pause{.until = at(10s)}, ask_info(11)});
  bench.node.start(asking, bench.now);
  bench.node.start(pausing, bench.now);
  bench.sent_and_echoed();
  bench.node.stop(bench.now);
  CHECK(bench.node.jobs() == 0);
  bench.pass(900ms);
  CHECK(bench.sent().empty());
  CHECK(asking.outcomes == Kinds{start, cancelled});
  CHECK(pausing.outcomes == Kinds{start, cancelled});
}

TEST_CASE("frames of a question that is given up shall not leave any more") {
  Bench bench;
  Talk talk({ask_register(12, "0x38", std::int64_t{900})});
  Talk waiting({ask_info(12)}); // not asked yet: nothing of it is anywhere
  bench.node.start(talk, bench.now);
  bench.node.start(waiting, bench.now);
  const Lines question = bench.sent();
  REQUIRE(question.size() == 3);
  SECTION("it was stopped") {
    bench.node.stop(bench.now);
    CHECK(bench.withdrawn == question);
  }
  SECTION("it was cancelled with all others") {
    bench.node.cancel_all(bench.now);
    CHECK(bench.withdrawn == question);
  }
  SECTION("it did not leave in time") {
    bench.pass(1s);
    CHECK(talk.outcomes == Kinds{start, not_sent});
    CHECK(bench.withdrawn == question);
  }
  SECTION("a part of it has left") {
    bench.node.sent(frame(question[0]), bench.now);
    bench.node.stop(bench.now);
    CHECK(bench.withdrawn == question); // as far as they are still here
  }
}

TEST_CASE("what has left is not called back") {
  Bench bench;
  Talk talk({ask_register(12, "0x38", std::int64_t{900})});
  bench.node.start(talk, bench.now);
  bench.sent_and_echoed();
  SECTION("when it is stopped") {
    bench.node.stop(bench.now);
    CHECK(talk.outcomes == Kinds{start, cancelled});
  }
  SECTION("when it is answered") {
    bench.answer(12, GetSet::type, 0,
                 GetSet::Response{.value = std::int64_t{900}, .name = "0x38"}.encode());
    CHECK(talk.outcomes == Kinds{start, answered});
  }
  CHECK(bench.withdrawn.empty());
}

namespace {

/// The transfer IDs of another node ID.
struct OtherIds {
  std::array<TransferIds::Slot, TransferIds::slots> table{};
  TransferIds ids{table};
};

} // namespace

TEST_CASE("with a new node ID what was asked is asked again, and the old one gets no answer") {
  Bench bench;
  OtherIds other;
  Talk talk({ask_info(10, 1)});
  bench.node.start(talk, bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C0"});
  bench.pass(400ms);
  bench.node.change_id(NodeId(126), other.ids, bench.now);
  CHECK(bench.node.id() == NodeId(126));
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFE#C0"});
  bench.answer_info(10, 0); // to 127
  CHECK(talk.outcomes == Kinds{start});
  bench.pass(499ms); // all of its time
  bench.answer(10, GetNodeInfo::type, 0, GetNodeInfo::Response{.name = "servo"}.encode(), 126);
  CHECK(talk.outcomes == Kinds{start, answered});
}

TEST_CASE("the question under the old node ID is no try that failed") {
  Bench bench;
  OtherIds other;
  Talk talk({ask_info(10, 1)});
  bench.node.start(talk, bench.now);
  bench.sent_and_echoed();
  bench.node.change_id(NodeId(126), other.ids, bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFE#C0"});
  bench.pass(500ms);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFE#C1"});
  bench.pass(500ms);
  CHECK(talk.outcomes == Kinds{start, timed_out});
}

TEST_CASE("what has not left under the old node ID leaves no more") {
  Bench bench;
  OtherIds other;
  Talk talk({ask_info(10, 1)});
  bench.node.start(talk, bench.now);
  bench.node.change_id(NodeId(126), other.ids, bench.now);
  CHECK(bench.withdrawn == Lines{"1E018AFF#C0"});
}

TEST_CASE("with a new node ID nothing is sent twice that must not be") {
  Bench bench;
  OtherIds other;
  Talk once({ask_info(10, 0), ask_info(10, 0)});
  Talk waits({ask_info(10, 1)});
  bench.node.start(once, bench.now);
  bench.node.start(waits, bench.now);
  CHECK(bench.sent_and_echoed() == Lines{"1E018AFF#C0"});
  bench.node.change_id(NodeId(126), other.ids, bench.now);
  CHECK(bench.sent().empty());
  CHECK(bench.withdrawn.empty());
  bench.answer_info(10, 0); // to 127: it may be another's
  CHECK(once.outcomes == Kinds{start});
  bench.pass(500ms);
  CHECK(once.outcomes == Kinds{start, timed_out});
  CHECK(bench.sent() == Lines{"1E018AFE#C0"});
}

TEST_CASE("a node that listened first begins to live when it gets its ID") {
  Bench bench{anonymous};
  OtherIds own;
  bench.pass(5s);
  CHECK(bench.sent().empty());
  bench.node.change_id(NodeId(11), own.ids, bench.now);
  bench.node.advance(bench.now);
  bench.pass(999ms);
  CHECK(bench.sent().empty());
  bench.pass(1ms);
  CHECK(bench.sent() == Lines{"1001550B#01000000000000C0"});
  Talk talk({ask_info(10)});
  bench.node.start(talk, bench.now);
  CHECK(bench.sent() == Lines{"1E018A8B#C0"});
}

TEST_CASE("our NodeStatus comes after a second of life, then every second") {
  Bench bench;
  bench.pass(999ms);
  CHECK(bench.sent().empty());
  CHECK(bench.node.next_deadline() == at(1s));
  bench.pass(1ms);
  CHECK(bench.sent() == Lines{"1001557F#01000000000000C0"});
  bench.pass(1s);
  bench.pass(1s);
  CHECK(bench.sent() == Lines{"1001557F#02000000000000C1", "1001557F#03000000000000C2"});
}

TEST_CASE("after a long sleep our NodeStatus comes once, not once for every second that passed") {
  Bench bench;
  bench.pass(1h);
  bench.pass(0s);
  bench.pass(0s);
  CHECK(bench.sent() == Lines{"1001557F#100E0000000000C0"});
  bench.pass(999ms);
  CHECK(bench.sent().empty());
  bench.pass(1ms);
  CHECK(bench.sent() == Lines{"1001557F#110E0000000000C1"});
}

TEST_CASE("a node that only listens sends nothing, whatever it is asked to") {
  Bench bench(anonymous);
  CHECK(bench.node.next_deadline() == never);
  bench.node.receive(frame("1E018A85#C0"), bench.now);
  Talk talk({ask_info(10)});
  bench.node.start(talk, bench.now);
  bench.pass(10s);
  CHECK(bench.sent().empty());
  CHECK(talk.outcomes == Kinds{start, not_sent});
  CHECK(bench.node.jobs() == 0);
}

TEST_CASE("GetNodeInfo is answered with our name, version, unique ID and uptime") {
  Bench bench;
  bench.pass(5s);
  bench.sent();
  bench.node.receive(frame("1801FF85#C7"), bench.now); // from node 5, priority 24
  // Priority and transfer ID are those of the request.
  CHECK(bench.sent() == Lines{"180105FF#E72B050000000087", "180105FF#0000010200000027",
                              "180105FF#0000000000000007", "180105FF#0000000000B1AC27",
                              "180105FF#0000000000000007", "180105FF#0000000000000027",
                              "180105FF#00626C6163746C47"});
}

TEST_CASE("no other service of ours and no request to others is answered") {
  Bench bench;
  bench.node.receive(frame("1E0BFF85#000030783338C0"), bench.now); // GetSet
  bench.node.receive(frame("1E04FF85#C0"), bench.now);             // GetTransportStats
  bench.node.receive(frame("1E01FE85#C0"), bench.now);             // GetNodeInfo of 126
  CHECK(bench.sent().empty());
}

TEST_CASE("own services keep still while many frames wait to leave") {
  Bench bench;
  bench.backlog = 100;
  for (std::uint8_t id = 0; id < transfer_id_modulus; ++id) { // a flood of questions
    bench.node.receive(
        can::Frame{.id = 0x1E01FF85, .size = 1, .data = {static_cast<std::uint8_t>(0xC0 | id)}},
        bench.now);
  }
  bench.pass(1s);
  CHECK(bench.sent().empty());
  bench.backlog = 0;
  bench.pass(1s);
  CHECK(bench.sent() == Lines{"1001557F#02000000000000C0"});
}

TEST_CASE("a frame that is read late does not make the next question old") {
  Bench bench;
  Talk talk({ask_info(10), ask_info(10)});
  bench.node.start(talk, bench.now);
  bench.sent_and_echoed();
  // The process slept for ten seconds; the answer came in the first of them.
  bench.node.tell_time(at(10s));
  bench.answer_info(10, 0);
  CHECK(bench.sent() == Lines{"1E018AFF#C1"});
  bench.now = at(10s);
  bench.pass(999ms);
  CHECK(talk.outcomes == Kinds{start, answered});
}
