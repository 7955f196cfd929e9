#include "cli/output/scan_view.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/status_words.hpp"

#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::cli {

using dronecan::NodeId;
using fleet::Conflict;
using fleet::Finding;
using fleet::Findings;
using fleet::Roster;

namespace {

void write_info(JsonWriter& json, const Finding& node) {
  json.key("info");
  const auto& now = node.status;
  if (!node.info && !now) {
    json.value(nullptr);
    return;
  }
  const auto version = [](unsigned major, unsigned minor) {
    return fmt::format("{}.{}", major, minor);
  };
  const auto& info = node.info;
  json.begin_object();
  json.member("name", info ? std::optional(printable(info->name)) : std::nullopt);
  json.member("uptime_s", now ? std::optional(now->uptime_s) : std::nullopt);
  const auto mode = now ? name(now->mode) : std::string_view();
  json.member("mode", mode.empty() ? std::nullopt : std::optional(mode));
  json.member("health", now ? std::optional(name(now->health)) : std::nullopt);
  json.member("vendor_status", now ? std::optional(now->vendor_status) : std::nullopt);
  json.member("software_version",
              info ? std::optional(version(info->software_major, info->software_minor))
                   : std::nullopt);
  json.member("hardware_version",
              info ? std::optional(version(info->hardware_major, info->hardware_minor))
                   : std::nullopt);
  json.end_object();
}

void write_ids(JsonWriter& json, const char* key, const std::vector<NodeId>& ids) {
  json.array(key, ids, [&](NodeId id) { json.value(id.value()); });
}

void write_node(JsonWriter& json, const Finding& node) {
  write_head(json, node.servo);
  json.member("static_node_id", node.servo.static_node_id);
  json.member("model_certain", node.servo.identity.certain());
  write_info(json, node);
  json.array("warnings", node.warnings, [&](const std::string& warning) { json.value(warning); });
}

/// "ok", "warning", "maintenance warning": each word in the colour of its meaning, and the mode
/// only if it is not the usual one.
std::string state_text(const dronecan::NodeStatus& now, const Page& page) {
  using dronecan::Health;
  using dronecan::Mode;
  const Tone tone = now.health == Health::ok        ? Tone::good
                    : now.health == Health::warning ? Tone::warning
                                                    : Tone::bad;
  std::string health = page.paint(tone, fleet::health_word(now.health));
  if (now.mode == Mode::operational) {
    return health;
  }
  const Tone mode = now.mode == Mode::offline ? Tone::bad : Tone::warning;
  return page.paint(mode, fleet::mode_word(now.mode)) +
         (now.health == Health::ok ? "" : ' ' + health);
}

/// "BLA21-12U-AB", with a question mark if uncertain.
std::string model_text(const Finding& node) {
  if (node.is_foreign) {
    return say<texts::foreign_node>(printable(node.info->name));
  }
  const std::string model = node.servo.identity.model();
  return model.empty() ? say<texts::unknown_word>()
                       : model + (node.servo.identity.certain() ? "" : " ?");
}

constexpr std::size_t unique_id_digits = 2 * sizeof(dronecan::UniqueId);

/// The fewest digits, but at least eight, that tell all units apart.
std::size_t enough_digits(const Roster& roster) {
  std::set<std::string> all;
  for (const auto& [id, member] : roster.members()) {
    if (const auto unit = member.unique_id()) {
      all.insert(hex(*unit));
    }
  }
  constexpr std::size_t least = 8;
  std::size_t digits = least;
  for (auto now = all.begin(); now != all.end() && std::next(now) != all.end(); ++now) {
    const auto differs = std::ranges::mismatch(*now, *std::next(now)).in1 - now->begin();
    digits = std::max(digits, static_cast<std::size_t>(differs) + 1);
  }
  return digits;
}

/// `digits`: how many of a unique ID are shown.
std::vector<std::string> row(const Finding& node, std::size_t digits, const Page& page) {
  const fleet::Servo& servo = node.servo;
  const auto& readings = servo.identity.readings();
  const bool dynamic = servo.is_servo && servo.static_node_id == 0;
  return {servo.id_is_known ? std::to_string(servo.id.value()) : "-",
          model_text(node),
          or_text(readings.serial_number, "-"),
          servo.is_servo ? or_text(servo.servo_id, "-") : "-",
          readings.firmware_version ? version_text(*readings.firmware_version) : "-",
          dynamic ? say<texts::dynamic_id>() : or_text(servo.static_node_id, "-"),
          node.status ? state_text(*node.status, page) : "-",
          node.status ? fmt::format("{} s", node.status->uptime_s) : "-",
          servo.unique_id ? hex(*servo.unique_id).substr(0, digits) : "-"};
}

Table table(const Findings& findings, std::size_t digits, const Page& page) {
  Table table({say<texts::column_node>(), say<texts::column_model>(), say<texts::column_serial>(),
               say<texts::column_servo_id>(), say<texts::scan_column_firmware>(),
               say<texts::column_static_id>(), say<texts::column_state>(),
               say<texts::column_uptime>(), say<texts::column_unique_id>()});
  for (const Finding& node : findings.nodes) {
    table.add(row(node, digits, page));
  }
  return table;
}

/// Each warning once, with the node IDs of all that it is true of.
std::vector<std::pair<std::string_view, std::string>> warnings_of(const Findings& findings) {
  std::vector<std::pair<std::string_view, std::string>> all;
  for (const Finding& node : findings.nodes) {
    const std::string id = std::to_string(node.servo.id.value());
    for (const std::string& warning : node.warnings) {
      const auto same =
          std::ranges::find(all, warning, [](const auto& each) { return each.first; });
      if (same == all.end()) {
        all.emplace_back(warning, id);
      } else {
        same->second += ", " + id;
      }
    }
  }
  return all;
}

} // namespace

