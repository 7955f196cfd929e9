#pragma once
// The lines of the slcan protocol as text, without any port: frames out, and what an adapter says.
//
//   T 1401552A 8 D2040000000700C0 [4 hex digits of time] [L] CR      extended data frame
//   t 123 2 1122 CR    R 1401552A 8 CR    r 123 0 CR                 standard, remote
//   CR, Z CR, z CR: done    BEL: refused    F00, V1010, N1234: what it tells of itself
//
// Sources: Lawicel CAN232 manual 1.4; pydronecan driver/slcan.py; ArduPilot AP_CANManager/
// AP_SLCANIface.cpp (always with a time); Zubax Babel (L: the adapter's own frame).

#include "blactl/can/frame.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::can {

/// "T1401552A8D2040000000700C0\r", in upper case as the program of the servo's vendor writes it.
[[nodiscard]] std::string to_slcan(const Frame& frame);

/// What one line of an adapter means.
struct SlcanLine {
  enum class Kind : std::uint8_t {
    frame,    ///< of another node
    loopback, ///< a frame of ours, as it was sent
    done,     ///< a command or a frame was taken
    refused,
    told,  ///< an answer to F, V or N
    other, ///< anything else, and what was damaged: FD frames, MAVLink
  };

  Kind kind = Kind::other;
  Frame frame{};
  std::string told{}; ///< the letter of the command, and the answer: "V1010"
};

/// Cuts what an adapter sends into lines, byte by byte, in bounded memory.
///
/// Lines end with CR, LF or BEL. Bytes that no line can hold, and lines that are too long, spoil
/// everything up to the next end of line; but a T always begins a frame anew: no line has one
/// inside, so what stood before it has lost its end.
class SlcanParser {
 public:
  /// The line that ends with this byte, if one does.
  [[nodiscard]] std::optional<SlcanLine> take(char byte);

 private:
  /// N and 16 bytes as digits; T, 8 digits, DLC, 16 digits, 4 of the time, L are less.
  static constexpr std::size_t longest = 1 + 32;

  [[nodiscard]] SlcanLine finish();

  std::array<char, longest> line_{};
  std::size_t size_ = 0;
  bool spoilt_ = false;
};

} // namespace blactl::can
