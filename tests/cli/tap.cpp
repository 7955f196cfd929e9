#include "tap.hpp"

#include "blactl/dronecan/types.hpp"
#include "blactl/sim/scenario/foreign_node.hpp"

#include <poll.h>

#include <deque>
#include <stdexcept>

namespace blactl::test {
namespace {

constexpr dronecan::NodeId visitor(100);

bool is_from(const can::Frame& frame, int source) {
  const auto header = dronecan::decode_id(frame.id);
  return header && header->source.value() == source;
}

void wait_for_frames(const can::SimBus& bus, int milliseconds) {
  pollfd readable{bus.descriptor(), POLLIN, 0};
  poll(&readable, 1, milliseconds);
}

} // namespace

std::unique_ptr<can::SimBus> join(const Bench& bench) {
  auto bus = can::SimBus::open(bench.folder() / "run" / "blactl" / "sim", "sim:");
  if (!bus) {
    throw std::runtime_error(bus.error().message);
  }
  return std::move(*bus);
}

Tap::Tap(const Bench& bench) : bus_(join(bench)) {
  // Only what blactl sends: the servos alone would fill the queue while nobody looks.
  constexpr std::uint32_t source = 0x7F;
  const std::vector<can::Filter> filters{{127, source}, {126, source}};
  if (!bus_->filter(filters)) {
    throw std::runtime_error("the simulator is gone");
  }
}

std::vector<can::Frame> Tap::take() {
  std::vector<can::Frame> frames;
  while (const auto event = bus_->receive()) {
    if (const auto* received = std::get_if<can::Received>(&*event)) {
      frames.push_back(received->frame);
    } else {
      throw std::runtime_error("the tap lost frames");
    }
  }
  return frames;
}

std::size_t Tap::frames() {
  return take().size();
}

std::vector<std::string> Tap::writes() {
  using dronecan::GetSet;
  std::vector<std::string> found;
  const auto write = [&](const dronecan::Transfer& transfer) {
    const auto request = GetSet::Request::decode(transfer.payload);
    const auto* value = request ? std::get_if<std::int64_t>(&request->value) : nullptr;
    if (value != nullptr) {
      found.push_back(request->name + "=" + std::to_string(*value));
    }
  };
  dronecan::Receiver receiver(32, dronecan::anonymous, {.transfer = [&](const auto& transfer) {
                                const auto& header = transfer.header;
                                if (header.kind == dronecan::Kind::request &&
                                    header.data_type_id == GetSet::type.id) {
                                  write(transfer);
                                }
                              }});
  for (const can::Frame& frame : take()) {
    receiver.receive(frame, Time{});
  }
  return found;
}

void Tap::wait_for(int source) {
  for (;;) {
    for (const can::Frame& frame : take()) {
      if (is_from(frame, source)) {
        return;
      }
    }
    wait_for_frames(*bus_, 1000);
  }
}

Visitor::Visitor(const Bench& bench, std::uint8_t servo) : bus_(join(bench)), servo_(servo) {
  wait_for(dronecan::Kind::message);
}

void Visitor::ask(const dronecan::DataType& type, const dronecan::Payload& request) {
  const dronecan::Header header{
      dronecan::Kind::request, dronecan::priority_service, type.id, visitor, servo_, 0};
  for (const can::Frame& frame :
       dronecan::segment(header, transfer_id_, type.signature, request.bytes())) {
    if (!bus_->send(frame).value_or(false)) {
      throw std::runtime_error("the simulator does not take a frame");
    }
  }
  transfer_id_ =
      static_cast<dronecan::TransferId>((transfer_id_ + 1) % dronecan::transfer_id_modulus);
  wait_for(dronecan::Kind::response);
}

/// Until a transfer of the servo has begun, a response of it to this node.
void Visitor::wait_for(dronecan::Kind kind) {
  const Time end = bus_->now() + 20s;
  while (bus_->now() < end) {
    while (const auto event = bus_->receive()) {
      const auto* received = std::get_if<can::Received>(&*event);
      const auto heard =
          received != nullptr ? dronecan::decode_id(received->frame.id) : std::nullopt;
      if (heard && heard->kind == kind && heard->source == servo_ &&
          (kind == dronecan::Kind::message || heard->destination == visitor)) {
        return;
      }
    }
    wait_for_frames(*bus_, 1000);
  }
  throw std::runtime_error("the servo is not heard");
}

Guest::Guest(const Bench& bench, const sim::ForeignSetup& setup)
    : thread_([this, setup, bus = join(bench)] {
        sim::ForeignNode node(setup, bus->now());
        std::deque<can::Frame> queue;
        node.connect([&](const can::Frame& frame) { queue.push_back(frame); });
        while (!leaves_) {
          while (const auto event = bus->receive()) {
            if (const auto* received = std::get_if<can::Received>(&*event)) {
              node.receive(received->frame, received->at);
            }
          }
          while (node.next_deadline() <= bus->now()) {
            node.advance(bus->now());
          }
          while (!queue.empty() && bus->send(queue.front()).value_or(false)) {
            queue.pop_front();
          }
          wait_for_frames(*bus, 5);
        }
      }) {}

Guest::~Guest() {
  leaves_ = true;
  thread_.join();
}

} // namespace blactl::test
