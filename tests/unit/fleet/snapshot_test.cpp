#include "blactl/fleet/bus/snapshot.hpp"

#include "support.hpp"

#include <string>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
namespace at = bla::address;

namespace {

constexpr const char* servo_11 = R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
    "ram": {"angle_limit_cw": "90deg", "reverse": "on"}}])";

/// What node 11 holds.
Snapshot read() {
  return Scene(servo_11).read(11, configuration);
}

bool mentions(const Error& error, std::string_view words) {
  return error.message.find(words) != std::string::npos;
}

} // namespace

TEST_CASE("a snapshot is plain data: it outlives the bus from which it came") {
  const Snapshot snapshot = read();
  CHECK(snapshot.servo.id == NodeId(11));
  CHECK(snapshot.servo.identity.model() == "BLA21-12U-AB");
  CHECK(snapshot.raw(at::angle_limit_cw) == 900);
  CHECK_FALSE(snapshot.raw(at::current_angle)); // of which nothing was asked
  CHECK_FALSE(snapshot.first_error());
}

TEST_CASE("what was read is what must be there") {
  const Snapshot snapshot = read();
  const bla::Values held = snapshot.values();
  CHECK(held.size() == snapshot.readings.size());
  CHECK(held.at(at::angle_limit_cw) == 900);
  CHECK_FALSE(compare(snapshot, held));
  CHECK_FALSE(compare(snapshot, {})); // nothing is expected
  CHECK_FALSE(compare(snapshot, {{at::angle_limit_cw, 900}}));
  CHECK_FALSE(compare(snapshot, {{at::current_angle, 5}})); // of which nothing was read
}

TEST_CASE("registers that differ are named, each with what it holds and what it should hold") {
  const Snapshot snapshot = read();
  bla::Values expected = snapshot.values();
  SECTION("one") {
    expected[at::angle_limit_cw] = 1799;
    const auto error = compare(snapshot, expected);
    REQUIRE(error);
    CHECK(error->code == Code::mismatch);
    CHECK(error->node_id == 11);
    CHECK(mentions(*error, "angle_limit_cw"));
    CHECK(mentions(*error, "90.0"));
    CHECK(mentions(*error, "179.9"));
    CHECK_FALSE(mentions(*error, "reverse"));
  }
  SECTION("several") {
    expected[at::angle_limit_cw] = 1799;
    expected[at::reverse] = 0;
    const auto error = compare(snapshot, expected);
    REQUIRE(error);
    CHECK(mentions(*error, "angle_limit_cw"));
    CHECK(mentions(*error, "reverse"));
  }
}

TEST_CASE("what could not be read is no match, whatever the other registers hold") {
  Snapshot snapshot = read();
  snapshot.readings[1].raw = std::unexpected(Error{Code::timeout, "mute", {}, 11});
  const auto error = compare(snapshot, snapshot.values());
  REQUIRE(error);
  CHECK(error->code == Code::timeout);
  CHECK(snapshot.first_error()->code == Code::timeout);
  CHECK_FALSE(snapshot.values().contains(at::soft_start));
  CHECK_FALSE(snapshot.raw(at::soft_start));
  CHECK(snapshot.values().contains(at::torque_output));
}

TEST_CASE("a servo that was not identified is no match") {
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
                                   "faults": {"mute": true}}])");
  const Snapshot snapshot = scene.read(11, configuration);
  const auto error = compare(snapshot, {});
  REQUIRE(error);
  CHECK(error->code == Code::timeout);
  CHECK(snapshot.values().empty());
}

TEST_CASE("a servo tells by 0x1A whether it could read its ROM at its start") {
  constexpr std::int64_t rom_unreadable = 1 << 15;
  const Servo servo = bla21();
  const bla::Parameter* warnings = rom_state(servo.identity);
  REQUIRE(warnings != nullptr);
  CHECK(warnings->address == at::fault_warning);
  CHECK_FALSE(check_rom(snapshot_of(servo, {warnings}, {{at::fault_warning, 0}})));
  CHECK_FALSE(check_rom(snapshot_of(servo, {warnings}, {{at::fault_warning, 1 << 8}})));
  CHECK_FALSE(check_rom(snapshot_of(servo, {}))); // not read
  const auto error =
      check_rom(snapshot_of(servo, {warnings}, {{at::fault_warning, rom_unreadable | 1 << 8}}));
  REQUIRE(error);
  CHECK(error->code == Code::mismatch);
  CHECK(error->node_id == 11);
  CHECK(mentions(*error, "ROM"));
}
