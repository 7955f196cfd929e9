#pragma once
// Hears whether one question is answered by two units that share a node ID.

#include "blactl/can/frame.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace blactl::dronecan {

/// The receiver of the specification takes a second answer with the same transfer ID for a
/// repetition of the first, and drops it (4.1). This one puts every answer to GetNodeInfo together,
/// and reports two of them with one transfer ID and different unique IDs. Answers whose frames mix
/// are not read: then nobody takes them for an answer.
class AnswerWatch {
 public:
  using Report = std::function<void(NodeId, const UniqueId&, const UniqueId&)>;

  explicit AnswerWatch(Report report) : report_(std::move(report)) {}

  /// A frame of whatever kind with the header that its ID says; it has data.
  void receive(const Header& header, const can::Frame& frame, Time at);

 private:
  struct Answer {
    std::optional<UniqueId> unit{};
    NodeId client{};
    Time at{};
  };

  struct Assembly {
    TransferId transfer_id = 0;
    bool toggle = false; ///< of the next frame
    std::vector<std::uint8_t> bytes{};
    /// Who answered which question: the second one may come after answers to later questions.
    std::array<Answer, transfer_id_modulus> answers{};
  };

  void complete(Assembly& assembly, const Header& header, Time at);

  Report report_;
  std::map<NodeId, Assembly> assemblies_; ///< by server, so it is bounded
};

} // namespace blactl::dronecan
