#include "blactl/fleet/bus/discovery.hpp"

#include "support.hpp"
#include "unit/can/fake_bus.hpp"

#include <fmt/format.h>

#include <signal.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using can::test::FakeBus;
using can::test::Wire;
using dronecan::Kind;
using dronecan::NodeStatus;
using state::LocalNodeId;

namespace {

constexpr const char* two_servos_and_a_node = R"(
    "servos": [{"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 240900558},
               {"model": "BLA21-12U-AB", "node_id": 12}],
    "foreign": [{"kind": "node", "node_id": 30, "serves_get_set": true}])";
constexpr const char* one_servo =
    R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 240900558}])";
constexpr const char* nobody = R"("servos": [],
    "foreign": [{"kind": "node", "node_id": 30, "serves_get_set": true}])";

Targets targets(std::string_view list) {
  auto parsed = parse_targets(list);
  REQUIRE(parsed);
  return std::move(*parsed);
}

using Ids = std::vector<int>;

Ids ids(const Selection& selection) {
  Ids all;
  for (const NodeId id : selection.ids) {
    all.push_back(id.value());
  }
  return all;
}

/// What a search finds that listens as long as a reading command does.
Selection select(const Scene& scene, const Targets& wanted) {
  Discovery discovery(*scene.session, profiles(), {});
  auto selection = discovery.select(wanted, servo_search_time);
  REQUIRE(selection);
  return std::move(*selection);
}

std::size_t questions(const Scene& scene) {
  std::size_t all = 0;
  for (std::uint8_t id = 1; id <= NodeId::max; ++id) {
    all += scene.requests(GetNodeInfo::type, id) + scene.requests(GetSet::type, id);
  }
  return all;
}

Ids there(const Arrivals& arrivals) {
  Ids all;
  for (const Arrival& arrival : arrivals.servos) {
    if (arrival.is_there) {
      all.push_back(arrival.servo.id.value());
    }
  }
  return all;
}

/// The codes of errors and the nodes that they are about; 0: none.
std::vector<std::pair<Code, int>> codes(const std::vector<Error>& errors) {
  std::vector<std::pair<Code, int>> all;
  for (const Error& error : errors) {
    all.emplace_back(error.code, error.node_id.value_or(0));
  }
  return all;
}

using Codes = std::vector<std::pair<Code, int>>;

} // namespace

TEST_CASE("IDs that are named are taken as they are: nothing is listened to, nothing asked") {
  const Scene scene(one_servo);
  const Time begin = scene.session->now();
  const Selection selection = select(scene, targets("55,11"));
  CHECK(ids(selection) == Ids{11, 55});
  CHECK(selection.errors.empty());
  CHECK(scene.session->now() == begin);
  CHECK(scene.sent.empty());
}

TEST_CASE("without -n every servo that is heard is identified and meant, and nobody else") {
  const Scene scene(two_servos_and_a_node);
  const Time begin = scene.session->now();
  const Selection selection = select(scene, {});
  CHECK(ids(selection) == Ids{11, 12});
  CHECK(selection.errors.empty());
  CHECK(scene.requests(GetNodeInfo::type, 30) == 0); // sends no actuator.Status
  CHECK(scene.session->now() - begin >= servo_search_time);
  CHECK(scene.session->now() - begin < servo_search_time + 50ms);
}

TEST_CASE("a servo that is heard while others are asked who they are is one of all") {
  const Scene scene(R"("servos": [
      {"model": "BLA21-12U-AB", "node_id": 11, "sending": {"late_answers": 1, "late_by": "80ms"}},
      {"model": "BLA21-12U-AB", "node_id": 12, "serial_number": 7}],
    "events": [{"at": "0ms", "servo": 7, "world": {"plugged": "off"}},
               {"at": "450ms", "servo": 7, "world": {"plugged": "on"}}])");
  const Selection selection = select(scene, targets("all"));
  CHECK(ids(selection) == Ids{11, 12});
  CHECK(selection.errors.empty());
}

