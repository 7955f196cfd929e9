// blactl apply: brings servos to the settings of a fleet file, proven after a restart.

#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/saved_plan.hpp"
#include "blactl/fleet/files/fleet_diff.hpp"
#include "blactl/fleet/files/fleet_file.hpp"
#include "blactl/fleet/files/fleet_match.hpp"

#include "cli/change/change_servos.hpp"
#include "cli/change/texts.hpp"
#include "cli/commands.hpp"
#include "cli/settings_files.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
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
  RestartTimes times{};
};

constexpr Option apply_options[]{
    {.name = "--dry-run",
     .kind = Kind::flag,
     .help = {"change nothing; exit status 8 when something would be done",
              "変更しない (処理の予定がある場合は終了ステータス 8)"},
     .store = into<&ApplyOptions::dry_run>},
    {.name = "--plan",
     .kind = Kind::flag,
     .help = {"FILE is what `apply --dry-run --json` printed: do just that, and only where nothing "
              "has changed since",
              "FILE は `apply --dry-run --json` の出力。作成時から変化がない場合のみ実行"},
     .store = into<&ApplyOptions::is_plan>},
    {.name = "--entry",
     .value = "NAME",
     .kind = Kind::text,
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
    restart_wait<&ApplyOptions::times>,
    restart_stagger<&ApplyOptions::times>,
};

constexpr Option apply_arguments[]{
    {.name = "FILE",
     .kind = Kind::file,
     .required = true,
     .help = {"a fleet file or, for one servo, a parameter file. `-`: stdin",
              "フリートファイル、または 1 台分のパラメータファイル。`-` で標準入力"},
     .store = into<&ApplyOptions::file>},
};

/// How to carry out an entry.
struct Manner {
  std::function<bool(const fleet::FleetEntry& entry)> saves; ///< settings go to ROM, too
  bool trusts_ram = false; ///< equal RAM is enough: no restart to prove ROM
};

fleet::Goal goal(const fleet::FleetEntry& entry, dronecan::NodeId id, const Manner& manner) {
  return {.id = id,
          .name = entry.name,
          .wanted = {.assignments = entry.set,
                     .restart = manner.saves(entry) ? std::optional(fleet::RestartKind::save)
                                                    : std::nullopt},
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

/// The error for an entry without a servo.
Error missing(const fleet::FleetEntry& entry, const fleet::Roster& roster) {
  auto unclear = fleet::may_be_unidentified(entry, roster);
  return unclear ? std::move(*unclear)
                 : Error{Code::not_found,
                         say<texts::apply_missing>(entry.name, fleet::text(entry.match)),
                         say<texts::apply_missing_hint>(), std::nullopt};
}

/// The goals for the servos that match entries.
Goals match(const fleet::FleetFile& file, const Manner& manner, const Whom& whom,
            const bla::Profiles& profiles) {
  const auto matched = fleet::match(file, whom.roster, whom.targets, profiles);
  Goals goals{.others = fleet::unpaired(matched, whom.roster, profiles), .errors = matched.errors};
  for (const fleet::FleetMatch::Pair& pair : matched.pairs) {
    goals.goals.push_back(goal(*pair.entry, pair.id, manner));
  }
  for (const fleet::FleetEntry* entry : matched.missing) {
    goals.errors.push_back(missing(*entry, whom.roster));
  }
  goals.may_wait = !matched.missing.empty();
  goals.missing = units(matched.missing);
  if (goals.goals.empty() && goals.errors.empty()) {
    goals.errors.push_back({Code::not_found, say<texts::apply_nobody>(printable(file.file)),
                            say<texts::apply_nobody_hint>(printable(file.file)), std::nullopt});
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

/// The entry named by --entry.
Result<const fleet::FleetEntry*> find_entry(const fleet::FleetFile& file, const std::string& name) {
  const auto found = std::ranges::find(file.servos, name, &fleet::FleetEntry::name);
  if (found != file.servos.end()) {
    return &*found;
  }
  std::string names;
  for (const fleet::FleetEntry& entry : file.servos) {
    names += (names.empty() ? "" : ", ") + printable(entry.name);
  }
  return fail(Code::usage, say<texts::apply_no_entry>(printable(file.file), printable(name)),
              say<texts::apply_no_entry_hint>(names));
}

/// A plan contains all of this already.
std::optional<Error> refuse_beside_plan(const ApplyOptions& options) {
  const std::pair<bool, std::string_view> all[]{{!options.entry.empty(), "--entry"},
                                                {options.no_save, "--no-save"},
                                                {options.trust_ram, "--trust-ram"}};
  for (const auto& [is_given, option] : all) {
    if (is_given) {
      return Error{Code::usage, say<texts::apply_beside_plan>(option),
                   say<texts::apply_beside_plan_hint>(), std::nullopt};
    }
  }
  return std::nullopt;
}

Report carry_out_plan(const ApplyOptions& options, ChangeRequest request, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  if (auto refused = refuse_beside_plan(options)) {
    report.fail(std::move(*refused));
    return report;
  }
  const auto plan = fleet::read_saved_plan(options.file, context.known());
  if (!plan) {
    report.fail(plan.error());
    return report;
  }
  const Manner manner{
      .saves = [&](const fleet::FleetEntry& entry) { return plan->step(entry).saves; },
      .trusts_ram = plan->trusts_ram};
  request.find = [&](const Whom& whom) {
    return match(plan->fleet, manner, whom, context.known());
  };
  request.refuse = [&](std::span<const fleet::GoalResult> results) {
    return fleet::stale(*plan, results);
  };
  return change_servos(request, context);
}

Report apply_file(const ApplyOptions& options, ChangeRequest request, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto file = read_settings(options.file, context, report);
  if (!file) {
    return report;
  }
  const Manner manner{.saves = [&](const fleet::FleetEntry&) { return !options.no_save; },
                      .trusts_ram = options.trust_ram};
  request.find = [&](const Whom& whom) { return match(*file, manner, whom, context.known()); };
  if (!options.entry.empty()) {
    const auto entry = find_entry(*file, options.entry);
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

Report execute(const ApplyOptions& options, Context& context) {
  if (overwrites_its_file(options)) {
    Report report{.interface = printable(context.shared().interface)};
    report.fail({Code::usage, say<texts::events_over_file>(printable(options.events)),
                 say<texts::events_unopened_hint>(), std::nullopt});
    return report;
  }
  if (const auto profiles = context.profiles(); !profiles) {
    Report report{.interface = printable(context.shared().interface)};
    report.fail(profiles.error());
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
