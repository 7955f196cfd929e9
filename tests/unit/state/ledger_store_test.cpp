#include "blactl/base/rfc3339.hpp"
#include "blactl/state/ledger_store.hpp"

#include "catch.hpp"
#include "database_files.hpp"
#include "processes.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

using namespace blactl;
using namespace blactl::state;
using namespace blactl::state::test;
using namespace std::chrono_literals;

namespace {

/// As the first format was written.
constexpr const char* first_ledger =
    "PRAGMA application_id = 1651269996; PRAGMA user_version = 1;"
    "CREATE TABLE ledger (number INTEGER PRIMARY KEY, record_id TEXT NOT NULL UNIQUE, time TEXT "
    "NOT NULL, verdict TEXT NOT NULL CHECK (verdict IN ('pass', 'fail', 'skip')), code TEXT, "
    "attempt INTEGER, serial_number INTEGER, unique_id TEXT, model TEXT, firmware_version INTEGER, "
    "hardware_version INTEGER, production_date TEXT, label TEXT, node_id INTEGER, node_id_after "
    "INTEGER, static_node_id INTEGER, servo_id INTEGER, config_sha256 TEXT, changed_count INTEGER, "
    "voltage_v REAL, temperature_c INTEGER, faults TEXT, duration_s REAL, station TEXT, operator "
    "TEXT, work_order TEXT, recipe TEXT, recipe_sha256 TEXT, profile_sha256 TEXT, tool_version "
    "TEXT, UNIQUE (number, record_id, time, verdict, code, attempt, serial_number, unique_id, "
    "model, firmware_version, hardware_version, production_date, label, node_id, node_id_after, "
    "static_node_id, servo_id, config_sha256, changed_count, voltage_v, temperature_c, faults, "
    "duration_s, station, operator, work_order, recipe, recipe_sha256, profile_sha256, "
    "tool_version)) STRICT;"
    "INSERT INTO ledger (record_id, time, verdict, station) VALUES "
    "('a', '2026-11-22T12:00:00Z', 'pass', 'bench');"
    "INSERT INTO ledger (record_id, time, verdict, model, station) VALUES "
    "('b', '2026-11-22T12:00:00Z', 'skip', 'BLA21-12U-AB', 'bench');";

LedgerRecord record(const std::string& id, WallTime at = noon,
                    const std::string& verdict = "pass") {
  LedgerRecord one;
  one.record_id = id;
  one.time = rfc3339(at);
  one.verdict = verdict;
  one.station = "bench";
  one.serial_number = 240900558;
  return one;
}

LedgerRecord numbered(LedgerRecord one, std::int64_t number) {
  one.station_seq = number;
  return one;
}

/// Each key holds something else.
LedgerRecord full() {
  LedgerRecord one = record("a");
  std::int64_t number = 100;
  for (const LedgerColumn& column : ledger_columns) {
    std::visit(
        [&](auto member) {
          using Value = typename std::remove_reference_t<decltype(one.*member)>::value_type;
          if constexpr (std::is_same_v<Value, std::string>) {
            one.*member = (one.*member).value_or("text " + std::to_string(++number));
          } else {
            one.*member = static_cast<Value>(++number) / 4;
          }
        },
        column.member);
  }
  one.station_seq.reset(); // the ledger's own
  return one;
}

Result<LedgerStore> try_open(const Folder& folder, Access access = Access::write) {
  return LedgerStore::open((folder.path / "state").string(), access, 10s);
}

LedgerStore opened(const Folder& folder, Access access = Access::write) {
  auto store = try_open(folder, access);
  if (!store) {
    FAIL(store.error().message);
  }
  return std::move(*store);
}

std::vector<LedgerRecord> found(const LedgerStore& store, const LedgerQuery& query = {}) {
  std::vector<LedgerRecord> records;
  const auto read = store.each(query, [&](const LedgerRecord& one) {
    records.push_back(one);
    return true;
  });
  INFO((read ? "" : read.error().message));
  REQUIRE(read);
  return records;
}

void add(LedgerStore& store, const LedgerRecord& one) {
  const auto added = store.end(one);
  INFO((added ? "" : added.error().message));
  REQUIRE(added);
}

std::string ids(const std::vector<LedgerRecord>& records) {
  std::string all;
  for (const LedgerRecord& one : records) {
    all += *one.record_id;
  }
  return all;
}

} // namespace

