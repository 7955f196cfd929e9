#pragma once
// A fleet file as if its servos had been recorded: what -i file: answers from.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/archive.hpp"
#include "blactl/fleet/files/fleet_file.hpp"

#include <string>
#include <vector>

namespace blactl::fleet {

struct FleetRecording {
  /// A servo of which the file tells no node ID has one that is free, for want of another handle
  /// (Servo::id_is_known).
  std::vector<RecordedServo> servos;
  std::vector<const FleetEntry*> without_id; ///< entries of those, in the order of their IDs
  std::vector<const FleetEntry*> of_many;    ///< entries by model alone: no servo
};

/// What the entries say, and nothing more: the settings; what they match by; about whom they are.
/// The node ID is the one that an entry matches by, else the static one. `file` outlives the
/// recording. `assumed`: --profile, or null.
/// Errors: bad_file (more servos than a bus has room for), model_mismatch.
[[nodiscard]] Result<FleetRecording>
recording_of(const FleetFile& file, const bla::Profiles& profiles, const bla::Profile* assumed);

} // namespace blactl::fleet
