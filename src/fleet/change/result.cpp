#include "blactl/fleet/change/result.hpp"

#include "fleet/change/goal_results.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace blactl::fleet {

void ChangeResult::doubt() {
  now.clear();
  is_doubted = true;
  for (RegisterChange& change : changes) {
    change.after = std::nullopt;
    change.status = ChangeStatus::failed;
  }
}

std::vector<Error> ChangeResult::errors() const {
  std::vector<Error> all;
  for (const RegisterChange& change : changes) {
    if (change.error) {
      all.push_back(*change.error);
    }
  }
  if (error) {
    all.push_back(*error);
  }
  return all;
}

bla::Values ChangeResult::after() const {
  bla::Values values = before;
  std::erase_if(values, [&](const auto& held) { return !servo.identity.is_setting(held.first); });
  values.insert(now.begin(), now.end());
  for (const RegisterChange& change : changes) {
    const auto raw = was_begun ? change.after : std::optional(change.requested);
    if (raw) {
      values[change.parameter->address] = *raw;
    } else {
      values.erase(change.parameter->address);
    }
  }
  return values;
}

bool GoalResult::has_differences() const {
  return std::ranges::any_of(
      change.changes, [](const RegisterChange& each) { return each.before != each.requested; });
}

ChangeResult as_planned(const Plan& plan) {
  return {.servo = plan.before.servo,
          .before = plan.before.values(),
          .changes = plan.changes,
          .mode_before = plan.mode_before,
          .mode_after = plan.mode_after,
          .warnings = plan.warnings,
          .saves = plan.restart == RestartKind::save,
          .node_id_after = plan.before.servo.id};
}

std::string_view name(ChangeStatus status) {
  switch (status) {
  case ChangeStatus::planned: return "planned";
  case ChangeStatus::unchanged: return "unchanged";
  case ChangeStatus::written: return "written";
  case ChangeStatus::failed: return "failed";
  case ChangeStatus::mismatch: return "mismatch";
  }
  return {};
}

namespace {

/// From the present to the wanted values.
std::vector<RegisterChange> changes(const Goal& goal, const Snapshot& held) {
  std::vector<RegisterChange> all;
  for (const bla::Assignment& wish : goal.wanted.assignments) {
    const bla::Parameter* parameter = held.servo.identity.parameter(wish.parameter->address);
    if (parameter != nullptr) { // else there will be no plan
      all.push_back(change_from(held.raw(parameter->address), parameter, wish.value.raw));
    }
  }
  return all;
}

/// Updates a register that an earlier round may have changed, from the last one.
void learn(RegisterChange& change, const ChangeResult& last) {
  const auto same = std::ranges::find_if(last.changes, [&](const RegisterChange& each) {
    return each.parameter->address == change.parameter->address;
  });
  if (same == last.changes.end()) {
    if (last.is_doubted) { // a restart that was to show ROM may have replaced it
      change.after = std::nullopt;
      change.status = ChangeStatus::failed;
    }
    return;
  }
  change.after = same->after;
  change.error = same->error;
  const bool was_made = change.is_planned() && same->status == ChangeStatus::unchanged;
  if (same->requested != change.requested) { // a node ID that comes in between
    change.status =
        same->status == ChangeStatus::written ? ChangeStatus::mismatch : ChangeStatus::planned;
  } else {
    change.status = was_made ? ChangeStatus::written : same->status;
  }
}

} // namespace

GoalResult compared(Goal goal, Need need, const Snapshot& held) {
  GoalResult result{.goal = std::move(goal), .need = need};
  ChangeResult& change = result.change;
  change.servo = held.servo;
  change.before = held.values();
  change.changes = changes(result.goal, held);
  change.mode_before = change.mode_after = held.pwm_mode();
  for (const RegisterChange& each : change.changes) {
    if (each.parameter->address == bla::address::pwm_mode) {
      change.mode_after = each.requested;
    }
  }
  change.node_id_after = held.servo.id;
  result.is_done = need == Need::nothing;
  return result;
}

ChangeResult merged(ChangeResult earlier, const ChangeResult& last) {
  ChangeResult all = last;
  all.servo.id = earlier.servo.id; // not the temporary one of an exchange
  all.was_begun = all.was_begun || earlier.was_begun;
  all.was_sent = all.was_sent || earlier.was_sent;
  all.may_have_changed = all.may_have_changed || earlier.may_have_changed;
  all.may_have_saved = all.may_have_saved || earlier.may_have_saved;
  all.was_restarted = all.was_restarted || earlier.was_restarted;
  all.duration += earlier.duration;
  all.before = std::move(earlier.before);
  all.mode_before = earlier.mode_before;
  all.mode_after = earlier.mode_after;
  std::ranges::copy_if(last.warnings, std::back_inserter(earlier.warnings), [&](const Warning& w) {
    return std::ranges::find(earlier.warnings, w.text, &Warning::text) == earlier.warnings.end();
  });
  all.warnings = std::move(earlier.warnings);
  all.changes = std::move(earlier.changes);
  std::ranges::for_each(all.changes, [&](RegisterChange& each) { learn(each, last); });
  return all;
}

} // namespace blactl::fleet
