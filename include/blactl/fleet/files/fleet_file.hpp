#pragma once
// A fleet file: which servos there are, and what each shall hold (contract, section 6).
//
//   {
//     "schema": "blactl-fleet/1",
//     "common": {"timeout_action": "off", "timeout_time": "500ms"},
//     "servos": [
//       {
//         "name": "left aileron",
//         "match": {"serial_number": 240900558},
//         "set": {"servo_id": 3, "angle_limit_cw": "45.0deg"}
//       }
//     ]
//   }
//
// (schemas/fleet.schema.json)

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/fleet/bus/servo.hpp"
#include "blactl/fleet/bus/snapshot.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::fleet {

/// The word that a fleet file begins with.
inline constexpr std::string_view fleet_schema = "blactl-fleet/1";

/// Which servo an entry means: all keys that are given must agree.
struct Match {
  std::optional<dronecan::UniqueId> unique_id{};
  std::optional<std::int64_t> serial_number{}; ///< 0x51
  std::optional<std::int64_t> servo_id{};      ///< 0x45
  std::optional<dronecan::NodeId> node_id{};   ///< where it is on the bus
  std::string model{};                         ///< as `-n model:` takes it; empty: any

  /// Exactly one servo; else as many as there are of the model.
  [[nodiscard]] bool means_one() const { return unique_id || serial_number || servo_id || node_id; }

  /// Whether this identified servo is meant; a model only if it is known for sure.
  [[nodiscard]] bool means(const Servo& servo, const bla::Profiles& profiles) const;
};

/// What `export` tells of a servo beside its settings; nothing is compared with it.
struct About {
  std::optional<std::string> model{};
  std::optional<std::int64_t> firmware_version{}, hardware_version{}; ///< 0x52, 0x53
  std::optional<std::string> production_date{};                       ///< "2025-06-22 15:30"
  std::optional<std::string> time{};                                  ///< of the reading, RFC 3339
  std::optional<std::string> tool_version{};
};

struct FleetEntry {
  std::string name; ///< each once in a file; for people, and for `--entry`
  Match match;
  std::vector<bla::Assignment> set; ///< with those of "common", by address, each register once
  About about;

  /// The value for this register; empty: none is wished.
  [[nodiscard]] std::optional<std::int64_t> wish(bla::Address address) const;
};

struct FleetFile {
  std::string file; ///< its name, for messages
  std::vector<FleetEntry> servos;
  /// A parameter file (see params_file.hpp): its one entry says nothing of which servo it is for.
  bool is_params = false;
  std::vector<bla::Address> passed_over{}; ///< no settings, by address: in parameter files
};

/// `file` is the name for messages. Errors: bad_file with file, line, JSON pointer and reason of
/// every fault: what is no JSON, keys that are unknown or there twice, values that no model takes,
/// or not the model that the entry names, registers that are no settings, two entries for one
/// servo, an ID for two, an entry that would not find its servo again after its own change.
[[nodiscard]] Result<FleetFile> parse_fleet_file(std::string_view text, std::string file,
                                                 const bla::Profiles& profiles);

/// "-" reads stdin. Errors: the same.
[[nodiscard]] Result<FleetFile> read_fleet_file(const std::filesystem::path& file,
                                                const bla::Profiles& profiles);

/// What export makes of servos.
struct FleetFileStyle {
  std::optional<WallTime> time{}; ///< of the reading; empty: not known
  std::string tool_version{};     ///< of this program
};

/// The registers that an entry tells of: the configuration, and when the servo was made.
[[nodiscard]] std::vector<const bla::Parameter*> registers_to_export(const Servo& servo);

/// A file that `apply` takes as it is and that reads well in version control: every setting of
/// these servos, which were read completely, in their order.
[[nodiscard]] std::string fleet_file(std::span<const Snapshot> servos, const FleetFileStyle& style);

} // namespace blactl::fleet
