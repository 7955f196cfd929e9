#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/allocation_service.hpp"

#include "support.hpp"
#include "unit/can/fake_bus.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using can::test::FakeBus;
using can::test::Wire;
using dronecan::Kind;
using state::LocalNodeId;

namespace {

/// A session on a bus that the test writes.
struct Rig {
  explicit Rig(Session::Hearing hearing = Session::Hearing::all, bool listen_only = false) {
    std::optional<LocalNodeId> local;
    if (!listen_only) {
      local = LocalNodeId::unshared({});
    }
    auto opened =
        Session::open(std::make_unique<FakeBus>(wire), std::move(local), hearing, profiles());
    REQUIRE(opened);
    session = std::move(*opened);
  }

  void hear(const std::vector<can::Frame>& frames, Duration later = {}) {
    for (const auto& frame : frames) {
      wire.hear(frame, later);
    }
  }

  /// The answer of node 11 to a GetNodeInfo with this transfer ID.
  void answer(dronecan::TransferId id, Duration later) {
    hear(service(Kind::response, GetNodeInfo::type, 11, 127, GetNodeInfo::Response{}.encode(), id),
         later);
  }

  Wire wire;
  std::unique_ptr<Session> session;
};

/// Asks node 11 for its name, so many times.
class Ask final : public dronecan::Job {
 public:
  explicit Ask(int times = 1, Patience patience = {}) : left_(times), patience_(patience) {}

  dronecan::Step next(const Outcome& outcome) override {
    outcomes.push_back(outcome.kind);
    if (left_-- == 0) {
      return std::nullopt;
    }
    return ask(NodeId(11), GetNodeInfo::type, GetNodeInfo::Request{}.encode(), patience_);
  }

  std::vector<Outcome::Kind> outcomes;

 private:
  int left_;
  Patience patience_;
};

/// A session from the moment on when everybody gets power.
std::unique_ptr<Session> on_simulated_bus(std::string_view members) {
  const auto scenario = sim::parse_scenario(
      fmt::format(R"({{"schema": "blactl-scenario/1", "clock": "virtual", {}}})", members),
      "test.json", profiles());
  REQUIRE(scenario);
  auto session = Session::open(std::make_unique<sim::PrivateBus>("sim:", *scenario),
                               LocalNodeId::unshared({}), Session::Hearing::all, profiles());
  REQUIRE(session);
  return std::move(*session);
}

constexpr auto start = Outcome::Kind::start;
constexpr auto answered = Outcome::Kind::answered;
constexpr auto cancelled = Outcome::Kind::cancelled;

using Kinds = std::vector<Outcome::Kind>;

bool passes(const Wire& wire, const can::Frame& frame) {
  return wire.filters.empty() || std::ranges::any_of(wire.filters, [&](const can::Filter& filter) {
           return ((frame.id ^ filter.id) & filter.mask) == 0;
         });
}

} // namespace

TEST_CASE("a session waits for a bus that opens by a dialogue, and keeps what it says") {
  Rig rig;
  CHECK(rig.session->wait_until_open()); // open from the beginning
  const Time begin = rig.wire.now;
  rig.wire.open = false;
  rig.wire.happen(can::Opened{"noted"}, std::chrono::seconds(5));
  CHECK(rig.session->wait_until_open());
  CHECK(rig.wire.now == begin + std::chrono::seconds(5));
  CHECK(rig.session->opening_note() == "noted");
}

TEST_CASE("a bus that cannot be opened ends the session, as does a signal meanwhile") {
  Rig rig;
  rig.wire.open = false;
  rig.wire.happen(can::Gone{{Code::interface, "it refuses"}}, std::chrono::seconds(1));
  CHECK(rig.session->wait_until_open().error().code == Code::interface);
  Rig other;
  other.wire.open = false;
  REQUIRE(raise(SIGTERM) == 0);
  CHECK(other.session->wait_until_open().error().code == Code::interrupted);
  CHECK(other.session->signal() == SIGTERM);
}

TEST_CASE("a session lives until its deadline, and hears who is there") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 4}],
                 "foreign": [{"kind": "node", "node_id": 30}])");
  const Time begin = scene.session->now();
  scene.live(1s);
  CHECK(scene.session->now() == begin + 1s);
  CHECK(scene.roster().find(NodeId(11))->actuator_id == 4);
  CHECK(scene.roster().heard(NodeId(30)));
  CHECK(scene.roster().members().size() == 2);
  CHECK(scene.session->interface() == "sim:test.json");
}

