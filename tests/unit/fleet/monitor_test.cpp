#include "blactl/fleet/live/monitor.hpp"

#include "replugged.hpp"
#include "support.hpp"

#include <algorithm>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

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
      : Watching(std::make_unique<Replugged>(servo_1001, other,
                                             std::vector{Gap{Time(5s), Time(5s) + silence}}),
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
