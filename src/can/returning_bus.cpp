#include "blactl/can/returning_bus.hpp"

#include <algorithm>
#include <utility>

namespace blactl::can {

ReturningBus::ReturningBus(std::unique_ptr<Bus> bus, Opener opener, Duration period)
    : bus_(std::move(bus)), opener_(std::move(opener)), period_(period), name_(bus_->name()),
      echoes_(bus_->echoes()), has_worked_(bus_->is_open()) {}

/// A device must be closed before it can be opened again.
void ReturningBus::leave() {
  unreadable_ += bus_->unreadable();
  lost_before_ = lost_;
  bus_.reset();
  next_try_ = now() + period_;
}

Result<bool> ReturningBus::send(const Frame& frame) {
  if (!bus_ || failed_) {
    return false;
  }
  auto taken = bus_->send(frame);
  if (taken || taken.error().code != Code::interface) {
    return taken;
  }
  failed_ = taken.error();
  return false;
}

Time ReturningBus::send_again_at(Time refused) const {
  return bus_ && !failed_ ? bus_->send_again_at(refused) : std::max(refused + period_, next_try_);
}

std::optional<BusEvent> ReturningBus::receive() {
  if (!bus_) {
    return try_again();
  }
  auto event = failed_ ? std::optional<BusEvent>(Gone{*std::exchange(failed_, std::nullopt)})
                       : bus_->receive();
  if (!event) {
    return std::nullopt;
  }
  if (auto* gone = std::get_if<Gone>(&*event)) {
    if (!has_worked_ || gone->error.code != Code::interface) {
      return event;
    }
    leave();
    return std::exchange(is_away_, true) ? std::nullopt
                                         : std::optional<BusEvent>(Away{std::move(gone->error)});
  }
  if (auto* overflow = std::get_if<Overflow>(&*event)) {
    lost_ = overflow->lost += lost_before_;
  } else if (std::holds_alternative<Opened>(*event)) {
    has_worked_ = true;
    return is_away_ ? begin_again() : std::move(*event);
  }
  return event;
}

std::optional<BusEvent> ReturningBus::try_again() {
  if (now() < next_try_) {
    return std::nullopt;
  }
  next_try_ = now() + period_;
  auto opened = opener_();
  if (!opened || !(*opened)->filter(filters_)) {
    return std::nullopt;
  }
  bus_ = std::move(*opened);
  return bus_->is_open() ? std::optional(begin_again()) : std::nullopt;
}

BusEvent ReturningBus::begin_again() {
  is_away_ = false;
  return Back{};
}

Result<void> ReturningBus::filter(std::span<const Filter> filters) {
  filters_.assign(filters.begin(), filters.end());
  return bus_ ? bus_->filter(filters) : Result<void>();
}

Time ReturningBus::idle_until(Time deadline) {
  if (failed_) {
    return now();
  }
  return bus_ ? bus_->idle_until(deadline) : std::min(deadline, next_try_);
}

} // namespace blactl::can
