#pragma once
// Graphs of one servo over the last minute.

#include "blactl/fleet/live/monitor.hpp"

#include "cli/output/screen.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace blactl::cli {

/// Stores the samples of the last minute.
class MonitorHistory {
 public:
  static constexpr Duration span = std::chrono::seconds(60);

  void take(const std::vector<fleet::LiveServo>& servos, Time now);

  /// One value of a field and its time.
  using Point = std::pair<Time, std::int64_t>;

  [[nodiscard]] std::vector<Point> points(dronecan::NodeId id, fleet::LiveField field) const;

 private:
  struct Moment {
    Time at{};
    std::array<std::optional<std::int64_t>, fleet::live_fields> values{};
  };

  std::map<dronecan::NodeId, std::deque<Moment>> moments_;
};

/// Angle, speed and torque of a servo one below the other, then temperature and voltage, as far as
/// they fit. Limits are drawn if they are within the scale, which follows the data.
[[nodiscard]] std::vector<ScreenLine> graphs(const fleet::LiveServo& servo,
                                             const MonitorHistory& history, Time now,
                                             std::size_t height, std::size_t width, bool unicode);

} // namespace blactl::cli
