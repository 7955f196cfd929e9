// blactl replace: a new servo takes the place of a broken one, on the bus and in the fleet file.

#include "blactl/base/file_hold.hpp"
#include "blactl/base/hex.hpp"
#include "blactl/base/json_reader.hpp"
#include "blactl/base/read_file.hpp"
#include "blactl/base/replace_file.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/files/fleet_file_editor.hpp"
#include "blactl/fleet/files/fleet_match.hpp"
#include "blactl/fleet/files/successor.hpp"

#include "cli/change/change_servos.hpp"
#include "cli/change/texts.hpp"
#include "cli/change/waiting_ids.hpp"
#include "cli/commands.hpp"
#include "cli/stores.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

struct ReplaceOptions {
  std::string file{};
  std::string name{};
  bool dry_run = false;
  bool no_snapshot = false;
  RestartTimes times{};
};

constexpr Option replace_options[]{
    dry_run_option<&ReplaceOptions::dry_run>,
    {.name = "--no-snapshot",
     .kind = Kind::flag,
     .help = {"go on even if the settings of the servo cannot be recorded for `undo`",
              "変更履歴を記録できない場合も続行 (`undo` では戻せません)"},
     .store = into<&ReplaceOptions::no_snapshot>},
    restart_wait<&ReplaceOptions::times>,
};

constexpr Option replace_arguments[]{
    {.name = "FILE",
     .kind = Kind::file,
     .required = true,
     .help = {"the fleet file; it names the new servo in the end",
              "フリートファイル (最後に新しいサーボの個体情報に書き換える)"},
     .store = into<&ReplaceOptions::file>},
    {.name = "NAME",
     .kind = Kind::entry,
     .required = true,
     .help = {"the name of the broken servo's entry", "故障したサーボのエントリ名"},
     .store = into<&ReplaceOptions::name>},
};

/// The fleet file, as it was read.
struct File {
  std::optional<FileHold> hold; ///< until the new servo is named; a dry run needs none
  std::string text;
  fleet::FleetFile fleet;
};

Result<File> read(const std::string& name, bool dry_run, const bla::Profiles& profiles) {
  if (name == "-") {
    return fail(Code::usage, say<texts::replace_needs_file>(),
                say<texts::replace_needs_file_hint>());
  }
  if (const auto replaceable = check_replaceable(name); !replaceable) {
    return fail(Code::usage, replaceable.error().message, replaceable.error().hint);
  }
  std::optional<FileHold> hold;
  if (!dry_run) {
    auto taken = FileHold::take(name);
    if (!taken) {
      return std::unexpected(std::move(taken.error()));
    }
    hold.emplace(std::move(*taken));
  }
  auto text = read_file(name, json::max_file_bytes);
  if (!text) {
    return std::unexpected(text.error());
  }
  auto fleet = fleet::parse_fleet_file(*text, name, profiles);
  return fleet ? Result<File>({std::move(hold), std::move(*text), std::move(*fleet)})
               : std::unexpected(fleet.error());
}

/// One run of the command.
class Replacement {
 public:
  Replacement(const ReplaceOptions& options, const File& file, const fleet::FleetEntry& entry,
              Context& context)
      : options_(options), file_(file), entry_(entry), context_(context) {}

  [[nodiscard]] Goals find(const Whom& whom);

  /// Puts the new servo into the file, once it is proven.
  void ended(std::span<const fleet::GoalResult> results);

  /// Why the file does not name the new servo; empty: it does, or the servo is not done.
  [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }

 private:
  [[nodiscard]] std::optional<std::string> waiting_successor(const Whom& whom) const;
  [[nodiscard]] bool has_taken_place(const dronecan::UniqueId& unit) const;
  [[nodiscard]] std::optional<Error> old_beside_successor(const fleet::Roster& roster) const;
  [[nodiscard]] Result<void> look_for_broken(const fleet::GoalResult& result);
  [[nodiscard]] Result<fleet::Snapshot> read_unit(const fleet::GoalResult& result);
  [[nodiscard]] Result<void> name_unit(const fleet::Snapshot& unit);

  const ReplaceOptions& options_;
  const File& file_;
  const fleet::FleetEntry& entry_;
  Context& context_;
  std::optional<Error> failure_;
};

