// Several simulated servos changed at once: ChangeJob, UnitJob and Allocator together in a session.

#include "blactl/dronecan/service.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/change/carry_out.hpp"

#include "support.hpp"
#include "unit/can/fake_bus.hpp"
#include "unit/state/processes.hpp"

#include <signal.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using can::test::FakeBus;
using can::test::Wire;
using dronecan::Allocation;
using dronecan::ExecuteOpcode;
using dronecan::Kind;
using dronecan::NodeStatus;
using dronecan::RestartNode;
using state::LocalNodeId;

namespace {

/// A servo of a scene; `more`: further members, with a comma before each.
std::string servo(int node_id, std::string_view more = "") {
  return fmt::format(R"({{"model": "BLA21-12U-AB", "node_id": {}{}}})", node_id, more);
}

std::string servos(std::initializer_list<std::string> all) {
  return fmt::format(R"("servos": [{}])", fmt::join(all, ", "));
}

const Wanted save{.restart = RestartKind::save};
const Wanted restart{.restart = RestartKind::restart};

Wanted set(const char* assignment, bool saves = false) {
  return {.assignments = assignments({assignment}),
          .restart = saves ? std::optional(RestartKind::save) : std::nullopt};
}

CarriedOut change(const Scene& scene, const Wanted& wanted, const std::vector<std::uint8_t>& ids,
                  const Manner& manner = {}) {
  const auto plans = plans_for(scene, wanted, ids);
  auto carried_out = carry_out(*scene.session, profiles(), plans, manner);
  CHECK(carried_out.servos.size() == ids.size());
  CHECK(scene.session->node().jobs() == 0); // nobody is asked any more
  return carried_out;
}

ChangeResult change_one(const Scene& scene, const Wanted& wanted, std::uint8_t id = 11,
                        const Manner& manner = {}) {
  auto carried_out = change(scene, wanted, {id}, manner);
  INFO((carried_out.broken ? carried_out.broken->message : ""));
  CHECK_FALSE(carried_out.broken);
  return carried_out.servos.front();
}

void write(const Scene& scene, std::uint8_t id, const char* assignment) {
  REQUIRE(change_one(scene, set(assignment), id).is_done());
}

std::optional<std::int64_t> read(const Scene& scene, std::uint8_t id, const char* name) {
  return scene.read(id, registers({name})).raw(parameter(name).address);
}

/// Grown old enough for a restart to show.
void grow_old(const Scene& scene) {
  scene.live(3s);
}

Code error_of(const ChangeResult& result) {
  CHECK_FALSE(result.is_done());
  CHECK_FALSE(result.saved);
  CHECK_FALSE(result.returned);
  REQUIRE(result.error);
  return result.error->code;
}

const Manner allocating{.may_allocate = true};
} // namespace

TEST_CASE("what is saved survives the restart, what is not does not") {
  const bool saves = GENERATE(true, false);
  const Scene scene(servos({servo(11)}));
  write(scene, 11, "angle_limit_cw=90deg");
  const auto result = change_one(scene, saves ? save : restart);
  CHECK(result.is_done());
  CHECK(result.saved == saves);
  CHECK(result.returned == NodeId(11));
  CHECK(result.duration > 50ms);
  CHECK(result.duration < 5s);
  CHECK(scene.member(11).is_known()); // it was identified again
  CHECK(read(scene, 11, "angle_limit_cw") == (saves ? 900 : 1799));
}

TEST_CASE("there is one ROM write, whether the answer came or was lost") {
  const auto* faults = GENERATE("", R"(, "faults": {"lose_opcode_answers": 1})",
                                R"(, "behaviour": {"answers_save_first": false})",
                                R"(, "faults": {"lose_opcode_answers": 1, "return_delay": "3s"})",
                                R"(, "behaviour": {"rom_write_time": "2s"},
                                     "faults": {"lose_opcode_answers": 1})");
  INFO(faults);
  const Scene scene(servos({servo(11, faults)}));
  const auto result = change_one(scene, save);
  CHECK(result.is_done());
  CHECK(result.returned == NodeId(11));
  CHECK(scene.requests(ExecuteOpcode::type, 11) == 1);
  CHECK(scene.member(11).boots == 1);
}

