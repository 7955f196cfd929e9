#include "blactl/base/rfc3339.hpp"
#include "blactl/state/ledger_store.hpp"

#include "catch.hpp"
#include "database_files.hpp"
#include "processes.hpp"

#include <chrono>
#include <filesystem>
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

LedgerRecord record(const std::string& id, WallTime at = noon,
                    const std::string& verdict = "pass") {
  LedgerRecord one;
  one.record_id = id;
  one.time = rfc3339(at);
  one.verdict = verdict;
  one.serial_number = 240900558;
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
  const auto added = store.add(one);
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
  CHECK(records[0] == full());
  CHECK(records[1] == record("b"));
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
  const auto other = store.add(record("a"));
  REQUIRE_FALSE(other);
  CHECK(other.error().code == Code::state);
  CHECK(found(store).front() == full());
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
      CHECK(other.add(record("new")));
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
  CHECK_FALSE(store.add(record("a", noon, "perhaps")));
  CHECK(found(store).empty());
}

TEST_CASE("two stations write into one ledger") {
  constexpr int stations = 3, units = 20;
  const Folder folder;
  CHECK(all_at_once(stations, [&](int station) {
    LedgerStore store = opened(folder);
    for (int i = 0; i < units; ++i) {
      if (!store.add(record(std::to_string(station) + "." + std::to_string(i)))) {
        return false;
      }
    }
    return true;
  }));
  CHECK(found(opened(folder)).size() == stations * units);
}
