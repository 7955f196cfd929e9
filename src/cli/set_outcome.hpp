#pragma once
// What a set did, or would do, and how it is shown.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/roster.hpp"
#include "blactl/fleet/write_job.hpp"

#include <string>
#include <vector>

namespace blactl::cli {

/// One servo and what is to be changed on it.
struct Plan {
  fleet::Member* member;
  std::vector<fleet::Change> changes;
};

struct Outcome {
  std::vector<Plan> plans;
};

// The views; `set` has no table of values, hence no CSV.
void write_json(JsonWriter& json, const Outcome& outcome);
[[nodiscard]] std::string text(const Outcome& outcome);

} // namespace blactl::cli
