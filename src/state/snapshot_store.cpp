#include "blactl/state/snapshot_store.hpp"

#include "state/boot.hpp"
#include "state/formats.hpp"
#include "state/register_bytes.hpp"
#include "state/sqlite.hpp"
#include "state/state_file.hpp"
#include "state/texts.hpp"

#include <tuple>
#include <utility>

namespace blactl::state {

using dronecan::UniqueId;

namespace {

const std::string change_columns =
    "number INTEGER PRIMARY KEY, "
    "run INTEGER NOT NULL, "
    "at INTEGER NOT NULL CHECK (at BETWEEN 0 AND 253402300799999999), "
    "command TEXT NOT NULL, "
    "unique_id BLOB NOT NULL CHECK (length(unique_id) = 16), "
    "held BLOB NOT NULL, ";

const std::string end_columns = "saved INTEGER NOT NULL CHECK (saved IN (0, 1)), "
                                "ended INTEGER NOT NULL CHECK (ended IN (0, 1)), ";

const std::string settled_column =
    "settled INTEGER CHECK (settled BETWEEN 0 AND 253402300799999999), ";

const std::string snapshot_clock_columns =
    "clock INTEGER CHECK (clock BETWEEN -253402300799999999 AND 253402300799999999), "
    "boot TEXT NOT NULL, ";

/// Changes are ordered by number, not by time: clocks are set back. The index repeats whole rows,
/// so the check of the file detects any change. `at`: microseconds since 1970, UTC, up to the year
/// 9999. `clock`: see SnapshotEntry. `boot`: of the machine.
const std::string snapshots_schema =
    "CREATE TABLE snapshots (" + change_columns + "written BLOB NOT NULL, " + end_columns +
    settled_column + snapshot_clock_columns +
    "serial_number INTEGER, "
    "UNIQUE (unique_id, number, run, at, command, held, written, saved, ended, settled, clock, "
    "boot, serial_number)) STRICT";

/// The others: as the present table has them, of a row of the older one.
OlderFormat older_snapshots(const std::string& older_schema, const std::string& written,
                            const std::string& settled, const std::string& clock = "NULL, ''") {
  return {.schema = older_schema,
          .upgrade = "ALTER TABLE snapshots RENAME TO older; " + snapshots_schema +
                     "; INSERT INTO snapshots SELECT number, run, at, command, unique_id, held, " +
                     written + ", saved, ended, " + settled + ", " + clock +
                     ", NULL FROM older; DROP TABLE older"};
}

const std::string settled_if_saved = "CASE saved WHEN 1 THEN at END";

/// It did not record what was written, nor when an outcome was known.
OlderFormat snapshots_of_version_1() {
  return older_snapshots("CREATE TABLE snapshots (" + change_columns + end_columns +
                             "UNIQUE (unique_id, number, run, at, command, held, saved, ended)) "
                             "STRICT",
                         "x''", settled_if_saved);
}

OlderFormat snapshots_of_version_2() {
  return older_snapshots("CREATE TABLE snapshots (" + change_columns + "written BLOB NOT NULL, " +
                             end_columns +
                             "UNIQUE (unique_id, number, run, at, command, held, written, saved, "
                             "ended)) STRICT",
                         "written", settled_if_saved);
}

/// It did not tell by which clock.
OlderFormat snapshots_of_version_3() {
  return older_snapshots("CREATE TABLE snapshots (" + change_columns + "written BLOB NOT NULL, " +
                             end_columns + settled_column +
                             "UNIQUE (unique_id, number, run, at, command, held, written, saved, "
                             "ended, settled)) STRICT",
                         "written", "settled");
}

/// It did not tell a unit from another with its unique ID.
OlderFormat snapshots_of_version_4() {
  return older_snapshots("CREATE TABLE snapshots (" + change_columns + "written BLOB NOT NULL, " +
                             end_columns + settled_column + snapshot_clock_columns +
                             "UNIQUE (unique_id, number, run, at, command, held, written, saved, "
                             "ended, settled, clock, boot)) STRICT",
                         "written", "settled", "clock, boot");
}

} // namespace

const DatabaseFormat& snapshots_format() {
  static const DatabaseFormat format{.application_id = 0x626C6173, // "blas"
                                     .version = 5,
                                     .schema = snapshots_schema,
                                     .file = "snapshots.db",
                                     .what = texts::change_history,
                                     .way_back = texts::change_history_back,
                                     .older = {snapshots_of_version_1(), snapshots_of_version_2(),
                                               snapshots_of_version_3(), snapshots_of_version_4()}};
  return format;
}

namespace {

/// Of those with one unique ID, the entries of the unit with the serial number ?2, as far as known.
const std::string of_unit = "(?2 IS NULL OR serial_number IS NULL OR serial_number = ?2)";

/// A query for the columns that snapshot_in() reads.
std::string select(std::string_view rest) {
  return "SELECT number, at, command, unique_id, held, saved, run, ended, written, "
         "settled, clock, boot, serial_number FROM snapshots " +
         std::string(rest);
}

SnapshotEntry snapshot_in(Statement& row) {
  const bool is_of_this_boot = !boot_id().empty() && row.text(11) == boot_id();
  return {.number = row.integer(0),
          .run = row.integer(6),
          .at = WallTime(Duration(row.integer(1, 0, last_time))),
          .command = std::string(row.text(2)),
          .unique_id = row.array<std::tuple_size_v<UniqueId>>(3),
          .held = registers_in(row, 4),
          .written = registers_in(row, 8),
          .saved = row.integer(5, 0, 1) != 0,
          .ended = row.integer(7, 0, 1) != 0,
          .settled = row.is_null(9)
                         ? std::nullopt
                         : std::optional(WallTime(Duration(row.integer(9, 0, last_time)))),
          .clock = row.is_null(10) || !is_of_this_boot
                       ? std::nullopt
                       : std::optional(WallTime(Duration(row.integer(10, -last_time, last_time)))),
          .serial_number = row.is_null(12) ? std::nullopt : std::optional(row.integer(12))};
}

/// Every row of a statement.
Result<std::vector<SnapshotEntry>> all_of(Statement& statement) {
  std::vector<SnapshotEntry> all;
  const auto read = statement.each([&] {
    all.push_back(snapshot_in(statement));
    return true;
  });
  return read ? Result<std::vector<SnapshotEntry>>(std::move(all)) : std::unexpected(read.error());
}

/// The number after the highest, which is also what SQLite gives the next new row.
Result<std::int64_t> next_number(const Database& database) {
  Statement row(database, "SELECT ifnull(max(number), 0) + 1 FROM snapshots");
  const auto read = row.step();
  return read ? Result<std::int64_t>(row.integer(0)) : std::unexpected(read.error());
}

Statement& bind_serial(Statement& statement, std::optional<std::int64_t> number) {
  return number ? statement.bind(*number) : statement.bind(std::nullopt);
}

/// Stores one entry and returns its number.
Result<std::int64_t> keep_one(const Database& database, const SnapshotEntry& entry,
                              std::int64_t new_run) {
  const std::vector<std::uint8_t> held = bytes_of(entry.held);
  const std::vector<std::uint8_t> written = bytes_of(entry.written);
  Statement statement(database,
                      "INSERT OR REPLACE INTO snapshots "
                      "(number, run, at, command, unique_id, held, written, saved, ended, settled, "
                      "clock, boot, serial_number) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  entry.number == 0 ? statement.bind(std::nullopt) : statement.bind(entry.number);
  statement.bind(entry.run == 0 ? new_run : entry.run)
      .bind(entry.at.time_since_epoch().count())
      .bind(entry.command)
      .bind(entry.unique_id)
      .bind(held)
      .bind(written)
      .bind(std::int64_t{entry.saved})
      .bind(std::int64_t{entry.ended});
  entry.settled ? statement.bind(entry.settled->time_since_epoch().count())
                : statement.bind(std::nullopt);
  entry.clock ? statement.bind(entry.clock->time_since_epoch().count())
              : statement.bind(std::nullopt);
  statement.bind(boot_id());
  const auto kept = bind_serial(statement, entry.serial_number).run();
  return kept ? Result<std::int64_t>(sqlite3_last_insert_rowid(database.handle()))
              : std::unexpected(kept.error());
}

Result<void> drop_surplus(const Database& database, const UniqueId& unique_id) {
  return Statement(database, "DELETE FROM snapshots WHERE unique_id = ?1 AND number NOT IN "
                             "(SELECT number FROM snapshots WHERE unique_id = ?1 "
                             "ORDER BY number DESC LIMIT ?)")
      .bind(unique_id)
      .bind(std::int64_t{most_snapshots})
      .run();
}

/// Drops old entries, but not the last one of each servo with the tries that it continues, nor the
/// one that an unfinished undo is taking back: a clock may be set ahead by years.
Result<void> drop_old(const Database& database, WallTime now) {
  return Statement(database, "DELETE FROM snapshots WHERE at < ? AND number < "
                             "(SELECT max(number) FROM snapshots AS newer "
                             "WHERE newer.unique_id = snapshots.unique_id "
                             "AND (newer.command != 'undo' OR newer.ended = 1)) "
                             "AND run != (SELECT run FROM snapshots AS newest "
                             "WHERE newest.unique_id = snapshots.unique_id "
                             "ORDER BY number DESC LIMIT 1)")
      .bind((now - oldest_snapshot).time_since_epoch().count())
      .run();
}

Result<void> remove(const Database& database, std::int64_t number) {
  return Statement(database, "DELETE FROM snapshots WHERE number = ?").bind(number).run();
}

/// The part of keep() inside its transaction.
Result<std::vector<std::int64_t>> keep_all(const Database& database,
                                           std::span<const SnapshotEntry> entries, WallTime now,
                                           std::span<const std::int64_t> former) {
  const auto new_run = next_number(database);
  if (!new_run) {
    return std::unexpected(new_run.error());
  }
  std::vector<std::int64_t> numbers;
  for (const SnapshotEntry& entry : entries) {
    const auto number = keep_one(database, entry, *new_run);
    if (!number) {
      return std::unexpected(number.error());
    }
    numbers.push_back(*number);
    if (auto dropped = drop_surplus(database, entry.unique_id); !dropped) {
      return std::unexpected(dropped.error());
    }
  }
  for (const std::int64_t number : former) { // now: no number is given to a second entry
    if (auto removed = remove(database, number); !removed) {
      return std::unexpected(removed.error());
    }
  }
  const auto dropped = drop_old(database, now);
  return dropped ? Result<std::vector<std::int64_t>>(std::move(numbers))
                 : std::unexpected(dropped.error());
}

Result<void> settle_one(const Database& database, const Settlement& settlement) {
  if (settlement.end == ChangeEnd::never_begun) {
    return remove(database, settlement.number);
  }
  return Statement(database, "UPDATE snapshots SET saved = ?, settled = ? WHERE number = ?")
      .bind(std::int64_t{settlement.end == ChangeEnd::saved})
      .bind(settlement.at.time_since_epoch().count())
      .bind(settlement.number)
      .run();
}

} // namespace

SnapshotStore::SnapshotStore(std::unique_ptr<StateFile> file) : file_(std::move(file)) {}

SnapshotStore::SnapshotStore(SnapshotStore&&) noexcept = default;
SnapshotStore& SnapshotStore::operator=(SnapshotStore&&) noexcept = default;
SnapshotStore::~SnapshotStore() = default;

Result<SnapshotStore> SnapshotStore::open(const std::string& folder, Access access,
                                          std::chrono::milliseconds patience) {
  return store_on<SnapshotStore>(StateFile::open(folder, snapshots_format(), access, patience));
}

Result<SnapshotStore> SnapshotStore::unshared() {
  return store_on<SnapshotStore>(StateFile::unshared(snapshots_format()));
}

Result<std::vector<std::int64_t>> SnapshotStore::keep(std::span<const SnapshotEntry> entries,
                                                      WallTime now,
                                                      std::span<const std::int64_t> former) {
  return file_->transact(
      [&](const Database& database) { return keep_all(database, entries, now, former); });
}

Result<void> SnapshotStore::settle(std::span<const Settlement> settlements) {
  return file_->transact([&](const Database& database) -> Result<void> {
    for (const Settlement& settlement : settlements) {
      if (auto settled = settle_one(database, settlement); !settled) {
        return settled;
      }
    }
    return {};
  });
}

Result<void> SnapshotStore::end(std::span<const UniqueId> units, std::string_view command) {
  return file_->transact([&](const Database& database) -> Result<void> {
    for (const UniqueId& unit : units) {
      auto ended = Statement(database, "UPDATE snapshots SET ended = 1 WHERE command = ?2 AND "
                                       "unique_id = ?1 AND run = (SELECT run FROM snapshots "
                                       "WHERE unique_id = ?1 ORDER BY number DESC LIMIT 1)")
                       .bind(unit)
                       .bind(command)
                       .run();
      if (!ended) {
        return ended;
      }
    }
    return {};
  });
}

Result<std::optional<SnapshotEntry>>
SnapshotStore::last(const UniqueId& unique_id, std::optional<std::int64_t> serial_number) const {
  const Database* database = file_->database();
  if (database == nullptr) {
    return std::nullopt;
  }
  Statement statement(
      *database, select("WHERE unique_id = ?1 AND " + of_unit + " ORDER BY number DESC LIMIT 1"));
  return bind_serial(statement.bind(unique_id), serial_number).first([&] {
    return snapshot_in(statement);
  });
}

Result<std::optional<SnapshotEntry>> SnapshotStore::before(const SnapshotEntry& entry) const {
  const Database* database = file_->database();
  if (database == nullptr) {
    return std::nullopt;
  }
  Statement statement(*database, select("WHERE unique_id = ?1 AND " + of_unit +
                                        " AND number < ?3 ORDER BY number DESC LIMIT 1"));
  return bind_serial(statement.bind(entry.unique_id), entry.serial_number)
      .bind(entry.number)
      .first([&] { return snapshot_in(statement); });
}

Result<std::vector<SnapshotEntry>> SnapshotStore::last_run() const {
  const Database* database = file_->database();
  if (database == nullptr) {
    return std::vector<SnapshotEntry>();
  }
  Statement statement(*database, select("WHERE run = "
                                        "(SELECT run FROM snapshots ORDER BY number DESC LIMIT 1) "
                                        "ORDER BY number"));
  return all_of(statement);
}

Result<std::vector<SnapshotEntry>> SnapshotStore::entries() const {
  const Database* database = file_->database();
  if (database == nullptr) {
    return std::vector<SnapshotEntry>();
  }
  Statement statement(*database, select("ORDER BY number DESC"));
  return all_of(statement);
}

} // namespace blactl::state
