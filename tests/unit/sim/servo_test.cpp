#include "blactl/sim/servo/servo.hpp"

#include "unit/sim/servo_rig.hpp"

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using dronecan::GetSet;
using testing::bla21;
using testing::failed;
using testing::frame;
using testing::Frames;
using testing::only;
using testing::Rig;
using testing::servo_setup;

namespace {

using Numbers = std::initializer_list<std::uint8_t>;

} // namespace

TEST_CASE("requirements 66, 70: a read is answered with the value and the name, 16 bytes",
          "[requirement-66][requirement-70]") {
  Rig rig(bla21);
  CHECK(rig.bench.ask({frame("1E0B8BFF#000030783338C5")}) ==
        Frames{"1E0B7F8B#6D4C010707000085", "1E0B7F8B#0000000000000025", "1E0B7F8B#3078333845"});
}

TEST_CASE("requirement 84: negative values are sign-extended to 64 bits", "[requirement-84]") {
  Rig rig(bla21);
  CHECK(rig.bench.ask({frame("1E0B8BFF#000030783339C5")}) ==
        Frames{"1E0B7F8B#FEF601F8F8FFFF85", "1E0B7F8B#FFFFFFFF00000025", "1E0B7F8B#3078333945"});
}

TEST_CASE("requirement 70: a write is answered with the value that is true afterwards",
          "[requirement-70]") {
  Rig rig(bla21);
  CHECK(rig.bench.ask({frame("1E0B8BFF#B477000184030086"), frame("1E0B8BFF#0000000000307826"),
                       frame("1E0B8BFF#333846")}) ==
        Frames{"1E0B7F8B#FF06018403000086", "1E0B7F8B#0000000000000026", "1E0B7F8B#3078333846"});
  CHECK(rig.servo.registers().value(bla::address::angle_limit_cw) == 900);
}

TEST_CASE("requirement 78: the answer to a value out of range has the old value",
          "[requirement-78][unproven]") {
  Rig rig(bla21);
  const auto response = rig.answered(rig.get_set(0, std::int64_t{-5}, "0x38"));
  CHECK(response.value == GetSet::Value(std::int64_t{1799}));
}

TEST_CASE("requirements 71, 74: a failure is tag 0 without a name, 4 bytes",
          "[requirement-71][requirement-74][unproven]") {
  Rig rig(bla21);
  CHECK(rig.bench.ask({frame("1E0B8BFF#000030783033C5")}) == Frames{"1E0B7F8B#00000000C5"});
}

TEST_CASE("requirements 71, 78: a refused value may be answered with that failure",
          "[requirement-71][requirement-78][unproven]") {
  Rig rig(bla21 + std::string(R"(, "behaviour": {"out_of_range": "fail"})"));
  const auto failure = rig.get_set(0, std::int64_t{-5}, "0x38");
  REQUIRE(failure.size() == 1);
  CHECK(failure.front().starts_with("1E0B7F8B#00000000"));
  CHECK(failure.front().size() == std::string("1E0B7F8B#00000000C5").size());
  CHECK(rig.read("0x38") == 1799);
  CHECK(rig.write("0x38", 900) == 900);
}

TEST_CASE("a servo may send the name with a failure") {
  Rig rig(bla21 + std::string(R"(, "behaviour": {"failure_with_name": true})"));
  const auto response = rig.answered(rig.get_set(0, {}, "0x03"));
  CHECK(failed(response));
  CHECK(response.name == "0x03");
}

TEST_CASE("requirement 67: the name is 0x and two upper-case hexadecimal digits, nothing else",
          "[requirement-67]") {
  Rig rig(bla21);
  CHECK_FALSE(failed(rig.answered(rig.get_set(0, {}, "0x2A"))));
  for (const char* wrong :
       {"0x2a", "0X2A", "2A", "0x2A ", "0x002A", "0x+1", "0x2", "0xGG", "\xff"}) {
    INFO(wrong);
    CHECK(failed(rig.answered(rig.get_set(0, {}, wrong))));
  }
}

TEST_CASE("requirement 69: a name wins over an index, an index alone is an address",
          "[requirement-69][unproven]") {
  Rig rig(bla21);
  CHECK(rig.answered(rig.get_set(0x39, {}, "0x38")).name == "0x38");
  const auto by_index = rig.answered(rig.get_set(0x38, {}, ""));
  CHECK(by_index.name == "0x38");
  CHECK(by_index.value == GetSet::Value(std::int64_t{1799}));
  CHECK(failed(rig.answered(rig.get_set(0x138, {}, "")))); // 13 bits, not 8
  Rig without(bla21 + std::string(R"(, "behaviour": {"index_only_access": false})"));
  CHECK(failed(without.answered(without.get_set(0x38, {}, ""))));
  CHECK_FALSE(failed(without.answered(without.get_set(0, {}, "0x38"))));
}

