// blactl faults: 0x18-0x1B in words.

#include "blactl/fleet/live/fault_job.hpp"

#include "cli/commands.hpp"
#include "cli/faults/watch.hpp"
#include "cli/output/faults_view.hpp"
#include "cli/read_servos.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace blactl::cli {
namespace {

using bla::Level;
using fleet::FaultState;

struct FaultsOptions {
  std::optional<Level> level{};
  bool watch = false;
};

constexpr std::array<std::string_view, 3> levels{"notice", "warning", "failure"}; // as bla::Level

constexpr Option faults_options[]{
    {.name = "--level",
     .value = "L",
     .kind = Kind::word,
     .words = levels,
     .help = {"only faults of this level and above; they make the exit status 8 (default: all are "
              "shown, warning and above make it 8)",
              "このレベル以上のみ表示し、あれば終了ステータス 8 とする (省略時: 全て表示し、"
              "警告以上で 8)"},
     .store = into<&FaultsOptions::level>},
    {.name = "--watch",
     .kind = Kind::flag,
     .help = {"goes on until Ctrl-C: every fault as it comes and goes",
              "Ctrl-C まで継続し、発生と解消を表示"},
     .store = into<&FaultsOptions::watch>},
};

void list(const std::vector<dronecan::NodeId>& ids, const FaultsOptions& options, Context& context,
          Report& report) {
  auto read = fleet::read_faults(context.session(), context.known(), ids, context.identification());
  if (read.broken) { // before the servos: those report it as well
    context.broken(*read.broken, report);
  }
  for (const FaultState& servo : read.servos) {
    report.targets.push_back(
        {.errors = servo.errors,
         .has_found = has_found(servo, options.level.value_or(Level::warning))});
  }
  const auto servos = std::make_shared<std::vector<FaultState>>(std::move(read.servos));
  std::erase_if(*servos, [](const FaultState& servo) { return servo.snapshot.readings.empty(); });
  const Level level = options.level.value_or(Level::notice);
  report.json = [servos, level](JsonWriter& json) { write_json(json, *servos, level); };
  report.text = [servos, level](const Page& page) { return text(*servos, level, page); };
}

Report execute(const FaultsOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface), .is_stream = options.watch};
  if (const auto profiles = context.profiles(); !profiles) {
    report.fail(profiles.error());
    return report;
  }
  const auto servos = select_for_reading("faults", context, report);
  if (!servos) {
    return report;
  }
  if (options.watch) {
    watch_faults(*servos, options.level.value_or(Level::notice),
                 options.level.value_or(Level::warning), context, report);
  } else {
    list(*servos, options, context, report);
  }
  report.count_targets();
  return report;
}

} // namespace

constinit const Command commands::faults{
    .name = "faults",
    .traits = {.session = true, .recordings = true},
    .help = {"what is wrong with servos, and what to do", "障害・警告・通知の内容と対処"},
    .options = faults_options,
    .action = action<FaultsOptions, execute>,
};

} // namespace blactl::cli
