// Which goals are refused before anything is sent, and what they need.

#include "blactl/fleet/change/change.hpp"

#include "recorded_change.hpp"

#include <algorithm>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
namespace at = bla::address;

namespace {

/// The errors of this goal alone.
std::vector<Error> refusals(const Scene& scene, const Goal& wanted, const Manner& manner = {}) {
  Change change(*scene.session, profiles(), {.manner = manner});
  return change.prepare({wanted});
}

Need need(const Scene& scene, const Goal& wanted, const Manner& manner) {
  Change change(*scene.session, profiles(), {.manner = manner});
  CHECK(change.prepare({wanted}).empty());
  return change.results().front().need;
}

Goal erase(bool keep_ids) {
  return {.id = NodeId(11), .wanted = {.erase = true, .keep_ids = keep_ids}};
}

} // namespace

TEST_CASE("a goal of one unit is not carried out on another that has its node ID") {
  const Scene scene(scene_of({servo_at(11), servo_at(12, R"(, "faults": {"mute": true})")}));
  scene.live(3s);
  Goal wanted = goal(11, {"reverse=on"});
  CHECK(refusals(scene, wanted).empty()); // of any unit
  wanted.unique_id = scene.identify(11).unique_id;
  CHECK(refusals(scene, wanted).empty());
  wanted.unique_id = dronecan::UniqueId{9};
  const auto errors = refusals(scene, wanted);
  REQUIRE(codes(errors) == std::vector{Code::state});
  CHECK(errors[0].message == "node 11 is another servo now");
  wanted.id = NodeId(12); // nobody knows which unit that is
  CHECK(codes(refusals(scene, wanted)) == std::vector{Code::timeout});
  CHECK(scene.requests(GetSet::type, 12) == 0);
}

TEST_CASE("a proof of ROM spares the restart that would show it") {
  const Stores stores;
  const Scene scene(scene_of({servo_at(11)}));
  scene.live(3s);
  command(scene, stores, "apply", {saved_goal(11, {"reverse=on"})});
  History history = stores.history("apply");
  const Goal again = saved_goal(11, {"reverse=on"}, Evidence::restart);
  CHECK(need(scene, again, {.proofs = &history}) == Need::nothing);
  CHECK(need(scene, again, {}) == Need::prove);
}

TEST_CASE("a servo that could not read its ROM is saved only once a restart did not help") {
  const Stores stores;
  const Scene scene(scene_of({servo_at(11, R"(, "faults": {"rom_unread_starts": 9})")}) +
                    R"(, "foreign": [{"kind": "autopilot", "node_id": 33, "allocates": true}])");
  scene.live(10s); // until it has got a node ID
  const auto& members = scene.session->roster().members();
  const NodeId id = std::ranges::find_if(members, [](const auto& entry) {
                      return entry.second.sends_actuator_status();
                    })->first;
  const Goal save{.id = id, .wanted = {.restart = RestartKind::save}};
  History history = stores.history("save");
  CHECK(codes(refusals(scene, save)) == std::vector{Code::rom_unread});
  const auto errors = refusals(scene, save, {.proofs = &history});
  REQUIRE(codes(errors) == std::vector{Code::rom_unread});
  CHECK(errors[0].hint.find("blactl restart") != std::string::npos);

  command(scene, stores, "restart", {{.id = id, .wanted = {.restart = RestartKind::restart}}});
  CHECK(codes(refusals(scene, save)) == std::vector{Code::rom_unread}); // without the record
  Change change(*scene.session, profiles(), {.manner = {.proofs = &history}});
  CHECK(codes(change.prepare({save})) == std::vector{Code::state}); // of the restart just now
  CHECK(change.overwrites_rom());
}

TEST_CASE("IDs that an erase has lost are written back, or asked for where 0 may be meant") {
  const Stores stores;
  const Scene scene(scene_of({servo_at(11, R"(, "servo_id": 5)")}));
  scene.live(3s);
  const std::string name(erase_keeping_ids);
  History broken_off = stores.history(name);
  CHECK(refusals(scene, erase(true), {.history = &broken_off}).empty()); // it has lost none
  const auto plans = plans_for(scene, erase(true).wanted, {11});
  REQUIRE(
      carry_out(*scene.session, profiles(), plans, {.history = &broken_off}).servos[0].is_done());
  elsewhere(scene, 11, {.assignments = assignments({"servo_id=0"})}); // as it broke off
  scene.live(3s);
  History history = stores.history(name);
  const Manner manner{.history = &history};

  SECTION("it has run on since") {
    Change change(*scene.session, profiles(), {.manner = manner});
    REQUIRE(change.prepare({erase(true)}).empty());
    REQUIRE(change.carry_out().empty());
    CHECK(change.results().front().is_done);
    CHECK(scene.read(11, registers({"servo_id"})).raw(at::servo_id) == 5);
  }
  SECTION("it has restarted since") {
    elsewhere(scene, 11, {.restart = RestartKind::save});
    scene.live(3s);
    const auto errors = refusals(scene, erase(true), manner);
    REQUIRE(codes(errors) == std::vector{Code::state});
    CHECK(errors[0].hint.find("servo_id=5") != std::string::npos);
    CHECK(refusals(scene, erase(false), manner).empty()); // which is to keep none
    CHECK(refusals(scene, erase(true)).empty());          // nobody knows of that erase
  }
}

TEST_CASE("a unit that asks for a node ID with the unique ID of a servo is its copy") {
  const std::string same = R"(, "unique_id": "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa")";
  const Scene scene(scene_of({servo_at(11, same), servo_at(0, same)}));
  scene.live(3s);
  const Goal wanted = goal(11, {"reverse=on"});
  CHECK(codes(refusals(scene, wanted, {.may_allocate = true})) ==
        std::vector{Code::duplicate_unique_id});
  CHECK(refusals(scene, wanted).empty()); // where another process may answer its requests
}

TEST_CASE("two servos with one unique ID are refused, also one that needs nothing") {
  const std::string same = R"(, "unique_id": "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa")";
  const Scene scene(scene_of({servo_at(11, same), servo_at(12, same)}));
  scene.live(3s);
  REQUIRE(scene.identify(11).unique_id == scene.identify(12).unique_id);
  const Goal held = goal(11, {"reverse=off"}, Evidence::ram);
  CHECK(codes(refusals(scene, held, {.may_allocate = true})) ==
        std::vector{Code::duplicate_unique_id});
}
