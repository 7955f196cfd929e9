#include "catch.hpp"
#include "support.hpp"

#include <random>
#include <set>

using namespace blactl;
using namespace blactl::dronecan;
using namespace blactl::dronecan::test;

namespace {

using Lines = std::vector<std::string>;

std::vector<std::uint8_t> counting(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  std::uint8_t value = 0;
  for (auto& byte : bytes) {
    byte = ++value;
  }
  return bytes;
}

/// A request to node 10 from node 127 at priority 30, transfer ID 0.
template <class Request> Lines request_lines(const DataType& type, const Request& request) {
  const Header header{.kind = Kind::request,
                      .priority = priority_service,
                      .data_type_id = type.id,
                      .source = NodeId(127),
                      .destination = NodeId(10)};
  return texts(segment(header, 0, type.signature, request.encode().bytes()));
}

template <class Message>
Lines message_lines(const Message& message, NodeId source, Priority priority, TransferId id) {
  const Header header{.priority = priority, .data_type_id = Message::type.id, .source = source};
  return texts(segment(header, id, Message::type.signature, message.encode().bytes()));
}

Allocation allocation(std::uint8_t node_id, bool first, std::string_view unique_id) {
  Allocation result{.node_id = node_id, .first_part_of_unique_id = first};
  const auto bytes = unhex(unique_id);
  result.size = static_cast<std::uint8_t>(bytes.size());
  std::ranges::copy(bytes, result.unique_id.begin());
  return result;
}

} // namespace

TEST_CASE("a transfer CRC starts from the signature of its type") {
  CHECK(base_crc(NodeStatus::type.signature) == 0xBE5F);
  CHECK(base_crc(GetNodeInfo::type.signature) == 0xD9A7);
  CHECK(base_crc(Allocation::type.signature) == 0xF258);
  CHECK(base_crc(GetSet::type.signature) == 0xFB10);
  CHECK(base_crc(ExecuteOpcode::type.signature) == 0xD7D4);
  CHECK(base_crc(RestartNode::type.signature) == 0x1F7F);
  CHECK(base_crc(ArrayCommand::type.signature) == 0x5E37);
  CHECK(base_crc(ActuatorStatus::type.signature) == 0x9A63);
}

TEST_CASE("messages look on the wire as other implementations send them") {
  CHECK(message_lines(NodeStatus{.uptime_s = 1234, .vendor_status = 7}, NodeId(42), 20, 0) ==
        Lines{"1401552A#D2040000000700C0"});
  const ActuatorStatus status{.actuator_id = 3,
                              .position = 0.5F,
                              .force = std::numeric_limits<float>::quiet_NaN(),
                              .speed = -1.25F,
                              .power_rating_pct = 17};
  CHECK(message_lines(status, NodeId(42), 20, 0) ==
        Lines{"1403F32A#1F76030038FF7F80", "1403F32A#00BD1160"});
}

TEST_CASE("requests look on the wire as other implementations send them") {
  CHECK(request_lines(GetNodeInfo::type, GetNodeInfo::Request{}) == Lines{"1E018AFF#C0"});
  CHECK(request_lines(GetSet::type, GetSet::Request{.index = 5, .value = {}, .name = {}}) ==
        Lines{"1E0B8AFF#0500C0"});
  CHECK(request_lines(GetSet::type, GetSet::Request{.index = 0, .value = {}, .name = "X"}) ==
        Lines{"1E0B8AFF#000058C0"});
  const GetSet::Request write{.index = 0, .value = std::int64_t{1500}, .name = "ABC"};
  CHECK(request_lines(GetSet::type, write) ==
        Lines{"1E0B8AFF#19B40001DC050080", "1E0B8AFF#0000000000414220", "1E0B8AFF#4340"});
  CHECK(request_lines(ExecuteOpcode::type, ExecuteOpcode::Request{}) ==
        Lines{"1E0A8AFF#00000000000000C0"});
  CHECK(request_lines(RestartNode::type, RestartNode::Request{}) == Lines{"1E058AFF#1E1B55CEACC0"});
}

