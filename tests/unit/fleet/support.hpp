#pragma once
// What the tests of this floor share: a session on a simulated bus of virtual time that keeps every
// frame it sends, messages and answers of nodes that are not there, and outcomes for jobs.

#include "blactl/bla/profile.hpp"
#include "blactl/can/bus.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/plan.hpp"
#include "blactl/sim/bus/private_bus.hpp"
#include "blactl/sim/scenario/scenario.hpp"
#include "blactl/state/local_node_id.hpp"

#include "bus_around.hpp"
#include "catch.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::fleet::test {

using namespace std::chrono_literals;
using dronecan::GetNodeInfo;
using dronecan::GetSet;
using dronecan::NodeId;
using dronecan::Outcome;

inline const bla::Profiles& profiles() {
  static const Result<bla::Profiles> loaded = bla::Profiles::load(std::nullopt);
  REQUIRE(loaded);
  return *loaded;
}

inline const bla::Profile& model(std::string_view name) {
  const auto models = profiles().matching(name);
  REQUIRE(models.size() == 1);
  return *models.front();
}

inline const bla::Parameter& parameter(std::string_view name) {
  const auto found = profiles().find(name);
  REQUIRE(found);
  return **found;
}

inline std::vector<can::Frame> message(const dronecan::DataType& type, std::uint8_t source,
                                       const dronecan::Payload& payload,
                                       dronecan::TransferId id = 0) {
  const dronecan::Header header{.kind = dronecan::Kind::message,
                                .priority = 16,
                                .data_type_id = type.id,
                                .source = NodeId(source)};
  return dronecan::segment(header, id, type.signature, payload.bytes());
}

inline std::vector<can::Frame> service(dronecan::Kind kind, const dronecan::DataType& type,
                                       std::uint8_t source, std::uint8_t destination,
                                       const dronecan::Payload& payload,
                                       dronecan::TransferId id = 0) {
  const dronecan::Header header{.kind = kind,
                                .priority = 30,
                                .data_type_id = type.id,
                                .source = NodeId(source),
                                .destination = NodeId(destination)};
  return dronecan::segment(header, id, type.signature, payload.bytes());
}

/// Writes down what was sent.
class Tap final : public blactl::test::BusAround {
 public:
  Tap(std::unique_ptr<can::Bus> bus, std::vector<can::Frame>& sent)
      : BusAround(std::move(bus)), sent_(sent) {}

  [[nodiscard]] Result<bool> send(const can::Frame& frame) override {
    auto taken = BusAround::send(frame);
    if (taken && *taken) {
      sent_.push_back(frame);
    }
    return taken;
  }

 private:
  std::vector<can::Frame>& sent_;
};

/// A session on the simulated bus of a scenario, with virtual time; everybody has started.
class Scene {
 public:
  /// `members`: JSON members of the scenario: "servos": […], "foreign": […].
  explicit Scene(std::string_view members, Session::Hearing hearing = Session::Hearing::all,
                 std::optional<state::LocalNodeId> local = state::LocalNodeId::unshared({})) {
    const auto scenario = sim::parse_scenario(
        fmt::format(R"({{"schema": "blactl-scenario/1", "clock": "virtual", {}}})", members),
        "test.json", profiles());
    INFO((scenario ? "" : scenario.error().message));
    REQUIRE(scenario);
    auto bus = std::make_unique<sim::PrivateBus>("sim:test.json", *scenario);
    auto opened = Session::open(std::make_unique<Tap>(std::move(bus), sent), std::move(local),
                                hearing, profiles());
    REQUIRE(opened);
    session = std::move(*opened);
    live(start_time);
  }

  /// As jobs see it.
  [[nodiscard]] Roster& roster() const { return session->records(); }

  /// What is known of this node now.
  [[nodiscard]] Member member(std::uint8_t id) const { return roster().member(NodeId(id)); }

  void run(dronecan::Job& job) const {
    session->start(job);
    const auto ran = session->run();
    INFO((ran ? "" : ran.error().message));
    REQUIRE(ran);
  }

  void live(Duration time) const { REQUIRE(session->live_until(session->now() + time)); }

