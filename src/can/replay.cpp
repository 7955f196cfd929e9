#include "blactl/can/replay.hpp"

#include "blactl/can/replay_texts.hpp"

#include "can/kernel_frame.hpp"

#include <algorithm>
#include <utility>

namespace blactl::can {
namespace {

/// The most lines without a frame that are read before the user may interrupt.
constexpr std::size_t most_at_once = 4096;

} // namespace

Result<std::unique_ptr<ReplayBus>> ReplayBus::open(const std::string& path, std::string name) {
  auto reader = LogReader::open(path);
  if (!reader) {
    Error error = std::move(reader.error());
    error.code = Code::interface; // the file takes the place of an interface here
    return std::unexpected(std::move(error));
  }
  return std::unique_ptr<ReplayBus>(new ReplayBus(std::move(*reader), std::move(name)));
}

Result<bool> ReplayBus::send(const Frame&) {
  return fail(Code::usage, say<texts::log_takes_no_frames>(name_),
              say<texts::log_takes_no_frames_hint>());
}

Result<void> ReplayBus::filter(std::span<const Filter>) {
  return {};
}

std::optional<BusEvent> ReplayBus::receive() {
  passed_over_ = 0;
  while (passed_over_ < most_at_once) {
    if (!faults_.empty()) {
      const BusFault fault = faults_.front();
      faults_.pop_front();
      return fault;
    }
    const auto line = reader_->next();
    if (!line) {
      break;
    }
    clock_.pass(*line);
    if (line->kind == LogLine::Kind::frame) {
      has_frames_ = true;
      return Received{line->frame, clock_.now(), clock_.wall(),
                      line->stamp != LogLine::Stamp::none};
    }
    if (line->kind == LogLine::Kind::error) {
      take_error_frame(*line);
    }
    ++passed_over_;
  }
  if (!reader_->ended() || std::exchange(told_end_, true)) {
    return std::nullopt;
  }
  return end();
}

Time ReplayBus::idle_until(Time deadline) {
  const bool has_more = reader_->has_paused() || passed_over_ == most_at_once;
  return has_more ? now() : deadline;
}

void ReplayBus::take_error_frame(const LogLine& line) {
  has_frames_ = true;
  can_frame raw{};
  raw.can_id = line.frame.id | CAN_ERR_FLAG;
  raw.len = line.frame.size;
  std::ranges::copy(line.frame.data, raw.data);
  for (const FaultKind kind : faults(raw)) {
    faults_.push_back({kind, clock_.now()});
  }
}

BusEvent ReplayBus::end() const {
  if (const auto& error = reader_->error()) {
    return Gone{*error};
  }
  if (!has_frames_) {
    return Gone{{Code::bad_file, say<texts::log_without_frames>(reader_->name()),
                 say<texts::log_unreadable_hint>(), std::nullopt}};
  }
  return Ended{};
}

} // namespace blactl::can