TEST_CASE("allocations look on the wire as in the specification's log") {
  const NodeId allocator(1);
  CHECK(message_lines(allocation(0, false, "44C08B635E05F4BC1096DF11"), allocator, 30, 1) ==
        Lines{"1E000101#05B00044C08B6381", "1E000101#5E05F4BC1096DF21", "1E000101#1141"});
  const auto whole = "44C08B635E05F4BC1096DF11A8BA5447";
  CHECK(message_lines(allocation(125, false, whole), allocator, 30, 2) ==
        Lines{"1E000101#29BAFA44C08B6382", "1E000101#5E05F4BC1096DF22", "1E000101#11A8BA544742"});
  CHECK(message_lines(allocation(20, false, whole), allocator, 30, 2) ==
        Lines{"1E000101#E00D2844C08B6382", "1E000101#5E05F4BC1096DF22", "1E000101#11A8BA544742"});
}

TEST_CASE("anonymous requests bear the discriminators of the specification's log") {
  const auto line = [](const Allocation& request, TransferId id) {
    const auto payload = request.encode();
    const Header header{.priority = 30,
                        .data_type_id = Allocation::type.id,
                        .discriminator = discriminator(payload.bytes(), id)};
    return texts(segment(header, id, Allocation::type.signature, payload.bytes()));
  };
  CHECK(line(allocation(0, true, "44C08B635E05"), 0) == Lines{"1EEE8100#0144C08B635E05C0"});
  CHECK(line(allocation(0, false, "F4BC1096DF11"), 1) == Lines{"1EEBE500#00F4BC1096DF11C1"});
  CHECK(line(allocation(0, false, "A8BA5447"), 2) == Lines{"1E41E100#00A8BA5447C2"});
}

TEST_CASE("seven bytes fit into one frame and eight do not") {
  const Header header{.data_type_id = 1010, .source = NodeId(1)};
  CHECK(texts(segment(header, 3, 0, counting(7))) == Lines{"1003F201#01020304050607C3"});
  const auto two = segment(header, 3, 0, counting(8));
  REQUIRE(two.size() == 2);
  CHECK(two[0].size == 8);
  CHECK(text(two[1]) == "1003F201#06070863");
}

TEST_CASE("all frames but the last are full, and the last is never empty") {
  const Header header{.data_type_id = 1010, .source = NodeId(1)};
  for (std::size_t size = 8; size < 100; ++size) {
    const auto frames = segment(header, 31, 0, counting(size));
    REQUIRE(frames.size() == (size + 2 + 6) / 7);
    for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
      CHECK(frames[i].size == 8);
      CHECK((frames[i].data[7] & 0xC0) == (i == 0 ? 0x80 : 0));
      CHECK((frames[i].data[7] & 0x20) == (i % 2 == 0 ? 0 : 0x20));
    }
    CHECK(frames.back().size >= 2);
    CHECK((frames.back().data[frames.back().size - 1U] & 0xDF) == (0x40 | 31));
  }
}

TEST_CASE("an anonymous transfer of several frames is not made") {
  CHECK(segment({.data_type_id = 1}, 0, 0, counting(7)).size() == 1);
  CHECK(segment({.data_type_id = 1}, 0, 0, counting(8)).empty());
}

TEST_CASE("forbidden IDs are refused") {
  CHECK_FALSE(decode_id(0x1E018AFF | 0x2000'0000)); // more than 29 bits
  CHECK_FALSE(decode_id(0x1E0180FF));               // to node 0
  CHECK_FALSE(decode_id(0x1E018A80));               // from node 0
  CHECK_FALSE(decode_id(0x1E018A8A));               // to itself
  CHECK(decode_id(0x1E018AFF));
}

TEST_CASE("the ID of an anonymous message tells the low bits of its type") {
  const auto header = decode_id(0x1EEE8100);
  REQUIRE(header);
  CHECK(*header == Header{.priority = 30, .data_type_id = 1, .discriminator = 0x3BA0});
}

TEST_CASE("whatever ID is allowed is encoded as it was") {
  std::mt19937 random(1);
  for (int i = 0; i < 100'000; ++i) {
    const auto id = static_cast<std::uint32_t>(random()) & can::extended_id_mask;
    if (const auto header = decode_id(id)) {
      REQUIRE(encode_id(*header) == id);
    }
  }
}

TEST_CASE("fields too wide for an ID do not reach their neighbours") {
  CHECK(encode_id({.kind = Kind::request,
                   .priority = 0xFF,
                   .data_type_id = 0xFFFF,
                   .source = NodeId(1),
                   .destination = NodeId(2)}) == 0x1FFF8281);
  CHECK(encode_id({.priority = 0, .data_type_id = 0xFFFF, .discriminator = 0xFFFF}) == 0x00FF'FF00);
}
