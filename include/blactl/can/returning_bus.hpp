#pragma once
// A bus that outlives its interface: an adapter that is unplugged and plugged in again.

#include "blactl/can/bus.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace blactl::can {

/// Forwards everything to another bus. When that bus ends (Gone with code interface, after it was
/// open), this one reports Away, refuses frames, and reopens the bus until it is Back. Only for
/// buses in real time.
class ReturningBus final : public Bus {
 public:
  /// Opens the same interface once more.
  using Opener = std::function<Result<std::unique_ptr<Bus>>()>;

  /// Between two tries.
  static constexpr Duration usual_period = std::chrono::seconds(1);

  ReturningBus(std::unique_ptr<Bus> bus, Opener opener, Duration period = usual_period);

  /// Always the name of the first bus.
  [[nodiscard]] std::string_view name() const override { return name_; }

  [[nodiscard]] bool is_open() const override { return bus_ && bus_->is_open(); }

  [[nodiscard]] Result<bool> send(const Frame& frame) override;
  [[nodiscard]] Time send_again_at(Time refused) const override;
  [[nodiscard]] std::optional<BusEvent> receive() override;
  [[nodiscard]] Result<void> filter(std::span<const Filter> filters) override;

  [[nodiscard]] bool echoes() const override { return echoes_; }

  [[nodiscard]] std::uint64_t unreadable() const override {
    return unreadable_ + (bus_ ? bus_->unreadable() : 0);
  }

  [[nodiscard]] std::optional<Error> silence() const override {
    return bus_ ? bus_->silence() : std::nullopt;
  }

  [[nodiscard]] std::string bus_off_hint() const override {
    return bus_ ? bus_->bus_off_hint() : Bus::bus_off_hint();
  }

  [[nodiscard]] bool stamps() const override { return !bus_ || bus_->stamps(); }

  [[nodiscard]] int descriptor() const override { return bus_ ? bus_->descriptor() : -1; }

  [[nodiscard]] bool wants_to_write() const override { return bus_ && bus_->wants_to_write(); }

  [[nodiscard]] Time idle_until(Time deadline) override;

 private:
  [[nodiscard]] std::optional<BusEvent> try_again();
  [[nodiscard]] BusEvent begin_again();
  void leave();

  std::unique_ptr<Bus> bus_; ///< null: away
  Opener opener_;
  Duration period_;
  std::string name_;
  bool echoes_;
  std::vector<Filter> filters_;
  bool has_worked_ = false;     ///< frames have passed, or might have
  bool is_away_ = false;        ///< and has been reported
  std::optional<Error> failed_; ///< an error of send() not yet reported
  Time next_try_{};
  std::uint64_t lost_ = 0, lost_before_ = 0; ///< Overflow: in total, and until it last went away
  std::uint64_t unreadable_ = 0;             ///< of the buses before this one
};

} // namespace blactl::can
