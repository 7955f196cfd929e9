#include "blactl/can/silent_replay.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/files/fleet_replay.hpp"

#include "catch.hpp"
#include "unit/fleet/support.hpp"

#include <memory>
#include <set>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
namespace at = blactl::bla::address;

namespace {

/// A file with these entries.
FleetFile fleet_of(const std::string& entries) {
  auto read = parse_fleet_file(R"({"schema":"blactl-fleet/1","servos":[)" + entries + "]}",
                               "fleet.json", profiles());
  REQUIRE(read);
  return std::move(*read);
}

constexpr const char* whole =
    R"({"name":"a","match":{"unique_id":"88ace781674b4cac255e706b7426bd30","serial_number":7},)"
    R"("set":{"servo_id":3,"static_node_id":11,"angle_limit_cw":"45.0deg"},)"
    R"("about":{"model":"BLA21-12U-AB","firmware_version":1400,"hardware_version":12050,)"
    R"("production_date":"2025-06-22 15:30"}})";

} // namespace

TEST_CASE("an entry tells who the servo is and what it holds") {
  const FleetFile file = fleet_of(whole);
  const auto recording = recording_of(file, profiles(), nullptr);
  REQUIRE(recording);
  REQUIRE(recording->servos.size() == 1);
  const auto& [servo, values] = recording->servos.front();
  CHECK(servo.id == NodeId(11));
  CHECK(servo.id_is_known);
  CHECK(servo.is_servo);
  CHECK(servo.unique_id == file.servos.front().match.unique_id);
  CHECK(servo.servo_id == 3);
  CHECK(servo.static_node_id == 11);
  CHECK(servo.identity.model() == "BLA21-12U-AB");
  CHECK(servo.identity.certain());
  CHECK(servo.identity.readings().serial_number == 7);
  CHECK(bla::find(values, at::angle_limit_cw) == 450);
  CHECK(bla::find(values, at::model_number) == model("BLA21-12U-AB").model_number);
  CHECK(bla::find(values, at::firmware_version) == 1400);
  CHECK(bla::find(values, at::production_year) == 2025);
  CHECK(bla::find(values, at::production_minute) == 30);
  CHECK_FALSE(bla::find(values, at::angle_limit_ccw));
}

TEST_CASE("what an entry does not say is not known") {
  const FleetFile file = fleet_of(R"({"name":"a","match":{"serial_number":7}},)"
                                  R"({"name":"b","match":{"servo_id":4,"model":"BLA21-12U-AB"}},)"
                                  R"({"name":"c","match":{"node_id":1}},)"
                                  R"({"name":"d","match":{"model":"BLA21"}})");
  const auto recording = recording_of(file, profiles(), nullptr);
  REQUIRE(recording);
  REQUIRE(recording->of_many.size() == 1);
  CHECK(recording->of_many.front()->name == "d");
  REQUIRE(recording->without_id.size() == 2);
  REQUIRE(recording->servos.size() == 3);
  const Servo& c = recording->servos[0].servo;
  CHECK(c.id == NodeId(1));
  CHECK(c.id_is_known);
  CHECK(c.identity.model().empty());
  CHECK(recording->servos[0].values.empty());
  const Servo& a = recording->servos[1].servo;
  CHECK(a.id == NodeId(2)); // 1 is another's
  CHECK_FALSE(a.id_is_known);
  CHECK_FALSE(a.unique_id);
  CHECK_FALSE(a.servo_id);
  const Servo& b = recording->servos[2].servo;
  CHECK(b.servo_id == 4);
  CHECK(b.identity.model() == "BLA21-12U-AB");
  CHECK_FALSE(b.identity.certain()); // no hardware version
}

TEST_CASE("what the user says of the model counts where the file says nothing else") {
  const FleetFile unknown = fleet_of(R"({"name":"a","match":{"node_id":1}})");
  const auto assumed = recording_of(unknown, profiles(), &model("BLA34-12U-AB"));
  REQUIRE(assumed);
  CHECK(assumed->servos.front().servo.identity.model() == "BLA34-12U-AB");
  const FleetFile file = fleet_of(whole);
  const auto against = recording_of(file, profiles(), &model("BLA34-12U-AB"));
  REQUIRE_FALSE(against);
  CHECK(against.error().code == Code::model_mismatch);
}

TEST_CASE("no two entries have one handle, and there is room for 125") {
  std::string entries;
  for (int serial = 1; serial <= 126; ++serial) {
    entries += (serial == 1 ? "" : ",") +
               fmt::format(R"({{"name":"{0}","match":{{"serial_number":{0}}}}})", serial);
    if (serial == 125) {
      const FleetFile file = fleet_of(entries);
      const auto recording = recording_of(file, profiles(), nullptr);
      REQUIRE(recording);
      std::set<NodeId> ids;
      for (const RecordedServo& servo : recording->servos) {
        ids.insert(servo.servo.id);
      }
      CHECK(ids.size() == 125);
    }
  }
  const FleetFile file = fleet_of(entries);
  const auto recording = recording_of(file, profiles(), nullptr);
  REQUIRE_FALSE(recording);
  CHECK(recording.error().code == Code::bad_file);
}

TEST_CASE("a session on a file answers what it was told, and no number names who has none") {
  const FleetFile file =
      fleet_of(whole + std::string(R"(,{"name":"b","match":{"serial_number":8}})"));
  const auto recording = recording_of(file, profiles(), nullptr);
  REQUIRE(recording);
  auto session = Session::open(std::make_unique<can::SilentReplay>("file:fleet.json"), std::nullopt,
                               Session::Hearing::answers, profiles());
  REQUIRE(session);
  for (const RecordedServo& servo : recording->servos) {
    (*session)->recall(servo);
  }
  ReadJob job((*session)->records(), NodeId(11), profiles(), {},
              registers({"angle_limit_cw", "angle_limit_ccw"}), ReadJob::Proof::none);
  (*session)->start(job);
  REQUIRE((*session)->run());
  REQUIRE_FALSE(job.snapshot().error);
  CHECK(job.snapshot().raw(at::angle_limit_cw) == 450);
  CHECK(job.snapshot().readings[1].raw.error().code == Code::not_recorded);
  Discovery discovery(**session, profiles(), {});
  const auto all = discovery.select({}, 1ms);
  REQUIRE(all);
  CHECK(all->ids.size() == 2);
  const NodeId handle = recording->servos[1].servo.id;
  const auto named = discovery.select(parse_targets(std::to_string(handle.value())).value(), 1ms);
  REQUIRE(named);
  CHECK(named->ids.empty());
  REQUIRE_FALSE(named->errors.empty());
  CHECK(named->errors.front().code == Code::not_recorded);
  const auto by_serial = discovery.select(parse_targets("serial:8").value(), 1ms);
  REQUIRE(by_serial);
  CHECK(by_serial->ids == std::vector{handle});
}
