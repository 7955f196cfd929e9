#pragma once
// A log as a receive-only bus: `replay:FILE`.

#include "blactl/can/bus.hpp"
#include "blactl/can/log_clock.hpp"
#include "blactl/can/log_reader.hpp"

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::can {

/// Delivers the frames of all interfaces in the log's order, as fast as they are read, then Ended.
/// The bus clock is the time of the last line (see LogClock): waiting takes no time unless a pipe
/// has nothing yet. Error frames become BusFault. `replay:-` reads standard input.
class ReplayBus final : public Bus {
 public:
  /// `name`: as the user gave it. Errors: interface (the log cannot be opened).
  [[nodiscard]] static Result<std::unique_ptr<ReplayBus>> open(const std::string& path,
                                                               std::string name);

  [[nodiscard]] std::string_view name() const override { return name_; }

  /// Errors: usage, always.
  [[nodiscard]] Result<bool> send(const Frame& frame) override;

  /// Ends with Gone (bad_file) for a log without a frame, or one that becomes unreadable.
  [[nodiscard]] std::optional<BusEvent> receive() override;

  /// Now, if receive() has skipped so much that the user must get a chance to interrupt it.
  [[nodiscard]] Time idle_until(Time deadline) override;

  /// Lets everything through.
  [[nodiscard]] Result<void> filter(std::span<const Filter> filters) override;

  [[nodiscard]] bool echoes() const override { return false; }

  [[nodiscard]] int descriptor() const override { return reader_->descriptor(); }

  [[nodiscard]] Time now() const override { return clock_.now(); }

  [[nodiscard]] WallTime wall() const override { return clock_.wall(); }

  [[nodiscard]] bool is_replay() const override { return true; }

  /// The log reader, which counts skipped lines.
  [[nodiscard]] const LogReader& reader() const { return *reader_; }

 private:
  ReplayBus(std::unique_ptr<LogReader> reader, std::string name)
      : reader_(std::move(reader)), name_(std::move(name)) {}

  void take_error_frame(const LogLine& line);
  [[nodiscard]] BusEvent end() const;

  std::unique_ptr<LogReader> reader_;
  std::string name_;
  LogClock clock_;
  std::deque<BusFault> faults_; ///< one error frame may report several
  bool has_frames_ = false;
  bool told_end_ = false;
  std::size_t passed_over_ = 0; ///< lines, by the receive() that ran last
};

} // namespace blactl::can
