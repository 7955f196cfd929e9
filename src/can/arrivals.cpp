#include "blactl/can/arrivals.hpp"

#include "can/kernel_frame.hpp"

namespace blactl::can {

void Arrivals::read_at(Time now, WallTime wall) {
  now_ = now;
  wall_ = wall;
}

Arrivals::Arrival Arrivals::arrival(const Aside& aside) {
  const WallTime stamp = aside.stamp.value_or(wall_);
  last_ = bus_time(stamp, now_, wall_, last_);
  Arrival arrival{last_, stamp, std::nullopt};
  if (aside.dropped && *aside.dropped != dropped_) {
    lost_ += *aside.dropped - dropped_;
    dropped_ = *aside.dropped;
    arrival.before = Overflow{lost_};
  }
  return arrival;
}

} // namespace blactl::can
