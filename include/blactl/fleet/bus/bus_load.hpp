#pragma once
// How busy a bus is: on average, in its busiest second, in the last one.

#include "blactl/base/time.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace blactl::fleet {

/// Counts the bits that cross a bus of 1 Mbit/s, where one takes 1 us, from the first frame on. The
/// same few bytes of memory however long it goes on.
///
/// Times that go back a little (stamps of several sockets) are taken for the latest so far. Once
/// they go back by more than `most_disorder`, a clock was set: nothing tells a duration any more.
class BusLoad {
 public:
  /// What the busiest and the last time are measured over. It is moved on by tenths.
  static constexpr Duration window = std::chrono::seconds(1);
  static constexpr Duration most_disorder = std::chrono::seconds(1);

  /// A frame of so many bits, with those between frames.
  void hear(std::size_t bits, Time at);

  /// Nothing more was heard until `now`.
  void pass(Time now);

  /// From the first frame to the last, or to when pass() said that there was none; empty: that is
  /// no time, or times run backwards.
  [[nodiscard]] std::optional<Duration> duration() const;

  [[nodiscard]] std::uint64_t bits() const { return bits_; }

  /// In thousandths of what fits; empty: no duration.
  [[nodiscard]] std::optional<std::uint64_t> mean_permille() const;

  /// Of the busiest window; empty: no whole one has passed.
  [[nodiscard]] std::optional<std::uint64_t> max_permille() const { return permille(most_); }

  /// Of the last whole window; empty: there is none yet.
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

  std::array<std::uint64_t, slices> in_slice_{}; ///< bits; the running one is at current_
  std::size_t current_ = 0;
  std::size_t ended_ = 0; ///< slices since the window began, as far as they matter
  Time slice_began_{};
  std::uint64_t in_window_ = 0; ///< of all slices
  std::optional<std::uint64_t> most_, last_window_;
};

} // namespace blactl::fleet
