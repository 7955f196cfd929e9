// Restarts of simulated servos: RestartJob, Recognizer and Allocator together in a session.

#include "blactl/fleet/configuration.hpp"
#include "blactl/fleet/restart.hpp"
#include "blactl/fleet/write_job.hpp"

#include "fleet/recognizer.hpp"
#include "support.hpp"
#include "unit/can/fake_bus.hpp"

#include <signal.h>

#include <algorithm>
#include <array>
#include <string>
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

void write(const Scene& scene, std::uint8_t id, const char* name, std::int64_t value) {
  Change change;
  change.parameter = &parameter(name);
  change.requested = value;
  change.status = ChangeStatus::planned;
  WriteJob job(scene.identify(id), {change}, {});
  scene.run(job);
  REQUIRE(job.changes()[0].status == ChangeStatus::written);
}

std::optional<std::int64_t> read(const Scene& scene, std::uint8_t id, const char* name) {
  ReadJob job(scene.roster(), scene.member(id), profiles(), {}, [&](const Member&) {
    return Result<std::vector<const bla::Parameter*>>(std::vector{&parameter(name)});
  });
  scene.run(job);
  return job.raw(parameter(name).address);
}

/// Grown old enough for a restart to show.
void grow_old(const Scene& scene) {
  scene.live(3s);
}

RestartPlan plan(RestartKind kind, bool may_allocate = false, Duration stagger = {}) {
  RestartPlan plan;
  plan.kind = kind;
  plan.may_allocate = may_allocate;
  plan.stagger = stagger;
  return plan;
}

constexpr std::array<std::uint8_t, 3> three{11, 12, 13};

RestartResult restart_one(const Scene& scene, std::uint8_t id, RestartPlan plan = {}) {
  std::vector<Member*> one{&scene.identify(id)};
  auto result = restart(*scene.session, one, plan);
  CHECK_FALSE(result.broken);
  REQUIRE(result.servos.size() == 1);
  return result;
}

Code error_of(const RestartResult& result) {
  REQUIRE(result.servos[0].error);
  CHECK(result.servos[0].after == nullptr);
  return result.servos[0].error->code;
}

} // namespace

TEST_CASE("what is saved survives the restart, what is not does not") {
  const auto [kind, limit] =
      GENERATE(std::pair(RestartKind::save, 900), std::pair(RestartKind::restart, 1799));
  Scene scene(servos({servo(11)}));
  write(scene, 11, "angle_limit_cw", 900);
  const auto result = restart_one(scene, 11, plan(kind));
  CHECK(result.servos[0].after == &scene.member(11));
  CHECK_FALSE(result.servos[0].error);
  CHECK(result.servos[0].is_sent);
  CHECK(result.servos[0].duration > 50ms);
  CHECK(result.servos[0].duration < 5s);
  CHECK_FALSE(scene.member(11).is_known()); // it must be looked at again
  CHECK(read(scene, 11, "angle_limit_cw") == limit);
}

TEST_CASE("there is one ROM write, whether the answer came or was lost") {
  const auto* faults = GENERATE("", R"(, "faults": {"lose_opcode_answers": 1})",
                                R"(, "behaviour": {"answers_save_first": false})",
                                R"(, "faults": {"lose_opcode_answers": 1, "return_delay": "3s"})",
                                R"(, "behaviour": {"rom_write_time": "2s"},
                                     "faults": {"lose_opcode_answers": 1})");
  Scene scene(servos({servo(11, faults)}));
  const auto result = restart_one(scene, 11);
  CHECK(result.servos[0].after == &scene.member(11));
  CHECK(scene.requests(ExecuteOpcode::type, 11) == 1);
  CHECK(scene.member(11).boots == 1);
}

TEST_CASE("a request that was lost is repeated once, and never again") {
  SECTION("with success") {
    Scene scene(servos({servo(11, R"(, "faults": {"ignore_opcodes": 1})")}));
    CHECK(restart_one(scene, 11).servos[0].after == &scene.member(11));
    CHECK(scene.requests(ExecuteOpcode::type, 11) == 2);
  }
  SECTION("in vain") {
    Scene scene(servos({servo(11, R"(, "faults": {"ignore_opcodes": 9})")}));
    CHECK(error_of(restart_one(scene, 11)) == Code::timeout);
    CHECK(scene.requests(ExecuteOpcode::type, 11) == 2);
  }
}

TEST_CASE("a servo that does not do as it is told has its own word for each way") {
  const auto [fault, code] =
      GENERATE(std::pair("refuse_opcodes", Code::refused), std::pair("stays", Code::state),
               std::pair("never_returns", Code::not_back));
  Scene scene(servos({servo(11, fmt::format(R"(, "faults": {{"{}": true}})", fault))}));
  CHECK(error_of(restart_one(scene, 11)) == code);
  CHECK(scene.requests(ExecuteOpcode::type, 11) == 1);
}

