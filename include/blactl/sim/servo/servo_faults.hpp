#pragma once
// The faults of a simulated servo that a scenario sets.

#include "blactl/base/time.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace blactl::sim {

/// The kind of a client's request. A `read` and a `write` are GetSet; an `opcode` is SAVE or ERASE.
enum class RequestKind : std::uint8_t { any, node_info, read, write, opcode, restart };

/// A restart by itself as soon as the response to a request has left, so that it falls between two
/// requests: `number` counts requests since power-on, the first is 1. A ROM write or restart
/// ordered by that request does not take place.
struct RestartAfterAnswer {
  RequestKind to = RequestKind::any;
  std::uint32_t number = 1; ///< of the requests of that kind

  friend bool operator==(const RestartAfterAnswer&, const RestartAfterAnswer&) = default;
};

/// Orders are SAVE, ERASE, RestartNode with the right magic number, and 1 written to 0x10, 0x11 or
/// 0x12.
struct ServoFaults {
  std::uint32_t lose_responses = 0;      ///< this many first responses are lost
  bool mute = false;                     ///< no response is ever sent; messages go on
  bool no_node_status = false;           ///< it never sends NodeStatus
  bool no_actuator_status = false;       ///< it never sends actuator.Status
  std::uint32_t lose_opcode_answers = 0; ///< this many first orders are obeyed without a response
  std::uint32_t ignore_opcodes = 0; ///< this many first orders are neither carried out nor answered
  bool refuse_opcodes = false;      ///< all get a response with ok=false, or a failure of GetSet
  bool deny_opcodes = false;        ///< the same response, and all are carried out
  bool rom_write_fails = false; ///< ok, silence, restart and count as usual, but ROM is unchanged
  bool stays = false;           ///< responds ok and writes ROM, but does not restart
  bool never_returns = false;   ///< is dead after its first restart
  std::uint16_t rom_unread_starts =
      0; ///< the first so many starts cannot read ROM, unless it is written
  std::uint32_t restart_instead_of_answer = 0; ///< number of the service request, the first is 1
  std::vector<RestartAfterAnswer> restart_after_answer;
  std::optional<Duration> power_loss_in_save{}; ///< once, this long into the ROM write
  Duration return_delay{}; ///< the additional time of a restart over power-on; up to 600 s
};

} // namespace blactl::sim
