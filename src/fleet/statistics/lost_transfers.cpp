#include "blactl/fleet/statistics/lost_transfers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace blactl::fleet {
namespace {

using dronecan::transfer_id_modulus;

/// How far transfers may be from their usual time: by one, or by a quarter of a long gap. Wide
/// enough for senders that are not exact; a restart looks like a loss only if its ID happens to
/// fit.
constexpr double gap_tolerance = 0.25;

/// Of the usual period, what each further one counts.
constexpr double weight = 0.25;

/// A pause of a sender that sends in bursts must not look like its period.
constexpr double most_growth = 2;

/// From 1, right after the last one, to 32, the same ID again.
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

/// Also after 32 lost ones, or 64, the IDs go on by one: the time tells. One that sends in bursts
/// pauses for any time; one that has become slower is silent for as long again.
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
    return; // stamps of a log that are the same, or went back
  }
  const double usual = usual_us_.value_or(elapsed_us);
  usual_us_ = usual + (std::min(elapsed_us, usual * most_growth) - usual) * weight;
}

/// Whether in this time the IDs come round, once or more often, and on to the next one.
bool LostTransfers::is_round(double elapsed_us) const {
  return std::abs(std::remainder(elapsed_us / *usual_us_ - 1, double{transfer_id_modulus})) <= 1;
}

/// Whether so many transfers are sent in this time.
bool LostTransfers::explains(unsigned steps, double elapsed_us) const {
  if (!usual_us_ || elapsed_us >= *usual_us_ * transfer_id_modulus) {
    return false;
  }
  const double off_us = std::abs(elapsed_us - *usual_us_ * steps);
  return off_us <= std::max(*usual_us_, elapsed_us * gap_tolerance);
}

} // namespace blactl::fleet
