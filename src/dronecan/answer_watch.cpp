#include "blactl/dronecan/answer_watch.hpp"

#include "blactl/base/crc16.hpp"

#include "dronecan/tail.hpp"

#include <span>

namespace blactl::dronecan {
namespace {

/// The longest answer to GetNodeInfo, with its CRC: longer ones are none.
constexpr std::size_t most_bytes = 400;

/// The payload of a transfer of several frames, if its CRC is right.
std::optional<std::span<const std::uint8_t>> checked(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < crc_size) {
    return std::nullopt;
  }
  const auto payload = bytes.subspan(crc_size);
  const unsigned crc = crc16(payload, base_crc(GetNodeInfo::type.signature));
  const unsigned sent = bytes[0] | static_cast<unsigned>(bytes[1]) << 8U;
  return crc == sent ? std::optional(payload) : std::nullopt;
}

} // namespace

void AnswerWatch::receive(const Header& header, const can::Frame& frame, Time at) {
  if (header.kind != Kind::response || header.data_type_id != GetNodeInfo::type.id) {
    return;
  }
  const Tail tail = Tail::decode(frame.data[frame.size - 1U]);
  Assembly& assembly = assemblies_[header.source];
  if (tail.start) {
    assembly.transfer_id = tail.transfer_id;
    assembly.toggle = false;
    assembly.bytes.clear();
  } else if (assembly.bytes.empty() || tail.transfer_id != assembly.transfer_id ||
             tail.toggle != assembly.toggle) {
    return;
  }
  assembly.toggle = !assembly.toggle;
  const auto data = frame.payload().first(frame.size - 1U);
  assembly.bytes.insert(assembly.bytes.end(), data.begin(), data.end());
  if (assembly.bytes.size() > most_bytes) {
    assembly.bytes.clear();
  } else if (tail.end) {
    complete(assembly, header, at);
    assembly.bytes.clear();
  }
}

void AnswerWatch::complete(Assembly& assembly, const Header& header, Time at) {
  const auto payload = checked(assembly.bytes);
  const auto info = payload ? GetNodeInfo::Response::decode(*payload) : std::nullopt;
  if (!info) {
    return;
  }
  Answer& first = assembly.answers[assembly.transfer_id];
  const bool is_second = first.unit && first.client == header.destination &&
                         at - first.at < Receiver::transfer_timeout;
  if (is_second && *first.unit != info->unique_id) {
    report_(header.source, *first.unit, info->unique_id);
  }
  first = {info->unique_id, header.destination, at};
}

} // namespace blactl::dronecan
