#pragma once
// Transfers: CAN ID layout, tail byte, transfer CRC, segmentation and reassembly.
// DroneCAN specification 4.1 (CAN bus transport layer).

#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"
#include "blactl/dronecan/ids.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace blactl::dronecan {

/// The fields of a 29-bit CAN ID.
struct Header {
  Kind kind = Kind::message;
  Priority priority = priority_medium;
  std::uint16_t data_type_id = 0;  ///< anonymous messages: 0..3
  NodeId source{};                 ///< 0: anonymous
  NodeId destination{};            ///< 0 for messages
  std::uint16_t discriminator = 0; ///< 14 bits, anonymous messages only

  friend bool operator==(const Header&, const Header&) = default;
};

/// The 29-bit CAN ID. Values too wide for their field are truncated.
[[nodiscard]] std::uint32_t encode_id(const Header& header);

/// Empty for an ID that the standard forbids (a service from or to node 0, source = destination)
/// and for more than 29 bits.
[[nodiscard]] std::optional<Header> decode_id(std::uint32_t can_id);

/// Transfer IDs count modulo 32.
using TransferId = std::uint8_t;
inline constexpr TransferId transfer_id_modulus = 32;

/// Bytes of the CRC in front of the payload of a multi-frame transfer.
inline constexpr std::size_t crc_size = 2;

/// The CRC over a data type signature, least significant byte first: a transfer's initial CRC.
[[nodiscard]] std::uint16_t base_crc(std::uint64_t signature);

/// The discriminator that libuavcan sends: the low 14 bits of the CRC over the payload and the
/// tail byte of its only frame; receivers ignore it.
[[nodiscard]] std::uint16_t discriminator(std::span<const std::uint8_t> payload, TransferId id);

/// Splits a payload into the frames of one transfer. Payloads of 7 bytes or less make one frame.
/// An anonymous header must have a payload of 7 bytes or less; a longer one gives no frames.
[[nodiscard]] std::vector<can::Frame> segment(const Header& header, TransferId id,
                                              std::uint64_t signature,
                                              std::span<const std::uint8_t> payload);

/// A complete transfer; `payload` points into the receiver and is valid until its next frame.
struct Transfer {
  Header header{};
  TransferId transfer_id = 0;
  std::span<const std::uint8_t> payload{};
  Time at{};               ///< when its first frame was seen
  bool crc_checked = true; ///< false: multi-frame transfer of a type with unknown signature
};

/// Why a transfer could not be delivered (the words of `trace`).
enum class ReceiveError : std::uint8_t {
  crc,
  toggle,        ///< a wrong toggle bit: a frame before this one was lost, or the sender is wrong
  missing_start, ///< frames of a transfer whose first frame was not heard
  transfer_id,   ///< a repeated transfer ID, or a new transfer before the end of the last one
  truncated,     ///< a frame that is not full before the last, or a payload beyond capacity
  timeout,       ///< the rest did not come within 2 s
};

/// Reassembles interleaved transfers of any number of senders, exactly by the pseudo code of the
/// specification 4.1 (one interface). Memory is allocated once and bounded: the session idle
/// longest makes room for a new one.
class Receiver {
 public:
  /// The longest payload that is reassembled. The longest of the types used here has 376 bytes.
  static constexpr std::size_t capacity = 1024;
  /// Transfer ID timeout of the specification.
  static constexpr Duration transfer_timeout = std::chrono::seconds(2);

  /// Each may be empty. They must not throw.
  struct Callbacks {
    /// A complete transfer.
    std::function<void(const Transfer&)> transfer{};
    /// A lost transfer, reported once: later frames of it are silently ignored, as is a frame that
    /// CAN delivered twice. `can_id` is that of the frame that revealed the fault.
    std::function<void(ReceiveError, std::uint32_t can_id, Time)> error{};
    /// The signature of a data type; empty: unknown, delivered unchecked.
    std::function<std::optional<std::uint64_t>(Kind, std::uint16_t data_type_id)> signature{};
  };

  /// `sessions`: how many (kind, type, source, destination) are remembered at a time, at least 1;
  /// each reserves 1.1 KiB of address space, which becomes real memory only for multi-frame
  /// transfers. Anonymous transfers need none. `local`: services for other nodes are dropped,
  /// unless it is 0 (a listener hears all).
  Receiver(std::size_t sessions, NodeId local, Callbacks callbacks);
  ~Receiver();
  Receiver(const Receiver&) = delete;
  Receiver(Receiver&&) = delete;
  Receiver& operator=(const Receiver&) = delete;
  Receiver& operator=(Receiver&&) = delete;

  /// Feeds one frame. Frames that are not DroneCAN (standard IDs, remote frames, no data, forbidden
  /// IDs, anonymous frames that are not single) are ignored. Never allocates.
  void receive(const can::Frame& frame, Time at);

  /// Reports the unfinished transfers that began more than 2 s before `now` as `timeout`, each with
  /// the CAN ID of its first frame and the time when its 2 s were over; `never` takes all, as at
  /// the end of a log. Without it such a transfer is reported only when its sender is heard again.
  void expire(Time now);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace blactl::dronecan
