#include "blactl/base/hex.hpp"
#include "blactl/base/replace_file.hpp"
#include "blactl/base/rfc3339.hpp"
#include "blactl/can/loop.hpp"
#include "blactl/state/allocation_file.hpp"

#include "cli/alloc/actions.hpp"
#include "cli/alloc/texts.hpp"
#include "cli/log_target.hpp"
#include "cli/output/table.hpp"
#include "cli/stores.hpp"
#include "cli/texts.hpp"

#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

namespace blactl::cli {

using state::AllocationEntry;
using state::AllocationStore;

namespace {

using Entries = std::vector<AllocationEntry>;

Report failed(Error error) {
  Report report;
  report.fail(std::move(error));
  return report;
}

Result<Entries> entries_of(Context& context) {
  const auto store = open_allocations(context.shared().interface, AllocationStore::Access::read);
  return store ? store->entries() : std::unexpected(store.error());
}

std::string text(const Entries& entries, const Page& page) {
  if (entries.empty()) {
    return say<texts::alloc_table_empty>();
  }
  Table table({say<texts::alloc_column_node>(), say<texts::alloc_column_unit>(),
               say<texts::alloc_column_since>()});
  for (const AllocationEntry& entry : entries) {
    table.add({std::to_string(entry.node_id.value()), hex(entry.unique_id), rfc3339(entry.at)});
  }
  return table.text("", page);
}

/// A file that is there is replaced only by its like: a name is typed faster than looked at.
Result<void> check_target(const std::string& file) {
  if (auto apart = check_no_state(file, "--export"); !apart) {
    return apart;
  }
  std::error_code unseen; // what cannot be examined cannot be replaced either
  const bool has_content = std::filesystem::is_regular_file(file, unseen) &&
                           std::filesystem::file_size(file, unseen) > 0;
  return has_content && !state::read_allocation_file(file)
             ? fail(Code::usage, say<texts::alloc_export_over_other>(printable(file)),
                    say<texts::log_over_other_hint>())
             : Result<void>();
}

/// The report of an operation on a file.
Report done_with(const std::string& file, std::string text) {
  Report report;
  report.json = [file](JsonWriter& json) {
    json.member("file", file);
    json.member("status", "done");
  };
  report.text = [text = std::move(text)](const Page& /*page*/) { return text; };
  return report;
}

} // namespace

Report list_allocations(Context& context) {
  auto entries = entries_of(context);
  if (!entries) {
    return failed(std::move(entries.error()));
  }
  Report report;
  const auto kept = std::make_shared<Entries>(std::move(*entries));
  report.counts = {{"entries", kept->size()}};
  report.json = [kept](JsonWriter& json) { state::write_entries(json, *kept); };
  report.text = [kept](const Page& page) { return text(*kept, page); };
  return report;
}

Report export_allocations(const std::string& file, Context& context) {
  const auto entries = entries_of(context);
  if (!entries) {
    return failed(entries.error());
  }
  std::string content = state::allocation_file(*entries);
  if (file == "-" && context.reporter().format() == Format::json) {
    return failed({Code::usage, say<texts::alloc_export_json_needs_file>(),
                   say<texts::alloc_export_json_needs_file_hint>(), std::nullopt});
  }
  if (file == "-") {
    return done_with(file, std::move(content));
  }
  auto written = check_target(file);
  if (written) {
    written = replace_file(file, content);
  }
  if (!written) {
    return failed(std::move(written.error()));
  }
  return done_with(file, say<texts::alloc_exported>(entries->size(), printable(file)));
}

Report import_allocations(const std::string& file, Context& context) {
  const auto wishes = state::read_allocation_file(file);
  if (!wishes) {
    return failed(wishes.error());
  }
  auto store = open_allocations(context.shared().interface, AllocationStore::Access::write);
  if (!store) {
    return failed(std::move(store.error()));
  }
  const can::Loop clock(nullptr);
  if (auto put = store->enter(*wishes, clock.wall()); !put) {
    return failed(std::move(put.error()));
  }
  return done_with(file, say<texts::alloc_imported>(wishes->size(), printable(file)));
}

} // namespace blactl::cli
