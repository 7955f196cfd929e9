#include "blactl/base/crc16.hpp"
#include "blactl/dronecan/transfer.hpp"

#include "dronecan/slot_table.hpp"
#include "dronecan/tail.hpp"

#include <algorithm>
#include <utility>

namespace blactl::dronecan {
namespace {

constexpr std::size_t buffer_size = Receiver::capacity + crc_size;

/// All of a CAN ID but the priority is just what the specification calls the transfer descriptor:
/// kind, data type, source and destination.
constexpr std::uint32_t descriptor_mask = 0x00FF'FFFF;
constexpr unsigned priority_in_key = 24;

constexpr TransferId next(TransferId id) {
  return static_cast<TransferId>((id + 1U) % transfer_id_modulus);
}

constexpr unsigned forward_distance(TransferId from, TransferId to) {
  return (to - from) % static_cast<unsigned>(transfer_id_modulus);
}

bool timed_out(Time since, Time now) {
  return since < now - Receiver::transfer_timeout;
}

/// A frame that belongs to this network, taken apart.
struct Arrival {
  const can::Frame& frame;
  Header header;
  Tail tail;
  Time at;
};

/// The payload of a frame, without the tail byte.
std::span<const std::uint8_t> payload_of(const can::Frame& frame) {
  return frame.payload().first(frame.size - 1U);
}

std::optional<Arrival> take_apart(const can::Frame& frame, Time at) {
  if (!frame.extended || frame.remote || frame.size == 0 || frame.size > frame.data.size()) {
    return std::nullopt;
  }
  const auto header = decode_id(frame.id);
  if (!header) {
    return std::nullopt;
  }
  return Arrival{frame, *header, Tail::decode(frame.data[frame.size - 1U]), at};
}

/// How far the transfer in progress can be trusted; each value is worse than the last.
enum class Trust : std::uint8_t {
  whole,    ///< nothing is amiss so far
  doubtful, ///< there may be a gap: it is delivered only if its CRC proves it right
  broken,   ///< parts of it were not kept: it is not delivered
};

/// The state of one transfer descriptor.
struct Session {
  std::span<std::uint8_t> buffer; ///< CRC and payload of a multi-frame transfer

  // The state variables of the pseudo code; `started`: `first` has a value.
  bool started = false;
  Time first; ///< when the last transfer began
  TransferId expected = 0;
  bool toggle = false;

  bool pending = false;
  bool single = false; ///< single-frame transfer: no CRC, the buffer stays unused
  Trust trust = Trust::whole;
  Priority priority = 0; ///< of its first frame
  std::size_t size = 0;  ///< bytes in the buffer

  // Limits the reports to one per fault.
  can::Frame last{.size = 0};       ///< the last frame that was accepted
  std::optional<TransferId> blamed; ///< the transfer whose fault was reported last
  Time blamed_at;

  [[nodiscard]] bool needs_restart(const Arrival& arrival) const {
    return !started || timed_out(first, arrival.at) ||
           (arrival.tail.start && forward_distance(arrival.tail.transfer_id, expected) > 1);
  }

  void restart(TransferId id) {
    expected = id;
    toggle = false;
    pending = false;
    last.size = 0;
  }

  void blame(TransferId id, Time at) {
    blamed = id;
    blamed_at = at;
  }

  /// Whether the frame continues a transfer already reported as lost.
  [[nodiscard]] bool is_blamed(const Arrival& arrival) const {
    return !arrival.tail.start && blamed == arrival.tail.transfer_id &&
           !timed_out(blamed_at, arrival.at);
  }

  /// CAN may deliver a frame twice (an error in the last bit of the end of frame), which is no
  /// fault, unless the frame is a transfer by itself. A frame that is like the last but one looks
  /// the same if the one between them is lost; the CRC knows.
  [[nodiscard]] bool is_echo(const Arrival& arrival) const {
    return !arrival.tail.single() && std::ranges::equal(last.payload(), arrival.frame.payload());
  }
};

/// The reason why the specification ignores this frame.
ReceiveError reason(const Session& session, const Tail& tail) {
  const bool repeated = next(tail.transfer_id) == session.expected;
  if (tail.transfer_id != session.expected) {
    return tail.start || repeated ? ReceiveError::transfer_id : ReceiveError::missing_start;
  }
  if (session.pending == tail.start) {
    return tail.start ? ReceiveError::transfer_id : ReceiveError::missing_start;
  }
  return ReceiveError::toggle;
}

} // namespace

class Receiver::Impl {
 public:
  Impl(std::size_t sessions, NodeId local, Callbacks callbacks);

