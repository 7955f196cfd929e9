#pragma once
// The node ID of this process, held by a lock file for as long as the process lives.

#include "blactl/base/error.hpp"
#include "blactl/dronecan/transfer_ids.hpp"
#include "blactl/state/lock_file.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::state {

/// A node ID that no other blactl of this machine uses on the same interface, and the transfer IDs
/// that went out under it. An ID is never shared: one process's read inside another's three-frame
/// write would break the write.
///
/// The lock file `<interface>.<id>` keeps the transfer IDs, so that the next process goes on where
/// this one stopped.
class LocalNodeId {
 public:
  /// Takes `wanted`, or the first free of 127 and 126 (reserved for tools, specification 5).
  /// Errors: no_local_node_id, naming the processes that hold them.
  [[nodiscard]] static Result<LocalNodeId>
  acquire(std::string_view interface, std::optional<dronecan::NodeId> wanted,
          const std::string& shared = LockFile::shared_folder);

  /// For a bus that no other process can reach: no lock, counters from 0.
  [[nodiscard]] static LocalNodeId unshared(std::optional<dronecan::NodeId> wanted);

  LocalNodeId(const LocalNodeId&) = delete;
  LocalNodeId& operator=(const LocalNodeId&) = delete;
  LocalNodeId(LocalNodeId&&) noexcept;
  LocalNodeId& operator=(LocalNodeId&&) noexcept;
  ~LocalNodeId();

  [[nodiscard]] dronecan::NodeId id() const;
  [[nodiscard]] dronecan::TransferIds& transfer_ids();

 private:
  struct State;
  explicit LocalNodeId(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

} // namespace blactl::state
