#include "blactl/state/ledger_store.hpp"

#include "blactl/base/rfc3339.hpp"

#include "state/database_errors.hpp"
#include "state/formats.hpp"
#include "state/sqlite.hpp"
#include "state/state_file.hpp"
#include "state/texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace blactl::state {

namespace {

/// What format 1 did not have.
constexpr std::string_view new_columns[]{"start_time",  "parameter", "expected",  "actual",
                                         "station_seq", "machine",   "refers_to", "reason"};

/// "record_id, time, …": `each` returns the text for a column; of `version` 1 or 2.
template <class Each> std::string columns(Each each, int version = 2) {
  std::string text;
  for (const LedgerColumn& column : ledger_columns) {
    if (version > 1 || std::ranges::find(new_columns, column.name) == std::end(new_columns)) {
      text += (text.empty() ? "" : ", ") + std::string(each(column));
    }
  }
  return text;
}

std::string column_names(int version = 2) {
  return columns([](const LedgerColumn& column) { return column.name; }, version);
}

std::string_view type_of(const LedgerColumn& column) {
  constexpr std::array types{"INTEGER", "REAL", "TEXT"};
  return types.at(column.member.index());
}

/// `record_id`, `time` and `verdict` are always set.
std::string definitions(std::string_view verdicts, int version) {
  return columns(
      [&](const LedgerColumn& column) {
        const std::string definition = fmt::format("{} {}", column.name, type_of(column));
        return column.name == "record_id" ? definition + " NOT NULL UNIQUE"
               : column.name == "time"    ? definition + " NOT NULL"
               : column.name == "verdict"
                   ? fmt::format("{} NOT NULL CHECK (verdict IN ({}))", definition, verdicts)
                   : definition;
      },
      version);
}

/// A row `begun` is removed as its record is added. The first index repeats whole rows, so the
/// check of the file detects any change.
std::string ledger_schema() {
  return fmt::format(
      "CREATE TABLE ledger (number INTEGER PRIMARY KEY, {}, UNIQUE (serial_number, number, {}), "
      "UNIQUE (unique_id, recipe, number), UNIQUE (station, station_seq), "
      "CHECK ((verdict = 'begun') = (station_seq IS NULL))) STRICT",
      definitions("'begun', 'pass', 'fail', 'error', 'skip', 'scrap'", 2), column_names());
}

OlderFormat first_ledger() {
  return {.schema =
              fmt::format("CREATE TABLE ledger (number INTEGER PRIMARY KEY, {}, UNIQUE (number, "
                          "{})) STRICT",
                          definitions("'pass', 'fail', 'skip'", 1), column_names(1)),
          .upgrade = fmt::format(
              "ALTER TABLE ledger RENAME TO former; {}; "
              "INSERT INTO ledger (number, {}, station_seq) SELECT number, {}, row_number() OVER "
              "(PARTITION BY station ORDER BY number) FROM former; DROP TABLE former",
              ledger_schema(), column_names(1), column_names(1))};
}

} // namespace

const DatabaseFormat& ledger_format() {
  static const DatabaseFormat format{.application_id = 0x626C616C, // "blal"
                                     .version = 2,
                                     .schema = ledger_schema(),
                                     .file = "ledger.db",
                                     .what = texts::ledger,
                                     .way_back = texts::ledger_back,
                                     .older = {first_ledger()},
                                     .is_local = true};
  return format;
}

