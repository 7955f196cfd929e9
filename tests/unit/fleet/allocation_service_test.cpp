#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/change/allocation_service.hpp"

#include "support.hpp"
#include "unit/can/fake_bus.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using state::AllocationStore;
using Event = AllocationService::Event;

namespace {

std::string dynamic_servos(int count, std::string_view more = "") {
  std::string servos;
  for (int i = 1; i <= count; ++i) {
    servos += fmt::format(R"({}{{"model": "BLA21-12U-AB", "node_id": 0, "serial_number": {}}})",
                          i > 1 ? "," : "", i);
  }
  return fmt::format(R"("servos": [{}{}])", servos, more);
}

AllocationStore memory() {
  auto store = AllocationStore::unshared();
  REQUIRE(store);
  return std::move(*store);
}

/// An allocator on a simulated bus, and what it tells.
class Bench {
 public:
  explicit Bench(std::string_view members, AllocationService::Range range = {})
      : scene(members),
        service(*scene.session, store, range, [this](Event event, const AllocatedUnit& unit) {
          events.emplace_back(event, unit.node_id.value());
        }) {}

  /// Hears the bus, as the command does, and lives on.
  void serve(Duration time) {
    REQUIRE(discovery.find_all(bus_watch_time));
    service.bus_is_known();
    scene.live(time);
  }

  [[nodiscard]] std::ptrdiff_t count(Event event) const {
    return std::ranges::count(events, event, &std::pair<Event, int>::first);
  }

  [[nodiscard]] std::set<int> given() const {
    std::set<int> ids;
    for (const auto& [unique_id, unit] : service.units()) {
      if (service.is_there(unit)) {
        ids.insert(unit.node_id.value());
      }
    }
    return ids;
  }

  AllocationStore store = memory();
  Scene scene;
  std::vector<std::pair<Event, int>> events;
  AllocationService service;
  Discovery discovery{*scene.session, profiles(), {}};
};

} // namespace

TEST_CASE("every unit that asks gets an ID of its own, which is in the table") {
  Bench bench(dynamic_servos(5));
  bench.serve(15s);
  CHECK(bench.given() == std::set<int>{121, 122, 123, 124, 125});
  CHECK(bench.count(Event::assigned) == 5);
  CHECK(bench.service.asking() == 0);
  CHECK(bench.store.entries()->size() == 5);
  CHECK_FALSE(bench.service.end());
  CHECK(bench.service.free_ids() == 120);
}

TEST_CASE("new IDs come from the range, and are none that is in use, static or our own") {
  const std::string others =
      R"(, {"model": "BLA21-12U-AB", "node_id": 20, "serial_number": 50},
           {"model": "BLA21-12U-AB", "node_id": 23, "serial_number": 51})";
  Bench bench(dynamic_servos(2, others), {NodeId(20), NodeId(24)});
  REQUIRE(bench.discovery.find_all(bus_watch_time));
  bench.scene.roster().learn_static_node_id(NodeId(23), 22); // somebody has written it
  bench.service.bus_is_known();
  bench.scene.live(15s);
  CHECK(bench.given() == std::set<int>{21, 24});
}

TEST_CASE("a unit of the table gets its ID again, before the bus is known, too") {
  Bench bench(dynamic_servos(1));
  bench.serve(5s);
  REQUIRE(bench.given() == std::set<int>{125});
  const dronecan::UniqueId unit = bench.store.entries()->front().unique_id;
  REQUIRE(bench.store.enter(std::array{AllocationStore::Wish{unit, NodeId(40)}}, {}));

  Scene again(dynamic_servos(1));
  std::vector<Event> events;
  const AllocationService service(
      *again.session, bench.store, {},
      [&](Event event, const AllocatedUnit&) { events.push_back(event); });
  again.live(5s); // bus_is_known() was not said
  CHECK(events ==
        std::vector{Event::request, Event::request, Event::kept}); // first it is too early
  CHECK_FALSE(service.is_there(service.units().at(unit)));         // nobody has asked who that is
  CHECK(again.roster().heard(NodeId(40)));
}

TEST_CASE("until the bus is known nobody new gets an ID") {
  Bench bench(dynamic_servos(1));
  bench.scene.live(5s);
  CHECK(bench.events.empty());
  CHECK(bench.service.asking() == 1);
  CHECK(bench.store.entries()->empty());
}

TEST_CASE("a unit whose ID another one uses by now gets a new one") {
  Bench bench(
      dynamic_servos(1, R"(, {"model": "BLA21-12U-AB", "node_id": 60, "serial_number": 50})"));
  bench.serve(5s);
  REQUIRE(bench.given() == std::set<int>{125});
  const dronecan::UniqueId unit = bench.store.entries()->front().unique_id;
  REQUIRE(bench.store.enter(std::array{AllocationStore::Wish{unit, NodeId(60)}}, {}));

  Scene again(
      dynamic_servos(1, R"(, {"model": "BLA21-12U-AB", "node_id": 60, "serial_number": 50})"));
  std::vector<Event> events;
  AllocationService service(*again.session, bench.store, {},
                            [&](Event event, const AllocatedUnit&) { events.push_back(event); });
  Discovery discovery(*again.session, profiles(), {});
  REQUIRE(discovery.find_all(bus_watch_time));
  service.bus_is_known();
  again.live(10s);
  CHECK(std::ranges::count(events, Event::conflict) == 0);
  CHECK(std::ranges::count(events, Event::assigned) == 1);
  CHECK(again.roster().member(NodeId(125)).is_unit(unit));
  CHECK(bench.store.find(unit).value()->node_id == NodeId(125));
}