TEST_CASE("the first frame of a session that asks nothing is its NodeStatus, after a second") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])");
  scene.live(990ms - Scene::start_time);
  CHECK(scene.sent.empty());
  scene.live(20ms);
  REQUIRE(scene.sent.size() == 1);
  CHECK(scene.sent[0].id == 0x1001557F);
  scene.live(5s);
  CHECK(scene.sent.size() == 6);
}

TEST_CASE("a session without a node ID sends nothing, and still hears") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}],
                 "foreign": [{"kind": "node", "node_id": 127}])",
              Session::Hearing::all, std::nullopt);
  scene.live(3s);
  CHECK(scene.sent.empty());
  CHECK(scene.roster().heard(NodeId(11)));
  CHECK(scene.roster().heard(NodeId(127))); // nobody's but its own
  IdentifyJob job(scene.roster(), NodeId(11), profiles(), {});
  scene.session->start(job);
  REQUIRE(scene.session->run());
  CHECK(scene.sent.empty());
}

TEST_CASE("run lives until no job is left") {
  Rig rig;
  Ask job(2);
  rig.session->start(job);
  rig.answer(0, 3ms);
  rig.answer(1, 7ms);
  const Time begin = rig.wire.now;
  REQUIRE(rig.session->run());
  CHECK(job.outcomes == Kinds{start, answered, answered});
  CHECK(rig.wire.now - begin == 7ms);
  CHECK(rig.wire.sent.size() == 2);
  REQUIRE(rig.session->run());
  CHECK(rig.wire.now - begin == 7ms);
}

TEST_CASE("run of a group lives until its jobs have ended; what else runs goes on") {
  Rig rig;

  class Idle final : public dronecan::Job {
   public:
    dronecan::Step next(const Outcome& outcome) override {
      last = outcome.kind;
      return dronecan::Pause{};
    }

    Outcome::Kind last{};
  } other;

  rig.session->start(other);
  Ask first;
  Ask second(2);
  const std::vector<dronecan::Job*> group{&first, &second};
  rig.answer(0, 3ms);
  rig.answer(1, 5ms);
  rig.answer(2, 7ms);
  const Time begin = rig.wire.now;
  REQUIRE(rig.session->run(group));
  CHECK(rig.wire.now - begin == 7ms);
  CHECK(first.outcomes.back() == answered);
  CHECK(second.outcomes.back() == answered);
  CHECK(rig.session->node().is_running(other));
  CHECK(rig.session->node().jobs() == 1);
  rig.session->cancel(other);
  CHECK(other.last == cancelled);
  CHECK(rig.session->node().jobs() == 0);
}

TEST_CASE("run of an empty group is over at once") {
  Rig rig;
  const Time begin = rig.wire.now;
  REQUIRE(rig.session->run(std::span<dronecan::Job* const>()));
  CHECK(rig.wire.now == begin);
}

TEST_CASE("a signal ends the jobs of a group and those beside it") {
  Rig rig;
  Ask other;
  rig.session->start(other);
  Ask first;
  const std::vector<dronecan::Job*> group{&first};
  REQUIRE(raise(SIGINT) == 0);
  const auto ran = rig.session->run(group);
  REQUIRE_FALSE(ran);
  CHECK(ran.error().code == Code::interrupted);
  CHECK(first.outcomes == Kinds{start, cancelled});
  CHECK(other.outcomes == Kinds{start, cancelled});
}

TEST_CASE("a signal ends the session, and what is asked is cancelled") {
  const int number = GENERATE(SIGINT, SIGTERM, SIGHUP);
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])");
  Ask job(100);
  scene.session->start(job);
  const std::size_t sent = scene.sent.size();
  REQUIRE(raise(number) == 0);
  const auto ran = scene.session->run();
  REQUIRE_FALSE(ran);
  CHECK(ran.error().code == Code::interrupted);
  CHECK(scene.session->signal() == number);
  CHECK(job.outcomes.back() == cancelled);
  CHECK(scene.session->node().jobs() == 0);
  CHECK(scene.sent.size() == sent);
}

TEST_CASE("that a terminal is gone is told twice where a shell tells it too, and is one signal") {
  const int first = GENERATE(SIGHUP, SIGTERM);
  Rig rig;
  rig.session->set_grace(10s);
  REQUIRE(raise(first) == 0);
  CHECK_FALSE(rig.session->live_until(never));
  REQUIRE(raise(SIGHUP) == 0);
  CHECK(rig.session->live_until(rig.wire.now + 1s));
  REQUIRE(raise(SIGINT) == 0);
  CHECK_FALSE(rig.session->live_until(rig.wire.now + 1s));
}

