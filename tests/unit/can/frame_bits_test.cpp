#include "blactl/can/frame_bits.hpp"

#include "unit/sim/support.hpp"

#include <set>

using namespace blactl;
using namespace blactl::sim;
using testing::frame;

namespace {

/// Bits on the wire, intermissions included.
std::size_t on_wire(const std::vector<can::Frame>& frames) {
  std::size_t bits = 0;
  for (const can::Frame& one : frames) {
    bits += can::frame_length(one) + can::intermission_bits;
  }
  return bits;
}

/// Request and answer of a GetSet: node 127 asks node 10, transfer ID 1.
std::size_t get_set_bits(const char* name, dronecan::GetSet::Value written, std::int64_t value) {
  constexpr std::uint8_t server = 10;
  constexpr dronecan::TransferId id = 1;
  const auto& type = dronecan::GetSet::type;
  const dronecan::GetSet::Request request{0, std::move(written), name};
  dronecan::GetSet::Response response;
  response.value = value;
  response.name = name;
  const dronecan::Header back{dronecan::Kind::response, 30, type.id, dronecan::NodeId(server),
                              dronecan::NodeId(127),    0};
  return on_wire(testing::request(type, request, server, id)) +
         on_wire(dronecan::segment(back, id, type.signature, response.encode().bytes()));
}

} // namespace

TEST_CASE("an extended frame of 8 bytes takes 128 bits without stuffing and 157 at most") {
  std::size_t shortest = 1000;
  std::size_t longest = 0;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    can::Frame one;
    one.id = (i * 2654435761U) & can::extended_id_mask;
    one.size = 8;
    for (std::uint8_t j = 0; j < 8; ++j) {
      one.data[j] = static_cast<std::uint8_t>((i * (j + 7U)) >> 3U);
    }
    shortest = std::min(shortest, can::frame_length(one));
    longest = std::max(longest, can::frame_length(one));
  }
  CHECK(shortest >= 128);
  CHECK(longest <= 157);
}

TEST_CASE("a frame without bytes and one of standard format have their textbook lengths") {
  // SOF, 32 bits of arbitration, 6 of control, 15 of CRC, 10 of trailer; 10101… needs no stuffing.
  can::Frame extended{.id = 0x15555555, .size = 0};
  CHECK(can::frame_length(extended) >= 64);
  CHECK(can::frame_length(extended) <= 68);
  can::Frame standard{.id = 0x555, .extended = false, .size = 0};
  CHECK(can::frame_length(standard) >= 44);
  CHECK(can::frame_length(standard) <= 47);
  can::Frame remote{.id = 0x555, .extended = false, .remote = true, .size = 8};
  CHECK(can::frame_length(remote) <= 47); // no data whatever the DLC
}

TEST_CASE("stuff bits follow every run of five, those that the stuffing makes included") {
  // All dominant up to the CRC: 0x0 with a DLC of 0 has 19 zero bits (standard format).
  can::Frame zeros{.id = 0, .extended = false, .size = 0};
  const std::size_t unstuffed = 1 + 11 + 3 + 4 + 15 + 10;
  // CRC-15 of zeros is zero: 34 zero bits; a stuff bit after 5 and then after every further 5.
  CHECK(can::frame_length(zeros) == unstuffed + 6);
}

TEST_CASE("the bus costs of the messages are those computed elsewhere") {
  CHECK(on_wire({frame("1E0B8AFF#0500C0")}) == 98); // GetSet by index 5
  CHECK(on_wire({frame("1003F32A#1F76030038FF7F80"), frame("1003F32A#00BD1160")}) == 249);
  CHECK(on_wire({frame("1001552A#D2040000000000C0")}) == 143);
}

TEST_CASE("reading a register costs about 533 bits, writing it 784") {
  CHECK(get_set_bits("0x38", {}, -1800) == 533);
  CHECK(get_set_bits("0x38", std::int64_t{-1800}, -1800) == 784);
  for (const std::int64_t value : {0, 1, 900, 1799}) { // stuffing makes the difference
    CHECK(get_set_bits("0x38", {}, value) >= 532);
    CHECK(get_set_bits("0x38", {}, value) <= 541);
    CHECK(get_set_bits("0x38", value, value) >= 783);
    CHECK(get_set_bits("0x38", value, value) <= 799);
  }
}

TEST_CASE("arbitration compares identifiers, and a standard frame beats an extended one") {
  const can::Frame low = frame("1001550B#00");
  const can::Frame high = frame("1E0B7F8B#00");
  CHECK(can::arbitration_field(low) < can::arbitration_field(high));
  can::Frame standard = low;
  standard.extended = false;
  standard.id = low.id >> 18U;
  CHECK(can::arbitration_field(standard) < can::arbitration_field(low));
  can::Frame remote = standard;
  remote.remote = true;
  CHECK(can::arbitration_field(standard) < can::arbitration_field(remote));
  CHECK(can::arbitration_field(remote) < can::arbitration_field(low));
}

TEST_CASE("the first difference of two frames is found where it is on the wire") {
  const can::FrameBits a(frame("10015555#0000"));
  const can::FrameBits b(frame("10015555#0001"));
  const can::FrameBits c(frame("10015555#8000"));
  CHECK(a.first_difference(a) == a.size());
  CHECK(a.first_difference(c) < a.first_difference(b));
  CHECK(a.first_difference(c) > 32);
  CHECK(a.first_difference(b) == b.first_difference(a));
}