TEST_CASE("whenever a servo restarts by itself, only what ROM holds is said to be saved") {
  int saved = 0;
  for (int number = 1; number <= 60; ++number) {
    INFO("it restarts after answer " << number);
    const Scene scene(servos({servo(11, fmt::format(R"(, "behaviour": {{"first_node_status": "1s"}},
                "faults": {{"restart_after_answer": [{{"to": "any", "number": {}}}]}})",
                                                    number))}));
    const Wanted wanted = set("angle_limit_cw=90deg", true);
    auto plan = make_plan(
        wanted, scene.read(11, [&](const Servo& known) { return registers_needed(wanted, known); }),
        profiles());
    if (!plan) {
      continue; // it could not be read, and nothing was sent
    }
    const auto result = carry_out(*scene.session, profiles(), std::span(&*plan, 1), {}).servos[0];
    CHECK(result.is_done() == result.errors().empty());
    CHECK(result.is_done() == result.saved);
    if (result.changes[0].status == ChangeStatus::written) {
      CHECK(read(scene, 11, "angle_limit_cw") == 900);
    }
    if (result.saved) {
      ++saved;
      grow_old(scene);
      REQUIRE(change_one(scene, restart).is_done());
      CHECK(read(scene, 11, "angle_limit_cw") == 900);
    }
  }
  CHECK(saved >= 9); // nearly all who restart are told so
}

TEST_CASE("a request that was lost is repeated once, and never again") {
  SECTION("with success") {
    const Scene scene(servos({servo(11, R"(, "faults": {"ignore_opcodes": 1})")}));
    CHECK(change_one(scene, save).is_done());
    CHECK(scene.requests(ExecuteOpcode::type, 11) == 2);
  }
  SECTION("in vain") {
    const Scene scene(servos({servo(11, R"(, "faults": {"ignore_opcodes": 9})")}));
    CHECK(error_of(change_one(scene, save)) == Code::timeout);
    CHECK(scene.requests(ExecuteOpcode::type, 11) == 2);
  }
}

TEST_CASE("a servo that does not do as it is told has its own word for each way") {
  const auto [fault, code] =
      GENERATE(std::pair("refuse_opcodes", Code::refused), std::pair("stays", Code::state),
               std::pair("never_returns", Code::not_back));
  const Scene scene(servos({servo(11, fmt::format(R"(, "faults": {{"{}": true}})", fault))}));
  CHECK(error_of(change_one(scene, save)) == code);
  CHECK(scene.requests(ExecuteOpcode::type, 11) == 1);
}

TEST_CASE("a servo is found again under its new static ID, however long it takes") {
  const Scene scene(servos({servo(11, R"(, "faults": {"return_delay": "3s"})")}));
  const auto result = change_one(scene, set("static_node_id=20", true));
  CHECK(result.is_done());
  CHECK(result.servo.id == NodeId(11));
  CHECK(result.returned == NodeId(20));
  CHECK(result.node_id_after == NodeId(20));
  CHECK(result.duration > 3s);
  CHECK(scene.member(20).is_unit(*result.servo.unique_id));
}

TEST_CASE("a servo that moved is followed through its next restart as well") {
  const Scene scene(servos({servo(11)}));
  REQUIRE(change_one(scene, set("static_node_id=20", true)).returned == NodeId(20));
  grow_old(scene);
  CHECK(change_one(scene, save, 20).returned == NodeId(20));
  CHECK(scene.member(20).boots == 1);
}

TEST_CASE("servos that have no ID of their own get those they had, again and again",
          "[requirement-36][requirement-37][requirement-48]") {
  const Scene scene(servos({servo(11), servo(12), servo(13)}));
  for (const std::uint8_t id : std::array<std::uint8_t, 3>{11, 12, 13}) {
    write(scene, id, "static_node_id=0");
  }
  for (const Wanted& wanted : {save, restart}) {
    const auto carried_out = change(scene, wanted, {11, 12, 13}, allocating);
    CHECK_FALSE(carried_out.broken);
    for (const ChangeResult& result : carried_out.servos) {
      INFO((result.error ? result.error->message : ""));
      CHECK(result.is_done());
      CHECK(result.returned == result.servo.id);
    }
    grow_old(scene);
  }
  CHECK(read(scene, 11, "static_node_id") == 0);
}

