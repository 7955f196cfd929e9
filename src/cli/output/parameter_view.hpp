#pragma once
// Parameters of servos as JSON, CSV and text.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/bus/snapshot.hpp"

#include "cli/output/page.hpp"

#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// What is shown of one servo: readings without errors.
struct ServoValues {
  fleet::Snapshot snapshot;
  std::vector<fleet::Reading> shown;
  bool is_complete = true; ///< all that was asked for was read
  bool can_differ = true;  ///< some of what was read has a default
};

void write_json(JsonWriter& json, std::span<const ServoValues> servos);
[[nodiscard]] std::string csv(std::span<const ServoValues> servos);
/// `changed_only`: of what was read, a servo without values has nothing but defaults.
[[nodiscard]] std::string text(std::span<const ServoValues> servos, const bla::Profiles& profiles,
                               bool changed_only, const Page& page);

} // namespace blactl::cli