TEST_CASE("a selector picks those that it matches; one that matches none is told") {
  const Scene scene(two_servos_and_a_node);
  CHECK(ids(select(scene, targets("serial:240900558"))) == Ids{11});
  const Selection both = select(scene, targets("serial:240900558,serial:1"));
  CHECK(ids(both) == Ids{11});
  CHECK(codes(both.errors) == Codes{{Code::not_found, 0}});
  CHECK(both.errors[0].message.find("serial:1") != std::string::npos);
}

TEST_CASE("a servo that does not say who it is may be meant by a selector, and is not left out") {
  const Scene scene(R"("servos": [
      {"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1, "serial_number": 7},
      {"model": "BLA21-12U-AB", "node_id": 12, "servo_id": 2, "serial_number": 8,
       "faults": {"mute": true}}])");
  scene.live(300ms);
  const std::string unique_id = hex(*scene.identify(11).unique_id);
  SECTION("where it may be") {
    const std::string selector =
        GENERATE_COPY(std::string("model:BLA21"), std::string("servo:2"), std::string("serial:8"),
                      "uid:" + unique_id.substr(0, 1));
    const Selection selection = select(scene, targets(selector));
    INFO(selector);
    CHECK(codes(selection.errors) == Codes{{Code::timeout, 12}});
  }
  SECTION("where it cannot be") {
    const std::string selector =
        GENERATE_COPY(std::string("servo:1"), std::string("serial:7"), "uid:" + unique_id);
    const Selection selection = select(scene, targets(selector));
    INFO(selector);
    CHECK(selection.errors.empty());
    CHECK(ids(selection) == Ids{11});
  }
}

TEST_CASE("a selector means a servo that restarts since it was identified") {
  const Scene scene(R"("servos": [
      {"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 7,
       "faults": {"restart_after_answer": [{"to": "read", "number": 4}]}}])");
  const Selection selection = select(scene, targets("serial:7"));
  CHECK(selection.errors.empty());
  CHECK(ids(selection) == Ids{11});
}

TEST_CASE("an actuator of another make is left out, and that is said") {
  const Scene scene(one_servo);
  const auto status = dronecan::ActuatorStatus{.actuator_id = 9}.encode();
  const auto frames = message(dronecan::ActuatorStatus::type, 30, status);
  scene.roster().hear(frames.front(), scene.session->now());
  scene.roster().receive({.header = {.kind = Kind::message,
                                     .data_type_id = dronecan::ActuatorStatus::type.id,
                                     .source = NodeId(30)},
                          .payload = status.bytes(),
                          .at = scene.session->now()});
  scene.roster().learn(Servo{.id = NodeId(30)},
                       GetNodeInfo::Response{.unique_id = {30}, .name = "org.example.actuator"});
  const Selection selection = select(scene, {});
  CHECK(ids(selection) == Ids{11});
  CHECK(selection.errors.empty());
  REQUIRE(selection.notes.size() == 1);
  CHECK(selection.notes[0].find("30") != std::string::npos);
  CHECK(selection.notes[0].find("org.example.actuator") != std::string::npos);
}

TEST_CASE("a selector that matches none may mean one of two units that share an ID") {
  const Scene scene(two_servos_and_a_node);
  scene.roster().mark_doubled(NodeId(12), {1}, {2});
  const Selection selection = select(scene, targets("serial:1"));
  CHECK(selection.ids.empty());
  CHECK(codes(selection.errors) == Codes{{Code::duplicate_node_id, 12}});
  CHECK(select(scene, targets("serial:240900558")).errors.empty());
}

TEST_CASE("where there is no servo that is said, once") {
  const Scene scene(nobody);
  const Selection selection = select(scene, {});
  CHECK(selection.ids.empty());
  CHECK(codes(selection.errors) == Codes{{Code::not_found, 0}});
  CHECK(questions(scene) == 0);
}

