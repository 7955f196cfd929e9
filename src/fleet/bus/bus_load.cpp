#include "blactl/fleet/bus/bus_load.hpp"

#include <algorithm>
#include <utility>

namespace blactl::fleet {

void BusLoad::hear(std::size_t bits, Time at) {
  if (!first_) {
    first_ = last_ = at;
    begin_window(at);
  }
  if (at + most_disorder < last_) {
    runs_backwards_ = true;
    last_ = at;
    begin_window(at); // time skipped by the clock is in no window
  }
  pass(at);
  bits_ += bits;
  in_slice_[current_] += bits;
  in_window_ += bits;
}

void BusLoad::pass(Time now) {
  if (first_) {
    end_slices(now);
    last_ = std::max(last_, now);
  }
}

void BusLoad::begin_window(Time at) {
  in_slice_.fill(0);
  in_window_ = 0;
  ended_ = 0;
  slice_began_ = at;
}

void BusLoad::end_slices(Time now) {
  // beyond a whole window, a longer silence makes no difference
  for (std::size_t i = 0; i <= slices && now - slice_began_ >= slice; ++i) {
    end_slice();
  }
  if (now > slice_began_) {
    slice_began_ += (now - slice_began_) / slice * slice;
  }
}

void BusLoad::end_slice() {
  slice_began_ += slice;
  if (++ended_ >= slices) {
    ended_ = slices;
    last_window_ = in_window_;
    most_ = std::max(most_.value_or(0), in_window_);
  }
  current_ = (current_ + 1) % slices;
  in_window_ -= std::exchange(in_slice_[current_], 0);
}

std::optional<Duration> BusLoad::duration() const {
  return first_ && last_ > *first_ && !runs_backwards_ ? std::optional(last_ - *first_)
                                                       : std::nullopt;
}

std::optional<std::uint64_t> BusLoad::mean_permille() const {
  const auto time = duration();
  return time ? std::optional(bits_ * 1000 / static_cast<std::uint64_t>(time->count()))
              : std::nullopt;
}

std::optional<std::uint64_t> BusLoad::permille(std::optional<std::uint64_t> bits) {
  return bits ? std::optional(*bits * 1000 / static_cast<std::uint64_t>(window.count()))
              : std::nullopt;
}

} // namespace blactl::fleet
