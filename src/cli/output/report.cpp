#include "cli/output/report.hpp"

#include <signal.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace blactl::cli {
namespace {

constexpr int interface_failed = 3;
constexpr int mixed = 6;
constexpr int found_something = 8;

bool is_failure(int status) {
  return status != 0 && status != found_something;
}

int status_of(const Target& target) {
  if (!target.errors.empty()) {
    return exit_status(target.errors.front().code);
  }
  return target.has_found ? found_something : 0;
}

std::vector<int> statuses_of(const std::vector<Error>& errors) {
  std::vector<int> statuses;
  std::ranges::transform(errors, std::back_inserter(statuses),
                         [](const Error& error) { return exit_status(error.code); });
  return statuses;
}

bool has(const std::vector<int>& statuses, int status) {
  return std::ranges::find(statuses, status) != statuses.end();
}

} // namespace

void Report::count_targets(std::optional<std::size_t> all) {
  const auto failed = static_cast<std::uint64_t>(
      std::ranges::count_if(targets, [](const Target& target) { return !target.errors.empty(); }));
  std::erase_if(
      counts, [](const auto& count) { return count.first == "nodes" || count.first == "failed"; });
  const std::uint64_t nodes = all.value_or(targets.size());
  counts.insert(counts.begin(), {{"nodes", nodes}, {"failed", failed}});
}

std::vector<Error> Report::all_errors() const {
  std::vector<Error> all = errors;
  for (const Target& target : targets) {
    all.insert(all.end(), target.errors.begin(), target.errors.end());
  }
  return all;
}

int Report::exit_status() const {
  if (signal != 0) {
    return 128 + signal;
  }
  if (has(statuses_of(all_errors()), interface_failed)) {
    return interface_failed;
  }
  const std::vector<int> of_command = statuses_of(errors);
  if (const auto failure = std::ranges::find_if(of_command, is_failure);
      failure != of_command.end()) {
    return *failure;
  }
  std::vector<int> of_targets;
  std::ranges::transform(targets, std::back_inserter(of_targets), status_of);
  if (std::ranges::any_of(of_targets, is_failure)) {
    const bool alike = std::ranges::count(of_targets, of_targets.front()) == std::ssize(of_targets);
    return alike ? of_targets.front() : mixed;
  }
  return has(of_targets, found_something) || has(of_command, found_something) ? found_something : 0;
}

} // namespace blactl::cli
