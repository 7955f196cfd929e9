#include "cli/change/entries_view.hpp"

#include "blactl/fleet/change/saved_plan.hpp"

#include "cli/change/result_view.hpp"
#include "cli/change/texts.hpp"
#include "cli/output/fleet_view.hpp"
#include "cli/output/node_head.hpp"

#include <algorithm>
#include <iterator>
#include <optional>

namespace blactl::cli {

using fleet::EntryStatus;
using fleet::GoalResult;
using fleet::Need;
using fleet::RegisterChange;

namespace {

constexpr std::size_t screen_lines = 24;

std::size_t differences(const GoalResult& result) {
  return static_cast<std::size_t>(
      std::ranges::count_if(result.change.changes, [](const RegisterChange& change) {
        return change.before != change.requested;
      }));
}

bool was_written(const GoalResult& result) {
  return result.change.saved ||
         std::ranges::any_of(result.change.changes, [](const RegisterChange& change) {
           return change.status == fleet::ChangeStatus::written;
         });
}

std::string plan_text(const GoalResult& result, const Page& page) {
  switch (result.need) {
  case Need::write:
    return page.paint(
        Tone::warning,
        result.goal.saves()
            ? say<texts::apply_would_write_save>(differences(result), result.change.changes.size())
            : say<texts::apply_would_write>(differences(result), result.change.changes.size()));
  case Need::save: return page.paint(Tone::warning, say<texts::apply_would_save>());
  case Need::prove:
    return page.paint(Tone::warning, say<texts::apply_would_prove>(result.change.changes.size()));
  case Need::nothing: break;
  }
  return page.paint(Tone::good, result.rom_proven ? say<texts::apply_unchanged_proven>()
                                                  : say<texts::apply_unchanged>());
}

std::string changed_text(const GoalResult& result) {
  if (!result.change.saved) {
    return say<texts::apply_changed_ram>(differences(result), result.change.changes.size());
  }
  return result.has_differences()
             ? say<texts::apply_changed>(differences(result), result.change.changes.size())
             : say<texts::apply_saved>();
}

std::string end_text(const GoalResult& result, const Page& page) {
  const bool is_back = result.change.node_id_after && result.change.duration > Duration::zero();
  const std::string back = is_back ? say<texts::apply_back>(result.change.node_id_after->value(),
                                                            seconds_text(result.change.duration))
                                   : std::string();
  switch (entry_status(result, false)) {
  case EntryStatus::failed: return page.paint(Tone::bad, say<texts::apply_failed>());
  case EntryStatus::skipped: return page.paint(Tone::warning, say<texts::apply_skipped>());
  case EntryStatus::changed: return page.paint(Tone::good, changed_text(result)) + back;
  default: return plan_text({.goal = result.goal, .rom_proven = result.rom_proven}, page) + back;
  }
}

std::string servo_text(const GoalResult& result, bool is_plan, const Page& page) {
  std::string out = title(result.goal.name, result.servo()) + ": " +
                    (is_plan ? plan_text(result, page) : end_text(result, page)) + '\n';
  const bool has_failed = !is_plan && entry_status(result, false) == EntryStatus::failed;
  std::vector<RegisterChange> shown;
  std::ranges::copy_if(result.change.changes, std::back_inserter(shown),
                       [&](const RegisterChange& change) {
                         return change.before != change.requested || change.error;
                       });
  if ((is_plan || has_failed) && !shown.empty()) {
    out += changes_table(shown,
                         {.mode_before = result.change.mode_before,
                          .mode_after = result.change.mode_after,
                          .was_begun = !is_plan},
                         page);
  }
  return out;
}

void write_servo(JsonWriter& json, const GoalResult& result, bool is_plan) {
  json.begin_object();
  write_head(json, result.servo());
  json.member("name", result.goal.name.empty() ? std::nullopt : std::optional(result.goal.name));
  json.member("status", fleet::name(entry_status(result, is_plan)));
  if (is_plan) {
    json.member("action", fleet::name(result.need));
    json.member("saves", result.goal.saves());
    json.member("config_sha256", fleet::settings_sha256(result));
  }
  write_changes(json, result.change.changes);
  json.member("saved", result.change.saved);
  json.member("verified_after_restart", result.rom_proven.value_or(false));
  json.key("node_id_after");
  result.change.node_id_after ? json.value(result.change.node_id_after->value())
                              : json.value(nullptr);
  json.key("duration_s");
  json.number(seconds_text(result.change.duration));
  write_warnings(json, result.change.warnings);
  json.end_object();
}

std::string counts_text(std::span<const GoalResult> results, bool is_plan) {
  const auto count = [&](EntryStatus status) {
    return std::ranges::count_if(
        results, [&](const GoalResult& result) { return entry_status(result, is_plan) == status; });
  };
  return is_plan
             ? say<texts::apply_plan_counts>(results.size(),
                                             std::ssize(results) - count(EntryStatus::unchanged),
                                             count(EntryStatus::unchanged))
             : say<texts::apply_counts>(results.size(), count(EntryStatus::changed),
                                        count(EntryStatus::unchanged), count(EntryStatus::failed),
                                        count(EntryStatus::skipped));
}

} // namespace

EntryStatus entry_status(const GoalResult& result, bool is_plan) {
  if (is_plan) {
    return result.need == Need::nothing ? EntryStatus::unchanged : EntryStatus::different;
  }
  if (result.is_done) {
    return was_written(result) ? EntryStatus::changed : EntryStatus::unchanged;
  }
  return result.change.was_begun || !result.errors.empty() ? EntryStatus::failed
                                                           : EntryStatus::skipped;
}

std::vector<Error> errors_of(const GoalResult& result, bool is_plan) {
  std::vector<Error> errors = result.errors;
  if (!is_plan && !result.is_done && errors.empty()) {
    const std::uint8_t id = result.servo().id.value();
    errors.push_back({Code::state,
                      result.change.was_sent ? say<texts::apply_only_restarted>(id)
                                             : say<texts::apply_not_begun>(id),
                      {},
                      id});
  }
  return errors;
}

void write_json(JsonWriter& json, std::span<const GoalResult> results,
                std::span<const fleet::EntryDiff> others, bool is_plan) {
  json.key("nodes");
  json.begin_array();
  for (const GoalResult& result : results) {
    write_servo(json, result, is_plan);
  }
  for (const fleet::EntryDiff& entry : others) {
    write_entry(json, entry);
  }
  json.end_array();
}

std::string text(std::span<const GoalResult> results, std::span<const fleet::EntryDiff> others,
                 bool is_plan, const Page& page) {
  std::string out;
  for (const GoalResult& result : results) {
    const bool is_well =
        entry_status(result, is_plan) == EntryStatus::unchanged || (!is_plan && result.is_done);
    if (results.size() <= screen_lines || !is_well) {
      out += servo_text(result, is_plan, page);
    }
  }
  return out + text(others, {}, {}, page) + counts_text(results, is_plan);
}

} // namespace blactl::cli
