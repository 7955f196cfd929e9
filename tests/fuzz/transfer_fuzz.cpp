// Frames of anybody, in any order and at any time: reassembly, and the data types in what it
// delivers.

#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"

#include "fuzz.hpp"
#include "unit/dronecan/support.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>

using namespace blactl;
using namespace blactl::dronecan;

namespace {

/// Of one frame in the input: how long after the last, which flags and how many bytes, the CAN ID,
/// the bytes.
constexpr std::size_t record = 14;

void decode_as_anything(Bytes payload) {
  (void)NodeStatus::decode(payload);
  (void)GetNodeInfo::Response::decode(payload);
  (void)Allocation::decode(payload);
  (void)RestartNode::Request::decode(payload);
  (void)RestartNode::Response::decode(payload);
  (void)ExecuteOpcode::Request::decode(payload);
  (void)ExecuteOpcode::Response::decode(payload);
  (void)GetSet::Request::decode(payload);
  (void)GetSet::Response::decode(payload);
  (void)ArrayCommand::decode(payload);
  (void)ActuatorStatus::decode(payload);
  (void)ArmingStatus::decode(payload);
}

can::Frame frame_of(const std::uint8_t* bytes) {
  can::Frame frame{.extended = (bytes[1] & 0x80U) == 0,
                   .remote = (bytes[1] & 0x40U) != 0,
                   .size = static_cast<std::uint8_t>((bytes[1] & 0x0FU) % 9)};
  std::memcpy(&frame.id, bytes + 2, sizeof frame.id);
  frame.id &= frame.extended ? can::extended_id_mask : 0x7FFU;
  std::copy_n(bytes + 6, frame.data.size(), frame.data.begin());
  return frame;
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Receiver receiver(4, NodeId{},
                    {.transfer =
                         [](const Transfer& transfer) {
                           fuzz::require(transfer.payload.size() <= Receiver::capacity);
                           decode_as_anything(transfer.payload);
                         },
                     .signature = test::known_signature});
  Time now{};
  for (; size >= record; data += record, size -= record) {
    now += std::chrono::milliseconds(10 * data[0]);
    receiver.receive(frame_of(data), now);
  }
  receiver.expire(never);
  return 0;
}
