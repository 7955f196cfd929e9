#pragma once
// What gzip has packed, unpacked piece by piece (RFC 1952).

#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace blactl::can {

/// Takes packed bytes and gives back what they hold, some tens of KiB at a time however long it is
/// all together. What several runs of gzip wrote one after the other is one text.
class Gunzip {
 public:
  /// What every gzip file begins with.
  static constexpr std::array<char, 2> magic{'\x1f', '\x8b'};

  Gunzip();
  ~Gunzip();
  Gunzip(const Gunzip&) = delete;
  Gunzip& operator=(const Gunzip&) = delete;

  /// The bytes that follow; they stay where they are until unpack() has given nothing.
  void take(std::span<const char> packed);

  /// How many bytes were put into `room`; 0: what was taken is used up, or is damaged.
  [[nodiscard]] std::size_t unpack(std::span<char> room);

  /// What was taken is not what gzip writes, or its checksum is wrong.
  [[nodiscard]] bool is_damaged() const { return damaged_; }

  /// It may end here: between what two runs of gzip wrote.
  [[nodiscard]] bool is_whole() const { return whole_; }

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
  bool damaged_ = false;
  bool whole_ = false;
};

} // namespace blactl::can
