#pragma once
// What was measured on a real servo: a facts file ("schema":"blactl-facts/1").
//
//   {
//     "schema": "blactl-facts/1",
//     "behaviour": {"out_of_range": "clamp", "rom_write_time": "80ms"},
//     "about": {"model": "BLA21-12U-AB", "name": "jp.co.futaba.bla21", "software": "1.40"}
//   }
//
// "behaviour" has the members of Behaviour; what it leaves out is as likely as before. With
// `blactl sim --facts FILE` every servo behaves like that; what its scenario says stands above it,
// key by key. "about" tells people which servo it was (`blactl characterize` writes it); no servo
// goes by it. (schemas/facts.schema.json)

#include "blactl/base/error.hpp"
#include "blactl/sim/scenario/scenario.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace blactl::sim {

/// Errors: bad_file with file, line, JSON pointer and reason of every fault.
[[nodiscard]] Result<Behaviour> read_facts(const std::filesystem::path& file);
[[nodiscard]] Result<Behaviour> parse_facts(std::string_view text, std::string file);

} // namespace blactl::sim
