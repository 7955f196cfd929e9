#include "cli/trace/stats_screen.hpp"

namespace blactl::cli {

void StatsScreen::begin(Time now) {
  due_ = stats_ != nullptr && reporter_.has_screen() ? now + period : never;
}

void StatsScreen::pass(Time now) {
  if (stats_ != nullptr) {
    stats_->pass(now);
  }
}

Result<bool> StatsScreen::advance(Time now) {
  if (now < due_) {
    return true;
  }
  due_ = now + period;
  has_shown_ = true;
  return reporter_.show(stats_->text(reporter_.page()));
}

Result<bool> StatsScreen::end() {
  return has_shown_ ? reporter_.show("") : Result<bool>(true);
}

} // namespace blactl::cli
