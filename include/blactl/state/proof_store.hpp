#pragma once
// Proofs of the ROM contents of servos. Contract, sections 6 and 7, "apply": a restart followed by
// a complete read is a proof.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/state/access.hpp"
#include "blactl/state/registers.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::state {

class StateFile;

/// The ROM of one unit at its start: RAM was read completely before anything was written to it.
struct RomProof {
  dronecan::UniqueId unique_id{};
  Registers
      rom{}; ///< all registers that SAVE keeps; if it could not be read, at most the IDs before
  WallTime started{};            ///< by its uptime at the proof
  std::chrono::seconds uptime{}; ///< at the proof
  /// The wall time at which the clock that waits (CLOCK_MONOTONIC) was 0: another one once the wall
  /// clock was set, or the machine slept.
  WallTime clock{};
  std::optional<std::int64_t> serial_number{}; ///< of the unit; empty: it did not tell it

  friend bool operator==(const RomProof&, const RomProof&) = default;
};

/// How far two uptimes of one run may contradict each other: they count whole seconds, and clocks
/// drift (contract, section 7, "apply").
inline constexpr Duration uptime_tolerance = std::chrono::seconds(2);

/// More than a clock that is set by small steps may have been set.
inline constexpr Duration clock_tolerance = std::chrono::milliseconds(200);

/// Whether a unit with this uptime has kept running since the proof: ROM changes by SAVE alone, and
/// a restart follows every SAVE (4.11). `clock`: as RomProof::clock, now.
[[nodiscard]] bool holds(const RomProof& proof, std::chrono::seconds uptime, WallTime now,
                         WallTime clock);

/// The same proof with a later uptime, once it holds(): a crystal drifting by 30 ppm uses up the
/// tolerance in a day.
[[nodiscard]] RomProof renewed(RomProof proof, std::chrono::seconds uptime, WallTime now);

/// One proof per unit, in `proofs.db` of a folder: an SQLite database that several processes use at
/// once. When a function returns, its result is on disk.
///
/// A file that is not ours or was made by a newer blactl is an error, and so is damage where it is
/// met (check_state_files() meets all of it). It stays as it is, byte for byte.
///
/// Errors of every function: bad_file (not a file of ours, damaged, of a newer blactl), permission,
/// io (also a full disk: then nothing has changed), busy (another process used it longer than our
/// patience). A store is used by one thread and must not be carried through a fork().
class ProofStore {
 public:
  /// `folder`: from state_folder(). Further errors: state: it is empty.
  [[nodiscard]] static Result<ProofStore> open(const std::string& folder, Access access,
                                               std::chrono::milliseconds patience = usual_patience);

  /// For a bus that no other process can reach: an empty store that ends with this object.
  [[nodiscard]] static Result<ProofStore> unshared();

  /// Used by open() and unshared().
  explicit ProofStore(std::unique_ptr<StateFile> file);

  ProofStore(const ProofStore&) = delete;
  ProofStore& operator=(const ProofStore&) = delete;
  ProofStore(ProofStore&&) noexcept;
  ProofStore& operator=(ProofStore&&) noexcept;
  ~ProofStore();

  /// Replaces the proofs of these units: all or none.
  [[nodiscard]] Result<void> put(std::span<const RomProof> proofs);

  /// The proof of a unit, to be checked with holds(); empty: its ROM is unknown. What was proven
  /// before this machine started is not: its clock may have begun anew at the same time.
  [[nodiscard]] Result<std::optional<RomProof>> find(const dronecan::UniqueId& unique_id) const;

  /// All proofs, also those of before this machine started: what ROM held then.
  [[nodiscard]] Result<std::vector<RomProof>> proofs() const;

  /// Removes all proofs.
  [[nodiscard]] Result<void> clear();

  /// Removes the proofs of these units: all or none.
  [[nodiscard]] Result<void> drop(std::span<const dronecan::UniqueId> units);

 private:
  std::unique_ptr<StateFile> file_;
};

} // namespace blactl::state
