#pragma once
// All servos at a glance, for a screen of any size.

#include "blactl/fleet/live/monitor.hpp"

#include "cli/output/screen.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// A table of servos of which one is chosen.
class MonitorTable {
 public:
  /// New servos, and how old data is, are told against `begin`.
  explicit MonitorTable(Time begin) : begin_(begin) {}

  /// The servos as they are now. The chosen one stays chosen wherever it stands; one whose shaft
  /// begins to turn becomes it.
  void take(std::vector<fleet::LiveServo> servos);

  /// True: the key meant something.
  [[nodiscard]] bool press(Key key);

  [[nodiscard]] std::size_t size() const { return servos_.size(); }

  /// Null: there is none.
  [[nodiscard]] const fleet::LiveServo* chosen() const;

  /// What the rows are in the order of.
  [[nodiscard]] std::string order() const;

  /// `height` lines: the header, and the rows around the chosen one.
  [[nodiscard]] std::vector<ScreenLine> lines(std::size_t height, Time now);

  /// Which rows those were: "1-20 of 120"; empty: all.
  [[nodiscard]] const std::string& shown() const { return shown_; }

 private:
  enum class Order : std::uint8_t { node, state, angle, temperature, voltage };

  void follow(const std::vector<fleet::LiveServo>& servos);
  void sort();
  void move(std::ptrdiff_t by);
  [[nodiscard]] std::size_t place() const;

  Time begin_;
  std::vector<fleet::LiveServo> servos_;
  std::optional<dronecan::NodeId> chosen_;
  Order order_ = Order::node;
  std::size_t top_ = 0; ///< the first row that is shown
  std::size_t rows_ = 1;
  std::string shown_;
};

/// What a person should know of a servo, the worst first, and how it stands out.
[[nodiscard]] Piece state_of(const fleet::LiveServo& servo, Time now, Time begin);

} // namespace blactl::cli