TEST_CASE("requirement 75: reals, booleans and strings are refused", "[requirement-75]") {
  Rig rig(bla21);
  for (const GetSet::Value& value :
       {GetSet::Value(900.0F), GetSet::Value(true), GetSet::Value(std::string("900"))}) {
    CHECK(failed(rig.answered(rig.get_set(0, value, "0x38"))));
  }
  CHECK(rig.servo.registers().value(bla::address::angle_limit_cw) == 1799);
}

TEST_CASE("requirement 8: unlisted services get no answer", "[requirement-8]") {
  Rig rig(bla21);
  CHECK(rig.bench.ask({frame("1E048BFF#C1")}).empty()); // GetTransportStats
  CHECK(rig.bench.ask({frame("1E288BFF#00C1")}).empty());
}

TEST_CASE("requests for other nodes and repeated transfer IDs are not answered") {
  Rig rig(bla21);
  CHECK(rig.bench.ask({frame("1E0B8CFF#000030783338C5")}).empty());
  CHECK(rig.bench.ask({frame("1E0B8BFF#000030783338C5")}).size() == 3);
  CHECK(rig.bench.ask({frame("1E0B8BFF#000030783338C5")}).empty());
  CHECK(rig.bench.ask({frame("1E0B8BFF#000030783338C6")}).size() == 3);
  rig.bench.run(3s);
  CHECK(rig.bench.ask({frame("1E0B8BFF#000030783338C6")}).size() == 3); // forgotten after 2 s
}

TEST_CASE("requirement 11: a write with a bad CRC is dropped", "[requirement-11]") {
  Rig rig(bla21);
  CHECK(rig.bench
            .ask({frame("1E0B8BFF#B577000184030086"), frame("1E0B8BFF#0000000000307826"),
                  frame("1E0B8BFF#333846")})
            .empty());
  CHECK(rig.servo.registers().value(bla::address::angle_limit_cw) == 1799);
}

TEST_CASE("requirements 15, 16: GetNodeInfo, with and without the stray byte of table 2-5",
          "[requirement-15][requirement-16]") {
  Rig rig(bla21);
  rig.bench.run(2s);
  const Frames info{
      "1E017F8B#0AA1020000000082", "1E017F8B#0000012800000022", "1E017F8B#0000000000000002",
      "1E017F8B#0000000C05001122", "1E017F8B#2233445566778802", "1E017F8B#99AABBCCDDEEFF22",
      "1E017F8B#006A702E636F2E02", "1E017F8B#6675746162612E22", "1E017F8B#626C61323142"};
  CHECK(rig.bench.ask({frame("1E018BFF#C2")}) == info);
  rig.bench.ask({frame("1E018BFF#C1")});
  CHECK(rig.bench.ask({frame("1E018BFF#00C2")}) == info);
}

TEST_CASE("requirements 3, 17, 24: NodeStatus every second at priority 16, with the uptime",
          "[requirement-3][requirement-17][requirement-24]") {
  Rig rig(bla21, 0ms);
  const auto statuses = only(rig.bench.run(3400ms), dronecan::NodeStatus::type.id);
  REQUIRE(statuses.size() == 4);
  CHECK(testing::text(statuses[0]) == "1001550B#00000000000000C0");
  CHECK(testing::text(statuses[3]) == "1001550B#03000000000000C3");
}

TEST_CASE("requirements 21, 22: health follows the warning and failure bits, failure first",
          "[requirement-21][requirement-22]") {
  const auto first_status = [](const char* ram) {
    Rig rig(bla21 + fmt::format(R"(, "ram": {{{}}})", ram));
    return only(rig.heard, dronecan::NodeStatus::type.id).at(0).data[4] >> 6U;
  };
  CHECK(first_status(R"("fault_notice": 256)") == 0);
  CHECK(first_status(R"("fault_warning": 2048)") == 1);
  CHECK(first_status(R"("fault_failure": 1)") == 2);
  CHECK(first_status(R"("fault_warning": 2048, "fault_failure": 1)") == 2);
}

TEST_CASE("requirements 4, 108: actuator.Status every 100 ms, degrees / 100, the rest unused",
          "[requirement-4][requirement-108]") {
  Rig rig(bla21 + std::string(R"(, "ram": {"current_angle": "45deg"})"), 0ms);
  const auto frames = only(rig.bench.run(1150ms), dronecan::ActuatorStatus::type.id);
  REQUIRE(frames.size() == 2 * 11); // it boots in 50 to 150 ms
  CHECK(testing::text(frames[0]) == "1003F30B#888F013337FF7F80");
  CHECK(testing::text(frames[1]) == "1003F30B#FF7F7F60");
}

TEST_CASE("requirement 178: a changed 0x46 has no effect while the servo runs",
          "[requirement-178]") {
  Rig rig(bla21);
  CHECK_FALSE(failed(rig.answered(rig.get_set(0, std::int64_t{40}, "0x46"))));
  CHECK(rig.servo.node_id() == dronecan::NodeId(11));
  CHECK(rig.answered(rig.get_set(0, {}, "0x46")).value == GetSet::Value(std::int64_t{40}));
}