TEST_CASE("a window that changes its size ends nothing") {
  Rig rig;
  REQUIRE(raise(SIGWINCH) == 0);
  CHECK(rig.session->live_until(rig.wire.now + 100ms));
  CHECK(rig.session->signal() == 0);
}

TEST_CASE("a node ID that another node has is left to it: the session goes on with the other one") {
  const auto session = on_simulated_bus(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}],
      "foreign": [{"kind": "node", "node_id": 127}])");
  std::vector<std::string> told;
  session->on_new_id([&](const LocalNodeId& local) { told.push_back(local.passed_over()); });
  REQUIRE(session->live_until(session->now() + 3s));
  CHECK(told == std::vector<std::string>{"127 is used by another node"});
  CHECK(session->node().id() == NodeId(126));
  CHECK(session->roster().local() == NodeId(126));
  CHECK(session->roster().heard(NodeId(127)));
  IdentifyJob job(session->records(), NodeId(11), profiles(), {});
  session->start(job);
  REQUIRE(session->run());
  CHECK_FALSE(job.identification().error());
}

TEST_CASE("a session whose IDs are both another's ends") {
  const auto session = on_simulated_bus(
      R"("foreign": [{"kind": "node", "node_id": 127}, {"kind": "node", "node_id": 126}])");
  const auto lived = session->live_until(session->now() + 2s);
  REQUIRE_FALSE(lived);
  CHECK(lived.error().code == Code::no_local_node_id);
  CHECK(lived.error().hint.find("--local-node-id") != std::string::npos);
}

TEST_CASE("a session whose IDs are both taken goes on under the last one, to put things back") {
  Rig rig;
  rig.hear(message(dronecan::NodeStatus::type, 126, {}), 10ms);
  rig.hear(message(dronecan::NodeStatus::type, 127, {}), 500ms);
  CHECK_FALSE(rig.session->live_until(rig.wire.now + 2s));
  CHECK(rig.session->node().id() == NodeId(126));
  Ask ask;
  rig.session->start(ask); // with transfer IDs that are still there
  [[maybe_unused]] const auto ran = rig.session->run();
  CHECK_FALSE(ask.outcomes.empty());
}

TEST_CASE("an ID that another node is heard to have is not taken in place of our own") {
  Rig rig;
  rig.hear(message(dronecan::NodeStatus::type, 126, {}), 10ms);
  rig.hear(message(dronecan::NodeStatus::type, 127, {}), 20ms);
  const auto lived = rig.session->live_until(rig.wire.now + 30ms);
  REQUIRE_FALSE(lived);
  CHECK(lived.error().code == Code::no_local_node_id);
  SECTION("unless it is gone") {
    Rig later;
    later.hear(message(dronecan::NodeStatus::type, 126, {}), 10ms);
    later.hear(message(dronecan::NodeStatus::type, 127, {}), 10s);
    CHECK(later.session->live_until(later.wire.now + 11s));
    CHECK(later.session->node().id() == NodeId(126));
  }
}

TEST_CASE("any frame with our ID is another node's, a service too; one without an ID is not") {
  Rig rig;
  rig.hear(message(dronecan::Allocation::type, 0,
                   dronecan::Allocation{.first_part_of_unique_id = true, .size = 6}.encode()));
  CHECK(rig.session->live_until(rig.wire.now + 10ms));
  CHECK(rig.session->node().id() == NodeId(127));
  rig.hear(service(Kind::request, GetSet::type, 127, 11, GetSet::Request{}.encode()));
  CHECK(rig.session->live_until(rig.wire.now + 10ms));
  CHECK(rig.session->node().id() == NodeId(126));
  CHECK(rig.session->roster().heard(NodeId(127)));
}

TEST_CASE("with the ID the kernel filter changes") {
  Rig rig(Session::Hearing::answers);
  const auto answer =
      service(Kind::response, GetNodeInfo::type, 11, 126, GetNodeInfo::Response{}.encode(), 0)[0];
  CHECK_FALSE(passes(rig.wire, answer));
  rig.hear(service(Kind::request, GetSet::type, 127, 11, GetSet::Request{}.encode()));
  CHECK(rig.session->live_until(rig.wire.now + 10ms));
  CHECK(passes(rig.wire, answer));
}

