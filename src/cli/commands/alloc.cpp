// blactl alloc: dynamic node IDs, and the table of who has which.

#include "cli/alloc/book.hpp"
#include "cli/alloc/options.hpp"
#include "cli/alloc/serve.hpp"
#include "cli/alloc/texts.hpp"
#include "cli/commands.hpp"

#include <array>
#include <utility>

namespace blactl::cli {
namespace {

constexpr Option option_table[]{
    {.name = "--once",
     .kind = Kind::flag,
     .help = {"end when nobody asks any more", "割当て要求がなくなったら終了"},
     .store = into<&AllocOptions::once>},
    {.name = "--count",
     .value = "N",
     .kind = Kind::whole,
     .whole = {1, 125},
     .help = {"end when so many units have their node ID", "この台数の割当てが済んだら終了"},
     .store = into<&AllocOptions::count>},
    {.name = "--wait",
     .value = "SEC",
     .kind = Kind::seconds,
     .seconds = {std::chrono::seconds(2), std::chrono::hours(24)},
     .help = {"with --once: how long to wait for the first request (default 10)",
              "--once 使用時に最初の要求を待つ時間 (省略時 10)"},
     .store = into<&AllocOptions::wait>},
    {.name = "--range",
     .value = "A-B",
     .kind = Kind::text,
     .help = {"take new node IDs from these (default 1-125, from the top)",
              "新規割当てに使う範囲 (省略時 1-125、大きい番号から)"},
     .store = into<&AllocOptions::range>},
    {.name = "--assign",
     .value = "UID=ID",
     .kind = Kind::text,
     .repeat = Repeat::list,
     .help = {"this unit gets this node ID from now on",
              "以後、この固有 ID にこのノード ID を割り当てる"},
     .store = into<&AllocOptions::assign>},
    {.name = "--list",
     .kind = Kind::flag,
     .help = {"show the table, without a bus", "割当て表を表示 (バス不要)"},
     .store = into<&AllocOptions::list>},
    {.name = "--forget",
     .value = "UID",
     .kind = Kind::text,
     .repeat = Repeat::list,
     .help = {"drop a unit from the table: its node ID is free", "割当て表から削除"},
     .store = into<&AllocOptions::forget>},
    {.name = "--export",
     .value = "FILE",
     .kind = Kind::file,
     .help = {"write the table to a file, - for stdout", "割当て表をファイルに出力 (- で標準出力)"},
     .store = into<&AllocOptions::export_to>},
    {.name = "--import",
     .value = "FILE",
     .kind = Kind::file,
     .help = {"take over the entries of such a file: all, or none",
              "--export で出力したファイルを割当て表に取り込む (全件または中止)"},
     .store = into<&AllocOptions::import_from>},
};

/// The options that mean a thing of its own, in the order in which they are named.
std::vector<std::string_view> things(const AllocOptions& options) {
  const bool serves =
      options.once || options.count || !options.range.empty() || !options.assign.empty();
  const std::array<std::pair<bool, std::string_view>, 5> all{
      {{serves, options.once            ? "--once"
                : options.count         ? "--count"
                : options.range.empty() ? "--assign"
                                        : "--range"},
       {options.list, "--list"},
       {!options.forget.empty(), "--forget"},
       {!options.export_to.empty(), "--export"},
       {!options.import_from.empty(), "--import"}}};
  std::vector<std::string_view> given;
  for (const auto& [is_given, option] : all) {
    if (is_given) {
      given.push_back(option);
    }
  }
  return given;
}

Report execute(const AllocOptions& options, Context& context) {
  if (context.shared().nodes) {
    Report report;
    report.fail({Code::usage, say<texts::alloc_no_nodes>(), say<texts::alloc_no_nodes_hint>(),
                 std::nullopt});
    return report;
  }
  if (const auto given = things(options); given.size() > 1) {
    Report report;
    report.fail({Code::usage, say<texts::alloc_one_thing>(given[0], given[1]),
                 say<texts::alloc_one_thing_hint>(), std::nullopt});
    return report;
  }
  if (options.list) {
    return list_allocations(context);
  }
  if (!options.forget.empty()) {
    return forget_units(options.forget, context);
  }
  if (!options.export_to.empty()) {
    return export_allocations(options.export_to, context);
  }
  if (!options.import_from.empty()) {
    return import_allocations(options.import_from, context);
  }
  return serve_allocations(options, context);
}

} // namespace

constinit const Command commands::alloc{
    .name = "alloc",
    .traits = {.session = true},
    .help = {"give node IDs to servos that ask for one",
             "ノード ID を要求するサーボにノード ID を割り当てる"},
    .options = option_table,
    .action = action<execute>,
};

} // namespace blactl::cli