TEST_CASE("a servo is found again under its new static ID, however long it takes") {
  Scene scene(servos({servo(11, R"(, "faults": {"return_delay": "3s"})")}));
  write(scene, 11, "static_node_id", 20);
  const auto result = restart_one(scene, 11);
  CHECK(result.servos[0].before == &scene.member(11));
  REQUIRE(result.servos[0].after == &scene.member(20));
  CHECK(result.servos[0].duration > 3s);
  CHECK(scene.member(20).info->unique_id == scene.member(11).info->unique_id);
}

TEST_CASE("a servo that moved is followed through its next restart as well") {
  Scene scene(servos({servo(11)}));
  write(scene, 11, "static_node_id", 20);
  REQUIRE(restart_one(scene, 11).servos[0].after == &scene.member(20));
  grow_old(scene);
  const auto again = restart_one(scene, 20);
  CHECK(again.servos[0].after == &scene.member(20));
  CHECK(scene.member(20).boots == 1);
}

TEST_CASE("servos that have no ID of their own get those they had, again and again",
          "[requirement-36][requirement-37][requirement-48]") {
  Scene scene(servos({servo(11), servo(12), servo(13)}));
  std::vector<Member*> members;
  for (const std::uint8_t id : three) {
    write(scene, id, "static_node_id", 0);
    members.push_back(&scene.member(id));
  }
  Identification::Options with_static_id;
  with_static_id.static_node_id = true;
  for (const RestartKind kind : {RestartKind::save, RestartKind::restart}) {
    for (Member* member : members) {
      scene.identify(member->id.value(), with_static_id);
      CHECK(will_ask_for_id(*member, kind));
    }
    const auto result = restart(*scene.session, members, plan(kind, true));
    CHECK_FALSE(result.broken);
    CHECK_FALSE(result.other_allocator);
    for (std::size_t i = 0; i < members.size(); ++i) {
      INFO((result.servos[i].error ? result.servos[i].error->message : ""));
      CHECK(result.servos[i].after == members[i]);
    }
    grow_old(scene);
  }
  CHECK(read(scene, 11, "static_node_id") == 0);
}

TEST_CASE("where somebody else allocates, or may, this process does not") {
  Scene scene(servos({servo(11)}));
  write(scene, 11, "static_node_id", 0);
  bool may_allocate = true;
  SECTION("another process of this machine holds the right") {
    may_allocate = false;
  }
  SECTION("another allocator was heard before") {
    const Allocation answer{.node_id = 0, .size = 6, .unique_id = {9}};
    const auto payload = answer.encode();
    scene.roster().receive({.header = {.kind = Kind::message,
                                       .data_type_id = Allocation::type.id,
                                       .source = NodeId(5)},
                            .payload = payload.bytes(),
                            .at = scene.session->now()});
  }
  const auto result = restart_one(scene, 11, plan(RestartKind::save, may_allocate));
  CHECK(error_of(result) == Code::not_back);
  CHECK(result.servos[0].error->hint.find("allocator") != std::string::npos);
  const bool is_silent = std::ranges::none_of(scene.sent, [](const can::Frame& frame) {
    const auto header = dronecan::decode_id(frame.id);
    return header && header->kind == Kind::message && header->data_type_id == Allocation::type.id;
  });
  CHECK(is_silent);
}

TEST_CASE("an ID that another servo has taken is not given", "[requirement-41]") {
  Scene scene(servos({servo(11), servo(12)}));
  write(scene, 11, "static_node_id", 0);
  write(scene, 12, "static_node_id", 11); // and is faster
  std::vector<Member*> members{&scene.member(11), &scene.member(12)};
  const auto result = restart(*scene.session, members, plan(RestartKind::save, true));
  CHECK(result.servos[0].after == nullptr);
  REQUIRE(result.servos[0].error);
  CHECK(result.servos[0].error->code == Code::not_back);
  CHECK(result.servos[1].after == &scene.member(11));
}

TEST_CASE("requests to several servos keep their distance") {
  Scene scene(servos({servo(11), servo(12), servo(13)}));
  std::vector<Member*> members;
  for (const std::uint8_t id : three) {
    members.push_back(&scene.identify(id));
  }
  grow_old(scene);
  const Time begin = scene.session->now();
  const auto result = restart(*scene.session, members, plan(RestartKind::save, false, 2s));
  CHECK(scene.session->now() - begin >= 4s); // the third begins when two distances have passed
  CHECK(scene.session->now() - begin < 5s);
  for (const Restarted& each : result.servos) {
    CHECK(each.after != nullptr);
    CHECK(each.duration < 1s); // the waiting is no part of it
  }
}

