#include "blactl/state/snapshot_store.hpp"
#include "blactl/state/state_folder.hpp"

#include "catch.hpp"
#include "database_files.hpp"
#include "processes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::state;
using namespace blactl::state::test;
using namespace std::chrono_literals;
using dronecan::UniqueId;

namespace {

SnapshotEntry entry(int number, std::int64_t value = 900, WallTime at = noon) {
  return {.at = at,
          .command = "set",
          .unique_id = unit(number),
          .held = {{0x38, value}, {0x39, -1799}},
          .written = {{0x38, value + 1}},
          .saved = true};
}

std::filesystem::path file_of(const Folder& folder) {
  return folder.path / "state" / "snapshots.db";
}

Result<SnapshotStore> try_open(const Folder& folder, Access access = Access::write) {
  return SnapshotStore::open((folder.path / "state").string(), access, 10s);
}

SnapshotStore opened(const Folder& folder, Access access = Access::write) {
  auto store = try_open(folder, access);
  if (!store) {
    FAIL(store.error().message);
  }
  return std::move(*store);
}

/// Keeps one and gives it as it is in the store.
SnapshotEntry kept(SnapshotStore& store, SnapshotEntry one, WallTime now = noon) {
  const auto numbers = store.keep(std::array{one}, now);
  INFO((numbers ? "" : numbers.error().message));
  REQUIRE(numbers);
  REQUIRE(numbers->size() == 1);
  one.number = numbers->front();
  one.run = one.run == 0 ? one.number : one.run;
  return one;
}

std::vector<SnapshotEntry> all(const SnapshotStore& store) {
  auto entries = store.entries();
  INFO((entries ? "" : entries.error().message));
  REQUIRE(entries);
  return *entries;
}

std::size_t count_of(const SnapshotStore& store, int number) {
  return static_cast<std::size_t>(
      std::ranges::count(all(store), unit(number), &SnapshotEntry::unique_id));
}

} // namespace

TEST_CASE("what is kept is there for the next process, the newest first") {
  const Folder folder;
  std::vector<SnapshotEntry> expected;
  {
    auto store = opened(folder);
    CHECK(all(store).empty());
    expected = {kept(store, entry(1)), kept(store, entry(2, -5)), kept(store, entry(1, 7))};
    std::ranges::reverse(expected);
  }
  const auto store = opened(folder, Access::read);
  CHECK(all(store) == expected);
  CHECK(store.last(unit(1)) == expected[0]);
  CHECK(store.last(unit(2)) == expected[1]);
  CHECK(store.last(unit(3)).value() == std::nullopt);
  CHECK(bytes_of(file_of(folder)).substr(68, 4) == "blas");
  CHECK(std::filesystem::status(file_of(folder)).permissions() == std::filesystem::perms(0600));
}

TEST_CASE("the last change is the one that was kept last, whatever the clock says") {
  auto store = SnapshotStore::unshared().value();
  kept(store, entry(1, 1, noon));
  const auto later = kept(store, entry(1, 2, noon - 24h), noon - 24h);
  CHECK(store.last(unit(1)) == later);
  CHECK(all(store).front() == later);
}

TEST_CASE("what became of a change is settled afterwards; one that was not begun goes") {
  auto store = SnapshotStore::unshared().value();
  const auto before = kept(store, entry(1, 1));
  const auto numbers = store.keep(std::array{entry(1, 2), entry(2), entry(3)}, noon).value();
  REQUIRE(store.settle(std::array{Settlement{numbers[0], ChangeEnd::never_begun},
                                  Settlement{numbers[1], ChangeEnd::not_saved, noon + 1s},
                                  Settlement{numbers[2], ChangeEnd::saved, noon + 2s}}));
  CHECK(store.last(unit(1)) == before);
  CHECK_FALSE(store.last(unit(2)).value()->saved);
  CHECK(store.last(unit(3)).value()->saved);
  CHECK(store.last(unit(2)).value()->settled == noon + 1s);
  CHECK(store.last(unit(3)).value()->settled == noon + 2s);
}

TEST_CASE("the last command is all that it changed, in however many rounds") {
  auto store = SnapshotStore::unshared().value();
  CHECK(store.last_run().value().empty());
  kept(store, entry(1));
  const auto numbers = store.keep(std::array{entry(1, 2), entry(2)}, noon).value();
  auto later = entry(3);
  later.run = numbers.front();
  kept(store, later);
  const auto run = store.last_run().value();
  REQUIRE(run.size() == 3);
  CHECK(run[0].unique_id == unit(1));
  CHECK(run[0].held.at(0x38) == 2);
  CHECK(run[2].unique_id == unit(3));
  REQUIRE(store.settle(std::array{Settlement{run[0].number, ChangeEnd::never_begun},
                                  Settlement{run[1].number, ChangeEnd::never_begun},
                                  Settlement{run[2].number, ChangeEnd::never_begun}}));
  CHECK(store.last_run().value().size() == 1);
}