TEST_CASE("a servo that does not answer is told, unless another one is looked for") {
  const Scene scene(
      R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11, "faults": {"mute": true}},
                                  {"model": "BLA21-12U-AB", "node_id": 12, "serial_number": 7}])");
  const Selection all = select(scene, {});
  CHECK(ids(all) == Ids{12});
  CHECK(codes(all.errors) == Codes{{Code::timeout, 11}});
  CHECK(select(scene, targets("serial:7")).errors.empty());
}

TEST_CASE("who writes without -n means the one servo there is, and listens longer for it") {
  const Scene scene(one_servo);
  const Time begin = scene.session->now();
  Discovery discovery(*scene.session, profiles(), {});
  const auto selection = discovery.select_for_writing({});
  REQUIRE(selection);
  CHECK(ids(*selection) == Ids{11});
  CHECK(scene.session->now() - begin >= bus_watch_time);
}

TEST_CASE("who writes without -n to several servos is asked which, and none is chosen") {
  const Scene scene(two_servos_and_a_node);
  Discovery discovery(*scene.session, profiles(), {});
  const auto selection = discovery.select_for_writing({});
  REQUIRE_FALSE(selection);
  CHECK(selection.error().code == Code::usage);
  CHECK(selection.error().message.find("11, 12") != std::string::npos);
  CHECK(selection.error().hint.find("-n 11") != std::string::npos);
}

TEST_CASE("who writes with -n may mean several") {
  const Scene scene(two_servos_and_a_node);
  Discovery discovery(*scene.session, profiles(), {});
  CHECK(ids(*discovery.select_for_writing(targets("all"))) == Ids{11, 12});
  CHECK(ids(*discovery.select_for_writing(targets("11-12"))) == Ids{11, 12});
}

TEST_CASE("all are found: who is heard, who is silent; servos are asked twice who they are") {
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}],
                       "foreign": [{"kind": "node", "node_id": 30, "serves_get_set": true}])");
  Discovery discovery(*scene.session, profiles(), {});
  REQUIRE(discovery.find_all(1200ms));
  CHECK(scene.member(11).is_known());
  CHECK(scene.member(11).static_node_id == 11); // for the sake of conflicts
  CHECK(scene.member(30).is_known());
  CHECK(scene.requests(GetNodeInfo::type, 11) == 2);
  CHECK(scene.requests(GetNodeInfo::type, 30) == 1);
  CHECK(scene.requests(GetNodeInfo::type, 2) == 1); // a probe
  CHECK(scene.requests(GetNodeInfo::type, 126) == 0);
  CHECK_FALSE(scene.roster().is_doubled(NodeId(11)));
  for (const auto& error : discovery.identifications()) {
    CHECK_FALSE(error);
  }
}

TEST_CASE("a session that only listens finds by listening, and asks nobody") {
  const Scene scene(one_servo, Session::Hearing::all, std::nullopt);
  Discovery discovery(*scene.session, profiles(), {});
  REQUIRE(discovery.find_all(1200ms));
  CHECK(scene.roster().heard(NodeId(11)));
  CHECK(discovery.identifications().empty());
  CHECK(scene.sent.empty());
}

TEST_CASE("who answers a search and fails is listed with the reason") {
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
                                   "faults": {"mute": true}}])");
  Discovery discovery(*scene.session, profiles(), {.patience = {.timeout = 50ms, .retries = 0}});
  REQUIRE(discovery.find_all(300ms));
  const auto ends = discovery.identifications();
  REQUIRE(ends.size() == 1);
  REQUIRE(ends[0]);
  CHECK(ends[0]->code == Code::timeout);
}

TEST_CASE("a servo that is there is not waited for any longer than it takes to ask it") {
  const Scene scene(one_servo);
  const Time begin = scene.session->now();
  Discovery discovery(*scene.session, profiles(), {});
  const Arrivals arrivals = discovery.wait_for(targets("11"), 10s);
  CHECK(there(arrivals) == Ids{11});
  CHECK(arrivals.errors.empty());
  CHECK_FALSE(arrivals.broken);
  CHECK(scene.session->now() - begin < 1100ms); // its first NodeStatus may take a second
  CHECK(arrivals.servos[0].servo.identity.model() == "BLA21-12U-AB");
}

