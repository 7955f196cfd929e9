#pragma once
// The lines of the slcan protocol as text, without any port: frames out, adapter lines in.
//
//   T 1401552A 8 D2040000000700C0 [4 hex digits of time] [L] CR      extended data frame
//   t 123 2 1122 CR    R 1401552A 8 CR    r 123 0 CR                 standard, remote
//   CR, Z CR, z CR: done    BEL: refused    F00, V1010, N1234: answers about itself
//
// Sources: Lawicel CAN232 manual 1.4; pydronecan driver/slcan.py; ArduPilot AP_CANManager/
// AP_SLCANIface.cpp (always with a time); Zubax Babel (L: the adapter's own frame).

#include "blactl/can/frame.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace blactl::can {

/// "T1401552A8D2040000000700C0\r", in upper case as the program of the servo's vendor writes it.
[[nodiscard]] std::string to_slcan(const Frame& frame);

/// The meaning of one line from an adapter.
struct SlcanLine {
  enum class Kind : std::uint8_t {
    frame,    ///< from another node
    loopback, ///< one of our frames, as it was sent
    done,     ///< a command or a frame was accepted
    refused,
    told,  ///< an answer to F, V or N
    other, ///< anything else, or damaged: FD frames, MAVLink
  };

  Kind kind = Kind::other;
  Frame frame{};
  std::string told{}; ///< the letter of the command, and the answer: "V1010"
};

/// Splits an adapter's output into lines, byte by byte, in bounded memory.
///
/// Lines end with CR, LF or BEL. Bytes that no line can hold, and lines that are too long, spoil
/// everything up to the next line end; but a T always begins a new frame: no line has one inside,
/// so anything before it has lost its end.
class SlcanParser {
 public:
  /// Returns the line that ends with this byte, if one does.
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
