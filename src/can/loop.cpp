#include "blactl/can/loop.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

namespace blactl::can {
namespace {

/// Frames in flight without an echo: one probes a silent bus, three keep a live one busy.
constexpr std::size_t probe_window = 1;
constexpr std::size_t window = 3;

/// A process that is so late has stood still.
constexpr Duration longest_delay = std::chrono::milliseconds(300);

/// After that, an adapter and the kernel have handed over what has waited.
constexpr Duration catch_up_time = std::chrono::milliseconds(500);

/// Whether the signal is ignored, as nohup arranges.
bool is_ignored(int number) {
  struct sigaction action{};
  return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN; // NOLINT
}

int open_signals() {
  struct sigaction ignore{};
  ignore.sa_handler = SIG_IGN; // NOLINT: the macro casts
  sigaction(SIGPIPE, &ignore, nullptr);
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGWINCH}) {
    sigaddset(&set, number);
  }
  if (!is_ignored(SIGHUP)) {
    sigaddset(&set, SIGHUP);
  }
  sigprocmask(SIG_BLOCK, &set, nullptr);
  return signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
}

timespec until(Time now, Time deadline) {
  const auto left = std::max(deadline - now, Duration::zero());
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
  return {static_cast<time_t>(seconds.count()),
          static_cast<long>(std::chrono::nanoseconds(left - seconds).count())};
}

/// After these events, frames in flight may never be echoed: the kernel dropped the echoes, the
/// controller has forgotten the frames, or it is gone with them. They free their places.
bool loses_echoes(const BusEvent& event) {
  const auto* fault = std::get_if<BusFault>(&event);
  return std::holds_alternative<Overflow>(event) || std::holds_alternative<Away>(event) ||
         (fault != nullptr && fault->kind == FaultKind::bus_off);
}

} // namespace

Loop::Loop(std::unique_ptr<Bus> bus) : bus_(std::move(bus)), signals_(open_signals()) {}

Loop::~Loop() {
  if (signals_ >= 0) {
    close(signals_);
  }
}

