#include "blactl/bla/value.hpp"

#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/set_outcome.hpp"
#include "cli/texts.hpp"

#include <optional>

namespace blactl::cli {

using fleet::Change;
using fleet::ChangeStatus;

namespace {

void write_change(JsonWriter& json, const Change& change) {
  json.begin_object();
  json.member("address", change.parameter->address.name());
  json.member("name", change.parameter->name);
  json.member("before", change.before);
  json.member("requested", change.requested);
  json.member("after", change.after);
  json.member("status", name(change.status));
  json.end_object();
}

std::string status_text(ChangeStatus status) {
  switch (status) {
  case ChangeStatus::planned: return say<texts::set_planned>();
  case ChangeStatus::unchanged: return say<texts::set_unchanged>();
  case ChangeStatus::written: return say<texts::set_written>();
  case ChangeStatus::failed: return say<texts::set_failed>();
  case ChangeStatus::mismatch: return say<texts::set_mismatch>();
  }
  return {};
}

} // namespace

void write_json(JsonWriter& json, const Outcome& outcome) {
  json.key("nodes");
  json.begin_array();
  for (const Plan& plan : outcome.plans) {
    json.begin_object();
    write_head(json, *plan.member);
    json.key("changes");
    json.begin_array();
    for (const Change& change : plan.changes) {
      write_change(json, change);
    }
    json.end_array();
    json.member("saved", plan.saved);
    json.end_object();
  }
  json.end_array();
}

std::string text(const Outcome& outcome) {
  std::string out;
  bool written = false;
  for (const Plan& plan : outcome.plans) {
    out += head_line(*plan.member);
    Table table({"", say<texts::column_parameter>(), say<texts::column_before>(), "",
                 say<texts::column_after>(), ""});
    for (const Change& change : plan.changes) {
      const bla::Parameter& parameter = *change.parameter;
      const auto shown = [&](const std::optional<std::int64_t>& raw,
                             const std::optional<std::int64_t>& mode) {
        return raw ? register_text(parameter, *raw, mode) : say<texts::unknown_before>();
      };
      const bool planned = change.status == ChangeStatus::planned;
      table.add({parameter.address.name(), parameter.name, shown(change.before, plan.mode_before),
                 "->", shown(planned ? change.requested : change.after, plan.mode_after),
                 status_text(change.status)});
      written = written || change.status == ChangeStatus::written;
    }
    out += table.text("  ");
  }
  if (!outcome.saves.empty()) {
    return out + say<texts::saving>() + '\n' + text(outcome.saves);
  }
  return written ? out + say<texts::not_saved_note>() + '\n' : out;
}

} // namespace blactl::cli
