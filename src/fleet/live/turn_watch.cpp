#include "blactl/fleet/live/turn_watch.hpp"

#include <cstdlib>

namespace blactl::fleet {

void TurnWatch::take(std::int64_t decideg, Time at) {
  if (!rest_) {
    rest_ = decideg;
  }
  if (std::abs(decideg - *rest_) >= least_turn) {
    rest_ = decideg;
    turned_at_ = at;
  }
}

} // namespace blactl::fleet
