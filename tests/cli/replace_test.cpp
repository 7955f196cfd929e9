// A broken servo: a new one takes its place, on the bus and in the fleet file.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

constexpr const char* model = "BLA21-12U-AB";
constexpr int broken = 240900002, fresh = 240900777;
constexpr const char* old_uid = "a1b20000000000000000000000000002";

/// As a person writes it: the layout must stay.
const std::string wing = R"({
  "schema": "blactl-fleet/1",
  "common": { "smoothing": "off" },
  "servos": [
    { "name": "left aileron",  "match": {"serial_number": 240900001},
      "set": {"servo_id": 1, "static_node_id": 11, "angle_limit_cw": "45.0deg"}},

    { "name": "right aileron", "match": { "serial_number" : 240900002 },
      "set": {"servo_id": 2, "static_node_id": 12, "angle_limit_cw": "47.0deg"},
      "about": {"production_date": "2024-09-01 10:00", "model": "BLA21-12U-AB"} }
  ]
}
)";

/// The left servo, and beside it one that no entry means.
Scene with(int node_id, const nlohmann::json& more = {}) {
  Scene scene;
  scene.servo(model, 11, {{"serial_number", 240900001}, {"servo_id", 1}});
  nlohmann::json keys = {{"serial_number", fresh}, {"servo_id", 0}};
  keys.update(more.is_null() ? nlohmann::json::object() : more);
  scene.servo(model, node_id, keys);
  return scene;
}