TEST_CASE("the allocation table says which ID a servo gets back, and keeps what it was given") {
  const state::test::Folder folder;
  const auto open = [&] {
    return state::AllocationStore::open(folder.path.string(),
                                        state::AllocationStore::Access::write);
  };
  const Scene scene(servos({servo(11), servo(12), servo(13)}));
  const dronecan::UniqueId first = *scene.identify(11).unique_id;
  const dronecan::UniqueId second = *scene.identify(12).unique_id;
  const std::array wishes{
      state::AllocationStore::Wish{first, NodeId(40)},
      state::AllocationStore::Wish{dronecan::UniqueId{1}, NodeId(12)}}; // of a servo that is away
  REQUIRE(open()->enter(wishes, {}));
  for (const std::uint8_t id : std::array<std::uint8_t, 3>{11, 12, 13}) {
    write(scene, id, "static_node_id=0");
  }
  Manner manner = allocating;
  manner.allocations = open;
  const auto carried_out = change(scene, save, {11, 12, 13}, manner);
  for (const ChangeResult& result : carried_out.servos) {
    INFO((result.error ? result.error->message : ""));
    CHECK(result.is_done());
  }
  CHECK(carried_out.servos[0].returned == NodeId(40));
  CHECK(carried_out.servos[1].returned == NodeId(14)); // 12 is another's, 13 is in use
  CHECK(carried_out.servos[2].returned == NodeId(13));
  CHECK(open()->find(second).value()->node_id == NodeId(14));
  CHECK(open()->entries()->size() == 4);
}

TEST_CASE("where the allocation table cannot be opened, a servo gets the ID that it had") {
  const Scene scene(servos({servo(11)}));
  write(scene, 11, "static_node_id=0");
  Manner manner = allocating;
  int asked = 0;
  manner.allocations = [&]() -> Result<state::AllocationStore> {
    ++asked;
    return fail(Code::io, "no table");
  };
  CHECK(change_one(scene, save, 11, manner).returned == NodeId(11));
  CHECK(asked == 1);
}

TEST_CASE("an ID that the allocation table does not take is told of once, whenever that shows") {
  const state::test::Folder folder;
  const std::string path = folder.path.string();
  using Access = state::AllocationStore::Access;
  const Scene scene(servos({servo(11), servo(12)}));
  write(scene, 11, "static_node_id=0");
  write(scene, 12, "static_node_id=0");
  Manner manner = allocating;
  std::vector<Code> told;
  manner.not_kept = [&](const Error& error) -> std::optional<Error> {
    told.push_back(error.code);
    return std::nullopt;
  };
  SECTION("it cannot be opened") {
    manner.allocations = []() -> Result<state::AllocationStore> {
      return fail(Code::permission, "no table");
    };
  }
  SECTION("it cannot be written, as on a disk that is full since") {
    REQUIRE(state::AllocationStore::open(path, Access::write));
    manner.allocations = [&] { return state::AllocationStore::open(path, Access::read); };
  }
  const auto carried_out = change(scene, save, {11, 12}, manner);
  CHECK(carried_out.servos[0].returned == NodeId(11));
  CHECK(carried_out.servos[1].returned == NodeId(12));
  CHECK(told == std::vector{Code::permission});
}

TEST_CASE("where somebody else allocates, or may, this process does not") {
  const Scene scene(servos({servo(11)}));
  write(scene, 11, "static_node_id=0");
  Manner manner = allocating;
  SECTION("another process of this machine holds the right") {
    manner.may_allocate = false;
  }
  SECTION("another allocator was heard before") {
    const auto payload = Allocation{.node_id = 0, .size = 6, .unique_id = {9}}.encode();
    scene.roster().receive({.header = {.kind = Kind::message,
                                       .data_type_id = Allocation::type.id,
                                       .source = NodeId(5)},
                            .payload = payload.bytes(),
                            .at = scene.session->now()});
  }
  const auto result = change_one(scene, save, 11, manner);
  CHECK(error_of(result) == Code::not_back);
  CHECK(result.error->hint.find("allocator") != std::string::npos);
  const bool is_silent = std::ranges::none_of(scene.sent, [](const can::Frame& frame) {
    const auto header = dronecan::decode_id(frame.id);
    return header && header->kind == Kind::message && header->data_type_id == Allocation::type.id;
  });
  CHECK(is_silent);
}

