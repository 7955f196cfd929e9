#include "blactl/fleet/change/let_in.hpp"
#include "blactl/fleet/change/static_ids.hpp"
#include "blactl/fleet/change/table_entries.hpp"
#include "blactl/fleet/change/wanted_ids.hpp"

#include "cli/alloc/actions.hpp"
#include "cli/alloc/texts.hpp"
#include "cli/alloc/view.hpp"
#include "cli/change/change_servos.hpp"
#include "cli/stores.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

using state::AllocationStore;
using Wishes = std::vector<AllocationStore::Wish>;

/// The node IDs to make static, by servo.
class StaticWishes {
 public:
  StaticWishes(const AllocOptions& options, std::vector<fleet::WantedId> wanted,
               AllocationStore& table, Context& context)
      : options_(options), wanted_(std::move(wanted)), table_(table), context_(context) {}

  [[nodiscard]] Goals find(const Whom& whom) {
    std::vector<Error> unknown = wish(whom);
    auto found = fleet::static_goals(whom.roster, context_.known(), wishes_, not_let_in_);
    std::ranges::move(found.errors, std::back_inserter(unknown));
    const bool may_wait = !unknown.empty() || !name_units();
    return {.goals = std::move(found.goals), .errors = std::move(unknown), .may_wait = may_wait};
  }

  /// Those with a wish get its ID for the time being. To tell who is meant by anything but a whole
  /// unique ID, all that wait need one.
  [[nodiscard]] Result<void> let_in() {
    if (wanted_.empty() || !name_units()) {
      return let_all_in();
    }
    auto done = fleet::let_in(context_.session(), table_, wishes_);
    if (!done) {
      return std::unexpected(std::move(done.error()));
    }
    tell(fleet::taken_over(done->allocated));
    not_let_in_ = std::move(done->left);
    return {};
  }

 private:
  [[nodiscard]] bool name_units() const {
    return std::ranges::all_of(wanted_, fleet::names_one_unit);
  }

  void tell(const std::vector<std::string>& notes) const {
    for (const std::string& note : notes) {
      context_.reporter().note(note);
    }
  }

  /// Not under an ID that is wished for one of them.
  [[nodiscard]] Result<void> let_all_in() {
    state::NodeIds wished;
    for (const fleet::WantedId& wanted : wanted_) {
      wished.set(wanted.node_id.value());
    }
    const auto asked = fleet::let_in(context_.session(), table_, std::nullopt, wished);
    if (!asked) {
      return std::unexpected(asked.error());
    }
    tell(fleet::taken_over(*asked));
    for (const fleet::AllocatedUnit& unit : *asked) {
      if (unit.is_new) {
        newcomers_.insert(unit.unique_id);
      }
    }
    return {};
  }

  /// Returns why some have none.
  [[nodiscard]] std::vector<Error> wish(const Whom& whom) {
    wishes_.clear();
    if (wanted_.empty()) {
      auto wishes = wishes_for(whom);
      if (!wishes) {
        return {std::move(wishes.error())};
      }
      wishes_ = std::move(*wishes);
      return {};
    }
    auto found = fleet::units_meant(wanted_, whom.roster, context_.known());
    wishes_ = std::move(found.wishes);
    return std::move(found.errors);
  }

  [[nodiscard]] Result<Wishes> wishes_for(const Whom& whom) const {
    if (!options_.range.empty()) {
      const auto range = parse_range(options_.range);
      return range ? fleet::ids_within(*range, whom.roster, whom.selected, newcomers_)
                   : std::unexpected(range.error());
    }
    if (options_.id && whom.selected.size() != 1) {
      return fail(Code::usage, say<texts::alloc_several_for_id>(*options_.id, whom.selected.size()),
                  say<texts::alloc_several_for_id_hint>());
    }
    auto wishes = fleet::ids_as_they_are(whom.roster, whom.selected);
    if (wishes && options_.id) {
      wishes->front().node_id = dronecan::NodeId(static_cast<std::uint8_t>(*options_.id));
    }
    return wishes;
  }

  const AllocOptions& options_;
  std::vector<fleet::WantedId> wanted_; ///< by --assign
  Wishes wishes_{};
  AllocationStore& table_;
  Context& context_;
  fleet::NotLetIn not_let_in_;
  std::set<dronecan::UniqueId> newcomers_{}; ///< they have their IDs for the time being
};

/// Prints a line for every move, and for every servo that already has its ID.
class Stream {
 public:
  Stream(AllocationStore& table, Context& context) : table_(table), context_(context) {}

  void moved(const fleet::IdMove& move) {
    if (!move.is_temporary) {
      moved_.insert(move.unique_id);
    }
    print(move, move.to);
  }

  /// The IDs that servos had already enter the table here, those that were given have done so.
  void ended(std::span<const fleet::GoalResult> results) {
    Wishes kept;
    for (const fleet::GoalResult& result : results) {
      const auto& unit = result.goal.unique_id;
      if (result.is_done && unit && !moved_.contains(*unit)) {
        kept.push_back({*unit, result.servo().id});
        print(StaticUnit{*unit, result.servo().id}, result.servo().id);
      }
    }
    if (const auto entered = fleet::enter_kept(table_, kept, context_.session().wall()); !entered) {
      failure_ = entered.error();
    }
  }

  /// The error of writing to stdout or to the table; empty: none.
  [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }

 private:
  /// `id`: its node ID now.
  void print(const auto& what, dronecan::NodeId id) {
    const WallTime time = context_.session().wall();
    const fleet::Servo servo = context_.session().roster().member(id).servo();
    const Reporter& reporter = context_.reporter();
    const bool is_json = reporter.format() == Format::json;
    const auto printed =
        reporter.stream(is_json ? json_line(UnixTime(time), what)
                                : text_line(time, what, servo.identity.readings().serial_number));
    if (!printed) {
      failure_ = printed.error();
    }
  }

  AllocationStore& table_;
  Context& context_;
  std::set<dronecan::UniqueId> moved_;
  std::optional<Error> failure_;
};

} // namespace

Report make_static(const AllocOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface), .is_stream = true};
  auto wanted = parse_wishes(options.assign);
  if (!wanted) {
    std::ranges::copy(wanted.error(), std::back_inserter(report.errors));
  }
  if (const auto range = parse_range(options.range); !range) {
    report.fail(range.error());
  }
  if (const auto profiles = context.profiles(); !profiles) {
    report.fail(profiles.error());
  }
  if (!report.errors.empty()) {
    return report;
  }
  auto table = open_allocations(context.shared().interface, AllocationStore::Access::write);
  if (!table) {
    report.fail(table.error());
    return report;
  }
  StaticWishes ids(options, std::move(*wanted), *table, context);
  Stream stream(*table, context);
  report = change_servos(
      {.command = "alloc --static",
       .search = Search::everybody,
       .needs_targets = options.assign.empty(),
       .waiting = options.assign.empty() ? Waiting::unless_node_ids : Waiting::if_missing,
       .find = [&](const Whom& whom) { return ids.find(whom); },
       .let_in = [&] { return ids.let_in(); },
       .moved = [&](const fleet::IdMove& move) { stream.moved(move); },
       .ended = [&](auto results) { stream.ended(results); },
       .stops_at_failure = true,
       .view = ResultView::moves},
      context);
  if (stream.failure()) {
    report.fail(*stream.failure());
  }
  return report;
}

} // namespace blactl::cli
