#include "catch.hpp"
#include "dronecan/slot_table.hpp"

#include <list>
#include <random>

using blactl::dronecan::SlotTable;

TEST_CASE("a slot table finds a key again where it put it") {
  SlotTable table(4);
  const auto first = table.touch(7);
  CHECK(first.fresh);
  const auto second = table.touch(9);
  CHECK(second.slot != first.slot);
  const auto again = table.touch(7);
  CHECK_FALSE(again.fresh);
  CHECK(again.slot == first.slot);
  CHECK(table.key(second.slot) == 9);
}

TEST_CASE("a full slot table forgets the key that was idle longest") {
  SlotTable table(3);
  for (const std::uint32_t key : {1U, 2U, 3U}) {
    CHECK(table.touch(key).fresh);
  }
  CHECK_FALSE(table.touch(1).fresh); // now 2 is the idlest
  const auto slot_of_2 = table.touch(4).slot;
  CHECK(table.key(slot_of_2) == 4);
  CHECK_FALSE(table.touch(1).fresh);
  CHECK_FALSE(table.touch(3).fresh);
  CHECK(table.touch(2).fresh);
  CHECK(table.size() == 3);
}

TEST_CASE("a slot table has room for one key at least") {
  SlotTable table(0);
  CHECK(table.capacity() == 1);
  CHECK(table.touch(1).fresh);
  CHECK(table.touch(2).fresh);
  CHECK(table.touch(1).fresh);
}

TEST_CASE("a slot table agrees with a list kept in the order of use") {
  std::mt19937 random(2);
  for (const std::size_t capacity : {1U, 2U, 5U, 64U, 100U}) {
    SlotTable table(capacity);
    std::list<std::uint32_t> by_use; // the latest first
    for (int i = 0; i < 20'000; ++i) {
      const auto key = static_cast<std::uint32_t>(random() % (2 * capacity) * 0x10001U);
      const auto known = std::ranges::find(by_use, key);
      const auto touched = table.touch(key);
      REQUIRE(touched.fresh == (known == by_use.end()));
      REQUIRE(table.key(touched.slot) == key);
      if (known != by_use.end()) {
        by_use.erase(known);
      } else if (by_use.size() == capacity) {
        by_use.pop_back();
      }
      by_use.push_front(key);
      REQUIRE(table.size() == by_use.size());
    }
  }
}