TEST_CASE("an entry that goes on is put in its place, not beside it") {
  auto store = SnapshotStore::unshared().value();
  auto first = kept(store, entry(1));
  const auto other = kept(store, entry(2));
  first.held[0x46] = 0;
  CHECK(kept(store, first) == first);
  CHECK(all(store) == std::vector{other, first});
}

TEST_CASE("of one servo a hundred changes are kept, and all of the others") {
  auto store = SnapshotStore::unshared().value();
  kept(store, entry(2));
  for (int i = 0; i < 105; ++i) {
    kept(store, entry(1, i));
  }
  kept(store, entry(3));
  CHECK(count_of(store, 1) == most_snapshots);
  CHECK(count_of(store, 2) == 1);
  CHECK(count_of(store, 3) == 1);
  CHECK(store.last(unit(1)).value()->held.at(0x38) == 104);
}

TEST_CASE("after a year a change goes, unless it is the last one of its servo") {
  auto store = SnapshotStore::unshared().value();
  kept(store, entry(1, 1, noon));
  kept(store, entry(1, 2, noon + 24h), noon + 24h);
  kept(store, entry(2, 3, noon));
  const WallTime year_later = noon + oldest_snapshot + 1s;
  kept(store, entry(3, 4, year_later), year_later);
  CHECK(count_of(store, 1) == 1);
  CHECK(store.last(unit(1)).value()->held.at(0x38) == 2);
  CHECK(store.last(unit(2)).value()->held.at(0x38) == 3);
  const WallTime long_after = noon + 10 * oldest_snapshot;
  kept(store, entry(3, 5, long_after), long_after);
  CHECK(store.last(unit(1)).value()->held.at(0x38) == 2);
  CHECK(store.last(unit(2)).value()->held.at(0x38) == 3);
  CHECK(count_of(store, 3) == 1);
}

TEST_CASE("tries of one command stay together, however far a clock was set ahead between them") {
  auto store = SnapshotStore::unshared().value();
  const SnapshotEntry first = kept(store, entry(1, 1, noon));
  const WallTime years_ahead = noon + 3 * oldest_snapshot;
  SnapshotEntry second = entry(1, 2, years_ahead);
  second.run = first.run;
  kept(store, second, years_ahead);
  CHECK(count_of(store, 1) == 2);
  kept(store, entry(1, 3, years_ahead), years_ahead);
  CHECK(count_of(store, 1) == 2);
}

TEST_CASE("a change tells by which clock it was, as long as this machine runs") {
  const Folder folder;
  SnapshotEntry timed = entry(1);
  timed.clock = noon - 5h;
  auto store = opened(folder);
  const SnapshotEntry stored = kept(store, timed);
  CHECK(all(store) == std::vector{stored});
  run_sql(file_of(folder), "UPDATE snapshots SET boot = 'another'");
  CHECK_FALSE(all(store).front().clock);
}

TEST_CASE("an undo does not drop the old change that it takes back, until it has ended") {
  auto store = SnapshotStore::unshared().value();
  kept(store, entry(1, 1, noon));
  const WallTime long_after = noon + 2 * oldest_snapshot;
  SnapshotEntry undo = entry(1, 2, long_after);
  undo.command = "undo";
  kept(store, undo, long_after);
  CHECK(count_of(store, 1) == 2);
  REQUIRE(store.end(std::vector{unit(1)}, "undo"));
  kept(store, entry(2, 3, long_after), long_after);
  CHECK(count_of(store, 1) == 1);
}

TEST_CASE("a command is kept as it is, whatever is in it") {
  auto store = SnapshotStore::unshared().value();
  SnapshotEntry odd = entry(1);
  odd.command = "alloc --static'; DROP TABLE snapshots; --";
  const SnapshotEntry stored = kept(store, odd);
  CHECK(stored == all(store).front());
}

TEST_CASE("reading a history makes no file and changes nothing") {
  const Folder folder;
  if (GENERATE(false, true)) {
    auto store = opened(folder);
    kept(store, entry(1));
  }
  const bool was_there = std::filesystem::exists(folder.path / "state");
  auto store = opened(folder, Access::read);
  const auto before = all(store);
  CHECK(store.keep(std::array{entry(1, 7)}, noon).error().code == Code::permission);
  CHECK(store.settle(std::array{Settlement{1, ChangeEnd::saved}}).error().code == Code::permission);
  CHECK(all(store) == before);
  CHECK(std::filesystem::exists(folder.path / "state") == was_there);
}

