#pragma once
// One blactl process on one bus: the loop, our node, the roster, and jobs until they are done.

#include "blactl/base/error.hpp"
#include "blactl/can/loop.hpp"
#include "blactl/dronecan/local_node_id.hpp"
#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/roster.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace blactl::fleet {

class Session {
 public:
  /// What of the bus this session wants to hear; a kernel filter keeps the rest away.
  enum class Hearing : std::uint8_t {
    answers,  ///< services for us, NodeStatus, actuator.Status, and frames with our own ID
    commands, ///< also what drives servos: ArrayCommand, ArmingStatus, GetSet requests
    all,
  };

  /// Without a local ID the session only listens.
  [[nodiscard]] static Result<std::unique_ptr<Session>>
  open(std::unique_ptr<can::Bus> bus, std::optional<dronecan::LocalNodeId> local, Hearing hearing);

  ~Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] Roster& roster() { return roster_; }

  [[nodiscard]] dronecan::Node& node() { return node_; }

  [[nodiscard]] std::string_view interface() { return loop_.bus().name(); }

  [[nodiscard]] Time now() const { return loop_.now(); }

  void start(dronecan::Job& job) { node_.start(job, loop_.now()); }

  /// Lives until the bus is open: what is asked from then on, and how long is listened, has nothing
  /// to do with how long an adapter took.
  [[nodiscard]] Result<void> wait_until_open();

  /// Lives until `deadline`.
  /// Errors of this, run() and wait_until_open(): interrupted, interface, bus_off, no_acknowledge,
  /// duplicate_node_id (a foreign frame with our ID). They end the session: every job is cancelled.
  [[nodiscard]] Result<void> live_until(Time deadline);

  /// Lives until no job is left.
  [[nodiscard]] Result<void> run();

  /// Lives until `descriptor` (where a person answers a question) can be read.
  [[nodiscard]] Result<void> wait_for_input(int descriptor);

  /// The signal that ended the session; 0: none.
  [[nodiscard]] int signal() const { return signal_; }

  /// What a person should know of how the bus was opened; empty: nothing.
  [[nodiscard]] const std::string& opening_note() const { return opening_note_; }

  /// Frames that the kernel dropped.
  [[nodiscard]] std::uint64_t lost_frames() const { return lost_; }

  /// Frames of ours that never were acknowledged: the kernel may still send what it was given.
  [[nodiscard]] std::size_t unsent() const { return loop_.unsent(); }

 private:
  Session(std::unique_ptr<can::Bus> bus, std::optional<dronecan::LocalNodeId> local);

  enum class Happened : std::uint8_t { something, deadline, input };
  [[nodiscard]] Result<Happened> step(Time deadline);
  [[nodiscard]] Result<Happened> take(const can::Event& event);
  [[nodiscard]] Result<Happened> take_frame(const can::Received& received);
  [[nodiscard]] std::unexpected<Error> end(Error error);
  [[nodiscard]] Time acknowledge_deadline() const;

  std::optional<dronecan::LocalNodeId> local_;
  can::Loop loop_;
  Roster roster_;
  dronecan::Node node_;
  int signal_ = 0;
  std::uint64_t lost_ = 0;
  std::string opening_note_;
};

} // namespace blactl::fleet