std::string content(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct Place {
  Fleet fleet;
  std::string file = fleet.bench().file("wing.json", wing);

  explicit Place(const Scene& scene) : fleet(scene) {}

  [[nodiscard]] Result replace(const Arguments& more = {}) const {
    Arguments arguments{"replace", file, "right aileron", "-y", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return fleet.run(arguments);
  }
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

} // namespace

TEST_CASE("a new servo that waits for a node ID takes the place of a broken one") {
  const Place place(with(0));
  const Result done = place.replace();
  INFO(done.err);
  REQUIRE(done.status == 0);
  const auto told = json(done.out);
  CHECK(told["command"] == "replace");
  CHECK(told["file"] == place.file);
  REQUIRE(told["nodes"].size() == 1);
  CHECK(told["nodes"][0]["name"] == "right aileron");
  CHECK(told["nodes"][0]["status"] == "changed");
  CHECK(told["nodes"][0]["verified_after_restart"] == true);
  CHECK(told["nodes"][0]["node_id_after"] == 12);
  CHECK(contains(done.err, "takes the place of 'right aileron'"));
  CHECK(contains(done.err, "CAN_D1_UC_OPTION"));
  CHECK(place.fleet.rom("12", "angle_limit_cw") == 470);
  CHECK(place.fleet.ram("12", "servo_id") == 2);
  const std::string now = content(place.file);
  CHECK(contains(now, R"("match": { "serial_number" : 240900777 },)"));
  CHECK(contains(now, R"("model": "BLA21-12U-AB")"));
  CHECK_FALSE(contains(now, "2024-09-01"));
  // apart from that byte for byte
  const std::size_t about = now.find("\"about\""), was = wing.find("\"about\"");
  CHECK(now.substr(0, about) == replaced(wing.substr(0, was), "240900002", "240900777"));
  CHECK(place.fleet.run({"diff", place.file, "-n", "12"}).status == 0);
}

TEST_CASE("a new servo that has just been switched on is waited for until it can have asked") {
  Scene scene = with(0);
  scene.joins(fresh, "700ms");
  const Bench bench;
  const Result done =
      scene.run(bench, {"replace", bench.file("wing.json", wing), "right aileron", "-y"});
  INFO(done.err);
  CHECK(done.status == 0);
}

TEST_CASE("replace repeated after its end changes nothing, and ends well") {
  const Place place(with(33));
  REQUIRE(place.replace().status == 0);
  const Result again = place.replace();
  INFO(again.err);
  CHECK(again.status == 0);
  CHECK(statuses(again) == std::vector<std::string>{"unchanged"});
  CHECK(contains(again.err, "has taken the place of 'right aileron' already"));
}

TEST_CASE("a replacement that ended before its file was written is completed") {
  const Place place(with(33));
  REQUIRE(place.replace().status == 0);
  const std::string named = content(place.file);
  std::ofstream(place.file) << wing; // as if it had been killed before
  const Result again = place.replace();
  INFO(again.err);
  CHECK(again.status == 0);
  CHECK(statuses(again) == std::vector<std::string>{"unchanged"});
  CHECK(content(place.file) == named);
}

TEST_CASE("two runs of replace on one file: the second is refused before it changes a servo") {
  const Place place(with(33));
  const int held = open(place.file.c_str(), O_RDWR | O_CLOEXEC);
  REQUIRE(flock(held, LOCK_EX | LOCK_NB) == 0); // as another run holds it
  check_error(place.replace(), 9, "busy", "another blactl is about to write");
  CHECK(place.replace({"--dry-run"}).status == 8);
  CHECK(place.fleet.ram("33", "servo_id") == 0);
  close(held);
  CHECK(place.replace().status == 0);
}

TEST_CASE("a dry run of replace changes neither servo nor file") {
  Place place(with(33));
  const Result planned = place.replace({"--dry-run"});
  CHECK(planned.status == 8);
  CHECK(content(place.file) == wing);
  CHECK(place.fleet.rom_writes() == 0);
}

TEST_CASE("a dry run of replace tells who waits for a node ID, and whether that is the new one") {
  Place place(with(0));
  const Result unclear = place.replace({"--dry-run"}); // by its serial number it may be the old one
  check_error(unclear, 4, "not_found", "right aileron");
  CHECK(contains(unclear.err, "a unit waits for a node ID: unique ID "));
  CHECK(content(place.file) == wing);
  std::ofstream(place.file) << replaced(wing, R"("serial_number" : 240900002)",
                                        R"("unique_id": "a1b20000000000000000000000000009")");
  const std::string before = content(place.file);
  const Result planned = place.replace({"--dry-run"});
  INFO(planned.err << planned.out);
  CHECK(planned.status == 8);
  CHECK(contains(planned.err, "would get a free one first, and then take the place of 'right ail"));
  CHECK(content(place.file) == before);
  CHECK(place.fleet.rom_writes() == 0);
}

TEST_CASE("a broken servo that still answers is not replaced") {
  Scene scene = with(33);
  scene.servo(model, 12, {{"serial_number", broken}, {"servo_id", 2}});
  Place place(scene);
  for (const Arguments& more : {Arguments{}, Arguments{"-n", "33"}}) {
    check_error(place.replace(more), 9, "several_servos",
                "the servo of 'right aileron' still answers: node 12");
  }
  CHECK(content(place.file) == wing);
  CHECK(place.fleet.rom_writes() == 0);
}

TEST_CASE("a broken servo that only waits for a node ID is there, too, whatever -n says") {
  Scene scene = with(33);
  scene.servo(model, 0, {{"serial_number", broken}, {"servo_id", 2}});
  Place place(scene);
  check_error(place.replace({"-n", "33"}), 9, "several_servos", "still answers");
  CHECK(content(place.file) == wing);
  CHECK(place.fleet.rom_writes() == 0);
}

TEST_CASE("a broken servo that comes back meanwhile is told before the file is written") {
  const auto [node_id, words] =
      GENERATE(std::pair(45, "still answers: node 45"), std::pair(0, "still asks for a node ID"));
  int told = 0;
  for (int at = 1200; at < 3600; at += 300) {
    Scene scene = with(33);
    scene.servo(model, node_id, {{"serial_number", broken}, {"servo_id", 9}});
    scene.joins(broken, std::to_string(at) + "ms");
    const Place place(scene);
    const Result replaced = place.replace();
    INFO(at << ' ' << replaced.err);
    CHECK((content(place.file) != wing) == (replaced.status == 0));
    told += contains(replaced.err, words) ? 1 : 0;
  }
  CHECK(told >= 3);
}

TEST_CASE(
    "a broken servo that comes back on the node ID of the new one is named, and its hint ends it") {
  Scene scene = with(33);
  scene.servo(model, 12, {{"serial_number", broken}, {"servo_id", 2}, {"unique_id", old_uid}});
  scene.joins(broken, "4500ms"); // the new servo has its node ID by then
  const Place place(scene);
  const std::string told = "and by uid:" + std::string(old_uid) +
                           ", as its node ID tells the old servo (serial number 240900002)";
  const Result first = place.replace();
  INFO(first.err);
  check_error(first, 9, "duplicate_node_id", "the servo is done, its file is not: ");
  for (const Arguments& more : {Arguments{}, Arguments{"-n", "33"}, Arguments{"--dry-run"}}) {
    const Result again = place.replace(more);
    INFO(again.err);
    check_error(again, 9, "duplicate_node_id", told);
    CHECK(contains(again.err, "take the old one off the bus"));
  }
  CHECK(content(place.file) == wing);
}

TEST_CASE("the fleet file keeps its mode, and one that is write-protected is refused") {
  const Place place(with(33));
  std::filesystem::permissions(place.file, std::filesystem::perms(0640));
  REQUIRE(place.replace().status == 0);
  CHECK(std::filesystem::status(place.file).permissions() == std::filesystem::perms(0640));
  const std::string named = content(place.file);
  REQUIRE(place.replace().status == 0);
  CHECK(content(place.file) == named); // nothing to change, not even a time
}

TEST_CASE("without a new servo there is nothing to replace the broken one with") {
  Scene scene;
  scene.servo(model, 11, {{"serial_number", 240900001}, {"servo_id", 1}});
  const Place place(scene);
  check_error(place.replace(), 4, "not_found", "no servo for the place of 'right aileron'");
  SECTION("nor where the servo of the entry is the only one left") {
    Scene both = scene;
    both.servo(model, 12, {{"serial_number", broken}, {"servo_id", 2}});
    const Place all(both);
    check_error(all.replace(), 9, "several_servos", "still answers: node 12");
  }
}

TEST_CASE("of two new servos -n says which one is meant") {
  Scene scene = with(33);
  scene.servo(model, 34, {{"serial_number", 240900778}, {"servo_id", 0}});
  const Place place(scene);
  check_error(place.replace(), 9, "several_servos", "2 servos have no entry of");
  check_error(place.replace({"-n", "11"}), 2, "usage",
              "node 11 has an entry of its own: 'left aileron'");
  CHECK(place.replace({"-n", "serial:240900778"}).status == 0);
  CHECK(contains(content(place.file), "\"serial_number\" : 240900778 }"));
}

TEST_CASE("a new servo of another model is refused") {
  Scene scene;
  scene.servo("BLA15-12U-A0", 33, {{"serial_number", fresh}, {"servo_id", 0}});
  Place place(scene);
  check_error(place.replace(), 9, "model_mismatch",
              "node 33 is a BLA15-12U-A0, 'right aileron' is for a BLA21-12U-AB");
  CHECK(place.fleet.rom_writes() == 0);
}

TEST_CASE("an entry that does not name its unit gives its IDs, and the file stays") {
  const Place place(with(33));
  const std::string text = replaced(
      replaced(wing, R"({ "serial_number" : 240900002 })", R"({ "servo_id": 2, "node_id": 12 })"),
      R"("servo_id": 2, "static_node_id": 12, )", "");
  const std::string plain = text.substr(0, text.find(",\n      \"about\"")) + " }\n  ]\n}\n";
  std::ofstream(place.file) << plain;
  const Result done = place.replace();
  INFO(done.err);
  CHECK(done.status == 0);
  CHECK(contains(done.err, "stays as it is"));
  CHECK(content(place.file) == plain);
  CHECK(place.fleet.rom("12", "servo_id") == 2);
  CHECK(place.replace().status == 0);
}

TEST_CASE("what replace cannot write back is refused before anything else") {
  const Place place(with(33));
  check_error(place.fleet.run({"replace", "-", "right aileron", "-y", "--json"}), 2, "usage",
              "it cannot be stdin");
  check_error(place.fleet.run({"replace", "/dev/null", "x", "-y", "--json"}), 2, "usage",
              "/dev/null");
  check_error(place.fleet.run({"replace", place.file, "rudder", "-y", "--json"}), 2, "usage",
              "has no entry 'rudder'");
}

TEST_CASE("apply tells how to replace a servo that is missing") {
  const Place place(with(GENERATE(33, 0)));
  const Result refused = place.fleet.run({"apply", place.file, "-y", "--json"});
  check_error(refused, 4, "not_found", "no servo for 'right aileron'");
  CHECK(contains(refused.err, "blactl replace " + place.file + " 'right aileron'"));
}

TEST_CASE("apply does not take a waiting servo for one that has another unique ID") {
  const Place place(with(0));
  const std::string file = place.fleet.bench().file(
      "one.json", R"({"schema": "blactl-fleet/1", "servos": [{"name": "a", "set": {},
        "match": {"unique_id": "00112233445566778899aabbccddeeff"}}]})");
  const Result refused = place.fleet.run({"apply", file, "-y"});
  CHECK(contains(refused.err, "blactl replace " + file));
  CHECK_FALSE(contains(refused.err, "may be one of them"));
}

TEST_CASE("undo takes back what the new servo got") {
  const Place place(with(33));
  REQUIRE(place.replace().status == 0);
  const Result undone = place.fleet.run({"undo", "-y", "--json"});
  INFO(undone.err);
  CHECK(undone.status == 0);
  CHECK(place.fleet.rom("33", "servo_id") == 0);
}

TEST_CASE("a new servo that has no node ID of its own after its restart is not the broken one") {
  const Fleet fleet(Scene().servo(model, 0, {{"serial_number", fresh}, {"servo_id", 0}}));
  const std::string file =
      fleet.bench().file("wing.json", R"({"schema": "blactl-fleet/1", "servos": [
        {"name": "left", "match": {"servo_id": 1}, "set": {"smoothing": "off"}}]})");
  const Result replaced = fleet.run({"replace", file, "left", "-y"});
  INFO(replaced.out << replaced.err);
  CHECK(replaced.status == 0);
}
