#include "fleet/characterize/servo_ids.hpp"

#include "fleet/characterize/test_bench.hpp"

#include <algorithm>
#include <chrono>
#include <ranges>

namespace blactl::fleet {

namespace at = bla::address;

bool is_free_servo_id(const TestBench& bench, std::int64_t servo_id) {
  const auto hears = [&](const auto& entry) {
    const auto& [id, member] = entry;
    return id != bench.servo().id &&
           (member.actuator_id == servo_id || member.commanded_id() == servo_id);
  };
  const auto may_hold = [&](const Neighbour& other) {
    return other.servo_id.value_or(servo_id) == servo_id;
  };
  return std::ranges::none_of(bench.roster().members(), hears) &&
         std::ranges::none_of(bench.neighbours(), may_hold);
}

std::optional<std::int64_t> free_servo_id(const TestBench& bench) {
  constexpr std::int64_t lowest = 1, highest = 254; // 4.37
  const std::int64_t own = bench.held(at::servo_id).value_or(0);
  for (const std::int64_t id : std::views::iota(lowest, highest + 1)) {
    if (id != own && is_free_servo_id(bench, id)) {
      return id;
    }
  }
  return std::nullopt;
}

Result<ServoIdTaken> take_servo_id(TestBench& bench, std::int64_t servo_id) {
  constexpr Duration some_status = std::chrono::milliseconds(450);
  const auto told = [&]() -> std::optional<std::int64_t> {
    const auto status = bench.start_watch().status_of(bench.servo().id);
    return status ? std::optional<std::int64_t>(status->actuator_id) : std::nullopt;
  };
  const auto before = told();
  auto waited = bench.set(at::servo_id, servo_id);
  waited = waited ? bench.pause(some_status) : waited;
  if (!waited) {
    return std::unexpected(waited.error());
  }
  const auto after = told();
  if (!before || before == servo_id) {
    return ServoIdTaken::unseen;
  }
  return after == servo_id ? ServoIdTaken::at_once
         : after == before ? ServoIdTaken::waits
                           : ServoIdTaken::unseen;
}

} // namespace blactl::fleet
