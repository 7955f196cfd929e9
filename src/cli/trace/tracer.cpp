#include "cli/trace/tracer.hpp"

#include "blactl/dronecan/standard_types.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace blactl::cli {
namespace {

using dronecan::Receiver;

/// Concurrent sessions of the reassembly (senders times types); 4 MiB of address space.
constexpr std::size_t sessions = 4096;

/// The interval of checks for unfinished transfers while frames come.
constexpr Duration sweep_interval = std::chrono::seconds(1);

/// Just longer than a transfer may take.
constexpr Duration expiry = Receiver::transfer_timeout + Duration(1);

std::optional<std::uint64_t> signature_of(dronecan::Kind kind, std::uint16_t data_type_id) {
  const auto* type = dronecan::find_standard_type(kind, data_type_id);
  return type != nullptr ? std::optional(type->signature) : std::nullopt;
}

TraceError error_of(dronecan::ReceiveError error) {
  switch (error) {
  case dronecan::ReceiveError::crc: return TraceError::crc;
  case dronecan::ReceiveError::toggle: return TraceError::toggle;
  case dronecan::ReceiveError::missing_start: return TraceError::missing_start;
  case dronecan::ReceiveError::transfer_id: return TraceError::transfer_id;
  case dronecan::ReceiveError::truncated: return TraceError::truncated;
  case dronecan::ReceiveError::timeout: break;
  }
  return TraceError::timeout;
}

} // namespace

Tracer::Tracer(TraceFilter filter, TraceOutput& output, std::uint64_t most)
    : filter_(std::move(filter)), output_(output), most_(most) {}

std::unique_ptr<Tracer::Network> Tracer::make_network(std::string_view interface) {
  auto network = std::make_unique<Network>();
  network->interface = interface;
  // without its own node ID the receiver accepts every destination
  network->receiver = std::make_unique<Receiver>(
      sessions, dronecan::anonymous,
      Receiver::Callbacks{
          .transfer = [this, here = network.get()](const auto& transfer) { show(*here, transfer); },
          .error = [this,
                    here = network.get()](auto error, std::uint32_t can_id,
                                          Time at) { show(*here, error_of(error), can_id, at); },
          .signature = signature_of});
  return network;
}

Tracer::Network* Tracer::network_of(std::string_view interface) {
  if (last_ != nullptr && last_->interface == interface) {
    return last_;
  }
  const auto it =
      std::ranges::find(networks_, interface, [](const auto& network) -> const std::string& {
        return network->interface;
      });
  if (it != networks_.end()) {
    last_ = it->get();
  } else if (networks_.size() < most_interfaces) {
    last_ = networks_.emplace_back(make_network(interface)).get();
  } else {
    return nullptr;
  }
  return last_;
}

void Tracer::receive(const Heard& heard) {
  ++counts_.frames;
  Network* network = network_of(heard.interface);
  if (network == nullptr) {
    ++counts_.skipped;
    return;
  }
  network->to_wall = heard.wall.time_since_epoch() - heard.at.time_since_epoch();
  const auto header = heard.frame.extended ? dronecan::decode_id(heard.frame.id) : std::nullopt;
  output_.frame(heard, header && filter_.passes(*header));
  network->receiver->receive(heard.frame, heard.at);
  if (heard.at >= network->sweep) {
    network->receiver->expire(heard.at);
    network->sweep = heard.at + sweep_interval;
  }
  next_expiry_ = heard.at + expiry;
}

void Tracer::expire(Time now) {
  for (const auto& network : networks_) {
    network->receiver->expire(now);
  }
  if (now >= next_expiry_) {
    next_expiry_ = never;
  }
}

void Tracer::show(const Network& network, const dronecan::Transfer& transfer) {
  if (full() || !filter_.passes(transfer.header)) {
    return;
  }
  if (output_.transfer(network.occasion(transfer.at), transfer)) {
    ++counts_.transfers;
  } else {
    show(network, TraceError::too_short, encode_id(transfer.header), transfer.at);
  }
}

void Tracer::show(const Network& network, TraceError error, std::uint32_t can_id, Time at) {
  const auto header = dronecan::decode_id(can_id);
  if (full() || !header || !filter_.passes(*header)) {
    return;
  }
  ++counts_.errors;
  output_.broken(network.occasion(at), error, can_id);
}

} // namespace blactl::cli
