#include "blactl/fleet/bus/target.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"

#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using dronecan::GetNodeInfo;
using dronecan::NodeId;

namespace {

const bla::Profiles& profiles() {
  return blactl::test::built_in();
}

const bla::Profile& model(std::string_view name) {
  return *profiles().matching(name).front();
}

std::vector<int> ids(std::string_view list) {
  const auto targets = parse_targets(list);
  REQUIRE(targets);
  std::vector<int> out;
  for (const NodeId id : targets->ids) {
    out.push_back(id.value());
  }
  return out;
}

using Ids = std::vector<int>;

Member servo(std::uint8_t id) {
  Member member;
  member.id = NodeId(id);
  member.identified = member.is_servo = true;
  member.info = GetNodeInfo::Response{};
  member.info->unique_id = {0x00, 0x11, 0x22, 0xAB};
  member.servo_id = 3;
  member.identity = bla::Identity(profiles(), {model("BLA21-12U-AB").model_number, 240900558, 1400,
                                               model("BLA21-12U-AB").hardware_version});
  return member;
}

bool means(std::string_view list, const Member& member) {
  const auto targets = parse_targets(list);
  REQUIRE(targets);
  return targets->mean(member, profiles());
}

} // namespace

TEST_CASE("IDs and ranges, ascending and each once") {
  CHECK(ids("12") == Ids{12});
  CHECK(ids("20,10-14") == Ids{10, 11, 12, 13, 14, 20});
  CHECK(ids("12,12,11-13") == Ids{11, 12, 13});
  CHECK(ids("7-7") == Ids{7});
  CHECK(ids("1-127").size() == 127);
}

TEST_CASE("IDs alone need no search of the bus") {
  CHECK_FALSE(parse_targets("12,14-15")->need_search());
  CHECK(parse_targets("12")->given);
  CHECK(parse_targets("all")->need_search());
  CHECK(parse_targets("12,servo:1")->need_search());
  CHECK(Targets{}.need_search());
  CHECK_FALSE(Targets{}.given);
}

TEST_CASE("what is no target is refused with examples") {
  const auto list =
      GENERATE(as<std::string>{}, "", ",", "12,", ",12", "12,,13", "-1", "+1", " 12", "12 ", "12-",
               "-12", "10--12", "1e1", "0x0C", "1.5", "nan", "uid:", "uid:00g1",
               "uid:00112233445566778899aabbccddeefg", "serial:", "serial:x", "serial:-5",
               "serial: 5", "serial:0x10", "serial:99999999999999999999", "servo:", "servo:1.5",
               "model:", "name:x", "12:5", ":", "uid", "node_id:12", "１２");
  INFO(list);
  const auto targets = parse_targets(list);
  REQUIRE_FALSE(targets);
  CHECK(targets.error().code == Code::usage);
  CHECK(targets.error().hint.find("serial:240900558") != std::string::npos);
}

TEST_CASE("a number that is no node ID is refused with what node IDs are") {
  for (const char* list : {"0", "128", "256", "4294967308", "5,128", "10-128", "0-5", "000"}) {
    INFO(list);
    const auto targets = parse_targets(list);
    REQUIRE_FALSE(targets);
    CHECK(targets.error().code == Code::usage);
    CHECK(targets.error().message.find("node IDs are 1 to 127") != std::string::npos);
  }
  CHECK(parse_targets("0").error().message == "-n 0: node IDs are 1 to 127");
  CHECK(parse_targets("14-10").error().hint == "type -n 10-14");
}

TEST_CASE("a foreign target cannot write to the terminal") {
  CHECK(parse_targets("\x1b[2J").error().message.find('\x1b') == std::string::npos);
}

TEST_CASE("a servo is meant by its ID, unique ID, serial number, servo ID and model",
          "[requirement-177]") {
  const Member member = servo(11);
  for (const char* list : {"11",
                           "10-12",
                           "5,11",
                           "all",
                           "uid:001122ab000000000000000000000000",
                           "unique_id:001122AB000000000000000000000000",
                           "serial:240900558",
                           "serial_number:240900558",
                           "servo:3",
                           "servo_id:3",
                           "model:BLA21-12U-AB",
                           "model:BLA21",
                           "model:bla21-12u",
                           "model:BLA21-12U-AB2",
                           "5,servo:3",
                           "ALL",
                           "All",
                           "SERIAL:240900558",
                           "Servo_ID:3",
                           "MODEL:BLA21",
                           "uid:0",
                           "UID:001122Ab",
                           "uid:001122ab00000000000000000000000"}) {
    INFO(list);
    CHECK(means(list, member));
  }
  for (const char* list :
       {"12", "10,12-20", "uid:001122ab000000000000000000000001", "serial:240900559", "servo:4",
        "servo:11", "model:BLA34", "model:BLA21-28U", "model:XY", "uid:1", "uid:001123"}) {
    INFO(list);
    CHECK_FALSE(means(list, member));
  }
}

TEST_CASE("without -n every servo that was identified is meant, and nothing else") {
  Member member = servo(11);
  CHECK(Targets{}.mean(member, profiles()));
  member.is_servo = false;
  CHECK_FALSE(Targets{}.mean(member, profiles()));
  CHECK_FALSE(means("all", member));
  CHECK(means("11", member)); // asked for by its ID, whatever it is
}

TEST_CASE("a servo that restarted since is meant by its ID only") {
  Member member = servo(11);
  ++member.boots;
  CHECK_FALSE(means("serial:240900558", member));
  CHECK_FALSE(means("all", member));
  CHECK(means("11", member));
}

TEST_CASE("a selector never picks a model by a guess") {
  Member member = servo(11);
  // 0x53 of no known class: BLA21 for sure, the rest is open.
  member.identity =
      bla::Identity(profiles(), {model("BLA21-12U-AB").model_number, 1, 1400, 99'999});
  CHECK_FALSE(means("model:BLA21-12U", member));
}

TEST_CASE("the beginning of a unique ID, or a serial number, must mean one unit") {
  Roster roster(NodeId(127), profiles());
  for (const std::uint8_t id : {std::uint8_t{11}, std::uint8_t{12}}) {
    Member member = servo(id);
    member.info->unique_id[15] = id;
    roster.learn(NodeId(id), *member.info, Time{});
    roster.learn(member.servo(), member.info);
  }
  const auto ambiguity = [&](std::string_view list) {
    return parse_targets(list)->ambiguity(roster, profiles());
  };
  const auto error = ambiguity("uid:0011");
  REQUIRE(error);
  CHECK(error->code == Code::usage);
  CHECK(error->message == "-n uid:0011: several servos have a unique ID that begins so: "
                          "001122ab00000000000000000000000b (11), "
                          "001122ab00000000000000000000000c (12)");
  CHECK_FALSE(ambiguity("uid:001122ab00000000000000000000000b"));
  CHECK_FALSE(ambiguity("uid:ff"));
  const auto serial = ambiguity("serial:240900558");
  REQUIRE(serial);
  CHECK(serial->code == Code::usage);
  CHECK(serial->message == "-n serial:240900558: several servos have this serial number: "
                           "001122ab00000000000000000000000b (11), "
                           "001122ab00000000000000000000000c (12)");
  CHECK(serial->hint == "say which: -n 11");
  CHECK_FALSE(ambiguity("serial:240900559"));
  CHECK_FALSE(ambiguity("model:BLA21"));
}
