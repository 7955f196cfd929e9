#include "catch.hpp"
#include "fields.hpp"
#include "support.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

using namespace blactl;
using namespace blactl::dronecan;
using namespace blactl::dronecan::test;

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

template <class Type> std::string encoded(const Type& value) {
  return hex(value.encode().bytes());
}

template <class Type> std::optional<Type> decoded(std::string_view payload) {
  return Type::decode(unhex(payload));
}

/// Each payload that is cut short of `size` is refused, and what follows it does not matter.
template <class Type> void check_length(const Type& value, std::size_t size) {
  const auto payload = value.encode();
  REQUIRE(payload.bytes().size() >= size);
  for (std::size_t n = 0; n < size; ++n) {
    CHECK_FALSE(Type::decode(payload.bytes().first(n)));
  }
  CHECK(Type::decode(payload.bytes()) == value);
}

template <class Type> void check_trailing(const Type& value) {
  auto payload = value.encode();
  payload.append(unhex("DEADBEEF"));
  CHECK(Type::decode(payload.bytes()) == value);
}

const GetNodeInfo::Response info{
    .status = {.uptime_s = 1,
               .health = Health::error,
               .mode = Mode::maintenance,
               .sub_mode = 5,
               .vendor_status = 0x1234},
    .software_major = 1,
    .software_minor = 2,
    .optional_field_flags = 3,
    .vcs_commit = 0x01020304,
    .image_crc = 0x0102030405060708,
    .hardware_major = 4,
    .hardware_minor = 5,
    .unique_id = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16},
    .certificate = {0xAA, 0xBB},
    .name = "jp.futaba.bla"};

/// Decodes random bytes; what is accepted must be encoded and decoded to the same again.
template <class Type> void fuzz() {
  std::mt19937 random(3);
  std::uniform_int_distribution<unsigned> byte(0, 255);
  std::size_t accepted = 0;
  for (std::size_t round = 0; round < 20'000; ++round) {
    std::vector<std::uint8_t> bytes(round % 450);
    for (auto& each : bytes) {
      each = static_cast<std::uint8_t>(round % 3 == 0 ? byte(random) & 0x04 : byte(random));
    }
    if (const auto value = Type::decode(bytes)) {
      ++accepted;
      const auto once = value->encode();
      const auto again = Type::decode(once.bytes());
      REQUIRE(again);
      // By its payload: a NaN is not equal to itself.
      REQUIRE(hex(again->encode().bytes()) == hex(once.bytes()));
    }
  }
  CHECK(accepted > 0);
}

} // namespace

TEST_CASE("any bytes are decoded or refused", "[requirement-19]") {
  SECTION("NodeStatus") {
    fuzz<NodeStatus>();
  }
  SECTION("GetNodeInfo request") {
    fuzz<GetNodeInfo::Request>();
  }
  SECTION("GetNodeInfo response") {
    fuzz<GetNodeInfo::Response>();
  }
  SECTION("Allocation") {
    fuzz<Allocation>();
  }
  SECTION("RestartNode request") {
    fuzz<RestartNode::Request>();
  }
  SECTION("RestartNode response") {
    fuzz<RestartNode::Response>();
  }
  SECTION("ExecuteOpcode request") {
    fuzz<ExecuteOpcode::Request>();
  }
  SECTION("ExecuteOpcode response") {
    fuzz<ExecuteOpcode::Response>();
  }
  SECTION("GetSet request") {
    fuzz<GetSet::Request>();
  }
  SECTION("GetSet response") {
    fuzz<GetSet::Response>();
  }
  SECTION("ArrayCommand") {
    fuzz<ArrayCommand>();
  }
  SECTION("ActuatorStatus") {
    fuzz<ActuatorStatus>();
  }
  SECTION("ArmingStatus") {
    fuzz<ArmingStatus>();
  }
}

