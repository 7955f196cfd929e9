#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/replayed_jobs.hpp"
#include "blactl/fleet/live/fault_job.hpp"

#include "support.hpp"
#include "unit/can/fake_bus.hpp"

#include <signal.h>

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using dronecan::Kind;

namespace {

/// A recording that the test writes.
class Tape final : public can::Bus {
 public:
  explicit Tape(std::vector<can::BusEvent> events) : events_(events.begin(), events.end()) {}

  [[nodiscard]] std::string_view name() const override { return "replay:tape"; }

  [[nodiscard]] Result<bool> send(const can::Frame&) override {
    FAIL("a recording was sent a frame");
    return false;
  }

  [[nodiscard]] std::optional<can::BusEvent> receive() override {
    if (events_.empty()) {
      return std::nullopt;
    }
    can::BusEvent event = std::move(events_.front());
    events_.pop_front();
    if (const auto* received = std::get_if<can::Received>(&event)) {
      now_ = received->at;
    }
    return event;
  }

  [[nodiscard]] Result<void> filter(std::span<const can::Filter>) override { return {}; }

  [[nodiscard]] bool echoes() const override { return false; }

  [[nodiscard]] int descriptor() const override { return -1; }

  [[nodiscard]] bool is_replay() const override { return true; }

  [[nodiscard]] Time now() const override { return now_; }

 private:
  std::deque<can::BusEvent> events_;
  Time now_{};
};

/// Writes a recording: a servo with ID 11 that 127 asks.
struct Writer {
  void hear(const std::vector<can::Frame>& frames) {
    for (const can::Frame& frame : frames) {
      at += 1ms;
      events.emplace_back(can::Received{frame, at, {}});
    }
  }

  void say(const dronecan::DataType& type, const dronecan::Payload& payload) {
    hear(message(type, 11, payload, id++));
  }

  void answer(std::string_view name, std::int64_t value) {
    hear(service(Kind::response, GetSet::type, 11, 127,
                 GetSet::Response{.value = value, .name = std::string(name)}.encode(),
                 id++ % dronecan::transfer_id_modulus));
  }

  /// All that Identification asks.
  void identify() {
    say(dronecan::ActuatorStatus::type, dronecan::ActuatorStatus{}.encode());
    hear(service(Kind::response, GetNodeInfo::type, 11, 127,
                 GetNodeInfo::Response{.unique_id = {7}, .name = "servo"}.encode(), id++));
    answer("0x50", 61);
    answer("0x51", 240900558);
    answer("0x52", 1400);
    answer("0x53", 12050);
    answer("0x45", 3);
  }

  [[nodiscard]] std::unique_ptr<Session> play() {
    events.emplace_back(can::Ended{});
    auto session = Session::open(std::make_unique<Tape>(events), std::nullopt,
                                 Session::Hearing::answers, profiles());
    REQUIRE(session);
    return std::move(*session);
  }

  Time at{};
  dronecan::TransferId id = 0;
  std::vector<can::BusEvent> events;
};

ReadJob reader(Session& session, std::vector<const char*> names) {
  return {session.records(),           NodeId(11),          profiles(), {},
          registers(std::move(names)), ReadJob::Proof::none};
}

} // namespace

TEST_CASE("a job on a recording is answered from all of it, what comes later included") {
  Writer writer;
  writer.identify();
  writer.answer("0x38", 900);
  writer.answer("0x38", 901);
  const auto session = writer.play();
  ReadJob job = reader(*session, {"angle_limit_cw", "angle_limit_ccw"});
  session->start(job);
  CHECK(job.snapshot().readings.empty());
  REQUIRE(session->run());
  REQUIRE_FALSE(job.snapshot().error);
  CHECK(job.snapshot().servo.identity.readings().serial_number == 240900558);
  REQUIRE(job.snapshot().readings.size() == 2);
  CHECK(job.snapshot().readings[0].raw == 901);
  CHECK(job.snapshot().readings[1].raw.error().code == Code::not_recorded);
  CHECK(session->now() == writer.at);
  ReadJob later = reader(*session, {"angle_limit_cw"});
  session->start(later);
  CHECK(later.snapshot().raw(bla::address::angle_limit_cw) == 901);
}

TEST_CASE("what a recording tells of faults only later is not known, where none were found") {
  const auto faults = [](dronecan::Health health, std::int64_t warnings, bool is_summed_up = true) {
    Writer writer;
    writer.identify();
    writer.answer("0x18", warnings != 0 && is_summed_up ? 0x200 : 0);
    writer.answer("0x1A", warnings);
    writer.say(dronecan::NodeStatus::type, dronecan::NodeStatus{.health = health}.encode());
    const auto session = writer.play();
    auto states = read_faults(*session, profiles(), std::vector{NodeId(11)}, {});
    REQUIRE(states.servos.size() == 1);
    return std::move(states.servos.front());
  };
  namespace at = bla::address;
  const FaultState fine = faults(dronecan::Health::ok, 0);
  CHECK(fine.errors.empty());
  CHECK(fine.fault_register(at::fault_failure) == 0);
  const FaultState critical = faults(dronecan::Health::critical, 0);
  REQUIRE(critical.errors.size() == 1);
  CHECK(critical.errors.front().code == Code::not_recorded);
  CHECK(critical.faults.empty());
  for (const bla::Address reg : bla::all_fault_registers) {
    CHECK_FALSE(critical.fault_register(reg));
  }
  const FaultState found = faults(dronecan::Health::critical, 0x100);
  CHECK(found.errors.size() == 1);
  CHECK(found.faults.size() == 1); // the last one known
  CHECK_FALSE(found.fault_register(at::fault_failure));
  CHECK(faults(dronecan::Health::warning, 0x100).errors.empty());
  const FaultState over = faults(dronecan::Health::ok, 0x100);
  REQUIRE(over.errors.size() == 1);
  CHECK(over.errors.front().code == Code::not_recorded);
  CHECK_FALSE(over.fault_register(at::fault_warning));
  CHECK(over.faults.empty());
  const FaultState later = faults(dronecan::Health::warning, 0x100, false); // it came after 0x18
  REQUIRE(later.errors.size() == 1);
  CHECK(later.errors.front().code == Code::not_recorded);
  CHECK(later.fault_register(at::fault_warning) == 0x100);
}

