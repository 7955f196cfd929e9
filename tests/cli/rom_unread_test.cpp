// A servo that could not read its ROM runs on initial values, and its ROM may be whole: nothing
// saves over it before a restart was tried, and then only who knows.

#include "catch.hpp"
#include "fleet.hpp"
#include "scene.hpp"

#include <string>
#include <vector>

using namespace blactl::test;

namespace {

/// Its ROM holds 90 deg. So many starts do not read it; then it asks for a node ID, and has got
/// 125.
class Unread {
 public:
  explicit Unread(int starts)
      : fleet(Scene().servo("BLA21-12U-AB", 11,
                            {{"rom", {{"angle_limit_cw", "90deg"}}},
                             {"faults", {{"rom_unread_starts", starts}}}})) {
    REQUIRE(fleet.run({"alloc", "--once"}).status == 0);
  }

  Fleet fleet;
};

constexpr const char* refused =
    "node 125 could not read its ROM at its start: saving would replace all that ROM holds by "
    "initial values\n  the next start may read it: blactl restart -n 125";

} // namespace

TEST_CASE("whatever would save is refused while the ROM was not read, also with every yes") {
  const auto command = GENERATE(Arguments{"save", "-n", "all"},
                                Arguments{"set", "-n", "all", "smoothing=off", "--save"},
                                Arguments{"pwm-config", "-n", "all", "--output", "90deg", "--save"},
                                Arguments{"erase", "-n", "all", "--save", "--keep-ids"},
                                Arguments{"alloc", "--static", "-n", "all"});
  Unread servo(5);
  Arguments agreed = command;
  agreed.insert(agreed.end(), {"-y", "--overwrite-rom"});
  check_error(servo.fleet.run(agreed), 9, "rom_unread", refused);
  CHECK(servo.fleet.rom_writes() == 0);
}

TEST_CASE("apply does not save over a ROM that was not read") {
  Unread servo(5);
  auto document = servo.fleet.exported();
  document["servos"][0]["set"]["angle_limit_cw"] = "45deg";
  const Result applied = servo.fleet.apply(document);
  CHECK(applied.status == 9);
  CHECK(codes(applied) == std::vector<std::string>{"rom_unread"});
  CHECK(servo.fleet.rom_writes() == 0);
}

TEST_CASE("what its ROM holds is not told from what RAM holds") {
  Unread servo(1);
  REQUIRE(servo.fleet.run({"set", "-n", "all", "static_node_id=11", "-y"}).status == 0);
  const Result result = servo.fleet.run({"restart", "-n", "all", "-y"});
  CHECK(result.status == 0);
  CHECK_FALSE(contains(result.err, "static_node_id"));
}

TEST_CASE("what stays in RAM is written, and ERASE of the ROM needs no further word") {
  Unread servo(5);
  CHECK(servo.fleet.run({"set", "-n", "all", "smoothing=off", "-y"}).status == 0);
  CHECK(servo.fleet.run({"erase", "-n", "all", "--save", "-y"}).status == 0);
  CHECK(servo.fleet.rom_writes() == 1);
}

TEST_CASE("the next start reads it: what ROM holds is back, and can be saved") {
  Unread servo(1);
  const Result restarted = servo.fleet.run({"restart", "-n", "all", "-y", "--json"});
  CHECK(restarted.status == 0);
  CHECK_FALSE(contains(restarted.err, "could not read its ROM"));
  CHECK(servo.fleet.ram("11", "angle_limit_cw") == 900);
  CHECK(servo.fleet.run({"set", "-n", "11", "smoothing=off", "--save", "-y"}).status == 0);
}

TEST_CASE("where a restart did not help, --yes is not enough, and --overwrite-rom agrees") {
  Unread servo(5);
  const Result restarted = servo.fleet.run({"restart", "-n", "all", "-y", "--json"});
  CHECK(restarted.status == 0);
  CHECK(contains(restarted.err, "could not read its ROM at its start and holds initial values"));
  CHECK(json(restarted.out)["nodes"][0]["warnings"][0]["code"] == "rom_unread");
  const Arguments save{"save", "-n", "all", "-y"};
  const Result unsure = servo.fleet.run(save);
  CHECK(unsure.status == 7);
  CHECK(contains(unsure.err, "limits, servo ID and node ID among them"));
  CHECK(contains(unsure.err, "add --overwrite-rom to agree beforehand"));
  CHECK(servo.fleet.run({"save", "-n", "all", "-y", "--overwrite-rom"}).status == 0);
  CHECK(servo.fleet.rom_writes() == 1);
}