TEST_CASE("without -n all that live have had the time to be heard") {
  const Scene scene(two_servos_and_a_node);
  const Time begin = scene.session->now();
  Discovery discovery(*scene.session, profiles(), {});
  CHECK(there(discovery.wait_for({}, 10s)) == Ids{11, 12});
  CHECK(scene.session->now() - begin >= servo_search_time);
}

TEST_CASE("who comes while a search waits for its last answers is asked who it is") {
  const Scene scene(R"("servos": [
      {"model": "BLA21-12U-AB", "node_id": 11, "faults": {"mute": true}},
      {"model": "BLA21-12U-AB", "node_id": 12, "serial_number": 7}],
    "events": [{"at": "0ms", "servo": 7, "world": {"plugged": "off"}},
               {"at": "2500ms", "servo": 7, "world": {"plugged": "on"}}])");
  Discovery discovery(*scene.session, profiles(), {.patience = {.timeout = 2s, .retries = 1}});
  REQUIRE(discovery.find_all(2s));
  CHECK(scene.member(12).is_servo);
}

TEST_CASE("nobody who was heard is half identified when a search ends") {
  int heard = 0, unheard = 0;
  for (int at = 300; at < 1200; at += 3) {
    INFO("on the bus at " << at << " ms");
    const Scene scene(fmt::format(
        R"("servos": [{{"model": "BLA21-12U-AB", "node_id": 11}},
            {{"model": "BLA21-12U-AB", "node_id": 12, "serial_number": 7}}],
           "events": [{{"at": "0ms", "servo": 7, "world": {{"plugged": "off"}}}},
                      {{"at": "{}ms", "servo": 7, "world": {{"plugged": "on"}}}}])",
        at));
    Discovery discovery(*scene.session, profiles(), {});
    REQUIRE(discovery.find_all(500ms));
    const bool is_heard = scene.roster().heard(NodeId(12));
    is_heard ? ++heard : ++unheard;
    CHECK(scene.member(12).is_servo == is_heard);
  }
  CHECK(heard > 0);
  CHECK(unheard > 0);
}

TEST_CASE("a search ends beside a servo that restarts again and again") {
  std::string restarts;
  for (int at = 2500; at < 120'000; at += 2500) {
    restarts += fmt::format(R"({}{{"at": "{}ms", "servo": 12, "happens": "watchdog_error"}})",
                            restarts.empty() ? "" : ", ", at);
  }
  const Scene scene(fmt::format(
      R"("servos": [{{"model": "BLA21-12U-AB", "node_id": 11}},
          {{"model": "BLA21-12U-AB", "node_id": 12, "serial_number": 12,
            "behaviour": {{"first_node_status": "100ms"}}, "faults": {{"mute": true}}}}],
         "events": [{}])",
      restarts));
  const Time begin = scene.session->now();
  Discovery discovery(*scene.session, profiles(), {.patience = {.timeout = 2s, .retries = 1}});
  REQUIRE(discovery.find_all(2s));
  CHECK(scene.session->now() - begin < 30s);
}

TEST_CASE("all are there when all that were heard have said who they are") {
  const Targets wanted = GENERATE(Targets{}, targets("all"), targets("model:BLA21"));
  SECTION("one is silent for a while") {
    const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11},
        {"model": "BLA21-12U-AB", "node_id": 12, "faults": {"lose_responses": 3}}])");
    Discovery discovery(*scene.session, profiles(), {.patience = {.timeout = 50ms, .retries = 0}});
    CHECK(there(discovery.wait_for(wanted, 10s)) == Ids{11, 12});
  }
  SECTION("one is mute") {
    const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11},
        {"model": "BLA21-12U-AB", "node_id": 12, "faults": {"mute": true}}])");
    Discovery discovery(*scene.session, profiles(), {.patience = {.timeout = 50ms, .retries = 0}});
    const Arrivals arrivals = discovery.wait_for(wanted, 5s);
    CHECK(codes(arrivals.errors) == Codes{{Code::timeout, 12}});
  }
}

