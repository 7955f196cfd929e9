#include "blactl/can/paced_replay.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::can {
namespace {

constexpr int slowest = -3, fastest = 6;

/// The longest wait, because a log may hold any time.
constexpr Duration longest_wait = std::chrono::hours(1);

Duration multiplied(Duration time, int doublings) {
  return doublings >= 0 ? time * (1 << doublings) : time / (1 << -doublings);
}

/// The time of an event; empty: it has none and is due now.
std::optional<Time> time_of(const BusEvent& event) {
  if (const auto* received = std::get_if<Received>(&event)) {
    return received->at;
  }
  const auto* fault = std::get_if<BusFault>(&event);
  return fault != nullptr ? std::optional(fault->at) : std::nullopt;
}

} // namespace

PacedReplay::PacedReplay(std::unique_ptr<Bus> recording)
    : recording_(std::move(recording)), log_(recording_->now()), machine_(Bus::now()) {}

Time PacedReplay::now() const {
  return stands() ? log_ : log_ + multiplied(Bus::now() - machine_, doublings_);
}

/// The recording may be ahead.
WallTime PacedReplay::wall() const {
  return recording_->wall() - (recording_->now() - now());
}

/// Makes this moment the origin of both clocks.
void PacedReplay::anchor() {
  log_ = now();
  machine_ = Bus::now();
}

void PacedReplay::pause(bool is_paused) {
  anchor();
  is_paused_ = is_paused;
}

void PacedReplay::set_pace(int doublings) {
  anchor();
  doublings_ = std::clamp(doublings, slowest, fastest);
}

void PacedReplay::go_faster() {
  set_pace(doublings_ + 1);
}

void PacedReplay::go_slower() {
  set_pace(doublings_ - 1);
}

std::optional<BusEvent> PacedReplay::receive() {
  if (!next_) {
    next_ = recording_->receive();
    next_at_ = next_ ? time_of(*next_).value_or(now()) : Time{};
  }
  if (!next_ || next_at_ > now()) {
    return std::nullopt;
  }
  if (std::holds_alternative<Ended>(*next_)) {
    anchor();
    has_ended_ = true;
  }
  return std::exchange(next_, std::nullopt);
}

Time PacedReplay::idle_until(Time deadline) {
  if (stands()) {
    return never;
  }
  const bool looks_again = !next_ && recording_->idle_until(deadline) < deadline;
  const Time due = looks_again ? now() : next_ ? std::min(deadline, next_at_) : deadline;
  if (due == never) {
    return never;
  }
  const Duration wait = std::clamp(due - now(), Duration::zero(), longest_wait);
  return now() + multiplied(wait, -doublings_);
}

} // namespace blactl::can
