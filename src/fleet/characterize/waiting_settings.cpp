// Measurements of settings that may take effect at the next start only: with the output off 0x08
// shows 0x23 and 0x44, and actuator.Status shows 0x45.

#include "fleet/characterize/findings.hpp"
#include "fleet/characterize/servo_ids.hpp"
#include "fleet/characterize/test_bench.hpp"
#include "fleet/characterize/texts.hpp"

#include <array>
#include <chrono>
#include <cstdlib>

namespace blactl::fleet {

namespace at = bla::address;

namespace {

/// When a setting takes effect; `moved`: the shaft has turned meanwhile.
enum class Effect : std::uint8_t { unseen, at_once, waits, moved };

/// The way from one angle to another, within half a turn: readings may lose whole turns.
std::int64_t way(std::int64_t from, std::int64_t to) {
  constexpr std::int64_t turn = 3600;
  const std::int64_t rest = ((to - from) % turn + turn) % turn;
  return rest > turn / 2 ? rest - turn : rest;
}

/// The same angle, with some play and noise; angles to be told apart differ by more than twice
/// that.
bool are_alike(std::int64_t angle, std::int64_t other) {
  constexpr std::int64_t play_decideg = 20;
  return std::abs(way(angle, other)) <= play_decideg;
}

bool are_apart(std::int64_t angle, std::int64_t other) {
  constexpr std::int64_t least_decideg = 100;
  return std::abs(way(angle, other)) >= least_decideg;
}

/// What 0x08 reads after 0x23 is switched, if 0x44 = `origin` turns round with it: both readings
/// are the angle of the shaft less the origin, in opposite counts.
std::int64_t turned(std::int64_t angle, std::int64_t origin) {
  return -angle - 2 * origin;
}

Result<std::int64_t> angle_with(TestBench& bench, bla::Address address, std::int64_t raw) {
  constexpr Duration until_read = std::chrono::milliseconds(50);
  auto set = bench.set(address, raw);
  set = set ? bench.pause(until_read) : set;
  return set ? bench.read(at::current_angle) : std::unexpected(set.error());
}

/// What the settings of the count have shown.
struct Count {
  Effect origin = Effect::unseen, reverse = Effect::unseen;
  std::optional<bool> turns{}; ///< 0x44 turns round with 0x23
};

/// Moves the origin to where the next step can tell everything apart. Returns what 0x08 reads then.
Result<std::int64_t> see_origin(TestBench& bench, std::int64_t angle, Count& count,
                                std::int64_t& origin) {
  const std::int64_t held = bench.held(at::origin).value_or(0);
  std::int64_t now = angle;
  for (const std::int64_t wanted : {450, -450, 700, -700, 250}) {
    if (!are_apart(wanted, held)) {
      continue;
    }
    const auto read = angle_with(bench, at::origin, origin = wanted);
    if (!read) {
      return read;
    }
    now = *read;
    const std::int64_t moved = way(angle, now);
    count.origin = are_alike(std::abs(moved), std::abs(way(held, wanted))) ? Effect::at_once
                   : are_alike(moved, 0)                                   ? Effect::waits
                                                                           : Effect::moved;
    const bool tells = are_apart(now, -now) && are_apart(now, turned(now, wanted)) &&
                       are_apart(-now, turned(now, wanted));
    if (count.origin != Effect::at_once || tells) {
      break;
    }
  }
  return now;
}

/// Switches 0x23; `angle`: what 0x08 reads before.
Result<void> see_reverse(TestBench& bench, std::int64_t angle, std::int64_t origin, Count& count) {
  const std::int64_t held = bench.held(at::reverse).value_or(0);
  const auto read = angle_with(bench, at::reverse, 1 - held);
  if (!read) {
    return std::unexpected(read.error());
  }
  const bool acts = count.origin == Effect::at_once;
  const std::int64_t round = turned(angle, origin);
  const bool may_be_round = acts && are_alike(*read, round);
  if (!are_apart(angle, -angle)) {
    count.reverse = Effect::unseen;
  } else if (are_alike(*read, -angle)) {
    count.reverse = Effect::at_once;
    count.turns = acts ? std::optional(false) : std::nullopt;
  } else if (may_be_round && are_apart(round, angle)) {
    count.reverse = Effect::at_once;
    count.turns = true;
  } else if (are_alike(*read, angle)) { // at the horn notch this is what turning round reads, too
    count.reverse = may_be_round ? Effect::unseen : Effect::waits;
  } else {
    count.reverse = acts ? Effect::moved : Effect::unseen;
  }
  return {};
}

/// In the end both are as they were, and so must the angle be.
Result<Count> see_count(TestBench& bench) {
  Count count;
  std::int64_t origin = 0;
  const auto angle = bench.read(at::current_angle);
  const auto now = angle ? see_origin(bench, *angle, count, origin) : angle;
  const auto seen = now ? see_reverse(bench, *now, origin, count) : std::unexpected(now.error());
  auto back = seen ? angle_with(bench, at::reverse, bench.held(at::reverse).value_or(0))
                   : std::unexpected(seen.error());
  back = back ? angle_with(bench, at::origin, bench.held(at::origin).value_or(0)) : back;
  if (!back) {
    return std::unexpected(back.error());
  }
  const bool has_moved =
      !are_alike(*angle, *back) || count.origin == Effect::moved || count.reverse == Effect::moved;
  return has_moved ? Count{.origin = Effect::moved, .reverse = Effect::moved} : count;
}

Result<Effect> see_servo_id(TestBench& bench) {
  const auto other = free_servo_id(bench);
  const auto taken =
      other ? take_servo_id(bench, *other) : Result<ServoIdTaken>(ServoIdTaken::unseen);
  if (!taken) {
    return std::unexpected(taken.error());
  }
  return *taken == ServoIdTaken::at_once ? Effect::at_once
         : *taken == ServoIdTaken::waits ? Effect::waits
                                         : Effect::unseen;
}

std::string words(Effect effect) {
  return effect == Effect::at_once ? say<texts::bench_acts_at_once>()
         : effect == Effect::waits ? say<texts::bench_acts_later>()
                                   : say<texts::bench_acts_unseen>();
}

/// 0x27 shows itself with the output on only: it is taken to be like the others.
void conclude_waiting(const Count& count, Effect servo_id, Notes& notes) {
  const auto may_be = [&](Effect effect) {
    const auto fits = [&](Effect seen) { return seen == effect || seen == Effect::unseen; };
    return fits(count.origin) && fits(count.reverse) && fits(servo_id);
  };
  if (count.origin == Effect::moved) {
    notes.leave("settings_wait_for_start", say<texts::bench_shaft_turned>());
  } else if (count.origin != Effect::unseen && may_be(count.origin)) {
    notes.found("settings_wait_for_start", count.origin == Effect::waits);
  } else {
    notes.leave("settings_wait_for_start",
                say<texts::bench_settings_differ>(words(count.reverse), words(count.origin),
                                                  words(servo_id)));
  }
}

} // namespace

Result<void> measure_waiting_settings(TestBench& bench, Notes& notes) {
  const auto count = see_count(bench);
  const auto servo_id = count ? see_servo_id(bench) : std::unexpected(count.error());
  if (!servo_id) {
    return std::unexpected(servo_id.error());
  }
  conclude_waiting(*count, *servo_id, notes);
  if (count->turns) {
    notes.found("reverse_turns_origin", *count->turns);
  } else if (count->origin == Effect::moved) {
    notes.leave("reverse_turns_origin", say<texts::bench_shaft_turned>());
  } else if (count->origin == Effect::at_once && count->reverse == Effect::unseen) {
    notes.leave("reverse_turns_origin", say<texts::bench_at_zero>());
  } else {
    notes.leave("reverse_turns_origin", say<texts::bench_count_waits>());
  }
  return {};
}

} // namespace blactl::fleet
