#include "blactl/dronecan/allocator.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::dronecan {
namespace {

using namespace std::chrono_literals;

/// FOLLOWUP_TIMEOUT_MS of the DSDL: after that an unfinished exchange is forgotten.
constexpr Duration followup_timeout = 500ms;

/// How long this allocator leaves another one to answer before its own first answer.
constexpr Duration courtesy = 100ms;

/// The priority that the vendor's program and the servos use.
constexpr Priority priority = 24;

constexpr std::uint8_t part_size = 6;
constexpr std::uint8_t last_part_size = 4;
constexpr std::uint8_t whole = 16;

} // namespace

void Allocator::receive(const Transfer& transfer) {
  const Header& header = transfer.header;
  if (header.kind != Kind::message || header.data_type_id != Allocation::type.id ||
      header.source == node_.id()) {
    return;
  }
  if (header.source.is_unicast()) {
    other_ = header.source;
    answer_due_ = never;
    return;
  }
  const auto request = Allocation::decode(transfer.payload);
  if (!request || other_) {
    return;
  }
  if (transfer.at - answered_at_ > followup_timeout) {
    collected_ = {};
  }
  if (!takes(*request)) {
    return; // not the part awaited, or not a unit of ours: changes nothing
  }
  answer_due_ = has_answered_ ? transfer.at : transfer.at + courtesy;
  answered_at_ = answer_due_; // the servo's timeout runs from our answer
}

/// Adds a part if it is the next one expected.
bool Allocator::takes(const Allocation& request) {
  const std::uint8_t have = collected_.size;
  const std::uint8_t expected = have < 2 * part_size ? part_size : last_part_size;
  if (request.first_part_of_unique_id != (have == 0) || request.size != expected || have == whole) {
    return false;
  }
  Allocation longer = collected_;
  std::copy_n(request.unique_id.begin(), request.size, longer.unique_id.begin() + have);
  longer.size = static_cast<std::uint8_t>(have + request.size);
  if (!table_.serves(Bytes(longer.unique_id).first(longer.size))) {
    return false;
  }
  collected_ = longer;
  preferred_ = NodeId(request.node_id);
  return true;
}

void Allocator::advance(Time now) {
  if (answer_due_ <= now) {
    answer_due_ = never;
    answer();
  }
}

void Allocator::answer() {
  Allocation reply = collected_;
  if (reply.size == whole) {
    collected_ = {};
    if (is_blank(reply.unique_id)) { // every other such unit would take the same node ID
      return;
    }
    const auto id = table_.assign(reply.unique_id, preferred_);
    if (!id || !id->is_unicast() || id == node_.id()) {
      return;
    }
    reply.node_id = id->value();
  }
  has_answered_ = true;
  node_.broadcast(Allocation::type, priority, reply.encode());
}

} // namespace blactl::dronecan
