// blactl export: the configuration of servos as a file for apply.

#include "blactl/base/read_file.hpp"
#include "blactl/base/replace_file.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/files/fleet_file.hpp"
#include "blactl/fleet/files/params_file.hpp"
#include "blactl/fleet/files/recipe.hpp"

#include "cli/commands.hpp"
#include "cli/confirm.hpp"
#include "cli/fleet_texts.hpp"
#include "cli/log_target.hpp"
#include "cli/output/alike.hpp"
#include "cli/read_servos.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

struct ExportOptions {
  std::string file{}; ///< empty or "-": stdout
  bool recipe = false;
  bool params = false;

  [[nodiscard]] bool to_stdout() const { return file.empty() || file == "-"; }
};

constexpr Option export_options[]{
    {.name = "--recipe",
     .kind = Kind::flag,
     .help = {"of one servo, for others of its model: without servo_id and static_node_id",
              "1 台の設定を同じ機種用のレシピにする (servo_id と static_node_id を除く)"},
     .store = into<&ExportOptions::recipe>},
    {.name = "--params",
     .kind = Kind::flag,
     .help =
         {"of one servo, as the parameter file that the DroneCAN GUI Tool and Mission Planner load",
          "1 台の設定を DroneCAN GUI Tool、Mission Planner 用のパラメータファイルにする"},
     .store = into<&ExportOptions::params>},
};

constexpr Option export_arguments[]{
    {.name = "FILE",
     .kind = Kind::file,
     .help = {"where to; it is replaced only when everything was read (default `-`: stdout)",
              "出力先。すべて読み出せた場合のみ置き換える (省略時 `-`: 標準出力)"},
     .store = into<&ExportOptions::file>},
};

/// The option for a file of one servo; empty: none.
std::string_view form_of_one(const ExportOptions& options) {
  return options.recipe ? "--recipe" : options.params ? "--params" : "";
}

std::string content(const ExportOptions& options, std::span<const fleet::Snapshot> servos,
                    std::optional<WallTime> time) {
  const fleet::FleetFileStyle style{time, BLACTL_VERSION};
  return options.recipe   ? fleet::recipe_file(servos.front())
         : options.params ? fleet::params_file(servos.front(), style)
                          : fleet::fleet_file(servos, style);
}

/// Errors that are found before a frame is sent.
std::optional<Error> refuse(const ExportOptions& options, const Context& context) {
  if (options.recipe && options.params) {
    return Error{Code::usage, say<texts::export_one_form>(), say<texts::export_one_form_hint>(),
                 std::nullopt};
  }
  if (options.to_stdout()) {
    return context.reporter().format() == Format::json
               ? std::optional(Error{Code::usage, say<texts::export_json_needs_file>(),
                                     say<texts::export_json_needs_file_hint>(), std::nullopt})
               : std::nullopt;
  }
  const auto apart = check_no_state(options.file, "export");
  const auto replaceable = apart ? check_replaceable(options.file) : apart;
  return replaceable ? std::nullopt : std::optional(replaceable.error());
}

/// Errors of single servos go to the report.
std::vector<fleet::Snapshot> read(std::span<const dronecan::NodeId> servos, Context& context,
                                  Report& report) {
  auto read = fleet::take_snapshots(context.session(), context.known(), servos,
                                    context.identification(), fleet::registers_to_export);
  if (read.broken) {
    context.broken(*read.broken, report);
  }
  note_copies(read.servos, context);
  const fleet::Roster& roster = context.session().roster();
  std::vector<AboutNode> notes;
  for (fleet::Snapshot& snapshot : read.servos) {
    fleet::drop_unrecorded_state(snapshot);
    if (const auto unread = fleet::check_rom(snapshot)) {
      notes.push_back({snapshot.servo.id.value(), unread->message});
    }
    const bool doubled = roster.is_doubled(snapshot.servo.id);
    report.targets.push_back({.errors = doubled
                                            ? std::vector{fleet::doubled(roster, snapshot.servo.id)}
                                            : snapshot.errors()});
  }
  for (const auto& [first, others] : alike(notes)) {
    context.reporter().note(likewise(notes[first].text, others));
  }
  return std::move(read.servos);
}

/// "# BLA21-12U-AB 240900001 blactl 0.1.0": of which servo a parameter file is.
std::string_view first_line(std::string_view text) {
  return text.substr(0, text.find(" blactl "));
}

