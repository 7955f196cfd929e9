#include "blactl/state/counter_store.hpp"

#include "catch.hpp"
#include "database_files.hpp"
#include "processes.hpp"

#include <array>
#include <chrono>
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

/// As the first format was written: the units 0 to 2 in two laps of 1 to 2.
const std::string first_counters =
    "PRAGMA application_id = 1651269987; PRAGMA user_version = 1;"
    "CREATE TABLE assignments (number INTEGER PRIMARY KEY, recipe TEXT NOT NULL, parameter TEXT "
    "NOT NULL, unique_id BLOB NOT NULL CHECK (length(unique_id) = 16), value INTEGER NOT NULL, "
    "counted INTEGER NOT NULL CHECK (counted IN (0, 1)), at INTEGER NOT NULL CHECK (at BETWEEN 0 "
    "AND 253402300799999999), UNIQUE (recipe, parameter, unique_id), UNIQUE (recipe, parameter, "
    "counted, number, value, unique_id, at)) STRICT;"
    "INSERT INTO assignments (recipe, parameter, unique_id, value, counted, at) VALUES "
    "('aileron', 'servo_id', x'0000A5A5A5A5A5A5A5A5A5A5A5A5A5A5', 1, 1, 1),"
    "('aileron', 'servo_id', x'0100A5A5A5A5A5A5A5A5A5A5A5A5A5A5', 2, 1, 2),"
    "('aileron', 'servo_id', x'0200A5A5A5A5A5A5A5A5A5A5A5A5A5A5', 1, 1, 3)";

CounterStore opened(const Folder& folder) {
  auto store = CounterStore::open((folder.path / "state").string(), Access::write, 10s);
  if (!store) {
    FAIL(store.error().message);
  }
  return std::move(*store);
}

IdWish counted(std::int64_t first, std::int64_t last, bool again = false, std::int64_t step = 1) {
  return {
      .parameter = "servo_id", .first = first, .last = last, .step = step, .begins_again = again};
}

IdWish labelled(std::int64_t value) {
  return {.parameter = "servo_id", .value = value};
}

/// The one ID; its error code in its place.
std::string given(CounterStore& store, int number, const IdWish& wish,
                  const std::string& recipe = "aileron") {
  const auto ids = store.assign(unit(number), recipe, std::array{wish}, noon);
  if (!ids) {
    return std::string(name(ids.error().code));
  }
  REQUIRE(ids->size() == 1);
  return std::to_string(ids->front());
}

} // namespace

TEST_CASE("units get one ID after the other, and keep it for good") {
  const Folder folder;
  {
    CounterStore store = opened(folder);
    CHECK(given(store, 1, counted(1, 3)) == "1");
    CHECK(given(store, 2, counted(1, 3)) == "2");
    CHECK(given(store, 1, counted(1, 3)) == "1");
  }
  CounterStore store = opened(folder);
  CHECK(given(store, 2, counted(1, 3)) == "2");
  CHECK(given(store, 3, counted(1, 3)) == "3");
  CHECK(given(store, 4, counted(1, 3)) == "counter_end");
  CHECK(given(store, 3, counted(10, 12)) == "3"); // the recipe has changed
  CHECK(given(store, 4, counted(10, 12)) == "10");
  CHECK(given(store, 4, counted(1, 3), "elevator") == "1"); // another one has its own
}

TEST_CASE("a counter that begins again gives its IDs once more, in steps") {
  const Folder folder;
  CounterStore store = opened(folder);
  const IdWish wish = counted(2, 7, true, 2);
  std::string all;
  for (int i = 0; i < 8; ++i) {
    all += given(store, i, wish);
  }
  CHECK(all == "24624624");
}

TEST_CASE("what a label says is given to that unit alone") {
  const Folder folder;
  CounterStore store = opened(folder);
  CHECK(given(store, 1, labelled(2)) == "2");
  CHECK(given(store, 1, labelled(2)) == "2");
  CHECK(given(store, 1, labelled(3)) == "label_mismatch");
  CHECK(given(store, 2, labelled(2)) == "label_mismatch");
  CHECK(given(store, 2, counted(1, 4)) == "1");
  CHECK(given(store, 3, counted(1, 4)) == "3"); // 2 is given
  CHECK(given(store, 4, labelled(4)) == "4");
  CHECK(given(store, 5, counted(1, 4)) == "counter_end");
}

