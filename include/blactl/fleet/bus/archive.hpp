#pragma once
// What a recording holds of the answers of servos: stands in for them when jobs ask.

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

/// A servo as a file describes it.
struct RecordedServo {
  Servo servo;
  bla::Values values; ///< what its registers hold, as far as the file tells
};

/// Keeps the last answer to each question that reads: GetNodeInfo, and GetSet of each register,
/// whoever asked. An answer to a write tells the value after it, so it counts as well.
///
/// What a node was told after that makes its answers history, whatever it answers: a write that of
/// its register, until the value after it is told; ERASE all that it sets; RestartNode and SAVE, or
/// a restart that uptimes show (see Roster), all: its RAM is gone, its ID may be that of another.
/// Memory is bounded: one answer for each node and register, one question for each two nodes and
/// transfer ID.
class Archive {
 public:
  /// `roster` outlives this and has been told of each transfer first.
  explicit Archive(const Roster& roster) : roster_(roster) {}

  void receive(const dronecan::Transfer& transfer);

  /// What a file says that a register holds counts as an answer.
  void recall(dronecan::NodeId node, bla::Address address, std::int64_t raw);

  /// `answered` with the last answer, or `not_recorded`. The payload is valid until the next
  /// transfer.
  [[nodiscard]] dronecan::Outcome answer(const dronecan::Request& request) const;

 private:
  /// The transfers of the recording, counted: many may have one time.
  using Moment = std::uint64_t;

  struct Answer {
    std::vector<std::uint8_t> payload;
    Time at{};
    std::uint32_t boots = 0; ///< of the node when it said so
    Moment asked = 0;        ///< where the question was not recorded: answered
  };

  /// Which register was asked for: a failure comes without its name (errata C7).
  struct Question {
    bla::Address address;
    Moment at = 0;
  };

  struct Server {
    Answer info;
    std::map<bla::Address, Answer> registers;
    std::map<std::pair<dronecan::NodeId, dronecan::TransferId>, Question> questions; ///< by client
    // What it was told last, whatever it answered.
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
