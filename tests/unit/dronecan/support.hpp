#pragma once
// What the tests of this floor share: hex, frames as hex, and a receiver that writes down what
// it is told.

#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace blactl::dronecan::test {

using namespace std::chrono_literals;

inline std::string hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const auto byte : bytes) {
    text += fmt::format("{:02X}", byte);
  }
  return text;
}

inline std::vector<std::uint8_t> unhex(std::string_view text) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    const auto byte = std::stoul(std::string(text.substr(i, 2)), nullptr, 16);
    bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  return bytes;
}

/// As candump writes them: "1E018AFF#C0".
inline std::string text(const can::Frame& frame) {
  return fmt::format("{:08X}#{}", frame.id, hex(frame.payload()));
}

inline std::vector<std::string> texts(std::span<const can::Frame> frames) {
  std::vector<std::string> lines;
  lines.reserve(frames.size());
  for (const auto& frame : frames) {
    lines.push_back(text(frame));
  }
  return lines;
}

inline can::Frame frame(std::uint32_t id, std::span<const std::uint8_t> bytes) {
  can::Frame result{.id = id, .size = static_cast<std::uint8_t>(bytes.size())};
  std::ranges::copy(bytes, result.data.begin());
  return result;
}

inline can::Frame frame(std::string_view text) {
  const auto id = std::stoul(std::string(text.substr(0, 8)), nullptr, 16);
  return frame(static_cast<std::uint32_t>(id), unhex(text.substr(9)));
}

inline std::optional<std::uint64_t> known_signature(Kind kind, std::uint16_t id) {
  const auto* type = find_type(kind, id);
  return type != nullptr ? std::optional(type->signature) : std::nullopt;
}

/// A time on the bus clock that starts at 1000 s.
inline Time at(Duration duration) {
  return Time(1000s + duration);
}

inline constexpr NodeId listener{};

/// A receiver, what it delivered and what it complained of.
class Ear {
 public:
  struct Heard {
    Header header;
    TransferId transfer_id;
    std::string payload; ///< hex
    Time at;
    bool crc_checked;
  };

  using Complaint = std::tuple<ReceiveError, std::uint32_t, Time>;

  explicit Ear(NodeId local = listener, std::size_t sessions = 64)
      : receiver_(sessions, local,
                  {.transfer =
                       [this](const Transfer& transfer) {
                         heard.push_back({transfer.header, transfer.transfer_id,
                                          hex(transfer.payload), transfer.at,
                                          transfer.crc_checked});
                       },
                   .error =
                       [this](ReceiveError error, std::uint32_t id, Time time) {
                         errors.push_back(error);
                         complaints.emplace_back(error, id, time);
                       },
                   .signature = known_signature}) {}

  Ear& hear(const can::Frame& frame, Duration when = {}) {
    receiver_.receive(frame, at(when));
    return *this;
  }

  Ear& hear(std::string_view text, Duration when = {}) { return hear(frame(text), when); }

  Ear& hear(std::span<const can::Frame> frames, Duration when = {}) {
    for (const auto& each : frames) {
      hear(each, when);
    }
    return *this;
  }

  Receiver& receiver() { return receiver_; }

  [[nodiscard]] std::vector<std::string> payloads() const {
    std::vector<std::string> list;
    list.reserve(heard.size());
    for (const auto& each : heard) {
      list.push_back(each.payload);
    }
    return list;
  }

  std::vector<Heard> heard;
  std::vector<ReceiveError> errors;
  std::vector<Complaint> complaints;

 private:
  Receiver receiver_;
};

} // namespace blactl::dronecan::test