TEST_CASE("who does not come in time is told, each for itself") {
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11},
                                  {"model": "BLA21-12U-AB", "node_id": 12,
                                   "faults": {"mute": true}}])");
  Discovery discovery(*scene.session, profiles(), {.patience = {.timeout = 50ms, .retries = 0}});
  const Arrivals arrivals = discovery.wait_for(targets("11,12,55,serial:1"), 2s);
  CHECK(there(arrivals) == Ids{11});
  CHECK(arrivals.servos.size() == 2); // node 12 was heard
  CHECK(codes(arrivals.errors) ==
        Codes{{Code::timeout, 12}, {Code::not_found, 55}, {Code::timeout, 12}});
}

TEST_CASE("another device on the node ID is not the servo that is waited for") {
  const Scene scene(two_servos_and_a_node);
  Discovery discovery(*scene.session, profiles(), {});
  const Arrivals arrivals = discovery.wait_for(targets("11,30"), 2s);
  CHECK(there(arrivals) == Ids{11});
  CHECK(arrivals.servos.size() == 1);
  CHECK(codes(arrivals.errors) == Codes{{Code::not_found, 30}});
}

TEST_CASE("two units on one ID are not the servo that is waited for") {
  const Scene scene(one_servo);
  scene.roster().mark_doubled(NodeId(11), {1}, {2});
  Discovery discovery(*scene.session, profiles(), {});
  const Arrivals arrivals = discovery.wait_for(targets("11"), 2s);
  CHECK(there(arrivals).empty());
  CHECK(codes(arrivals.errors) == Codes{{Code::duplicate_node_id, 11}});
}

TEST_CASE("where nobody comes that is said, once") {
  const Scene scene(nobody);
  Discovery discovery(*scene.session, profiles(), {});
  const Arrivals arrivals = discovery.wait_for({}, 1s);
  CHECK(arrivals.servos.empty());
  CHECK(codes(arrivals.errors) == Codes{{Code::not_found, 0}});
}

TEST_CASE("a signal ends the waiting, and what was asked") {
  const Scene scene(one_servo);
  REQUIRE(raise(SIGINT) == 0);
  Discovery discovery(*scene.session, profiles(), {});
  const Arrivals arrivals = discovery.wait_for(targets("55"), 10s);
  REQUIRE(arrivals.broken);
  CHECK(arrivals.broken->code == Code::interrupted);
  CHECK(scene.session->node().jobs() == 0);
}

TEST_CASE("who was heard before the search began is asked like those who come") {
  const Scene scene(one_servo);
  REQUIRE(scene.roster().heard(NodeId(11)));
  REQUIRE_FALSE(scene.member(11).is_known());
  Discovery discovery(*scene.session, profiles(), {});
  REQUIRE(discovery.find_all(100ms));
  CHECK(scene.member(11).is_known());
  CHECK(scene.requests(GetSet::type, 11) == 6);
  Discovery again(*scene.session, profiles(), {});
  REQUIRE(again.find_all(100ms));
  CHECK(scene.requests(GetSet::type, 11) == 6); // it is known
}

TEST_CASE("the jobs of a search end with it") {
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
                                   "faults": {"mute": true}}])");

  class Other final : public dronecan::Job {
   public:
    dronecan::Step next(const Outcome&) override { return dronecan::Pause{}; }
  } other;

  scene.session->start(other);
  {
    Discovery discovery(*scene.session, profiles(), {});
    discovery.recognise();
    const auto status = message(NodeStatus::type, 40, NodeStatus{}.encode());
    scene.roster().hear(status.front(), scene.session->now());
    CHECK(scene.session->node().jobs() == 2);
    CHECK(scene.session->node().is_running(other));
  }
  CHECK(scene.session->node().jobs() == 1); // another's job goes on
  CHECK(scene.session->node().is_running(other));
  scene.session->cancel(other);
  const std::size_t before = questions(scene);
  const auto status = message(NodeStatus::type, 41, NodeStatus{}.encode());
  scene.roster().hear(status.front(), scene.session->now()); // nobody attends any more
  scene.live(3s);
  CHECK(questions(scene) == before);
}

