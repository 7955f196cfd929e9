#include "blactl/sim/servo/allocatee.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::sim {

using namespace std::chrono_literals;

namespace {

constexpr std::uint8_t part_size = 6;
constexpr Duration min_request_period = 600ms;
constexpr Duration max_request_period = 1000ms;
constexpr Duration max_followup_delay = 400ms;

} // namespace

Allocatee::Allocatee(const dronecan::UniqueId& unique_id, std::uint64_t seed, Time now)
    : unique_id_(unique_id), random_(seed), due_(now + request_period()) {}

Duration Allocatee::request_period() {
  return random_.between(min_request_period, max_request_period);
}

std::optional<dronecan::Allocation> Allocatee::advance(Time now) {
  if (now < due_) {
    return std::nullopt;
  }
  const std::uint8_t from = std::exchange(confirmed_, std::uint8_t{0});
  const auto size =
      static_cast<std::uint8_t>(std::min<std::size_t>(part_size, unique_id_.size() - from));
  dronecan::Allocation request;
  request.first_part_of_unique_id = from == 0;
  request.size = size;
  std::copy_n(unique_id_.begin() + from, size, request.unique_id.begin());
  sent_ = static_cast<std::uint8_t>(from + size);
  answered_ = from;
  due_ = now + request_period();
  return request;
}

bool Allocatee::begins_with(const dronecan::Allocation& message) const {
  return message.size > 0 && message.size <= unique_id_.size() &&
         std::equal(unique_id_.begin(), unique_id_.begin() + message.size,
                    message.unique_id.begin());
}

bool Allocatee::repeats(const dronecan::Allocation& message) const {
  return message.size <= answered_ && begins_with(message);
}

std::optional<dronecan::NodeId> Allocatee::receive(const dronecan::Allocation& message,
                                                   bool anonymous, Time now) {
  if (!anonymous && repeats(message)) {
    return std::nullopt;
  }
  const bool answer = !anonymous && message.size == sent_ && begins_with(message);
  const std::uint8_t size = std::exchange(sent_, std::uint8_t{0});
  confirmed_ = answered_ = 0;
  due_ = now + request_period();
  if (!answer) {
    return std::nullopt;
  }
  if (size < unique_id_.size()) {
    confirmed_ = answered_ = size;
    due_ = now + random_.between(0ms, max_followup_delay);
    return std::nullopt;
  }
  return message.node_id != 0 ? std::optional(dronecan::NodeId(message.node_id)) : std::nullopt;
}

} // namespace blactl::sim
