#pragma once
// One run of `blactl monitor` on an open session: samples on a screen or as a stream.

#include "blactl/fleet/live/monitor.hpp"

#include "cli/context.hpp"
#include "cli/monitor/sample.hpp"
#include "cli/monitor/view.hpp"
#include "cli/output/report.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// The options of the output, and its duration.
struct MonitorManner {
  SampleFields fields{};
  Duration period{}; ///< of a sample
  std::optional<Duration> duration{};
  std::optional<std::uint64_t> count{};    ///< of samples
  bool identifies = false;                 ///< servos are turned by hand
  std::vector<dronecan::NodeId> holding{}; ///< those of them that still have torque
};

class MonitorRun {
 public:
  /// `context`, whose session is open, and `report` outlive this.
  MonitorRun(MonitorManner manner, fleet::Targets targets, Context& context, Report& report);

  /// Runs until the end; the report shows whether the session broke.
  void run();

  /// Whether the user has ended it by a key.
  [[nodiscard]] bool was_quit() const { return was_quit_; }

  /// Adds all servos to the report; `errors`: further errors of single ones.
  void conclude(std::span<const Error> errors);

 private:
  [[nodiscard]] fleet::Monitor::Options options();
  void open_screen();
  void take_keys();
  void take_other_key(Key key);
  void tell_presence();
  void tell_state();
  [[nodiscard]] std::string playing() const;
  [[nodiscard]] bool shall_end();
  [[nodiscard]] bool is_past_duration(Time now);
  void sample(Time now);
  void stream(const std::vector<fleet::LiveServo>& servos);
  void check(const Result<bool>& printed);

  MonitorManner manner_;
  Context& context_;
  Report& report_;
  std::unique_ptr<MonitorView> view_; ///< null: lines
  fleet::Monitor monitor_;
  std::optional<Time> begin_; ///< for a recording, which has its own time
  std::uint64_t samples_ = 0;
  bool has_header_ = false;
  bool is_over_ = false;
  bool was_quit_ = false;
  bool told_end_ = false; ///< of the log
};

} // namespace blactl::cli
