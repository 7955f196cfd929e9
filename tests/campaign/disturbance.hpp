#pragma once
// One thing that goes wrong at a certain moment of a command: the k-th frame, the k-th system call,
// the k-th write to a database.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

namespace blactl::campaign {

struct Disturbance {
  enum class Kind : std::uint8_t {
    none,
    request_lost,    ///< a frame of ours that no node took, although one acknowledged it
    killed,          ///< the command ends before that frame leaves
    frame_lost,      ///< a frame of others that this process did not get
    frame_doubled,   ///< it comes twice
    frame_corrupted, ///< a bit of a transfer of several frames; their CRC tells
    frame_late,      ///< by 0.3 s
    frame_of_other,  ///< it comes under another node's ID
    call_failed,     ///< a system call
    computer_off,    ///< its power is cut at a write or sync of a database
  };

  Kind kind = Kind::none;
  std::size_t number = 0;             ///< of the frame or the call, from 1
  bool lasts = false;                 ///< every one from then on
  std::size_t seen = 0;               ///< counts, whatever the kind
  const Disturbance* first = nullptr; ///< it counts from when that one has struck; null: at once

  static constexpr std::size_t no_number = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] bool has_struck() const { return seen >= number; }

  /// Counts one, and tells whether it is meant.
  [[nodiscard]] bool strikes() {
    if (first != nullptr && !first->has_struck()) {
      return false;
    }
    ++seen;
    return lasts ? seen >= number : seen == number;
  }
};

[[nodiscard]] constexpr std::string_view name(Disturbance::Kind kind) {
  using Kind = Disturbance::Kind;
  switch (kind) {
  case Kind::none: return "nothing";
  case Kind::request_lost: return "request lost";
  case Kind::killed: return "killed";
  case Kind::frame_lost: return "frame lost";
  case Kind::frame_doubled: return "frame doubled";
  case Kind::frame_corrupted: return "frame corrupted";
  case Kind::frame_late: return "frame late";
  case Kind::frame_of_other: return "frame of another";
  case Kind::call_failed: return "system call failed";
  case Kind::computer_off: return "computer off";
  }
  return {};
}

/// What a command throws when it is killed.
struct Killed {};

/// From now on system calls of this process are counted by `disturbance`, and fail as it says;
/// null: no more. Those to standard output and errors are not counted.
void fail_calls(Disturbance* disturbance);

} // namespace blactl::campaign
