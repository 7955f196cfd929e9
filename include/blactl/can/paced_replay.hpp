#pragma once
// A log played back at its own pace.

#include "blactl/can/bus.hpp"

#include <memory>
#include <optional>
#include <string_view>

namespace blactl::can {

/// Delivers the events of a recording at their time. The bus clock is the time of the log: it
/// follows the machine's, faster or slower, and stops while paused and after the end.
class PacedReplay final : public Bus {
 public:
  /// `recording`: a bus that delivers events at once and whose clock is the time of the last one.
  explicit PacedReplay(std::unique_ptr<Bus> recording);

  void pause(bool is_paused);

  /// Doubles or halves the speed, between 1/8 and 64 times.
  void go_faster();
  void go_slower();

  /// The speed is two to the power of this.
  [[nodiscard]] int doublings() const { return doublings_; }

  [[nodiscard]] std::string_view name() const override { return recording_->name(); }

  [[nodiscard]] Result<bool> send(const Frame& frame) override { return recording_->send(frame); }

  [[nodiscard]] std::optional<BusEvent> receive() override;

  [[nodiscard]] Result<void> filter(std::span<const Filter> filters) override {
    return recording_->filter(filters);
  }

  [[nodiscard]] bool echoes() const override { return recording_->echoes(); }

  [[nodiscard]] int descriptor() const override { return next_ ? -1 : recording_->descriptor(); }

  [[nodiscard]] bool is_replay() const override { return true; }

  [[nodiscard]] bool is_paced() const override { return true; }

  [[nodiscard]] Time now() const override;
  [[nodiscard]] WallTime wall() const override;
  [[nodiscard]] Time idle_until(Time deadline) override;

 private:
  [[nodiscard]] bool stands() const { return is_paused_ || has_ended_; }

  void set_pace(int doublings);
  void anchor();

  std::unique_ptr<Bus> recording_;
  std::optional<BusEvent> next_; ///< not yet due
  Time next_at_{};
  Time log_{}, machine_{}; ///< the same moment on both clocks
  int doublings_ = 0;
  bool is_paused_ = false;
  bool has_ended_ = false;
};

} // namespace blactl::can
