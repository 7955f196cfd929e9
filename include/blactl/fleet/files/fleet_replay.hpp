#pragma once
// A fleet file presented as a recording of its servos, for -i file:.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/replayed_answers.hpp"
#include "blactl/fleet/files/fleet_file.hpp"

#include <vector>

namespace blactl::fleet {

struct FleetRecording {
  /// A servo without a node ID in the file gets a free one, as a handle (Servo::id_is_known).
  std::vector<RecordedServo> servos;
  std::vector<const FleetEntry*> without_id; ///< entries of those, in the order of their IDs
  std::vector<const FleetEntry*> of_many;    ///< entries by model only: no servo
};

/// The contents of the entries, and nothing more: the settings, the match keys, and "about". The
/// node ID is the one in the match of an entry, else the static one. `file` outlives the recording.
/// `assumed`: --profile, or null. Errors: bad_file (more servos than a bus has room for),
/// model_mismatch.
[[nodiscard]] Result<FleetRecording>
recording_of(const FleetFile& file, const bla::Profiles& profiles, const bla::Profile* assumed);

} // namespace blactl::fleet
