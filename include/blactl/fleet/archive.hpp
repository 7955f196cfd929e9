#pragma once
// What a recording holds of the answers of servos: stands in for them when jobs ask.

#include "blactl/bla/parameter.hpp"
#include "blactl/dronecan/node.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/fleet/roster.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace blactl::fleet {

/// Keeps the last answer to each question that reads: GetNodeInfo, and GetSet of each register,
/// whoever asked. An answer to a write tells the value after it, so it counts as well.
///
/// A restart, as far as uptimes show it (see Roster), makes all of a node's earlier answers
/// history: its RAM is gone, and another unit may have its ID. Memory is bounded: one answer for
/// each node and register.
class Archive {
 public:
  /// `roster` outlives this and has been told of each transfer first.
  explicit Archive(const Roster& roster) : roster_(roster) {}

  void receive(const dronecan::Transfer& transfer);

  /// `answered` with the last answer, or `not_recorded`. The payload is valid until the next
  /// transfer.
  [[nodiscard]] dronecan::Outcome answer(const dronecan::Request& request) const;

 private:
  struct Answer {
    std::vector<std::uint8_t> payload;
    Time at{};
    std::uint32_t boots = 0; ///< of the node when it said so
  };

  /// Which register was asked for: a failure comes without its name (errata C7).
  struct Question {
    dronecan::NodeId client;
    bla::Address address;
  };

  struct Server {
    Answer info;
    std::map<bla::Address, Answer> registers;
    /// By transfer ID; two clients that use the same one at a time hide one another.
    std::array<Question, dronecan::transfer_id_modulus> questions{};
  };

  void receive_question(const dronecan::Transfer& transfer);
  void receive_register(const dronecan::Transfer& transfer);
  void keep(Answer& slot, const dronecan::Transfer& transfer);
  [[nodiscard]] std::uint32_t boots(dronecan::NodeId node) const;
  [[nodiscard]] const Answer* find(const dronecan::Request& request) const;

  const Roster& roster_;
  std::map<dronecan::NodeId, Server> servers_;
};

} // namespace blactl::fleet
