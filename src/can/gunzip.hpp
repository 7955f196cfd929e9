#pragma once
// Unpacks gzip data piece by piece (RFC 1952).

#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace blactl::can {

/// Takes packed bytes and returns the unpacked ones, some tens of KiB at a time however long the
/// whole is. The concatenated output of several gzip runs is one text.
class Gunzip {
 public:
  /// The first bytes of every gzip file.
  static constexpr std::array<char, 2> magic{'\x1f', '\x8b'};

  Gunzip();
  ~Gunzip();
  Gunzip(const Gunzip&) = delete;
  Gunzip& operator=(const Gunzip&) = delete;

  /// Takes the next bytes, which must stay in place until unpack() returns 0.
  void take(std::span<const char> packed);

  /// Returns the number of bytes put into `room`; 0: the input is used up, or is damaged.
  [[nodiscard]] std::size_t unpack(std::span<char> room);

  /// Whether the input is not gzip data, or its checksum is wrong.
  [[nodiscard]] bool is_damaged() const { return damaged_; }

  /// Whether the input may end here: a gzip member is complete.
  [[nodiscard]] bool is_whole() const { return whole_; }

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
  bool damaged_ = false;
  bool whole_ = false;
};

} // namespace blactl::can
