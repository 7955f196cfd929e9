#include "fleet/characterize/start_watch.hpp"

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

namespace blactl::fleet {

using dronecan::Allocation;
using dronecan::ExecuteOpcode;
using dronecan::NodeStatus;
using dronecan::RestartNode;

namespace {

/// The next transfer ID of a unit after this one (5 bits).
constexpr dronecan::TransferId id_after(dronecan::TransferId id) {
  return static_cast<dronecan::TransferId>((id + 1U) & 0x1FU);
}

} // namespace

void StartWatch::receive(const dronecan::Transfer& transfer) {
  const dronecan::Header& header = transfer.header;
  const bool is_order =
      header.data_type_id == RestartNode::type.id || header.data_type_id == ExecuteOpcode::type.id;
  if (header.kind == dronecan::Kind::response && header.source == id_ && is_order &&
      is_expected() && !answered_) {
    begin_start(); // earlier frames do not belong to it
    answered_ = transfer.at;
  } else if (header.kind == dronecan::Kind::message && header.source.is_unicast()) {
    hear_message(transfer);
  } else if (header.kind == dronecan::Kind::message) {
    hear_request(transfer);
  }
}

/// A sender that restarted begins its transfer IDs and its uptime anew, and sends at other moments.
bool StartWatch::has_started(Sender& sender, const dronecan::Transfer& transfer) {
  constexpr Duration period = std::chrono::milliseconds(100); // of actuator.Status (2.2)
  constexpr Duration tolerance = std::chrono::milliseconds(20);
  const std::uint16_t type = transfer.header.data_type_id;
  const auto last = sender.last_ids.find(type);
  bool is_new = last == sender.last_ids.end() || transfer.transfer_id != id_after(last->second);
  sender.last_ids[type] = transfer.transfer_id;
  if (const auto status = type == NodeStatus::type.id ? NodeStatus::decode(transfer.payload)
                                                      : std::optional<NodeStatus>()) {
    is_new = is_new || status->uptime_s < sender.uptime_s.value_or(0);
    sender.uptime_s = status->uptime_s;
  }
  if (type == dronecan::ActuatorStatus::type.id) {
    const Duration since = transfer.at - std::exchange(sender.status_at, transfer.at);
    is_new = is_new || since < period - tolerance || since > period + tolerance;
    sender.status = dronecan::ActuatorStatus::decode(transfer.payload);
  }
  return is_new;
}

void StartWatch::hear_message(const dronecan::Transfer& transfer) {
  Sender& sender = senders_[transfer.header.source];
  const bool is_new = has_started(sender, transfer);
  if (!is_expected() || (!is_new && !sender.first)) {
    return;
  }
  sender.first = sender.first.value_or(transfer.at);
  const auto status = transfer.header.data_type_id == NodeStatus::type.id
                          ? NodeStatus::decode(transfer.payload)
                          : std::optional<NodeStatus>();
  if (status && !sender.first_status) {
    sender.first_status = transfer.at;
    sender.first_mode = status->mode;
  }
}

void StartWatch::hear_request(const dronecan::Transfer& transfer) {
  const auto request = transfer.header.data_type_id == Allocation::type.id
                           ? Allocation::decode(transfer.payload)
                           : std::optional<Allocation>();
  const bool is_ours =
      request && request->first_part_of_unique_id &&
      dronecan::begins_with(unique_id_, std::span(request->unique_id).first(request->size));
  if (is_ours && is_expected()) {
    requested_ = requested_.value_or(transfer.at);
  }
}

void StartWatch::expect(dronecan::NodeId id, std::function<bool()> is_sent) {
  id_ = id;
  is_sent_ = std::move(is_sent);
  begin_start();
}

void StartWatch::begin_start() {
  answered_ = requested_ = std::nullopt;
  for (auto& [node, sender] : senders_) {
    sender.first = sender.first_status = std::nullopt;
    sender.first_mode = std::nullopt;
  }
}

Start StartWatch::start_of(dronecan::NodeId id) const {
  Start start{.answered = answered_, .requested = requested_};
  if (const auto sender = senders_.find(id); sender != senders_.end()) {
    start.first = sender->second.first;
    start.first_status = sender->second.first_status;
    start.first_mode = sender->second.first_mode;
  }
  return start;
}

std::optional<dronecan::ActuatorStatus> StartWatch::status_of(dronecan::NodeId id) const {
  const auto sender = senders_.find(id);
  return sender != senders_.end() ? sender->second.status : std::nullopt;
}

} // namespace blactl::fleet
