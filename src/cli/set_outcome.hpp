#pragma once
// What a set did, or would do, and how it is shown.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/roster.hpp"
#include "blactl/fleet/write_job.hpp"

#include "cli/lifecycle.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace blactl::cli {

/// One servo and what is to be changed on it.
struct Plan {
  fleet::Member* member;
  std::vector<fleet::Change> changes;
  /// 0x37 before and after, which the unit of 0x36 hangs on; empty where it was not read.
  std::optional<std::int64_t> mode_before{}, mode_after{};
  std::vector<const bla::Parameter*> configuration{}; ///< with --save: what will be saved
  bool saved = false; ///< ROM was written, and the servo is back with these values
  std::optional<Error> save_error{};
};

struct Outcome {
  std::vector<Plan> plans;
  std::vector<Passage> saves; ///< with --save: through the restart
};

// The views; `set` has no table of values, hence no CSV.
void write_json(JsonWriter& json, const Outcome& outcome);
[[nodiscard]] std::string text(const Outcome& outcome);

} // namespace blactl::cli