TEST_CASE("an ID that is no tool's is listened for before it is used") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])", Session::Hearing::all,
              LocalNodeId::unshared({NodeId(60)}));
  CHECK_FALSE(scene.session->may_ask());
  const Time begin = scene.session->now();
  REQUIRE(scene.session->wait_until_open());
  CHECK(scene.session->now() - begin == bus_watch_time);
  CHECK(scene.sent.empty());
  CHECK(scene.session->node().id() == NodeId(60));
  CHECK(scene.identify(11).is_servo);
}

TEST_CASE("an ID that was asked for and is another's is not spoken with") {
  const auto scenario = sim::parse_scenario(
      R"({"schema": "blactl-scenario/1", "clock": "virtual",
          "servos": [{"model": "BLA21-12U-AB", "node_id": 11}]})",
      "test.json", profiles());
  REQUIRE(scenario);
  std::vector<can::Frame> sent;
  auto session = Session::open(
      std::make_unique<Tap>(std::make_unique<sim::PrivateBus>("sim:", *scenario), sent),
      LocalNodeId::unshared({NodeId(11)}), Session::Hearing::all, profiles());
  REQUIRE(session);
  const auto opened = (*session)->wait_until_open();
  REQUIRE_FALSE(opened);
  CHECK(opened.error().code == Code::duplicate_node_id);
  CHECK(opened.error().node_id == 11);
  CHECK(sent.empty());
}

TEST_CASE("on an empty bus nobody acknowledges: told after a tenth of a second") {
  Rig rig;
  rig.wire.echo = Wire::Echo::by_hand;
  Ask job(3);
  rig.session->start(job);
  const Time begin = rig.wire.now;
  const auto ran = rig.session->run();
  REQUIRE_FALSE(ran);
  CHECK(ran.error().code == Code::no_acknowledge);
  CHECK(rig.wire.now - begin == 100ms);
  CHECK(rig.wire.sent.size() == 1);
  CHECK(rig.session->unsent() == 1); // the controller still has it
  CHECK(job.outcomes == Kinds{start, cancelled});
}

TEST_CASE("on the simulated bus it is the same") {
  const auto session = on_simulated_bus(R"("servos": [])");
  CHECK(session->live_until(session->now() + 900ms)); // nothing was sent yet
  const auto lived = session->live_until(session->now() + 10s);
  REQUIRE_FALSE(lived);
  CHECK(lived.error().code == Code::no_acknowledge);
  CHECK(exit_status(lived.error().code) == 3);
  CHECK(session->now() - Time{} == 1100ms);
}

TEST_CASE("as long as somebody is heard an echo may take its time") {
  Rig rig;
  rig.wire.echo = Wire::Echo::by_hand;
  for (int i = 1; i < 10; ++i) {
    rig.wire.hear({.id = 0x1003F30C, .size = 1, .data = {0x40}}, i * 90ms);
  }
  Ask job;
  rig.session->start(job);
  CHECK(rig.session->live_until(rig.wire.now + 810ms));
  CHECK(rig.session->live_until(rig.wire.now + 1s).error().code == Code::no_acknowledge);
}

TEST_CASE("a bus that goes away ends the session with its error, and is asked nothing more") {
  Rig rig;
  Ask job;
  rig.session->start(job);
  rig.wire.happen(can::Gone{{Code::interface, "unplugged"}}, 1ms);
  const auto ran = rig.session->run();
  REQUIRE_FALSE(ran);
  CHECK(ran.error().code == Code::interface);
  CHECK(ran.error().message == "unplugged");
  CHECK(job.outcomes.back() == cancelled);
}

TEST_CASE("an interface that is waited for ends nothing, and who wants to know is told") {
  Rig rig;
  std::vector<bool> told;
  rig.session->on_away([&] { told.push_back(rig.session->away().has_value()); });
  rig.wire.happen(can::Away{{Code::interface, "unplugged"}}, 10ms);
  rig.wire.happen(can::Back{}, 5s);
  CHECK(rig.session->live_until(rig.wire.now + 1s));
  REQUIRE(rig.session->away());
  CHECK(rig.session->away()->message == "unplugged");
  CHECK(rig.session->live_until(rig.wire.now + 6s));
  CHECK_FALSE(rig.session->away());
  CHECK(told == std::vector<bool>{true, false});
}

