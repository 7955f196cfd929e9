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
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace blactl::state {

namespace {

/// "record_id, time, …": `each` returns the text for a column.
template <class Each> std::string columns(Each each) {
  std::string text;
  for (const LedgerColumn& column : ledger_columns) {
    text += (text.empty() ? "" : ", ") + std::string(each(column));
  }
  return text;
}

std::string column_names() {
  return columns([](const LedgerColumn& column) { return column.name; });
}

std::string_view type_of(const LedgerColumn& column) {
  constexpr std::array types{"INTEGER", "REAL", "TEXT"};
  return types.at(column.member.index());
}

/// `record_id`, `time` and `verdict` are always set. The index repeats whole rows, so the check of
/// the file detects any change.
std::string ledger_schema() {
  const std::string definitions = columns([](const LedgerColumn& column) {
    const std::string definition = fmt::format("{} {}", column.name, type_of(column));
    return column.name == "record_id" ? definition + " NOT NULL UNIQUE"
           : column.name == "time"    ? definition + " NOT NULL"
           : column.name == "verdict"
               ? definition + " NOT NULL CHECK (verdict IN ('pass', 'fail', 'skip'))"
               : definition;
  });
  return fmt::format("CREATE TABLE ledger (number INTEGER PRIMARY KEY, {}, UNIQUE (number, {})) "
                     "STRICT",
                     definitions, column_names());
}

} // namespace

const DatabaseFormat& ledger_format() {
  static const DatabaseFormat format{.application_id = 0x626C616C, // "blal"
                                     .version = 1,
                                     .schema = ledger_schema(),
                                     .file = "ledger.db",
                                     .what = texts::ledger,
                                     .way_back = texts::ledger_back};
  return format;
}

namespace {

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

/// The part of add() inside its transaction.
Result<void> insert(const Database& database, const LedgerRecord& record) {
  const auto known = find(database, record.record_id.value_or(std::string()));
  if (!known) {
    return std::unexpected(known.error());
  }
  if (*known) {
    return **known == record ? Result<void>()
                             : fail(Code::state, say<texts::ledger_twice>(*record.record_id));
  }
  Statement statement(database, fmt::format("INSERT INTO ledger ({}) VALUES ({})", column_names(),
                                            columns([](const LedgerColumn&) { return "?"; })));
  bind(statement, record);
  return statement.run();
}

/// The conditions of a query, and the values for them.
class Conditions {
 public:
  explicit Conditions(const LedgerQuery& query) {
    add("time >= ?", query.since ? std::optional(rfc3339(*query.since)) : std::nullopt);
    add("time < ?", query.until ? std::optional(rfc3339(*query.until)) : std::nullopt);
    add("verdict = ?", query.verdict);
    add("work_order = ?", query.work_order);
    add("unique_id = ?", query.unique_id);
    add("recipe = ?", query.recipe);
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

  std::string text_ = "1";
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

Result<void> LedgerStore::add(const LedgerRecord& record) {
  return file_->transact([&](const Database& database) { return insert(database, record); });
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

const std::string& LedgerStore::path() const {
  return file_->path();
}

} // namespace blactl::state
