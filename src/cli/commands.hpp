#pragma once
// The commands: one function each, from options to a report. They print nothing but through the
// reporter, ask nothing without it, and never exit.

#include "cli/context.hpp"
#include "cli/options.hpp"
#include "cli/output/report.hpp"

namespace blactl::cli {

[[nodiscard]] Report execute(const ScanOptions& options, Context& context);
[[nodiscard]] Report execute(const GetOptions& options, Context& context);
[[nodiscard]] Report execute(const SetOptions& options, Context& context);
[[nodiscard]] Report execute(const SaveOptions& options, Context& context);
[[nodiscard]] Report execute(const EraseOptions& options, Context& context);
[[nodiscard]] Report execute(const RestartOptions& options, Context& context);
[[nodiscard]] Report execute(const WaitOptions& options, Context& context);
[[nodiscard]] Report execute(const TraceOptions& options, Context& context);
[[nodiscard]] Report execute(const ModelsOptions& options, Context& context);
[[nodiscard]] Report execute(const SimOptions& options, Context& context);

} // namespace blactl::cli