TEST_CASE("bus-off ends the session, other faults do not") {
  Rig rig;
  rig.wire.happen(can::BusFault{can::FaultKind::error_passive, rig.wire.now});
  CHECK(rig.session->live_until(rig.wire.now + 10ms));
  rig.wire.happen(can::BusFault{can::FaultKind::bus_off, rig.wire.now});
  CHECK(rig.session->live_until(rig.wire.now + 10ms).error().code == Code::bus_off);
}

TEST_CASE("frames that the kernel dropped are counted") {
  Rig rig;
  rig.wire.happen(can::Overflow{7});
  rig.wire.happen(can::Overflow{12}, 1ms);
  CHECK(rig.session->live_until(rig.wire.now + 10ms));
  CHECK(rig.session->lost_frames() == 12);
}

TEST_CASE("a question whose echo was dropped is asked again if no answer comes") {
  Rig rig;
  rig.wire.echo = Wire::Echo::by_hand;
  Ask job(1, {.timeout = 50ms, .retries = 1});
  rig.session->start(job);
  rig.hear(message(dronecan::NodeStatus::type, 12, dronecan::NodeStatus{}.encode()), 1ms);
  rig.wire.happen(can::Overflow{300}, 2ms);
  rig.answer(1, 60ms);
  REQUIRE(rig.session->run());
  CHECK(rig.wire.sent.size() == 2);
  CHECK(job.outcomes == Kinds{start, answered});
}

TEST_CASE("a process that was stopped for a while takes what came meanwhile") {
  Rig rig;
  Ask job(2, {.timeout = 500ms, .retries = 0});
  rig.session->start(job);
  rig.wire.acknowledge(rig.wire.sent.at(0), 1ms);
  rig.answer(0, 2ms);
  rig.wire.now += 10s;
  rig.answer(1, 5ms);
  REQUIRE(rig.session->run());
  CHECK(job.outcomes == Kinds{start, answered, answered});
  REQUIRE(rig.wire.sent.size() == 3);
  CHECK(rig.wire.sent[2].id == 0x1001557F); // our NodeStatus, which is long due
}

TEST_CASE("a flood that never pauses does not keep the session from its deadlines") {
  Rig rig;
  Ask job(1, {.timeout = 50ms, .retries = 0});
  rig.session->start(job);
  rig.wire.acknowledge(rig.wire.sent.at(0), 1ms);
  for (int i = 0; i < 2000; ++i) {
    rig.hear(message(dronecan::NodeStatus::type, 12, dronecan::NodeStatus{}.encode()), i * 130us);
  }
  rig.wire.now += 10s; // all of it waits to be read
  REQUIRE(rig.session->run());
  CHECK(job.outcomes == Kinds{start, Outcome::Kind::timed_out});
  CHECK_FALSE(rig.wire.events.empty());
}

TEST_CASE("GetNodeInfo is answered, and a flood of questions fills no memory") {
  Rig rig;
  rig.wire.echo = Wire::Echo::by_hand;
  for (unsigned i = 0; i < 10'000; ++i) {
    rig.wire.hear({.id = 0x1E01FF80U | (1 + i % 120),
                   .size = 1,
                   .data = {static_cast<std::uint8_t>(0xC0 | (i / 120 % 32))}});
  }
  CHECK(rig.session->live_until(rig.wire.now + 1ms));
  CHECK(rig.wire.sent.size() == 3);
  CHECK(rig.session->unsent() < 30);
  CHECK(rig.wire.sent[0].id == 0x1E0101FF);
}

TEST_CASE("an answer on the terminal ends the waiting for it, and the bus lives on meanwhile") {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  Rig rig;
  rig.hear(message(dronecan::NodeStatus::type, 12, dronecan::NodeStatus{}.encode()));
  REQUIRE(write(ends[1], "y\n", 2) == 2);
  CHECK(rig.session->wait_for_input(ends[0]));
  CHECK(rig.session->live_until(rig.wire.now + 1ms)); // it is watched no longer
  CHECK(rig.session->roster().heard(NodeId(12)));
  close(ends[0]);
  close(ends[1]);
}

TEST_CASE("a signal ends the waiting for an answer, too") {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  Rig rig;
  REQUIRE(raise(SIGINT) == 0);
  CHECK(rig.session->wait_for_input(ends[0]).error().code == Code::interrupted);
  close(ends[0]);
  close(ends[1]);
}

