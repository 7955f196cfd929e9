#include "blactl/dronecan/transfer.hpp"

#include "blactl/base/crc16.hpp"

#include "dronecan/tail.hpp"

#include <algorithm>
#include <array>

namespace blactl::dronecan {
namespace {

// DroneCAN specification 4.1, "ID field".
constexpr unsigned priority_shift = 24;
constexpr unsigned message_type_shift = 8;
constexpr unsigned discriminator_shift = 10;
constexpr unsigned service_type_shift = 16;
constexpr unsigned destination_shift = 8;
constexpr std::uint32_t service_bit = 1U << 7U;
constexpr std::uint32_t request_bit = 1U << 15U;
constexpr std::uint32_t discriminator_mask = 0x3FFF;

Header decode_message(std::uint32_t id, Header header) {
  header.kind = Kind::message;
  if (header.source == anonymous) {
    header.data_type_id = static_cast<std::uint16_t>((id >> message_type_shift) & 3U);
    header.discriminator =
        static_cast<std::uint16_t>((id >> discriminator_shift) & discriminator_mask);
  } else {
    header.data_type_id = static_cast<std::uint16_t>((id >> message_type_shift) & 0xFFFFU);
  }
  return header;
}

std::optional<Header> decode_service(std::uint32_t id, Header header) {
  header.kind = (id & request_bit) != 0 ? Kind::request : Kind::response;
  header.data_type_id = static_cast<std::uint16_t>((id >> service_type_shift) & 0xFFU);
  header.destination = NodeId(static_cast<std::uint8_t>((id >> destination_shift) & NodeId::max));
  if (!header.source.is_unicast() || !header.destination.is_unicast() ||
      header.source == header.destination) {
    return std::nullopt;
  }
  return header;
}

can::Frame make_frame(std::uint32_t id, std::span<const std::uint8_t> bytes, Tail tail) {
  can::Frame frame{.id = id, .size = static_cast<std::uint8_t>(bytes.size() + 1)};
  std::ranges::copy(bytes, frame.data.begin());
  frame.data[bytes.size()] = tail.encode();
  return frame;
}

} // namespace

std::uint32_t encode_id(const Header& header) {
  const auto common = ((header.priority & 0x1FU) << priority_shift) | header.source.value();
  if (header.kind != Kind::message) {
    return common | ((header.data_type_id & 0xFFU) << service_type_shift) |
           (header.kind == Kind::request ? request_bit : 0U) |
           (static_cast<std::uint32_t>(header.destination.value()) << destination_shift) |
           service_bit;
  }
  if (header.source == anonymous) {
    return common | ((header.discriminator & discriminator_mask) << discriminator_shift) |
           ((header.data_type_id & 3U) << message_type_shift);
  }
  return common | (static_cast<std::uint32_t>(header.data_type_id) << message_type_shift);
}

std::optional<Header> decode_id(std::uint32_t can_id) {
  if (can_id > can::extended_id_mask) {
    return std::nullopt;
  }
  const Header header{.priority = static_cast<Priority>(can_id >> priority_shift),
                      .source = NodeId(static_cast<std::uint8_t>(can_id & NodeId::max))};
  return (can_id & service_bit) != 0 ? decode_service(can_id, header)
                                     : decode_message(can_id, header);
}

std::uint16_t base_crc(std::uint64_t signature) {
  std::array<std::uint8_t, 8> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(signature >> (8 * i));
  }
  return crc16(bytes);
}

std::uint16_t discriminator(std::span<const std::uint8_t> payload, TransferId id) {
  const Tail tail{.start = true, .end = true, .transfer_id = id};
  return crc16(std::array{tail.encode()}, crc16(payload)) & discriminator_mask;
}

std::vector<can::Frame> segment(const Header& header, TransferId id, std::uint64_t signature,
                                std::span<const std::uint8_t> payload) {
  const auto can_id = encode_id(header);
  if (payload.size() <= frame_payload) {
    return {make_frame(can_id, payload, {.start = true, .end = true, .transfer_id = id})};
  }
  if (header.kind == Kind::message && header.source == anonymous) {
    return {};
  }
  const auto crc = crc16(payload, base_crc(signature));
  std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(crc),
                                  static_cast<std::uint8_t>(crc >> 8U)};
  bytes.insert(bytes.end(), payload.begin(), payload.end());

  std::vector<can::Frame> frames;
  Tail tail{.start = true, .transfer_id = id};
  for (std::span<const std::uint8_t> rest = bytes; !rest.empty();) {
    const auto part = rest.first(std::min(rest.size(), frame_payload));
    rest = rest.subspan(part.size());
    tail.end = rest.empty();
    frames.push_back(make_frame(can_id, part, tail));
    tail.start = false;
    tail.toggle = !tail.toggle;
  }
  return frames;
}

} // namespace blactl::dronecan
