#include "blactl/state/counter_store.hpp"

#include "blactl/base/hex.hpp"

#include "state/formats.hpp"
#include "state/sqlite.hpp"
#include "state/state_file.hpp"
#include "state/texts.hpp"

#include <fmt/format.h>

#include <string_view>
#include <tuple>
#include <utility>

namespace blactl::state {

using dronecan::UniqueId;

namespace {

/// The rows of a format, without its keys.
constexpr std::string_view first_columns =
    "number INTEGER PRIMARY KEY, recipe TEXT NOT NULL, parameter TEXT NOT NULL, unique_id BLOB NOT "
    "NULL CHECK (length(unique_id) = 16), value INTEGER NOT NULL, counted INTEGER NOT NULL CHECK "
    "(counted IN (0, 1)), at INTEGER NOT NULL CHECK (at BETWEEN 0 AND 253402300799999999), UNIQUE "
    "(recipe, parameter, unique_id)";

/// Assignments are ordered by number, not by time: clocks are set back. Without a unique ID it was
/// freed. `counted`: by a counter, not by a label. The last index repeats whole rows, so the check
/// of the file detects any change. `at`: microseconds since 1970, UTC, up to the year 9999.
constexpr std::string_view present_columns =
    "number INTEGER PRIMARY KEY, recipe TEXT NOT NULL, parameter TEXT NOT NULL, lap INTEGER NOT "
    "NULL CHECK (lap >= 0), unique_id BLOB CHECK (length(unique_id) = 16), value INTEGER NOT NULL, "
    "counted INTEGER NOT NULL CHECK (counted IN (0, 1)), at INTEGER NOT NULL CHECK (at BETWEEN 0 "
    "AND 253402300799999999), UNIQUE (recipe, parameter, unique_id), UNIQUE (recipe, parameter, "
    "lap, value), UNIQUE (recipe, parameter, counted, number, lap, value, unique_id, at)";

std::string counters_schema() {
  return fmt::format("CREATE TABLE assignments ({}) STRICT", present_columns);
}

OlderFormat first_counters() {
  return {.schema = fmt::format("CREATE TABLE assignments ({}, UNIQUE (recipe, parameter, counted, "
                                "number, value, unique_id, at)) STRICT",
                                first_columns),
          .upgrade = fmt::format(
              "ALTER TABLE assignments RENAME TO former; {}; INSERT INTO assignments (number, "
              "recipe, parameter, lap, unique_id, value, counted, at) SELECT number, recipe, "
              "parameter, row_number() OVER (PARTITION BY recipe, parameter, value ORDER BY "
              "number) - 1, unique_id, value, counted, at FROM former; DROP TABLE former",
              counters_schema())};
}

} // namespace

const DatabaseFormat& counters_format() {
  static const DatabaseFormat format{.application_id = 0x626C6163, // "blac"
                                     .version = 2,
                                     .schema = counters_schema(),
                                     .file = "counters.db",
                                     .what = texts::counters,
                                     .way_back = texts::counters_back,
                                     .older = {first_counters()},
                                     .is_local = true};
  return format;
}

namespace {

/// The arguments of assign() for its transaction.
struct Request {
  const Database& database;
  const UniqueId& unique_id;
  const std::string& recipe;
  WallTime now;
};

/// The number in the first row; empty: there is none.
Result<std::optional<std::int64_t>> first_number(Statement& row) {
  return row.first([&] { return row.integer(0); });
}

Result<std::optional<std::int64_t>> value_of_unit(const Request& request, const IdWish& wish) {
  Statement statement(request.database, "SELECT value FROM assignments WHERE recipe = ? AND "
                                        "parameter = ? AND unique_id = ?");
  statement.bind(request.recipe).bind(wish.parameter).bind(request.unique_id);
  return first_number(statement);
}

/// The last ID that a counter has given.
struct Count {
  std::int64_t value = 0, lap = 0;
};

Result<std::optional<Count>> last_counted(const Request& request, const IdWish& wish) {
  Statement statement(request.database,
                      "SELECT value, lap FROM assignments WHERE recipe = ? AND parameter = ? AND "
                      "counted = 1 ORDER BY lap DESC, number DESC LIMIT 1");
  statement.bind(request.recipe).bind(wish.parameter);
  return statement.first([&] { return Count{statement.integer(0), statement.integer(1)}; });
}

/// The unit that has this ID in this lap, empty text: it was freed; empty: it was not given.
Result<std::optional<std::string>> holder(const Request& request, const IdWish& wish,
                                          const Count& id) {
  Statement statement(request.database, "SELECT unique_id FROM assignments WHERE recipe = ? AND "
                                        "parameter = ? AND value = ? AND lap = ?");
  statement.bind(request.recipe).bind(wish.parameter).bind(id.value).bind(id.lap);
  return statement.first([&] { return hex(statement.bytes(0)); });
}

std::optional<Count> after(const IdWish& wish, const Count& last) {
  // The recipe may have changed since the ID was given.
  const std::int64_t next = last.value < wish.first ? wish.first : last.value + wish.step;
  return next <= wish.last   ? std::optional(Count{next, last.lap})
         : wish.begins_again ? std::optional(Count{wish.first, last.lap + 1})
                             : std::nullopt;
}

Error ended(const Request& request, const IdWish& wish) {
  return {Code::counter_end,
          say<texts::counter_ended>(wish.parameter, printable(request.recipe), wish.last),
          say<texts::counter_ended_hint>(), std::nullopt};
}

/// What was freed in this lap, and this counter gives.
Result<std::optional<std::int64_t>> freed(const Request& request, const IdWish& wish,
                                          std::int64_t lap) {
  Statement statement(request.database,
                      "SELECT value FROM assignments WHERE recipe = ? AND parameter = ? AND lap = "
                      "? AND unique_id IS NULL AND value BETWEEN ? AND ? ORDER BY number LIMIT 1");
  statement.bind(request.recipe).bind(wish.parameter).bind(lap).bind(wish.first).bind(wish.last);
  return first_number(statement);
}

/// The next one that nobody has in its lap.
Result<Count> next_of_counter(const Request& request, const IdWish& wish) {
  const auto last = last_counted(request, wish);
  const auto again = last ? freed(request, wish, *last ? (*last)->lap : 0)
                          : Result<std::optional<std::int64_t>>(std::unexpected(last.error()));
  if (!again) {
    return std::unexpected(again.error());
  }
  if (*again) {
    return Count{**again, *last ? (*last)->lap : 0};
  }
  const std::int64_t last_lap = *last ? (*last)->lap + 1 : 1;
  auto next = *last ? after(wish, **last) : std::optional(Count{wish.first, 0});
  while (next && next->lap <= last_lap) {
    const auto other = holder(request, wish, *next);
    if (!other) {
      return std::unexpected(other.error());
    }
    if (!*other || (*other)->empty()) {
      return *next;
    }
    next = after(wish, *next);
  }
  return std::unexpected(ended(request, wish));
}

/// In the present lap of the counter, if there is one.
Result<Count> told_by_label(const Request& request, const IdWish& wish) {
  const auto last = last_counted(request, wish);
  if (!last) {
    return std::unexpected(last.error());
  }
  const Count id{*wish.value, *last ? (*last)->lap : 0};
  const auto other = holder(request, wish, id);
  if (!other) {
    return std::unexpected(other.error());
  }
  return *other && !(*other)->empty()
             ? fail(Code::label_mismatch,
                    say<texts::counter_taken>(wish.parameter, *wish.value, **other),
                    say<texts::counter_taken_hint>())
             : Result<Count>(id);
}

/// In the place of what was freed, if it was.
Result<void> keep(const Request& request, const IdWish& wish, const Count& id) {
  return Statement(request.database,
                   "INSERT INTO assignments (recipe, parameter, unique_id, value, lap, counted, "
                   "at) VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT (recipe, parameter, lap, value) "
                   "DO UPDATE SET unique_id = excluded.unique_id, at = excluded.at")
      .bind(request.recipe)
      .bind(wish.parameter)
      .bind(request.unique_id)
      .bind(id.value)
      .bind(id.lap)
      .bind(std::int64_t{!wish.value})
      .bind(request.now.time_since_epoch().count())
      .run();
}

Result<std::int64_t> assign_one(const Request& request, const IdWish& wish) {
  const auto before = value_of_unit(request, wish);
  if (!before) {
    return std::unexpected(before.error());
  }
  if (*before && wish.value && **before != *wish.value) {
    return fail(Code::label_mismatch,
                say<texts::counter_other>(wish.parameter, **before, *wish.value),
                say<texts::counter_taken_hint>());
  }
  if (*before) {
    return **before;
  }
  const auto id = wish.value ? told_by_label(request, wish) : next_of_counter(request, wish);
  if (!id) {
    return std::unexpected(id.error());
  }
  const auto kept = keep(request, wish, *id);
  return kept ? Result<std::int64_t>(id->value) : std::unexpected(kept.error());
}

} // namespace

CounterStore::CounterStore(std::unique_ptr<StateFile> file) : file_(std::move(file)) {}

CounterStore::CounterStore(CounterStore&&) noexcept = default;
CounterStore& CounterStore::operator=(CounterStore&&) noexcept = default;
CounterStore::~CounterStore() = default;

Result<CounterStore> CounterStore::open(const std::string& folder, Access access,
                                        std::chrono::milliseconds patience) {
  return store_on<CounterStore>(StateFile::open(folder, counters_format(), access, patience));
}

Result<CounterStore> CounterStore::unshared() {
  return store_on<CounterStore>(StateFile::unshared(counters_format()));
}

Result<std::vector<std::int64_t>> CounterStore::assign(const UniqueId& unique_id,
                                                       const std::string& recipe,
                                                       std::span<const IdWish> wishes,
                                                       WallTime now) {
  return file_->transact([&](const Database& database) -> Result<std::vector<std::int64_t>> {
    const Request request{database, unique_id, recipe, now};
    std::vector<std::int64_t> values;
    for (const IdWish& wish : wishes) {
      const auto value = assign_one(request, wish);
      if (!value) {
        return std::unexpected(value.error());
      }
      values.push_back(*value);
    }
    return values;
  });
}

Result<std::vector<UniqueId>> CounterStore::units(const std::string& recipe,
                                                  const std::string& parameter) const {
  std::vector<UniqueId> units;
  const Database* database = file_->database();
  if (database == nullptr) {
    return units;
  }
  Statement statement(*database,
                      "SELECT unique_id FROM assignments WHERE recipe = ? AND parameter = "
                      "? AND unique_id IS NOT NULL ORDER BY unique_id");
  statement.bind(recipe).bind(parameter);
  const auto read = statement.each([&] {
    units.push_back(statement.array<std::tuple_size_v<UniqueId>>(0));
    return true;
  });
  return read ? Result<std::vector<UniqueId>>(std::move(units)) : std::unexpected(read.error());
}

bool CounterStore::is_there() const {
  return file_->database() != nullptr;
}

Result<void> CounterStore::check() const {
  return file_->check();
}

Result<void> CounterStore::back_up(const std::string& file) const {
  return file_->copy_to(file);
}

Result<void> CounterStore::free(const UniqueId& unique_id, const std::string& recipe) {
  return file_->transact([&](const Database& database) -> Result<void> {
    Statement statement(
        database, "UPDATE assignments SET unique_id = NULL WHERE recipe = ? AND unique_id = ?");
    statement.bind(recipe).bind(unique_id);
    return statement.run();
  });
}

} // namespace blactl::state
