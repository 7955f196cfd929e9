#include "cli/trace/trace_run.hpp"

#include "blactl/can/replay_texts.hpp"

#include <signal.h>

#include <algorithm>
#include <utility>
#include <variant>

namespace blactl::cli {
namespace {

/// The size of a block for stdout, if no one waits for a single line.
constexpr std::size_t block_size = 64 << 10;

/// The number of log lines between checks for Ctrl-C.
constexpr std::uint64_t lines_between_looks = 4096;

} // namespace

/// False ends the trace: stdout cannot be written, or its reader has left.
bool TraceRun::check(const Result<bool>& written) {
  if (!written) {
    report_.fail(written.error());
  }
  return written.value_or(false);
}

bool TraceRun::flush() {
  if (out_.empty()) {
    return true;
  }
  const auto written = context_.reporter().stream(out_);
  out_.clear();
  return check(written);
}

bool TraceRun::handle(const can::Event& event, std::string_view interface, Time end) {
  if (const auto* received = std::get_if<can::Received>(&event)) {
    if (received->at > end) {
      return false;
    }
    tracer_.receive({received->frame, received->at, received->wall, interface});
    return !tracer_.full();
  }
  if (const auto* overflow = std::get_if<can::Overflow>(&event)) {
    lost_ = overflow->lost;
  } else if (const auto* signal = std::get_if<can::Signal>(&event)) {
    if (signal->number != SIGWINCH) {
      report_.signal = signal->number;
      return false;
    }
  } else if (const auto* gone = std::get_if<can::Gone>(&event)) {
    report_.fail(gone->error);
    return false;
  }
  return !std::holds_alternative<can::Ended>(event);
}

void TraceRun::live(std::unique_ptr<can::Bus> bus) {
  can::Loop loop(std::move(bus));
  report_.interface = loop.bus().name();
  const Time end = duration_ ? loop.now() + *duration_ : never;
  screen_.begin(loop.now());
  // While frames wait to be read, the bus is not known up to now: a transfer that seems overdue may
  // be among them.
  Time known_until = loop.now();
  bool goes_on = true;
  while (goes_on) {
    const Time deadline = std::min({end, tracer_.next_expiry(), screen_.due()});
    const can::Event event = loop.next(deadline);
    const Time now = loop.now();
    // Everything before the end is read, however late this process is.
    const bool has_read_all = std::holds_alternative<can::DeadlineReached>(event);
    goes_on = handle(event, report_.interface, end) && !(has_read_all && now >= end);
    if (const auto* received = std::get_if<can::Received>(&event)) {
      known_until = received->at;
    } else if (!std::holds_alternative<can::Overflow>(event)) {
      known_until = now;
    }
    if (goes_on && tracer_.next_expiry() <= known_until) {
      tracer_.expire(known_until);
    }
    if (screen_.due() <= now || !goes_on) {
      screen_.pass(std::min(known_until, end));
    }
    goes_on = flush() && check(screen_.advance(now)) && goes_on;
  }
  unreadable_ = loop.bus().unreadable();
  context_.check_recording(report_);
  (void)check(screen_.end());
}

bool TraceRun::take(const can::LogLine& line, const can::LogClock& clock) {
  if (line.kind == can::LogLine::Kind::other) {
    return true;
  }
  const WallTime at = clock.wall();
  begin_ = has_frames_ ? begin_ : at;
  has_frames_ = true;
  if (duration_ && at - begin_ > *duration_) {
    return false;
  }
  if (line.kind == can::LogLine::Kind::frame) {
    // The log's own times, to the microsecond: its clock is the wall clock.
    tracer_.receive({line.frame, Time(at.time_since_epoch()), at, line.interface});
  }
  return !tracer_.full();
}

/// Takes the available lines without waiting.
TraceRun::Next TraceRun::take_lines(can::LogReader& reader, can::LogClock& clock) {
  for (std::uint64_t i = 0; i < lines_between_looks; ++i) {
    const auto line = reader.next();
    if (!line) {
      // a pipe is empty for now: the lines so far are to be visible
      const Next next = reader.has_paused() ? Next::go_on : Next::wait;
      return flush() ? next : Next::stop;
    }
    clock.pass(*line);
    if (!take(*line, clock) || (out_.size() >= block_size && !flush())) {
      return Next::stop;
    }
  }
  return Next::go_on;
}

/// Returns whether the log was read to its end.
bool TraceRun::play(can::LogReader& reader) {
  can::Loop loop(nullptr);
  loop.watch(reader.descriptor());
  can::LogClock clock;
  screen_.begin(loop.now());
  while (!reader.ended()) {
    const Next next = take_lines(reader, clock);
    if (next == Next::stop || !check(screen_.advance(loop.now()))) {
      return false;
    }
    if (reader.ended()) {
      break;
    }
    const can::Event event = loop.next(next == Next::wait ? screen_.due() : Time::min());
    if (const auto* signal = std::get_if<can::Signal>(&event);
        signal != nullptr && signal->number != SIGWINCH) {
      report_.signal = signal->number;
      return false;
    }
  }
  return true;
}

void TraceRun::log(can::LogReader& reader) {
  const bool is_whole = play(reader);
  if (is_whole) {
    tracer_.expire(never);
  }
  (void)flush();
  (void)check(screen_.end());
  if (!is_whole) {
    return;
  }
  if (const auto& error = reader.error()) {
    report_.fail(*error);
  } else if (!has_frames_) {
    report_.fail({Code::bad_file, say<texts::log_without_frames>(reader.name()),
                  say<texts::log_unreadable_hint>(), std::nullopt});
  }
}

} // namespace blactl::cli
