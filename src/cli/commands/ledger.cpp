// blactl ledger: the records of a production line.

#include "blactl/base/rfc3339.hpp"
#include "blactl/can/loop.hpp"
#include "blactl/fleet/line/scrap.hpp"
#include "blactl/state/ledger_store.hpp"

#include "cli/commands.hpp"
#include "cli/confirm.hpp"
#include "cli/context.hpp"
#include "cli/line/line_stores.hpp"
#include "cli/line/record_view.hpp"
#include "cli/line/station_name.hpp"
#include "cli/line/texts.hpp"
#include "cli/stores.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

using state::LedgerRecord;
using state::LedgerStore;

constexpr std::array<std::string_view, 5> verdicts{"pass", "fail", "error", "skip", "scrap"};

struct LedgerOptions {
  std::string since{}, until{};
  std::optional<std::uint64_t> serial{};
  std::optional<std::uint8_t> verdict{};
  std::string work_order{}, station{};
  std::string scrap{}, reason{};
  bool check = false;
  std::string backup{};
};

constexpr Option ledger_options[]{
    {.name = "--since",
     .value = "TIME",
     .kind = Kind::text,
     .help = {"records that ended at this time or later (RFC 3339)",
              "この日時以降の記録 (RFC 3339)"},
     .store = into<&LedgerOptions::since>},
    {.name = "--until",
     .value = "TIME",
     .kind = Kind::text,
     .help = {"records that ended before this time", "この日時より前の記録"},
     .store = into<&LedgerOptions::until>},
    {.name = "--serial",
     .value = "N",
     .kind = Kind::whole,
     .whole = {0, 0xFFFFFFFF},
     .help = {"records of this serial number", "この製造番号の記録"},
     .store = into<&LedgerOptions::serial>},
    {.name = "--verdict",
     .value = "VERDICT",
     .kind = Kind::word,
     .words = verdicts,
     .help = {"records with this verdict", "この判定の記録"},
     .store = into<&LedgerOptions::verdict>},
    {.name = "--work-order",
     .value = "NAME",
     .kind = Kind::text,
     .help = {"records of this work order", "この作業指示番号の記録"},
     .store = into<&LedgerOptions::work_order>},
    {.name = "--station",
     .value = "NAME",
     .kind = Kind::text,
     .help = {"records of this station; with --scrap: whose record it is",
              "このステーションの記録 (--scrap 使用時: 記録するステーション名)"},
     .store = into<&LedgerOptions::station>},
    {.name = "--scrap",
     .value = "RECORD",
     .kind = Kind::text,
     .help = {"take the servo of this record_id out, and free its IDs",
              "この record_id のサーボを廃棄扱いとし、ID を解放"},
     .store = into<&LedgerOptions::scrap>},
    {.name = "--reason",
     .value = "TEXT",
     .kind = Kind::text,
     .help = {"with --scrap: why", "--scrap の理由"},
     .store = into<&LedgerOptions::reason>},
    {.name = "--check",
     .kind = Kind::flag,
     .help = {"look for damage, missing records, and work that has not ended",
              "破損・欠落・未完了の処理を確認"},
     .store = into<&LedgerOptions::check>},
    {.name = "--backup",
     .value = "FILE",
     .kind = Kind::file,
     .help = {"copy the ledger into a new file, and the IDs that were given into FILE.counters",
              "製造記録を新しいファイルに、採番表を FILE.counters にコピー"},
     .store = into<&LedgerOptions::backup>},
};

Result<std::optional<WallTime>> time_of(std::string_view option, const std::string& text) {
  if (text.empty()) {
    return std::optional<WallTime>();
  }
  const auto time = parse_rfc3339(text);
  return time ? Result<std::optional<WallTime>>(*time)
              : fail(Code::usage, say<texts::ledger_no_time>(option, printable(text)),
                     say<texts::ledger_no_time_hint>());
}

