#include "blactl/fleet/change/id_moves.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/target_texts.hpp"

#include "fleet/change/id_texts.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;
using Wish = state::AllocationStore::Wish;

namespace {

bool holds(const IdHolder& unit, NodeId id) {
  return unit.id == id || unit.static_node_id == id.value();
}

/// The error for a unit, or an ID, with an earlier wish.
std::optional<Error> wished_twice(std::span<const Wish> earlier, const Wish& wish) {
  for (const Wish& other : earlier) {
    if (other.unique_id == wish.unique_id) {
      return Error{Code::usage,
                   say<texts::two_ids_for_unit>(hex(wish.unique_id), other.node_id.value(),
                                                wish.node_id.value()),
                   say<texts::id_for_each_unit_hint>()};
    }
    if (other.node_id == wish.node_id) {
      return Error{Code::usage,
                   say<texts::one_id_for_two_units>(wish.node_id.value(), hex(other.unique_id),
                                                    hex(wish.unique_id)),
                   say<texts::id_for_each_unit_hint>()};
    }
  }
  return std::nullopt;
}

/// Objections to a wish, independent of the order of the moves.
class WishCheck {
 public:
  WishCheck(std::span<const IdHolder> units, std::span<const Wish> wishes,
            const state::NodeIds& taken, std::span<const dronecan::UniqueId> become_dynamic)
      : units_(units), wishes_(wishes), taken_(taken), become_dynamic_(become_dynamic) {}

  [[nodiscard]] std::vector<Error> all() {
    for (std::size_t i = 0; i < wishes_.size(); ++i) {
      check(wishes_[i]);
      if (auto error = wished_twice(wishes_.first(i), wishes_[i])) {
        errors_.push_back(std::move(*error));
      }
    }
    return std::move(errors_);
  }

 private:
  void check(const Wish& wish) {
    const bool may_be_given =
        wish.node_id >= state::first_dynamic_id && wish.node_id <= state::last_dynamic_id;
    if (!may_be_given) {
      errors_.push_back({Code::out_of_range,
                         say<texts::no_static_id>(hex(wish.unique_id), wish.node_id.value()),
                         say<texts::no_static_id_hint>(hex(wish.unique_id))});
    }
    const auto unit = std::ranges::find(units_, wish.unique_id, &IdHolder::unique_id);
    if (unit == units_.end()) {
      errors_.push_back({Code::not_found, say<texts::nothing_matches>("uid:" + hex(wish.unique_id)),
                         say<texts::node_not_found_hint>()});
    } else if (may_be_given) {
      check_free(*unit, wish.node_id);
    }
  }

  void check_free(const IdHolder& unit, NodeId wish) {
    if (taken_[wish.value()]) {
      errors_.push_back({Code::duplicate_node_id,
                         say<texts::id_given_is_kept>(unit.id.value(), wish.value()),
                         say<texts::id_given_is_kept_hint>(), unit.id.value()});
    }
    for (const IdHolder& other : units_) {
      const bool stays =
          std::ranges::find(wishes_, other.unique_id, &Wish::unique_id) == wishes_.end() &&
          std::ranges::find(become_dynamic_, other.unique_id) == become_dynamic_.end();
      if (stays && holds(other, wish)) {
        errors_.push_back({Code::duplicate_node_id,
                           say<texts::id_given_is_held>(unit.id.value(), wish.value(),
                                                        other.id.value(), hex(other.unique_id)),
                           say<texts::id_given_is_held_hint>(hex(other.unique_id)),
                           unit.id.value()});
      }
    }
  }

  std::span<const IdHolder> units_;
  std::span<const Wish> wishes_;
  const state::NodeIds& taken_;
  std::span<const dronecan::UniqueId> become_dynamic_;
  std::vector<Error> errors_;
};

/// The units after the rounds so far. Wishes have been checked.
class IdSchedule {
 public:
  IdSchedule(std::span<const IdHolder> units, std::span<const Wish> wishes,
             const state::NodeIds& taken, const state::NodeIds& promised,
             std::span<const dronecan::UniqueId> become_dynamic)
      : never_temporary_(taken), rather_not_(promised) {
    for (const IdHolder& unit : units) {
      const auto wish = std::ranges::find(wishes, unit.unique_id, &Wish::unique_id);
      const bool leaves =
          std::ranges::find(become_dynamic, unit.unique_id) != become_dynamic.end() &&
          std::ranges::any_of(wishes,
                              [&](const Wish& other) { return holds(unit, other.node_id); });
      units_.push_back(
          {unit, wish == wishes.end() ? std::nullopt : std::optional(wish->node_id), leaves});
    }
    for (const Wish& wish : wishes) {
      never_temporary_.set(wish.node_id.value());
    }
  }

