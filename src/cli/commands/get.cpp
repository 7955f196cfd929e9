// blactl get: reads parameters.

#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/register_choice.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "cli/commands.hpp"
#include "cli/output/parameter_view.hpp"
#include "cli/read_servos.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace blactl::cli {
namespace {

struct GetOptions {
  std::vector<std::string> parameters{};
  std::vector<std::string> groups{};
  bool all = false;
  bool changed = false;
};

constexpr Option get_options[]{
    {.name = "--group",
     .value = "G",
     .kind = Kind::group,
     .repeat = Repeat::list,
     .help = {"all of a group: command, status, operation, fault, config, control, pwm, limit, "
              "option, product, production",
              "グループ内の全パラメータ: command、status、operation、fault、config、control、pwm、"
              "limit、option、product、production"},
     .store = into<&GetOptions::groups>},
    {.name = "--all",
     .kind = Kind::flag,
     .help = {"every parameter (as without PARAM)", "全パラメータ (PARAM 省略時と同じ)"},
     .store = into<&GetOptions::all>},
    {.name = "--changed",
     .kind = Kind::flag,
     .help = {"only what differs from the model's default", "機種の初期値と異なるもののみ"},
     .store = into<&GetOptions::changed>},
};

constexpr Option get_arguments[]{
    {.name = "PARAM",
     .kind = Kind::parameter,
     .repeat = Repeat::list,
     .help = {"names or addresses: angle_limit_cw, 0x38",
              "名前またはアドレス: angle_limit_cw、0x38"},
     .store = into<&GetOptions::parameters>},
};

/// Checks that need no servo.
std::expected<fleet::RegisterChoice, std::vector<Error>> understand(const GetOptions& options,
                                                                    const bla::Profiles& profiles) {
  auto choice = fleet::RegisterChoice::parse(profiles, options.parameters, options.groups);
  return choice && options.all ? fleet::RegisterChoice::parse(profiles, {}, {}) : choice;
}

/// The shown values of one servo. If its model, and so the default, is uncertain, none is left out.
ServoValues shown(fleet::Snapshot snapshot, const fleet::RegisterChoice& choice,
                  bool changed_only) {
  auto readings = choice.asked_for(snapshot);
  std::erase_if(readings, [](const fleet::Reading& reading) { return !reading.raw; });
  const bool can_differ = std::ranges::any_of(
      readings, [](const fleet::Reading& reading) { return reading.parameter->writable(); });
  std::erase_if(readings, [&](const fleet::Reading& reading) {
    const bla::Parameter& parameter = *reading.parameter;
    return changed_only && (!parameter.writable() || parameter.default_raw == *reading.raw);
  });
  return {.snapshot = std::move(snapshot), .shown = std::move(readings), .can_differ = can_differ};
}

/// Without known defaults, --changed cannot leave values out.
void tell_unknown_defaults(const GetOptions& options, const fleet::Servo& servo,
                           const Reporter& reporter) {
  if (options.changed && servo.is_servo && servo.identity.model().empty()) {
    reporter.note(say<texts::no_defaults_known>(servo.id.value()));
  }
}

std::vector<Error> errors(const fleet::Snapshot& snapshot, const fleet::RegisterChoice& choice,
                          const fleet::Roster& roster) {
  const bool is_begun = snapshot.servo.is_servo;
  if (!is_begun && snapshot.error && snapshot.error->code == Code::interrupted) {
    return {}; // the command's own error covers it
  }
  std::vector<Error> all = snapshot.errors();
  if (roster.is_doubled(snapshot.servo.id)) { // the readings are from two units
    return {fleet::doubled(roster, snapshot.servo.id)};
  }
  std::ranges::move(choice.refusals(snapshot.servo), std::back_inserter(all));
  return all;
}

Report execute(const GetOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto profiles = context.profiles();
  if (!profiles) {
    report.fail(profiles.error());
    return report;
  }
  const auto choice = understand(options, **profiles);
  if (!choice) {
    report.errors = choice.error();
    return report;
  }
  const auto servos = select_for_reading("get", context, report);
  if (!servos) {
    return report;
  }
  const auto answers = std::make_shared<std::vector<ServoValues>>();
  auto snapshots =
      fleet::take_snapshots(context.session(), context.known(), *servos, context.identification(),
                            [&](const fleet::Servo& servo) { return choice->registers_of(servo); });
  const fleet::Roster& roster = context.session().roster();
  if (snapshots.broken) { // before the servos: those report it as well
    context.broken(*snapshots.broken, report);
  }
  note_copies(snapshots.servos, context);
  for (fleet::Snapshot& snapshot : snapshots.servos) {
    tell_unknown_defaults(options, snapshot.servo, context.reporter());
    report.targets.push_back({.errors = errors(snapshot, *choice, roster)});
    if (!snapshot.error && !roster.is_doubled(snapshot.servo.id)) {
      answers->push_back(shown(std::move(snapshot), *choice, options.changed));
      answers->back().is_complete = report.targets.back().errors.empty();
    }
  }
  report.count_targets();
  report.json = [answers](JsonWriter& json) { write_json(json, *answers); };
  report.csv = [answers] { return csv(*answers); };
  report.text = [answers, &known = **profiles, changed = options.changed](const Page& page) {
    return text(*answers, known, changed, page);
  };
  return report;
}

} // namespace

constinit const Command commands::get{
    .name = "get",
    .traits = {.tables = true, .session = true, .recordings = true},
    .help = {"read parameters", "パラメータの読出し"},
    .options = get_options,
    .arguments = get_arguments,
    .action = action<GetOptions, execute>,
};

} // namespace blactl::cli
