#include "blactl/fleet/statistics/lost_transfers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace blactl::fleet {
namespace {

using dronecan::transfer_id_modulus;

/// The tolerance of transfer times: one period, or a quarter of a long gap. Wide enough for inexact
/// senders; a restart looks like a loss only if its ID happens to fit.
constexpr double gap_tolerance = 0.25;

/// The weight of each further transfer in the usual period.
constexpr double weight = 0.25;

/// The pause of a sender that sends in bursts must not be taken for its period.
constexpr double most_growth = 2;

/// From 1, the next ID, to 32, the same ID again.
constexpr unsigned steps_between(dronecan::TransferId last, dronecan::TransferId id) {
  return (id - last - 1U) % static_cast<unsigned>(transfer_id_modulus) + 1U;
}

} // namespace

void LostTransfers::take(dronecan::TransferId id, Time at) {
  const auto last = std::exchange(last_, id);
  const auto elapsed_us = static_cast<double>((at - std::exchange(at_, at)).count());
  if (!last) {
    return;
  }
  const unsigned steps = steps_between(*last, id);
  if (steps == 1) {
    take_next(elapsed_us);
  } else if (explains(steps, elapsed_us)) {
    lost_ += steps - 1;
  } else {
    ++jumps_;
  }
}

/// After 32 lost transfers, or 64, the IDs are consecutive again: only the time shows it. A sender
/// in bursts pauses for any time; one that has become slower is silent for as long again.
void LostTransfers::take_next(double elapsed_us) {
  const bool is_silence = usual_us_ && elapsed_us >= *usual_us_ * transfer_id_modulus;
  const bool is_first = !std::exchange(was_silent_, is_silence);
  if (is_silence && is_first && !pauses_ && is_round(elapsed_us)) {
    ++jumps_;
    return;
  }
  pauses_ = pauses_ || is_silence;
  learn(elapsed_us);
}

void LostTransfers::learn(double elapsed_us) {
  if (elapsed_us <= 0) {
    return; // log timestamps that are equal, or went back
  }
  const double usual = usual_us_.value_or(elapsed_us);
  usual_us_ = usual + (std::min(elapsed_us, usual * most_growth) - usual) * weight;
}

/// Whether this time is enough for the IDs to wrap around, once or more, and reach the next one.
bool LostTransfers::is_round(double elapsed_us) const {
  return std::abs(std::remainder(elapsed_us / *usual_us_ - 1, double{transfer_id_modulus})) <= 1;
}

/// Whether this number of transfers fits this time.
bool LostTransfers::explains(unsigned steps, double elapsed_us) const {
  if (!usual_us_ || elapsed_us >= *usual_us_ * transfer_id_modulus) {
    return false;
  }
  const double off_us = std::abs(elapsed_us - *usual_us_ * steps);
  return off_us <= std::max(*usual_us_, elapsed_us * gap_tolerance);
}

} // namespace blactl::fleet
