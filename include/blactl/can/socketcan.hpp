#pragma once
// A CAN interface of this machine (can0, vcan0) through the kernel's raw CAN sockets.

#include "blactl/can/arrivals.hpp"
#include "blactl/can/bus.hpp"

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct can_frame; // NOLINT: the kernel's name

namespace blactl::can {

/// One raw socket on one interface (linux/can/raw.h). Frames of other programs on this machine are
/// Received like those of the bus; our own come back as Sent. Only classic CAN.
class SocketCan final : public Bus {
 public:
  /// Opens a CAN interface that is up. Errors: interface (no such interface, not a CAN one, down,
  /// kernel without CAN), permission.
  [[nodiscard]] static Result<std::unique_ptr<Bus>> open(std::string_view interface);

  ~SocketCan() override;
  SocketCan(const SocketCan&) = delete;
  SocketCan& operator=(const SocketCan&) = delete;

  [[nodiscard]] std::string_view name() const override { return name_; }

  [[nodiscard]] Result<bool> send(const Frame& frame) override;
  [[nodiscard]] std::optional<BusEvent> receive() override;

  /// Our own frames always pass: an echo that the kernel filtered out would never be Sent.
  [[nodiscard]] Result<void> filter(std::span<const Filter> filters) override;

  [[nodiscard]] bool echoes() const override { return true; }

  [[nodiscard]] std::string bus_off_hint() const override;

  [[nodiscard]] int descriptor() const override { return descriptor_; }

 private:
  SocketCan(std::string_view name, int descriptor) : name_(name), descriptor_(descriptor) {}

  Result<void> configure();
  Result<void> bind();
  Result<void> apply_filters();
  void read_batch();
  void take(const can_frame& frame, bool is_own, const Arrivals::Arrival& arrival);
  [[nodiscard]] Error broken(int error) const;

  std::string name_;
  int descriptor_;
  std::vector<Filter> filters_;
  std::optional<Filter> echoes_; ///< Matches all frames sent so far.
  std::deque<BusEvent> ready_;
  Arrivals arrivals_;
};

} // namespace blactl::can
