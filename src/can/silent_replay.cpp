#include "blactl/can/silent_replay.hpp"

#include "blactl/can/replay_texts.hpp"

namespace blactl::can {

Result<bool> SilentReplay::send(const Frame&) {
  return fail(Code::usage, say<texts::file_takes_no_frames>(name_),
              say<texts::log_takes_no_frames_hint>());
}

std::optional<BusEvent> SilentReplay::receive() {
  return std::exchange(told_end_, true) ? std::nullopt : std::optional<BusEvent>(Ended{});
}

} // namespace blactl::can