TEST_CASE("a payload that is too short is refused") {
  check_length(info.status, 7);
  check_length(info, 43);
  check_length(Allocation{.node_id = 3}, 1);
  check_length(RestartNode::Request{}, 5);
  check_length(RestartNode::Response{.ok = true}, 1);
  check_length(ExecuteOpcode::Request{.opcode = ExecuteOpcode::erase, .argument = -2}, 7);
  check_length(ExecuteOpcode::Response{.argument = -2, .ok = true}, 7);
  check_length(GetSet::Request{.index = 300, .value = std::int64_t{-7}, .name = {}}, 10);
  check_length(GetSet::Request{.index = 1, .value = std::string("text"), .name = {}}, 7);
  check_length(GetSet::Response{.value = 1.5F,
                                .default_value = true,
                                .max_value = std::int64_t{5},
                                .min_value = -2.5F,
                                .name = {}},
               5 + 2 + 9 + 5);
  check_length(ActuatorStatus{.actuator_id = 1, .position = 0.5F}, 8);
  check_length(ArmingStatus{.status = ArmingStatus::fully_armed}, 1);
}

TEST_CASE("bytes behind the last field are ignored") {
  check_trailing(info.status);
  check_trailing(RestartNode::Request{});
  check_trailing(RestartNode::Response{.ok = true});
  check_trailing(ExecuteOpcode::Request{.argument = 77});
  check_trailing(ExecuteOpcode::Response{.argument = 77, .ok = true});
  check_trailing(ActuatorStatus{.actuator_id = 9, .speed = -1});
  check_trailing(ArmingStatus{.status = 255});
}

TEST_CASE("a GetNodeInfo request may have the byte that Futaba prints") {
  CHECK(GetNodeInfo::Request::decode({}));
  CHECK(decoded<GetNodeInfo::Request>("00"));
}

TEST_CASE("the bits of a NodeStatus fill their byte from the top", "[requirement-10]") {
  const NodeStatus status{.uptime_s = 0x04030201,
                          .health = Health::critical,
                          .mode = Mode::software_update,
                          .sub_mode = 1,
                          .vendor_status = 0xBBAA};
  CHECK(encoded(status) == "01020304D9AABB");
  CHECK(NodeStatus::decode(unhex("01020304D9AABB")) == status);
}

TEST_CASE("a reserved mode passes unchanged") {
  const auto status = decoded<NodeStatus>("00000000280000");
  REQUIRE(status);
  CHECK(std::to_underlying(status->mode) == 5);
  CHECK(encoded(*status) == "00000000280000");
}

TEST_CASE("node information keeps certificate and name apart") {
  CHECK(GetNodeInfo::Response::decode(info.encode().bytes()) == info);
  GetNodeInfo::Response largest = info;
  largest.certificate.assign(255, 0xCC);
  largest.name.assign(80, 'n');
  CHECK(largest.encode().bytes().size() == 376);
  CHECK(GetNodeInfo::Response::decode(largest.encode().bytes()) == largest);
}

TEST_CASE("fields that a servo does not use may hold anything", "[requirement-18]") {
  for (const std::uint8_t filling : std::to_array<std::uint8_t>({0x00, 0x5A, 0xFF})) {
    GetNodeInfo::Response servo = info;
    servo.certificate.clear(); // its length is a field in use
    auto bytes = unhex(encoded(servo));
    bytes[4] = static_cast<std::uint8_t>((bytes[4] & 0xF8U) | (filling & 0x07U)); // sub_mode
    std::fill(bytes.begin() + 5, bytes.begin() + 7, filling);                     // vendor status
    std::fill(bytes.begin() + 9, bytes.begin() + 22, filling); // flags, VCS commit, image CRC
    const auto read = GetNodeInfo::Response::decode(bytes);
    REQUIRE(read);
    CHECK(read->status.uptime_s == 1);
    CHECK(read->status.health == Health::error);
    CHECK(read->status.mode == Mode::maintenance);
    CHECK(read->software_major == 1);
    CHECK(read->software_minor == 2);
    CHECK(read->hardware_major == 4);
    CHECK(read->hardware_minor == 5);
    CHECK(read->unique_id == info.unique_id);
    CHECK(read->name == info.name);
  }
}

TEST_CASE("a certificate that says it is longer than the payload is refused") {
  auto bytes = unhex(encoded(info));
  bytes[40] = 200;
  CHECK_FALSE(GetNodeInfo::Response::decode(bytes));
}

