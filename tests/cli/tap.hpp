#pragma once
// A second place on the bus of a running `blactl sim`: hears every frame, and can be a node with
// habits that no scenario file can spell.

#include "blactl/can/simbus.hpp"
#include "blactl/dronecan/payload.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/sim/scenario/scenario.hpp"

#include "run.hpp"

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace blactl::test {

[[nodiscard]] std::unique_ptr<can::SimBus> join(const Bench& bench);

/// What blactl (127, or 126) puts on the bus from now on. The frames wait until they are asked for.
class Tap {
 public:
  explicit Tap(const Bench& bench);

  /// How many frames since the last call.
  [[nodiscard]] std::size_t frames();

  /// Writes by GetSet since the last call, in their order: "0x38=900".
  [[nodiscard]] std::vector<std::string> writes();

  /// Waits until node `source` has sent something.
  void wait_for(int source);

 private:
  [[nodiscard]] std::vector<can::Frame> take();

  std::unique_ptr<can::SimBus> bus_;
};

/// Node 100: demands of one servo what blactl would not.
class Visitor {
 public:
  /// Waits until the servo is on the bus.
  Visitor(const Bench& bench, std::uint8_t servo);

  /// Asks once and waits for the answer.
  void ask(const dronecan::DataType& type, const dronecan::Payload& request);

 private:
  void wait_for(dronecan::Kind kind);

  std::unique_ptr<can::SimBus> bus_;
  dronecan::NodeId servo_;
  dronecan::TransferId transfer_id_ = 0;
};

/// A node that is no servo, on the bus as long as this object lives.
class Guest {
 public:
  Guest(const Bench& bench, const sim::ForeignSetup& setup);
  ~Guest();
  Guest(const Guest&) = delete;
  Guest& operator=(const Guest&) = delete;

 private:
  std::atomic<bool> leaves_ = false;
  std::thread thread_;
};

} // namespace blactl::test
