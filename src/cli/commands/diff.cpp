// blactl diff: servos against a fleet file, or file against file.

#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/files/fleet_diff.hpp"
#include "blactl/fleet/files/fleet_match.hpp"

#include "cli/commands.hpp"
#include "cli/fleet_texts.hpp"
#include "cli/output/fleet_view.hpp"
#include "cli/read_servos.hpp"
#include "cli/settings_files.hpp"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

namespace blactl::cli {
namespace {

struct DiffOptions {
  std::vector<std::string> files{};
};

constexpr Option diff_arguments[]{
    {.name = "FILE",
     .kind = Kind::file,
     .repeat = Repeat::list,
     .required = true,
     .help =
         {"what servos are compared with: a fleet file, a parameter file or, for those of -n, a "
          "recipe; two: with each other. `-`: stdin",
          "サーボと比較するフリートファイル、パラメータファイル、または (-n のサーボ用の) レシピ。"
          "2 つの場合はファイル同士を比較。`-` で標準入力"},
     .store = into<&DiffOptions::files>},
};

/// Shows the differences, and sets the exit status.
void conclude(fleet::FleetDiff found, std::string one, std::string other, Report& report) {
  using fleet::EntryStatus;
  std::uint64_t differences = 0;
  for (const fleet::EntryDiff& entry : found.entries) {
    const bool is_alike =
        entry.status == EntryStatus::unchanged || entry.status == EntryStatus::skipped;
    report.targets.push_back({.errors = entry.errors, .has_found = !is_alike});
    differences += entry.differences();
  }
  report.count_targets();
  report.counts.emplace_back("differences", differences);
  const auto kept = std::make_shared<std::vector<fleet::EntryDiff>>(std::move(found.entries));
  report.json = [kept](JsonWriter& json) { write_json(json, *kept); };
  report.text = [kept, one = std::move(one), other = std::move(other)](const Page& page) {
    return text(*kept, one, other, page);
  };
}

/// Identifies every servo that may be selected; false: the report has the reason.
bool look_around(Context& context, Report& report) {
  if (!open_for_reading("diff", context, report)) {
    return false;
  }
  auto identification = context.identification();
  identification.static_node_id = true; // if a servo is matched by its node ID
  fleet::Discovery discovery(context.session(), context.known(), identification);
  if (const auto found = discovery.find_all(fleet::bus_watch_time); !found) {
    context.broken(found.error(), report);
    return false;
  }
  if (const auto waiting = context.session().roster().pending().size(); waiting > 0) {
    context.reporter().note(say<texts::units_wait_for_id>(waiting));
  }
  return true;
}

void compare_servos(const fleet::FleetFile& file, const fleet::Targets& targets, Context& context,
                    Report& report) {
  if (!look_around(context, report)) {
    return;
  }
  const auto match = fleet::match(file, context.session().roster(), targets, context.known(),
                                  context.session().is_replay());
  for (const std::string& note : notes(file, match)) {
    context.reporter().note(note);
  }
  report.errors.insert(report.errors.end(), match.errors.begin(), match.errors.end());
  auto found = fleet::diff(context.session(), context.known(), match, context.identification());
  if (found.broken) {
    context.broken(*found.broken, report);
  }
  conclude(std::move(found), say<texts::fleet_column_servo>(), say<texts::fleet_column_file>(),
           report);
}

/// Errors that are found before a file is read.
std::optional<Error> refuse(const std::vector<std::string>& files, bool chooses) {
  if (files.size() == 2 && chooses) {
    return Error{Code::usage, say<texts::fleet_files_are_whole>(),
                 say<texts::fleet_files_are_whole_hint>(), std::nullopt};
  }
  if (files.size() > 2) {
    return Error{Code::usage, say<texts::fleet_many_files>(files.size()),
                 say<texts::fleet_many_files_hint>(), std::nullopt};
  }
  if (std::ranges::count(files, "-") > 1) {
    return Error{Code::usage, say<texts::fleet_two_stdin>(), say<texts::fleet_two_stdin_hint>(),
                 std::nullopt};
  }
  return std::nullopt;
}

/// A recipe may be compared as far as it says itself what each servo holds.
void refuse_recipes(std::span<const fleet::FleetFile> files, const fleet::Targets& targets,
                    Report& report) {
  for (const fleet::FleetFile& file : files) {
    if (auto refused = refuse_counters(file)) {
      report.fail(std::move(*refused));
    }
  }
  if (files.size() == 1) {
    if (auto refused = refuse_without_targets(files.front(), targets)) {
      report.fail(std::move(*refused));
    }
  }
}

/// Errors of the files taken together, as far as they could be read.
std::optional<Error> refuse(std::span<const fleet::FleetFile> files) {
  const auto many = std::ranges::find_if(
      files, [](const fleet::FleetFile& file) { return file.servos.size() != 1; });
  if (std::ranges::none_of(files, &fleet::FleetFile::names_nobody) || many == files.end()) {
    return std::nullopt;
  }
  return Error{Code::usage, say<texts::params_one_entry>(printable(many->file)),
               say<texts::params_one_entry_hint>(), std::nullopt};
}

Report execute(const DiffOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto profiles = context.profiles();
  if (!profiles) {
    report.fail(profiles.error());
    return report;
  }
  const auto targets = context.targets();
  if (!targets) {
    report.fail(targets.error());
    return report;
  }
  if (auto refused = refuse(options.files, targets->given)) {
    report.fail(std::move(*refused));
    return report;
  }
  std::vector<fleet::FleetFile> files;
  for (const std::string& name : options.files) {
    if (auto file = read_settings(name, context, report)) {
      files.push_back(std::move(*file));
    }
  }
  if (auto refused = refuse(files)) {
    report.fail(std::move(*refused));
  }
  if (files.size() == options.files.size()) {
    refuse_recipes(files, *targets, report);
  }
  if (!report.errors.empty()) {
    return report;
  }
  if (files.size() == 1) {
    compare_servos(files.front(), *targets, context, report);
  } else {
    conclude(fleet::diff(files[0], files[1], **profiles), printable(files[0].file),
             printable(files[1].file), report);
  }
  return report;
}

} // namespace

constinit const Command commands::diff{
    .name = "diff",
    .traits = {.session = true, .recordings = true},
    .help = {"servos against a fleet file, or file against file",
             "サーボとフリートファイル、またはファイル同士の比較"},
    .arguments = diff_arguments,
    .action = action<DiffOptions, execute>,
};

} // namespace blactl::cli
