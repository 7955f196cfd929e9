#include "blactl/state/counter_store.hpp"

#include "catch.hpp"
#include "database_files.hpp"
#include "processes.hpp"

#include <array>
#include <chrono>
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
