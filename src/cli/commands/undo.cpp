// blactl undo: restores the settings of servos before their last changes.

#include "blactl/fleet/change/undo.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/base/rfc3339.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/state/snapshot_store.hpp"

#include "cli/change/change_servos.hpp"
#include "cli/change/texts.hpp"
#include "cli/commands.hpp"
#include "cli/output/snapshots_view.hpp"
#include "cli/stores.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

using state::SnapshotEntry;
using state::SnapshotStore;

struct UndoOptions {
  bool list = false;
  std::optional<std::uint64_t> to{};
  bool dry_run = false;
  bool no_save = false;
  RestartTimes times{};
};

constexpr Option undo_options[]{
    {.name = "--list",
     .kind = Kind::flag,
     .help = {"show the changes that are recorded, without a bus", "変更履歴を表示 (バス不要)"},
     .store = into<&UndoOptions::list>},
    {.name = "--to",
     .value = "N",
     .kind = Kind::whole,
     .whole = {1, std::numeric_limits<std::int64_t>::max()},
     .help = {"before the command with this number of --list: every servo that was changed since",
              "--list の番号 N のコマンドを実行する前の状態に戻す (以後に変更した全サーボ)"},
     .store = into<&UndoOptions::to>},
    dry_run_option<&UndoOptions::dry_run>,
    {.name = "--no-save",
     .kind = Kind::flag,
     .help = {"RAM only, also where the change was saved",
              "RAM のみ変更 (変更が保存されていた場合も)"},
     .store = into<&UndoOptions::no_save>},
    restart_wait<&UndoOptions::times>,
    restart_stagger<&UndoOptions::times>,
};

/// One run of the command: finds the changes to undo.
class Undo {
 public:
  Undo(const UndoOptions& options, const SnapshotStore& store, Context& context)
      : options_(options), store_(store), context_(context) {}

  [[nodiscard]] Goals find(const Whom& whom) {
    Goals goals;
    if (!whom.targets.given) {
      of_all(whom, goals);
    } else if (options_.to) {
      of_nodes_since(whom, goals);
    } else {
      std::ranges::for_each(whom.selected, [&](dronecan::NodeId id) { of_node(id, whom, goals); });
    }
    return goals;
  }

  /// Marks changes without effect, or already undone, as settled: they must not hide the one before
  /// them.
  void forget_what_never_was(std::span<const fleet::GoalResult> results);

 private:
  [[nodiscard]] Result<std::vector<fleet::Undoing>> changes() const;
  void of_nodes_since(const Whom& whom, Goals& goals);
  void of_all(const Whom& whom, Goals& goals);
  void of_node(dronecan::NodeId id, const Whom& whom, Goals& goals);
  void take_back(const fleet::Undoing& change, dronecan::NodeId id, Goals& goals);

  const UndoOptions& options_;
  const SnapshotStore& store_;
  Context& context_;
  std::set<std::string> told_;
  std::map<dronecan::UniqueId, std::vector<std::int64_t>> numbers_{}; ///< of the changes undone
};

/// By the last command, or since the one that --to names.
Result<std::vector<fleet::Undoing>> Undo::changes() const {
  return options_.to ? fleet::changes_since(store_, static_cast<std::int64_t>(*options_.to))
                     : fleet::last_changes(store_);
}

/// With -n and --to.
void Undo::of_nodes_since(const Whom& whom, Goals& goals) {
  const auto changes = this->changes();
  if (!changes) {
    goals.errors.push_back(changes.error());
    return;
  }
  for (const dronecan::NodeId id : whom.selected) {
    const fleet::Servo servo = whom.roster.member(id).servo();
    const auto change = std::ranges::find_if(*changes, [&](const fleet::Undoing& each) {
      return each.entry.unique_id == servo.unique_id &&
             !fleet::has_other_serial(servo, each.entry.serial_number);
    });
    if (change != changes->end()) {
      take_back(*change, id, goals);
    } else {
      goals.errors.push_back({Code::not_found,
                              say<texts::undo_nothing_of_node_since>(id.value(), *options_.to),
                              say<texts::undo_see_list_hint>(), id.value()});
    }
  }
}

/// Without -n: all servos that were changed, wherever they are now.
void Undo::of_all(const Whom& whom, Goals& goals) {
  const auto changes = this->changes();
  if (!changes) {
    goals.errors.push_back(changes.error());
    return;
  }
  if (changes->empty()) { // an unfinished undo, without the change before it
    goals.errors.push_back({Code::not_found, say<texts::undo_nothing_at_all>(),
                            say<texts::undo_see_list_hint>(), std::nullopt});
  }
  for (const fleet::Undoing& change : *changes) {
    const SnapshotEntry& entry = change.entry;
    const auto& members = whom.roster.members();
    const auto there = std::ranges::find_if(
        members, [&](const auto& each) { return each.second.is_unit(entry.unique_id); });
    if (there != members.end()) {
      take_back(change, there->first, goals);
      continue;
    }
    const auto& doubled = whom.roster.doubled();
    const auto shared = std::ranges::find_if(doubled, [&](dronecan::NodeId id) {
      return whom.roster.units(id).contains(entry.unique_id);
    });
    if (shared != doubled.end()) {
      goals.errors.push_back(fleet::doubled(whom.roster, *shared));
      continue;
    }
    goals.may_wait = true;
    goals.missing = std::move(goals.missing).value_or(std::vector<dronecan::UniqueId>());
    goals.missing->push_back(entry.unique_id);
    goals.errors.push_back(
        {Code::not_found, say<texts::undo_missing>(hex(entry.unique_id), printable(entry.command)),
         say<texts::apply_missing_hint>(), std::nullopt});
  }
}