TEST_CASE("a unit that comes during a restart with the unique ID of the servo is not that one") {
  const auto [serial, code] =
      GENERATE(std::pair(7, Code::duplicate_unique_id), std::pair(0, Code::not_back));
  const std::string unit = R"("unique_id": "00112233445566778899aabbccddeeff")";
  const std::string twin =
      serial != 0 ? servo(15, fmt::format(R"(, "serial_number": {}, {})", serial, unit)) : "";
  const Scene scene(
      fmt::format(R"("servos": [{}{}{}], "events": [{}])",
                  servo(11, R"(, "serial_number": 1, "faults": {"never_returns": true}, )" + unit),
                  twin.empty() ? "" : ", ", twin,
                  twin.empty() ? "" : R"({"servo": 7, "happens": "power_off", "at": 0},
                                    {"servo": 7, "happens": "power_on", "at": "4s"})"));
  scene.live(3s);
  const ChangeResult result = change_one(scene, set("smoothing=off", true));
  REQUIRE(result.error);
  CHECK(result.error->code == code);
  CHECK_FALSE(result.saved);
  CHECK_FALSE(result.node_id_after);
  CHECK(result.changes.front().after != 1); // what the other holds is not told
}

TEST_CASE("an ID that another servo has taken is not given", "[requirement-41]") {
  const Scene scene(servos({servo(11), servo(12)}));
  grow_old(scene);
  write(scene, 11, "static_node_id=0");
  write(scene, 12, "static_node_id=11"); // and is faster
  const auto carried_out = change(scene, save, {11, 12}, allocating);
  CHECK(error_of(carried_out.servos[0]) == Code::not_back);
  const std::string& hint = carried_out.servos[0].error->hint;
  CHECK(hint.find("node ID 11 is used by uid:") != std::string::npos);
  CHECK(hint.find("blactl alloc --once --assign") != std::string::npos);
  CHECK(carried_out.servos[1].returned == NodeId(11));
  CHECK(carried_out.servos[1].is_done());
}

TEST_CASE("requests to several servos keep their distance") {
  const Scene scene(servos({servo(11), servo(12), servo(13)}));
  grow_old(scene);
  const auto plans = plans_for(scene, save, {11, 12, 13});
  const Time begin = scene.session->now();
  const auto carried_out = carry_out(*scene.session, profiles(), plans, {.stagger = 2s});
  CHECK(scene.session->now() - begin >= 4s); // the third begins when two distances have passed
  CHECK(scene.session->now() - begin < 5s);
  for (const ChangeResult& each : carried_out.servos) {
    CHECK(each.is_done());
    CHECK(each.duration < 1s); // the waiting is no part of it
  }
}

TEST_CASE("how long a servo may stay away hangs on how many will ask for an ID") {
  // A static ID that is saved with the rest: 5 s. Without one: 2 s more for each.
  const auto [static_id, wanted, longest] =
      GENERATE(std::tuple(11, save, 5s), std::tuple(0, save, 7s), std::tuple(11, restart, 5s),
               std::tuple(0, restart, 7s), std::tuple(20, save, 5s),
               std::tuple(20, restart, 7s)); // in RAM; ROM may hold 0
  const Scene scene(servos({servo(11, R"(, "faults": {"never_returns": true})")}));
  if (static_id != 11) {
    write(scene, 11, static_id == 0 ? "static_node_id=0" : "static_node_id=20");
  }
  grow_old(scene);
  const auto result = change_one(scene, wanted);
  CHECK(error_of(result) == Code::not_back);
  CHECK(result.duration >= longest);
  CHECK(result.duration < longest + 10ms); // an answer to the last call may still be under way
}

TEST_CASE("how long a servo may stay away can be said") {
  const Scene scene(servos({servo(11, R"(, "faults": {"never_returns": true})")}));
  grow_old(scene);
  CHECK(change_one(scene, save, 11, {.come_back = 1s}).duration == 1s);
}

namespace {

/// Writes down when each node was first asked for its registers after its restart.
class Readings final : public dronecan::Service {
 public:
  explicit Readings(Session& session) : session_(session) { session_.attach(*this); }

  ~Readings() override { session_.detach(*this); }

  void receive(const dronecan::Transfer& transfer) override {
    const bool is_value =
        transfer.header.kind == Kind::response && transfer.header.data_type_id == GetSet::type.id;
    if (is_value && session_.roster().member(transfer.header.source).boots > 0) {
      last[transfer.header.source.value()] = transfer.at;
    }
  }

  [[nodiscard]] Time next_deadline() const override { return never; }

  void advance(Time) override {}

  std::map<int, Time> last;

 private:
  Session& session_;
};

} // namespace

TEST_CASE("a dead servo does not hold up the others: each is read as soon as it is back") {
  const Scene scene(servos({servo(11), servo(12, R"(, "faults": {"never_returns": true})"),
                            servo(13, R"(, "faults": {"return_delay": "2s"})"), servo(14)}));
  grow_old(scene);
  const auto plans = plans_for(scene, set("reverse=on", true), {11, 12, 13, 14});
  const Readings readings(*scene.session);
  const Time begin = scene.session->now();
  const auto carried_out = carry_out(*scene.session, profiles(), plans, {});
  CHECK(scene.session->now() - begin >= 5s); // for the sake of the dead one
  CHECK(carried_out.servos[0].is_done());
  CHECK(error_of(carried_out.servos[1]) == Code::not_back);
  CHECK(carried_out.servos[2].is_done());
  CHECK(carried_out.servos[3].is_done());
  CHECK(readings.last.at(11) - begin < 1s);
  CHECK(readings.last.at(14) - begin < 1s);
  CHECK(readings.last.at(13) - begin > 2s);
  CHECK(readings.last.at(13) - begin < 3s);
  CHECK_FALSE(readings.last.contains(12));
}

TEST_CASE("a servo that refuses a value does not keep the others from saving theirs") {
  const Scene scene(servos({servo(11), servo(12, R"(, "faults": {"refuse_opcodes": true})")}));
  const auto carried_out = change(scene, set("reverse=on", true), {12, 11});
  CHECK(error_of(carried_out.servos[0]) == Code::refused);
  CHECK(carried_out.servos[0].changes[0].status == ChangeStatus::written);
  CHECK(carried_out.servos[1].is_done());
  CHECK(carried_out.servos[1].saved);
  CHECK_FALSE(carried_out.broken);
}

TEST_CASE("a servo ID that another node has given to another servo meanwhile is not given") {
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11},
                                  {"model": "BLA21-12U-AB", "node_id": 12}],
    "foreign": [{"kind": "node", "node_id": 91, "orders": [
        {"at": "5s", "to": 12, "order": "write", "address": 69, "value": 7}]}])");
  const auto plans = plans_for(scene, {.assignments = assignments({"servo_id=7"})}, {11});
  scene.live(6s);
  const ChangeResult result = carry_out(*scene.session, profiles(), plans, {}).servos.front();
  REQUIRE(result.changes[0].error);
  CHECK(result.changes[0].error->code == Code::duplicate_servo_id);
  CHECK(scene.read(11, registers({"servo_id"})).raw(bla::address::servo_id) != 7);
}