TEST_CASE("where nodes on the bus have all IDs of the range, that is told") {
  Bench bench(dynamic_servos(3), {NodeId(10), NodeId(11)});
  bench.serve(15s);
  CHECK(bench.given() == std::set<int>{10, 11});
  CHECK(bench.count(Event::full) == 1);
  CHECK(bench.service.free_ids() == 0);
}

TEST_CASE("beside another allocator nobody is served") {
  Bench bench(dynamic_servos(3) +
              R"(, "foreign": [{"kind": "autopilot", "node_id": 100, "allocates": true}])");
  bench.serve(10s);
  const auto end = bench.service.end();
  REQUIRE(end);
  CHECK(end->code == Code::other_allocator);
  CHECK(end->node_id == 100);
  CHECK(bench.store.entries()->empty());
}

namespace {

/// An allocator on a bus that the test writes. The unit has a one and zeros for its unique ID.
struct Rig {
  Rig() {
    auto opened =
        Session::open(std::make_unique<can::test::FakeBus>(wire), state::LocalNodeId::unshared({}),
                      Session::Hearing::all, profiles());
    REQUIRE(opened);
    session = std::move(*opened);
    service.emplace(*session, store, AllocationService::Range{},
                    [this](Event event, const AllocatedUnit&) { events.push_back(event); });
    service->bus_is_known();
  }

  void hear(const std::vector<can::Frame>& frames, Duration later) {
    for (const auto& frame : frames) {
      wire.hear(frame, later);
    }
  }

  /// It asks, and needs a second for it.
  void ask(Duration between = 200ms) {
    for (std::uint8_t part = 0; part < 3; ++part) {
      dronecan::Allocation request{.first_part_of_unique_id = part == 0,
                                   .size = static_cast<std::uint8_t>(part < 2 ? 6 : 4),
                                   .unique_id = {}};
      request.unique_id[0] = part == 0 ? 1 : 0;
      hear(message(dronecan::Allocation::type, 0, request.encode(), part), 100ms + part * between);
    }
    live(1s);
  }

  /// It says that it is on node ID 125.
  void come_up() {
    hear(message(dronecan::NodeStatus::type, 125, dronecan::NodeStatus{}.encode()), 1ms);
    live(2ms);
    session->records().learn(NodeId(125), {.unique_id = {1}}, wire.now);
  }

  void live(Duration time) const { REQUIRE(session->live_until(wire.now + time)); }

  [[nodiscard]] const AllocatedUnit& unit() const { return service->units().begin()->second; }

  [[nodiscard]] std::ptrdiff_t count(Event event) const {
    return std::ranges::count(events, event);
  }

  can::test::Wire wire;
  std::unique_ptr<Session> session;
  AllocationStore store = memory();
  std::vector<Event> events;
  std::optional<AllocationService> service;
};

} // namespace

TEST_CASE("an ID of the table is not given before its present holder had time to be heard") {
  Rig rig;
  REQUIRE(rig.store.enter(std::array{AllocationStore::Wish{{1}, NodeId(60)}}, {}));
  REQUIRE(rig.session->wait_until_open());
  rig.ask(50ms); // complete before a second has passed
  CHECK(rig.count(Event::request) == 1);
  CHECK(rig.count(Event::kept) == 0);
  rig.ask();
  CHECK(rig.count(Event::kept) == 1);
}

TEST_CASE("a unit that never takes its ID is told of once, and keeps nobody waiting") {
  Rig rig;
  for (int i = 0; i < 12; ++i) {
    rig.ask();
  }
  CHECK(rig.count(Event::request) == 5);
  CHECK(rig.count(Event::assigned) == 1);
  CHECK(rig.count(Event::kept) == 4);
  CHECK(rig.count(Event::deaf) == 1);
  CHECK(rig.session->now() - rig.service->last_request() > 5s);
  CHECK(rig.service->absence(rig.unit()).code == Code::not_back);
  CHECK(rig.unit().given == 12); // it goes on being given
  rig.come_up();
  rig.ask(); // after a restart
  CHECK_FALSE(rig.unit().is_deaf);
  CHECK(rig.events.back() == Event::kept);
}

TEST_CASE("a unit that asks while its ID is heard has a twin, and does not get it") {
  Rig rig;
  rig.ask();
  rig.come_up();
  REQUIRE(rig.service->is_there(rig.unit()));
  rig.hear(message(dronecan::NodeStatus::type, 125, dronecan::NodeStatus{}.encode(), 1), 400ms);
  rig.ask();
  CHECK(rig.events ==
        std::vector{Event::request, Event::assigned, Event::request, Event::conflict});
  const auto refusal = rig.service->refusal(rig.unit());
  REQUIRE(refusal);
  CHECK(refusal->code == Code::duplicate_unique_id);
  CHECK(refusal->message.find("the same unique ID") != std::string::npos);
}

TEST_CASE("a twin that has asked between two messages of the other gets nothing after that") {
  Rig rig;
  rig.ask();
  rig.come_up();
  rig.hear(message(dronecan::NodeStatus::type, 125, dronecan::NodeStatus{}.encode(), 1), 400ms);
  rig.ask();
  REQUIRE(rig.events.back() == Event::conflict);
  rig.ask();
  CHECK(rig.events.back() == Event::conflict);
  CHECK(rig.count(Event::assigned) == 1);
  CHECK(rig.service->refusal(rig.unit())->code == Code::duplicate_unique_id);
}

TEST_CASE("a unit that restarts and asks again has no twin") {
  Rig rig;
  rig.ask();
  rig.come_up();
  rig.ask();
  CHECK(rig.events.back() == Event::kept);
}