namespace {

constexpr const char* begun_verdict = "begun";

void bind(Statement& statement, const LedgerRecord& record) {
  for (const LedgerColumn& column : ledger_columns) {
    std::visit(
        [&](auto member) {
          const auto& value = record.*member;
          value ? statement.bind(*value) : statement.bind(std::nullopt);
        },
        column.member);
  }
}

LedgerRecord record_of(const Statement& row) {
  LedgerRecord record;
  int place = 0;
  for (const LedgerColumn& column : ledger_columns) {
    std::visit(
        [&](auto member) {
          auto& value = record.*member;
          using Value = typename std::remove_reference_t<decltype(value)>::value_type;
          if (row.is_null(place)) {
            return;
          }
          if constexpr (std::is_same_v<Value, std::string>) {
            value = std::string(row.text(place));
          } else if constexpr (std::is_same_v<Value, double>) {
            value = row.real(place);
          } else {
            value = row.integer(place);
          }
        },
        column.member);
    ++place;
  }
  return record;
}

/// The record with this ID; empty: there is none.
Result<std::optional<LedgerRecord>> find(const Database& database, const std::string& record_id) {
  Statement statement(database, "SELECT " + column_names() + " FROM ledger WHERE record_id = ?");
  statement.bind(record_id);
  return statement.first([&] { return record_of(statement); });
}

Result<void> insert(const Database& database, const LedgerRecord& record) {
  Statement statement(database, fmt::format("INSERT INTO ledger ({}) VALUES ({})", column_names(),
                                            columns([](const LedgerColumn&) { return "?"; })));
  bind(statement, record);
  return statement.run();
}

/// The next one of the station.
Result<std::int64_t> next_number(const Database& database, const std::string& station) {
  Statement statement(database, "SELECT coalesce(max(station_seq), 0) + 1 FROM ledger WHERE "
                                "station = ?");
  statement.bind(station);
  const auto next = statement.first([&] { return statement.integer(0); });
  return next ? Result<std::int64_t>(next->value_or(1)) : std::unexpected(next.error());
}

Result<void> remove_begun(const Database& database, const std::string& record_id) {
  Statement statement(database, "DELETE FROM ledger WHERE record_id = ? AND verdict = ?");
  statement.bind(record_id).bind(std::string_view(begun_verdict));
  return statement.run();
}

/// The part of end() inside its transaction.
Result<std::int64_t> add(const Database& database, LedgerRecord record) {
  const auto known = find(database, *record.record_id);
  if (!known) {
    return std::unexpected(known.error());
  }
  if (*known && (*known)->verdict != begun_verdict) {
    record.station_seq = (*known)->station_seq;
    return **known == record ? Result<std::int64_t>(record.station_seq.value_or(0))
                             : fail(Code::state, say<texts::ledger_twice>(*record.record_id));
  }
  if (auto removed = remove_begun(database, *record.record_id); !removed) {
    return std::unexpected(removed.error());
  }
  const auto number = next_number(database, *record.station);
  if (!number) {
    return number;
  }
  record.station_seq = *number;
  const auto inserted = insert(database, record);
  return inserted ? number : std::unexpected(inserted.error());
}

/// The conditions of a query, and the values for them.
class Conditions {
 public:
  explicit Conditions(const LedgerQuery& query) {
    add("time >= ?", query.since ? std::optional(rfc3339(*query.since)) : std::nullopt);
    add("time < ?", query.until ? std::optional(rfc3339(*query.until)) : std::nullopt);
    add("verdict = ?", query.verdict);
    add("work_order = ?", query.work_order);
    add("station = ?", query.station);
    add("unique_id = ?", query.unique_id);
    add("recipe = ?", query.recipe);
    add("record_id = ?", query.record_id);
    if (query.serial_number) {
      text_ += " AND serial_number = " + std::to_string(*query.serial_number);
    }
  }

  [[nodiscard]] const std::string& text() const { return text_; }

  void bind(Statement& statement) const {
    for (const std::string& value : values_) {
      statement.bind(value);
    }
  }

 private:
  void add(std::string_view condition, const std::optional<std::string>& value) {
    if (value) {
      text_ += fmt::format(" AND {}", condition);
      values_.push_back(*value);
    }
  }

  std::string text_ = "verdict <> 'begun'";
  std::vector<std::string> values_;
};

/// The next records after the one with the number `last`, which becomes that of the last of them;
/// empty: there are none left. Records are read in blocks, since nobody can commit during a read,
/// and whoever takes them may be slow.
Result<std::vector<LedgerRecord>> next_block(const Database& database, const LedgerQuery& query,
                                             std::int64_t& last) {
  const Conditions conditions(query);
  Statement statement(database, fmt::format("SELECT {}, number FROM ledger WHERE {} AND "
                                            "number > {} ORDER BY number LIMIT 256",
                                            column_names(), conditions.text(), last));
  conditions.bind(statement);
  std::vector<LedgerRecord> records;
  const auto read = statement.each([&] {
    records.push_back(record_of(statement));
    const std::int64_t number = statement.integer(static_cast<int>(ledger_columns.size()));
    if (number <= last) { // a damaged file would be read for ever
      statement.reject();
    }
    last = number;
    return true;
  });
  return read ? Result<std::vector<LedgerRecord>>(std::move(records))
              : std::unexpected(read.error());
}

} // namespace

LedgerStore::LedgerStore(std::unique_ptr<StateFile> file) : file_(std::move(file)) {}

LedgerStore::LedgerStore(LedgerStore&&) noexcept = default;
LedgerStore& LedgerStore::operator=(LedgerStore&&) noexcept = default;
LedgerStore::~LedgerStore() = default;

Result<LedgerStore> LedgerStore::open(const std::string& folder, Access access,
                                      std::chrono::milliseconds patience) {
  return store_on<LedgerStore>(StateFile::open(folder, ledger_format(), access, patience));
}