Goals Replacement::find(const Whom& whom) {
  const auto found = fleet::find_successor(file_.fleet, entry_, whom.roster, whom.targets,
                                           whom.selected, context_.known());
  const auto waiting = !found && options_.dry_run && found.error().code == Code::not_found
                           ? waiting_successor(whom)
                           : std::nullopt;
  if (waiting) {
    return {.notes = {*waiting}, .would_let_in = 1};
  }
  auto old = found ? std::nullopt : old_beside_successor(whom.roster);
  if (old) {
    return {.errors = {std::move(*old)}};
  }
  if (!found) {
    return {.errors = {found.error()}, .may_wait = found.error().code == Code::not_found};
  }
  const auto unit = whom.roster.member(found->id).unique_id();
  if (found->is_meant && !(unit && has_taken_place(*unit))) {
    return {.errors = {fleet::still_there(file_.fleet, entry_, found->id)}};
  }
  auto settings = fleet::settings_of_successor(entry_, context_.known());
  if (!settings) {
    return {.errors = {settings.error()}};
  }
  const std::uint8_t id = found->id.value();
  const std::string name = printable(entry_.name);
  return {.goals = {{.id = found->id,
                     .unique_id = unit,
                     .name = entry_.name,
                     .wanted = {.assignments = std::move(*settings),
                                .restart = fleet::RestartKind::save},
                     .evidence = fleet::Evidence::restart}},
          .notes = {found->is_meant ? say<texts::replace_took_place>(id, name)
                                    : say<texts::replace_takes_place>(id, name)}};
}

/// The only unit that waits for a node ID, if it can be no other than the new one: told in a dry
/// run.
std::optional<std::string> Replacement::waiting_successor(const Whom& whom) const {
  const auto pending = whom.roster.pending();
  if (!whom.targets.mean_all() || pending.size() != 1) {
    return std::nullopt;
  }
  const auto missing =
      fleet::match(file_.fleet, whom.roster, fleet::Targets(), context_.known()).missing;
  const bool may_have_entry = std::ranges::any_of(missing, [&](const fleet::FleetEntry* entry) {
    const auto& unit = entry->match.unique_id;
    return !unit || dronecan::begins_with(*unit, pending.front());
  });
  dronecan::UniqueId unit{};
  std::ranges::copy(pending.front(), unit.begin());
  return may_have_entry ? std::nullopt
                        : std::optional(say<texts::replace_would_let_in>(
                              hex(pending.front()),
                              would_get_id(unit, whom.roster, context_.shared().interface),
                              printable(entry_.name)));
}

/// A run of this command may have been killed at its end. One whose last change was another is the
/// broken one.
bool Replacement::has_taken_place(const dronecan::UniqueId& unit) const {
  const auto store = open_snapshots(context_.shared().interface, state::Access::read);
  const auto last = store ? store->last(unit) : Result<std::optional<state::SnapshotEntry>>();
  return last && *last && (*last)->command == fleet::replacing;
}

/// By the record of an earlier run: the unit that it put there last is the successor.
std::optional<Error> Replacement::old_beside_successor(const fleet::Roster& roster) const {
  const auto store = open_snapshots(context_.shared().interface, state::Access::read);
  std::optional<state::SnapshotEntry> newest;
  for (const dronecan::NodeId id : roster.doubled()) {
    for (const dronecan::UniqueId& unit : roster.units(id)) {
      const auto last = store ? store->last(unit) : Result<std::optional<state::SnapshotEntry>>();
      if (last && *last && (*last)->command == fleet::replacing &&
          (!newest || newest->number < (*last)->number)) {
        newest = **last;
      }
    }
  }
  return newest ? fleet::back_on_its_id(entry_, newest->unique_id, newest->serial_number, roster)
                : std::nullopt;
}

void Replacement::ended(std::span<const fleet::GoalResult> results) {
  if (options_.dry_run || results.size() != 1 || !results.front().is_done) {
    return;
  }
  const auto away = look_for_broken(results.front());
  const auto unit = away ? read_unit(results.front()) : std::unexpected(away.error());
  const auto named = unit ? name_unit(*unit) : std::unexpected(unit.error());
  if (!named) {
    const bool is_doubled = named.error().code == Code::duplicate_node_id;
    failure_ = {named.error().code, say<texts::replace_file_left>(named.error().message),
                is_doubled ? named.error().hint : say<texts::replace_again_hint>(),
                named.error().node_id};
  }
}

