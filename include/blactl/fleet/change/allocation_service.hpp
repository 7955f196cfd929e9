#pragma once
// Allocates node IDs on a session: the allocator with the table that outlives the process. DroneCAN
// specification 6, uavcan/protocol/dynamic_node_id/1.Allocation.uavcan; Futaba 2.3.

#include "blactl/base/error.hpp"
#include "blactl/dronecan/allocator.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/state/allocation_store.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

/// A unit that asked for a node ID, and the result.
struct AllocatedUnit {
  dronecan::UniqueId unique_id{};
  dronecan::NodeId node_id{};                 ///< from the table; 0: none
  bool is_new = false;                        ///< this ID of it was not in the table before
  std::optional<dronecan::UniqueId> former{}; ///< had it in the table: see state::Allocation
  Time asked_at{};                            ///< the last time
  std::optional<Error> refused{};             ///< why it got none: duplicate_node_id, table_full
  bool is_shared = false; ///< refused, too: its ID was assigned, and is used by another unit
  unsigned given = 0;     ///< how often in a row, without the unit being heard under it
  bool is_deaf = false;   ///< it was assigned its ID several times, and still asks
};

/// The node ID of a unit by the table; a new unit, or one whose ID another node has by now, is
/// entered there with one that nobody on the bus has.
/// Errors: as AllocationStore::allocate().
[[nodiscard]] Result<state::Allocation> allocate(const Session& session,
                                                 state::AllocationStore& table,
                                                 const dronecan::UniqueId& unique_id,
                                                 state::AllocationChoice choice);

/// During its lifetime, units that ask for a node ID get one: that of the table, else a free one.
/// Every ID is in the table before it goes over the wire.
///
/// Other nodes need time to be heard: until bus_is_known() only units of the table are served, and
/// these not before bus_watch_time, for another unit may have their ID now. It ends by itself when
/// another allocator is heard, or the table cannot be used.
class AllocationService final : private dronecan::Service, private dronecan::AllocationTable {
 public:
  enum class Event : std::uint8_t {
    request,  ///< a unit has sent its complete unique ID
    assigned, ///< it is new in the table, and the response goes out
    kept,     ///< it was in the table, and the response goes out
    conflict, ///< another unit uses its ID, or has its unique ID
    full,     ///< nodes on the bus have all IDs of the range
    deaf      ///< it does not accept its ID; further responses are not reported
  };

  using Hook = std::function<void(Event, const AllocatedUnit&)>;

  struct Range {
    dronecan::NodeId first = state::first_dynamic_id;
    dronecan::NodeId last = state::last_dynamic_id;
  };

  /// `session` and `store` outlive this. `range`: for new IDs. `hook` is called for every event;
  /// for a lasting one, such as a refusal, once.
  AllocationService(Session& session, state::AllocationStore& store, Range range, Hook hook);
  ~AllocationService() override;
  AllocationService(const AllocationService&) = delete;
  AllocationService(AllocationService&&) = delete;
  AllocationService& operator=(const AllocationService&) = delete;
  AllocationService& operator=(AllocationService&&) = delete;

  /// The bus was heard for bus_watch_time and silent nodes were looked for: new units are served.
  void bus_is_known() { bus_is_known_ = true; }

  /// No new unit gets one of these.
  void avoid(const state::NodeIds& ids) { avoided_ = ids; }

  /// Only these units get an ID.
  void serve_only(std::vector<dronecan::UniqueId> units) { only_ = std::move(units); }

  /// The reason why it has stopped. Errors: other_allocator, naming the node; those of the table
  /// (bad_file, permission, io).
  [[nodiscard]] std::optional<Error> end() const;

  /// The units that asked, by unique ID. Bounded: a flood of unknown units is not stored.
  [[nodiscard]] const std::map<dronecan::UniqueId, AllocatedUnit>& units() const { return units_; }

  /// Whether it was heard under its assigned ID, and identified itself as this unit.
  [[nodiscard]] bool is_there(const AllocatedUnit& unit) const;

  /// The reason why it has no ID of its own: as `refused`, by present knowledge. Empty: none.
  [[nodiscard]] std::optional<Error> refusal(const AllocatedUnit& unit) const;

  /// The reason why a unit that is not refused is not there. It has an ID in the table.
  [[nodiscard]] Error absence(const AllocatedUnit& unit) const;

  /// The last request of a unit that may still succeed, so not of refused or deaf ones; one that is
  /// neither repeated nor complete is nobody's. Without one, the start of this service.
  [[nodiscard]] Time last_request() const { return last_request_; }

  /// Whether a unit may just have begun to ask: it was heard once, less than its period ago.
  [[nodiscard]] bool may_begin_to_ask() const;

  /// The number of units asking: recently, and not heard under an ID since. Units whose unique IDs
  /// begin alike count as one.
  [[nodiscard]] std::size_t asking() const;

  /// The number of IDs in the range that no node on the bus has.
  [[nodiscard]] std::size_t free_ids() const;

 private:
  enum class Holder : std::uint8_t { nobody, unknown, other };

  void receive(const dronecan::Transfer& transfer) override;

  [[nodiscard]] Time next_deadline() const override { return allocator_.next_deadline(); }

  void advance(Time now) override;

  [[nodiscard]] bool serves(dronecan::Bytes prefix) const override;
  [[nodiscard]] std::optional<dronecan::NodeId> assign(const dronecan::UniqueId& unique_id,
                                                       dronecan::NodeId preferred) override;

  [[nodiscard]] std::optional<dronecan::NodeId> keep(AllocatedUnit& unit, dronecan::NodeId id);
  [[nodiscard]] std::optional<dronecan::NodeId> give(AllocatedUnit& unit,
                                                     state::AllocationChoice choice);
  void refuse(AllocatedUnit& unit, Event event, Error error);
  [[nodiscard]] Error in_use(const AllocatedUnit& unit) const;
  [[nodiscard]] Error shared(const AllocatedUnit& unit) const;
  void watch_for_twins();
  void note_request(AllocatedUnit& unit);
  [[nodiscard]] AllocatedUnit* known(const dronecan::UniqueId& unique_id);
  [[nodiscard]] Holder holder(dronecan::NodeId id, const dronecan::UniqueId& unique_id) const;
  [[nodiscard]] std::optional<dronecan::NodeId> copy_of(const AllocatedUnit& unit) const;
  [[nodiscard]] bool is_left_out(dronecan::Bytes prefix) const;
  [[nodiscard]] bool is_meant(dronecan::Bytes prefix) const;
  void hear_first_part(dronecan::Bytes prefix, Time at);

  Session& session_;
  state::AllocationStore& store_;
  Range range_;
  Hook hook_;
  dronecan::Allocator allocator_;
  std::map<dronecan::UniqueId, AllocatedUnit> units_;
  std::optional<Error> failure_; ///< of the table
  Time last_request_;
  std::optional<Time> asked_once_{}; ///< the last request of a unit that had not asked before
  bool bus_is_known_ = false;
  state::NodeIds avoided_{};
  std::optional<std::vector<dronecan::UniqueId>> only_{}; ///< empty: all units
};

/// For each ID that was that of another unit: a sentence which names that unit.
[[nodiscard]] std::vector<std::string> taken_over(std::span<const AllocatedUnit> units);

} // namespace blactl::fleet
