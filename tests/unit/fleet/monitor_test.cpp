#include "blactl/fleet/live/monitor.hpp"

#include "support.hpp"

#include <algorithm>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

std::unique_ptr<can::Bus> bus_of(std::string_view servos) {
  const auto scenario = sim::parse_scenario(
      fmt::format(R"({{"schema": "blactl-scenario/1", "clock": "virtual", "servos": [{}]}})",
                  servos),
      "test.json", profiles());
  INFO((scenario ? "" : scenario.error().message));
  REQUIRE(scenario);
  return std::make_unique<sim::PrivateBus>("sim:test.json", *scenario);
}

/// The cable is pulled off one bus at `off`, and is on the other one from `on`. Both run all the
/// time.
class Replugged final : public blactl::test::BusAround {
 public:
  Replugged(std::string_view one, std::string_view other, Time off, Time on)
      : BusAround(bus_of(one)), other_(bus_of(other)), off_(off), on_(on) {}

  [[nodiscard]] Result<bool> send(const can::Frame& frame) override {
    return now() < off_ ? BusAround::send(frame) : other_->send(frame);
  }

  [[nodiscard]] std::optional<can::BusEvent> receive() override {
    if (now() < off_) {
      return BusAround::receive();
    }
    auto event = other_->receive();
    const auto* received = event ? std::get_if<can::Received>(&*event) : nullptr;
    return received != nullptr && received->at < on_ ? std::nullopt : event;
  }

  [[nodiscard]] Result<void> filter(std::span<const can::Filter> filters) override {
    REQUIRE(other_->filter(filters));
    return BusAround::filter(filters);
  }

  [[nodiscard]] Time now() const override { return std::max(BusAround::now(), other_->now()); }

  [[nodiscard]] Time idle_until(Time deadline) override {
    const bool is_on_first = now() < off_;
    const Time end = is_on_first ? BusAround::idle_until(std::min(deadline, off_))
                                 : other_->idle_until(deadline);
    while (is_on_first && other_->now() < end) {
      while (other_->receive()) {
      }
      (void)other_->idle_until(end);
    }
    return end;
  }

 private:
  std::unique_ptr<can::Bus> other_;
  Time off_, on_;
};

constexpr std::string_view servo_1001 =
    R"({"model": "BLA21-12U-AB", "node_id": 20, "serial_number": 1001,
        "behaviour": {"boot_time": "100ms"}})";
constexpr std::string_view servo_1002 =
    R"({"model": "BLA21-12U-AB", "node_id": 20, "serial_number": 1002,
        "rom": {"temperature_limit_high": "20degC"}, "behaviour": {"boot_time": "100ms"}})";

/// From 5 s on no NodeStatus is heard, but all else is.
class WithoutStatus final : public blactl::test::BusAround {
 public:
  using BusAround::BusAround;

  [[nodiscard]] std::optional<can::BusEvent> receive() override {
    auto event = BusAround::receive();
    const auto* received = event ? std::get_if<can::Received>(&*event) : nullptr;
    const auto header =
        received != nullptr ? dronecan::decode_id(received->frame.id) : std::nullopt;
    const bool is_lost = header && header->kind == dronecan::Kind::message &&
                         header->data_type_id == dronecan::NodeStatus::type.id &&
                         received->at > Time(5s);
    return is_lost ? std::nullopt : event;
  }
};

/// A session on a bus, and a monitor of what `list` means.
class Watching {
 public:
  /// The cable of servo 1001 is pulled at 5 s, and is on the other one after the silence.
  Watching(std::string_view other, Duration silence, std::string_view list)
      : Watching(std::make_unique<Replugged>(servo_1001, other, Time(5s), Time(5s) + silence),
                 list) {}

  Watching(std::unique_ptr<can::Bus> bus, std::string_view list)
      : session(open(std::move(bus))),
        monitor(*session, profiles(), *parse_targets(list),
                {.identification = {},
                 .fields = {LiveField::angle, LiveField::speed, LiveField::torque,
                            LiveField::temperature, LiveField::voltage, LiveField::faults},
                 .sample = [this](Time now) { samples.push_back(monitor.servos(now)); }}) {}

