#include "cli/output/snapshots_view.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/base/rfc3339.hpp"
#include "blactl/base/text.hpp"

#include "cli/change/texts.hpp"
#include "cli/output/table.hpp"

namespace blactl::cli {

namespace {

std::string memory_of(const state::SnapshotEntry& entry) {
  if (!entry.saved) {
    return say<texts::undo_in_ram>();
  }
  return entry.settled ? say<texts::undo_in_rom>() : say<texts::undo_perhaps_in_rom>();
}

/// The first few, by name.
std::string settings_of(const state::SnapshotEntry& entry, const bla::Profiles& profiles) {
  constexpr std::size_t few = 2;
  std::string named;
  std::size_t count = 0;
  for (const auto& [address, raw] : entry.held) {
    if (count++ < few) {
      const bla::Parameter* parameter = profiles.find(bla::Address(address));
      named += named.empty() ? "" : ", ";
      named += parameter != nullptr ? std::string(parameter->name) : bla::Address(address).name();
    }
  }
  return count > few ? say<texts::undo_more_settings>(named, count - few) : named;
}

} // namespace

void write_snapshots(JsonWriter& json, std::span<const state::SnapshotEntry> entries) {
  json.objects("snapshots", entries, [&](const state::SnapshotEntry& entry) {
    json.member("number", entry.run);
    json.member("time", rfc3339(entry.at));
    json.member("unique_id", hex(entry.unique_id));
    json.member("command", printable(entry.command));
    json.member("changed_count", entry.held.size());
  });
}

std::string text(std::span<const state::SnapshotEntry> entries, const bla::Profiles& profiles,
                 const Page& page) {
  if (entries.empty()) {
    return say<texts::undo_nothing_recorded>();
  }
  Table table({say<texts::undo_column_number>(), say<texts::undo_column_time>(),
               say<texts::undo_column_unit>(), say<texts::undo_column_command>(),
               say<texts::undo_column_saved>(), say<texts::undo_column_settings>()});
  for (const state::SnapshotEntry& entry : entries) {
    table.add({std::to_string(entry.run), rfc3339(entry.at), hex(entry.unique_id),
               printable(entry.command), memory_of(entry), settings_of(entry, profiles)});
  }
  return table.text("", page);
}

} // namespace blactl::cli
