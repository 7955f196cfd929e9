#pragma once
// Times of a trace: Unix seconds with six decimals for programs, the time of day for people.

#include "blactl/base/time.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace blactl::cli {

/// "1436509052.249713"; the characters live as long as this object. Times before 1970 are 0.
class UnixTime {
 public:
  explicit UnixTime(WallTime time) {
    constexpr std::int64_t million = 1'000'000;
    const auto micros = std::max<std::int64_t>(time.time_since_epoch().count(), 0);
    auto* end = std::to_chars(text_.data(), text_.data() + text_.size(), micros / million).ptr;
    *end++ = '.';
    auto fraction = micros % million;
    for (auto place = million / 10; place > 0; place /= 10) {
      *end++ = static_cast<char>('0' + fraction / place);
      fraction %= place;
    }
    size_ = static_cast<std::size_t>(end - text_.data());
  }

  [[nodiscard]] std::string_view text() const { return {text_.data(), size_}; }

 private:
  std::array<char, 32> text_{};
  std::size_t size_ = 0;
};

/// "2015-07-09 14:30:52", in the time zone of this process. Times before 1970 are 1970.
[[nodiscard]] std::string clock_text(WallTime at);

/// "2015-07-09 14:30:52.249713", in the time zone of this process. Times before 1970 are 1970.
[[nodiscard]] std::string wall_text(WallTime at);

} // namespace blactl::cli
