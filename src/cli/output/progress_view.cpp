#include "cli/output/progress_view.hpp"

#include "cli/texts.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::cli {

std::string short_list(std::span<const dronecan::NodeId> ids) {
  constexpr std::size_t most = 10;
  const std::string shown = fleet::id_list(ids.first(std::min(ids.size(), most)));
  return ids.size() > most ? shown + " …" : shown;
}

long long whole_seconds(Duration duration) {
  return std::chrono::duration_cast<std::chrono::seconds>(duration).count();
}

std::string text(const fleet::Progress& progress) {
  const std::string at_work =
      progress.at_work.empty() ? "" : say<texts::progress_at_work>(short_list(progress.at_work));
  const std::string away =
      progress.away.empty() ? "" : say<texts::progress_away>(short_list(progress.away));
  return say<texts::progress_change>(progress.ended, progress.servos,
                                     whole_seconds(progress.elapsed), at_work, away);
}

} // namespace blactl::cli