TEST_CASE("the bus is heard for as long as it takes, from the moment when it was open") {
  const Scene scene(one_servo);
  REQUIRE(hear_bus(*scene.session));
  CHECK(scene.session->now() >= scene.session->opened() + bus_watch_time);
  const Time heard = scene.session->now();
  REQUIRE(hear_bus(*scene.session)); // it has been
  CHECK(scene.session->now() == heard);
}

namespace {

/// A session on a bus that the test writes.
struct Rig {
  Rig() {
    auto opened = Session::open(std::make_unique<FakeBus>(wire), LocalNodeId::unshared({}),
                                Session::Hearing::all, profiles());
    REQUIRE(opened);
    session = std::move(*opened);
  }

  void hear(const std::vector<can::Frame>& frames, Duration later) {
    for (const auto& frame : frames) {
      wire.hear(frame, later);
    }
  }

  void status(std::uint8_t source, std::uint32_t uptime_s, Duration later,
              dronecan::TransferId id = 0) {
    hear(message(NodeStatus::type, source, NodeStatus{.uptime_s = uptime_s}.encode(), id), later);
  }

  /// The answer of node 11 to our GetNodeInfo with this transfer ID.
  void info(dronecan::TransferId id, std::uint32_t uptime_s, Duration later) {
    hear(service(Kind::response, GetNodeInfo::type, 11, 127,
                 GetNodeInfo::Response{.status = {.uptime_s = uptime_s}, .unique_id = {1}}.encode(),
                 id),
         later);
  }

  [[nodiscard]] std::size_t questions(std::uint8_t server) const {
    return static_cast<std::size_t>(std::ranges::count_if(wire.sent, [&](const auto& frame) {
      const auto header = dronecan::decode_id(frame.id);
      return header && header->kind == Kind::request && header->destination == NodeId(server);
    }));
  }

  Wire wire;
  std::unique_ptr<Session> session;
};

} // namespace

TEST_CASE("who appears or restarts is asked who it is, and nothing more; who is known is not") {
  Rig rig;
  rig.status(11, 100, 0ms, 31);
  REQUIRE(rig.session->live_until(rig.wire.now + 1ms)); // it is nobody new
  {
    Discovery discovery(*rig.session, profiles(), {.patience = {.timeout = 500ms, .retries = 0}});
    discovery.recognise();
    rig.status(11, 0, 10s, 1); // it restarted
    rig.status(20, 0, 5s);
    REQUIRE(rig.session->live_until(rig.wire.now + 4s));
    CHECK(rig.questions(11) == 0);
    REQUIRE(rig.session->live_until(rig.wire.now + 2s));
    CHECK(rig.questions(20) == 1);
    CHECK(rig.questions(11) == 0);
    rig.info(0, 0, 4100ms);
    REQUIRE(rig.session->live_until(rig.wire.now + 5s));
    CHECK(rig.questions(11) == 1);
    CHECK(rig.session->roster().member(NodeId(11)).boots == 1);
    CHECK(rig.session->roster().member(NodeId(11)).is_unit({1}));
    CHECK_FALSE(rig.session->roster().member(NodeId(20)).info); // it did not answer
    REQUIRE(rig.session->run());
  }
  rig.status(30, 0, 1s);
  rig.status(11, 0, 3s, 2);
  REQUIRE(rig.session->live_until(rig.wire.now + 5s));
  CHECK(rig.questions(30) == 0);
  CHECK(rig.questions(11) == 1);
}

TEST_CASE("where frames were lost while listening nothing is known of who commands") {
  Rig rig;
  REQUIRE(rig.session->wait_until_open());
  rig.wire.happen(can::Overflow{7}, 100ms);
  const auto heard = hear_bus(*rig.session);
  REQUIRE_FALSE(heard);
  CHECK(heard.error().code == Code::state);
}
