#pragma once
// A recording without frames, for input that was not received on a bus.

#include "blactl/can/bus.hpp"
#include "blactl/can/replay_texts.hpp"

#include <string>
#include <string_view>
#include <utility>

namespace blactl::can {

class SilentReplay final : public Bus {
 public:
  /// `name`: as the user gave it.
  explicit SilentReplay(std::string name) : name_(std::move(name)) {}

  [[nodiscard]] std::string_view name() const override { return name_; }

  /// Errors: usage, always.
  [[nodiscard]] Result<bool> send(const Frame&) override {
    return fail(Code::usage, say<texts::file_takes_no_frames>(name_),
                say<texts::log_takes_no_frames_hint>());
  }

  /// Returns its end, once.
  [[nodiscard]] std::optional<BusEvent> receive() override {
    return std::exchange(told_end_, true) ? std::nullopt : std::optional<BusEvent>(Ended{});
  }

  [[nodiscard]] Result<void> filter(std::span<const Filter>) override { return {}; }

  [[nodiscard]] bool echoes() const override { return false; }

  [[nodiscard]] int descriptor() const override { return -1; }

  [[nodiscard]] Time now() const override { return {}; }

  [[nodiscard]] bool is_replay() const override { return true; }

 private:
  std::string name_;
  bool told_end_ = false;
};

} // namespace blactl::can
