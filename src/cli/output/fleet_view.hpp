#pragma once
// What servos hold against a fleet file, as JSON and text.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/files/fleet_diff.hpp"

#include "cli/output/page.hpp"

#include <span>
#include <string>

namespace blactl::cli {

/// Who it is, for people: an entry by its name, and where; a servo of no entry by what it says.
[[nodiscard]] std::string title(const std::string& name, const fleet::Servo& servo);

/// "nodes", with the keys of the contract, section 5, `diff apply`.
void write_json(JsonWriter& json, std::span<const fleet::EntryDiff> entries);

/// One of them.
void write_entry(JsonWriter& json, const fleet::EntryDiff& entry);

/// `one` and `other` are the heads of the two columns: "SERVO", "FILE". Registers that are alike
/// are counted only.
[[nodiscard]] std::string text(std::span<const fleet::EntryDiff> entries, const std::string& one,
                               const std::string& other, const Page& page);

} // namespace blactl::cli
