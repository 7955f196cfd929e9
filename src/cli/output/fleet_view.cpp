#include "cli/output/fleet_view.hpp"

#include "blactl/bla/value.hpp"
#include "blactl/fleet/change/register_change.hpp"

#include "cli/fleet_texts.hpp"
#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/texts.hpp"

#include <optional>

namespace blactl::cli {

using fleet::Difference;
using fleet::EntryDiff;
using fleet::EntryStatus;

namespace {

void write_difference(JsonWriter& json, const Difference& difference) {
  const auto status =
      difference.is_one() ? fleet::ChangeStatus::planned : fleet::ChangeStatus::unchanged;
  json.begin_object();
  json.member("address", difference.parameter->address.name());
  json.member("name", difference.parameter->name);
  json.member("before", difference.before);
  json.member("requested", difference.wished);
  json.member("after", nullptr);
  json.member("status", fleet::name(status));
  json.end_object();
}

} // namespace

std::string title(const std::string& name, const fleet::Servo& servo) {
  if (name.empty() && !servo.id.is_unicast()) {
    return {}; // parameter files have none
  }
  if (name.empty()) {
    std::string head = head_line(servo);
    head.erase(head.find_last_not_of('\n') + 1);
    return head;
  }
  return servo.id.is_unicast() && servo.id_is_known
             ? say<texts::fleet_entry_at>(printable(name), servo.id.value())
             : printable(name);
}

void write_entry(JsonWriter& json, const EntryDiff& entry) {
  json.begin_object();
  write_head(json, entry.servo);
  json.member("name", entry.name.empty() ? std::nullopt : std::optional(entry.name));
  json.member("status", fleet::name(entry.status));
  json.array("changes", entry.registers,
             [&](const Difference& difference) { write_difference(json, difference); });
  json.end_object();
}

namespace {

std::string summary(const EntryDiff& entry, const Page& page) {
  switch (entry.status) {
  case EntryStatus::different:
    return page.paint(Tone::warning,
                      say<texts::fleet_different>(entry.differences(), entry.registers.size()));
  case EntryStatus::missing: return page.paint(Tone::warning, say<texts::fleet_missing>());
  case EntryStatus::extra: return page.paint(Tone::warning, say<texts::fleet_extra>());
  case EntryStatus::skipped: return say<texts::fleet_skipped>();
  case EntryStatus::failed: return page.paint(Tone::bad, say<texts::fleet_not_compared>());
  default: return page.paint(Tone::good, say<texts::fleet_unchanged>(entry.registers.size()));
  }
}

std::string registers_text(const EntryDiff& entry, const std::string& one, const std::string& other,
                           const Page& page) {
  Table table({"", say<texts::column_parameter>(), one, "", other});
  for (const Difference& difference : entry.registers) {
    if (!difference.is_one()) {
      continue;
    }
    const bla::Parameter& parameter = *difference.parameter;
    const auto shown = [&](std::optional<std::int64_t> raw, std::optional<std::int64_t> mode) {
      return raw ? bla::register_text(parameter, *raw, mode) : say<texts::fleet_says_nothing>();
    };
    table.add({parameter.address.name(), parameter.name,
               shown(difference.before, entry.mode_before), "->",
               shown(difference.wished, entry.mode_after)});
  }
  return table.text("  ", page);
}

} // namespace

void write_json(JsonWriter& json, std::span<const EntryDiff> entries) {
  json.array("nodes", entries, [&](const EntryDiff& entry) { write_entry(json, entry); });
}

std::string text(std::span<const EntryDiff> entries, const std::string& one,
                 const std::string& other, const Page& page) {
  std::string out;
  for (const EntryDiff& entry : entries) {
    const std::string who = title(entry.name, entry.servo);
    out += who + (who.empty() ? "" : ": ") + summary(entry, page) + '\n';
    if (entry.status == EntryStatus::different) {
      out += registers_text(entry, one, other, page);
    }
  }
  return out;
}

} // namespace blactl::cli
