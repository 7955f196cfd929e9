#pragma once
// The frames that one command sent and heard, read without any help of the code under test.

#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace blactl::campaign {

/// A frame, and when it was on the bus.
struct OnWire {
  can::Frame frame;
  Time at;

  [[nodiscard]] std::uint8_t source() const { return frame.id & 0x7F; }

  [[nodiscard]] std::uint8_t destination() const { return frame.id >> 8 & 0x7F; }

  [[nodiscard]] bool is_service() const { return (frame.id & 0x80) != 0; }

  [[nodiscard]] bool is_request() const { return is_service() && (frame.id & 0x8000) != 0; }

  [[nodiscard]] std::uint16_t type() const;

  [[nodiscard]] bool starts() const { return frame.size > 0 && (tail() & 0x80) != 0; }

  [[nodiscard]] bool ends() const { return frame.size > 0 && (tail() & 0x40) != 0; }

  [[nodiscard]] std::uint8_t tail() const { return frame.data[frame.size - 1U]; }

  /// An order or a write of this program after which a servo may not be the same.
  [[nodiscard]] bool is_change() const;

  /// SAVE or a restart among them.
  [[nodiscard]] bool is_order() const;
};

/// A write of this program that went out whole.
struct SentWrite {
  Time at;
  std::uint8_t destination = 0;
  std::uint8_t address = 0;
  std::int64_t value = 0;
};

class Record {
 public:
  void add(const can::Frame& frame, Time at) { frames_.push_back({frame, at}); }

  [[nodiscard]] const std::vector<OnWire>& frames() const { return frames_; }

  /// Requests after which a servo may not be the same.
  [[nodiscard]] std::vector<OnWire> changes() const;

  /// Those of them that carry a value.
  [[nodiscard]] std::vector<SentWrite> writes() const;

  /// The last time at which one of these nodes sent what a client can learn a restart from: an
  /// answer, which it can follow with one more question, or its uptime. The beginning: never.
  [[nodiscard]] Time last_told_by(const std::set<std::uint8_t>& nodes) const;

  /// The first such time; `never`: there is none.
  [[nodiscard]] Time first_told_by(const std::set<std::uint8_t>& nodes) const;

  /// Whether one of these IDs had a NodeStatus between two of a run that have another priority: two
  /// units, heard before the last moment.
  [[nodiscard]] bool shows_two_on(const std::set<std::uint8_t>& nodes) const;

  /// When the vehicle was first said to be armed; `never`: not.
  [[nodiscard]] Time armed_at() const;

  /// When another node first commanded every servo; `never`: not.
  [[nodiscard]] Time driven_at() const;

  [[nodiscard]] Time end() const { return frames_.empty() ? Time{} : frames_.back().at; }

 private:
  std::vector<OnWire> frames_;
};

} // namespace blactl::campaign