TEST_CASE("a session on a recording lives until its end, whatever the deadline") {
  Writer writer;
  writer.identify();
  const auto session = writer.play();
  REQUIRE(session->live_until(session->now() + 1us));
  CHECK(session->now() == writer.at);
  CHECK(session->roster().heard(NodeId(11)));
  REQUIRE(session->live_until(session->now() + 1h));
  CHECK(session->now() == writer.at);
}

TEST_CASE("who shows up in a recording may be asked at once, and is answered at its end") {
  Writer writer;
  writer.identify();
  const auto session = writer.play();

  class Curious final : public Roster::Listener {
   public:
    explicit Curious(Session& session) : session_(session) { session.records().add(*this); }

    ~Curious() override { session_.records().remove(*this); }

    void on_new_unit(const Member& member) override {
      job.emplace(session_.records(), member.id, profiles(), Identification::Options{});
      session_.start(*job);
    }

    std::optional<IdentifyJob> job;

   private:
    Session& session_;
  } curious(*session);

  REQUIRE(session->live_until(never));
  REQUIRE(curious.job);
  CHECK(curious.job->identification().done());
  CHECK(curious.job->identification().servo().servo_id == 3);
  CHECK(session->roster().member(NodeId(11)).is_known());
}

TEST_CASE("a servo of which only a part was recorded is known by that part") {
  Writer writer;
  writer.say(dronecan::ActuatorStatus::type, dronecan::ActuatorStatus{}.encode());
  writer.answer("0x51", 240900558);
  writer.answer("0x38", 900);
  const auto session = writer.play();
  ReadJob job = reader(*session, {"angle_limit_cw"});
  session->start(job);
  REQUIRE(session->run());
  REQUIRE_FALSE(job.snapshot().error);
  CHECK(job.snapshot().servo.is_servo);
  CHECK_FALSE(job.snapshot().servo.unique_id);
  CHECK(job.snapshot().servo.identity.model().empty());
  CHECK(job.snapshot().raw(bla::address::angle_limit_cw) == 900);
}

TEST_CASE("a node of which nothing tells what it is is not_recorded") {
  const bool heard = GENERATE(true, false);
  Writer writer;
  writer.hear(message(dronecan::ActuatorStatus::type, heard ? 11 : 12,
                      dronecan::ActuatorStatus{}.encode()));
  const auto session = writer.play();
  ReadJob job = reader(*session, {"angle_limit_cw"});
  session->start(job);
  REQUIRE(session->run());
  REQUIRE(job.snapshot().error);
  CHECK(job.snapshot().error->code == Code::not_recorded);
  CHECK(job.snapshot().error->node_id == 11);
  CHECK((job.snapshot().error->message.find("what it is") != std::string::npos) == heard);
}

TEST_CASE("a foreign node in a recording is no servo") {
  Writer writer;
  writer.hear(service(Kind::response, GetNodeInfo::type, 11, 127,
                      GetNodeInfo::Response{.unique_id = {7}, .name = "gps"}.encode()));
  const auto session = writer.play();
  ReadJob job = reader(*session, {"angle_limit_cw"});
  session->start(job);
  REQUIRE(session->run());
  CHECK(job.snapshot().error->code == Code::not_found);
  CHECK(job.snapshot().error->message.find("gps") != std::string::npos);
}

TEST_CASE("a bus-off in a recording is history") {
  Writer writer;
  writer.events.emplace_back(can::BusFault{can::FaultKind::bus_off, {}});
  writer.identify();
  CHECK(writer.play()->run());
}

TEST_CASE("a recording that breaks off ends the session, and what waits is cancelled") {
  Writer writer;
  writer.identify();
  writer.events.emplace_back(can::Gone{{Code::bad_file, "broken"}});
  const auto session = writer.play();
  ReadJob job = reader(*session, {"angle_limit_cw"});
  session->start(job);
  const auto ran = session->run();
  REQUIRE_FALSE(ran);
  CHECK(ran.error().code == Code::bad_file);
  CHECK(job.snapshot().error->code == Code::interrupted);
  CHECK(session->run());
}

TEST_CASE("a signal ends the reading of a recording") {
  Writer writer;
  writer.identify();
  const auto session = writer.play();
  REQUIRE(raise(SIGINT) == 0);
  CHECK(session->run().error().code == Code::interrupted);
  CHECK(session->signal() == SIGINT);
  REQUIRE(session->run());
  CHECK_FALSE(session->roster().heard(NodeId(11))); // it is not taken up again
}