/// The broken one may have come back meanwhile.
Result<void> Replacement::look_for_broken(const fleet::GoalResult& result) {
  fleet::Discovery discovery(context_.session(), context_.known(), context_.identification());
  if (const auto found = discovery.find_all(fleet::bus_watch_time); !found) {
    return found;
  }
  const fleet::Roster& roster = context_.session().roster();
  const dronecan::UniqueId unit = result.servo().unique_id.value();
  auto back =
      fleet::back_on_its_id(entry_, unit, result.servo().identity.readings().serial_number, roster);
  if (!back) {
    back = fleet::come_back(file_.fleet, entry_, unit, roster, context_.known());
  }
  return back ? std::unexpected(std::move(*back)) : Result<void>();
}

/// As it is on the bus now.
Result<fleet::Snapshot> Replacement::read_unit(const fleet::GoalResult& result) {
  const std::array ids{result.change.node_id_after.value_or(result.servo().id)};
  auto read = fleet::take_snapshots(context_.session(), context_.known(), ids,
                                    context_.identification(), fleet::registers_to_export);
  if (read.broken) {
    return std::unexpected(std::move(*read.broken));
  }
  fleet::Snapshot& unit = read.servos.front();
  if (auto error = unit.first_error()) {
    return std::unexpected(std::move(*error));
  }
  return unit.servo.unique_id == result.servo().unique_id
             ? Result<fleet::Snapshot>(std::move(unit))
             : std::unexpected(fleet::silent(context_.session().roster(), ids.front()));
}

Result<void> Replacement::name_unit(const fleet::Snapshot& unit) {
  if (fleet::names_unit(entry_, unit.servo)) {
    return {}; // by an earlier run
  }
  const std::string file = printable(options_.file);
  const std::string name = printable(entry_.name);
  const fleet::FleetFileStyle style{context_.session().wall(), BLACTL_VERSION};
  const auto text = fleet::with_unit(file_.text, options_.file, entry_.name, unit, style);
  const auto now = text ? read_file(options_.file, json::max_file_bytes) : text;
  if (!now) {
    return std::unexpected(now.error());
  }
  if (*now != file_.text) {
    return fail(Code::io, say<texts::replace_file_changed>(file));
  }
  if (*text == file_.text) {
    context_.reporter().note(say<texts::replace_keeps>(file, name));
    return {};
  }
  if (auto replaced = replace_file(options_.file, *text); !replaced) {
    return replaced;
  }
  context_.reporter().note(
      say<texts::replace_names>(file, name, unit.servo.id.value(), hex(*unit.servo.unique_id)));
  context_.reporter().note(say<texts::replace_autopilot>(unit.servo.id.value()));
  return {};
}

Report execute(const ReplaceOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto profiles = context.profiles();
  const auto file = profiles ? read(options.file, options.dry_run, **profiles)
                             : std::unexpected(profiles.error());
  const auto entry = file ? fleet::find_entry(file->fleet, options.name)
                          : Result<const fleet::FleetEntry*>(std::unexpected(file.error()));
  if (!entry) {
    report.fail(entry.error());
    return report;
  }
  Replacement replacement(options, *file, **entry, context);
  report = change_servos(
      {.command = fleet::replacing,
       .search = Search::everybody,
       .needs_targets = false,
       .waiting = Waiting::always, // the broken one may wait, too
       .find = [&](const Whom& whom) { return replacement.find(whom); },
       .ended = [&](auto results) { replacement.ended(results); },
       .times = options.times,
       .dry_run = options.dry_run,
       .recording = options.no_snapshot ? Recording::if_possible : Recording::required,
       .view = ResultView::entries},
      context);
  if (replacement.failure()) {
    report.fail(*replacement.failure());
  }
  report.json = [nodes = std::move(report.json), file = options.file](JsonWriter& json) {
    if (nodes) {
      nodes(json);
    }
    json.member("file", file);
  };
  return report;
}

} // namespace

constinit const Command commands::replace{
    .name = "replace",
    .traits = {.writes = true, .for_newcomer = true, .session = true},
    .help = {"give a new servo the place of a broken one, and name it in the fleet file",
             "故障したサーボの代わりに新しいサーボを設定し、フリートファイルを更新"},
    .options = replace_options,
    .arguments = replace_arguments,
    .action = action<ReplaceOptions, execute>,
};

} // namespace blactl::cli