TEST_CASE("a record comes back as it was, whatever of it is known") {
  const Folder folder;
  {
    LedgerStore store = opened(folder);
    add(store, full());
    add(store, record("b"));
  }
  const auto records = found(opened(folder, Access::read));
  REQUIRE(records.size() == 2);
  CHECK(records[0] == numbered(full(), 1));
  CHECK(records[1] == numbered(record("b"), 2));
}

TEST_CASE("the keys of a record are those of the contract, each once") {
  std::set<std::string_view> names;
  for (const LedgerColumn& column : ledger_columns) {
    names.insert(column.name);
  }
  CHECK(names.size() == ledger_columns.size());
  CHECK(ledger_columns.front().name == "record_id");
  CHECK(ledger_columns.back().name == "tool_version");
}

TEST_CASE("a record may be sent twice, and stands once; another one with its ID is refused") {
  const Folder folder;
  LedgerStore store = opened(folder);
  add(store, full());
  add(store, full());
  CHECK(found(store).size() == 1);
  const auto other = store.end(record("a"));
  REQUIRE_FALSE(other);
  CHECK(other.error().code == Code::state);
  CHECK(found(store).front() == numbered(full(), 1));
}

TEST_CASE("a query gives what it names, in the order in which it was added") {
  const Folder folder;
  LedgerStore store = opened(folder);
  add(store, record("c", noon + 2h, "fail"));
  LedgerRecord ordered = record("a", noon);
  ordered.work_order = "W1";
  ordered.unique_id = "ff";
  ordered.recipe = "aileron";
  ordered.serial_number = 7;
  add(store, ordered);
  add(store, record("b", noon + 1h, "skip"));
  CHECK(ids(found(store)) == "cab");
  CHECK(ids(found(store, {.since = noon + 1h})) == "cb");
  CHECK(ids(found(store, {.until = noon + 1h})) == "a");
  CHECK(ids(found(store, {.since = noon, .until = noon + 2h})) == "ab");
  CHECK(ids(found(store, {.serial_number = 7})) == "a");
  CHECK(ids(found(store, {.verdict = "fail"})) == "c");
  CHECK(ids(found(store, {.work_order = "W1"})) == "a");
  CHECK(ids(found(store, {.unique_id = "ff", .recipe = "aileron"})) == "a");
  CHECK(ids(found(store, {.unique_id = "ff", .recipe = "elevator"})).empty());
  CHECK(ids(found(store, {.work_order = "' OR 1 --"})).empty());
}

TEST_CASE("who has seen enough gets no more") {
  const Folder folder;
  LedgerStore store = opened(folder);
  add(store, record("a"));
  add(store, record("b"));
  int seen = 0;
  REQUIRE(store.each({}, [&](const LedgerRecord&) { return ++seen < 1; }));
  CHECK(seen == 1);
}

TEST_CASE("who reads records slowly keeps nobody from adding one") {
  const Folder folder;
  LedgerStore store = opened(folder);
  constexpr int many = 300;
  for (int i = 0; i < many; ++i) {
    add(store, record(std::to_string(i)));
  }
  const LedgerStore reader = opened(folder, Access::read);
  std::vector<std::string> seen;
  REQUIRE(reader.each({.verdict = "pass"}, [&](const LedgerRecord& one) {
    if (seen.size() == 10) {
      LedgerStore other =
          LedgerStore::open((folder.path / "state").string(), Access::write, 20ms).value();
      CHECK(other.end(record("new")));
    }
    seen.push_back(*one.record_id);
    return true;
  }));
  REQUIRE(seen.size() == many + 1);
  CHECK(std::set(seen.begin(), seen.end()).size() == many + 1);
  CHECK(seen.front() == "0");
  CHECK(seen.back() == "new");
}

TEST_CASE("without a file there are no records, and reading makes none") {
  const Folder folder;
  CHECK(found(opened(folder, Access::read)).empty());
  CHECK_FALSE(std::filesystem::exists(folder.path / "state" / "ledger.db"));
}

TEST_CASE("what is no verdict is not recorded") {
  const Folder folder;
  LedgerStore store = opened(folder);
  CHECK_FALSE(store.end(record("a", noon, "perhaps")));
  CHECK(found(store).empty());
}

