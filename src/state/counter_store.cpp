#include "blactl/state/counter_store.hpp"

#include "blactl/base/hex.hpp"

#include "state/formats.hpp"
#include "state/sqlite.hpp"
#include "state/state_file.hpp"
#include "state/texts.hpp"

#include <utility>

namespace blactl::state {

using dronecan::UniqueId;

/// Assignments are ordered by number, not by time: clocks are set back. `counted`: by a counter,
/// not by a label. The index repeats whole rows, so the check of the file detects any change. `at`:
/// microseconds since 1970, UTC, up to the year 9999.
const DatabaseFormat& counters_format() {
  static const DatabaseFormat format{
      .application_id = 0x626C6163, // "blac"
      .version = 1,
      .schema = "CREATE TABLE assignments ("
                "number INTEGER PRIMARY KEY, "
                "recipe TEXT NOT NULL, "
                "parameter TEXT NOT NULL, "
                "unique_id BLOB NOT NULL CHECK (length(unique_id) = 16), "
                "value INTEGER NOT NULL, "
                "counted INTEGER NOT NULL CHECK (counted IN (0, 1)), "
                "at INTEGER NOT NULL CHECK (at BETWEEN 0 AND 253402300799999999), "
                "UNIQUE (recipe, parameter, unique_id), "
                "UNIQUE (recipe, parameter, counted, number, value, unique_id, at)) STRICT",
      .file = "counters.db",
      .what = texts::counters,
      .way_back = texts::counters_back};
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

Result<std::optional<std::int64_t>> last_counted(const Request& request, const IdWish& wish) {
  Statement statement(request.database,
                      "SELECT value FROM assignments WHERE recipe = ? AND parameter = ? AND "
                      "counted = 1 ORDER BY number DESC LIMIT 1");
  statement.bind(request.recipe).bind(wish.parameter);
  return first_number(statement);
}

/// The unit that has this ID; empty: none.
Result<std::optional<std::string>> holder(const Request& request, const IdWish& wish,
                                          std::int64_t value) {
  Statement statement(request.database, "SELECT unique_id FROM assignments WHERE recipe = ? AND "
                                        "parameter = ? AND value = ? LIMIT 1");
  statement.bind(request.recipe).bind(wish.parameter).bind(value);
  return statement.first([&] { return hex(statement.bytes(0)); });
}

std::optional<std::int64_t> after(const IdWish& wish, std::int64_t value) {
  // The recipe may have changed since the ID was given.
  const std::int64_t next = value < wish.first ? wish.first : value + wish.step;
  return next <= wish.last   ? std::optional(next)
         : wish.begins_again ? std::optional(wish.first)
                             : std::nullopt;
}

Error ended(const Request& request, const IdWish& wish) {
  return {Code::counter_end,
          say<texts::counter_ended>(wish.parameter, printable(request.recipe), wish.last),
          say<texts::counter_ended_hint>(), std::nullopt};
}

Result<std::int64_t> next_of_counter(const Request& request, const IdWish& wish) {
  const auto last = last_counted(request, wish);
  if (!last) {
    return std::unexpected(last.error());
  }
  auto next = *last ? after(wish, **last) : std::optional(wish.first);
  while (next && !wish.begins_again) {
    const auto other = holder(request, wish, *next);
    if (!other) {
      return std::unexpected(other.error());
    }
    if (!*other) {
      break;
    }
    next = after(wish, *next);
  }
  return next ? Result<std::int64_t>(*next) : std::unexpected(ended(request, wish));
}

Result<std::int64_t> told_by_label(const Request& request, const IdWish& wish) {
  const auto other = holder(request, wish, *wish.value);
  if (!other) {
    return std::unexpected(other.error());
  }
  return *other ? fail(Code::label_mismatch,
                       say<texts::counter_taken>(wish.parameter, *wish.value, **other),
                       say<texts::counter_taken_hint>())
                : Result<std::int64_t>(*wish.value);
}

Result<void> keep(const Request& request, const IdWish& wish, std::int64_t value) {
  return Statement(request.database, "INSERT INTO assignments "
                                     "(recipe, parameter, unique_id, value, counted, at) "
                                     "VALUES (?, ?, ?, ?, ?, ?)")
      .bind(request.recipe)
      .bind(wish.parameter)
      .bind(request.unique_id)
      .bind(value)
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
  auto value = wish.value ? told_by_label(request, wish) : next_of_counter(request, wish);
  if (!value) {
    return value;
  }
  const auto kept = keep(request, wish, *value);
  return kept ? value : std::unexpected(kept.error());
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

} // namespace blactl::state
