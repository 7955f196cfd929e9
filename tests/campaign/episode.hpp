#pragma once
// What one run of the campaign consists of, all from its seed: servos, what goes wrong, commands.

#include "chance.hpp"
#include "world.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace blactl::campaign {

struct Episode {
  std::uint64_t seed = 0;
  nlohmann::json scenario;
  std::vector<Command> steps; ///< one after the other
  /// The kinds of faults that this seed switches on: a random subset, often one alone. None:
  /// nothing goes wrong.
  std::set<std::string> faults;

  [[nodiscard]] bool has(const std::string& fault) const { return faults.contains(fault); }
};

/// All kinds of faults that there are.
[[nodiscard]] std::vector<std::string> fault_kinds();

/// Adds one of them, as `chance` draws it.
void plant(Episode& episode, const std::string& kind, Chance& chance);

[[nodiscard]] Episode make_episode(std::uint64_t seed);

/// On every 100th seed nothing goes wrong, but a servo lies: the judges must notice it.
[[nodiscard]] bool has_liar(const Episode& episode);

/// Whether a patient client gets everything right in spite of what goes wrong.
[[nodiscard]] bool is_harmless(const Episode& episode);

/// Whether what goes wrong is to come just when the program changes something, as seen in a play
/// where nothing goes wrong.
[[nodiscard]] bool is_aimed(const Episode& episode);

/// The same episode, in which nothing goes wrong.
[[nodiscard]] Episode calmed(Episode episode);

/// Moves what goes wrong at a time to one of these moments.
void aim(Episode& episode, const std::vector<Time>& moments);

/// As a file of frozen/, which campaign.py plays on the binary.
[[nodiscard]] nlohmann::json frozen(const Episode& episode);

} // namespace blactl::campaign
