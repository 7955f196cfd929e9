#pragma once
// Records the frames of a bus as a candump log: `--record FILE`.

#include "blactl/can/bus.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::can {

/// The name of a bus in a log, acceptable to candump and canplayer: "vcan0" stays, "sim:" is "sim",
/// "slcan:/dev/ttyUSB0" is "ttyUSB0", "mcast:0" is "mcast-0".
[[nodiscard]] std::string log_interface(std::string_view bus_name);

/// Forwards everything to another bus and writes a line for every frame from it: those of other
/// nodes, and the echoes of ours. Without echoes a frame of ours is written when the bus accepts
/// it.
///
/// Each line is one write(2), so the file is current even if this process is killed. When a line
/// cannot be written, recording ends there, with complete lines only, and the bus goes on.
class Recorder final : public Bus {
 public:
  /// Creates the file (mode 0644 less the umask), or replaces it as a shell's redirection does.
  /// Errors: io.
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> open(std::unique_ptr<Bus> bus,
                                                              const std::string& path);

  ~Recorder() override;
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Empties the file, which then holds the frames from now on; also after recording has ended
  /// early.
  void begin_anew();

  /// The path of the file.
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Why recording ended early: io.
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  [[nodiscard]] std::string_view name() const override { return bus_->name(); }

  [[nodiscard]] bool is_open() const override { return bus_->is_open(); }

  [[nodiscard]] Result<bool> send(const Frame& frame) override;

  [[nodiscard]] Time send_again_at(Time refused) const override {
    return bus_->send_again_at(refused);
  }

  [[nodiscard]] std::optional<BusEvent> receive() override;

  /// The log has all frames, so it is not forwarded; what is received is as without a recording.
  [[nodiscard]] Result<void> filter(std::span<const Filter> filters) override;

  [[nodiscard]] bool echoes() const override { return bus_->echoes(); }

  [[nodiscard]] std::uint64_t unreadable() const override { return bus_->unreadable(); }

  [[nodiscard]] std::optional<Error> silence() const override { return bus_->silence(); }

  [[nodiscard]] std::string bus_off_hint() const override { return bus_->bus_off_hint(); }

  [[nodiscard]] int descriptor() const override { return bus_->descriptor(); }

  [[nodiscard]] bool wants_to_write() const override { return bus_->wants_to_write(); }

  [[nodiscard]] bool stamps() const override { return bus_->stamps(); }

  [[nodiscard]] bool is_replay() const override { return bus_->is_replay(); }

  [[nodiscard]] bool is_paced() const override { return bus_->is_paced(); }

  [[nodiscard]] Time now() const override { return bus_->now(); }

  [[nodiscard]] WallTime wall() const override { return bus_->wall(); }

  [[nodiscard]] Time idle_until(Time deadline) override { return bus_->idle_until(deadline); }

 private:
  Recorder(std::unique_ptr<Bus> bus, int descriptor, std::string path);

  void record(const Frame& frame, WallTime at);
  [[nodiscard]] bool passes(const Frame& frame) const;
  void stop(int error);

  std::unique_ptr<Bus> bus_;
  int descriptor_;
  std::string path_;
  std::string interface_;
  std::int64_t complete_ = 0; ///< bytes of complete lines
  std::optional<Error> error_;
  std::vector<Filter> filters_; ///< empty: all
};

} // namespace blactl::can
