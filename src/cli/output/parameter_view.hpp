#pragma once
// Parameters of servos as JSON, CSV and text.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/bus/snapshot.hpp"

#include "cli/output/page.hpp"

#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// The shown values of one servo: readings without errors.
struct ServoValues {
  fleet::Snapshot snapshot;
  std::vector<fleet::Reading> shown;
  bool is_complete = true; ///< everything requested was read
  bool can_differ = true;  ///< at least one reading has a default
};

void write_json(JsonWriter& json, std::span<const ServoValues> servos);
[[nodiscard]] std::string csv(std::span<const ServoValues> servos);
/// `changed_only`: a servo without values has only defaults among its readings.
[[nodiscard]] std::string text(std::span<const ServoValues> servos, const bla::Profiles& profiles,
                               bool changed_only, const Page& page);

} // namespace blactl::cli
