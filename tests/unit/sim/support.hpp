#pragma once
// Frames as candump writes them, scenarios in a line, and devices that are asked directly.

#include "blactl/bla/profile.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/sim/bus/medium.hpp"
#include "blactl/sim/node/device.hpp"
#include "blactl/sim/scenario/scenario.hpp"

#include "catch.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::sim::testing {

/// "1E0B8AFF#0500C0": an extended frame.
inline can::Frame frame(std::string_view text) {
  can::Frame out;
  const auto hash = text.find('#');
  std::from_chars(text.data(), text.data() + hash, out.id, 16);
  for (std::size_t at = hash + 1; at < text.size(); at += 2) {
    std::from_chars(text.data() + at, text.data() + at + 2, out.data[out.size++], 16);
  }
  return out;
}

inline std::string text(const can::Frame& frame) {
  std::string out = fmt::format("{:08X}#", frame.id);
  for (const std::uint8_t byte : frame.payload()) {
    out += fmt::format("{:02X}", byte);
  }
  return out;
}

inline const bla::Profiles& profiles() {
  static const Result<bla::Profiles> loaded = bla::Profiles::load(std::nullopt);
  INFO((loaded ? "" : loaded.error().message));
  REQUIRE(loaded);
  return *loaded;
}

/// A scenario that must be right. `servos` and what may follow is JSON.
inline Scenario scenario(std::string_view members) {
  const auto parsed = parse_scenario(
      fmt::format(R"({{"schema": "blactl-scenario/1", {}}})", members), "test.json", profiles());
  INFO((parsed ? "" : parsed.error().message));
  REQUIRE(parsed);
  return *parsed;
}

inline ServoSetup servo_setup(std::string_view members) {
  return scenario(fmt::format(R"("servos": [{{{}}}])", members)).servos.front();
}

/// The frames of one transfer to a servo.
template <class Request>
std::vector<can::Frame> request(const dronecan::DataType& type, const Request& request,
                                std::uint8_t server, dronecan::TransferId id,
                                std::uint8_t client = 127) {
  const dronecan::Header header{dronecan::Kind::request,  dronecan::priority_service, type.id,
                                dronecan::NodeId(client), dronecan::NodeId(server),   0};
  return dronecan::segment(header, id, type.signature, request.encode().bytes());
}

/// A device without a bus: what it sends is kept.
class Bench {
 public:
  explicit Bench(Device& device) : device_(device) {
    device.connect([this](const can::Frame& sent) { frames_.push_back(sent); });
  }

  [[nodiscard]] Time now() const { return now_; }

  /// Lets time pass and returns the frames that were sent meanwhile.
  std::vector<can::Frame> run(Duration duration) {
    const Time end = now_ + duration;
    while (device_.next_deadline() <= end) {
      now_ = std::max(now_, device_.next_deadline());
      device_.advance(now_);
    }
    now_ = end;
    return std::exchange(frames_, {});
  }

  /// Sends frames to the device now.
  void deliver(const std::vector<can::Frame>& frames) {
    for (const can::Frame& sent : frames) {
      device_.receive(sent, now_);
    }
  }

  /// Sends frames to the device now and returns what it sends within `wait`, broadcasts left out.
  std::vector<std::string> ask(const std::vector<can::Frame>& frames,
                               Duration wait = std::chrono::milliseconds(1)) {
    deliver(frames);
    std::vector<std::string> answers;
    for (const can::Frame& answer : run(wait)) {
      const auto header = dronecan::decode_id(answer.id);
      if (header && header->kind == dronecan::Kind::response) {
        answers.push_back(text(answer));
      }
    }
    return answers;
  }

 private:
  Device& device_;
  std::vector<can::Frame> frames_;
  Time now_{};
};

} // namespace blactl::sim::testing
