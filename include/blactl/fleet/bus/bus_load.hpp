#pragma once
// The load of a bus: its average, in its busiest second, and in the last second.

#include "blactl/base/time.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace blactl::fleet {

/// Counts the bits on a bus of 1 Mbit/s, where one takes 1 us, from the first frame on, in constant
/// memory.
///
/// Times that go back a little (timestamps of several sockets) are taken for the latest so far.
/// Once they go back by more than `most_disorder`, a clock was set, and durations are not known any
/// more.
class BusLoad {
 public:
  /// The window of the busiest and the last load. It moves in tenths.
  static constexpr Duration window = std::chrono::seconds(1);
  static constexpr Duration most_disorder = std::chrono::seconds(1);

  /// Takes a frame of this number of bits, including those between frames.
  void hear(std::size_t bits, Time at);

  /// Advances to `now` without traffic.
  void pass(Time now);

  /// From the first frame to the last, or to the last pass(); empty: no time has passed, or times
  /// go backwards.
  [[nodiscard]] std::optional<Duration> duration() const;

  [[nodiscard]] std::uint64_t bits() const { return bits_; }

  /// In thousandths of the capacity; empty: no duration.
  [[nodiscard]] std::optional<std::uint64_t> mean_permille() const;

  /// For the busiest window; empty: no whole one has passed.
  [[nodiscard]] std::optional<std::uint64_t> max_permille() const { return permille(most_); }

  /// For the last whole window; empty: none yet.
  [[nodiscard]] std::optional<std::uint64_t> last_permille() const {
    return permille(last_window_);
  }

 private:
  static constexpr std::size_t slices = 10;
  static constexpr Duration slice = window / slices;

  [[nodiscard]] static std::optional<std::uint64_t> permille(std::optional<std::uint64_t> bits);
  void begin_window(Time at);
  void end_slices(Time now);
  void end_slice();

  std::optional<Time> first_;
  Time last_{};
  bool runs_backwards_ = false;
  std::uint64_t bits_ = 0;

  std::array<std::uint64_t, slices> in_slice_{}; ///< bits; the current one is at current_
  std::size_t current_ = 0;
  std::size_t ended_ = 0; ///< slices since the start of the window, up to the relevant number
  Time slice_began_{};
  std::uint64_t in_window_ = 0; ///< of all slices
  std::optional<std::uint64_t> most_, last_window_;
};

} // namespace blactl::fleet
