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

} // namespace

int Report::exit_status() const {
  if (signal != 0) {
    return 128 + signal;
  }
  std::vector<int> of_errors;
  std::ranges::transform(errors, std::back_inserter(of_errors),
                         [](const Error& error) { return blactl::exit_status(error.code); });
  const auto has = [](const std::vector<int>& all, int status) {
    return std::ranges::find(all, status) != all.end();
  };
  if (has(statuses, interface_failed) || has(of_errors, interface_failed)) {
    return interface_failed;
  }
  if (std::ranges::any_of(statuses, is_failure)) {
    const bool alike = std::ranges::count(statuses, statuses.front()) == std::ssize(statuses);
    return alike ? statuses.front() : mixed;
  }
  // No servo failed: what went wrong concerns the command as a whole.
  if (const auto failure = std::ranges::find_if(of_errors, is_failure);
      failure != of_errors.end()) {
    return *failure;
  }
  return has(statuses, found_something) || has(of_errors, found_something) ? found_something : 0;
}

} // namespace blactl::cli
