#include "blactl/sim/servo/command_timer.hpp"

#include "unit/sim/support.hpp"

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;

namespace {

constexpr Duration limit = 1s;
constexpr Time start = Time{} + 5s;

CommandTimer started(bool pwm_waits = false) {
  CommandTimer timer;
  timer.start(start, pwm_waits);
  return timer;
}

} // namespace

TEST_CASE("the timeout counts from the start, then from the last command") {
  CommandTimer timer = started();
  CHECK_FALSE(timer.timed_out(start + 1s - 1us, limit));
  CHECK(timer.timed_out(start + 1s, limit)); // requirement 145: 0x27 or longer
  timer.commanded(start + 500ms);
  CHECK_FALSE(timer.timed_out(start + 1500ms - 1us, limit));
  timer.commanded_by_can(start + 600ms, true);
  CHECK_FALSE(timer.timed_out(start + 1600ms - 1us, limit));
  CHECK(timer.timed_out(start + 1600ms, limit));
}

TEST_CASE("PWM counts from the start, and from 0x27 after a command by CAN") {
  CommandTimer timer = started();
  CHECK(timer.accepts_pwm(start, limit));
  timer.commanded_by_can(start + 100ms, true);
  CHECK_FALSE(timer.accepts_pwm(start + 1100ms - 1us, limit));
  CHECK(timer.accepts_pwm(start + 1100ms, limit));
  timer.commanded(start + 1100ms); // by PWM
  CHECK(timer.accepts_pwm(start + 1100ms, limit));
  CHECK_FALSE(started(true).accepts_pwm(start + 999ms, limit));
  CHECK(started(true).accepts_pwm(start + 1s, limit));
  CommandTimer other = started();
  other.commanded_by_can(start + 100ms, true, false); // one that PWM does not mind
  CHECK(other.accepts_pwm(start + 100ms, limit));
  CHECK_FALSE(other.timed_out(start + 1100ms - 1us, limit));
}

TEST_CASE("the next change by time alone is never missed") {
  const auto checked = [](const CommandTimer& timer) {
    Time at = start + 100ms;
    int changes = 0;
    for (Time next = timer.next_change(at, limit); next != never; ++changes) {
      const auto state = [&](Time time) {
        return std::pair(timer.timed_out(time, limit), timer.accepts_pwm(time, limit));
      };
      CHECK(state(next - 1us) == state(at));
      CHECK(state(next) != state(at));
      at = next;
      next = timer.next_change(at, limit);
    }
    return changes;
  };
  CommandTimer timer = started();
  CHECK(checked(timer) == 1); // the timeout
  timer.commanded_by_can(start + 50ms, true);
  CHECK(checked(timer) == 1); // PWM counts again, at the moment of the timeout
  timer.commanded_by_can(start + 70ms, false);
  CHECK(checked(timer) == 2); // the other way round
}