  [[nodiscard]] Result<IdRounds> rounds() {
    IdRounds rounds;
    while (!std::ranges::all_of(units_, &Unit::is_done)) {
      std::vector<IdMove> round = next_round();
      if (round.empty()) {
        return fail(Code::table_full, say<texts::no_temporary_id>(),
                    say<texts::no_temporary_id_hint>());
      }
      for (const IdMove& move : round) {
        carry_out(move);
      }
      rounds.push_back(std::move(round));
    }
    return rounds;
  }

 private:
  struct Unit {
    IdHolder now;
    std::optional<NodeId> wish{};
    bool leaves = false; ///< it becomes dynamic, and others want what it holds

    [[nodiscard]] bool is_done() const {
      return !leaves && (!wish || (now.id == *wish && now.static_node_id == wish->value()));
    }
  };

  using Cycle = std::vector<const Unit*>;

  [[nodiscard]] std::vector<IdMove> next_round() const {
    std::vector<IdMove> round;
    state::NodeIds closed = never_temporary_;
    for (const Unit& unit : units_) {
      if (unit.leaves) {
        const NodeId to = highest_free(unit, closed);
        if (to.is_unicast()) {
          closed.set(to.value());
          round.push_back({unit.now.unique_id, unit.now.id, to, false, true});
        }
      } else if (!unit.is_done() && blocker(unit) == nullptr) {
        round.push_back({unit.now.unique_id, unit.now.id, *unit.wish});
      }
    }
    for (const Cycle& cycle : cycles()) {
      if (const auto move = way_out(cycle, closed)) {
        closed.set(move->to.value());
        round.push_back(*move);
      }
    }
    return round;
  }

  /// Another unit that holds the ID wanted by this one; null: it may move, or need not.
  [[nodiscard]] const Unit* blocker(const Unit& unit) const {
    const auto found = std::ranges::find_if(units_, [&](const Unit& other) {
      return &other != &unit && unit.wish && !unit.is_done() && holds(other.now, *unit.wish);
    });
    return found == units_.end() ? nullptr : &*found;
  }

  /// Cycles of units each waiting for the next, and the last for the first.
  [[nodiscard]] std::vector<Cycle> cycles() const {
    std::vector<Cycle> found;
    std::set<const Unit*> seen;
    for (const Unit& start : units_) {
      Cycle path;
      const Unit* unit = &start;
      for (; unit != nullptr && seen.insert(unit).second; unit = blocker(*unit)) {
        path.push_back(unit);
      }
      const auto entry = std::ranges::find(path, unit);
      if (entry != path.end()) {
        found.emplace_back(entry, path.end());
      }
    }
    return found;
  }

  /// The unit of them that can go to the highest ID: after a cut that is the one that was on its
  /// way there. Empty: no ID is free.
  [[nodiscard]] std::optional<IdMove> way_out(const Cycle& cycle,
                                              const state::NodeIds& closed) const {
    std::optional<IdMove> best;
    for (const Unit* member : cycle) {
      if (const NodeId id = highest_free(*member, closed); id > (best ? best->to : NodeId())) {
        best = IdMove{member->now.unique_id, member->now.id, id, true};
      }
    }
    return best;
  }

  /// The highest temporary ID for this unit, preferably one that is not promised; 0: none.
  [[nodiscard]] NodeId highest_free(const Unit& unit, const state::NodeIds& closed) const {
    const NodeId unpromised = highest_open(unit, closed | rather_not_);
    return unpromised.is_unicast() ? unpromised : highest_open(unit, closed);
  }

  [[nodiscard]] NodeId highest_open(const Unit& unit, const state::NodeIds& closed) const {
    for (std::uint8_t id = state::last_dynamic_id.value(); id > 0; --id) {
      const bool is_free = !closed[id] && std::ranges::none_of(units_, [&](const Unit& other) {
        return &other != &unit && holds(other.now, NodeId(id));
      });
      if (is_free) {
        return NodeId(id);
      }
    }
    return {};
  }

  void carry_out(const IdMove& move) {
    const auto unit = std::ranges::find(units_, move.unique_id,
                                        [](const Unit& each) { return each.now.unique_id; });
    unit->now.id = move.to;
    unit->now.static_node_id = move.is_dynamic ? 0 : move.to.value();
    unit->leaves = false;
  }

  std::vector<Unit> units_;
  state::NodeIds never_temporary_; ///< held by others, or wanted
  state::NodeIds rather_not_;      ///< promised to units that are away
};

} // namespace

std::expected<IdRounds, std::vector<Error>>
plan_id_moves(std::span<const IdHolder> units, std::span<const Wish> wishes,
              const state::NodeIds& taken, const state::NodeIds& promised,
              std::span<const dronecan::UniqueId> become_dynamic) {
  if (auto errors = WishCheck(units, wishes, taken, become_dynamic).all(); !errors.empty()) {
    return std::unexpected(std::move(errors));
  }
  auto rounds = IdSchedule(units, wishes, taken, promised, become_dynamic).rounds();
  if (!rounds) {
    return std::unexpected(std::vector{std::move(rounds.error())});
  }
  return std::move(*rounds);
}

} // namespace blactl::fleet