TEST_CASE("requirement 95: serial number, firmware and hardware are those of the setup",
          "[requirement-95]") {
  Rig rig(bla21 + std::string(R"(, "serial_number": 240900558, "firmware_version": 1300,
                                   "hardware_version": 12345, "model_number": 99)"));
  const auto value = [&](const char* name) {
    return std::get<std::int64_t>(rig.answered(rig.get_set(0, {}, name)).value);
  };
  CHECK(value("0x50") == 99);
  CHECK(value("0x51") == 240900558);
  CHECK(value("0x52") == 1300);
  CHECK(value("0x53") == 12345);
}

TEST_CASE("answers come after the answer delay, one after the other") {
  Rig rig(R"("model": "BLA15-06U-A0", "node_id": 11, "answer_delay": "2ms")");
  const auto request = frame("1E0B8BFF#000030783338C5");
  CHECK(rig.bench.ask({request}, 1900us).empty());
  CHECK(rig.bench.ask({}, 200us).size() == 3);
}

TEST_CASE("the first answers can be lost, and a mute servo never answers") {
  Rig rig(bla21 + std::string(R"(, "faults": {"lose_responses": 2})"));
  CHECK(rig.get_set(0, {}, "0x38").empty());
  CHECK(rig.get_set(0, {}, "0x38").empty());
  CHECK(rig.get_set(0, {}, "0x38").size() == 3);
  Rig mute(bla21 + std::string(R"(, "faults": {"mute": true})"));
  CHECK(mute.get_set(0, std::int64_t{900}, "0x38").empty());
  CHECK(mute.servo.registers().value(bla::address::angle_limit_cw) == 900); // it did hear
  CHECK_FALSE(only(mute.heard, dronecan::ActuatorStatus::type.id).empty());
}

TEST_CASE("requirements 27, 30: without a static ID the servo asks, anonymously, at priority 24",
          "[requirement-27][requirement-30]") {
  Rig rig(R"("model": "BLA21-12U-AB", "unique_id": "00112233445566778899AABBCCDDEEFF")", 0ms);
  const auto frames = rig.bench.run(1200ms);
  REQUIRE(frames.size() == 1);
  const auto header = dronecan::decode_id(frames[0].id);
  REQUIRE(header);
  CHECK(header->priority == 24);
  CHECK(header->source == dronecan::anonymous);
  CHECK(header->data_type_id == dronecan::Allocation::type.id);
  CHECK(testing::text(frames[0]).substr(8) == "#01001122334455C0");
}

TEST_CASE("requirement 28: until an ID is assigned nothing else works", "[requirement-28]") {
  Rig rig(R"("model": "BLA21-12U-AB")", 0ms);
  for (std::uint8_t id = 1; id < 127; ++id) {
    const can::Frame info =
        testing::request(dronecan::GetNodeInfo::type, dronecan::GetNodeInfo::Request{}, id, 0)
            .front();
    CHECK(rig.bench.ask({info}).empty());
  }
  for (const can::Frame& one : rig.bench.run(5s)) {
    CHECK(dronecan::decode_id(one.id)->source == dronecan::anonymous);
  }
}

TEST_CASE("requirements 35, 39, 40: the third answer assigns the ID, which 0x46 does not keep",
          "[requirement-35][requirement-39][requirement-40]") {
  Rig rig(R"("model": "BLA21-12U-AB", "answer_delay": 0,
             "unique_id": "00112233445566778899aabbccddeeff")",
          0ms);
  dronecan::TransferId id = 0;
  for (const std::uint8_t size : Numbers{6, 12, 16}) {
    while (rig.bench.run(1ms).empty()) {
    }
    dronecan::Allocation answer;
    answer.node_id = size == 16 ? 125 : 0;
    answer.size = size;
    answer.unique_id = servo_setup(R"("model": "BLA21-12U-AB",
        "unique_id": "00112233445566778899aabbccddeeff")")
                           .unique_id;
    const dronecan::Header header{dronecan::Kind::message, 24, dronecan::Allocation::type.id,
                                  dronecan::NodeId(127),   {}, 0};
    rig.bench.deliver(dronecan::segment(header, id++, dronecan::Allocation::type.signature,
                                        answer.encode().bytes()));
  }
  CHECK(rig.servo.node_id() == dronecan::NodeId(125));
  const auto frames = rig.bench.run(100ms);
  REQUIRE_FALSE(only(frames, dronecan::NodeStatus::type.id).empty());
  CHECK((only(frames, dronecan::NodeStatus::type.id)[0].data[4] >> 3U & 7U) == 0);
  CHECK_FALSE(only(frames, dronecan::ActuatorStatus::type.id).empty());
  CHECK(rig.answered(rig.get_set(0, {}, "0x46")).value == GetSet::Value(std::int64_t{0}));
}