void Undo::of_node(dronecan::NodeId id, const Whom& whom, Goals& goals) {
  const fleet::Servo servo = whom.roster.member(id).servo();
  const auto change = servo.unique_id ? fleet::last_change(store_, *servo.unique_id,
                                                           servo.identity.readings().serial_number)
                                      : Result<std::optional<fleet::Undoing>>();
  if (!change) {
    goals.errors.push_back(change.error());
  } else if (*change) {
    take_back(**change, id, goals);
  } else {
    goals.errors.push_back({Code::not_found, say<texts::undo_nothing_of_node>(id.value()),
                            say<texts::undo_see_list_hint>(), id.value()});
  }
}

void Undo::take_back(const fleet::Undoing& change, dronecan::NodeId id, Goals& goals) {
  if (auto copied = fleet::not_unique(context_.session().roster(), id)) {
    goals.errors.push_back(std::move(*copied));
    return;
  }
  const auto left =
      fleet::as_left(change, id, context_.session(), context_.known(), context_.identification());
  if (!left) {
    goals.errors.push_back(left.error());
    return;
  }
  const SnapshotEntry& entry = left->entry;
  auto wanted = fleet::to_undo(entry, context_.known());
  if (!wanted) {
    wanted.error().node_id = id.value();
    goals.errors.push_back(std::move(wanted.error()));
    return;
  }
  std::string note = options_.to
                         ? say<texts::undo_takes_back_since>(*options_.to)
                         : say<texts::undo_takes_back>(printable(entry.command), rfc3339(entry.at));
  if (told_.insert(note).second) {
    context_.reporter().note(note);
  }
  if (!change.goes_on) {
    numbers_[entry.unique_id] = change.numbers;
  }
  if (options_.no_save) {
    wanted->restart.reset();
  }
  goals.goals.push_back({.id = id,
                         .unique_id = entry.unique_id,
                         .serial_number = entry.serial_number,
                         .wanted = std::move(*wanted),
                         .evidence = fleet::Evidence::restart});
}

void Undo::forget_what_never_was(std::span<const fleet::GoalResult> results) {
  std::vector<state::Settlement> settlements;
  for (const fleet::GoalResult& result : results) {
    const auto number =
        result.servo().unique_id ? numbers_.find(*result.servo().unique_id) : numbers_.end();
    const bool is_as_it_was = result.is_done && !result.change.saved && !result.has_differences();
    if (number != numbers_.end() && is_as_it_was && !options_.no_save) {
      std::ranges::transform(number->second, std::back_inserter(settlements), [](auto each) {
        return state::Settlement{each, state::ChangeEnd::never_begun};
      });
    }
  }
  if (settlements.empty()) {
    return;
  }
  if (auto store = open_snapshots(context_.shared().interface, state::Access::write)) {
    // on failure it is found again the next time
    [[maybe_unused]] const auto settled = store->settle(settlements);
  }
}

Report list(const SnapshotStore& store, Context& context) {
  Report report;
  const auto profiles = context.profiles();
  if (!profiles) {
    report.fail(profiles.error());
    return report;
  }
  auto entries = store.entries();
  if (!entries) {
    report.fail(std::move(entries.error()));
    return report;
  }
  const auto kept = std::make_shared<std::vector<SnapshotEntry>>(std::move(*entries));
  report.counts = {{"snapshots", kept->size()}};
  report.json = [kept, profiles](JsonWriter& json) { write_snapshots(json, *kept, **profiles); };
  report.text = [kept, profiles](const Page& page) { return text(*kept, **profiles, page); };
  return report;
}

Report failure(Error error) {
  Report report;
  report.fail(std::move(error));
  return report;
}

Report execute(const UndoOptions& options, Context& context) {
  const auto store = open_snapshots(context.shared().interface, state::Access::read);
  if (!store) {
    return failure(store.error());
  }
  if (options.list) {
    return options.dry_run || options.no_save || options.to || context.shared().nodes
               ? failure({Code::usage, say<texts::undo_list_alone>(),
                          say<texts::undo_list_alone_hint>(), std::nullopt})
               : list(*store, context);
  }
  const auto last = store->last_run();
  if (!last || last->empty()) {
    return failure(last ? Error{Code::not_found, say<texts::undo_nothing_at_all>(),
                                say<texts::undo_nothing_at_all_hint>(), std::nullopt}
                        : last.error());
  }
  Undo undo(options, *store, context);
  return change_servos({.command = "undo",
                        .search = Search::everybody,
                        .needs_targets = false,
                        .find = [&](const Whom& whom) { return undo.find(whom); },
                        .ended =
                            [&](auto results) {
                              if (!options.dry_run) {
                                undo.forget_what_never_was(results);
                              }
                            },
                        .times = options.times,
                        .dry_run = options.dry_run,
                        .view = ResultView::entries},
                       context);
}

} // namespace

constinit const Command commands::undo{
    .name = "undo",
    .traits = {.writes = true, .from_history = true, .session = true},
    .help = {"back to what servos held before the last change", "直前の変更を元に戻す"},
    .options = undo_options,
    .action = action<UndoOptions, execute>,
};

} // namespace blactl::cli