/// Whether `old` was exported from the same servos; a recipe: from one of this model.
bool is_export_of(const ExportOptions& options, const std::string& old, const std::string& content,
                  std::span<const fleet::Snapshot> servos, const bla::Profiles& profiles) {
  if (options.recipe) {
    const auto recipe = fleet::parse_recipe(old, options.file, profiles);
    const auto now = fleet::parse_recipe(content, options.file, profiles);
    return recipe && now && recipe->counters.empty() && recipe->name == now->name &&
           recipe->model == now->model;
  }
  if (options.params) {
    return first_line(old) == first_line(content);
  }
  const auto fleet = fleet::parse_fleet_file(old, options.file, profiles);
  if (!fleet || fleet->servos.size() != servos.size()) {
    return false;
  }
  return std::ranges::all_of(servos, [&](const fleet::Snapshot& servo) {
    return std::ranges::any_of(fleet->servos, [&](const fleet::FleetEntry& entry) {
      return entry.match.unique_id && entry.match.unique_id == servo.servo.unique_id &&
             entry.about.tool_version; // else somebody wrote it by hand
    });
  });
}

/// On a terminal a file of something else is replaced only after a yes.
Result<void> may_replace(const ExportOptions& options, const std::string& content,
                         std::span<const fleet::Snapshot> servos, Context& context) {
  constexpr std::size_t most = 16 << 20;
  std::error_code error;
  const bool is_asked = !options.to_stdout() && Reporter::has_terminal() &&
                        std::filesystem::exists(options.file, error);
  const auto old = is_asked ? read_file(options.file, most) : Result<std::string>();
  if (!is_asked || (old && is_export_of(options, *old, content, servos, context.known()))) {
    return {};
  }
  return confirm(say<texts::export_replaces>(printable(options.file)), context);
}

/// Shows the content, or writes it to the file.
void conclude(const ExportOptions& options, std::string content,
              std::span<const fleet::Snapshot> servos, Context& context, Report& report) {
  if (report.all_errors().empty()) {
    if (auto agreed = may_replace(options, content, servos, context); !agreed) {
      report.fail(agreed.error());
    }
  }
  const bool was_read = report.all_errors().empty();
  if (!options.to_stdout() && was_read) {
    if (auto written = replace_file(options.file, content); !written) {
      report.fail(written.error());
    }
  }
  const bool is_done = report.all_errors().empty();
  report.json = [file = options.file, is_done](JsonWriter& json) {
    json.member("file", file);
    json.member("status", is_done ? "done" : "failed");
  };
  if (!is_done) {
    return;
  }
  report.text = [options, content = std::make_shared<std::string>(std::move(content)),
                 servos = report.targets.size()](const Page&) {
    return options.to_stdout() ? *content
                               : say<texts::export_written>(printable(options.file), servos);
  };
}

Report execute(const ExportOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  if (const auto profiles = context.profiles(); !profiles) {
    report.fail(profiles.error());
    return report;
  }
  if (auto refused = refuse(options, context)) {
    report.fail(std::move(*refused));
    return report;
  }
  const auto nodes = select_for_reading("export", context, report);
  if (!nodes) {
    return report;
  }
  if (const std::string_view form = form_of_one(options); !form.empty() && nodes->size() > 1) {
    report.fail({Code::usage, say<texts::export_of_one>(form, nodes->size()),
                 say<texts::export_of_one_hint>(form, nodes->front().value()), std::nullopt});
    return report;
  }
  const auto servos = read(*nodes, context, report);
  if (const auto waiting = context.session().roster().pending().size(); waiting > 0) {
    context.reporter().note(say<texts::units_wait_for_id>(waiting));
  }
  report.count_targets();
  if (servos.empty()) {
    return report;
  }
  // the time at which a fleet file was read from servos is not known for each value
  const auto time =
      context.is_fleet_file() ? std::nullopt : std::optional(context.session().wall());
  const std::string text = content(options, servos, time);
  const bool was_read = report.all_errors().empty();
  if (was_read && !options.recipe && !options.params) {
    const auto fine = fleet::parse_fleet_file(text, options.file, context.known());
    if (!fine) {
      context.reporter().note(say<texts::export_has_faults>(fine.error().message));
    }
  }
  conclude(options, text, servos, context, report);
  if (!was_read && !options.to_stdout()) {
    context.reporter().note(say<texts::export_not_written>(printable(options.file)));
  }
  return report;
}

} // namespace

constinit const Command commands::export_servos{
    .name = "export",
    .traits = {.session = true, .recordings = true},
    .help = {"the configuration of servos as a file for apply",
             "サーボの設定を apply 用のファイルに出力"},
    .options = export_options,
    .arguments = export_arguments,
    .action = action<ExportOptions, execute>,
};

} // namespace blactl::cli
