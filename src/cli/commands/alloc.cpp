// blactl alloc: dynamic node IDs, and their table.

#include "cli/alloc/actions.hpp"
#include "cli/alloc/options.hpp"
#include "cli/alloc/texts.hpp"
#include "cli/commands.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

constexpr std::array<std::string_view, 2> forgettable{"absent", "all"};

constexpr Option alloc_options[]{
    {.name = "--once",
     .kind = Kind::flag,
     .help = {"end when no unit asks any more", "割当て要求がなくなったら終了"},
     .store = into<&AllocOptions::once>},
    {.name = "--count",
     .value = "N",
     .kind = Kind::whole,
     .whole = {1, 125},
     .help = {"end when this many units have their node ID", "この台数の割当てが済んだら終了"},
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
     .help =
         {"take new node IDs from these (default 1-125, from the top); with --static: bring all "
          "into it, by serial number",
          "新規割当てに使う範囲 (省略時 1-125、大きい番号から)。--static "
          "使用時は製造番号順に範囲内へ移動"},
     .store = into<&AllocOptions::range>},
    {.name = "--assign",
     .value = "SELECTOR=ID",
     .kind = Kind::text,
     .repeat = Repeat::list,
     .help = {"this servo (uid:, serial:, servo:) gets this node ID from now on",
              "以後、このサーボ (uid:、serial:、servo:) にこのノード ID を割り当てる"},
     .store = into<&AllocOptions::assign>},
    {.name = "--static",
     .kind = Kind::flag,
     .help = {"make the node IDs of the servos behind -n permanent, or those that --id or --assign "
              "say (save, restart, proof)",
              "-n のサーボの現在のノード ID、または --id や --assign の ID を固定する "
              "(保存・再起動・確認)"},
     .store = into<&AllocOptions::makes_static>},
    {.name = "--id",
     .value = "ID",
     .kind = Kind::whole,
     .whole = {1, 125},
     .help = {"with --static and one servo: this node ID",
              "--static 使用時、1 台のサーボにこのノード ID を設定"},
     .store = into<&AllocOptions::id>},
    {.name = "--list",
     .kind = Kind::flag,
     .help = {"show the table, without a bus", "割当て表を表示 (バス不要)"},
     .store = into<&AllocOptions::list>},
    {.name = "--forget",
     .value = "WHO",
     .kind = Kind::suggested,
     .repeat = Repeat::list,
     .words = forgettable,
     .help = {"drop from the table: a servo (uid:, serial:, servo:), absent (all that are not on "
              "this bus), all",
              "割当て表から削除: サーボ (uid:、serial:、servo:)、absent "
              "(このバスにないもの)、all (全件)"},
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

/// The actions of the command; options without a common action exclude each other.
struct Does {
  enum : std::uint8_t { serve = 1, fix = 2, list = 4, forget = 8, write = 16, read = 32 };
};

struct Given {
  bool is_given;
  std::string_view option;
  unsigned does; ///< the actions it may be combined with
};

std::vector<Given> given(const AllocOptions& options, const Shared& shared) {
  std::vector<Given> all{{options.makes_static, "--static", Does::fix},
                         {options.id.has_value(), "--id", Does::fix},
                         {shared.nodes.has_value(), "--node", Does::fix},
                         {options.once, "--once", Does::serve},
                         {options.count.has_value(), "--count", Does::serve},
                         {!options.range.empty(), "--range", Does::serve | Does::fix},
                         {!options.assign.empty(), "--assign", Does::serve | Does::fix},
                         {options.list, "--list", Does::list},
                         {!options.forget.empty(), "--forget", Does::forget},
                         {!options.export_to.empty(), "--export", Does::write},
                         {!options.import_from.empty(), "--import", Does::read}};
  std::erase_if(all, [](const Given& each) { return !each.is_given; });
  return all;
}

/// Of what gives IDs to servos one is enough.
std::optional<Error> refuse_two_wishes(const AllocOptions& options, const Shared& shared) {
  std::vector<std::string_view> ways;
  if (options.id) {
    ways.emplace_back("--id");
  }
  if (!options.range.empty()) {
    ways.emplace_back("--range");
  }
  if (shared.nodes && !options.assign.empty()) {
    ways.emplace_back("--node");
  }
  if (!options.assign.empty()) {
    ways.emplace_back("--assign");
  }
  return ways.size() < 2
             ? std::nullopt
             : std::optional(Error{Code::usage, say<texts::alloc_one_thing>(ways[0], ways[1]),
                                   say<texts::alloc_one_thing_hint>(), std::nullopt});
}

std::optional<Error> refuse_together(const AllocOptions& options, const Shared& shared) {
  const auto all = given(options, shared);
  for (const Given& one : all) {
    for (const Given& other : all) {
      if ((one.does & other.does) == 0) {
        return Error{Code::usage, say<texts::alloc_one_thing>(one.option, other.option),
                     say<texts::alloc_one_thing_hint>(), std::nullopt};
      }
    }
    if (one.does == Does::fix && !options.makes_static) {
      return Error{Code::usage, say<texts::alloc_only_static>(one.option),
                   say<texts::alloc_only_static_hint>(), std::nullopt};
    }
  }
  return options.makes_static ? refuse_two_wishes(options, shared) : std::nullopt;
}

Report execute(const AllocOptions& options, Context& context) {
  if (auto refused = refuse_together(options, context.shared())) {
    Report report;
    report.fail(std::move(*refused));
    return report;
  }
  if (options.makes_static) {
    return make_static(options, context);
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
    .options = alloc_options,
    .action = action<AllocOptions, execute>,
};

} // namespace blactl::cli
