#include "blactl/sim/bus/served_interface.hpp"

#include <algorithm>
#include <variant>

namespace blactl::sim {
namespace {

/// Frames of the devices queued while no node acknowledges; further ones are lost.
constexpr std::size_t max_outgoing = 256;

constexpr std::size_t nobody = static_cast<std::size_t>(-1);

} // namespace

ServedInterface::ServedInterface(can::Loop& loop, const Scenario& scenario, const EventSink& sink)
    : loop_(loop), devices_(make_devices(scenario, loop.now(), sink)),
      timeline_(scenario.events, loop.now()) {
  for (std::size_t i = 0; i < devices_.all.size(); ++i) {
    devices_.all[i]->connect([this, i](const can::Frame& frame) { send(i, frame); });
  }
}

Time ServedInterface::next_deadline() const {
  Time next = timeline_.next();
  for (const auto& device : devices_.all) {
    next = std::min(next, device->next_deadline());
  }
  return next;
}

void ServedInterface::handle(const can::Event& event) {
  if (const auto* received = std::get_if<can::Received>(&event)) {
    heard(received->frame, received->at, nobody);
  } else if (const auto* sent = std::get_if<can::Sent>(&event)) {
    const auto same = [&](const Outgoing& outgoing) { return outgoing.frame == sent->frame; };
    if (const auto it = std::ranges::find_if(outgoing_, same); it != outgoing_.end()) {
      const std::size_t sender = it->device;
      outgoing_.erase(it);
      heard(sent->frame, sent->at, sender);
    }
  }
  // echoes of frames on their way do not come any more
  const auto* fault = std::get_if<can::BusFault>(&event);
  if (std::holds_alternative<can::Overflow>(event) ||
      (fault != nullptr && fault->kind == can::FaultKind::bus_off)) {
    outgoing_.clear();
  }
  const Time now = loop_.now();
  while (const TimedEvent* due = timeline_.take(now)) {
    devices_.happen(*due, now);
  }
  for (const auto& device : devices_.all) {
    if (device->next_deadline() <= now) {
      device->advance(now);
    }
  }
}

void ServedInterface::send(std::size_t device, const can::Frame& frame) {
  if (outgoing_.size() < max_outgoing) {
    outgoing_.push_back({frame, device});
    loop_.send(frame);
  }
}

void ServedInterface::heard(const can::Frame& frame, Time at, std::size_t sender) {
  for (std::size_t i = 0; i < devices_.all.size(); ++i) {
    if (i != sender) {
      devices_.all[i]->receive(frame, at);
    }
  }
}

} // namespace blactl::sim
