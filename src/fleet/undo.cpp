#include "blactl/fleet/undo.hpp"

#include "blactl/fleet/texts.hpp"

#include <string>
#include <utility>

namespace blactl::fleet {

Result<Wanted> to_undo(const state::SnapshotEntry& entry, const bla::Profiles& profiles) {
  Wanted wanted{.restart = entry.saved ? std::optional(RestartKind::save) : std::nullopt};
  for (const auto& [address, raw] : entry.held) {
    const bla::Address setting(address);
    if (!bla::is_setting(setting)) {
      return fail(Code::bad_file, say<texts::no_setting_in_history>(setting.name()),
                  say<texts::no_setting_in_history_hint>());
    }
    auto assignment = bla::make_assignment(profiles, setting.name(), std::to_string(raw) + "raw");
    if (!assignment) {
      return std::unexpected(std::move(assignment.error()));
    }
    wanted.assignments.push_back(std::move(*assignment));
  }
  return wanted;
}

} // namespace blactl::fleet
