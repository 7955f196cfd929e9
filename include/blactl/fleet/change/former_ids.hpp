#pragma once
// The previous node IDs of restarting servos, for those that have to ask for one.

#include "blactl/dronecan/allocator.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/state/allocation_store.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace blactl::fleet {

/// Each of these units gets its previous ID, or the one in the allocation table; no other unit gets
/// one.
class FormerIds final : public dronecan::AllocationTable {
 public:
  /// Opens the allocation table, when a unit asks for an ID.
  using Open = std::function<Result<state::AllocationStore>()>;

  /// Called once with the reason why an assigned ID is not stored in the table.
  using NotKept = std::function<void(const Error&)>;

  /// `session` outlives this. Without `open`, or if it fails, each gets its previous ID.
  FormerIds(Session& session, std::map<dronecan::UniqueId, dronecan::NodeId> ids, Open open,
            NotKept not_kept = {})
      : session_(session), open_(std::move(open)), not_kept_(std::move(not_kept)),
        ids_(std::move(ids)) {}

  [[nodiscard]] bool serves(dronecan::Bytes prefix) const override;
  [[nodiscard]] std::optional<dronecan::NodeId> assign(const dronecan::UniqueId& unique_id,
                                                       dronecan::NodeId preferred) override;

  /// The hint for a unit that still asks although an ID was assigned, or because its ID is in use.
  /// Empty: neither.
  [[nodiscard]] std::optional<std::string> hint(const dronecan::UniqueId& unique_id) const;

 private:
  struct Asked {
    dronecan::NodeId id{}; ///< assigned, or intended
    unsigned given = 0;    ///< number of times
  };

  [[nodiscard]] std::optional<dronecan::NodeId> from_table(const dronecan::UniqueId& unique_id,
                                                           dronecan::NodeId former);

  void tell(const Error& error);

  Session& session_;
  Open open_;        ///< empty: already called
  NotKept not_kept_; ///< empty: already called
  std::optional<Result<state::AllocationStore>> table_;
  std::map<dronecan::UniqueId, dronecan::NodeId> ids_; ///< previous ones
  std::map<dronecan::UniqueId, Asked> asked_;
};

} // namespace blactl::fleet
