#pragma once
// One run of `blactl trace`: the source of frames, and the end.

#include "blactl/can/bus.hpp"
#include "blactl/can/log_clock.hpp"
#include "blactl/can/log_reader.hpp"
#include "blactl/can/loop.hpp"

#include "cli/context.hpp"
#include "cli/output/report.hpp"
#include "cli/trace/stats_screen.hpp"
#include "cli/trace/tracer.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::cli {

class TraceRun {
 public:
  /// `duration`: the listening time, or the first seconds of a log. `out`: the output of `tracer`
  /// for stdout. `report` receives errors. All of them outlive this.
  TraceRun(std::optional<Duration> duration, const Context& context, Tracer& tracer,
           StatsScreen& screen, std::string& out, Report& report)
      : duration_(duration), context_(context), tracer_(tracer), screen_(screen), out_(out),
        report_(report) {}

  void live(std::unique_ptr<can::Bus> bus);
  void log(can::LogReader& reader);

  /// Frames dropped by the kernel, and log lines without a usable frame.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

  [[nodiscard]] std::uint64_t unreadable() const { return unreadable_; }

 private:
  /// The step after the available lines.
  enum class Next : unsigned char { go_on, wait, stop };

  [[nodiscard]] bool handle(const can::Event& event, std::string_view interface, Time end);
  [[nodiscard]] bool take(const can::LogLine& line, const can::LogClock& clock);
  [[nodiscard]] Next take_lines(can::LogReader& reader, can::LogClock& clock);
  [[nodiscard]] bool play(can::LogReader& reader);
  [[nodiscard]] bool check(const Result<bool>& written);
  [[nodiscard]] bool flush();

  std::optional<Duration> duration_;
  const Context& context_;
  Tracer& tracer_;
  StatsScreen& screen_;
  std::string& out_;
  Report& report_;
  std::uint64_t lost_ = 0;
  std::uint64_t unreadable_ = 0;
  bool has_frames_ = false; ///< the log
  WallTime begin_{};        ///< of the log
};

} // namespace blactl::cli
