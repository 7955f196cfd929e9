#include "blactl/base/hex.hpp"

#include "cli/output/health_words.hpp"
#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/scan_findings.hpp"
#include "cli/texts.hpp"

#include <utility>

namespace blactl::cli {

using dronecan::NodeId;
using fleet::Member;
using fleet::Roster;

namespace {

void write_info(JsonWriter& json, const Member& member) {
  json.key("info");
  const auto now = status(member);
  if (!member.info && !now) {
    json.value(nullptr);
    return;
  }
  const auto version = [](unsigned major, unsigned minor) {
    return fmt::format("{}.{}", major, minor);
  };
  const auto& info = member.info;
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
  json.key(key);
  json.begin_array();
  for (const NodeId id : ids) {
    json.value(id.value());
  }
  json.end_array();
}

void write_node(JsonWriter& json, const Member& member) {
  json.begin_object();
  write_head(json, member);
  json.member("static_node_id", member.static_node_id);
  json.member("model_certain", member.identity.certain());
  write_info(json, member);
  json.key("warnings");
  json.begin_array();
  for (const std::string& warning : warnings(member)) {
    json.value(warning);
  }
  json.end_array();
  json.end_object();
}

std::vector<NodeId> commanders(const Roster& roster) {
  std::vector<NodeId> out;
  for (const auto& [id, commander] : roster.commanders()) {
    out.push_back(id);
  }
  return out;
}

std::vector<std::string> row(const Member& member) {
  const auto& readings = member.identity.readings();
  const auto now = status(member);
  const std::string model = member.identity.model();
  // Who sends actuator.Status is a servo, even if it answers nothing.
  const bool servo = member.is_servo || member.sends_actuator_status();
  const std::string shown_model =
      !servo          ? say<texts::foreign_node>(member.info ? printable(member.info->name) : "")
      : model.empty() ? say<texts::unknown_word>()
                      : model + (member.identity.certain() ? "" : " ?");
  const bool dynamic = member.is_servo && member.static_node_id == 0;
  return {std::to_string(member.id.value()),
          shown_model,
          or_text(readings.serial_number, "-"),
          member.is_servo ? or_text(member.servo_id, "-") : "-",
          readings.firmware_version ? version_text(*readings.firmware_version) : "-",
          dynamic ? say<texts::dynamic_id>() : or_text(member.static_node_id, "-"),
          now ? fmt::format("{} {}", name(now->mode), name(now->health)) : "-",
          now ? fmt::format("{} s", now->uptime_s) : "-",
          member.info ? hex(member.info->unique_id) : "-"};
}

} // namespace

void write_json(JsonWriter& json, const Findings& findings) {
  const Roster& roster = *findings.roster;
  json.key("nodes");
  json.begin_array();
  for (const Member* member : findings.nodes) {
    write_node(json, *member);
  }
  json.end_array();
  json.key("pending");
  json.begin_array();
  for (const auto& prefix : roster.pending()) {
    json.begin_object();
    json.member("unique_id_prefix", hex(prefix));
    json.end_object();
  }
  json.end_array();
  json.key("conflicts");
  json.begin_array();
  for (const Conflict& conflict : findings.conflicts) {
    json.begin_object();
    json.member("code", name(conflict.code));
    write_ids(json, "node_ids", conflict.nodes);
    json.member("text", conflict.text);
    json.end_object();
  }
  json.end_array();
  write_ids(json, "allocators", {roster.allocators().begin(), roster.allocators().end()});
  write_ids(json, "commanders", commanders(roster));
}

std::string csv(const Findings& findings) {
  auto columns = head_columns();
  for (const char* name : {"static_node_id", "model_certain", "name", "uptime_s", "mode", "health",
                           "vendor_status", "software_version", "warnings"}) {
    columns.emplace_back(name);
  }
  std::string out = csv_line(columns);
  for (const Member* member : findings.nodes) {
    auto cells = head_cells(*member);
    const auto now = status(*member);
    std::string warned;
    for (const std::string& warning : warnings(*member)) {
      warned += (warned.empty() ? "" : "; ") + warning;
    }
    for (std::string cell :
         {or_text(member->static_node_id, ""),
          std::string(member->identity.certain() ? "true" : "false"),
          member->info ? printable(member->info->name) : std::string(),
          now ? std::to_string(now->uptime_s) : std::string(),
          std::string(now ? name(now->mode) : ""), std::string(now ? name(now->health) : ""),
          now ? std::to_string(now->vendor_status) : std::string(),
          member->info
              ? fmt::format("{}.{}", member->info->software_major, member->info->software_minor)
              : std::string(),
          warned}) {
      cells.push_back(std::move(cell));
    }
    out += csv_line(cells);
  }
  return out;
}

std::string text(const Findings& findings) {
  const Roster& roster = *findings.roster;
  std::string out;
  if (!findings.nodes.empty()) {
    Table table({say<texts::column_node>(), say<texts::column_model>(), say<texts::column_serial>(),
                 say<texts::column_servo_id>(), say<texts::column_firmware>(),
                 say<texts::column_static_id>(), say<texts::column_state>(),
                 say<texts::column_uptime>(), say<texts::column_unique_id>()});
    for (const Member* member : findings.nodes) {
      table.add(row(*member));
    }
    out += table.text();
  }
  for (const Member* member : findings.nodes) {
    for (const std::string& warning : warnings(*member)) {
      out += fmt::format("! {}: {}\n", member->id.value(), warning);
    }
  }
  const auto line = [&](const std::string& what) { out += fmt::format("! {}\n", what); };
  for (const Conflict& conflict : findings.conflicts) {
    line(conflict.text);
  }
  for (const auto& prefix : roster.pending()) {
    line(say<texts::waits_for_id>(hex(prefix)));
  }
  for (const NodeId id : roster.allocators()) {
    line(say<texts::allocates>(id.value()));
  }
  for (const NodeId id : commanders(roster)) {
    line(say<texts::commands_servos>(id.value()));
  }
  if (const auto by = roster.armed_by()) {
    line(say<texts::says_armed>(by->value()));
  }
  return out;
}

} // namespace blactl::cli
