#include "blactl/sim/servo/angle_frame.hpp"

#include "sim/servo/rounded.hpp"

namespace blactl::sim {
namespace {

constexpr std::int64_t turn_decideg = 3600;

/// The number of turns to subtract for an angle of -180.0 to +179.9 deg.
std::int64_t turns_in(std::int64_t decideg) {
  const std::int64_t from_lowest = decideg + turn_decideg / 2;
  const std::int64_t turns = from_lowest / turn_decideg;
  return from_lowest % turn_decideg < 0 ? turns - 1 : turns;
}

} // namespace

void AngleFrame::wrap(const Shaft& shaft) {
  turns_ += sign_ * turns_in(decideg(shaft));
}

void AngleFrame::change(bool reversed, std::int64_t origin_decideg, const Shaft& shaft) {
  const bool moves = origin_decideg != origin_decideg_ && turns_in(decideg(shaft)) == 0;
  set(reversed, origin_decideg);
  if (moves) {
    wrap(shaft);
  }
}

Position AngleFrame::position(const Shaft& shaft) const {
  const std::int64_t zero = (origin_decideg_ + turns_ * turn_decideg) * angle_per_decideg;
  return {sign_ * (shaft.angle - zero), sign_ * shaft.speed};
}

std::int64_t AngleFrame::decideg(const Shaft& shaft) const {
  return rounded(position(shaft).angle, angle_per_decideg);
}

} // namespace blactl::sim
