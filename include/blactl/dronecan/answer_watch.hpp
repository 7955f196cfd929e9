#pragma once
// Detects two units that share a node ID by their two answers to one request.

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

/// The receiver of the specification takes a second response with the same transfer ID for a
/// repetition of the first, and drops it (4.1). This one reassembles every response to GetNodeInfo
/// and GetSet, and reports two with one transfer ID that cannot come from one unit: their unique
/// IDs differ, or their values of a parameter that changes only by request. Responses whose frames
/// interleave are not read; no receiver accepts those. That they begin otherwise is enough, because
/// no unit begins an answer again before it has ended.
class AnswerWatch {
 public:
  /// The unique IDs of the two units, or none if something else gave them away.
  using Report = std::function<void(NodeId, const std::set<UniqueId>&)>;

  /// `settled`: names of parameters that never change by themselves, unlike measured values.
  AnswerWatch(std::set<std::string> settled, Report report)
      : settled_(std::move(settled)), report_(std::move(report)) {}

  /// Forgets earlier answers, because another unit may have this node ID now.
  void forget(NodeId server);

  /// Feeds a frame of any kind, with the header decoded from its ID; it has data.
  void receive(const Header& header, const can::Frame& frame, Time at);

 private:
  /// A trait of the responding unit.
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
    NodeId client{};
    Time start{};
    std::vector<std::uint8_t> bytes{}; ///< empty: no answer is under way
    /// The answers by transfer ID: a second one may come after answers to later requests.
    std::array<Answer, transfer_id_modulus> answers{};
  };

  /// Whether this first frame of an answer is not of the unit that has begun one to the same
  /// question.
  [[nodiscard]] static bool is_another(const Assembly& begun, const Header& header,
                                       const can::Frame& frame, Time at);
  void complete(Assembly& assembly, const DataType& type, const Header& header, Time at);
  /// Transfer IDs soon wrap: the client's next ones are not those answered before.
  static void forget_last_lap(Assembly& assembly, NodeId client);
  [[nodiscard]] std::optional<Trait> trait(const DataType& type, Bytes payload) const;

  std::set<std::string> settled_;
  Report report_;
  std::map<std::pair<NodeId, std::uint16_t>, Assembly> assemblies_; ///< by server and data type ID
};

} // namespace blactl::dronecan