  void live_until(Time end) const {
    const auto lived = session->live_until(end);
    INFO((lived ? "" : lived.error().message));
    REQUIRE(lived);
  }

  std::unique_ptr<Session> session;
  std::vector<std::vector<LiveServo>> samples;
  Monitor monitor;

 private:
  static std::unique_ptr<Session> open(std::unique_ptr<can::Bus> bus) {
    auto opened = Session::open(std::move(bus), state::LocalNodeId::unshared({}),
                                Session::Hearing::answers, profiles());
    REQUIRE(opened);
    return std::move(*opened);
  }
};

std::optional<std::int64_t> serial_of(const LiveServo& servo) {
  return servo.servo.identity.readings().serial_number;
}

bool tells_a_value(const LiveServo& servo) {
  return std::ranges::any_of(servo.values, [](const auto& value) { return value.has_value(); });
}

} // namespace

TEST_CASE("a servo that was plugged in for another one is never shown under its name") {
  for (const Duration silence : {300ms, 1000ms, 5000ms}) {
    INFO(silence.count());
    const Time back = Time(5s) + silence;
    Watching watching(servo_1002, silence, "20");
    watching.live_until(back);
    REQUIRE(watching.samples.back().size() == 1);
    CHECK(serial_of(watching.samples.back()[0]) == 1001);
    watching.samples.clear();
    watching.live_until(back + 5s);
    for (const auto& sample : watching.samples) {
      for (const LiveServo& servo : sample) {
        const bool is_silent = servo.last_heard < back;
        CHECK((is_silent || !tells_a_value(servo) || serial_of(servo) == 1002));
      }
    }
    REQUIRE(watching.samples.back().size() == 1);
    const LiveServo& last = watching.samples.back()[0];
    CHECK(serial_of(last) == 1002);
    CHECK_FALSE(last.is_stale);
    CHECK_FALSE(last.is_doubled);
    CHECK(last.restarts == 0);
    CHECK(tells_a_value(last));
  }
}

TEST_CASE("who is monitored by its serial number is not shown by what another one tells") {
  Watching watching(servo_1002, 1s, "serial:1001");
  watching.live_until(Time(5s));
  REQUIRE(watching.samples.back().size() == 1);
  watching.samples.clear();
  watching.live_until(Time(12s));
  for (const auto& sample : watching.samples) {
    for (const LiveServo& servo : sample) {
      CHECK((servo.last_heard < Time(6s) || !tells_a_value(servo)));
    }
  }
  CHECK(watching.samples.back().empty());
  CHECK(watching.monitor.missing(Time(12s)).size() == 1);
}

TEST_CASE("a servo that comes back from a silence as itself is shown on") {
  Watching watching(servo_1001, 1s, "serial:1001");
  watching.live_until(Time(8s));
  REQUIRE(watching.samples.back().size() == 1);
  const LiveServo& last = watching.samples.back()[0];
  CHECK(serial_of(last) == 1001);
  CHECK_FALSE(last.is_stale);
  CHECK(last.restarts == 0);
  CHECK(tells_a_value(last));
}

TEST_CASE(
    "health and mode that were not heard for some seconds are not shown as the present ones") {
  Watching watching(std::make_unique<WithoutStatus>(bus_of(servo_1001)), "20");
  watching.live_until(Time(5s));
  CHECK(watching.samples.back().at(0).status);
  CHECK_FALSE(watching.samples.back().at(0).is_stale);
  watching.live_until(Time(9s));
  const LiveServo& last = watching.samples.back().at(0);
  CHECK_FALSE(last.status);
  CHECK(last.is_stale);
  CHECK_FALSE(last.is_gone);
  CHECK(serial_of(last) == 1001);
  CHECK(tells_a_value(last));
}
