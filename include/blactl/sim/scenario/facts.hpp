#pragma once
// Facts: the behaviour measured on a real servo, as a file ("schema":"blactl-facts/1").
//
//   {
//     "schema": "blactl-facts/1",
//     "behaviour": {"out_of_range": "clamp", "rom_write_time": "80ms"},
//     "about": {"model": "BLA21-12U-AB", "name": "jp.co.futaba.bla21", "software": "1.40"}
//   }
//
// "behaviour" has the members of Behaviour; members left out keep their defaults. With `blactl sim
// --facts FILE` they become the defaults of every servo; the keys of its scenario override them one
// by one. "about" records for people which servo was measured (`blactl characterize` writes it);
// the simulator does not use it. (schemas/facts.schema.json)

#include "blactl/base/error.hpp"
#include "blactl/sim/servo/behaviour.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace blactl::sim {

/// Errors: bad_file with file, line, JSON pointer and reason for each error.
[[nodiscard]] Result<Behaviour> read_facts(const std::filesystem::path& file);
[[nodiscard]] Result<Behaviour> parse_facts(std::string_view text, std::string file);

} // namespace blactl::sim
