#pragma once
// What goes wrong with a simulated servo, because a scenario says so.

#include "blactl/base/time.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace blactl::sim {

/// What a client asks a servo for. A `read` and a `write` are of GetSet; an `opcode` is SAVE or
/// ERASE.
enum class RequestKind : std::uint8_t { any, node_info, read, write, opcode, restart };

/// A restart by itself as soon as the answer to a request has left. Such restarts come between any
/// two requests: `number` counts requests since power-on, the first is 1. What the request orders
/// of ROM and restart does not happen any more.
struct RestartAfterAnswer {
  RequestKind to = RequestKind::any;
  std::uint32_t number = 1; ///< of the requests of that kind

  friend bool operator==(const RestartAfterAnswer&, const RestartAfterAnswer&) = default;
};

/// Orders are SAVE, ERASE, RestartNode with the right magic number, and 1 written to 0x10, 0x11 or
/// 0x12.
struct ServoFaults {
  std::uint32_t lose_responses = 0;      ///< the first so many answers never reach the bus
  bool mute = false;                     ///< none ever does; its messages go on
  bool no_node_status = false;           ///< it never sends NodeStatus
  bool no_actuator_status = false;       ///< it never sends actuator.Status
  std::uint32_t lose_opcode_answers = 0; ///< the first so many orders are obeyed without an answer
  std::uint32_t ignore_opcodes = 0;      ///< the first so many are neither obeyed nor answered
  bool refuse_opcodes = false;           ///< all are answered with ok=false, or a failure of GetSet
  bool rom_write_fails = false; ///< ok, silence, restart as ever, and counted, but ROM is as it was
  bool stays = false;           ///< answers ok and writes ROM, but does not restart
  bool never_returns = false;   ///< is dead after its first restart
  std::uint32_t restart_instead_of_answer = 0; ///< to this request of a service, the first is 1
  std::vector<RestartAfterAnswer> restart_after_answer;
  std::optional<Duration> power_loss_in_save{}; ///< once, so long after the ROM write has begun
  Duration return_delay{}; ///< how much longer a restart takes than power-on; up to 600 s
};

} // namespace blactl::sim