  void receive(const can::Frame& frame, Time at);
  void expire(Time now);

 private:
  void receive_anonymous(const Arrival& arrival);
  [[nodiscard]] Session& session_of(const Arrival& arrival);
  [[nodiscard]] bool restart(Session& session, const Arrival& arrival);
  void reject(Session& session, const Arrival& arrival);
  void accept(Session& session, const Arrival& arrival);
  void append(Session& session, const Arrival& arrival);
  void finish(Session& session, const Arrival& arrival);
  [[nodiscard]] bool verify(Session& session, const Arrival& arrival, Transfer& transfer);

  void fault(Session& session, ReceiveError error, const Arrival& arrival);
  void report(ReceiveError error, std::uint32_t can_id, Time at) const;
  void deliver(const Transfer& transfer) const;

  NodeId local_;
  Callbacks callbacks_;
  SlotTable slots_;
  std::vector<Session> sessions_; ///< grows within reserved memory
  /// Left uninitialised on purpose: the kernel provides pages only for buffers that are written.
  std::unique_ptr<std::uint8_t[]> buffers_;
  can::Frame anonymous_{};
};

Receiver::Impl::Impl(std::size_t sessions, NodeId local, Callbacks callbacks)
    : local_(local), callbacks_(std::move(callbacks)), slots_(sessions),
      buffers_(std::make_unique_for_overwrite<std::uint8_t[]>(slots_.capacity() * buffer_size)) {
  sessions_.reserve(slots_.capacity());
}

// The pseudo code of the specification 4.1, "State update in a non-redundant interface
// configuration".
void Receiver::Impl::receive(const can::Frame& frame, Time at) {
  const auto arrival = take_apart(frame, at);
  if (!arrival) {
    return;
  }
  const auto& header = arrival->header;
  if (header.kind != Kind::message && local_.is_unicast() && header.destination != local_) {
    return;
  }
  if (header.source == anonymous) {
    receive_anonymous(*arrival);
    return;
  }
  auto& session = session_of(*arrival);
  if (session.needs_restart(*arrival) && !restart(session, *arrival)) {
    return;
  }
  const auto& tail = arrival->tail;
  if (tail.toggle != session.toggle || tail.transfer_id != session.expected) {
    reject(session, *arrival);
  } else {
    accept(session, *arrival);
  }
}

// Senders without a node ID cannot be told apart, so nothing is remembered of them.
void Receiver::Impl::receive_anonymous(const Arrival& arrival) {
  if (!arrival.tail.single()) {
    return;
  }
  if (arrival.tail.toggle) {
    report(ReceiveError::toggle, arrival.frame.id, arrival.at);
    return;
  }
  anonymous_ = arrival.frame;
  deliver({.header = arrival.header,
           .transfer_id = arrival.tail.transfer_id,
           .payload = payload_of(anonymous_),
           .at = arrival.at});
}

Session& Receiver::Impl::session_of(const Arrival& arrival) {
  const auto [slot, fresh] = slots_.touch(arrival.frame.id & descriptor_mask);
  if (slot == sessions_.size()) {
    sessions_.emplace_back();
  }
  if (fresh) {
    sessions_[slot] = Session();
    sessions_[slot].buffer = {buffers_.get() + slot * buffer_size, buffer_size};
  }
  return sessions_[slot];
}

// Returns whether the frame may begin a transfer. One in progress is lost.
bool Receiver::Impl::restart(Session& session, const Arrival& arrival) {
  if (session.pending && session.blamed != session.expected) {
    session.blame(session.expected, arrival.at);
    report(timed_out(session.first, arrival.at) ? ReceiveError::timeout : ReceiveError::transfer_id,
           arrival.frame.id, arrival.at);
  }
  session.restart(arrival.tail.transfer_id);
  if (!arrival.tail.start) {
    session.expected = next(session.expected);
    fault(session, ReceiveError::missing_start, arrival);
  }
  return arrival.tail.start;
}

void Receiver::Impl::reject(Session& session, const Arrival& arrival) {
  if (arrival.tail.transfer_id == session.expected) {
    session.trust = std::max(session.trust, Trust::doubtful);
  }
  if (!session.is_echo(arrival)) {
    fault(session, reason(session, arrival.tail), arrival);
  }
}

void Receiver::Impl::accept(Session& session, const Arrival& arrival) {
  const auto& tail = arrival.tail;
  if (tail.start) {
    session.started = true;
    session.first = arrival.at;
    if (session.blamed == tail.transfer_id) {
      session.blamed.reset();
    }
  }
  const bool begins = !session.pending;
  if (begins) {
    session.pending = true;
    session.trust = Trust::whole;
    session.priority = arrival.header.priority;
    session.size = 0;
  }
  // Where toggle and transfer ID happen to fit, the pseudo code takes a later frame for a first
  // one, or a second first frame for a later one: then the CRC decides.
  if (begins != tail.start) {
    fault(session, tail.start ? ReceiveError::transfer_id : ReceiveError::missing_start, arrival);
    session.trust = std::max(session.trust, Trust::doubtful);
  }
  session.single = begins && tail.single();
  session.toggle = !session.toggle;
  session.last = arrival.frame;
  append(session, arrival);
  if (tail.end) {
    finish(session, arrival);
  }
}

void Receiver::Impl::append(Session& session, const Arrival& arrival) {
  if (session.trust == Trust::broken || session.single) {
    return;
  }
  const auto bytes = payload_of(arrival.frame);
  const bool too_short = !arrival.tail.end && bytes.size() < frame_payload;
  if (too_short || bytes.size() > session.buffer.size() - session.size) {
    fault(session, ReceiveError::truncated, arrival);
    session.trust = Trust::broken;
    return;
  }
  std::ranges::copy(bytes, session.buffer.subspan(session.size).begin());
  session.size += bytes.size();
}

void Receiver::Impl::finish(Session& session, const Arrival& arrival) {
  session.expected = next(session.expected);
  session.toggle = false;
  session.pending = false;
  if (session.trust == Trust::broken) {
    return;
  }
  Transfer transfer{.header = arrival.header,
                    .transfer_id = arrival.tail.transfer_id,
                    .payload = payload_of(session.last),
                    .at = session.first};
  transfer.header.priority = session.priority;
  if (session.single || verify(session, arrival, transfer)) {
    deliver(transfer);
  }
}

// Takes the payload after its CRC; returns whether the transfer may be delivered.
bool Receiver::Impl::verify(Session& session, const Arrival& arrival, Transfer& transfer) {
  if (session.size < crc_size) {
    return false; // its start is missing, as reported before
  }
  const auto crc = static_cast<std::uint16_t>(session.buffer[0] | (session.buffer[1] << 8U));
  transfer.payload = session.buffer.first(session.size).subspan(crc_size);
  const auto& header = transfer.header;
  const auto signature =
      callbacks_.signature ? callbacks_.signature(header.kind, header.data_type_id) : std::nullopt;
  if (!signature) {
    transfer.crc_checked = false;
    if (session.trust != Trust::whole) {
      fault(session, ReceiveError::toggle, arrival);
    }
    return session.trust == Trust::whole;
  }
  if (crc16(transfer.payload, base_crc(*signature)) == crc) {
    return true;
  }
  fault(session, ReceiveError::crc, arrival);
  return false;
}

void Receiver::Impl::expire(Time now) {
  for (std::size_t slot = 0; slot < sessions_.size(); ++slot) {
    auto& session = sessions_[slot];
    if (session.pending && session.blamed != session.expected && timed_out(session.first, now)) {
      const auto over = session.first + transfer_timeout;
      session.trust = Trust::broken;
      session.blame(session.expected, over);
      report(ReceiveError::timeout,
             slots_.key(slot) | static_cast<std::uint32_t>(session.priority) << priority_in_key,
             over);
    }
  }
}

// Reports a fault of the frame's transfer, unless already reported.
void Receiver::Impl::fault(Session& session, ReceiveError error, const Arrival& arrival) {
  if (!session.is_blamed(arrival)) {
    session.blame(arrival.tail.transfer_id, arrival.at);
    report(error, arrival.frame.id, arrival.at);
  }
}

void Receiver::Impl::report(ReceiveError error, std::uint32_t can_id, Time at) const {
  if (callbacks_.error) {
    callbacks_.error(error, can_id, at);
  }
}

void Receiver::Impl::deliver(const Transfer& transfer) const {
  if (callbacks_.transfer) {
    callbacks_.transfer(transfer);
  }
}

Receiver::Receiver(std::size_t sessions, NodeId local, Callbacks callbacks)
    : impl_(std::make_unique<Impl>(sessions, local, std::move(callbacks))) {}

Receiver::~Receiver() = default;

void Receiver::receive(const can::Frame& frame, Time at) {
  impl_->receive(frame, at);
}

void Receiver::expire(Time now) {
  impl_->expire(now);
}

} // namespace blactl::dronecan