TEST_CASE("the units that have passed by a recipe are told, until they are scrapped") {
  const Folder folder;
  LedgerStore store = opened(folder);
  int number = 0;
  const auto add = [&](const std::string& unit, const std::string& verdict,
                       std::optional<std::int64_t> servo_id, const std::string& recipe = "r") {
    LedgerRecord one = record(std::to_string(++number), noon, verdict);
    one.unique_id = unit;
    one.recipe = recipe;
    one.servo_id = servo_id;
    one.static_node_id = 10 + number;
    REQUIRE(store.end(one));
  };
  CHECK(store.passed("r") == std::map<std::string, PassedIds>());
  add("a", "pass", 1);
  add("b", "pass", 2);
  add("c", "fail", 3);
  add("d", "pass", 4, "another");
  add("b", "scrap", 2);
  add("a", "error", 6);
  add("a", "pass", std::nullopt);
  LedgerRecord nobody = record("nobody");
  nobody.recipe = "r";
  REQUIRE(store.end(nobody));
  CHECK(store.passed("r") ==
        std::map<std::string, PassedIds>{{"a", {.servo_id = {}, .static_node_id = 17}}});
  add("b", "pass", 2);
  CHECK(store.passed("r").value().contains("b"));
}

TEST_CASE("what is begun is kept apart until it has ended, also beyond the process") {
  const Folder folder;
  LedgerRecord one = record("a");
  one.verdict.reset();
  {
    LedgerStore store = opened(folder);
    REQUIRE(store.begin(one));
    CHECK_FALSE(store.begin(one));
  }
  LedgerStore store = opened(folder);
  CHECK(found(store).empty());
  CHECK(store.begun() == std::vector{one});
  CHECK(store.begun("bench") == std::vector{one});
  CHECK(store.begun("other") == std::vector<LedgerRecord>());
  CHECK(store.end(record("a", noon, "error")) == 1);
  CHECK(store.begun() == std::vector<LedgerRecord>());
  CHECK(found(store) == std::vector{numbered(record("a", noon, "error"), 1)});
  CHECK_FALSE(store.begin(one)); // its ID is used
}

TEST_CASE("each station counts its records without holes, and a hole is found") {
  const Folder folder;
  LedgerStore store = opened(folder);
  for (const char* id : {"a", "b", "c", "d", "e"}) {
    add(store, record(id));
  }
  LedgerRecord other = record("f");
  other.station = "other";
  add(store, other);
  CHECK(store.end(record("a")) == 1); // sent once more
  CHECK(store.holes() == std::vector<LedgerHole>());
  run_sql(folder.path / "state" / "ledger.db",
          "DELETE FROM ledger WHERE record_id IN ('a', 'c', 'd')");
  CHECK(store.holes() == std::vector<LedgerHole>{{"bench", 1, 1}, {"bench", 3, 4}});
}

TEST_CASE("a copy of the ledger is a ledger, and replaces no file") {
  const Folder folder;
  LedgerStore store = opened(folder);
  add(store, full());
  const std::filesystem::path copies = folder.path / "copy";
  std::filesystem::create_directory(copies);
  REQUIRE(store.back_up((copies / "ledger.db").string()));
  const auto copied = LedgerStore::open(copies.string(), Access::read, 10s);
  REQUIRE(copied);
  CHECK(found(*copied) == std::vector{numbered(full(), 1)});
  CHECK((std::filesystem::status(copies / "ledger.db").permissions() &
         std::filesystem::perms::others_all) == std::filesystem::perms::none);
  const auto twice = store.back_up((copies / "ledger.db").string());
  REQUIRE_FALSE(twice);
  CHECK(twice.error().code == Code::io);
  CHECK(names_in(copies) == std::set<std::string>{"ledger.db"});
  const auto nothing = opened(Folder(), Access::read).back_up((copies / "b.db").string());
  REQUIRE_FALSE(nothing);
  CHECK(nothing.error().code == Code::state);
}

TEST_CASE("a ledger of the first format is moved over") {
  const Folder folder;
  std::filesystem::create_directories(folder.path / "state");
  run_sql(folder.path / "state" / "ledger.db", first_ledger);
  const auto records = found(opened(folder, Access::read));
  REQUIRE(records.size() == 2);
  CHECK(records[0].record_id == "a");
  CHECK(records[1].verdict == "skip");
  CHECK(records[1].station_seq == 2);
  CHECK(records[1].model == "BLA21-12U-AB");
}

TEST_CASE("two stations write into one ledger") {
  constexpr int stations = 3, units = 20;
  const Folder folder;
  CHECK(all_at_once(stations, [&](int station) {
    LedgerStore store = opened(folder);
    for (int i = 0; i < units; ++i) {
      if (!store.end(record(std::to_string(station) + "." + std::to_string(i)))) {
        return false;
      }
    }
    return true;
  }));
  CHECK(found(opened(folder)).size() == stations * units);
}