  /// Identifies a servo that must be there.
  Servo identify(std::uint8_t id, Identification::Options options = {}) const {
    IdentifyJob job(roster(), NodeId(id), profiles(), options);
    run(job);
    REQUIRE_FALSE(job.identification().error());
    return job.identification().servo();
  }

  /// Identifies a servo, unless it is known, and reads these registers.
  [[nodiscard]] Snapshot read(std::uint8_t id, const ReadJob::Choice& choice) const {
    ReadJob job(roster(), NodeId(id), profiles(), {}, choice);
    run(job);
    return job.snapshot();
  }

  /// Until the uptime of everybody proves for some time that there was no restart.
  void grow_old() const { live(10s); }

  /// How many requests of this type went to this server, retries included.
  [[nodiscard]] std::size_t requests(const dronecan::DataType& type, std::uint8_t server) const {
    std::size_t count = 0;
    for (const can::Frame& frame : sent) {
      const auto header = dronecan::decode_id(frame.id);
      const bool is_first = (frame.data[frame.size - 1U] & 0x80U) != 0;
      count += header && header->kind == dronecan::Kind::request && is_first &&
                       header->data_type_id == type.id && header->destination == NodeId(server)
                   ? 1U
                   : 0U;
    }
    return count;
  }

  /// A servo takes up to 150 ms from power to its first frame.
  static constexpr Duration start_time = 200ms;

  std::vector<can::Frame> sent; ///< in the order in which the bus took them
  std::unique_ptr<Session> session;
};

/// The registers that SAVE keeps.
inline Result<std::vector<const bla::Parameter*>> configuration(const Servo& servo) {
  return servo.identity.configuration();
}

/// The registers of these names.
inline ReadJob::Choice registers(std::vector<const char*> names) {
  return
      [names = std::move(names)](const Servo& servo) -> Result<std::vector<const bla::Parameter*>> {
        std::vector<const bla::Parameter*> wanted;
        for (const char* name : names) {
          wanted.push_back(servo.identity.parameter(parameter(name).address));
        }
        return wanted;
      };
}

/// An identified servo as nobody has yet heard it: BLA21-12U-AB, firmware 1.400.
inline Servo bla21(std::uint8_t id = 11) {
  Servo servo{.id = NodeId(id), .unique_id = dronecan::UniqueId{id}, .is_servo = true};
  servo.identity = bla::Identity(profiles(), {61, 240900558, 1400, 12050});
  servo.servo_id = 0;
  return servo;
}

/// What `servo` answered for these registers: `held`, else its defaults, else 0.
inline Snapshot snapshot_of(const Servo& servo, const std::vector<const bla::Parameter*>& asked,
                            const bla::Values& held = {}) {
  Snapshot snapshot{.servo = servo};
  for (const bla::Parameter* each : asked) {
    snapshot.readings.push_back(
        {each, bla::find(held, each->address).value_or(each->default_raw.value_or(0))});
  }
  return snapshot;
}

/// What `texts` ask for: "angle_limit_cw=90deg".
inline std::vector<bla::Assignment> assignments(const std::vector<std::string>& texts) {
  auto parsed = bla::parse_assignments(profiles(), texts);
  INFO((parsed ? "" : parsed.error().front().message));
  REQUIRE(parsed);
  return *parsed;
}

/// The plan for a servo that holds this, and its defaults else.
inline Result<Plan> try_plan(const Wanted& wanted, const bla::Values& held = {},
                             const Servo& servo = bla21()) {
  const auto needed = registers_needed(wanted, servo);
  if (!needed) {
    return std::unexpected(needed.error());
  }
  return make_plan(wanted, snapshot_of(servo, *needed, held), profiles());
}

inline Plan plan_for(const Wanted& wanted, const bla::Values& held = {},
                     const Servo& servo = bla21()) {
  auto plan = try_plan(wanted, held, servo);
  INFO((plan ? "" : plan.error().message));
  REQUIRE(plan);
  return *plan;
}

