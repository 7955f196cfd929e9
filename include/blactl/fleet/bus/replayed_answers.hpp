#pragma once
// The responses of servos in a recording: they answer the requests of jobs.

#include "blactl/bla/parameter.hpp"
#include "blactl/bla/values.hpp"
#include "blactl/dronecan/node.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/servo.hpp"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace blactl::fleet {

/// A servo as described by a file.
struct RecordedServo {
  Servo servo;
  bla::Values values; ///< register values, as far as the file has them
};

/// Keeps the last response to each read request: GetNodeInfo, and GetSet of each register, whoever
/// asked. The response to a write contains the resulting value, so it counts as well.
///
/// Later requests to a node make its earlier responses obsolete, whatever it responds: a write
/// those of its register, until a response with the new value; ERASE those of all registers that it
/// sets; RestartNode and SAVE, or a restart shown by uptimes (see Roster), all of them: its RAM is
/// lost, and its ID may be that of another unit. Memory is bounded: one response for each node and
/// register, one request for each two nodes and transfer ID.
class ReplayedAnswers {
 public:
  /// `roster` outlives this and must receive each transfer first.
  explicit ReplayedAnswers(const Roster& roster) : roster_(roster) {}

  void receive(const dronecan::Transfer& transfer);

  /// Takes a register value of a file as a response.
  void recall(dronecan::NodeId node, bla::Address address, std::int64_t raw);

  /// The last response as `answered`, or `not_recorded`. The payload is valid until the next
  /// transfer.
  [[nodiscard]] dronecan::Outcome answer(const dronecan::Request& request) const;

 private:
  /// The number of transfers of the recording so far, as many may have the same time.
  using Moment = std::uint64_t;

  struct Answer {
    std::vector<std::uint8_t> payload;
    Time at{};
    std::uint32_t boots = 0; ///< of the node at that time
    Moment asked = 0;        ///< if the request was not recorded: of the response
  };

  /// The requested register: a failure comes without its name (errata C7).
  struct Question {
    bla::Address address;
    Moment at = 0;
  };

  struct Server {
    Answer info;
    std::map<bla::Address, Answer> registers;
    std::map<std::pair<dronecan::NodeId, dronecan::TransferId>, Question> questions; ///< by client
    // The last writes, whatever the responses.
    std::map<bla::Address, Moment> written;
    Moment erased = 0, restarted = 0;
  };

  void receive_request(const dronecan::Transfer& transfer);
  void receive_question(const dronecan::Transfer& transfer);
  void receive_register(const dronecan::Transfer& transfer);
  void keep(Answer& slot, const dronecan::Transfer& transfer, Moment asked);
  /// Since when its answers tell what a register holds.
  [[nodiscard]] Moment unchanged_since(const Server& server, bla::Address address) const;
  [[nodiscard]] std::uint32_t boots(dronecan::NodeId node) const;
  [[nodiscard]] const Answer* find(const dronecan::Request& request) const;

  const Roster& roster_;
  Moment now_ = 0;
  std::map<dronecan::NodeId, Server> servers_;
};

} // namespace blactl::fleet
