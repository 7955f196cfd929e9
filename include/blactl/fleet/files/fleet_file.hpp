#pragma once
// A fleet file: a list of servos with their wanted settings (contract, section 6).
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
#include "blactl/fleet/files/recipe.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::json {
class Document;
} // namespace blactl::json

namespace blactl::fleet {

/// The schema at the start of a fleet file.
inline constexpr std::string_view fleet_schema = "blactl-fleet/1";

/// The servo of an entry: all given keys must agree.
struct Match {
  std::optional<dronecan::UniqueId> unique_id{};
  std::optional<std::int64_t> serial_number{}; ///< 0x51
  std::optional<std::int64_t> servo_id{};      ///< 0x45
  std::optional<dronecan::NodeId> node_id{};   ///< its present node ID
  std::string model{};                         ///< like `-n model:`; empty: any

  /// Whether it selects exactly one servo; else all of the model.
  [[nodiscard]] bool means_one() const { return unique_id || serial_number || servo_id || node_id; }

  /// Whether it selects this identified servo; a model only if it is certain.
  [[nodiscard]] bool means(const Servo& servo, const bla::Profiles& profiles) const;
};

/// Information from `export` besides the settings; it is not compared.
struct About {
  std::optional<std::string> model{};
  std::optional<std::int64_t> firmware_version{}, hardware_version{}; ///< 0x52, 0x53
  std::optional<std::string> production_date{};                       ///< "2025-06-22 15:30"
  std::optional<std::string> time{};                                  ///< of the reading, RFC 3339
  std::optional<std::string> tool_version{};
};

struct FleetEntry {
  std::string name; ///< unique in a file; for people, and for `--entry`
  Match match;
  std::vector<bla::Assignment> set; ///< including those of "common", by address, each register once
  About about;

  /// The value for this register; empty: none.
  [[nodiscard]] std::optional<std::int64_t> wish(bla::Address address) const;

  /// The 0x37 for which 0x36 is meant: the one beside it, or by its unit; empty: unknown.
  [[nodiscard]] std::optional<std::int64_t> pwm_mode() const;
};

struct FleetFile {
  std::string file; ///< its name, for messages
  std::vector<FleetEntry> servos;
  bool is_params = false;                  ///< a parameter file, see params_file.hpp
  std::vector<bla::Address> passed_over{}; ///< not settings, by address: in parameter files
  /// The entry of a parameter file for several servos, without its IDs; empty: it has none.
  std::optional<FleetEntry> entry_without_ids{};
  std::optional<Recipe> recipe{}; ///< it is one, with the settings of its one entry

  /// Whether it is a parameter file or a recipe: its one entry does not identify a servo.
  [[nodiscard]] bool names_nobody() const { return is_params || recipe; }
};

/// The entry of this name. Errors: usage, with the names that there are.
[[nodiscard]] Result<const FleetEntry*> find_entry(const FleetFile& file, std::string_view name);

/// `file` is the name for messages. Errors: bad_file with file, line, JSON pointer and reason of
/// each error: invalid JSON, unknown or repeated keys, values that no model accepts, or not the
/// model of the entry, registers that are not settings, two entries for one servo, an ID for two,
/// an entry that would not match its servo again after its own change.
[[nodiscard]] Result<FleetFile> parse_fleet_file(std::string_view text, std::string file,
                                                 const bla::Profiles& profiles);

/// "-" reads stdin. Errors: the same.
[[nodiscard]] Result<FleetFile> read_fleet_file(const std::filesystem::path& file,
                                                const bla::Profiles& profiles);

/// A file that was read as JSON already. Errors: the same, and those of the document.
[[nodiscard]] Result<FleetFile> read_fleet_file(json::Document& document,
                                                const bla::Profiles& profiles);

/// Data for an exported file.
struct FleetFileStyle {
  std::optional<WallTime> time{}; ///< of the reading; empty: unknown
  std::string tool_version{};     ///< of this program
};

/// The registers of an entry: the configuration, the date of production, and whether ROM could be
/// read.
[[nodiscard]] std::vector<const bla::Parameter*> registers_to_export(const Servo& servo);

/// A fleet file that stands for servos need not say whether ROM could be read: that is no error.
void drop_unrecorded_state(Snapshot& snapshot);

/// A file for `apply` that reads well in version control: every setting of these servos, which were
/// read completely, in their order.
[[nodiscard]] std::string fleet_file(std::span<const Snapshot> servos, const FleetFileStyle& style);

} // namespace blactl::fleet
