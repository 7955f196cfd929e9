#pragma once
// The differences between servos and a fleet file, as JSON and text.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/files/fleet_diff.hpp"

#include "cli/output/page.hpp"

#include <span>
#include <string>

namespace blactl::cli {

/// The heading for people: the name of an entry and its node ID; for a servo without an entry its
/// identification.
[[nodiscard]] std::string title(const std::string& name, const fleet::Servo& servo);

/// "nodes", with the keys of the contract, section 5, `diff apply`.
void write_json(JsonWriter& json, std::span<const fleet::EntryDiff> entries);

void write_entry(JsonWriter& json, const fleet::EntryDiff& entry);

/// `one` and `other` are the headings of the two columns: "SERVO", "FILE". Equal registers are only
/// counted.
[[nodiscard]] std::string text(std::span<const fleet::EntryDiff> entries, const std::string& one,
                               const std::string& other, const Page& page);

} // namespace blactl::cli
