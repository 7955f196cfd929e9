// The IDs that a ROM which could not be read may hold: given to no other servo.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <string>

using namespace blactl::test;

namespace {

/// Node 11 with servo ID 5, whose starts at these times do not read ROM, and node 15.
Scene two_servos(const std::string& first, const std::string& second = "") {
  Scene scene;
  scene.servo("BLA21-12U-AB", 11, {{"serial_number", 1}, {"servo_id", 5}})
      .servo("BLA21-12U-AB", 15, {{"serial_number", 2}, {"servo_id", 6}})
      .event(1, "rom_error", first);
  if (!second.empty()) {
    scene.event(1, "rom_error", second);
  }
  return scene;
}

void prove(const Fleet& fleet) {
  const Result proven = fleet.run({"set", "-n", "11", "smoothing=off", "--save", "-y"});
  INFO(proven.err);
  REQUIRE(proven.status == 0);
}

} // namespace

TEST_CASE("the servo ID in a ROM that was proven, and not read since, is given to no other servo") {
  const Fleet fleet(two_servos("20s"));
  prove(fleet);
  REQUIRE(fleet.run({"monitor", "-n", "15", "--duration", "25"}).status == 0);
  REQUIRE(fleet.run({"alloc", "--once"}).status == 0);
  const Result refused = fleet.run({"set", "-n", "15", "servo_id=5", "-y"});
  INFO(refused.err);
  check_error(refused, 9, "duplicate_servo_id", "node 15 would have servo ID 5, which node ");
  CHECK(contains(refused.err, "may have in its ROM: it could not read that at its start"));
  CHECK(fleet.run({"set", "-n", "15", "servo_id=7", "-y"}).status == 0);
}

TEST_CASE("the node ID in a ROM that our own restart did not read is given to no other servo") {
  int unread = 0;
  for (int at = 4000; at <= 8000; at += 250) {
    const Fleet fleet(two_servos(std::to_string(at) + "ms", "40s"));
    prove(fleet);
    REQUIRE(fleet.run({"monitor", "-n", "15", "--duration", "1"}).status == 0);
    const Result restarted = fleet.run({"restart", "-n", "11", "-y"});
    if (!contains(restarted.err, "could not read its ROM")) {
      continue; // it has read it, and what that holds was not read
    }
    ++unread;
    REQUIRE(fleet.run({"monitor", "-n", "15", "--duration", "40"}).status == 0);
    const Result refused = fleet.run({"set", "-n", "15", "static_node_id=11", "--save", "-y"});
    INFO(at << restarted.err << refused.err);
    CHECK(refused.status == 9);
    CHECK(codes(refused) == std::vector<std::string>{"duplicate_node_id"});
  }
  CHECK(unread > 0);
}
