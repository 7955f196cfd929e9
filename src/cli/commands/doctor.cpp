// blactl doctor: the problems of an interface, a bus and its nodes, their severity, and the fixes.

#include "cli/commands.hpp"
#include "cli/doctor/examination.hpp"
#include "cli/doctor/mend_interface.hpp"
#include "cli/doctor/report_file.hpp"
#include "cli/doctor/view.hpp"

#include <chrono>
#include <memory>

namespace blactl::cli {
namespace {

struct DoctorOptions {
  bool fix = false;
  std::string report{};
};

constexpr Option doctor_options[]{
    {.name = "--fix",
     .kind = Kind::flag,
     .help = {"set up the CAN interface and bring it up, if something about it is wrong, after a "
              "question",
              "問題があれば CAN インターフェースを設定、起動 (事前に確認)"},
     .store = into<&DoctorOptions::fix>},
    {.name = "--report",
     .value = "FILE",
     .kind = Kind::file,
     .help = {"write all of it to one file for the support: findings, parameters, faults, node IDs "
              "given, and 10 s of traffic; -i replay:FILE answers from it",
              "診断結果、パラメータ、障害、割当て表、10 秒間の通信をサポート用ファイルに保存 "
              "(-i replay:FILE で参照可能)"},
     .store = into<&DoctorOptions::report>},
};

/// Longer than the silence after which a node counts as lost.
constexpr Duration look_time = std::chrono::milliseconds(3500);
constexpr Duration report_time = std::chrono::seconds(10);

Report execute(const DoctorOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  if (const auto profiles = context.profiles(); !profiles) {
    report.fail(profiles.error());
    return report;
  }
  const bool writes = !options.report.empty();
  if (const auto ready = writes ? prepare_report(options.report, context) : Result<void>();
      !ready) {
    report.fail(ready.error());
    return report;
  }
  const auto examination = std::make_shared<Examination>();
  if (options.fix) {
    mend_interface(context, *examination, report);
    if (context.signal() != 0) {
      return report;
    }
  }
  examine(writes ? report_time : look_time, context, *examination, report);
  if (writes && examination->nodes) {
    write_report(options.report, *examination, context, report);
  }
  report.targets.push_back({.has_found = !examination->diagnoses.empty()});
  report.counts = {{"findings", examination->diagnoses.size()}};
  report.count_targets(examination->nodes ? examination->nodes->nodes.size() : 0);
  report.json = [examination](JsonWriter& json) { write_json(json, *examination); };
  report.text = [examination](const Page& page) { return text(*examination, page); };
  return report;
}

} // namespace

constinit const Command commands::doctor{
    .name = "doctor",
    .traits = {.session = true, .recordings = true},
    .help = {"problems of interface, bus and nodes, and how to fix them",
             "インターフェース、バス、ノードの問題と対処"},
    .options = doctor_options,
    .action = action<DoctorOptions, execute>,
};

} // namespace blactl::cli
