#include "tries.hpp"

#include "campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

namespace blactl::campaign {
namespace {

using By = Act::By;
using Values = std::set<std::int64_t>;

enum class Memory : std::uint8_t { ram, rom };

/// One servo of a story, before the act with this index and from there on.
class Undone {
 public:
  Undone(const Story& story, std::int64_t serial) : story_(story), serial_(serial) {}

  [[nodiscard]] std::vector<std::size_t> firsts() const;
  [[nodiscard]] std::string difference(std::size_t first) const;

 private:
  [[nodiscard]] const ServoState& before(std::size_t index) const {
    const auto& acts = story_.acts();
    return (index < acts.size() ? acts[index] : story_.undo()).before.at(serial_);
  }

  [[nodiscard]] bool is_plain() const;
  [[nodiscard]] bool has_changed(std::size_t first, Memory memory) const;
  [[nodiscard]] Values due(std::uint8_t address, Memory memory, std::size_t first) const;

  const Story& story_;
  std::int64_t serial_;
};

/// Nothing came between tries that all were to save, changed this servo, and failed but for the
/// last: then they are certainly one change.
bool Undone::is_plain() const {
  const auto& acts = story_.acts();
  for (std::size_t i = 0; i < acts.size(); ++i) {
    const Act& act = acts[i];
    const bool is_last = i + 1 == acts.size();
    const bool is_proof = i == 0 && act.by == By::other_command;
    const bool is_try =
        act.by == By::tries && act.saves && act.touches(serial_) && (act.status == 0) == is_last;
    if (!is_proof && !is_try) {
      return false;
    }
  }
  return story_.names_both_last();
}

/// Where the change may begin that is taken back; after the last act: nothing is.
std::vector<std::size_t> Undone::firsts() const {
  std::vector<std::size_t> tries;
  const auto& acts = story_.acts();
  for (std::size_t i = 0; i < acts.size(); ++i) {
    if (acts[i].by == By::tries) {
      tries.push_back(i);
    }
  }
  if (tries.empty() || is_plain()) {
    return tries.empty() ? tries : std::vector{tries.front()};
  }
  tries.push_back(acts.size());
  return tries;
}

bool Undone::has_changed(std::size_t first, Memory memory) const {
  const auto& acts = story_.acts();
  return std::any_of(acts.begin() + static_cast<std::ptrdiff_t>(first), acts.end(),
                     [&](const Act& act) {
                       const ServoState &was = act.before.at(serial_), &is = act.after.at(serial_);
                       return act.by == By::tries &&
                              (memory == Memory::rom ? was.rom != is.rom : was.ram != is.ram);
                     });
}

/// What it held before the first try, or what others have put there since; what they did after the
/// last try that had an effect may go.
Values Undone::due(std::uint8_t address, Memory memory, std::size_t first) const {
  const auto held = [&](const ServoState& state) {
    return memory == Memory::rom ? state.rom.at(address) : state.ram.at(address);
  };
  const auto& acts = story_.acts();
  Values values;
  std::optional<std::int64_t> of_other;
  bool was_tried = false;
  for (std::size_t i = acts.size(); i-- > first;) {
    const Act& act = acts[i];
    const ServoState &was = act.before.at(serial_), &is = act.after.at(serial_);
    const bool is_own = act.by == By::tries;
    // another user's SAVE keeps what a try has written, too
    const bool is_of_try = memory == Memory::rom && held(is) == was.ram.at(address);
    if (is_own && act.touches(serial_) && !was_tried) {
      was_tried = true;
      if (of_other) {
        values.insert(*of_other);
        of_other.reset();
      }
    } else if (!is_own && held(was) != held(is) && is_of_try) {
      values.insert(held(is));
    } else if (!is_own && !of_other && held(was) != held(is)) {
      of_other = held(is);
    }
  }
  values.insert(of_other.value_or(held(before(first))));
  if (!was_tried || address == static_node_id) { // it may have been a temporary one
    values.insert(held(before(first)));
  }
  return values;
}

/// Empty: it holds what it must if the change began there.
std::string Undone::difference(std::size_t first) const {
  const ServoState& is = story_.undo().after.at(serial_);
  const bool was_saved = has_changed(first, Memory::rom);
  const bool was_meant_to_save = first == story_.acts().size() || story_.acts()[first].saves;
  const bool is_ram_due = was_saved || has_changed(first, Memory::ram);
  for (const std::uint8_t address : story_settings) {
    const Values rom = due(address, Memory::rom, first);
    Values ram = was_saved ? rom : due(address, Memory::ram, first);
    if (!was_saved) { // the supply was cut meanwhile
      ram.insert(before(first).ram.at(address));
    }
    if (was_meant_to_save) { // what RAM alone held does not come back
      ram.insert(rom.begin(), rom.end());
    }
    const bool is_right =
        rom.contains(is.rom.at(address)) && (!is_ram_due || ram.contains(is.ram.at(address)));
    if (story_.is_known(serial_, address) && !is_right) {
      return fmt::format("{:#04x} of {} is {} in RAM and {} in ROM, not {} and {}", address,
                         serial_, is.ram.at(address), is.rom.at(address), fmt::join(ram, " or "),
                         fmt::join(rom, " or "));
    }
  }
  return {};
}

/// Empty: none. What no try has touched, nor found as wished, undo leaves alone in ROM.
std::string difference(const Story& story) {
  for (const std::int64_t serial : story_servos) {
    const bool is_touched = std::ranges::any_of(story.acts(), [&](const Act& act) {
      return act.by == By::tries && (act.touches(serial) || act.status == 0);
    });
    const Act& undo = story.undo();
    if (!is_touched && undo.before.at(serial).rom != undo.after.at(serial).rom) {
      return fmt::format("{} was not touched, and undo changes its ROM", serial);
    }
    const Undone undone(story, serial);
    std::string last;
    for (const std::size_t first :
         story.is_meant(serial) ? undone.firsts() : std::vector<std::size_t>()) {
      last = undone.difference(first);
      if (last.empty()) {
        break;
      }
    }
    if (!last.empty()) {
      return last;
    }
  }
  return {};
}

} // namespace

void Tries::play(std::uint64_t seed) {
  const Folder folder(folder_);
  counts_.stories += 1;
  Story story(seed, folder_);
  story.play();
  if (story.undo().status != 0) {
    return;
  }
  counts_.undone += 1;
  if (const std::string found = difference(story); !found.empty()) {
    counts_.lies += 1;
    tell_(fmt::format("story {}: {}\n{}", seed, found, story.text()));
  }
}

} // namespace blactl::campaign
