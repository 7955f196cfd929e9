#pragma once
// The way of every command that changes servos: what is wanted, refusals, one question, carrying
// out, results.

#include "blactl/fleet/change/plan.hpp"

#include "cli/context.hpp"
#include "cli/options.hpp"
#include "cli/output/report.hpp"
#include "cli/output/result_view.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace blactl::cli {

struct ChangeRequest {
  std::string_view command; ///< its name
  fleet::Wanted wanted{};
  RestartTimes times{};
  bool dry_run = false;
  std::function<std::optional<Error>(std::size_t servos)> refuse{}; ///< by how many are meant
  ResultView view = ResultView::servos;
  /// In place of the view, where a command has its own way to show what became of single registers.
  std::function<void(JsonWriter&, std::span<const fleet::ChangeResult>)> json{};
  std::function<std::string(std::span<const fleet::ChangeResult>, const Page&)> text{};
  /// Gets the results too, before they are told.
  std::function<void(std::span<const fleet::ChangeResult>)> results{};
};

/// Changes the servos behind -n. If one of them refuses, none is written.
[[nodiscard]] Report change_servos(const ChangeRequest& request, Context& context);

} // namespace blactl::cli