void write_json(JsonWriter& json, const Findings& findings) {
  const Roster& roster = *findings.roster;
  json.objects("nodes", findings.nodes, [&](const Finding& node) { write_node(json, node); });
  json.objects("pending", roster.pending(),
               [&](const auto& prefix) { json.member("unique_id_prefix", hex(prefix)); });
  json.objects("conflicts", findings.conflicts, [&](const Conflict& conflict) {
    json.member("code", name(conflict.code));
    write_ids(json, "node_ids", conflict.nodes);
    json.member("text", conflict.text);
  });
  const auto allocators = roster.allocators();
  write_ids(json, "allocators", {allocators.begin(), allocators.end()});
  write_ids(json, "commanders", fleet::commanders(roster));
}

std::string csv(const Findings& findings) {
  auto columns = head_columns();
  for (const char* name : {"static_node_id", "model_certain", "name", "uptime_s", "mode", "health",
                           "vendor_status", "software_version", "warnings"}) {
    columns.emplace_back(name);
  }
  std::string out = csv_line(columns);
  for (const Finding& node : findings.nodes) {
    auto cells = head_cells(node.servo);
    const auto& now = node.status;
    std::string warned;
    for (const std::string& warning : node.warnings) {
      warned += (warned.empty() ? "" : "; ") + warning;
    }
    for (std::string cell :
         {or_text(node.servo.static_node_id, ""),
          std::string(node.servo.identity.certain() ? "true" : "false"),
          node.info ? printable(node.info->name) : std::string(),
          now ? std::to_string(now->uptime_s) : std::string(),
          std::string(now ? name(now->mode) : ""), std::string(now ? name(now->health) : ""),
          now ? std::to_string(now->vendor_status) : std::string(),
          node.info ? fmt::format("{}.{}", node.info->software_major, node.info->software_minor)
                    : std::string(),
          warned}) {
      cells.push_back(std::move(cell));
    }
    out += csv_line(cells);
  }
  return out;
}

std::string text(const Findings& findings, const Page& page) {
  const Roster& roster = *findings.roster;
  const std::string sign = page.paint(Tone::warning, "!");
  std::string out;
  if (!findings.nodes.empty()) {
    const Table whole = table(findings, unique_id_digits, page);
    const Table brief = table(findings, enough_digits(roster), page);
    const bool is_brief = !whole.fits("", page) && brief.fits("", page);
    out += (is_brief ? brief : whole).text("", page);
  }
  for (const auto& [warning, ids] : warnings_of(findings)) {
    out += fmt::format("{} {}: {}\n", sign, ids, warning);
  }
  const auto line = [&](const std::string& what) { out += fmt::format("{} {}\n", sign, what); };
  for (const Conflict& conflict : findings.conflicts) {
    line(conflict.text);
  }
  for (const auto& prefix : roster.pending()) {
    line(say<texts::waits_for_id>(hex(prefix)));
  }
  if (!roster.pending().empty()) {
    line(say<texts::more_may_wait>());
  }
  for (const std::string& other : fleet::others(roster)) {
    line(other);
  }
  return out;
}

} // namespace blactl::cli
