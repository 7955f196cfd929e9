#pragma once
// Gives node IDs on a session: the allocator with the table that outlives the process.
// DroneCAN specification 6, uavcan/protocol/dynamic_node_id/1.Allocation.uavcan; Futaba 2.3.

#include "blactl/base/error.hpp"
#include "blactl/dronecan/allocator.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/state/allocation_store.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>

namespace blactl::fleet {

/// A unit that asked for a node ID, and what came of it.
struct AllocatedUnit {
  dronecan::UniqueId unique_id{};
  dronecan::NodeId node_id{};     ///< of the table; 0: it has none
  bool is_new = false;            ///< it was not in the table before
  Time asked_at{};                ///< the last time
  std::optional<Error> refused{}; ///< why it was given none: duplicate_node_id, table_full
  bool is_shared = false;         ///< refused, too: it has got its ID, and so has another unit
  unsigned given = 0;             ///< how often in a row, without being heard under it
  bool is_deaf = false;           ///< it was given its ID again and again, and asks on
};

/// The node ID of a unit by the table, entered there if it is new: one that nobody on the bus has.
/// Errors: as AllocationStore::allocate().
[[nodiscard]] Result<dronecan::NodeId> allocate(const Session& session,
                                                state::AllocationStore& table,
                                                const dronecan::UniqueId& unique_id,
                                                state::AllocationChoice choice);

/// As long as it lives, units that ask for a node ID get one: what stands in the table, else one
/// that nobody has. What goes over the wire is in the table before.
///
/// Until bus_is_known() only those of the table are served: whoever is on the bus has had no time
/// to be heard. It ends by itself when another allocator is heard, or the table cannot be used.
class AllocationService final : private dronecan::Service, private dronecan::AllocationTable {
 public:
  enum class Event : std::uint8_t {
    request,  ///< a unit has told all of its unique ID
    assigned, ///< it is new in the table, and the answer goes out
    kept,     ///< it was in the table, and the answer goes out
    conflict, ///< the ID that it has in the table is another unit's on the bus
    full,     ///< no ID of the range is free
    deaf      ///< it does not take the ID that it is given; it goes on being given, untold
  };

  using Hook = std::function<void(Event, const AllocatedUnit&)>;

  struct Range {
    dronecan::NodeId first = state::first_dynamic_id;
    dronecan::NodeId last = state::last_dynamic_id;
  };

  /// `session` and `store` outlive this. `range`: where new IDs are taken from. `hook` is called
  /// for everything that happens; what lasts, as a refusal does, happens once.
  AllocationService(Session& session, state::AllocationStore& store, Range range, Hook hook);
  ~AllocationService() override;
  AllocationService(const AllocationService&) = delete;
  AllocationService(AllocationService&&) = delete;
  AllocationService& operator=(const AllocationService&) = delete;
  AllocationService& operator=(AllocationService&&) = delete;

  /// The bus was heard for bus_watch_time and silent nodes were looked for: new units are served.
  void bus_is_known() { bus_is_known_ = true; }

  /// Why it does not serve any more. Errors: other_allocator, naming the node; those of the table
  /// (bad_file, permission, io).
  [[nodiscard]] std::optional<Error> end() const;

  /// Those that asked, by unique ID. Bounded: a flood of strangers is not remembered.
  [[nodiscard]] const std::map<dronecan::UniqueId, AllocatedUnit>& units() const { return units_; }

  /// It was heard under the ID that it was given, and said that it is this unit.
  [[nodiscard]] bool is_there(const AllocatedUnit& unit) const;

  /// Why it has no ID of its own: as `refused`, with what is known now. Empty: nothing is against
  /// it.
  [[nodiscard]] std::optional<Error> refusal(const AllocatedUnit& unit) const;

  /// Why a unit that is not refused is not there. It has an ID in the table.
  [[nodiscard]] Error absence(const AllocatedUnit& unit) const;

  /// When a unit asked last that may still get somewhere, so none that is refused or deaf; the
  /// begin of this service, if none did.
  [[nodiscard]] Time last_request() const { return last_request_; }

  /// How many units ask now: they did of late, and have not been heard under an ID since. Units
  /// whose unique IDs begin alike count as one.
  [[nodiscard]] std::size_t asking() const;

  /// How many IDs of the range are left for new units. Errors: of the table.
  [[nodiscard]] Result<std::size_t> free_ids() const;

 private:
  enum class Holder : std::uint8_t { nobody, unknown, other, twin };

  void receive(const dronecan::Transfer& transfer) override;

  [[nodiscard]] Time next_deadline() const override { return allocator_.next_deadline(); }

  void advance(Time now) override;

  [[nodiscard]] bool serves(dronecan::Bytes prefix) const override;
  [[nodiscard]] std::optional<dronecan::NodeId> assign(const dronecan::UniqueId& unique_id,
                                                       dronecan::NodeId preferred) override;

  [[nodiscard]] std::optional<dronecan::NodeId> keep(AllocatedUnit& unit, dronecan::NodeId id);
  [[nodiscard]] std::optional<dronecan::NodeId> give(AllocatedUnit& unit,
                                                     dronecan::NodeId preferred);
  void refuse(AllocatedUnit& unit, Event event, Error error);
  [[nodiscard]] Error in_use(const AllocatedUnit& unit) const;
  [[nodiscard]] Error shared(const AllocatedUnit& unit) const;
  void watch_for_twins();
  void note_request(AllocatedUnit& unit);
  [[nodiscard]] AllocatedUnit* known(const dronecan::UniqueId& unique_id);
  [[nodiscard]] Holder holder(dronecan::NodeId id, const dronecan::UniqueId& unique_id) const;
  [[nodiscard]] bool is_heard_while_asking(const Member& member,
                                           const dronecan::UniqueId& unique_id) const;
  [[nodiscard]] bool is_left_out(dronecan::Bytes prefix) const;
  void hear_first_part(dronecan::Bytes prefix, Time at);

  Session& session_;
  state::AllocationStore& store_;
  Range range_;
  Hook hook_;
  dronecan::Allocator allocator_;
  std::map<dronecan::UniqueId, AllocatedUnit> units_;
  std::optional<Error> failure_; ///< of the table
  Time last_request_;
  std::map<UniqueIdPrefix, Time> first_parts_; ///< of requests, when they were heard last
  bool bus_is_known_ = false;
};

} // namespace blactl::fleet