TEST_CASE("arrays beyond their limit are refused", "[requirement-19]") {
  const auto long_name = [](std::string_view head, std::size_t size) {
    auto bytes = unhex(head);
    bytes.insert(bytes.end(), size, 'n');
    return bytes;
  };
  CHECK(GetSet::Request::decode(long_name("0000", 92)));
  CHECK_FALSE(GetSet::Request::decode(long_name("0000", 93)));
  CHECK(GetSet::Response::decode(long_name("00000000", 92)));
  CHECK_FALSE(GetSet::Response::decode(long_name("00000000", 93)));
  CHECK(Allocation::decode(long_name("00", 16)));
  CHECK_FALSE(Allocation::decode(long_name("00", 17)));
  CHECK(ArrayCommand::decode(long_name("", 60)));
  CHECK_FALSE(ArrayCommand::decode(long_name("", 64)));
  CHECK(GetSet::Request::decode(long_name("000480", 128)));
  CHECK_FALSE(GetSet::Request::decode(long_name("000481", 129)));
  auto info_with_long_name = unhex(encoded(GetNodeInfo::Response{}));
  info_with_long_name.insert(info_with_long_name.end(), 81, 'n');
  CHECK_FALSE(GetNodeInfo::Response::decode(info_with_long_name));
}

TEST_CASE("arrays beyond their limit are cut when they are sent") {
  const std::string text(300, 'x');
  const GetSet::Request request{.index = 0, .value = text, .name = text};
  CHECK(request.encode().bytes().size() == 2 + 1 + 128 + 92);
  const auto back = GetSet::Request::decode(request.encode().bytes());
  REQUIRE(back);
  CHECK(back->value == GetSet::Value(std::string(128, 'x')));
  CHECK(back->name == std::string(92, 'x'));
  CHECK(GetNodeInfo::Response{.name = text}.encode().bytes().size() == 41 + 80);
  CHECK(ArrayCommand{.commands = std::vector<ArrayCommand::Command>(20)}.encode().bytes().size() ==
        60);
}

TEST_CASE("integers too large for their field are saturated") {
  CHECK(encoded(GetSet::Request{.index = 0xFFFF, .value = {}, .name = {}}) == "FFF8");
  CHECK(encoded(Allocation{.node_id = 255, .size = 255}).substr(0, 2) == "FE");
  CHECK(Allocation{.size = 255}.encode().bytes().size() == 17);
  CHECK(encoded(RestartNode::Request{.magic_number = UINT64_MAX}) == "FFFFFFFFFF");
  CHECK(encoded(ExecuteOpcode::Request{.argument = INT64_MAX}) == "00FFFFFFFFFF7F");
  CHECK(encoded(ExecuteOpcode::Request{.argument = INT64_MIN}) == "00000000000080");
  CHECK(encoded(ActuatorStatus{.power_rating_pct = 200}) == "000000000000007F");
  CHECK(encoded(NodeStatus{.sub_mode = 200}) == "00000000070000");
}

TEST_CASE("signed integers keep their sign") {
  for (const std::int64_t value : {std::int64_t{0}, std::int64_t{-1}, INT64_MIN, INT64_MAX}) {
    const GetSet::Request request{.index = 0, .value = value, .name = "n"};
    CHECK(GetSet::Request::decode(request.encode().bytes()) == request);
  }
  const std::int64_t edge = 0x7FFF'FFFF'FFFF;
  for (const auto value : {edge, -edge - 1}) {
    const ExecuteOpcode::Response response{.argument = value, .ok = true};
    CHECK(ExecuteOpcode::Response::decode(response.encode().bytes()) == response);
  }
}

TEST_CASE("every kind of value survives") {
  using Value = GetSet::Value;
  for (const auto& value :
       {Value(), Value(std::int64_t{-5}), Value(0.1F), Value(true), Value(false),
        Value(std::string()), Value(std::string("\0\xFF\n", 3))}) {
    const GetSet::Response response{.value = value,
                                    .default_value = value,
                                    .max_value = std::int64_t{1},
                                    .min_value = 2.0F,
                                    .name = "\x1B[31m"};
    CHECK(GetSet::Response::decode(response.encode().bytes()) == response);
  }
}

