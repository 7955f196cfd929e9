#pragma once
// Regular calls for progress displays.

#include "blactl/dronecan/service.hpp"
#include "blactl/fleet/bus/session.hpp"

#include <functional>
#include <utility>

namespace blactl::fleet {

/// Calls a hook once every `period` during its lifetime; never on a recording, where there is no
/// waiting.
class Ticker final : private dronecan::Service {
 public:
  /// `session` outlives this.
  Ticker(Session& session, Duration period, std::function<void()> hook)
      : session_(session), period_(period), hook_(std::move(hook)), due_(session.now() + period) {
    session_.attach(*this);
  }

  ~Ticker() override { session_.detach(*this); }

  Ticker(const Ticker&) = delete;
  Ticker(Ticker&&) = delete;
  Ticker& operator=(const Ticker&) = delete;
  Ticker& operator=(Ticker&&) = delete;

 private:
  void receive(const dronecan::Transfer& /*transfer*/) override {}

  [[nodiscard]] Time next_deadline() const override { return due_; }

  void advance(Time now) override {
    if (now >= due_) {
      due_ = now + period_;
      hook_();
    }
  }

  Session& session_;
  Duration period_;
  std::function<void()> hook_;
  Time due_;
};

} // namespace blactl::fleet