Result<state::LedgerQuery> query_of(const LedgerOptions& options) {
  const auto since = time_of("--since", options.since);
  const auto until = since ? time_of("--until", options.until) : since;
  if (!until) {
    return std::unexpected(until.error());
  }
  state::LedgerQuery query{.since = *since,
                           .until = *until,
                           .work_order = unless_empty(options.work_order),
                           .station = unless_empty(options.station)};
  if (options.serial) {
    query.serial_number = static_cast<std::int64_t>(*options.serial);
  }
  if (options.verdict) {
    query.verdict = std::string(verdicts.at(*options.verdict));
  }
  return query;
}

/// What excludes each other.
std::optional<Error> check_options(const LedgerOptions& options) {
  const bool filters = !options.since.empty() || !options.until.empty() || options.serial ||
                       options.verdict || !options.work_order.empty();
  const bool scraps = !options.scrap.empty() || !options.reason.empty();
  const int actions = (scraps ? 1 : 0) + (options.check ? 1 : 0) + (options.backup.empty() ? 0 : 1);
  if (actions > 1 || (actions == 1 && filters) ||
      (actions == 1 && !scraps && !options.station.empty())) {
    const std::string_view option = scraps ? "--scrap" : options.check ? "--check" : "--backup";
    return Error{Code::usage,
                 say<texts::ledger_alone>(option, scraps ? "--reason, --station" : "-i"),
                 say<texts::ledger_alone_hint>(), std::nullopt};
  }
  if (scraps && (options.reason.empty() || options.scrap.empty())) {
    return Error{Code::usage, say<texts::ledger_scrap_reason>(),
                 say<texts::provision_redo_reason_hint>(), std::nullopt};
  }
  return std::nullopt;
}

Report list(const LedgerOptions& options, const LedgerStore& store, const Context& context) {
  Report report{.is_stream = true};
  const auto query = query_of(options);
  if (!query) {
    report.fail(query.error());
    return report;
  }
  const Reporter& reporter = context.reporter();
  auto printed = reporter.stream(records_header(reporter.format()));
  std::uint64_t count = 0;
  const auto read = store.each(*query, [&](const LedgerRecord& record) {
    printed = printed && *printed
                  ? reporter.stream(record_line(record, reporter.format(), reporter.page()))
                  : printed;
    count += printed && *printed ? 1U : 0U;
    return printed && *printed;
  });
  if (!read || !printed) {
    report.fail(read ? printed.error() : read.error());
  }
  report.counts = {{"records", count}};
  return report;
}

Report failed(Error error) {
  Report report;
  report.fail(std::move(error));
  return report;
}

std::string name_of(const LedgerRecord& record) {
  return record.serial_number ? std::to_string(*record.serial_number)
                              : record.unique_id.value_or(say<texts::ledger_unknown_unit>());
}

void write_begun(JsonWriter& json, const LedgerRecord& record) {
  json.member("record_id", record.record_id);
  json.member("start_time", record.start_time);
  json.member("serial_number", record.serial_number);
  json.member("unique_id", record.unique_id);
  json.member("recipe", record.recipe);
  json.member("station", record.station);
}

/// Whether both files are there and whole.
Result<void> check_files(const LedgerStore& store, std::string_view interface) {
  const auto counters = open_counters(interface, state::Access::read);
  const auto complete =
      counters ? check_line_stores(store, *counters, interface) : std::unexpected(counters.error());
  return complete ? counters->check() : complete;
}

