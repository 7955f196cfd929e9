#pragma once
// A file descriptor that is closed with its owner.

#include <unistd.h>

#include <utility>

namespace blactl::can {

class Descriptor {
 public:
  Descriptor() = default;

  explicit Descriptor(int number) : number_(number) {}

  ~Descriptor() {
    if (number_ >= 0) {
      close(number_);
    }
  }

  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}

  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  /// -1: none.
  [[nodiscard]] int get() const { return number_; }

 private:
  int number_ = -1;
};

} // namespace blactl::can
