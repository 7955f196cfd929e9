#include "told.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace blactl::campaign {

using nlohmann::json;

void require(bool truth, const std::string& what) {
  if (!truth) {
    throw Lie(what);
  }
}

std::uint8_t address_in(const json& text) {
  return static_cast<std::uint8_t>(std::stoul(text.get<std::string>(), nullptr, 16));
}

bool is_held(const json& change) {
  return change["status"] == "written" || change["status"] == "unchanged";
}

bool is_reached(const json& node) {
  const std::string status = node.value("status", "");
  if (!status.empty()) {
    return status == "done" || status == "changed" || status == "unchanged";
  }
  return node.contains("changes") && std::ranges::all_of(node["changes"], is_held);
}

namespace {

/// Whether another node on its ID can have answered in its place, while the servo was away or its
/// frames were lost, nothing came of that, and their NodeStatus did not give them away.
bool may_be_taken_for_other(const Step& step, std::int64_t serial, const json& node) {
  return step.shares_with_foreign(serial) && step.episode.faults.size() > 1 && !is_reached(node) &&
         !step.outcome.record.shows_two_on(step.node_ids(serial));
}

} // namespace

std::vector<std::pair<std::int64_t, const json*>> told_servos(const Step& step) {
  std::vector<std::pair<std::int64_t, const json*>> told;
  if (!step.outcome.document.contains("nodes")) {
    return told;
  }
  for (const json& node : step.outcome.document["nodes"]) {
    if (!node.contains("serial_number") || node["serial_number"].is_null()) {
      continue;
    }
    const auto serial = node["serial_number"].get<std::int64_t>();
    require(step.after.contains(serial), fmt::format("there is no servo {}", serial));
    require(node["unique_id"].is_null() || node["unique_id"] == step.after.at(serial).unique_id ||
                may_be_taken_for_other(step, serial, node),
            fmt::format("another unique ID of {}", serial));
    told.emplace_back(serial, &node);
  }
  return told;
}

} // namespace blactl::campaign
