#pragma once
// Everything random in an episode, from its seed alone: the same numbers with every library.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::campaign {

class Chance {
 public:
  /// `stream`: draws for one purpose change nothing for others.
  Chance(std::uint64_t seed, std::string_view stream) : state_(seed * 0x9E3779B97F4A7C15) {
    for (const char c : stream) {
      state_ = (state_ ^ static_cast<unsigned char>(c)) * 0x100000001B3;
    }
  }

  /// SplitMix64.
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9;
    z = (z ^ z >> 27) * 0x94D049BB133111EB;
    return z ^ z >> 31;
  }

  /// From `least` to `most`, both included.
  std::int64_t whole(std::int64_t least, std::int64_t most) {
    return least + static_cast<std::int64_t>(next() % static_cast<std::uint64_t>(most - least + 1));
  }

  bool comes(double probability) {
    return static_cast<double>(next() >> 11) * 0x1.0p-53 < probability;
  }

  template <class T> const T& one_of(const std::vector<T>& all) {
    return all[static_cast<std::size_t>(whole(0, static_cast<std::int64_t>(all.size()) - 1))];
  }

  /// So many of them, in a random order.
  template <class T> std::vector<T> some_of(std::vector<T> all, std::size_t count) {
    for (std::size_t i = 0; i < count && i + 1 < all.size(); ++i) {
      const auto other =
          whole(static_cast<std::int64_t>(i), static_cast<std::int64_t>(all.size()) - 1);
      std::swap(all[i], all[static_cast<std::size_t>(other)]);
    }
    all.resize(std::min(count, all.size()));
    return all;
  }

 private:
  std::uint64_t state_;
};

} // namespace blactl::campaign
