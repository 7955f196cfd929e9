#pragma once
// The node IDs that servos had before they restarted, for those that have to ask for one.

#include "blactl/dronecan/allocator.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/state/allocation_store.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace blactl::fleet {

/// Each of these units gets its ID again, or the one that it has in the allocation table; nobody
/// else gets any.
class FormerIds final : public dronecan::AllocationTable {
 public:
  /// Opens the allocation table, when a unit asks for an ID.
  using Open = std::function<Result<state::AllocationStore>()>;

  /// Told once why an ID that was given is not kept in the table.
  using NotKept = std::function<void(const Error&)>;

  /// `session` outlives this. Without `open`, and where it fails, each gets the ID that it had.
  FormerIds(Session& session, std::map<dronecan::UniqueId, dronecan::NodeId> ids, Open open,
            NotKept not_kept = {})
      : session_(session), open_(std::move(open)), not_kept_(std::move(not_kept)),
        ids_(std::move(ids)) {}

  [[nodiscard]] bool serves(dronecan::Bytes prefix) const override;
  [[nodiscard]] std::optional<dronecan::NodeId> assign(const dronecan::UniqueId& unique_id,
                                                       dronecan::NodeId preferred) override;

  /// What to do for a unit that asks on although it was given an ID, or because somebody uses the
  /// one that it would get. Empty: it is neither.
  [[nodiscard]] std::optional<std::string> hint(const dronecan::UniqueId& unique_id) const;

 private:
  /// What became of the requests of a unit.
  struct Asked {
    dronecan::NodeId id{}; ///< that it was given, or would have been
    unsigned given = 0;    ///< how often
  };

  [[nodiscard]] std::optional<dronecan::NodeId> from_table(const dronecan::UniqueId& unique_id,
                                                           dronecan::NodeId former);

  void tell(const Error& error);

  Session& session_;
  Open open_;        ///< empty: it was tried
  NotKept not_kept_; ///< empty: it was told
  std::optional<Result<state::AllocationStore>> table_;
  std::map<dronecan::UniqueId, dronecan::NodeId> ids_; ///< that they had
  std::map<dronecan::UniqueId, Asked> asked_;
};

} // namespace blactl::fleet