Time Loop::now() const {
  if (bus_) {
    return bus_->now();
  }
  return Time(
      std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

WallTime Loop::wall() const {
  if (bus_) {
    return bus_->wall();
  }
  return std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());
}

void Loop::send(const Frame& frame) {
  queue_.push_back(frame);
  pump();
}

void Loop::withdraw(std::span<const Frame> frames) {
  std::erase_if(queue_, [&](const Frame& queued) {
    return std::ranges::find(frames, queued) != frames.end();
  });
}

std::size_t Loop::unsent() const {
  return queue_.size() + in_flight_.size();
}

std::optional<Time> Loop::unacknowledged_since() const {
  if (in_flight_.empty()) {
    return std::nullopt;
  }
  return std::max(in_flight_.front().since, last_heard_);
}

void Loop::watch(int descriptor) {
  watched_.push_back(descriptor);
}

void Loop::unwatch(int descriptor) {
  std::erase(watched_, descriptor);
}

/// Hands queued frames to the bus as far as the window allows.
void Loop::pump() {
  refused_at_.reset();
  while (!queue_.empty() && !gone_ && in_flight_.size() < (heard_ ? window : probe_window)) {
    const auto taken = bus_->send(queue_.front());
    if (!taken) {
      gone_ = true;
      ready_.emplace_back(Gone{taken.error()});
      return;
    }
    if (!*taken) {
      refused_at_ = bus_->now();
      return;
    }
    if (bus_->echoes()) {
      in_flight_.push_back({queue_.front(), bus_->now()});
    } else {
      ready_.emplace_back(Sent{queue_.front(), bus_->now(), bus_->wall()});
    }
    queue_.pop_front();
  }
}

Time Loop::pump_again_at() const {
  return refused_at_ ? bus_->send_again_at(*refused_at_) : never;
}

std::optional<Event> Loop::from_signals() {
  signalfd_siginfo info{};
  if (read(signals_, &info, sizeof info) != sizeof info) {
    return std::nullopt;
  }
  return Signal{static_cast<int>(info.ssi_signo)};
}

std::optional<Event> Loop::from_bus() {
  if (!ready_.empty()) {
    Event event = std::move(ready_.front());
    ready_.pop_front();
    return event;
  }
  if (!bus_ || gone_) {
    return std::nullopt;
  }
  auto happened = bus_->receive();
  if (!happened) {
    return std::nullopt;
  }
  if (auto* received = std::get_if<Received>(&*happened)) {
    received->is_timed = received->is_timed && (bus_->stamps() || received->at >= late_until_);
    heard(received->at);
  } else if (const auto* sent = std::get_if<Sent>(&*happened)) {
    const auto same = [&](const Pending& pending) { return pending.frame == sent->frame; };
    if (const auto it = std::ranges::find_if(in_flight_, same); it != in_flight_.end()) {
      in_flight_.erase(it);
    }
    heard(sent->at);
  } else if (loses_echoes(*happened)) {
    in_flight_.clear();
    pump();
  } else if (std::holds_alternative<Gone>(*happened) || std::holds_alternative<Ended>(*happened)) {
    gone_ = true;
  }
  return std::visit([](auto&& event) { return Event(std::forward<decltype(event)>(event)); },
                    std::move(*happened));
}

/// The bus is alive: waiting frames may go on.
void Loop::heard(Time at) {
  heard_ = true;
  last_heard_ = at;
  pump();
}

/// This process should have run when it was `due`.
void Loop::note_run(Time due) {
  const Time now = this->now();
  if (due != never && now - due > longest_delay) {
    late_until_ = now + catch_up_time;
  }
}

/// Waits for the bus, a signal, a watched descriptor or the deadline, whichever is first.
std::optional<Event> Loop::wait(Time deadline) {
  const Time begin = now();
  const Time wake =
      bus_ && !gone_ ? bus_->idle_until(std::min(deadline, pump_again_at())) : deadline;
  auto event = poll_once(wake);
  note_run(std::max(wake, begin));
  return event;
}

std::optional<Event> Loop::poll_once(Time wake) {
  std::array<pollfd, 32> fds{};
  std::size_t count = 0;
  fds[count++] = {signals_, POLLIN, 0};
  if (bus_ && !gone_ && bus_->descriptor() >= 0) {
    const auto wanted = static_cast<short>(bus_->wants_to_write() ? POLLIN | POLLOUT : POLLIN);
    fds[count++] = {bus_->descriptor(), wanted, 0};
  }
  const std::size_t first_watched = count;
  for (const int descriptor : watched_) {
    if (count < fds.size()) {
      fds[count++] = {descriptor, POLLIN, 0};
    }
  }
  const timespec timeout = until(now(), wake);
  if (ppoll(fds.data(), count, wake == never ? nullptr : &timeout, nullptr) <= 0) {
    return std::nullopt;
  }
  if (fds[0].revents != 0) {
    return from_signals();
  }
  // Round robin, so that a busy descriptor does not starve the others.
  const std::size_t n = count - first_watched;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t at = (next_watched_ + i) % n;
    if (fds[first_watched + at].revents != 0) {
      next_watched_ = at + 1;
      return Ready{fds[first_watched + at].fd};
    }
  }
  return std::nullopt;
}

Event Loop::next(Time deadline) {
  note_run(left_at_.value_or(never));
  Event event = happening(deadline);
  left_at_ = now();
  return event;
}

Event Loop::happening(Time deadline) {
  if (auto event = from_signals()) { // on a busy bus nothing is waited for
    return *event;
  }
  for (;;) {
    if (pump_again_at() <= now()) {
      pump();
    }
    if (auto event = from_bus()) {
      return std::move(*event);
    }
    if (deadline <= now()) {
      return DeadlineReached{};
    }
    if (auto event = wait(deadline)) {
      return std::move(*event);
    }
  }
}

} // namespace blactl::can