TEST_CASE("of a servo that is not there any more nothing is told as held") {
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 1}],
    "events": [{"at": "5s", "servo": 1, "happens": "power_off"}])");
  const auto plans =
      plans_for(scene, {.assignments = assignments({"smoothing=off", "reverse=off"})}, {11});
  scene.live(6s);
  const ChangeResult result = carry_out(*scene.session, profiles(), plans, {}).servos.front();
  CHECK_FALSE(result.is_done());
  for (const RegisterChange& change : result.changes) {
    CHECK_FALSE(change.after);
    CHECK(change.status != ChangeStatus::unchanged);
  }
}

TEST_CASE("a servo that cannot read its ROM, and restarts again, has proven nothing to look at") {
  const Scene scene(
      servos({servo(11, R"(, "serial_number": 1, "faults": {"rom_unread_starts": 9})"),
              servo(12, R"(, "faults": {"return_delay": "20s"})")}) +
      R"(, "foreign": [{"kind": "autopilot", "node_id": 33, "allocates": true}],
                         "events": [{"at": "20s", "servo": 1, "happens": "power_off"},
                                    {"at": "20100ms", "servo": 1, "happens": "power_on"}])");
  scene.live(10s); // until it has got a node ID: 125, from the end as usual
  const auto plans = plans_for(scene, restart, {125, 12});
  const std::size_t before = scene.requests(dronecan::GetSet::type, 125);
  const auto result = carry_out(*scene.session, profiles(), plans, {.come_back = 30s}).servos[0];
  REQUIRE(scene.member(125).boots == 2);
  CHECK(result.is_done());
  REQUIRE(result.warnings.size() == 1);
  CHECK(result.warnings[0].code == "rom_unread");
  CHECK(scene.requests(dronecan::GetSet::type, 125) - before < 20); // not the whole configuration
}

