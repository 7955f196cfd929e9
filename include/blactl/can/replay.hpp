#pragma once
// A candump log as a bus that is only heard: `replay:FILE`.

#include "blactl/can/bus.hpp"
#include "blactl/can/candump_reader.hpp"
#include "blactl/can/log_clock.hpp"

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::can {

/// The frames of all interfaces of the log in its order, as fast as they are asked for, then Ended.
/// The bus clock is that of the line read last (see LogClock): waiting takes no time unless a pipe
/// has nothing yet. Error frames are BusFault. Standard input is a log too (`replay:-`).
class ReplayBus final : public Bus {
 public:
  /// `name`: as the user gave it. Errors: interface (the log cannot be opened).
  [[nodiscard]] static Result<std::unique_ptr<ReplayBus>> open(const std::string& path,
                                                               std::string name);

  [[nodiscard]] std::string_view name() const override { return name_; }

  /// Errors: usage, always.
  [[nodiscard]] Result<bool> send(const Frame& frame) override;

  /// A log without a frame ends as Gone (bad_file), and so does one that cannot be read further.
  [[nodiscard]] std::optional<BusEvent> receive() override;

  /// Now, if receive() has passed over so much that somebody shall get the chance to end it.
  [[nodiscard]] Time idle_until(Time deadline) override;

  /// Lets everything through.
  [[nodiscard]] Result<void> filter(std::span<const Filter> filters) override;

  [[nodiscard]] bool echoes() const override { return false; }

  [[nodiscard]] int descriptor() const override { return reader_->descriptor(); }

  [[nodiscard]] Time now() const override { return clock_.now(); }

  [[nodiscard]] WallTime wall() const override { return clock_.wall(); }

  [[nodiscard]] bool is_recording() const override { return true; }

  /// Where lines were passed over.
  [[nodiscard]] const CandumpReader& reader() const { return *reader_; }

 private:
  ReplayBus(std::unique_ptr<CandumpReader> reader, std::string name)
      : reader_(std::move(reader)), name_(std::move(name)) {}

  void take_error_frame(const LogLine& line);
  [[nodiscard]] BusEvent end() const;

  std::unique_ptr<CandumpReader> reader_;
  std::string name_;
  LogClock clock_;
  std::deque<BusFault> faults_; ///< one error frame may tell several
  bool has_frames_ = false;
  bool told_end_ = false;
  std::size_t passed_over_ = 0; ///< lines, by the receive() that ran last
};

} // namespace blactl::can
