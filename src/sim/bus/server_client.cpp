#include "sim/bus/server_client.hpp"

#include "sim/bus/client.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <utility>

namespace blactl::sim {

using can::sim_wire::Kind;
using can::sim_wire::Message;

namespace {

/// Messages per call, so that one busy client does not keep the others waiting.
constexpr int max_messages_at_a_time = 64;
constexpr std::size_t max_filters = 512; // as CAN_RAW_FILTER_MAX

/// More than a well-behaved client queues; further frames are lost.
constexpr std::size_t queue_capacity = 64;

std::int64_t microseconds(Time time) {
  return time.time_since_epoch().count();
}

/// Now, for a client on the real clock: the simulator may not have got so far yet, and what is
/// answered before it was asked makes clients think that a servo has started anew.
Time handed_over(Clock clock) {
  return clock == Clock::real ? monotonic_now() : Time{};
}

} // namespace

Time monotonic_now() {
  return Time(
      std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

ServerClient::ServerClient(int socket, Simulator& simulator, Clock clock)
    : socket_(socket), simulator_(simulator), clock_(clock) {}

ServerClient::~ServerClient() {
  close(socket_);
  if (port_) {
    simulator_.detach(*port_);
  }
}

void ServerClient::serve() {
  for (int i = 0; i < max_messages_at_a_time && !gone_; ++i) {
    Message message;
    const auto size = recv(socket_, &message, sizeof message, MSG_TRUNC);
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) {
      return;
    }
    if (size == sizeof message) {
      handle(message);
    } else {
      gone_ = true;
    }
  }
}

void ServerClient::handle(const Message& message) {
  if (attached() == (message.kind == Kind::hello)) {
    gone_ = true; // the greeting comes first, and once
    return;
  }
  switch (message.kind) {
  case Kind::hello: greet(message); break;
  case Kind::filter_none: filters_.clear(); break;
  case Kind::filter_add:
    if (filters_.size() < max_filters) {
      filters_.push_back({message.id, message.value});
    }
    break;
  case Kind::send:
    simulator_.send(*port_, can::sim_wire::frame_of(message), handed_over(clock_));
    break;
  case Kind::wait:
    waits_after_ = message.count;
    deadline_ = Time(Duration(message.at));
    break;
  default: gone_ = true; break;
  }
}

void ServerClient::greet(const Message& hello) {
  Message welcome{
      .kind = Kind::welcome, .value = can::sim_wire::version, .at = microseconds(simulator_.now())};
  if (clock_ == Clock::simulated) {
    welcome.flags = can::sim_wire::virtual_clock;
    welcome.count = static_cast<std::uint64_t>(virtual_epoch.time_since_epoch().count());
  }
  post(welcome);
  if (hello.value == can::sim_wire::version) {
    port_ = simulator_.attach(*this, queue_capacity);
  } else {
    gone_ = true;
  }
}

std::optional<Time> ServerClient::waits_until() const {
  return waits_after_ == posted_ ? std::optional(deadline_) : std::nullopt;
}

void ServerClient::tick(Time now) {
  post({.kind = Kind::tick, .at = microseconds(now)});
}

void ServerClient::heard(const can::Frame& frame, Time at) {
  if (passes(filters_, frame)) {
    Message message = can::sim_wire::with_frame(Kind::received, frame);
    message.at = microseconds(at);
    post(message);
  }
}

void ServerClient::sent(const can::Frame& frame, Time at) {
  Message message = can::sim_wire::with_frame(Kind::sent, frame);
  message.at = microseconds(at);
  post(message);
}

void ServerClient::bus_off(Time at) {
  post({.kind = Kind::fault,
        .value = std::to_underlying(can::FaultKind::bus_off),
        .at = microseconds(at)});
}

/// Messages that find no room are lost, and counted.
void ServerClient::post(const Message& message) {
  if (gone_) {
    return;
  }
  if (lost_ != reported_lost_) {
    if (!keep({.kind = Kind::overflow, .count = lost_})) {
      ++lost_;
      return;
    }
    reported_lost_ = lost_;
  }
  if (!keep(message)) {
    ++lost_;
  }
}

/// Appends to the backlog, so that the order is kept. False: the backlog is full.
bool ServerClient::keep(const Message& message) {
  if (backlog_.size() >= backlog_capacity) {
    return false;
  }
  if (!backlog_.empty() || !deliver(message)) {
    backlog_.push_back(message);
  }
  ++posted_;
  return true;
}

void ServerClient::flush() {
  while (!gone_ && !backlog_.empty() && deliver(backlog_.front())) {
    backlog_.pop_front();
  }
}

/// False: the socket is full, or its other end is closed.
bool ServerClient::deliver(const Message& message) {
  if (::send(socket_, &message, sizeof message, MSG_NOSIGNAL | MSG_DONTWAIT) == sizeof message) {
    return true;
  }
  gone_ = errno != EAGAIN && errno != ENOBUFS && errno != EINTR;
  return false;
}

} // namespace blactl::sim