TEST_CASE("a servo that is saved, and restarts again while another one is away, is read again") {
  const Scene scene(servos({servo(11, R"(, "serial_number": 1)"),
                            servo(12, R"(, "faults": {"return_delay": "5s"})")}) +
                    R"(, "events": [{"at": "6s", "servo": 1, "happens": "power_off"},
                                    {"at": "6100ms", "servo": 1, "happens": "power_on"}])");
  grow_old(scene);
  const auto result = change(scene, save, {11, 12}).servos[0];
  REQUIRE(scene.member(11).boots == 2);
  CHECK(result.is_read_again);
  CHECK_FALSE(result.is_done());
  REQUIRE(result.error);
  CHECK(result.error->message.find("since its ROM was proven") != std::string::npos);
}

TEST_CASE("what is only written restarts nobody") {
  const Scene scene(servos({servo(11), servo(12)}));
  const auto carried_out = change(scene, set("reverse=on"), {11, 12});
  for (const ChangeResult& result : carried_out.servos) {
    CHECK(result.is_done());
    CHECK_FALSE(result.was_restarted);
  }
  CHECK(scene.requests(ExecuteOpcode::type, 11) == 0);
  CHECK(scene.requests(RestartNode::type, 12) == 0);
}

TEST_CASE("an erased servo that keeps its IDs is back where it was, with the rest as delivered") {
  const Scene scene(servos({servo(11, R"(, "servo_id": 7, "rom": {"angle_limit_cw": "90deg"})")}));
  const auto result = change_one(
      scene, {.erase = true, .keep_ids = true, .restart = RestartKind::save}, 11, allocating);
  CHECK(result.is_done());
  CHECK(result.returned == NodeId(11));
  CHECK(result.servo.servo_id == 7);
  CHECK(read(scene, 11, "angle_limit_cw") == 1799);
  CHECK(scene.requests(ExecuteOpcode::type, 11) == 2); // ERASE and SAVE
}

TEST_CASE("several servos are read at once, and one that is away does not keep the others") {
  const Scene scene(servos({servo(11), servo(12)}));
  const std::vector ids{NodeId(12), NodeId(55), NodeId(11)};
  const auto snapshots =
      take_snapshots(*scene.session, profiles(), ids, {.patience = {.timeout = 20ms, .retries = 0}},
                     registers({"angle_limit_cw"}));
  CHECK_FALSE(snapshots.broken);
  REQUIRE(snapshots.servos.size() == 3);
  CHECK(snapshots.servos[0].servo.id == NodeId(12)); // in the order asked
  CHECK(snapshots.servos[0].raw(bla::address::angle_limit_cw) == 1799);
  CHECK(snapshots.servos[1].servo.id == NodeId(55));
  CHECK(snapshots.servos[1].error->code == Code::not_found);
  CHECK(snapshots.servos[2].raw(bla::address::angle_limit_cw) == 1799);
}

