#pragma once
// Compares servos with a fleet file, or two files.

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

/// One register: the value of the servo (or the first file), and of the (second) file.
struct Difference {
  const bla::Parameter* parameter = nullptr;
  std::optional<std::int64_t> before{}; ///< empty: not in the first file
  std::optional<std::int64_t> wished{}; ///< empty: not in the second file

  [[nodiscard]] bool is_one() const { return before != wished; }
};

/// The comparison of one entry of a fleet file, or of a servo without an entry.
struct EntryDiff {
  std::string name; ///< empty: no entry
  EntryStatus status = EntryStatus::unchanged;
  Servo servo;                         ///< as far as known
  std::vector<Difference> registers{}; ///< all registers of the entry, by address
  std::optional<std::int64_t> mode_before{}, mode_after{}; ///< 0x37: the unit of 0x36
  std::vector<Error> errors{};                             ///< why it was not compared

  /// The number of registers that differ.
  [[nodiscard]] std::size_t differences() const;
};

struct FleetDiff {
  std::vector<EntryDiff> entries; ///< servos by node ID, then those of unpaired()
  std::optional<Error> broken{};  ///< the error that ended the session early
};

/// Reads the registers of each servo's entry, all at once. Changes nothing.
[[nodiscard]] FleetDiff diff(Session& session, const bla::Profiles& profiles,
                             const FleetMatch& match, const Identification::Options& options);

/// The missing, left out or extra ones, and those that a recipe is not for, each on its own.
[[nodiscard]] std::vector<EntryDiff> unpaired(const FleetMatch& match, const Roster& roster,
                                              const bla::Profiles& profiles);

/// Pairs entries by their unique ID, else by their serial number, else by their name. In a pair, a
/// register that only one of them has differs, too. A parameter file or a recipe is compared with a
/// file of one entry.
[[nodiscard]] FleetDiff diff(const FleetFile& one, const FleetFile& other,
                             const bla::Profiles& profiles);

} // namespace blactl::fleet
