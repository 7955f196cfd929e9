#pragma once
// A table of all servos, for a screen of any size.

#include "blactl/fleet/live/monitor.hpp"

#include "cli/output/screen.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// A column of measured values, which its unit names.
struct Measured {
  fleet::LiveField field;
  std::string_view unit;
  std::size_t width;
};

inline constexpr std::array measured{
    Measured{fleet::LiveField::angle, "deg", 9}, Measured{fleet::LiveField::speed, "rpm", 6},
    Measured{fleet::LiveField::torque, "%", 6}, Measured{fleet::LiveField::temperature, "degC", 6},
    Measured{fleet::LiveField::voltage, "V", 6}};

/// The faults of a servo in words: the worst by name; else its health, where that is not ok.
[[nodiscard]] std::string faults_of(const fleet::LiveServo& servo);

/// A table of servos with one row chosen.
class MonitorTable {
 public:
  /// New servos, and the age of data, are relative to `begin`.
  explicit MonitorTable(Time begin) : begin_(begin) {}

  /// Takes the present state of the servos. The chosen one stays chosen wherever it is; one whose
  /// shaft begins to turn becomes the chosen one.
  void take(std::vector<fleet::LiveServo> servos);

  /// Handles a key; false: it has no meaning here.
  [[nodiscard]] bool press(Key key);

  [[nodiscard]] std::size_t size() const { return servos_.size(); }

  /// The chosen servo; null: none.
  [[nodiscard]] const fleet::LiveServo* chosen() const;

  /// The name of the sort order.
  [[nodiscard]] std::string order() const;

  /// `height` lines: the header, and the rows around the chosen one.
  [[nodiscard]] std::vector<ScreenLine> lines(std::size_t height, Time now);

  /// The range of those rows: "1-20 of 120"; empty: all.
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
  std::size_t top_ = 0; ///< the first visible row
  std::size_t rows_ = 1;
  std::string shown_;
};

/// The most important states of a servo, the worst first, and their look.
[[nodiscard]] Piece state_of(const fleet::LiveServo& servo, Time now, Time begin);

} // namespace blactl::cli