TEST_CASE("where one of two IDs cannot be given, none is") {
  const Folder folder;
  CounterStore store = opened(folder);
  IdWish node = counted(11, 11);
  node.parameter = "static_node_id";
  const std::array wishes{counted(1, 9), node};
  CHECK(store.assign(unit(1), "aileron", wishes, noon) == std::vector<std::int64_t>{1, 11});
  const auto second = store.assign(unit(2), "aileron", wishes, noon);
  REQUIRE_FALSE(second);
  CHECK(second.error().code == Code::counter_end);
  CHECK(second.error().message.find("static_node_id") != std::string::npos);
  CHECK(given(store, 3, counted(1, 9)) == "2"); // not lost
}

TEST_CASE("within one lap no ID is given twice, whoever gives it") {
  const Folder folder;
  CounterStore store = opened(folder);
  const IdWish wish = counted(1, 3, true);
  CHECK(given(store, 1, wish) == "1");
  CHECK(given(store, 2, labelled(2)) == "2");
  CHECK(given(store, 3, wish) == "3");
  CHECK(given(store, 4, wish) == "1"); // the second lap
  CHECK(given(store, 5, labelled(1)) == "label_mismatch");
  CHECK(given(store, 5, labelled(3)) == "3");
  CHECK(given(store, 6, wish) == "2");
  CHECK(given(store, 7, wish) == "1"); // 3 is told by a label
}

TEST_CASE("what was freed is given next, before the counter goes on") {
  const Folder folder;
  CounterStore store = opened(folder);
  const IdWish wish = counted(1, 8);
  for (int i = 1; i <= 8; ++i) {
    CHECK(given(store, i, wish) == std::to_string(i));
  }
  CHECK(given(store, 9, wish) == "counter_end");
  REQUIRE(store.free(unit(3), "elevator")); // it has nothing there
  CHECK(given(store, 9, wish) == "counter_end");
  REQUIRE(store.free(unit(3), "aileron"));
  REQUIRE(store.free(unit(3), "aileron")); // asked once more
  CHECK(given(store, 9, wish) == "3");
  CHECK(given(store, 3, wish) == "counter_end"); // the scrapped one counts as new
  REQUIRE(store.free(unit(5), "aileron"));
  CHECK(given(store, 10, labelled(5)) == "5");
}

TEST_CASE("what was freed in an earlier lap is not given in the present one") {
  const Folder folder;
  CounterStore store = opened(folder);
  const IdWish wish = counted(1, 2, true);
  for (int i = 1; i <= 3; ++i) {
    given(store, i, wish);
  }
  REQUIRE(store.free(unit(2), "aileron"));
  CHECK(given(store, 4, wish) == "2"); // of the second lap, as ever
  CHECK(given(store, 5, wish) == "1");
  REQUIRE(store.free(unit(5), "aileron"));
  CHECK(given(store, 6, wish) == "1");
  CHECK(given(store, 7, wish) == "2");
}

TEST_CASE("assignments of the first format are moved over") {
  const Folder folder;
  std::filesystem::create_directories(folder.path / "state");
  run_sql(folder.path / "state" / "counters.db", first_counters);
  CounterStore store = opened(folder);
  const IdWish wish = counted(1, 2, true);
  CHECK(given(store, 0, wish) == "1");
  CHECK(given(store, 1, wish) == "2");
  CHECK(given(store, 2, wish) == "1");
  CHECK(given(store, 3, wish) == "2"); // the second lap goes on
  CHECK(given(store, 4, wish) == "1");
}

TEST_CASE("stations beside each other give no ID twice") {
  constexpr int stations = 4, units = 12;
  const Folder folder;
  CHECK(all_at_once(stations, [&](int station) {
    CounterStore store = opened(folder);
    for (int i = 0; i < units; ++i) {
      if (!store.assign(unit(station * units + i), "aileron", std::array{counted(1, 250)}, noon)) {
        return false;
      }
    }
    return true;
  }));
  CounterStore store = opened(folder);
  std::set<std::string> ids;
  for (int i = 0; i < stations * units; ++i) {
    ids.insert(given(store, i, counted(1, 250)));
  }
  CHECK(ids.size() == stations * units);
  CHECK(given(store, 200, counted(1, 250)) == std::to_string(stations * units + 1));
}
