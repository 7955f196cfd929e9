#pragma once
// `models` as JSON (contract, section 5).

#include "blactl/base/json_writer.hpp"

#include "cli/output/data_sheet.hpp"

namespace blactl::cli {

/// models[], fault_bits[], firmware[], cross_checks[]: members of the document.
void write_models(JsonWriter& json, const Sheet& sheet, const bla::Profiles& profiles);

} // namespace blactl::cli
