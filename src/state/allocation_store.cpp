#include "blactl/state/allocation_store.hpp"

#include "blactl/base/hex.hpp"

#include "state/formats.hpp"
#include "state/sqlite.hpp"
#include "state/state_file.hpp"
#include "state/texts.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <tuple>
#include <utility>

namespace blactl::state {

using dronecan::NodeId;
using dronecan::UniqueId;

/// Both IDs are in the table and in its index, so the check of the whole file detects a change.
/// `at`: microseconds since 1970, UTC.
const DatabaseFormat& allocations_format() {
  static const DatabaseFormat format{
      .application_id = 0x626C6163, // "blac"
      .version = 1,
      .schema = "CREATE TABLE allocations ("
                "node_id INTEGER PRIMARY KEY CHECK (node_id BETWEEN 1 AND 125), "
                "unique_id BLOB NOT NULL UNIQUE CHECK (length(unique_id) = 16), "
                "at INTEGER NOT NULL) STRICT",
      .file = "allocations.db",
      .what = texts::allocation_table,
      .way_back = texts::allocation_table_back};
  return format;
}

namespace {

/// A time that is older is renewed.
constexpr std::chrono::hours worth_renewing{1};

bool may_be_given(NodeId id) {
  return first_dynamic_id <= id && id <= last_dynamic_id;
}

/// From `preferred` upward, then downward (1.Allocation.uavcan); 0: none.
NodeId first_free(const AllocationChoice& choice, const NodeIds& used) {
  const auto is_free = [&](std::uint8_t value) {
    const NodeId id(value);
    return choice.first <= id && id <= choice.last && may_be_given(id) && !used[value];
  };
  const NodeId preferred = choice.preferred.is_unicast() ? choice.preferred : last_dynamic_id;
  for (std::uint8_t id = preferred.value(); id <= last_dynamic_id.value(); ++id) {
    if (is_free(id)) {
      return NodeId(id);
    }
  }
  for (std::uint8_t id = preferred.value(); id > 0; --id) {
    if (is_free(id)) {
      return NodeId(id);
    }
  }
  return {};
}

/// The node ID in the first column.
NodeId node_id_of(Statement& row) {
  return NodeId(
      static_cast<std::uint8_t>(row.integer(0, first_dynamic_id.value(), last_dynamic_id.value())));
}

/// The entry in a row of node_id, unique_id, at.
AllocationEntry entry_of(Statement& row) {
  return {.node_id = node_id_of(row),
          .unique_id = row.array<std::tuple_size_v<UniqueId>>(1),
          .at = WallTime(Duration(row.integer(2)))};
}

Result<std::optional<AllocationEntry>> entry_with(const Database& database,
                                                  const UniqueId& unique_id) {
  Statement row(database, "SELECT node_id, unique_id, at FROM allocations WHERE unique_id = ?");
  return row.bind(unique_id).first([&] { return entry_of(row); });
}

Result<std::optional<AllocationEntry>> entry_with(const Database& database, NodeId node_id) {
  Statement row(database, "SELECT node_id, unique_id, at FROM allocations WHERE node_id = ?");
  return row.bind(node_id.value()).first([&] { return entry_of(row); });
}

Result<NodeIds> all_given(const Database& database) {
  Statement row(database, "SELECT node_id FROM allocations");
  NodeIds given;
  const auto read = row.each([&] {
    given.set(node_id_of(row).value());
    return true;
  });
  return read ? Result<NodeIds>(given) : std::unexpected(read.error());
}

/// Inserts a row, or replaces the node ID of a unit that has one.
Result<void> store(const Database& database, const UniqueId& unique_id, NodeId node_id,
                   WallTime now) {
  return Statement(database, "INSERT INTO allocations (node_id, unique_id, at) VALUES (?, ?, ?) "
                             "ON CONFLICT (unique_id) DO UPDATE "
                             "SET node_id = excluded.node_id, at = excluded.at")
      .bind(node_id.value())
      .bind(unique_id)
      .bind(now.time_since_epoch().count())
      .run();
}

Result<void> drop(const Database& database, const UniqueId& unique_id) {
  return Statement(database, "DELETE FROM allocations WHERE unique_id = ?").bind(unique_id).run();
}

Result<void> drop(const Database& database, NodeId node_id) {
  return Statement(database, "DELETE FROM allocations WHERE node_id = ?")
      .bind(node_id.value())
      .run();
}

/// That of the unit which was not seen for the longest time; empty: all are taken.
Result<std::optional<AllocationEntry>> longest_unseen(const Database& database,
                                                      const AllocationChoice& choice) {
  Statement row(database, "SELECT node_id, unique_id, at FROM allocations "
                          "WHERE node_id BETWEEN ? AND ? ORDER BY at, node_id");
  row.bind(choice.first.value()).bind(choice.last.value());
  std::optional<AllocationEntry> found;
  const auto read = row.each([&] {
    const AllocationEntry entry = entry_of(row);
    found = choice.taken[entry.node_id.value()] ? std::nullopt : std::optional(entry);
    return !found;
  });
  return read ? Result<std::optional<AllocationEntry>>(found) : std::unexpected(read.error());
}

/// For a unit without one, or whose ID is taken.
Result<Allocation> new_id(const Database& database, const UniqueId& unique_id,
                          const AllocationChoice& choice) {
  if (auto dropped = drop(database, unique_id); !dropped) {
    return std::unexpected(dropped.error());
  }
  const auto given = all_given(database);
  if (!given) {
    return std::unexpected(given.error());
  }
  if (const NodeId id = first_free(choice, *given | choice.taken); id.is_unicast()) {
    return Allocation{.node_id = id, .is_new = true};
  }
  const auto unseen = longest_unseen(database, choice);
  if (!unseen) {
    return std::unexpected(unseen.error());
  }
  if (!*unseen) {
    return fail(Code::table_full, say<texts::table_full>(choice.first.value(), choice.last.value()),
                say<texts::table_full_hint>());
  }
  const auto dropped = drop(database, (*unseen)->node_id);
  return dropped
             ? Result<Allocation>(
                   {.node_id = (*unseen)->node_id, .is_new = true, .former = (*unseen)->unique_id})
             : std::unexpected(dropped.error());
}

/// The part of allocate() inside its transaction.
Result<Allocation> known_or_new(const Database& database, const UniqueId& unique_id,
                                const AllocationChoice& choice, WallTime now) {
  const auto known = entry_with(database, unique_id);
  if (!known) {
    return std::unexpected(known.error());
  }
  const bool is_kept = *known && !choice.is_lost;
  auto allocated = is_kept ? Result<Allocation>({.node_id = (*known)->node_id})
                           : new_id(database, unique_id, choice);
  if (!allocated || (is_kept && now - (*known)->at < worth_renewing)) {
    return allocated;
  }
  const auto stored = store(database, unique_id, allocated->node_id, now);
  return stored ? allocated : std::unexpected(stored.error());
}

Error given_to(const UniqueId& holder, NodeId node_id) {
  const std::string other = hex(holder);
  return {Code::duplicate_node_id, say<texts::node_id_given>(node_id.value(), other),
          say<texts::node_id_given_hint>(other), node_id.value()};
}

Result<void> put_unless_taken(const Database& database, const AllocationStore::Wish& wish,
                              WallTime now) {
  const auto holder = entry_with(database, wish.node_id);
  if (!holder) {
    return std::unexpected(holder.error());
  }
  if (*holder) {
    return std::unexpected(given_to((*holder)->unique_id, wish.node_id));
  }
  return store(database, wish.unique_id, wish.node_id, now);
}

/// The part of enter() inside its transaction: first all units give up their IDs, since another may
/// request one. A unit that keeps its ID was seen with it.
Result<void> put_all(const Database& database, std::span<const AllocationStore::Wish> wishes,
                     WallTime now, AllocationStore::Former former) {
  std::vector<AllocationStore::Wish> changes;
  for (const auto& wish : wishes) {
    const auto known = entry_with(database, wish.unique_id);
    if (!known) {
      return std::unexpected(known.error());
    }
    if (*known && (*known)->node_id == wish.node_id) {
      const bool is_fresh = now - (*known)->at < worth_renewing;
      auto seen = is_fresh ? Result<void>() : store(database, wish.unique_id, wish.node_id, now);
      if (!seen) {
        return seen;
      }
      continue;
    }
    if (auto dropped = drop(database, wish.unique_id); !dropped) {
      return dropped;
    }
    changes.push_back(wish);
  }
  for (const auto& wish : changes) {
    auto yielded =
        former == AllocationStore::Former::yields ? drop(database, wish.node_id) : Result<void>();
    if (!yielded) {
      return yielded;
    }
  }
  for (const auto& wish : changes) {
    if (auto put = put_unless_taken(database, wish, now); !put) {
      return put;
    }
  }
  return {};
}

} // namespace

AllocationStore::AllocationStore(std::unique_ptr<StateFile> file) : file_(std::move(file)) {}

AllocationStore::AllocationStore(AllocationStore&&) noexcept = default;
AllocationStore& AllocationStore::operator=(AllocationStore&&) noexcept = default;
AllocationStore::~AllocationStore() = default;

Result<AllocationStore> AllocationStore::open(const std::string& folder, Access access,
                                              std::chrono::milliseconds patience) {
  return store_on<AllocationStore>(StateFile::open(folder, allocations_format(), access, patience));
}

Result<AllocationStore> AllocationStore::unshared() {
  return store_on<AllocationStore>(StateFile::unshared(allocations_format()));
}

const std::string& AllocationStore::path() const {
  return file_->path();
}

Result<std::vector<AllocationEntry>> AllocationStore::entries() const {
  std::vector<AllocationEntry> all;
  const Database* database = file_->database();
  if (database == nullptr) {
    return all;
  }
  Statement row(*database, "SELECT node_id, unique_id, at FROM allocations ORDER BY node_id");
  const auto read = row.each([&] {
    all.push_back(entry_of(row));
    return true;
  });
  return read ? Result<std::vector<AllocationEntry>>(std::move(all))
              : std::unexpected(read.error());
}

Result<std::optional<AllocationEntry>> AllocationStore::find(const UniqueId& unique_id) const {
  const Database* database = file_->database();
  return database != nullptr ? entry_with(*database, unique_id) : std::nullopt;
}

Result<std::optional<AllocationEntry>> AllocationStore::find(NodeId node_id) const {
  const Database* database = file_->database();
  return database != nullptr ? entry_with(*database, node_id) : std::nullopt;
}

Result<Allocation> AllocationStore::allocate(const UniqueId& unique_id,
                                             const AllocationChoice& choice, WallTime now) {
  auto allocated = file_->transact(
      [&](const Database& database) { return known_or_new(database, unique_id, choice, now); });
  if (allocated || choice.is_lost) {
    return allocated;
  }
  const auto known = find(unique_id); // its time could not be renewed: it has its ID all the same
  return known && *known ? Result<Allocation>({.node_id = (*known)->node_id}) : allocated;
}

Result<void> AllocationStore::enter(std::span<const Wish> wishes, WallTime now, Former former) {
  for (const Wish& wish : wishes) {
    if (!may_be_given(wish.node_id)) {
      return fail(Code::out_of_range, say<texts::node_id_not_dynamic>(wish.node_id.value()),
                  say<texts::node_id_not_dynamic_hint>());
    }
    const auto same = std::ranges::find(wishes, wish.node_id, &Wish::node_id);
    if (same->unique_id != wish.unique_id) {
      return std::unexpected(given_to(same->unique_id, wish.node_id));
    }
  }
  return file_->transact(
      [&](const Database& database) { return put_all(database, wishes, now, former); });
}

Result<bool> AllocationStore::forget(const UniqueId& unique_id) {
  return file_->transact([&](const Database& database) -> Result<bool> {
    const auto dropped = drop(database, unique_id);
    return dropped ? Result<bool>(sqlite3_changes(database.handle()) > 0)
                   : std::unexpected(dropped.error());
  });
}

} // namespace blactl::state