Report check(const LedgerStore& store, std::string_view interface) {
  if (const auto checked = check_files(store, interface); !checked) {
    return failed(checked.error());
  }
  const auto holes = store.holes();
  const auto begun =
      holes ? store.begun() : Result<std::vector<LedgerRecord>>(std::unexpected(holes.error()));
  if (!begun) {
    return failed(begun.error());
  }

  struct Found {
    std::vector<state::LedgerHole> holes;
    std::vector<LedgerRecord> begun;
  };

  const auto found = std::make_shared<Found>(Found{*holes, *begun});
  Report report;
  if (!found->holes.empty() || !found->begun.empty()) {
    report.targets.push_back({.has_found = true});
  }
  report.counts = {{"holes", found->holes.size()}, {"begun", found->begun.size()}};
  report.json = [found](JsonWriter& json) {
    json.objects("holes", found->holes, [&](const state::LedgerHole& hole) {
      json.member("station", hole.station);
      json.member("first", hole.first);
      json.member("last", hole.last);
    });
    json.objects("begun", found->begun,
                 [&](const LedgerRecord& record) { write_begun(json, record); });
  };
  report.text = [found](const Page&) {
    std::string text;
    for (const state::LedgerHole& hole : found->holes) {
      text += say<texts::ledger_hole>(printable(hole.station), hole.first, hole.last);
    }
    for (const LedgerRecord& record : found->begun) {
      text += say<texts::ledger_begun>(printable(record.station.value_or("")), name_of(record),
                                       record.start_time.value_or(""));
    }
    return text.empty() ? say<texts::ledger_whole>() : text;
  };
  return report;
}

Report scrap(const LedgerOptions& options, LedgerStore& store, Context& context) {
  const auto meant = fleet::record_to_scrap(store, options.scrap);
  if (!meant) {
    return failed(meant.error());
  }
  const auto agreed = confirm(
      say<texts::ledger_scrap_question>(name_of(*meant), printable(meant->recipe.value_or(""))),
      context);
  auto counters = agreed ? open_counters(context.shared().interface, state::Access::write)
                         : Result<state::CounterStore>(std::unexpected(agreed.error()));
  if (!counters) {
    return failed(counters.error());
  }
  const can::Loop clock(nullptr);
  const auto record = fleet::scrap(store, *counters, *meant, record_of_station(options.station),
                                   options.reason, clock.wall());
  if (!record) {
    return failed(record.error());
  }
  Report report{.is_stream = true};
  const Reporter& reporter = context.reporter();
  const auto printed = reporter.stream(records_header(reporter.format()) +
                                       record_line(*record, reporter.format(), reporter.page()));
  if (!printed) {
    report.fail(printed.error());
  }
  report.counts = {{"records", 1}};
  return report;
}

/// The IDs that were given belong to the records, and are copied second: a unit whose record is
/// copied has its IDs in the copy.
Report back_up(const LedgerOptions& options, const LedgerStore& store, const Context& context) {
  const std::string ids = options.backup + ".counters";
  for (const std::string& file : {options.backup, ids}) {
    std::error_code error;
    if (options.backup == "-" || std::filesystem::exists(file, error)) {
      return failed({Code::usage, say<texts::ledger_copy_exists>(printable(file)),
                     say<texts::ledger_copy_exists_hint>(), std::nullopt});
    }
  }
  const auto counters = open_counters(context.shared().interface, state::Access::read);
  auto copied =
      counters ? store.back_up(options.backup) : Result<void>(std::unexpected(counters.error()));
  if (copied) {
    copied = counters->back_up(ids);
    if (!copied) { // no half of a copy stands in the way of the next one
      std::error_code ignored;
      std::filesystem::remove(options.backup, ignored);
    }
  }
  if (!copied) {
    return failed(copied.error());
  }
  context.reporter().note(say<texts::ledger_copied>(printable(options.backup), printable(ids)));
  return {};
}

Report execute(const LedgerOptions& options, Context& context) {
  if (auto refused = check_options(options)) {
    return failed(std::move(*refused));
  }
  const auto access = options.scrap.empty() ? state::Access::read : state::Access::write;
  auto store = open_ledger(context.shared().interface, access);
  if (!store) {
    return failed(store.error());
  }
  return !options.scrap.empty()    ? scrap(options, *store, context)
         : options.check           ? check(*store, context.shared().interface)
         : !options.backup.empty() ? back_up(options, *store, context)
                                   : list(options, *store, context);
}

} // namespace

constinit const Command commands::ledger{
    .name = "ledger",
    .traits = {.streams = true, .tables = true},
    .help = {"the records of a production line", "製造ラインの記録"},
    .options = ledger_options,
    .action = action<LedgerOptions, execute>,
};

} // namespace blactl::cli