Result<LedgerStore> LedgerStore::unshared() {
  return store_on<LedgerStore>(StateFile::unshared(ledger_format()));
}

Result<void> LedgerStore::begin(const LedgerRecord& record) {
  return file_->transact([&](const Database& database) -> Result<void> {
    const auto known = find(database, *record.record_id);
    if (!known || *known) {
      return known ? fail(Code::state, say<texts::ledger_twice>(*record.record_id))
                   : std::unexpected(known.error());
    }
    LedgerRecord begun = record;
    begun.verdict = begun_verdict;
    return insert(database, begun);
  });
}

Result<std::int64_t> LedgerStore::end(const LedgerRecord& record) {
  return file_->transact([&](const Database& database) { return add(database, record); });
}

Result<std::vector<LedgerRecord>>
LedgerStore::begun(const std::optional<std::string>& station) const {
  std::vector<LedgerRecord> records;
  const Database* database = file_->database();
  if (database == nullptr) {
    return records;
  }
  Statement statement(*database, fmt::format("SELECT {} FROM ledger WHERE verdict = 'begun' AND "
                                             "(?1 IS NULL OR station = ?1) ORDER BY number",
                                             column_names()));
  station ? statement.bind(*station) : statement.bind(std::nullopt);
  const auto read = statement.each([&] {
    records.push_back(record_of(statement));
    records.back().verdict.reset();
    return true;
  });
  return read ? Result<std::vector<LedgerRecord>>(std::move(records))
              : std::unexpected(read.error());
}

bool LedgerStore::is_there() const {
  return file_->database() != nullptr;
}

Result<std::vector<LedgerHole>> LedgerStore::holes() const {
  std::vector<LedgerHole> holes;
  const Database* database = file_->database();
  if (const auto whole = file_->check(); !whole || database == nullptr) {
    return whole ? Result<std::vector<LedgerHole>>(holes) : std::unexpected(whole.error());
  }
  Statement statement(
      *database,
      "SELECT station, before + 1, station_seq - 1 FROM (SELECT station, station_seq, "
      "lag(station_seq, 1, 0) OVER (PARTITION BY station ORDER BY station_seq) AS before "
      "FROM ledger WHERE station_seq IS NOT NULL) WHERE station_seq <> before + 1");
  const auto read = statement.each([&] {
    holes.push_back({std::string(statement.text(0)), statement.integer(1), statement.integer(2)});
    return true;
  });
  return read ? Result<std::vector<LedgerHole>>(std::move(holes)) : std::unexpected(read.error());
}

Result<void> LedgerStore::back_up(const std::string& file) const {
  return file_->copy_to(file);
}

Result<void> LedgerStore::each(const LedgerQuery& query,
                               const std::function<bool(const LedgerRecord&)>& take) const {
  const Database* database = file_->database();
  if (database == nullptr) {
    return {};
  }
  std::int64_t last = 0;
  for (;;) {
    const auto records = next_block(*database, query, last);
    if (!records) {
      return std::unexpected(records.error());
    }
    if (records->empty() || !std::ranges::all_of(*records, take)) {
      return {};
    }
  }
}

Result<std::map<std::string, PassedIds>> LedgerStore::passed(const std::string& recipe) const {
  std::map<std::string, PassedIds> passed;
  const Database* database = file_->database();
  constexpr std::int64_t block = 8192; // nobody can commit during a read
  std::int64_t last = 0, count = database != nullptr ? block : 0;
  while (count == block) {
    Statement statement(*database, fmt::format("SELECT number, unique_id, verdict, servo_id, "
                                               "static_node_id FROM ledger WHERE number > {} AND "
                                               "recipe = ? AND verdict IN ('pass', 'scrap') AND "
                                               "unique_id IS NOT NULL ORDER BY number LIMIT {}",
                                               last, block));
    statement.bind(recipe);
    count = 0;
    const auto id = [&](int place) {
      return statement.is_null(place) ? std::optional<std::int64_t>() : statement.integer(place);
    };
    const auto read = statement.each([&] {
      if (statement.integer(0) <= last) { // a damaged file would be read for ever
        statement.reject();
      }
      last = statement.integer(0);
      ++count;
      const std::string unit(statement.text(1));
      if (statement.text(2) == "pass") {
        passed.insert_or_assign(unit, PassedIds{id(3), id(4)});
      } else {
        passed.erase(unit);
      }
      return true;
    });
    if (!read) {
      return std::unexpected(read.error());
    }
  }
  return passed;
}

const std::string& LedgerStore::path() const {
  return file_->path();
}

} // namespace blactl::state
