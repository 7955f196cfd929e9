#include "blactl/sim/servo/shaft.hpp"

#include <algorithm>
#include <cstdlib>

namespace blactl::sim {
namespace {

constexpr std::int64_t turn = 3600 * angle_per_decideg;
constexpr std::int64_t lag_ms = 5;
constexpr std::int64_t creep = speed_per_rpm / 10; ///< below this, friction stops it
constexpr std::int64_t hand_speed = 60 * speed_per_rpm;

constexpr std::int64_t friction(Drive::Kind kind) {
  switch (kind) {
  case Drive::Kind::on: return full_effort / 500;
  case Drive::Kind::off: return full_effort / 20;
  case Drive::Kind::brake: return full_effort * 3 / 10;
  }
  return 0;
}

/// The speed at which `push` and friction balance.
std::int64_t settled_speed(std::int64_t push, std::int64_t friction, std::int64_t full_speed) {
  if (std::abs(push) <= friction) {
    return 0;
  }
  const std::int64_t net = push > 0 ? push - friction : push + friction;
  return full_speed * net / (full_effort - friction);
}

/// The shortest way from `angle` to the position `decideg` within a turn.
std::int64_t way_to(std::int64_t decideg, std::int64_t angle) {
  const std::int64_t way = (decideg * angle_per_decideg - angle) % turn;
  if (way > turn / 2) {
    return way - turn;
  }
  return way < -turn / 2 ? way + turn : way;
}

} // namespace

void Shaft::step(Drive::Kind kind, std::int64_t push, const World& world, std::int64_t full_speed) {
  if (world.hand_decideg) {
    speed = std::clamp(way_to(*world.hand_decideg, angle), -hand_speed, hand_speed);
  } else if (world.stuck) {
    speed = 0;
  } else {
    const std::int64_t load = world.load_percent * effort_per_percent;
    const std::int64_t settled = settled_speed(push + load, friction(kind), full_speed);
    speed += (settled - speed) / lag_ms;
    if (settled == 0 && std::abs(speed) < creep) {
      speed = 0;
    }
  }
  angle += speed;
}

} // namespace blactl::sim
