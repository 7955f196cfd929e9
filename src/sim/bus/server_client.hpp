#pragma once
// One client of the simulator's socket, seen from the simulator.

#include "blactl/can/bus.hpp"
#include "blactl/can/sim_wire.hpp"
#include "blactl/sim/bus/simulator.hpp"

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace blactl::sim {

/// What time it is on the real clock.
[[nodiscard]] Time monotonic_now();

class ServerClient final : public Medium::Listener {
 public:
  /// Takes over the socket. `simulator` must outlive the client.
  ServerClient(int socket, Simulator& simulator, Clock clock);
  ServerClient(const ServerClient&) = delete;
  ServerClient& operator=(const ServerClient&) = delete;
  ~ServerClient() override;

  [[nodiscard]] int descriptor() const { return socket_; }

  /// Reads messages of the client, a limited number at a time.
  void serve();

  /// Whether messages wait because the socket is full: flush() when it has room again.
  [[nodiscard]] bool has_backlog() const { return !backlog_.empty(); }

  /// Sends waiting messages, as far as the socket accepts them.
  void flush();

  /// Whether the connection has ended, or must end.
  [[nodiscard]] bool gone() const { return gone_; }

  [[nodiscard]] bool attached() const { return port_.has_value(); }

  /// Virtual clock: the time until which the client lets time pass; empty: it is working, and time
  /// must stand still.
  [[nodiscard]] std::optional<Time> waits_until() const;
  void tick(Time now);

  void heard(const can::Frame& frame, Time at) override;
  void sent(const can::Frame& frame, Time at) override;
  void bus_off(Time at) override;

 private:
  void handle(const can::sim_wire::Message& message);
  void greet(const can::sim_wire::Message& hello);
  void post(const can::sim_wire::Message& message);
  [[nodiscard]] bool keep(const can::sim_wire::Message& message);
  [[nodiscard]] bool deliver(const can::sim_wire::Message& message);

  int socket_;
  Simulator& simulator_;
  Clock clock_;
  std::optional<Medium::PortId> port_; ///< from the greeting on
  std::vector<can::Filter> filters_;
  std::deque<can::sim_wire::Message> backlog_; ///< messages that the socket did not accept yet
  std::uint64_t posted_ = 0;                   ///< messages in its socket or waiting for it
  std::uint64_t lost_ = 0, reported_lost_ = 0;
  std::uint64_t waits_after_ = 0; ///< messages it had read when it sent `wait`; 0: it did not
  Time deadline_ = never;
  bool gone_ = false;
};

} // namespace blactl::sim
