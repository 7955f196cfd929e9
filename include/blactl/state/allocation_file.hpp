#pragma once
// The allocation table as a file to keep or to move to another machine.
//
//   {
//     "schema": "blactl-allocations/1",
//     "entries": [
//       {"unique_id": "c300b6d5402b1ae9…", "node_id": 125, "time": "2026-11-21T08:15:00Z"}
//     ]
//   }
//
// (schemas/allocations.schema.json)

#include "blactl/base/error.hpp"
#include "blactl/base/json_writer.hpp"
#include "blactl/state/allocation_store.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace blactl::state {

/// The member "entries" of a document, by node ID.
void write_entries(JsonWriter& json, std::span<const AllocationEntry> entries);

/// The whole file.
[[nodiscard]] std::string allocation_file(std::span<const AllocationEntry> entries);

/// The node IDs for units, in the order of the file; "-" reads stdin. Its times are ignored.
/// Errors: bad_file with file, line, JSON pointer and reason of every fault, including duplicate
/// units and IDs.
[[nodiscard]] Result<std::vector<AllocationStore::Wish>>
read_allocation_file(const std::filesystem::path& file);

} // namespace blactl::state