/// The plans for these servos, from what they hold now.
inline std::vector<Plan> plans_for(const Scene& scene, const Wanted& wanted,
                                   const std::vector<std::uint8_t>& ids) {
  std::vector<Plan> plans;
  for (const std::uint8_t id : ids) {
    auto plan = make_plan(
        wanted, scene.read(id, [&](const Servo& servo) { return registers_needed(wanted, servo); }),
        profiles());
    INFO((plan ? "" : plan.error().message));
    REQUIRE(plan);
    plans.push_back(std::move(*plan));
  }
  return plans;
}

/// A roster without a bus that has identified servo 11, and hears of its restarts.
class Acquaintance {
 public:
  explicit Acquaintance(Servo known = {.id = NodeId(11),
                                       .unique_id = dronecan::UniqueId{1},
                                       .name = "servo",
                                       .is_servo = true},
                        NodeId local = NodeId(127))
      : roster(local, profiles()), servo(std::move(known)) {
    hear_uptime(100);
    roster.learn(servo, GetNodeInfo::Response{.unique_id = *servo.unique_id, .name = servo.name});
  }

  void restart() {
    now += 10s;
    hear_uptime(0);
  }

  void hear_uptime(std::uint32_t uptime_s) {
    const auto payload = dronecan::NodeStatus{.uptime_s = uptime_s}.encode();
    roster.receive({.header = {.kind = dronecan::Kind::message,
                               .data_type_id = dronecan::NodeStatus::type.id,
                               .source = servo.id},
                    .payload = payload.bytes(),
                    .at = now});
  }

  [[nodiscard]] Member member() const { return roster.member(servo.id); }

  Roster roster;
  Servo servo;
  Time now{1000s};
};

/// Outcomes for a job that is asked without a bus. The payload lives as long as this object.
class Script {
 public:
  [[nodiscard]] Outcome answer(const dronecan::Payload& payload) {
    payload_ = payload;
    return {Outcome::Kind::answered, payload_.bytes(), {}};
  }

  [[nodiscard]] Outcome value(std::string_view register_name, GetSet::Value value) {
    return answer(
        GetSet::Response{.value = std::move(value), .name = std::string(register_name)}.encode());
  }

  /// The uptime proves that the unit has run all the time.
  [[nodiscard]] Outcome info(std::uint8_t unit, std::uint32_t uptime_s = 100) {
    return answer(GetNodeInfo::Response{
        .status = {.uptime_s = uptime_s}, .unique_id = {unit}, .name = "servo"}
                      .encode());
  }

  /// The uptime proves nothing: the unit may have restarted a moment ago.
  [[nodiscard]] Outcome young_info(std::uint8_t unit) { return info(unit, 0); }

  static Outcome start() { return {}; }

  static Outcome timed_out() { return {Outcome::Kind::timed_out, {}, {}}; }

  static Outcome withheld() { return {Outcome::Kind::withheld, {}, {}}; }

  static Outcome not_sent() { return {Outcome::Kind::not_sent, {}, {}}; }

  static Outcome cancelled() { return {Outcome::Kind::cancelled, {}, {}}; }

 private:
  dronecan::Payload payload_;
};

/// Node 30 says that the vehicle is armed.
inline void arm(Roster& roster, Time at) {
  const std::uint8_t armed[]{dronecan::ArmingStatus::fully_armed};
  roster.receive({.header = {.kind = dronecan::Kind::message,
                             .data_type_id = dronecan::ArmingStatus::type.id,
                             .source = NodeId(30)},
                  .payload = armed,
                  .at = at});
}

/// "read 0x38", "write 0x38=900", "GetNodeInfo", "pause", "nothing": what a job does next.
inline std::string text(const dronecan::Step& step) {
  const dronecan::Request* request = step.request();
  if (request == nullptr) {
    return step.is_end() ? "nothing" : "pause";
  }
  if (request->type->id != GetSet::type.id) {
    return std::string(request->type->name.substr(request->type->name.rfind('.') + 1));
  }
  const auto get_set = GetSet::Request::decode(request->payload.bytes());
  REQUIRE(get_set);
  if (const auto* number = std::get_if<std::int64_t>(&get_set->value)) {
    return fmt::format("write {}={}", get_set->name, *number);
  }
  return "read " + get_set->name;
}

} // namespace blactl::fleet::test
