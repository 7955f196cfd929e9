#pragma once
// Whether the servo of a visit is still on the bench, by its periods.

#include "blactl/base/time.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/ticker.hpp"

#include <functional>

namespace blactl::fleet {

class AbsenceWatch {
 public:
  /// `hook` is called when every servo has fallen silent, and when one is heard again.
  AbsenceWatch(Session& session, std::function<void(bool is_away)> hook);

  /// Whether it has been ordered to restart: then a longer silence is no absence.
  void expect_restart(bool is_expected) { is_restarting_ = is_expected; }

  /// Whether it was away at any time, without an order to restart.
  [[nodiscard]] bool was_away() const { return was_away_; }

 private:
  void look();

  Session& session_;
  std::function<void(bool is_away)> hook_;
  Time began_;
  bool is_restarting_ = false;
  bool is_away_ = false;
  bool was_away_ = false;
  Ticker ticker_;
};

} // namespace blactl::fleet
