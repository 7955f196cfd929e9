#include "blactl/sim/bus/served_interface.hpp"

#include "unit/sim/support.hpp"

#include <deque>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using testing::frame;
using testing::scenario;

namespace {

/// An interface whose frames the test sends and hears; its time passes when the loop waits.
class FakeBus final : public can::Bus {
 public:
  [[nodiscard]] std::string_view name() const override { return "vcan0"; }

  [[nodiscard]] Result<bool> send(const can::Frame& sent) override {
    on_wire.push_back(sent);
    if (acknowledged) {
      events.emplace_back(can::Sent{sent, now_, {}});
    }
    return true;
  }

  [[nodiscard]] std::optional<can::BusEvent> receive() override {
    if (events.empty()) {
      return std::nullopt;
    }
    can::BusEvent event = std::move(events.front());
    events.pop_front();
    return event;
  }

  [[nodiscard]] Result<void> filter(std::span<const can::Filter>) override { return {}; }

  [[nodiscard]] bool echoes() const override { return true; }

  [[nodiscard]] int descriptor() const override { return -1; }

  [[nodiscard]] Time now() const override { return now_; }

  [[nodiscard]] Time idle_until(Time deadline) override {
    now_ = deadline;
    return now_;
  }

  void hear(const can::Frame& heard) { events.emplace_back(can::Received{heard, now_, {}}); }

  std::vector<can::Frame> on_wire;
  std::deque<can::BusEvent> events;
  bool acknowledged = true;

 private:
  Time now_{};
};

struct Rig {
  explicit Rig(std::string_view members)
      : owned(std::make_unique<FakeBus>()), bus(*owned), loop(std::move(owned)),
        interface(loop, scenario(members),
                  [this](const ServoEvent& event) { events.push_back(event.kind); }) {}

  void run(Duration duration) {
    const Time end = loop.now() + duration;
    while (loop.now() < end) {
      interface.handle(loop.next(std::min(end, interface.next_deadline())));
    }
  }

  [[nodiscard]] long count(std::string_view text) const {
    return std::ranges::count_if(
        bus.on_wire, [&](const can::Frame& sent) { return testing::text(sent).starts_with(text); });
  }

  std::vector<ServoEvent::Kind> events;
  std::unique_ptr<FakeBus> owned;
  FakeBus& bus;
  can::Loop loop;
  ServedInterface interface;
};

} // namespace

TEST_CASE("the servos of a scenario live on a real interface") {
  Rig rig(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11, "answer_delay": "2ms"},
                        {"model": "BLA15-06U-A0", "node_id": 12}])");
  rig.run(2s);
  CHECK(rig.count("1001550B#") == 2);
  CHECK(rig.count("1001550C#") == 2);
  rig.bus.hear(frame("1E0B8BFF#000030783338C5"));
  rig.run(10ms);
  CHECK(rig.count("1E0B7F8B#6D4C010707000085") == 1);
  CHECK(rig.count("1E0B7F8B#3078333845") == 1);
  CHECK(rig.count("1E0B7F8C#") == 0);
}

TEST_CASE("a servo on a real interface saves, is silent, comes back, and it is told") {
  Rig rig(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])");
  rig.run(500ms);
  rig.bus.hear(frame("1E0A8BFF#00000000000000C1"));
  rig.run(10ms);
  CHECK(rig.count("1E0A7F8B#00000000000080C1") == 1);
  CHECK(rig.events.empty());
  const auto sent = rig.bus.on_wire.size();
  rig.run(80ms);
  CHECK(rig.bus.on_wire.size() == sent);
  rig.run(150ms);
  CHECK(rig.count("1001550B#00000000000000C0") == 2);
  CHECK(rig.events == std::vector{ServoEvent::Kind::rom_write, ServoEvent::Kind::restart});
}

TEST_CASE("devices on one interface hear each other once, and never themselves") {
  // Two servos without an ID: each request that one hears makes the other start over, so they
  // take turns for longer than one alone would need; what one sends itself does not delay it.
  Rig alone(R"("servos": [{"model": "BLA21-12U-AB"}])");
  alone.run(60s);
  const auto requests_alone = alone.bus.on_wire.size();
  CHECK(requests_alone >= 60);
  Rig pair(R"("servos": [{"model": "BLA21-12U-AB"}, {"model": "BLA21-12U-AB"}])");
  pair.run(60s);
  CHECK(pair.bus.on_wire.size() < requests_alone * 3 / 2);
}

TEST_CASE("while nobody acknowledges, frames do not pile up without end") {
  Rig rig(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])");
  rig.bus.acknowledged = false;
  rig.run(60s);
  CHECK(rig.bus.on_wire.size() == 1); // the loop probes with one
  CHECK(rig.loop.unsent() <= 256);
}
