#pragma once
// The simulated bus as a process: serves it to clients on a Unix socket (see can/sim_wire.hpp).

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/sim/bus/simulator.hpp"
#include "blactl/sim/scenario/scenario.hpp"
#include "blactl/sim/servo/event.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>

namespace blactl::sim {

/// A state machine behind one descriptor:
///
///   loop.watch(server.descriptor());
///   for (;;) { … loop.next(server.next_deadline(loop.now())); server.service(); }
///
/// A client that dies, sends garbage or does not read harms no other: it is disconnected, or
/// receives its frames late. Beyond 2.5 s of a full bus it loses frames, and receives their number.
class Server {
 public:
  /// Creates the folder of the socket if it is missing (0700), replaces a simulator that was
  /// killed, and powers the servos on. The scenario's profiles must outlive the server. `sink`
  /// receives the events of the servos, always during service(). Errors: busy (another simulator
  /// serves there), interface.
  [[nodiscard]] static Result<std::unique_ptr<Server>>
  open(const std::filesystem::path& socket, const Scenario& scenario, const EventSink& sink = {});
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Becomes readable when a client has connected, disconnected or sent something.
  [[nodiscard]] int descriptor() const;

  /// Serves the clients and lets time pass. Never waits.
  void service();

  /// The time of the next service() if the descriptor does not become readable earlier. `now`: of
  /// the monotonic clock, whatever the clock of the bus.
  [[nodiscard]] Time next_deadline(Time now) const;

  /// The lag of the bus behind the monotonic clock after the last service(); 0 on the virtual
  /// clock. It keeps growing if the machine is too slow for the traffic.
  [[nodiscard]] Duration behind() const;

  [[nodiscard]] Simulator& simulator();

  /// Stops the virtual clock until this number of clients is attached at once.
  void hold(std::size_t clients);

  [[nodiscard]] std::size_t clients() const;

 private:
  struct State;
  explicit Server(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

} // namespace blactl::sim