TEST_CASE("snapshots of a session that broke say so") {
  const Scene scene(servos({servo(11)}));
  REQUIRE(raise(SIGINT) == 0);
  const std::vector ids{NodeId(11)};
  const auto snapshots =
      take_snapshots(*scene.session, profiles(), ids, {}, registers({"angle_limit_cw"}));
  REQUIRE(snapshots.broken);
  CHECK(snapshots.broken->code == Code::interrupted);
  CHECK(snapshots.servos[0].error->code == Code::interrupted);
}

namespace {

/// A session on a bus that the test writes, with servo 11 identified by hand.
struct Rig {
  Rig() {
    auto opened = Session::open(std::make_unique<FakeBus>(wire), LocalNodeId::unshared({}),
                                Session::Hearing::all, profiles());
    REQUIRE(opened);
    session = std::move(*opened);
    hear(message(NodeStatus::type, 11, NodeStatus{.uptime_s = 100}.encode(), 31), 0ms);
    REQUIRE(session->live_until(wire.now + 1ms)); // it is nobody new
    plan.before.servo = bla21();
    plan.before.servo.unique_id = dronecan::UniqueId{1};
    session->records().learn(plan.before.servo, GetNodeInfo::Response{.unique_id = {1}});
  }

  void hear(const std::vector<can::Frame>& frames, Duration later) {
    for (const auto& frame : frames) {
      wire.hear(frame, later);
    }
  }

  /// A NodeStatus of node `source` that started at once.
  void status(std::uint8_t source, Duration later, dronecan::TransferId id = 0) {
    hear(message(NodeStatus::type, source, NodeStatus{}.encode(), id), later);
  }

  /// The answer of node 11 to our GetNodeInfo with this transfer ID.
  void info(dronecan::TransferId id, std::uint32_t uptime_s, Duration later) {
    hear(service(Kind::response, GetNodeInfo::type, 11, 127,
                 GetNodeInfo::Response{.status = {.uptime_s = uptime_s}, .unique_id = {1}}.encode(),
                 id),
         later);
  }

  /// Servo 11 answers until its restart, which it confirms.
  void confirm_restart() {
    info(0, 100, 10ms);
    hear(service(Kind::response, RestartNode::type, 11, 127, RestartNode::Response{true}.encode()),
         20ms);
  }

  /// Servo 11 asks for a node ID, its third part at `later`; its unique ID is a one and zeros.
  void ask_for_id(Duration later) {
    for (std::uint8_t part = 0; part < 3; ++part) {
      Allocation request{.first_part_of_unique_id = part == 0,
                         .size = static_cast<std::uint8_t>(part < 2 ? 6 : 4),
                         .unique_id = {}};
      request.unique_id[0] = part == 0 ? 1 : 0;
      hear(message(Allocation::type, 0, request.encode(), part), later - (2 - part) * 200ms);
    }
  }

  /// The node IDs that we gave away.
  [[nodiscard]] std::vector<int> given() const {
    std::vector<int> ids;
    dronecan::Receiver receiver(
        8, {},
        {.transfer =
             [&](const dronecan::Transfer& transfer) {
               const auto answer = Allocation::decode(transfer.payload);
               if (transfer.header.kind == Kind::message &&
                   transfer.header.data_type_id == Allocation::type.id && answer &&
                   answer->node_id != 0) {
                 ids.push_back(answer->node_id);
               }
             },
         .error = {},
         .signature = [](Kind kind, std::uint16_t type) -> std::optional<std::uint64_t> {
           const auto* known = dronecan::find_type(kind, type);
           return known != nullptr ? std::optional(known->signature) : std::nullopt;
         }});
    for (const can::Frame& frame : wire.sent) {
      receiver.receive(frame, wire.now);
    }
    return ids;
  }

  [[nodiscard]] std::size_t questions(std::uint8_t server) const {
    return static_cast<std::size_t>(std::ranges::count_if(wire.sent, [&](const auto& frame) {
      const auto header = dronecan::decode_id(frame.id);
      return header && header->kind == Kind::request &&
             header->data_type_id == GetNodeInfo::type.id && header->destination == NodeId(server);
    }));
  }

