#pragma once
// The node ID of this process, held by a lock file for as long as the process lives.

#include "blactl/base/error.hpp"
#include "blactl/dronecan/transfer_ids.hpp"
#include "blactl/state/lock_file.hpp"

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::state {

/// The IDs that are reserved for tools (specification 5), in the order in which they are tried.
inline constexpr std::array tool_ids{dronecan::NodeId(127), dronecan::NodeId(126)};

/// Whether a tool may use the ID without first listening whether it is free.
[[nodiscard]] constexpr bool is_tool_id(dronecan::NodeId id) {
  return id == tool_ids.front() || id == tool_ids.back();
}

/// A node ID that no other blactl of this machine uses on the same interface, and the transfer IDs
/// used with it. An ID is never shared: one process's read inside another's three-frame write would
/// break the write.
///
/// Its lock file keeps the transfer IDs, so that the next process continues where this one stopped.
class LocalNodeId {
 public:
  using Candidates = std::vector<dronecan::NodeId>;

  /// Takes the first candidate that no process holds, preferably one that no other node was heard
  /// to have; the default candidates are tool_ids. Errors: no_local_node_id, naming the processes
  /// that hold them.
  [[nodiscard]] static Result<LocalNodeId> acquire(LockPlace place, Candidates candidates);

  /// For a bus that no other process can reach: no lock, counters from 0.
  [[nodiscard]] static LocalNodeId unshared(Candidates candidates);

  /// Takes the next candidate because another node has this ID, and records that for later
  /// processes. Errors: duplicate_node_id if there is none, no_local_node_id; the ID is then
  /// unchanged.
  [[nodiscard]] Result<void> give_way(std::string_view interface);

  LocalNodeId(const LocalNodeId&) = delete;
  LocalNodeId& operator=(const LocalNodeId&) = delete;
  LocalNodeId(LocalNodeId&&) noexcept;
  LocalNodeId& operator=(LocalNodeId&&) noexcept;
  ~LocalNodeId();

  [[nodiscard]] dronecan::NodeId id() const;
  [[nodiscard]] dronecan::TransferIds& transfer_ids();

  /// Why other candidates were not available, for people; empty: none was tried.
  [[nodiscard]] std::string passed_over() const;

  /// The path of its lock file; empty: there is none.
  [[nodiscard]] std::string lock_file() const;

 private:
  struct State;
  LocalNodeId(LockPlace place, Candidates candidates);
  [[nodiscard]] Result<void> take_one();

  LockPlace place_;
  Candidates candidates_;
  /// The obstacles to each ID, for people.
  std::vector<std::pair<dronecan::NodeId, std::string>> obstacles_;
  std::unique_ptr<State> state_;
};

} // namespace blactl::state
