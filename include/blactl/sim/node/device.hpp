#pragma once
// A node on a simulated bus, as a state machine without I/O.

#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"

#include <functional>
#include <utility>

namespace blactl::sim {

class Device {
 public:
  using Sink = std::function<void(const can::Frame&)>;

  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// `sink` receives the device's frames, in the order of sending.
  void connect(Sink sink) { sink_ = std::move(sink); }

  /// Handles a frame of another node.
  virtual void receive(const can::Frame& frame, Time at) = 0;

  /// The latest time for the next advance(); one in the past means now.
  [[nodiscard]] virtual Time next_deadline() const = 0;

  /// Does whatever is due. Time never goes back.
  virtual void advance(Time now) = 0;

 protected:
  Device() = default;

  void send(const can::Frame& frame) const {
    if (sink_) {
      sink_(frame);
    }
  }

 private:
  Sink sink_;
};

} // namespace blactl::sim
