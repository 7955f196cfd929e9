#include "blactl/sim/bus/simulator.hpp"

#include "blactl/sim/node/random.hpp"
#include "blactl/sim/scenario/foreign_node.hpp"

#include <algorithm>
#include <utility>

namespace blactl::sim {
namespace {

/// Frames in a device's transmit queue; further ones are lost.
constexpr std::size_t device_queue = 64;

/// Different from the index of every device.
constexpr std::uint64_t seed_of_the_wire = ~std::uint64_t{0};

} // namespace

Devices make_devices(const Scenario& scenario, Time power_on, const EventSink& sink) {
  Devices devices;
  for (const ServoSetup& setup : scenario.servos) {
    const std::uint64_t seed = seed_of(scenario.seed, devices.all.size());
    auto servo = std::make_unique<Servo>(setup, seed, power_on);
    servo->report_to(sink);
    devices.servos.push_back(servo.get());
    if (setup.sending.any()) {
      devices.all.push_back(
          std::make_unique<DelayedDevice>(std::move(servo), setup.sending, seed_of(seed, 0)));
    } else {
      devices.all.push_back(std::move(servo));
    }
  }
  for (const ForeignSetup& setup : scenario.foreign) {
    devices.all.push_back(std::make_unique<ForeignNode>(setup, power_on + setup.joins));
  }
  return devices;
}

bool Devices::change(std::int64_t serial_number, std::span<const WorldChange> changes,
                     Time now) const {
  bool found = false;
  for (Servo* servo : servos) {
    if (servo->serial_number() == serial_number) {
      World world = servo->world();
      for (const WorldChange& change : changes) {
        change(world);
      }
      servo->surround(world, now);
      found = true;
    }
  }
  return found;
}

void Devices::happen(const TimedEvent& event, Time now) const {
  (void)change(event.serial_number, event.changes, now);
  for (Servo* servo : servos) {
    if (event.mishap && servo->serial_number() == event.serial_number) {
      servo->suffer(*event.mishap, now);
    }
  }
}

class Simulator::Station final : public Medium::Listener {
 public:
  Station(Device& device, Medium& medium, const Time& now) : device_(device) {
    const Medium::PortId port = medium.attach(*this, device_queue, now);
    device_.connect(
        [&medium, &now, port](const can::Frame& frame) { medium.send(port, frame, now); });
  }

  void heard(const can::Frame& frame, Time at) override { device_.receive(frame, at); }

  void sent(const can::Frame&, Time) override {}

  void bus_off(Time) override {}

 private:
  Device& device_;
};

Simulator::Simulator(const Scenario& scenario, Time power_on, const EventSink& sink)
    : now_(power_on), medium_(scenario.wire, seed_of(scenario.seed, seed_of_the_wire)),
      devices_(make_devices(scenario, power_on, sink)), timeline_(scenario.events, power_on) {
  for (const auto& device : devices_.all) {
    stations_.push_back(std::make_unique<Station>(*device, medium_, now_));
  }
}

Simulator::~Simulator() = default;

Time Simulator::next_event() const {
  Time next = std::min(medium_.next_event(), timeline_.next());
  for (const auto& device : devices_.all) {
    next = std::min(next, device->next_deadline());
  }
  return next == never ? never : std::max(next, now_);
}

/// At one moment the devices act before the medium, so that everything sent at that moment takes
/// part in the same arbitration.
void Simulator::advance_to(Time time) {
  for (Time at = next_event(); at <= time && at != never; at = next_event()) {
    now_ = at;
    while (const TimedEvent* event = timeline_.take(now_)) {
      happen(*event);
    }
    for (const auto& device : devices_.all) {
      if (device->next_deadline() <= now_) {
        device->advance(now_);
      }
    }
    medium_.advance(now_);
  }
  now_ = std::max(now_, time);
}

void Simulator::happen(const TimedEvent& event) {
  if (event.serial_number == 0) {
    link_clients(event.clients);
  } else {
    devices_.happen(event, now_);
  }
}

void Simulator::link_clients(ClientLink link) {
  for (const Medium::PortId client : clients_) {
    if (link == ClientLink::bus_off) {
      medium_.bus_off(client, now_);
    } else {
      medium_.cut(client, link == ClientLink::cut, now_);
    }
  }
  link_ = link == ClientLink::bus_off ? link_ : link;
}

Medium::PortId Simulator::attach(Medium::Listener& listener, std::size_t capacity) {
  const Medium::PortId port = medium_.attach(listener, capacity, now_);
  clients_.insert(port);
  medium_.cut(port, link_ == ClientLink::cut, now_);
  return port;
}

void Simulator::detach(Medium::PortId port) {
  clients_.erase(port);
  medium_.detach(port);
}

bool Simulator::send(Medium::PortId port, const can::Frame& frame, Time at) {
  return medium_.send(port, frame, std::max(at, now_));
}

} // namespace blactl::sim
