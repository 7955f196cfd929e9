#include "blactl/dronecan/transfer_ids.hpp"

#include "catch.hpp"

#include <array>

using namespace blactl::dronecan;

namespace {

using Table = std::array<TransferIds::Slot, TransferIds::slots>;

} // namespace

TEST_CASE("transfer IDs count from 0 to 31 and begin again") {
  Table table{};
  TransferIds ids(table);
  for (int i = 0; i < 100; ++i) {
    CHECK(ids.next(Kind::request, 11, NodeId(10)) == i % 32);
  }
}

TEST_CASE("each kind, data type and destination has its own transfer IDs") {
  Table table{};
  TransferIds ids(table);
  CHECK(ids.next(Kind::request, 11, NodeId(10)) == 0);
  CHECK(ids.next(Kind::request, 11, NodeId(11)) == 0);
  CHECK(ids.next(Kind::request, 1, NodeId(10)) == 0);
  CHECK(ids.next(Kind::message, 11, anonymous) == 0);
  CHECK(ids.next(Kind::response, 11, NodeId(10)) == 0);
  CHECK(ids.next(Kind::message, 0xFFFF, anonymous) == 0);
  CHECK(ids.next(Kind::request, 11, NodeId(10)) == 1);
}

TEST_CASE("four services of every node fit, and none disturbs another") {
  Table table{};
  TransferIds ids(table);
  for (int round = 0; round < 40; ++round) {
    for (const std::uint16_t type : std::array<std::uint16_t, 4>{1, 5, 10, 11}) {
      for (std::uint8_t node = 1; node <= NodeId::max; ++node) {
        REQUIRE(ids.next(Kind::request, type, NodeId(node)) == round % 32);
      }
    }
  }
}

TEST_CASE("the next owner of the memory goes on where this one stopped") {
  Table table{};
  CHECK(TransferIds(table).next(Kind::request, 11, NodeId(10)) == 0);
  CHECK(TransferIds(table).next(Kind::request, 11, NodeId(10)) == 1);
}

TEST_CASE("a counter without a past starts where it is told to") {
  Table table{};
  TransferIds ids(table, 30);
  CHECK(ids.next(Kind::request, 11, NodeId(10)) == 30);
  CHECK(ids.next(Kind::request, 11, NodeId(10)) == 31);
  CHECK(ids.next(Kind::request, 11, NodeId(10)) == 0);
  CHECK(ids.next(Kind::request, 11, NodeId(11)) == 30);
}

TEST_CASE("a table full of strangers still gives a new transfer ID each time") {
  Table table{};
  table.fill({0xFFFF'FFFF, 0xFFFF'FFFF});
  TransferIds ids(table);
  CHECK(ids.next(Kind::request, 11, NodeId(10)) == 0);
  CHECK(ids.next(Kind::request, 11, NodeId(10)) == 1);
}

TEST_CASE("a counter that was damaged counts on from whatever it holds") {
  Table table{};
  TransferIds ids(table);
  CHECK(ids.next(Kind::request, 11, NodeId(10)) == 0);
  for (auto& slot : table) {
    slot.next = slot.key != 0 ? 0xFFFF'FFFF : 0;
  }
  CHECK(ids.next(Kind::request, 11, NodeId(10)) == 31);
  CHECK(ids.next(Kind::request, 11, NodeId(10)) == 0);
}
