#include "blactl/state/allocation_file.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/base/json_reader.hpp"
#include "blactl/base/rfc3339.hpp"

#include "state/texts.hpp"

#include <algorithm>
#include <string_view>

namespace blactl::state {

using dronecan::NodeId;
using dronecan::UniqueId;

namespace {

constexpr std::string_view file_schema = "blactl-allocations/1";

using Wish = AllocationStore::Wish;

Wish read_entry(const json::Value& value, const std::vector<Wish>& before, json::Faults& faults) {
  json::Object object(value, faults);
  const auto unique_id = from_hex<std::tuple_size_v<UniqueId>>(object.string("unique_id"));
  const auto node_id = object.integer("node_id", first_dynamic_id.value(), last_dynamic_id.value());
  const json::Value* time = object.optional_any("time");
  object.finish();
  const Wish wish{unique_id.value_or(UniqueId{}), NodeId(static_cast<std::uint8_t>(node_id))};
  const auto written = time != nullptr ? json::as_string(*time, faults) : std::nullopt;
  if (written && !parse_rfc3339(*written)) {
    faults.add(*time, say<texts::no_time>());
  }
  if (object.exists() && object.has("unique_id") && wish.unique_id == UniqueId{}) {
    faults.add(value, say<texts::no_unique_id>());
  }
  if (unique_id && std::ranges::find(before, *unique_id, &Wish::unique_id) != before.end()) {
    faults.add(value, say<texts::unit_twice>());
  }
  if (node_id != 0 && std::ranges::find(before, wish.node_id, &Wish::node_id) != before.end()) {
    faults.add(value, say<texts::node_id_twice>());
  }
  return wish;
}

} // namespace

void write_entries(JsonWriter& json, std::span<const AllocationEntry> entries) {
  json.key("entries");
  json.begin_array();
  for (const AllocationEntry& entry : entries) {
    json.begin_object();
    json.member("unique_id", hex(entry.unique_id));
    json.member("node_id", entry.node_id.value());
    json.member("time", rfc3339(entry.at));
    json.end_object();
  }
  json.end_array();
}

std::string allocation_file(std::span<const AllocationEntry> entries) {
  std::string text;
  JsonWriter json(text, JsonWriter::Layout::pretty);
  json.begin_object();
  json.member("schema", file_schema);
  write_entries(json, entries);
  json.end_object();
  return text + '\n';
}

Result<std::vector<Wish>> read_allocation_file(const std::filesystem::path& file) {
  auto document = json::parse_file(file);
  if (!document) {
    return std::unexpected(document.error());
  }
  json::Faults& faults = document->faults();
  json::Object root(document->root(), faults);
  (void)root.optional_string("$schema"); // for editors
  (void)root.word("schema", {file_schema});
  std::vector<Wish> wishes;
  for (const json::Value* item : root.array("entries")) {
    wishes.push_back(read_entry(*item, wishes, faults));
  }
  root.finish();
  if (const auto fine = faults.result(); !fine) {
    return std::unexpected(fine.error());
  }
  return wishes;
}

} // namespace blactl::state