  [[nodiscard]] CarriedOut restart_servo() const {
    return carry_out(*session, profiles(), std::span(&plan, 1), allocating);
  }

  Plan plan{.before = {}, .restart = RestartKind::restart};
  Wire wire;
  std::unique_ptr<Session> session;
};

} // namespace

TEST_CASE("a servo that asks gets the ID it had") {
  Rig rig;
  rig.confirm_restart();
  rig.ask_for_id(1s);
  rig.status(11, 1200ms);
  rig.info(1, 0, 1300ms);
  CHECK(rig.restart_servo().servos[0].returned == NodeId(11));
  CHECK(rig.given() == std::vector<int>{11});
}

TEST_CASE("an ID under which somebody unknown has appeared is not given", "[requirement-41]") {
  Rig rig;
  rig.confirm_restart();
  rig.status(11, 300ms); // and does not answer who it is
  rig.ask_for_id(1s);
  const auto result = rig.restart_servo();
  CHECK(result.servos[0].returned == std::nullopt);
  CHECK(result.servos[0].duration == 7s); // its static ID is not known: perhaps it asks
  CHECK(rig.given().empty());
}

TEST_CASE("a servo that does not take the ID that it is given is said to be one") {
  Rig rig;
  rig.confirm_restart();
  rig.ask_for_id(1s);
  rig.ask_for_id(2500ms);
  rig.ask_for_id(4s);
  const auto result = rig.restart_servo();
  CHECK(error_of(result.servos[0]) == Code::not_back);
  CHECK(rig.given() == std::vector<int>{11, 11, 11});
  CHECK(result.servos[0].error->hint.find("node ID 11 was given to it again") != std::string::npos);
}

TEST_CASE("another allocator that is heard during the restart does the work") {
  Rig rig;
  rig.confirm_restart();
  rig.hear(message(Allocation::type, 5, Allocation{.size = 6, .unique_id = {9}}.encode()), 300ms);
  rig.ask_for_id(1s);
  const auto result = rig.restart_servo();
  CHECK(error_of(result.servos[0]) == Code::not_back);
  CHECK(rig.session->roster().allocators().contains(NodeId(5)));
  CHECK(rig.given().empty());
}

TEST_CASE("a signal lets a restart end that has begun, with all that belongs to it") {
  Rig rig;
  rig.confirm_restart();
  rig.status(11, 300ms); // it is asked who it is, and a signal comes before it answers
  rig.info(1, 0, 700ms);
  bool is_told = false;
  rig.session->on_stopping([&] { is_told = true; });

  class Hand final : public dronecan::Service {
   public:
    explicit Hand(Rig& rig) : rig_(rig) {}

    void receive(const dronecan::Transfer&) override {}

    [[nodiscard]] Time next_deadline() const override { return due_; }

    void advance(Time now) override {
      if (now >= due_) {
        due_ = never;
        CHECK(rig_.questions(11) == 2);
        raise(SIGINT);
      }
    }

   private:
    Rig& rig_;
    Time due_ = rig_.wire.now + 500ms;
  } hand(rig);

  rig.session->attach(hand);
  const auto result = rig.restart_servo();
  rig.session->detach(hand);
  CHECK(is_told);
  REQUIRE(result.broken);
  CHECK(result.broken->code == Code::interrupted);
  CHECK(result.servos[0].returned == NodeId(11));
  CHECK_FALSE(result.servos[0].error);
}

TEST_CASE("frames that were never acknowledged may still take effect, and that is told") {
  Rig rig;
  rig.plan.restart.reset();
  rig.wire.echo = Wire::Echo::by_hand;
  RegisterChange change;
  change.parameter = &parameter("reverse");
  change.requested = 1;
  change.before = 0;
  rig.plan.changes = {change};
  const auto result = rig.restart_servo();
  REQUIRE(result.broken);
  CHECK(result.broken->code == Code::no_acknowledge);
  CHECK_FALSE(result.servos[0].is_done());
}
