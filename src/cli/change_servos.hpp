#pragma once
// The way of every command that changes servos: what is wanted, refusals, one question, carrying
// out, results.

#include "blactl/fleet/plan.hpp"

#include "cli/context.hpp"
#include "cli/options.hpp"
#include "cli/output/report.hpp"
#include "cli/output/result_view.hpp"

#include <string_view>

namespace blactl::cli {

struct ChangeRequest {
  std::string_view command; ///< its name
  fleet::Wanted wanted{};
  RestartTimes times{};
  bool dry_run = false;
  ResultView view = ResultView::servos;
};

/// Changes the servos behind -n. If one of them refuses, none is written.
[[nodiscard]] Report change_servos(const ChangeRequest& request, Context& context);

} // namespace blactl::cli
