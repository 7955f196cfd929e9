#include "cli/change/result_view.hpp"

#include "blactl/bla/value.hpp"

#include "cli/change/entries_view.hpp"
#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <chrono>
#include <optional>

namespace blactl::cli {

using fleet::ChangeResult;
using fleet::ChangeStatus;
using fleet::RegisterChange;

std::string seconds_text(Duration duration) {
  return fmt::format("{:.3f}", std::chrono::duration<double>(duration).count());
}

namespace {

void write_change(JsonWriter& json, const RegisterChange& change) {
  json.member("address", change.parameter->address.name());
  json.member("name", change.parameter->name);
  json.member("before", change.before);
  json.member("requested", change.requested);
  json.member("after", change.after);
  json.member("status", name(change.status));
}

void write_servo(JsonWriter& json, const ChangeResult& result) {
  json.member("status", result.is_done() ? "done" : "failed");
  json.key("node_id_after");
  result.node_id_after ? json.value(result.node_id_after->value()) : json.value(nullptr);
  json.key("duration_s");
  json.number(seconds_text(result.duration));
}

} // namespace

void write_warnings(JsonWriter& json, std::span<const fleet::Warning> warnings) {
  if (warnings.empty()) {
    return;
  }
  json.objects("warnings", warnings, [&](const fleet::Warning& warning) {
    json.member("code", warning.code);
    json.member("text", warning.text);
  });
}

namespace {

std::string status_text(ChangeStatus status, bool was_begun, const Page& page) {
  switch (status) {
  case ChangeStatus::planned:
    return was_begun ? say<texts::set_not_written>() : say<texts::set_planned>();
  case ChangeStatus::unchanged: return say<texts::set_unchanged>();
  case ChangeStatus::written: return page.paint(Tone::good, say<texts::set_written>());
  case ChangeStatus::failed: return page.paint(Tone::bad, say<texts::set_failed>());
  case ChangeStatus::mismatch: return page.paint(Tone::bad, say<texts::set_mismatch>());
  }
  return {};
}

std::string end_text(const ChangeResult& result) {
  if (!result.is_done()) {
    return result.returned ? say<texts::back_but_failed>(result.returned->value())
                           : say<texts::servo_failed>();
  }
  return result.returned
             ? say<texts::servo_back>(result.returned->value(), seconds_text(result.duration))
             : say<texts::servo_done>();
}

std::string servo_text(const ChangeResult& result, const Page& page) {
  std::string out = head_line(result.servo) + "  " +
                    page.paint(result.is_done() ? Tone::good : Tone::bad, end_text(result));
  if (result.is_done() && result.values_read > 0) {
    out += say<texts::values_read_again>(result.values_read);
  }
  return out + '\n';
}

/// Whether SAVE could keep it, and a restart drops it.
bool is_in_ram_only(const RegisterChange& change) {
  return change.status == ChangeStatus::written && change.parameter->saved;
}

} // namespace

void write_changes(JsonWriter& json, std::span<const RegisterChange> changes) {
  json.objects("changes", changes,
               [&](const RegisterChange& change) { write_change(json, change); });
}

void write_changes(JsonWriter& json, const ChangeResult& result) {
  write_changes(json, result.changes);
  json.member("saved", result.saved);
  write_warnings(json, result.warnings);
}

std::string changes_table(std::span<const RegisterChange> changes, const TableStyle& style,
                          const Page& page) {
  // in Japanese the specification's name is shown beside the typed one
  const bool shows_names = language() == Language::japanese;
  std::vector<std::string> header{"", say<texts::column_parameter>(), say<texts::column_before>(),
                                  "", say<texts::column_after>(),     ""};
  if (shows_names) {
    header.push_back(say<texts::column_meaning>());
  }
  Table table(std::move(header));
  for (const RegisterChange& change : changes) {
    const bla::Parameter& parameter = *change.parameter;
    const auto shown = [&](const std::optional<std::int64_t>& raw,
                           const std::optional<std::int64_t>& mode) {
      return raw ? bla::register_text(parameter, *raw, mode) : say<texts::unknown_value>();
    };
    const bool is_shown = change.is_planned() && !style.was_begun;
    const auto after = is_shown ? std::optional(change.requested) : change.after;
    std::vector<std::string> row{parameter.address.name(),
                                 parameter.name,
                                 shown(change.before, style.mode_before),
                                 "->",
                                 shown(after, style.mode_after),
                                 status_text(change.status, style.was_begun, page)};
    if (shows_names) {
      row.push_back(parameter.name_ja);
    }
    table.add(std::move(row));
  }
  return table.text("  ", page);
}

std::string changes_text(const ChangeResult& result, const Page& page) {
  return head_line(result.servo) + changes_table(result.changes,
                                                 {.mode_before = result.mode_before,
                                                  .mode_after = result.mode_after,
                                                  .was_begun = result.was_begun},
                                                 page);
}

std::string saving_text(std::span<const ChangeResult> results, const Page& page) {
  std::string servos;
  bool in_ram_only = false;
  bool would_save = false;
  for (const ChangeResult& result : results) {
    if (result.was_restarted) {
      servos += servo_text(result, page);
    } else if (result.saves && result.was_begun) {
      servos += head_line(result.servo) + "  " +
                page.paint(Tone::bad, say<texts::servo_not_saved>()) + '\n';
    }
    would_save = would_save || (result.saves && !result.was_begun);
    in_ram_only = in_ram_only || std::ranges::any_of(result.changes, is_in_ram_only);
  }
  if (would_save) {
    return say<texts::would_save>() + '\n';
  }
  if (!servos.empty()) {
    return say<texts::saving>() + '\n' + servos;
  }
  return in_ram_only ? say<texts::not_saved_note>() + '\n' : std::string();
}

std::vector<std::pair<std::string, std::uint64_t>>
counts(ResultView view, std::span<const fleet::GoalResult> results, bool is_plan) {
  const auto count = [&](auto which) {
    return static_cast<std::uint64_t>(std::ranges::count_if(results, which));
  };
  const auto has_status = [&](fleet::EntryStatus status) {
    return count([&](const auto& result) { return entry_status(result, is_plan) == status; });
  };
  switch (view) {
  case ResultView::changes: {
    std::uint64_t written = 0;
    for (const fleet::GoalResult& result : results) {
      written += static_cast<std::uint64_t>(std::ranges::count(
          result.change.changes, ChangeStatus::written, &RegisterChange::status));
    }
    return {{"written", written}};
  }
  case ResultView::servos: return {{"done", count(&fleet::GoalResult::is_done)}};
  case ResultView::entries:
    return {{"changed", has_status(fleet::EntryStatus::changed)},
            {"unchanged", has_status(fleet::EntryStatus::unchanged)}};
  case ResultView::moves: {
    const auto is_kept = [](const auto& result) {
      return result.need == fleet::Need::nothing || result.need == fleet::Need::prove;
    };
    const auto kept = count([&](const auto& each) { return each.is_done && is_kept(each); });
    return {{"made_static", count(&fleet::GoalResult::is_done) - kept}, {"kept", kept}};
  }
  }
  return {};
}

void write_json(JsonWriter& json, ResultView view, std::span<const ChangeResult> results) {
  json.objects("nodes", results, [&](const ChangeResult& result) {
    write_head(json, result.servo);
    if (view == ResultView::changes) {
      write_changes(json, result);
    } else {
      write_servo(json, result);
      write_warnings(json, result.warnings);
    }
  });
}

std::string text(ResultView view, std::span<const ChangeResult> results, const Page& page) {
  std::string out;
  for (const ChangeResult& result : results) {
    out += view == ResultView::changes ? changes_text(result, page) : servo_text(result, page);
  }
  return view == ResultView::changes ? out + saving_text(results, page) : out;
}

} // namespace blactl::cli