TEST_CASE("a file that is no history of ours is refused by its name, and stays as it is") {
  const Folder folder;
  const auto [content, message] = GENERATE(
      std::pair("what is this", "not a blactl change history"),
      std::pair("PRAGMA user_version = 6", "has version 6; this blactl knows version 5"),
      std::pair("UPDATE snapshots SET held = x'38'", "is damaged"),
      std::pair("PRAGMA ignore_check_constraints = 1; UPDATE snapshots SET saved = 2",
                "is damaged"),
      std::pair("PRAGMA ignore_check_constraints = 1; UPDATE snapshots SET at = -1", "is damaged"),
      std::pair("PRAGMA ignore_check_constraints = 1; UPDATE snapshots SET unique_id = x'00'",
                "is damaged"));
  {
    auto store = opened(folder);
    kept(store, entry(1));
  }
  content == std::string("what is this") ? write_bytes(file_of(folder), content)
                                         : run_sql(file_of(folder), content);
  const std::string before = bytes_of(file_of(folder));
  const auto store = try_open(folder, GENERATE(Access::read, Access::write));
  const auto result = store ? store->entries() : std::unexpected(store.error());
  REQUIRE_FALSE(result);
  CHECK(result.error().code == Code::bad_file);
  INFO(result.error().message);
  CHECK(result.error().message.find(message) != std::string::npos);
  CHECK(result.error().hint.find("mv " + file_of(folder).string()) != std::string::npos);
  CHECK(bytes_of(file_of(folder)) == before);
}

namespace {

/// A file as an older version of this program left it, with the entry of unit 1.
void make_older_version(const std::filesystem::path& path, bool is_first) {
  std::filesystem::create_directories(path.parent_path());
  run_sql(path, "PRAGMA application_id = 1651270003; PRAGMA user_version = " +
                    std::string(is_first ? "1" : "2") +
                    "; CREATE TABLE snapshots ("
                    "number INTEGER PRIMARY KEY, "
                    "run INTEGER NOT NULL, "
                    "at INTEGER NOT NULL CHECK (at BETWEEN 0 AND 253402300799999999), "
                    "command TEXT NOT NULL, "
                    "unique_id BLOB NOT NULL CHECK (length(unique_id) = 16), "
                    "held BLOB NOT NULL, " +
                    std::string(is_first ? "" : "written BLOB NOT NULL, ") +
                    "saved INTEGER NOT NULL CHECK (saved IN (0, 1)), "
                    "ended INTEGER NOT NULL CHECK (ended IN (0, 1)), "
                    "UNIQUE (unique_id, number, run, at, command, held, " +
                    std::string(is_first ? "" : "written, ") +
                    "saved, ended)) STRICT; "
                    "INSERT INTO snapshots VALUES (7, 7, 1000000, 'set', "
                    "x'0100A5A5A5A5A5A5A5A5A5A5A5A5A5A5', x'380000000000000384', " +
                    std::string(is_first ? "" : "x'', ") + "1, 0)");
}

} // namespace

TEST_CASE("units with one unique ID are told apart by their serial numbers") {
  const Folder folder;
  auto store = opened(folder);
  const auto of_serial = [&](std::optional<std::int64_t> serial, int minutes) {
    SnapshotEntry one = entry(1, minutes);
    one.serial_number = serial;
    return kept(store, one);
  };
  const SnapshotEntry unknown = of_serial(std::nullopt, 1), first = of_serial(101, 2),
                      second = of_serial(102, 3);
  CHECK(store.last(unit(1), 101) == first);
  CHECK(store.last(unit(1), 102) == second);
  CHECK(store.last(unit(1), 103) == unknown);
  CHECK(store.last(unit(1)) == second);
  CHECK(store.before(second) == unknown);
}

TEST_CASE("the last version but one is brought to the present one with its clock") {
  const Folder folder;
  SnapshotEntry one;
  {
    auto store = opened(folder);
    one = entry(1);
    one.clock = noon - 1h;
    one = kept(store, one);
  }
  run_sql(file_of(folder),
          "CREATE TABLE older AS SELECT * FROM snapshots; DROP TABLE snapshots; "
          "CREATE TABLE snapshots (number INTEGER PRIMARY KEY, run INTEGER NOT NULL, "
          "at INTEGER NOT NULL CHECK (at BETWEEN 0 AND 253402300799999999), "
          "command TEXT NOT NULL, "
          "unique_id BLOB NOT NULL CHECK (length(unique_id) = 16), "
          "held BLOB NOT NULL, written BLOB NOT NULL, "
          "saved INTEGER NOT NULL CHECK (saved IN (0, 1)), "
          "ended INTEGER NOT NULL CHECK (ended IN (0, 1)), "
          "settled INTEGER CHECK (settled BETWEEN 0 AND 253402300799999999), "
          "clock INTEGER CHECK (clock BETWEEN -253402300799999999 AND 253402300799999999), "
          "boot TEXT NOT NULL, "
          "UNIQUE (unique_id, number, run, at, command, held, written, saved, ended, settled, "
          "clock, boot)) STRICT; "
          "INSERT INTO snapshots SELECT number, run, at, command, unique_id, held, written, saved, "
          "ended, settled, clock, boot FROM older; DROP TABLE older; PRAGMA user_version = 4");
  CHECK(all(opened(folder)) == std::vector{one});
  CHECK(check_state_files(file_of(folder).parent_path().string()).empty());
}

