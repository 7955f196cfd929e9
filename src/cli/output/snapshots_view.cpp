#include "cli/output/snapshots_view.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/base/rfc3339.hpp"
#include "blactl/base/text.hpp"
#include "blactl/fleet/change/undo.hpp"

#include "cli/change/texts.hpp"
#include "cli/output/table.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace blactl::cli {

namespace {

std::string memory_of(const state::SnapshotEntry& entry) {
  if (!entry.saved) {
    return say<texts::undo_in_ram>();
  }
  return entry.settled ? say<texts::undo_in_rom>() : say<texts::undo_perhaps_in_rom>();
}

std::string name_of(std::uint8_t address, const bla::Profiles& profiles) {
  const bla::Parameter* parameter = profiles.find(bla::Address(address));
  return parameter != nullptr ? parameter->name : bla::Address(address).name();
}

/// Empty: not named, as by erase.
std::optional<std::int64_t> written_by(const state::SnapshotEntry& entry, std::uint8_t address) {
  const auto written = entry.written.find(address);
  return written != entry.written.end() ? std::optional(written->second) : std::nullopt;
}

/// "angle_limit_cw 179.9 deg -> 90.0 deg"
std::string setting_of(const state::SnapshotEntry& entry, std::uint8_t address, std::int64_t raw,
                       const bla::Profiles& profiles) {
  const auto shown = [&](std::int64_t value) {
    return fleet::displayed(entry, bla::Address(address), value, profiles);
  };
  const std::string name = name_of(address, profiles);
  const auto written = written_by(entry, address);
  return written ? say<texts::undo_replaced>(name, shown(raw), shown(*written))
                 : say<texts::undo_was>(name, shown(raw));
}

/// The first few that the command has replaced.
std::string settings_of(const state::SnapshotEntry& entry, const bla::Profiles& profiles) {
  constexpr std::size_t few = 4;
  std::string named;
  std::size_t count = 0;
  for (const auto& [address, raw] : entry.held) {
    if (count++ < few) {
      named += (named.empty() ? "" : ", ") + setting_of(entry, address, raw, profiles);
    }
  }
  return count > few ? say<texts::undo_more_settings>(named, count - few) : named;
}

Table table(std::span<const state::SnapshotEntry> entries, const bla::Profiles& profiles,
            std::size_t unique_id_digits) {
  Table table({say<texts::undo_column_number>(), say<texts::undo_column_time>(),
               say<texts::undo_column_unit>(), say<texts::undo_column_command>(),
               say<texts::undo_column_saved>()});
  for (const state::SnapshotEntry& entry : entries) {
    table.add({std::to_string(entry.run), rfc3339(entry.at),
               hex(entry.unique_id).substr(0, unique_id_digits), printable(entry.command),
               memory_of(entry)});
    table.add_below(settings_of(entry, profiles));
  }
  return table;
}

} // namespace

void write_snapshots(JsonWriter& json, std::span<const state::SnapshotEntry> entries,
                     const bla::Profiles& profiles) {
  json.objects("snapshots", entries, [&](const state::SnapshotEntry& entry) {
    json.member("number", entry.run);
    json.member("time", rfc3339(entry.at));
    json.member("unique_id", hex(entry.unique_id));
    json.member("command", printable(entry.command));
    json.member("changed_count", entry.held.size());
    json.objects("changes", entry.held, [&](const auto& held) {
      const auto& [address, raw] = held;
      json.member("address", bla::Address(address).name());
      json.member("name", name_of(address, profiles));
      json.member("before", raw);
      json.member("after", written_by(entry, address));
    });
    const bool is_known = !entry.saved || entry.settled;
    json.member("saved", is_known ? std::optional(entry.saved) : std::nullopt);
  });
}

std::string text(std::span<const state::SnapshotEntry> entries, const bla::Profiles& profiles,
                 const Page& page) {
  if (entries.empty()) {
    return say<texts::undo_nothing_recorded>();
  }
  constexpr std::size_t all_digits = 2 * dronecan::UniqueId().size(), enough_digits = 8;
  const Table whole = table(entries, profiles, all_digits);
  return whole.fits("", page) ? whole.text("", page)
                              : table(entries, profiles, enough_digits).text("", page);
}

} // namespace blactl::cli
