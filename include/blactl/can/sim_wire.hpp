#pragma once
// The protocol on the socket between the simulator and its clients.
//
// A Unix socket of type SOCK_SEQPACKET; every packet is one Message in the machine's byte order;
// any other packet ends the connection. A client begins with `hello`, the simulator answers with
// `welcome`. From then on:
//
//   client     filter_none, filter_add*   the frames it wants; none: all
//              send                       a frame for the bus
//              wait                       nothing to do before `at`, having read `count` messages
//   simulator  received, sent, fault      as can::BusEvent
//              overflow                   `count` messages were lost since the connection
//              tick                       the deadline of `wait` has come
//
// On the virtual clock time moves only while every client waits: it has sent `wait` after reading
// all that was sent to it. A client that sends nothing stops time; one that disconnects does not.

#include "blactl/can/frame.hpp"

#include <array>
#include <cstdint>
#include <type_traits>

namespace blactl::can::sim_wire {

inline constexpr std::uint32_t version = 1;

enum class Kind : std::uint32_t {
  hello = 0x4D53'4C42, ///< "BLSM"; value: version
  welcome, ///< value: version; flags: virtual_clock; at: now; count: wall time of at = 0
  filter_none,
  filter_add, ///< id, value: mask
  send,       ///< frame
  wait,       ///< at: deadline; count: messages read, `welcome` included
  received,   ///< frame; at: its end
  sent,       ///< frame; at: its end
  fault,      ///< value: can::FaultKind; at
  overflow,   ///< count
  tick,       ///< at: now
};

// Bits of Message::flags.
inline constexpr std::uint8_t extended = 1, remote = 2, virtual_clock = 4;

/// One packet. Fields that a kind does not use are 0.
struct Message {
  Kind kind{};
  std::uint32_t value = 0;
  std::int64_t at = 0; ///< microseconds of the bus clock; the largest number: never
  std::uint64_t count = 0;
  std::uint32_t id = 0;
  std::uint8_t flags = 0;
  std::uint8_t size = 0;
  std::array<std::uint8_t, 8> data{};
  std::array<std::uint8_t, 2> reserved{};
};

static_assert(sizeof(Message) == 40 && std::is_trivially_copyable_v<Message>);

/// A message that carries a frame.
[[nodiscard]] inline Message with_frame(Kind kind, const Frame& frame) {
  Message message{.kind = kind, .id = frame.id, .size = frame.size, .data = frame.data};
  message.flags =
      static_cast<std::uint8_t>((frame.extended ? extended : 0) | (frame.remote ? remote : 0));
  return message;
}

/// The frame of a message; bits that no frame can have are cleared.
[[nodiscard]] inline Frame frame_of(const Message& message) {
  Frame frame;
  frame.extended = (message.flags & extended) != 0;
  frame.remote = (message.flags & remote) != 0;
  frame.id = message.id & (frame.extended ? extended_id_mask : 0x7FFU);
  frame.size = message.size <= 8 ? message.size : std::uint8_t{8};
  for (std::uint8_t i = 0; i < frame.size && !frame.remote; ++i) {
    frame.data[i] = message.data[i];
  }
  return frame;
}

} // namespace blactl::can::sim_wire