TEST_CASE("the first start that does not read it is no try yet") {
  const Fleet fleet(
      Scene().servo("BLA21-12U-AB", 11, {{"faults", {{"power_loss_in_save", "10ms"}}}}));
  REQUIRE(fleet.run({"save", "-n", "11", "-y"}).status != 0);
  const Arguments save{"save", "-n", "all", "-y", "--overwrite-rom"};
  CHECK(codes(fleet.run(save)) == std::vector<std::string>{"rom_unread"});
  REQUIRE(fleet.run({"restart", "-n", "all", "-y"}).status == 0);
  CHECK(fleet.run(save).status == 0);
}

TEST_CASE("a restart that was not ours is no try") {
  Unread servo(5);
  REQUIRE(servo.fleet.run({"restart", "-n", "all", "-y"}).status == 0);
  const std::filesystem::path state = servo.fleet.file_name("other");
  const Result saved = servo.fleet.run({"save", "-n", "all", "-y", "--overwrite-rom"},
                                       {.env = {{"BLACTL_STATE_DIR", state.string()}}});
  CHECK(codes(saved) == std::vector<std::string>{"rom_unread"});
}

TEST_CASE("export says that the values are not those of the ROM") {
  const Unread servo(5);
  const Result exported = servo.fleet.run({"export"});
  CHECK(exported.status == 0);
  CHECK(contains(exported.err, "could not read its ROM at its start and holds initial values"));
}

TEST_CASE("the node ID that such a servo may have in its ROM is not given away unseen") {
  const Fleet fleet(
      Scene()
          .servo("BLA21-12U-AB", 11, {{"serial_number", 1}, {"faults", {{"rom_unread_starts", 5}}}})
          .servo("BLA21-12U-AB", 15, {{"serial_number", 2}}));
  REQUIRE(fleet.run({"alloc", "--once"}).status == 0); // 1 has 125
  const Result refused = fleet.run({"set", "-n", "15", "static_node_id=11", "-y"});
  CHECK(codes(refused) == std::vector<std::string>{"rom_unread"});
  CHECK(contains(refused.err, "node 125 may have in its ROM"));
  CHECK(contains(refused.err, "blactl restart -n 125"));
  const Result noted = fleet.run({"set", "-n", "15", "servo_id=9", "-y"});
  CHECK(noted.status == 0);
  CHECK(contains(noted.err, "node 125 could not read its ROM: a conflict with the servo ID"));
}

TEST_CASE("a servo that was proven, and could not read its ROM at a later start, is not done") {
  const std::string at = GENERATE("2500ms", "3s", "4s");
  Scene scene;
  nlohmann::ordered_json entries = nlohmann::ordered_json::array();
  for (const int number : {1, 2}) {
    const nlohmann::json delay = {{"return_delay", number == 2 ? "4s" : "0s"}};
    scene.servo("BLA21-12U-AB", 10 + number, {{"serial_number", number}, {"faults", delay}});
    entries.push_back({{"name", std::to_string(number)},
                       {"match", {{"serial_number", number}}},
                       {"set", {{"angle_limit_cw", "90deg"}}}});
  }
  const Fleet fleet(scene.event(1, "rom_error", at));
  const bool is_apply = GENERATE(false, true);
  const Result result =
      is_apply ? fleet.apply({{"schema", "blactl-fleet/1"}, {"servos", entries}})
               : fleet.run({"set", "-n", "all", "angle_limit_cw=90deg", "--save", "-y", "--json"});
  INFO(at << " " << result.err);
  CHECK(result.status != 0);
  const auto nodes = json(result.out)["nodes"];
  CHECK(nodes[0]["saved"] == false);
  CHECK(nodes[1]["saved"] == true);
}
