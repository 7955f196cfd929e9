// blactl provision: the station of a production line.

#include "blactl/base/json_reader.hpp"
#include "blactl/base/read_file.hpp"
#include "blactl/base/sha256.hpp"
#include "blactl/fleet/line/counter_check.hpp"

#include "cli/alloc/options.hpp"
#include "cli/commands.hpp"
#include "cli/line/provision_run.hpp"
#include "cli/line/texts.hpp"

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

namespace blactl::cli {
namespace {

constexpr Option provision_options[]{
    {.name = "--label",
     .value = "-",
     .kind = Kind::text,
     .help = {"read a line for each servo: a serial number, or a JSON object",
              "サーボごとに 1 行読み取る (製造番号または JSON オブジェクト)"},
     .store = into<&ProvisionOptions::label>},
    {.name = "--range",
     .value = "A-B",
     .kind = Kind::text,
     .help = {"node IDs lent to servos that ask for one (default 100-124)",
              "ID を要求するサーボに一時的に割り当てるノード ID (省略時 100-124)"},
     .store = into<&ProvisionOptions::range>},
    {.name = "--count",
     .value = "N",
     .kind = Kind::whole,
     .whole = {1, 1'000'000},
     .help = {"end after this many servos", "この台数を処理したら終了"},
     .store = into<&ProvisionOptions::count>},
    {.name = "--idle-timeout",
     .value = "SEC",
     .kind = Kind::seconds,
     .seconds = {std::chrono::seconds(1), std::chrono::hours(24)},
     .help = {"end when no servo comes for this long", "この時間サーボが接続されなければ終了"},
     .store = into<&ProvisionOptions::idle_timeout>},
    {.name = "--station",
     .value = "NAME",
     .kind = Kind::text,
     .help = {"for the records (default: the name of this machine)",
              "記録するステーション名 (省略時: ホスト名)"},
     .store = into<&ProvisionOptions::station>},
    {.name = "--operator",
     .value = "NAME",
     .kind = Kind::text,
     .help = {"for the records", "記録する作業者名"},
     .store = into<&ProvisionOptions::operator_name>},
    {.name = "--work-order",
     .value = "NAME",
     .kind = Kind::text,
     .help = {"for the records", "記録する作業指示番号"},
     .store = into<&ProvisionOptions::work_order>},
    {.name = "--redo",
     .kind = Kind::flag,
     .help = {"do finished servos anew, with the IDs they have",
              "処理済みのサーボも、同じ ID のまま再処理"},
     .store = into<&ProvisionOptions::redo>},
    {.name = "--reason",
     .value = "TEXT",
     .kind = Kind::text,
     .help = {"with --redo: why", "--redo の理由"},
     .store = into<&ProvisionOptions::reason>},
    {.name = "--max-attempts",
     .value = "N",
     .kind = Kind::whole,
     .whole = {1, 1000},
     .help = {"how often a servo may fail (default 3)", "サーボごとの不合格の上限回数 (省略時 3)"},
     .store = into<&ProvisionOptions::max_attempts>},
    {.name = "--stop-after",
     .value = "N",
     .kind = Kind::whole,
     .whole = {1, 1000},
     .help = {"end when this many fail in a row", "この台数が連続して不合格になれば終了"},
     .store = into<&ProvisionOptions::stop_after>},
    {.name = "--events",
     .value = "FILE",
     .kind = Kind::file,
     .help = {"write what happens to a file or a pipe, for a lamp or a controller",
              "ランプや PLC 用に、処理の経過をファイルまたはパイプに出力"},
     .store = into<&ProvisionOptions::events>},
    {.name = "--logs",
     .value = "FOLDER",
     .kind = Kind::folder,
     .help = {"keep the frames of every servo that did not pass, named by its record_id",
              "合格しなかったサーボのフレームを record_id の名前で保存"},
     .store = into<&ProvisionOptions::logs>},
};

constexpr Option provision_arguments[]{
    {.name = "RECIPE",
     .kind = Kind::file,
     .required = true,
     .help = {"the recipe of the line", "ラインのレシピ"},
     .store = into<&ProvisionOptions::recipe>},
};

/// Adds every fault of the options to the report.
void check(const ProvisionOptions& options, const Shared& shared, Report& report) {
  if (shared.nodes || shared.profile) {
    const std::string_view option = shared.nodes ? "-n" : "--profile";
    report.fail({Code::usage, say<texts::provision_takes_all>(option),
                 say<texts::provision_takes_all_hint>(), std::nullopt});
  }
  if (shared.overwrite_rom) {
    report.fail({Code::usage, say<texts::provision_never_overwrites>(),
                 say<texts::provision_takes_all_hint>(), std::nullopt});
  }
  if (!options.logs.empty() && shared.record) {
    report.fail({Code::usage, say<texts::provision_logs_alone>(),
                 say<texts::provision_logs_alone_hint>(), std::nullopt});
  }
  if (!options.label.empty() && options.label != "-") {
    report.fail({Code::usage, say<texts::provision_label_word>(printable(options.label)),
                 say<texts::provision_label_word_hint>(), std::nullopt});
  }
  if (const auto range = parse_range(options.range); !range) {
    report.fail(range.error());
  }
  if (options.redo && options.reason.empty()) {
    report.fail({Code::usage, say<texts::provision_redo_reason>(),
                 say<texts::provision_redo_reason_hint>(), std::nullopt});
  }
  if (!options.redo && !options.reason.empty()) {
    report.fail({Code::usage, say<texts::provision_reason_alone>(),
                 say<texts::provision_reason_alone_hint>(), std::nullopt});
  }
}

Report execute(const ProvisionOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface), .is_stream = true};
  check(options, context.shared(), report);
  const auto profiles = context.profiles();
  if (!profiles) {
    report.fail(profiles.error());
  }
  const auto text = read_file(options.recipe, json::max_file_bytes);
  if (!text || !report.errors.empty()) {
    if (!text) {
      report.fail(text.error());
    }
    return report;
  }
  auto recipe = fleet::parse_recipe(*text, options.recipe, **profiles);
  if (!recipe) {
    report.fail(recipe.error());
    return report;
  }
  if (const auto own = context.shared().local_node_id) {
    if (const auto free = fleet::check_own_id(*recipe, dronecan::NodeId(*own)); !free) {
      report.fail(free.error());
      return report;
    }
  }
  ProvisionRun(options, std::move(*recipe), sha256(*text), context, report).run();
  return report;
}

} // namespace

constinit const Command commands::provision{
    .name = "provision",
    .traits = {.streams = true, .tables = true, .session = true},
    .help = {"a production line: check, number, configure, prove and record each servo",
             "製造ライン: サーボを 1 台ずつ確認・採番・設定・検証・記録"},
    .options = provision_options,
    .arguments = provision_arguments,
    .action = action<ProvisionOptions, execute>,
};

} // namespace blactl::cli
