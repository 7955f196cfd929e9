#pragma once
// What servos hold against what a fleet file says, or one file against another.

#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/files/fleet_file.hpp"
#include "blactl/fleet/files/fleet_match.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::fleet {

/// The words of the contract, section 5, `diff apply`.
enum class EntryStatus : std::uint8_t {
  changed,
  unchanged,
  different,
  failed,
  skipped,
  missing,
  extra,
};
[[nodiscard]] std::string_view name(EntryStatus status);

/// One register: what the servo (or the first file) holds, and what the (second) file says.
struct Difference {
  const bla::Parameter* parameter = nullptr;
  std::optional<std::int64_t> before{}; ///< empty: the first file does not say
  std::optional<std::int64_t> wished{}; ///< empty: the second file does not say

  [[nodiscard]] bool is_one() const { return before != wished; }
};

/// What is told of one entry of a fleet file, or of a servo that no entry means.
struct EntryDiff {
  std::string name; ///< empty: of no entry
  EntryStatus status = EntryStatus::unchanged;
  Servo servo;                                             ///< as far as it is known
  std::vector<Difference> registers{};                     ///< all that the entry names, by address
  std::optional<std::int64_t> mode_before{}, mode_after{}; ///< 0x37: the unit of 0x36
  std::vector<Error> errors{};                             ///< why it was not compared

  /// How many registers hold something else.
  [[nodiscard]] std::size_t differences() const;
};

struct FleetDiff {
  std::vector<EntryDiff> entries; ///< servos by node ID, then what is missing, then what is extra
  std::optional<Error> broken{};  ///< why the session ended in between
};

/// Reads from each servo what its entry wishes, all at once. Changes nothing.
[[nodiscard]] FleetDiff diff(Session& session, const bla::Profiles& profiles,
                             const FleetMatch& match, const Identification::Options& options);

/// What is missing, left out or extra, for itself.
[[nodiscard]] std::vector<EntryDiff> unpaired(const FleetMatch& match, const Roster& roster,
                                              const bla::Profiles& profiles);

/// Entries belong together by their unique ID, else by their serial number, else by their name.
/// Of two that do, a register that only one of them names is different too. A parameter file is
/// compared with a file of one entry.
[[nodiscard]] FleetDiff diff(const FleetFile& one, const FleetFile& other,
                             const bla::Profiles& profiles);

} // namespace blactl::fleet
