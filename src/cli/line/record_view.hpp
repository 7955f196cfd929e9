#pragma once
// Records of a production line as they are printed (contract, section 5, "provision", "ledger").

#include "blactl/base/error.hpp"
#include "blactl/state/ledger_record.hpp"

#include "cli/output/page.hpp"
#include "cli/output/reporter.hpp"

#include <optional>
#include <string>

namespace blactl::cli {

/// One line, or what comes before all lines, in this format. `reason`: why it is no pass, for
/// people.
[[nodiscard]] std::string record_line(const state::LedgerRecord& record, Format format,
                                      const Page& page,
                                      const std::optional<Error>& reason = std::nullopt);
[[nodiscard]] std::string records_header(Format format);

} // namespace blactl::cli
