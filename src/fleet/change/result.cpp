#include "blactl/fleet/change/result.hpp"

#include <algorithm>

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

} // namespace blactl::fleet
