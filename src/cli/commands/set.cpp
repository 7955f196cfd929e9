// blactl set: checks values against the profile, writes them, and reads them back.

#include "blactl/bla/assignment.hpp"

#include "cli/change/change_servos.hpp"
#include "cli/commands.hpp"

namespace blactl::cli {
namespace {

struct SetOptions {
  std::vector<std::string> assignments{};
  bool dry_run = false;
  bool save = false;
  RestartTimes times{};
};

constexpr Option set_options[]{
    {.name = "--save",
     .kind = Kind::flag,
     .help = {"then RAM to ROM: restarts the servo, and reads again",
              "続けて RAM を ROM に保存 (サーボの再起動後に再読出し)"},
     .store = into<&SetOptions::save>},
    {.name = "--dry-run",
     .kind = Kind::flag,
     .help = {"change nothing; exit status 8 when something would change",
              "変更しない (変更がある場合は終了ステータス 8)"},
     .store = into<&SetOptions::dry_run>},
    restart_wait<&SetOptions::times>,
    restart_stagger<&SetOptions::times>,
};

constexpr Option set_arguments[]{
    {.name = "PARAM=VALUE",
     .kind = Kind::assignment,
     .repeat = Repeat::list,
     .required = true,
     .help = {"what to write: angle_limit_cw=90deg, 0x38=900",
              "書き込む値: angle_limit_cw=90deg、0x38=900"},
     .store = into<&SetOptions::assignments>},
};

Report execute(const SetOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto profiles = context.profiles();
  if (!profiles) {
    report.fail(profiles.error());
    return report;
  }
  // errors that hold for every model: no frame is sent
  auto assignments = bla::parse_assignments(**profiles, options.assignments);
  if (!assignments) {
    report.errors = std::move(assignments.error());
    return report;
  }
  const auto restart = options.save ? std::optional(fleet::RestartKind::save) : std::nullopt;
  auto request =
      request_for_all("set", {.assignments = std::move(*assignments), .restart = restart},
                      options.save ? fleet::Evidence::record : fleet::Evidence::none);
  request.times = options.times;
  request.dry_run = options.dry_run;
  request.view = ResultView::changes;
  return change_servos(request, context);
}

} // namespace

constinit const Command commands::set{
    .name = "set",
    .traits = {.writes = true, .session = true},
    .help = {"check against the servo's model, write, read back",
             "機種の仕様と照合してから書込み、読み出して確認"},
    .options = set_options,
    .arguments = set_arguments,
    .action = action<SetOptions, execute>,
};

} // namespace blactl::cli
