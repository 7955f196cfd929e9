#pragma once
// The screen of monitor: table, graphs, help, and the keys that switch between them.

#include "cli/monitor/graph.hpp"
#include "cli/monitor/table.hpp"
#include "cli/output/reporter.hpp"
#include "cli/output/screen.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace blactl::cli {

class MonitorView {
 public:
  /// `reporter` outlives this: its notes are shown below the table, and again when the screen is
  /// gone. `opened`: the title of the screen.
  MonitorView(std::unique_ptr<Screen> screen, const Reporter& reporter, std::string opened,
              Time begin);
  ~MonitorView();
  MonitorView(const MonitorView&) = delete;
  MonitorView& operator=(const MonitorView&) = delete;

  void take(std::vector<fleet::LiveServo> servos, Time now);

  /// Handles the typed keys; false: it shall end.
  [[nodiscard]] bool take_keys(Time now);

  /// Passes keys without a meaning here to `hook`; `keys` replaces the usual line of keys.
  void on_other_keys(std::function<void(Key)> hook, std::string keys);

  [[nodiscard]] bool is_paused() const { return paused_.has_value(); }

  void draw(Time now);

  /// Sets the state in the title; empty: none.
  void tell(ScreenLine state) { told_ = std::move(state); }

  /// The servo whose graphs are shown; empty: none.
  [[nodiscard]] std::optional<dronecan::NodeId> shown() const;

 private:
  enum class Page : std::uint8_t { table, graphs, help };

  [[nodiscard]] bool press(Key key);
  [[nodiscard]] ScreenLine title(Time now) const;
  [[nodiscard]] ScreenLine footer() const;
  [[nodiscard]] std::vector<ScreenLine> body(std::size_t height, Time now);

  std::unique_ptr<Screen> screen_;
  const Reporter& reporter_;
  std::string opened_;
  Time begin_;
  MonitorTable table_;
  MonitorHistory history_;
  Page page_ = Page::table;
  std::optional<Time> paused_{}; ///< since when
  std::string held_;             ///< notes
  std::string keys_;             ///< of the table
  std::function<void(Key)> other_keys_;
  ScreenLine told_; ///< see tell()
};

} // namespace blactl::cli
