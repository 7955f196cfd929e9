// undo of node IDs that servos have exchanged.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <cstdint>
#include <string>

using namespace blactl::test;

namespace {

std::string uid(int number) {
  return "a1b200000000000000000000000000" + std::string(number < 10 ? "0" : "") +
         std::to_string(number);
}

/// Two with a static node ID, 11 and 12, and one that asks for its ID; serial numbers 1 to 3.
Scene two_static_and_one_dynamic() {
  Scene scene;
  for (const int i : {1, 2, 3}) {
    scene.servo("BLA21-12U-AB", i == 3 ? 0 : 10 + i,
                {{"serial_number", i}, {"unique_id", uid(i)}, {"servo_id", i}});
  }
  return scene;
}

std::int64_t node_of(const Fleet& fleet, int serial) {
  const Result got =
      fleet.run({"get", "-n", "serial:" + std::to_string(serial), "static_node_id", "--json"});
  INFO(got.err);
  REQUIRE(got.status == 0);
  return json(got.out)["nodes"][0]["node_id"];
}

std::int64_t static_id_of(const Fleet& fleet, int serial) {
  return fleet.ram("serial:" + std::to_string(serial), "static_node_id");
}

} // namespace

TEST_CASE("undo of exchanged IDs goes through where one of the servos asked for its ID before") {
  const Fleet fleet(two_static_and_one_dynamic());
  REQUIRE(fleet.run({"alloc", "--once", "--assign", uid(3) + "=20", "-y"}).status == 0);
  REQUIRE(node_of(fleet, 3) == 20);
  const Result rotated = fleet.run({"alloc", "--static", "--assign", uid(1) + "=12", "--assign",
                                    uid(2) + "=20", "--assign", uid(3) + "=11", "-y"});
  INFO(rotated.err);
  REQUIRE(rotated.status == 0);
  const Arguments to = GENERATE(Arguments{}, Arguments{"--to", "1"});
  Arguments arguments{"undo", "-y", "--json"};
  arguments.insert(arguments.end(), to.begin(), to.end());
  const Result undone = fleet.run(arguments);
  INFO(undone.err << undone.out);
  CHECK(undone.status == 0);
  CHECK(node_of(fleet, 1) == 11);
  CHECK(node_of(fleet, 2) == 12);
  CHECK(static_id_of(fleet, 3) == 0);
  CHECK(contains(undone.err, "node 11 leaves its node ID to another servo, and asks for one"));
  CHECK(node_of(fleet, 3) > 12);                            // any, but one that nobody has
  const Result again = fleet.run({"undo", "-y", "--json"}); // which is a change, too
  INFO(again.err << again.out);
  CHECK(again.status == 0);
  CHECK(node_of(fleet, 3) == 11);
}

TEST_CASE("undo takes a node ID from RAM of one servo, and gives it back to another") {
  const Fleet fleet(two_static_and_one_dynamic());
  REQUIRE(fleet.run({"alloc", "--static", "--assign", uid(1) + "=50", "-y"}).status == 0);
  const Result set = fleet.run({"set", "-n", "12", "static_node_id=11", "-y"});
  INFO(set.err);
  REQUIRE(set.status == 0);
  const Result undone = fleet.run({"undo", "--to", "1", "-y", "--json"});
  INFO(undone.err << undone.out);
  CHECK(undone.status == 0);
  CHECK(node_of(fleet, 1) == 11);
  CHECK(static_id_of(fleet, 2) == 12);
  REQUIRE(fleet.run({"restart", "-n", "12", "-y"}).status == 0);
  CHECK(static_id_of(fleet, 2) == 12);
}