TEST_CASE("a history of an older version is brought to the present one, also for reading") {
  const Folder folder;
  make_older_version(file_of(folder), GENERATE(true, false));
  for (const Access access : {GENERATE(Access::read, Access::write), Access::write}) {
    auto store = opened(folder, access);
    CHECK(all(store) == std::vector{SnapshotEntry{.number = 7,
                                                  .run = 7,
                                                  .at = WallTime(1s),
                                                  .command = "set",
                                                  .unique_id = unit(1),
                                                  .held = {{0x38, 900}},
                                                  .saved = true,
                                                  .settled = WallTime(1s)}});
  }
  auto store = opened(folder);
  CHECK(kept(store, entry(2)).number == 8);
  CHECK(check_state_files(file_of(folder).parent_path().string()).empty());
}

TEST_CASE("one of an older version that is damaged stays as it is, byte for byte") {
  const Folder folder;
  make_older_version(file_of(folder), GENERATE(true, false));
  const auto* damage = GENERATE("DROP TABLE snapshots", "CREATE TABLE other (a)",
                                "PRAGMA ignore_check_constraints = 1; "
                                "UPDATE snapshots SET saved = 2");
  run_sql(file_of(folder), damage);
  const std::string before = bytes_of(file_of(folder));
  const auto store = try_open(folder, GENERATE(Access::read, Access::write));
  REQUIRE_FALSE(store);
  CHECK(store.error().code == Code::bad_file);
  CHECK(bytes_of(file_of(folder)) == before);
}

TEST_CASE("a changed bit anywhere in a row is found out by the check") {
  const Folder folder;
  {
    auto store = opened(folder);
    kept(store, entry(1));
  }
  const std::string good = bytes_of(file_of(folder));
  const std::string part =
      GENERATE(std::string("set"), std::string("\xA5\xA5\xA5"), std::string("\x03\x84", 2));
  std::string bad = good;
  bad[good.find(part)] ^= 1;
  write_bytes(file_of(folder), bad);
  const auto faults = check_state_files(file_of(folder).parent_path().string());
  REQUIRE(faults.size() == 1);
  CHECK(faults.front().code == Code::bad_file);
}

TEST_CASE("on a full disk all of one command is kept or nothing, and nothing that was there goes") {
  const Folder folder;
  const rlim_t limit = GENERATE(0U, 1000U, 8000U, 20000U, 60000U);
  {
    auto store = opened(folder);
    for (int i = 1; i <= 20; ++i) {
      kept(store, entry(i));
    }
  }
  int told = 0;
  {
    const Child child([&] {
      auto store = try_open(folder);
      limit_files_to(limit);
      int commands = 0;
      while (store && commands < 1000) {
        const auto numbers = store->keep(std::array{entry(101), entry(102), entry(103)}, noon);
        if (!numbers) {
          return numbers.error().code == Code::io ? commands : -1;
        }
        ++commands;
      }
      return -2;
    });
    told = child.said;
  }
  REQUIRE(told >= 0);
  const auto store = opened(folder);
  for (int i = 1; i <= 20; ++i) {
    CHECK(count_of(store, i) == 1);
  }
  const auto expected = std::min(static_cast<std::size_t>(told), most_snapshots);
  for (const int number : {101, 102, 103}) {
    CHECK(count_of(store, number) == expected);
  }
}

TEST_CASE("two processes keep their changes side by side, each with a number of its own") {
  const Folder folder;
  constexpr int commands = 30;
  CHECK(all_at_once(2, [&](int number) {
    auto store = try_open(folder);
    for (int i = 0; store && i < commands; ++i) {
      if (!store->keep(std::array{entry(number, i)}, noon)) {
        return false;
      }
    }
    return store.has_value();
  }));
  const auto store = opened(folder);
  std::set<std::int64_t> numbers;
  for (const SnapshotEntry& each : all(store)) {
    numbers.insert(each.number);
  }
  CHECK(numbers.size() == 2 * commands);
  CHECK(store.last(unit(1)).value()->held.at(0x38) == commands - 1);
}

TEST_CASE("what a process told that was killed is there, as it was planned") {
  const Folder folder;
  Child child([&] {
    auto store = try_open(folder);
    return store ? said(store->keep(std::array{entry(1)}, noon)) : -1;
  });
  REQUIRE(child.said == 0);
  child.end();
  CHECK(opened(folder).last(unit(1)).value()->saved);
}
