#pragma once
// Hears whether one question is answered by two units that share a node ID.

#include "blactl/can/frame.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace blactl::dronecan {

/// The receiver of the specification takes a second answer with the same transfer ID for a
/// repetition of the first, and drops it (4.1). This one puts every answer to GetNodeInfo and
/// GetSet together, and reports two of them with one transfer ID that cannot be of one unit: their
/// unique IDs differ, or their values of a parameter that changes only by a question. Answers whose
/// frames mix are not read: then nobody takes them for an answer.
class AnswerWatch {
 public:
  /// The unique IDs of the two units, or none where parameters told them apart.
  using Report = std::function<void(NodeId, const std::set<UniqueId>&)>;

  /// `settled`: names of parameters that never change by themselves, as measured values do.
  AnswerWatch(std::set<std::string> settled, Report report)
      : settled_(std::move(settled)), report_(std::move(report)) {}

  /// Another unit may be on this node ID now: what was answered before tells nothing of it.
  void forget(NodeId server);

  /// A frame of whatever kind with the header that its ID says; it has data.
  void receive(const Header& header, const can::Frame& frame, Time at);

 private:
  /// What an answer says of the unit that gave it.
  struct Trait {
    std::string name{}; ///< of the parameter; empty: its unique ID
    std::variant<UniqueId, GetSet::Value> value{};
  };

  struct Answer {
    std::optional<Trait> trait{};
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

  void complete(Assembly& assembly, const DataType& type, const Header& header, Time at);
  /// Transfer IDs soon come again: the next ones of this client are not those that were answered.
  static void forget_last_lap(Assembly& assembly, NodeId client);
  [[nodiscard]] std::optional<Trait> trait(const DataType& type, Bytes payload) const;

  std::set<std::string> settled_;
  Report report_;
  std::map<std::pair<NodeId, std::uint16_t>, Assembly> assemblies_; ///< by server and data type ID
};

} // namespace blactl::dronecan