TEST_CASE("a boolean is any byte but 0") {
  const auto request = decoded<GetSet::Request>("000302");
  REQUIRE(request);
  CHECK(request->value == GetSet::Value(true));
  CHECK(encoded(*request) == "000301");
}

TEST_CASE("a tag that no value has is refused") {
  CHECK_FALSE(decoded<GetSet::Request>("0005"));
  CHECK_FALSE(decoded<GetSet::Request>("0007"));
  CHECK_FALSE(decoded<GetSet::Response>("05000000"));
  CHECK_FALSE(decoded<GetSet::Response>("00060000"));
  CHECK_FALSE(decoded<GetSet::Response>("00000300"));
  CHECK_FALSE(decoded<GetSet::Response>("00000003"));
}

TEST_CASE("padding before a tag is ignored") {
  CHECK(decoded<GetSet::Response>("F8F8FCFC") == GetSet::Response{});
}

TEST_CASE("an answer may refuse with a name or without") {
  CHECK(decoded<GetSet::Response>("00000000") == GetSet::Response{});
  const auto named = decoded<GetSet::Response>("0000000030783038");
  REQUIRE(named);
  CHECK(named->name == "0x08");
  CHECK(named->value == GetSet::Value());
}

TEST_CASE("the maximum comes before the minimum") {
  const auto response = decoded<GetSet::Response>("0000010100000000000000010200000000000000");
  REQUIRE(response);
  CHECK(response->max_value == GetSet::NumericValue(std::int64_t{1}));
  CHECK(response->min_value == GetSet::NumericValue(std::int64_t{2}));
}

TEST_CASE("commands with a part of a command are refused") {
  CHECK(decoded<ArrayCommand>("") == ArrayCommand{});
  CHECK_FALSE(decoded<ArrayCommand>("01010000FF"));
}

TEST_CASE("finite floats saturate, the others pass") {
  const auto sent = [](float value) {
    return encoded(ActuatorStatus{.position = value}).substr(2, 4);
  };
  CHECK(sent(65504) == "FF7B");
  CHECK(sent(65520) == "FF7B");
  CHECK(sent(-1e30F) == "FFFB");
  CHECK(sent(infinity) == "007C");
  CHECK(sent(-infinity) == "00FC");
  CHECK(sent(not_a_number) == "FF7F");
  CHECK(sent(-not_a_number) == "FF7F");
  CHECK(sent(-0.0F) == "0080");
}

TEST_CASE("every float16 that is a number survives") {
  for (std::uint32_t bits = 0; bits <= 0xFFFF; ++bits) {
    const auto value = from_float16(static_cast<std::uint16_t>(bits));
    if ((bits & 0x7FFF) > 0x7C00) {
      REQUIRE(std::isnan(value));
      REQUIRE(to_float16(value) == 0x7FFF);
    } else {
      REQUIRE(to_float16(value) == bits);
    }
  }
}

TEST_CASE("a float between two float16 goes to the nearer, a half away from zero") {
  for (std::uint16_t bits = 0; bits < 0x7BFF; ++bits) {
    const auto low = from_float16(bits);
    const auto high = from_float16(static_cast<std::uint16_t>(bits + 1));
    const auto half = (low + high) / 2; // exact: 12 significant bits at most
    REQUIRE(to_float16(half) == bits + 1);
    REQUIRE(to_float16(-half) == (bits + 1U | 0x8000U));
    REQUIRE(to_float16(std::nextafter(half, 0.0F)) == bits);
  }
  CHECK(to_float16(std::nextafter(65520.0F, 0.0F)) == 0x7BFF);
  CHECK(to_float16(65520.0F) == 0x7C00);
  CHECK(to_float16(std::numeric_limits<float>::denorm_min()) == 0);
}

TEST_CASE("types are found by kind and ID") {
  CHECK(find_type(Kind::message, 1) == &Allocation::type);
  CHECK(find_type(Kind::request, 1) == &GetNodeInfo::type);
  CHECK(find_type(Kind::response, 11) == &GetSet::type);
  CHECK(find_type(Kind::message, 1100) == &ArmingStatus::type);
  CHECK(find_type(Kind::message, 11) == nullptr);
  CHECK(find_type(Kind::request, 341) == nullptr);
}