TEST_CASE("the filter lets through what the session is about") {
  const auto hearing =
      GENERATE(Session::Hearing::answers, Session::Hearing::commands, Session::Hearing::all);
  const Rig rig(hearing);
  const auto hears = [&](const std::vector<can::Frame>& frames) {
    return passes(rig.wire, frames.front());
  };
  using dronecan::Payload;
  CHECK(hears(service(Kind::response, GetSet::type, 11, 127, Payload{})));
  CHECK(hears(service(Kind::request, GetNodeInfo::type, 5, 127, Payload{})));
  CHECK(hears(service(Kind::request, GetSet::type, 127, 11, Payload{}))); // our ID
  CHECK(hears(message(dronecan::NodeStatus::type, 11, Payload{})));
  CHECK(hears(message(dronecan::ActuatorStatus::type, 11, Payload{})));
  const bool commands = hearing != Session::Hearing::answers;
  CHECK(hears(message(dronecan::ArrayCommand::type, 30, Payload{})) == commands);
  CHECK(hears(message(dronecan::ArmingStatus::type, 30, Payload{})) == commands);
  CHECK(hears(service(Kind::request, GetSet::type, 30, 11, Payload{})) == commands);
  const bool all = hearing == Session::Hearing::all;
  CHECK(hears(service(Kind::response, GetSet::type, 11, 30, Payload{})) == all);
  CHECK(hears(message({"", 1002, false, 0}, 30, Payload{})) == all);
}

TEST_CASE("commands of another node are heard through the filter") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1}],
                 "foreign": [{"kind": "node", "node_id": 30, "armed": true,
                              "commands": {"servo_ids": [1, 2], "rate": 50}}])",
              Session::Hearing::commands);
  scene.live(1100ms);
  CHECK(scene.roster().said_armed() == NodeId(30));
  CHECK(scene.roster().driver_of(scene.member(11).servo(), scene.session->now()) == NodeId(30));
}

TEST_CASE("what is asked, and what stays without an answer, is told to who wants to know") {
  Rig rig;
  std::vector<int> asked;
  std::vector<int> unanswered;
  rig.session->on_requests(
      [&](const dronecan::Request& request, int tries) {
        CHECK(request.server == NodeId(11));
        asked.push_back(tries);
      },
      [&](const dronecan::Request&, int tries) { unanswered.push_back(tries); });
  Ask job(1, {.timeout = 50ms, .retries = 1});
  rig.session->start(job);
  REQUIRE(rig.session->run());
  CHECK(asked == std::vector{1, 2});
  CHECK(unanswered == std::vector{1, 2});
}

TEST_CASE("that anything of DroneCAN was heard is known, of whomever it is") {
  Rig rig;
  CHECK_FALSE(rig.session->heard_anything());
  CHECK_FALSE(rig.session->is_replay());
  rig.wire.hear({.id = 0x55, .extended = false, .size = 1, .data = {0xC0}}, 1ms);
  REQUIRE(rig.session->live_until(rig.wire.now + 10ms));
  CHECK_FALSE(rig.session->heard_anything());
  rig.hear(message(dronecan::Allocation::type, 0,
                   dronecan::Allocation{.first_part_of_unique_id = true, .size = 6}.encode()));
  REQUIRE(rig.session->live_until(rig.wire.now + 10ms));
  CHECK(rig.session->heard_anything());
}

TEST_CASE(
    "requests for node IDs that are never repeated keep no allocator waiting, and are forgotten") {
  Rig rig;
  auto store = state::AllocationStore::unshared().value();
  const AllocationService service(*rig.session, store, {}, [](auto, const auto&) {});
  const Time begin = service.last_request();
  const auto ask = [&](std::uint32_t unit, Duration later) {
    dronecan::Allocation part{.first_part_of_unique_id = true, .size = 6};
    for (unsigned byte = 0; byte < 4; ++byte) {
      part.unique_id[byte] = static_cast<std::uint8_t>(unit >> (byte * 8));
    }
    rig.hear(message(dronecan::Allocation::type, 0, part.encode(), unit % 32), later);
  };
  for (std::uint32_t unit = 1; unit <= 4000; ++unit) { // 400 a second
    ask(unit, 2500us * unit);
  }
  REQUIRE(rig.session->live_until(rig.wire.now + 10100ms));
  CHECK(service.last_request() == begin);
  CHECK(rig.session->roster().pending().size() < 1000);
  ask(5000, 5s);
  ask(5000, 6s);
  const Time second = rig.wire.now + 6s;
  REQUIRE(rig.session->live_until(rig.wire.now + 7s));
  CHECK(service.last_request() == second);
  CHECK(rig.session->roster().pending().size() == 1);
}
