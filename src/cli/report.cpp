#include "report.hpp"

#include <signal.h>

#include <algorithm>

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
  std::vector<int> all = statuses;
  for (const Error& error : errors) {
    const int status = blactl::exit_status(error.code);
    if (status == interface_failed) {
      return interface_failed;
    }
    if (statuses.empty()) {
      all.push_back(status);
    }
  }
  if (all.empty()) {
    return 0;
  }
  if (!std::ranges::any_of(all, is_failure)) {
    return std::ranges::max(all);
  }
  const bool same = std::ranges::all_of(all, [&](int status) { return status == all.front(); });
  return same || statuses.empty() ? all.front() : mixed;
}

} // namespace blactl::cli