TEST_CASE("whether a servo will ask for an ID hangs on its static one") {
  Member member;
  member.id = NodeId(11);
  CHECK(will_ask_for_id(member, RestartKind::save)); // not known: perhaps
  member.static_node_id = 0;
  CHECK(will_ask_for_id(member, RestartKind::save));
  CHECK(will_ask_for_id(member, RestartKind::restart));
  member.static_node_id = 11;
  CHECK_FALSE(will_ask_for_id(member, RestartKind::save));
  CHECK_FALSE(will_ask_for_id(member, RestartKind::restart));
  member.static_node_id = 20; // in RAM; ROM may hold 0
  CHECK_FALSE(will_ask_for_id(member, RestartKind::save));
  CHECK(will_ask_for_id(member, RestartKind::restart));
}

namespace {

/// A session on a bus that the test writes, with servo 11 identified by hand.
struct Rig {
  Rig() {
    auto opened = Session::open(std::make_unique<FakeBus>(wire),
                                LocalNodeId::unshared(std::nullopt), Session::Hearing::all);
    REQUIRE(opened);
    session = std::move(*opened);
    servo().info = GetNodeInfo::Response{.unique_id = {1}};
    servo().identified = servo().is_servo = true;
    hear(message(NodeStatus::type, 11, NodeStatus{.uptime_s = 100}.encode(), 31), 0ms);
    REQUIRE(session->live_until(wire.now + 1ms)); // it is nobody new
  }

  [[nodiscard]] Member& servo() const { return session->roster().member(NodeId(11)); }

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

  RestartResult restart_servo() const {
    std::vector<Member*> one{&servo()};
    return restart(*session, one, plan(RestartKind::restart, true));
  }

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
  CHECK(rig.restart_servo().servos[0].after == &rig.servo());
  CHECK(rig.given() == std::vector<int>{11});
}

TEST_CASE("an ID under which somebody unknown has appeared is not given", "[requirement-41]") {
  Rig rig;
  rig.confirm_restart();
  rig.status(11, 300ms); // and does not answer who it is
  rig.ask_for_id(1s);
  const auto result = rig.restart_servo();
  CHECK(result.servos[0].after == nullptr);
  CHECK(rig.given().empty());
}

TEST_CASE("another allocator that is heard during the restart does the work") {
  Rig rig;
  rig.confirm_restart();
  rig.hear(message(Allocation::type, 5, Allocation{.size = 6, .unique_id = {9}}.encode()), 300ms);
  rig.ask_for_id(1s);
  const auto result = rig.restart_servo();
  CHECK(result.other_allocator == NodeId(5));
  CHECK(rig.given().empty());
}

TEST_CASE("a signal lets a restart end that has begun, with all that belongs to it") {
  Rig rig;
  rig.confirm_restart();
  rig.status(11, 300ms); // it is asked who it is, and a signal comes before it answers
  rig.info(1, 0, 700ms);
  bool is_told = false;
  rig.session->on_stopping([&] { is_told = true; });
  const std::vector<Member*> one{&rig.servo()};

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
  CHECK(result.servos[0].after == &rig.servo());
  CHECK_FALSE(result.servos[0].error);
}

TEST_CASE("who appears or restarts is asked who it is; who is known is not") {
  Rig rig;
  {
    const Recognizer recognizer(*rig.session, {.timeout = 500ms, .retries = 0});
    rig.status(11, 10s, 1); // it restarted
    rig.status(20, 5s);
    REQUIRE(rig.session->live_until(rig.wire.now + 4s));
    CHECK(rig.questions(11) == 0);
    REQUIRE(rig.session->live_until(rig.wire.now + 2s));
    CHECK(rig.questions(20) == 1);
    CHECK(rig.questions(11) == 0);
    rig.info(0, 0, 4100ms);
    REQUIRE(rig.session->live_until(rig.wire.now + 5s));
    CHECK(rig.questions(11) == 1);
    CHECK(rig.servo().boots == 1);
    CHECK(rig.servo().is_unit({1}));
    CHECK_FALSE(rig.session->roster().member(NodeId(20)).info); // it did not answer
    REQUIRE(rig.session->run());
  }
  rig.status(30, 1s);
  rig.status(11, 3s, 2);
  REQUIRE(rig.session->live_until(rig.wire.now + 5s));
  CHECK(rig.questions(30) == 0);
  CHECK(rig.questions(11) == 1);
}
