#pragma once
// One servo on the bench, running, and what is asked of it.

#include "blactl/sim/servo/servo.hpp"

#include "unit/sim/support.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace blactl::sim::testing {

using Frames = std::vector<std::string>;

inline constexpr const char* bla21 = R"("model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1,
    "unique_id": "00112233445566778899aabbccddeeff", "answer_delay": 0)";

/// One servo on the bench, running.
struct Rig {
  explicit Rig(const std::string& members, Duration settle = std::chrono::milliseconds(200))
      : servo(servo_setup(members), 1, Time{}), bench(servo) {
    servo.report_to([this](const ServoEvent& event) { events.push_back(event); });
    heard = bench.run(settle);
  }

  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  Frames get_set(std::uint16_t index, dronecan::GetSet::Value value, std::string name) {
    const dronecan::GetSet::Request request{index, std::move(value), std::move(name)};
    id = static_cast<dronecan::TransferId>((id + 1) % dronecan::transfer_id_modulus);
    return bench.ask(
        testing::request(dronecan::GetSet::type, request, servo.node_id().value(), id));
  }

  /// The value of the answer; Empty for a failure. There must be an answer.
  dronecan::GetSet::Response answered(const Frames& frames) {
    std::vector<std::uint8_t> payload;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const can::Frame one = frame(frames[i]);
      const std::size_t skip = i == 0 && frames.size() > 1 ? 2 : 0; // the transfer CRC
      payload.insert(payload.end(), one.data.begin() + static_cast<std::ptrdiff_t>(skip),
                     one.data.begin() + one.size - 1);
    }
    const auto response = dronecan::GetSet::Response::decode(payload);
    REQUIRE(response);
    return *response;
  }

  /// "ok", "refused", or "silence" for none.
  std::string opcode(std::uint8_t opcode, std::int64_t argument = 0) {
    const auto frames =
        ask(dronecan::ExecuteOpcode::type, dronecan::ExecuteOpcode::Request{opcode, argument});
    return frames.empty() ? "silence" : frames.front().substr(21, 2) == "80" ? "ok" : "refused";
  }

  std::string restart_node(std::uint64_t magic = dronecan::RestartNode::magic) {
    const auto frames = ask(dronecan::RestartNode::type, dronecan::RestartNode::Request{magic});
    return frames.empty() ? "silence" : frames.front().substr(9, 2) == "80" ? "ok" : "refused";
  }

  /// The value of the answer to a write; empty: a failure, or none.
  std::optional<std::int64_t> write(const char* name, std::int64_t value) {
    return value_of(get_set(0, value, name));
  }

  std::optional<std::int64_t> read(const char* name) { return value_of(get_set(0, {}, name)); }

  [[nodiscard]] std::int64_t ram(bla::Address address) const {
    return servo.registers().value(address);
  }

  [[nodiscard]] std::int64_t rom(bla::Address address) const {
    return servo.registers().rom_value(address);
  }

  /// What was told so far: "restart 11" with the node ID.
  [[nodiscard]] Frames told() const {
    Frames lines;
    for (const ServoEvent& event : events) {
      lines.push_back(fmt::format("{} {}", name(event.kind), event.node_id.value()));
    }
    return lines;
  }

  /// Lets a restart, with the ROM write before it, be over.
  std::vector<can::Frame> settle() { return bench.run(std::chrono::milliseconds(210)); }

  /// An allocator's three answers to a servo that asks.
  void allocate(std::uint8_t node_id) {
    for (const std::uint8_t size : std::initializer_list<std::uint8_t>{6, 12, 16}) {
      while (bench.run(std::chrono::milliseconds(1)).empty()) {
      }
      dronecan::Allocation answer;
      answer.node_id = size == 16 ? node_id : 0;
      answer.size = size;
      answer.unique_id = servo.unique_id();
      const dronecan::Header header{dronecan::Kind::message, 24, dronecan::Allocation::type.id,
                                    dronecan::NodeId(127),   {}, 0};
      id = static_cast<dronecan::TransferId>((id + 1) % dronecan::transfer_id_modulus);
      bench.deliver(dronecan::segment(header, id, dronecan::Allocation::type.signature,
                                      answer.encode().bytes()));
    }
  }

  Servo servo;
  Bench bench;
  std::vector<can::Frame> heard; ///< while it settled
  std::vector<ServoEvent> events;
  dronecan::TransferId id = 0;

 private:
  template <class Request> Frames ask(const dronecan::DataType& type, const Request& what) {
    id = static_cast<dronecan::TransferId>((id + 1) % dronecan::transfer_id_modulus);
    return bench.ask(request(type, what, servo.node_id().value(), id));
  }

  std::optional<std::int64_t> value_of(const Frames& frames) {
    if (frames.empty()) {
      return std::nullopt;
    }
    const auto response = answered(frames);
    const auto* value = std::get_if<std::int64_t>(&response.value);
    return value != nullptr ? std::optional(*value) : std::nullopt;
  }
};

/// The frames of one data type among `frames`.
inline std::vector<can::Frame> only(const std::vector<can::Frame>& frames, std::uint16_t type) {
  std::vector<can::Frame> out;
  for (const can::Frame& one : frames) {
    const auto header = dronecan::decode_id(one.id);
    if (header && header->kind == dronecan::Kind::message && header->data_type_id == type) {
      out.push_back(one);
    }
  }
  return out;
}

inline bool failed(const dronecan::GetSet::Response& response) {
  return std::holds_alternative<dronecan::GetSet::Empty>(response.value);
}

/// Uptime and transfer ID of the NodeStatus among `frames`.
inline std::vector<std::pair<std::uint32_t, unsigned>> uptimes(const std::vector<can::Frame>& all) {
  std::vector<std::pair<std::uint32_t, unsigned>> out;
  for (const can::Frame& one : only(all, dronecan::NodeStatus::type.id)) {
    out.emplace_back(one.data[0], one.data[7] & 0x1FU);
  }
  return out;
}

} // namespace blactl::sim::testing
