// blactl apply: brings servos to the settings of a fleet file, proven after a restart.

#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/saved_plan.hpp"
#include "blactl/fleet/files/fleet_diff.hpp"
#include "blactl/fleet/files/fleet_file.hpp"
#include "blactl/fleet/files/fleet_match.hpp"

#include "cli/change/change_servos.hpp"
#include "cli/change/texts.hpp"
#include "cli/change/waiting_ids.hpp"
#include "cli/commands.hpp"
#include "cli/settings_files.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

namespace blactl::cli {
namespace {

struct ApplyOptions {
  std::string file{};
  std::string entry{}; ///< empty: all entries
  bool dry_run = false;
  bool is_plan = false;
  bool no_save = false;
  bool trust_ram = false;
  bool fail_fast = false;
  std::string events{};
  bool no_snapshot = false;
  bool check = false;
  RestartTimes times{};
};

constexpr Option apply_options[]{
    dry_run_option<&ApplyOptions::dry_run>,
    {.name = "--plan",
     .kind = Kind::flag,
     .help = {"FILE is what `apply --dry-run --json` printed: do just that, and only where nothing "
              "has changed since",
              "FILE は `apply --dry-run --json` の出力。作成時から変化がない場合のみ実行"},
     .store = into<&ApplyOptions::is_plan>},
    {.name = "--entry",
     .value = "NAME",
     .kind = Kind::entry,
     .help = {"give this entry to the servo behind -n, whatever it matches: for a broken servo's "
              "successor",
              "エントリ NAME を、照合条件によらず -n のサーボに設定 (故障品から交換したサーボ用)"},
     .store = into<&ApplyOptions::entry>},
    {.name = "--no-save",
     .kind = Kind::flag,
     .help = {"RAM only", "RAM のみ変更"},
     .store = into<&ApplyOptions::no_save>},
    {.name = "--trust-ram",
     .kind = Kind::flag,
     .help = {"if RAM is as wished, do not restart to check ROM",
              "RAM が一致していれば、ROM 確認のための再起動をしない"},
     .store = into<&ApplyOptions::trust_ram>},
    {.name = "--fail-fast",
     .kind = Kind::flag,
     .help = {"once one servo is known to have failed, no other is saved any more",
              "1 台の失敗が判明した時点で、以後の書込みと保存を中止"},
     .store = into<&ApplyOptions::fail_fast>},
    {.name = "--events",
     .value = "FILE",
     .kind = Kind::file,
     .help = {"write a line of JSON to FILE for each servo and stage",
              "サーボの各段階を 1 行ずつ JSON で FILE に出力"},
     .store = into<&ApplyOptions::events>},
    {.name = "--no-snapshot",
     .kind = Kind::flag,
     .help = {"go on even if the settings of servos cannot be recorded for `undo`",
              "変更履歴を記録できない場合も続行 (`undo` では戻せません)"},
     .store = into<&ApplyOptions::no_snapshot>},
    {.name = "--check",
     .kind = Kind::flag,
     .help = {"only check FILE against the models, without a bus",
              "FILE を機種データと照合するのみ (バスは使用しない)"},
     .store = into<&ApplyOptions::check>},
    restart_wait<&ApplyOptions::times>,
    restart_stagger<&ApplyOptions::times>,
};

constexpr Option apply_arguments[]{
    {.name = "FILE",
     .kind = Kind::file,
     .required = true,
     .help = {"a fleet file, a parameter file or, for the servos of -n, a recipe. `-`: stdin",
              "フリートファイル、パラメータファイル、または (-n のサーボ用の) レシピ。"
              "`-` で標準入力"},
     .store = into<&ApplyOptions::file>},
};

/// How to carry out an entry.
struct Manner {
  std::function<bool(const fleet::FleetEntry& entry)> saves; ///< settings go to ROM, too
  bool trusts_ram = false;     ///< equal RAM is enough: no restart to prove ROM
  bool is_listed_only = false; ///< in the order of the file, for --dry-run
  std::string_view interface{};
};

fleet::Goal goal(const fleet::FleetEntry& entry, dronecan::NodeId id, const Manner& manner) {
  return {.id = id,
          .name = entry.name,
          .wanted = {.assignments = entry.set,
                     .restart = manner.saves(entry) ? std::optional(fleet::RestartKind::save)
                                                    : std::nullopt,
                     .never_while_driven = true},
          .evidence = manner.trusts_ram ? fleet::Evidence::ram : fleet::Evidence::restart};
}

/// Their unique IDs; empty: not all entries have one.
std::optional<std::vector<dronecan::UniqueId>>
units(std::span<const fleet::FleetEntry* const> entries) {
  std::vector<dronecan::UniqueId> units;
  for (const fleet::FleetEntry* entry : entries) {
    if (!entry->match.unique_id) {
      return std::nullopt;
    }
    units.push_back(*entry->match.unique_id);
  }
  return units;
}

/// What may help: a servo that no entry means may be there in place of it, or wait for a node ID.
std::string hint_for_missing(const fleet::FleetFile& file, const fleet::FleetEntry& entry,
                             const fleet::FleetMatch& matched, const fleet::Roster& roster) {
  const bool is_another_there = !matched.extra.empty() || !roster.requests().empty();
  const bool may_be_replaced =
      is_another_there && !entry.name.empty() && entry.match.means_one() && file.file != "-";
  const std::string hint = may_be_replaced ? say<texts::apply_replaced_hint>(shell_word(file.file),
                                                                             shell_word(entry.name))
                                           : say<texts::apply_missing_hint>();
  const std::size_t waiting = roster.pending().size();
  const auto& unit = entry.match.unique_id;
  const bool may_wait = waiting > 0 && (!unit || roster.is_pending(*unit));
  return may_wait ? say<texts::apply_may_wait_hint>(waiting) + hint : hint;
}

/// The error for an entry without a servo.
Error missing(const fleet::FleetEntry& entry, const fleet::Roster& roster, std::string hint) {
  auto unclear = fleet::may_be_unidentified(entry, roster);
  const std::string whom = fleet::text(entry.match);
  return unclear ? std::move(*unclear)
                 : Error{Code::not_found,
                         entry.name.empty() ? say<texts::apply_missing_unnamed>(whom)
                                            : say<texts::apply_missing>(entry.name, whom),
                         std::move(hint), std::nullopt};
}

/// The goals for the servos that match entries.
Goals match(const fleet::FleetFile& file, const Manner& manner, const Whom& whom,
            const bla::Profiles& profiles) {
  auto matched = fleet::match(file, whom.roster, whom.targets, profiles);
  if (manner.is_listed_only) { // entries are in the order of the file
    std::ranges::stable_sort(matched.pairs, std::less<>(), &fleet::FleetMatch::Pair::entry);
  }
  Goals goals{.others = fleet::unpaired(matched, whom.roster, profiles),
              .notes = notes(file, matched),
              .errors = matched.errors};
  for (const fleet::FleetMatch::Pair& pair : matched.pairs) {
    goals.goals.push_back(goal(*pair.entry, pair.id, manner));
  }
  for (const fleet::FleetEntry* entry : matched.missing) {
    const auto& unit = entry->match.unique_id;
    if (manner.is_listed_only && unit && whom.roster.is_pending(*unit)) {
      goals.notes.push_back(say<texts::apply_would_let_in>(
          printable(entry->name), would_get_id(*unit, whom.roster, manner.interface),
          entry->set.size()));
      ++goals.would_let_in;
    } else {
      goals.errors.push_back(
          missing(*entry, whom.roster, hint_for_missing(file, *entry, matched, whom.roster)));
    }
  }
  std::ranges::transform(matched.misfits, std::back_inserter(goals.errors),
                         &fleet::FleetMatch::Misfit::error);
  goals.may_wait = !matched.missing.empty();
  goals.missing = units(matched.missing);
  if (goals.goals.empty() && goals.errors.empty() && goals.would_let_in == 0) {
    goals.errors.push_back({Code::not_found, say<texts::apply_nobody>(printable(file.file)),
                            say<texts::apply_nobody_hint>(shell_word(file.file)), std::nullopt});
  }
  return goals;
}

/// The goals with one entry for the selected servo.
Goals give(const fleet::FleetEntry& entry, const Manner& manner, const Whom& whom) {
  if (whom.selected.size() != 1) {
    return {.errors = {{Code::usage, say<texts::apply_entry_one>(whom.selected.size()),
                        say<texts::apply_entry_one_hint>(), std::nullopt}}};
  }
  return {.goals = {goal(entry, whom.selected.front(), manner)}};
}

/// An option, and whether it was given.
using GivenOption = std::pair<std::string_view, bool>;

/// Fails for each that was given although it has no meaning beside `option`.
void refuse_beside(std::string_view option, std::span<const GivenOption> others,
                   std::string_view hint, Report& report) {
  for (const auto& [other, is_given] : others) {
    if (is_given) {
      report.fail(
          {Code::usage, say<texts::apply_beside>(other, option), std::string(hint), std::nullopt});
    }
  }
}

Report carry_out_plan(const ApplyOptions& options, ChangeRequest request, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const GivenOption contained[]{{"--entry", !options.entry.empty()},
                                {"--no-save", options.no_save},
                                {"--trust-ram", options.trust_ram}};
  refuse_beside("--plan", contained, say<texts::apply_beside_plan_hint>(), report);
  if (!report.errors.empty()) {
    return report;
  }
  const auto plan = fleet::read_saved_plan(options.file, context.known());
  if (!plan) {
    report.fail(plan.error());
    return report;
  }
  const Manner manner{
      .saves = [&](const fleet::FleetEntry& entry) { return plan->step(entry).saves; },
      .trusts_ram = plan->trusts_ram,
      .is_listed_only = options.dry_run,
      .interface = context.shared().interface};
  request.find = [&](const Whom& whom) {
    return match(plan->fleet, manner, whom, context.known());
  };
  request.refuse = [&](std::span<const fleet::GoalResult> results) {
    return fleet::stale(*plan, results);
  };
  return change_servos(request, context);
}

/// What the form of the file does not permit, before a frame is sent.
void refuse_form(const ApplyOptions& options, const fleet::FleetFile& file, const Context& context,
                 Report& report) {
  if (file.names_nobody() && !options.entry.empty()) {
    report.fail({Code::usage, say<texts::apply_without_entries>(printable(file.file)),
                 say<texts::apply_without_entries_hint>(), std::nullopt});
  }
  if (auto refused = refuse_counters(file)) {
    report.fail(std::move(*refused));
  }
  const auto targets = context.targets();
  auto refused = targets ? refuse_without_targets(file, *targets) : std::optional(targets.error());
  if (refused) {
    report.fail(std::move(*refused));
  }
}

/// The file alone, without a bus.
Report check_file(const ApplyOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const GivenOption on_the_bus[]{{"-n", context.shared().nodes.has_value()},
                                 {"--dry-run", options.dry_run},
                                 {"--plan", options.is_plan},
                                 {"--entry", !options.entry.empty()},
                                 {"--no-save", options.no_save},
                                 {"--trust-ram", options.trust_ram},
                                 {"--fail-fast", options.fail_fast},
                                 {"--events", !options.events.empty()},
                                 {"--no-snapshot", options.no_snapshot},
                                 {"--wait", options.times.wait.has_value()},
                                 {"--stagger", options.times.stagger > Duration::zero()}};
  refuse_beside("--check", on_the_bus, say<texts::apply_beside_check_hint>(), report);
  const auto file =
      report.errors.empty() ? read_settings(options.file, context, report) : std::nullopt;
  if (!file) {
    return report;
  }
  std::size_t settings = file->recipe ? file->recipe->counters.size() : 0;
  for (const fleet::FleetEntry& entry : file->servos) {
    settings += entry.set.size();
  }
  report.counts = {{"entries", file->servos.size()}, {"settings", settings}};
  report.text = [name = printable(file->file), entries = file->servos.size(), settings](
                    const Page&) { return say<texts::apply_checked>(name, entries, settings); };
  return report;
}

Report apply_file(const ApplyOptions& options, ChangeRequest request, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto file = read_settings(options.file, context, report);
  if (file) {
    refuse_form(options, *file, context, report);
  }
  if (!report.errors.empty()) {
    return report;
  }
  const Manner manner{.saves = [&](const fleet::FleetEntry&) { return !options.no_save; },
                      .trusts_ram = options.trust_ram,
                      .is_listed_only = options.dry_run,
                      .interface = context.shared().interface};
  request.find = [&](const Whom& whom) { return match(*file, manner, whom, context.known()); };
  if (!options.entry.empty()) {
    const auto entry = fleet::find_entry(*file, options.entry);
    if (!entry) {
      report.fail(entry.error());
      return report;
    }
    request.find = [&manner, entry = *entry](const Whom& whom) {
      return give(*entry, manner, whom);
    };
    request.needs_targets = true;
  }
  return change_servos(request, context);
}

/// An input file must not be overwritten.
bool overwrites_its_file(const ApplyOptions& options) {
  std::error_code none;
  return std::filesystem::equivalent(options.events, options.file, none);
}

Report carry_out(const ApplyOptions& options, Context& context) {
  if (overwrites_its_file(options)) {
    Report report{.interface = printable(context.shared().interface)};
    report.fail({Code::usage, say<texts::events_over_file>(printable(options.events)),
                 say<texts::events_unopened_hint>(), std::nullopt});
    return report;
  }
  const ChangeRequest request{.command = "apply",
                              .search = Search::everybody,
                              .needs_targets = false,
                              .times = options.times,
                              .dry_run = options.dry_run,
                              .fails_fast = options.fail_fast,
                              .events = options.events,
                              .recording = options.no_snapshot ? Recording::if_possible
                                                               : Recording::required,
                              .view = ResultView::entries};
  return options.is_plan ? carry_out_plan(options, request, context)
                         : apply_file(options, request, context);
}

Report execute(const ApplyOptions& options, Context& context) {
  if (const auto profiles = context.profiles(); !profiles) {
    Report report{.interface = printable(context.shared().interface)};
    report.fail(profiles.error());
    return report;
  }
  return options.check ? check_file(options, context) : carry_out(options, context);
}

} // namespace

constinit const Command commands::apply{
    .name = "apply",
    .traits = {.writes = true, .from_file = true, .session = true},
    .help = {"bring servos to a fleet file, proven after a restart",
             "フリートファイルの内容をサーボに設定 (再起動後に確認)"},
    .options = apply_options,
    .arguments = apply_arguments,
    .action = action<ApplyOptions, execute>,
};

} // namespace blactl::cli
