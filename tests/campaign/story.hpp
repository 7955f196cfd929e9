#pragma once
// A random story of one command that is tried several times and then undone: tries are killed or
// fail, another user writes and saves in between, the supply is cut.

#include "chance.hpp"
#include "world.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::campaign {

/// Both servos of a story.
inline constexpr std::array<std::int64_t, 2> story_servos{240900001, 240900002};

/// The settings that change in it.
inline constexpr std::array<std::uint8_t, 4> story_settings{0x2C, 0x2E, 0x38, static_node_id};

/// What was done, and what the servos held before and after.
struct Act {
  enum class By : std::uint8_t { tries, other_command, other_user, supply };

  By by = By::tries;
  std::string text{};
  bool saves = false; ///< it is meant to
  int status = 0;     ///< less than 0: it was killed
  States before{}, after{};

  /// Whether it changed this servo.
  [[nodiscard]] bool touches(std::int64_t serial) const;
};

class Story {
 public:
  /// `folder`: for state and files.
  Story(std::uint64_t seed, const std::filesystem::path& folder);

  void play();

  /// In this order; the first may be one by which ROM was proven.
  [[nodiscard]] const std::vector<Act>& acts() const { return acts_; }

  /// The last.
  [[nodiscard]] const Act& undo() const { return undo_; }

  /// Whether undo is to put this servo back.
  [[nodiscard]] bool is_meant(std::int64_t serial) const;

  /// Whether the last try named both servos: else it is a change of its own for the one that was
  /// done.
  [[nodiscard]] bool names_both_last() const { return named_last_.size() == story_servos.size(); }

  /// Whether blactl can know what ROM held, and SAVE kept nothing there that nobody named.
  [[nodiscard]] bool is_known(std::int64_t serial, std::uint8_t address) const {
    return !unknown_values_.contains({serial, address});
  }

  /// What was done and changed, an act a line or some.
  [[nodiscard]] std::string text() const;

 private:
  void prove_rom();
  void try_once();
  [[nodiscard]] Command some_apply();
  void happen_between();
  void write_as_other(bool saves);
  void cut_supply();
  void act(Act::By by, const Command& command, bool may_be_killed = false);
  [[nodiscard]] Outcome run(Act::By by, const Command& command, Disturbance& kill);
  void note_what_is_known(const Act& act, const Command& command);
  [[nodiscard]] std::string some_value(Act::By by, std::uint8_t address,
                                       std::size_t servo); ///< others have others

  Chance chance_;
  World world_;
  bool is_erase_ = false; ///< what is tried is erase --keep-ids, else apply
  std::vector<Act> acts_;
  Act undo_;
  std::set<std::int64_t> named_last_; ///< by the last try
  bool names_first_ = false;          ///< undo does, by -n
  std::set<std::int64_t> unknown_;    ///< servos whose ROM may be another than blactl has seen
  std::set<std::pair<std::int64_t, std::uint8_t>> unknown_values_;
};

} // namespace blactl::campaign
