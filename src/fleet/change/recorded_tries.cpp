// How the record goes on after earlier tries of the same command.

#include "blactl/fleet/change/history.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace blactl::fleet {

using dronecan::UniqueId;

namespace {

/// Commands that bring a fleet to a goal: what is done of it for one servo is not done before all.
bool has_one_goal(std::string_view command) {
  return command == "apply" || command == "alloc --static";
}

/// Commands that complete an unfinished run when repeated.
bool is_repeated_as_a_whole(std::string_view command) {
  return has_one_goal(command) || command == "undo" || command == replacing ||
         command == erase_keeping_ids;
}

} // namespace

/// The last change of this unit, if a try of this command has made it and did not end. Empty: it is
/// another.
Result<std::optional<state::SnapshotEntry>> History::unfinished(const Servo& servo) const {
  auto last = is_repeated_as_a_whole(command_) ? last_of(servo)
                                               : Result<std::optional<state::SnapshotEntry>>();
  const bool is_other = last && *last && ((*last)->ended || (*last)->command != command_);
  return is_other ? Result<std::optional<state::SnapshotEntry>>() : last;
}

Result<void> History::go_on(std::span<const Servo> units, WallTime now) {
  std::vector<state::SnapshotEntry> tries;
  for (const Servo& unit : units) {
    auto tried = unfinished(unit);
    if (!tried) {
      return std::unexpected(tried.error());
    }
    if (*tried) {
      run_ = joined_ = std::max(run_, (*tried)->run);
      tries.push_back(std::move(**tried));
    }
  }
  return gather(tries, now);
}

/// Tries that named some of the units each are one change with this command.
Result<void> History::gather(std::span<const state::SnapshotEntry> tries, WallTime now) {
  std::vector<state::SnapshotEntry> gathered;
  for (const state::SnapshotEntry& tried : tries) {
    const bool is_apart = tried.run != run_;
    for (auto each = std::optional(tried); is_apart && each && each->run == tried.run;) {
      auto earlier = snapshots_.before(*each);
      if (!earlier) {
        return std::unexpected(earlier.error());
      }
      gathered.push_back(std::move(*each));
      gathered.back().run = run_;
      each = std::move(*earlier);
    }
  }
  const auto kept =
      gathered.empty() ? Result<std::vector<std::int64_t>>() : snapshots_.keep(gathered, now);
  return kept ? Result<void>() : std::unexpected(kept.error());
}

/// Resumes after tries of this command that ended half way. What they changed in RAM only, a
/// restart has taken back; what they have saved stays an entry of its own, to which undo goes back
/// through this one, unless this one changes RAM only.
Result<void> History::resume(const Plan& plan, const Session& session) {
  const Servo& servo = plan.before.servo;
  const UniqueId& unique_id = *servo.unique_id;
  if (kept_.contains(unique_id)) {
    return {};
  }
  auto last = unfinished(servo);
  if (!last || !*last) {
    return last ? Result<void>() : std::unexpected(last.error());
  }
  state::SnapshotEntry& tried = **last;
  const bool has_restarted = is_over(tried, plan.before, session);
  const auto joined = has_restarted && plan.restart ? join(tried, plan, session) : Result<void>();
  if (!joined || (has_restarted && tried.saved)) {
    return joined;
  }
  run_ = joined_ = std::max(run_, tried.run);
  if (has_restarted) {
    tried.held.clear();
    tried.written.clear();
  }
  const bool was_saved = tried.saved && tried.settled;
  kept_[unique_id] = {.entry = std::move(tried),
                      .was_changed = !has_restarted,
                      .was_saved = was_saved,
                      .is_another_try = true};
  return {};
}

/// Whether the servo has restarted since a try that broke off: RAM itself tells, where its last
/// write or the clock leaves that open.
bool History::is_over(const state::SnapshotEntry& tried, const Snapshot& ram,
                      const Session& session) {
  const auto started = start_of(ram.servo, session);
  if (!started) {
    return false;
  }
  const bool has_written = !tried.saved && !tried.written.empty();
  const bool is_before = (has_written ? last_write(tried) : tried.at) < *started;
  if (is_before && is_of_this_clock(tried, session)) {
    return true;
  }
  const bool is_open = is_before || tried.at < *started || tried.at > session.wall();
  return is_open && !is_shown(tried, ram).value_or(!is_before);
}

/// Goes on after tries that were saved: undo goes back through them, as far as they are still
/// there. An ID always is: it may be a temporary one, which the tries do not name.
Result<void> History::join(state::SnapshotEntry tried, const Plan& plan, const Session& session) {
  const std::int64_t run = tried.run;
  run_ = joined_ = std::max(run_, run);
  const bla::Values rom = known_rom(plan.before, session); // another tool's trial replaces nothing
  std::map<std::uint8_t, std::set<std::int64_t>> written;  // a try may have broken off before it
  const auto is_replaced = [&](std::uint8_t number) {
    const auto values = written.find(number);
    const bla::Address address(number);
    const auto is_written = [&](std::optional<std::int64_t> raw) {
      return raw && values->second.contains(*raw);
    };
    return values != written.end() && !bla::is_id(address) &&
           !is_written(plan.before.raw(address)) && !is_written(bla::find(rom, address));
  };
  std::vector<state::SnapshotEntry> shorter;
  for (std::optional<state::SnapshotEntry> each = std::move(tried); each && each->run == run;) {
    auto earlier = snapshots_.before(*each);
    if (!earlier) {
      return std::unexpected(earlier.error());
    }
    for (const auto& [address, raw] : each->written) {
      written[address].insert(raw);
    }
    if (std::erase_if(each->held, [&](const auto& held) { return is_replaced(held.first); }) > 0) {
      shorter.push_back(std::move(*each));
    }
    each = std::move(*earlier);
  }
  const auto kept = shorter.empty() ? Result<std::vector<std::int64_t>>()
                                    : snapshots_.keep(shorter, session.wall());
  return kept ? Result<void>() : std::unexpected(kept.error());
}

/// Servos that were done in an earlier try, while others were not: what others have changed since
/// is left out of that try, too.
Result<void> History::join_done(std::span<const Plan> plans, const Session& session) {
  for (const Plan& plan : plans) {
    const auto& unique_id = plan.before.servo.unique_id;
    if (joined_ == 0 || !unique_id || kept_.contains(*unique_id)) {
      continue;
    }
    auto last = last_of(plan.before.servo);
    if (!last) {
      return std::unexpected(last.error());
    }
    const bool is_done = *last && (*last)->ended && (*last)->run == joined_;
    auto joined = is_done ? join(std::move(**last), plan, session) : Result<void>();
    if (!joined) {
      return joined;
    }
  }
  return {};
}

/// Whether the record of this unit is that of an earlier run of the command.
bool History::is_another_try(const UniqueId& unit) const {
  const auto known = kept_.find(unit);
  return known != kept_.end() && known->second.is_another_try;
}

/// Of the tries that these entries continue: other commands may have come in between.
std::vector<std::int64_t>
History::former_numbers(std::span<const state::SnapshotEntry> entries) const {
  std::vector<std::int64_t> numbers;
  for (const state::SnapshotEntry& entry : entries) {
    if (is_another_try(entry.unique_id)) {
      numbers.push_back(kept_.at(entry.unique_id).entry.number);
    }
  }
  return numbers;
}

Result<void> History::end(std::span<const UniqueId> units, bool are_all) {
  const bool has_ended = are_all || !has_one_goal(command_);
  return is_repeated_as_a_whole(command_) && has_ended && !units.empty()
             ? snapshots_.end(units, command_)
             : Result<void>();
}

} // namespace blactl::fleet
