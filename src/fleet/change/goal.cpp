#include "blactl/fleet/change/goal.hpp"

#include <algorithm>

namespace blactl::fleet {
namespace {

using bla::Assignment;

/// A servo that started with this static node ID would be on it: it is in RAM only.
bool shows_other_rom(const Goal& goal, const Snapshot& held) {
  return std::ranges::any_of(goal.wanted.assignments, [&](const Assignment& wish) {
    return wish.parameter->address == bla::address::static_node_id && wish.value.raw != 0 &&
           wish.value.raw != held.servo.id.value();
  });
}

/// The need without a record.
Need need_without_record(const Goal& goal, const Snapshot& held) {
  if (goal.evidence == Evidence::record || shows_other_rom(goal, held)) {
    return Need::save;
  }
  return goal.evidence == Evidence::restart ? Need::prove : Need::nothing;
}

} // namespace

std::string_view name(Need need) {
  switch (need) {
  case Need::nothing: return "nothing";
  case Need::prove: return "restart";
  case Need::save: return "save";
  case Need::write: return "write";
  }
  return {};
}

Result<std::vector<Goal>> goals_for_all(const Wanted& wanted, Evidence evidence,
                                        std::span<const dronecan::NodeId> servos) {
  if (auto refused = refuse_together(wanted, servos)) {
    return std::unexpected(std::move(*refused));
  }
  std::vector<Goal> goals;
  for (const dronecan::NodeId id : servos) {
    goals.push_back({.id = id, .wanted = wanted, .evidence = evidence});
  }
  return goals;
}

bool holds(const bla::Values& values, const Goal& goal) {
  const auto mode = bla::find(values, bla::address::pwm_mode); // the unit of 0x36 depends on it
  return std::ranges::all_of(goal.wanted.assignments, [&](const Assignment& wish) {
    const bool is_of_unit = !mode || !wish.value.pwm_mode || mode == wish.value.pwm_mode;
    return is_of_unit && bla::find(values, wish.parameter->address) == wish.value.raw;
  });
}

Need need_of(const Goal& goal, const Snapshot& held, const std::optional<bla::Values>& rom) {
  if (goal.evidence == Evidence::none || !holds(held.values(), goal)) {
    return Need::write;
  }
  if (!goal.saves()) {
    return Need::nothing;
  }
  if (check_rom(held)) { // it holds initial values because ROM is unreadable
    return Need::save;
  }
  if (rom) {
    return holds(*rom, goal) ? Need::nothing : Need::save;
  }
  return need_without_record(goal, held);
}

} // namespace blactl::fleet
