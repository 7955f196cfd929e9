#pragma once
// A simulated BLA servo: its messages and services on the bus (sections 2.2, 2.3, 4.9-4.11). Its
// shaft is Motion.

#include "blactl/bla/parameter.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/sim/node/device.hpp"
#include "blactl/sim/node/endpoint.hpp"
#include "blactl/sim/node/random.hpp"
#include "blactl/sim/servo/allocatee.hpp"
#include "blactl/sim/servo/event.hpp"
#include "blactl/sim/servo/memory.hpp"
#include "blactl/sim/servo/mishap.hpp"
#include "blactl/sim/servo/motion.hpp"
#include "blactl/sim/servo/request_counter.hpp"
#include "blactl/sim/servo/servo_setup.hpp"

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace blactl::sim {

/// Sends NodeStatus and actuator.Status, requests a node ID, obeys ArrayCommand, answers
/// GetNodeInfo, GetSet, ExecuteOpcode and RestartNode; restarts, and keeps its saved registers
/// across that.
class Servo final : public Device {
 public:
  /// `seed`: of its boot times and its allocation requests.
  Servo(const ServoSetup& setup, std::uint64_t seed, Time power_on);

  /// `sink` receives the servo's events.
  void report_to(EventSink sink) { tell_ = std::move(sink); }

  void receive(const can::Frame& frame, Time at) override;
  [[nodiscard]] Time next_deadline() const override;
  void advance(Time now) override;

  /// Its node ID; 0 while it has none.
  [[nodiscard]] dronecan::NodeId node_id() const { return endpoint_.node_id(); }

  /// The causes of a restart by itself (4.12, note 2).
  enum class Upset : std::uint8_t { clock, watchdog, memory };

  [[nodiscard]] const World& world() const { return motion_.world(); }

  /// Changes its surroundings. Without power it is dead; when power returns it starts (4.8).
  void surround(const World& world, Time now);

  /// Restarts by itself and shows the cause until the next start.
  void upset(Upset cause, Time now);
  void miss_rom(Time now);

  /// Applies an event of a scenario.
  void suffer(Mishap mishap, Time now);

  /// Brings the readings in registers() up to `now`.
  void look(Time now) { motion_.look(now); }

  /// The physical shaft, as of the last look.
  [[nodiscard]] const Shaft& shaft() const { return motion_.shaft(); }

  /// RAM and ROM, readings as of the last look.
  [[nodiscard]] const Memory& registers() const { return registers_; }

  [[nodiscard]] const dronecan::UniqueId& unique_id() const { return setup_.unique_id; }

  [[nodiscard]] std::int64_t serial_number() const { return setup_.serial_number; }

  /// The number of ROM writes since power-on, including those that failed by a fault.
  [[nodiscard]] std::uint32_t rom_writes() const { return rom_writes_; }

 private:
  enum class Phase : std::uint8_t {
    boot,      ///< until wake_; `never`: dead
    run,       ///< with a node ID, or requesting one
    rom_write, ///< silent until wake_
  };

  /// Orders, each of which can be given in three ways: ExecuteOpcode, RestartNode, 1 written to
  /// 0x10-0x12.
  enum class Order : std::uint8_t { save, erase, restart };

  /// The end of the run after a response has left: an order, or a fault.
  struct Departure {
    enum class Kind : std::uint8_t { restart, save, fault };

    Time at;
    Kind kind = Kind::restart;
  };

  struct Answer {
    Time due;
    std::vector<can::Frame> frames;
  };

  // Life cycle (servo_life.cpp).
  [[nodiscard]] Duration boot_time();
  void wake(Time now);
  void start(Time now);
  void operate(dronecan::NodeId id, Time now);
  void depart(Time now);
  void end_rom_write(Time now);
  void restart(Time now, bool without_supply = false);
  void load_rom(Time now);
  void lose_power(Time now);
  void show_until_restart(std::int64_t warnings, std::int64_t failures, Time now);
  void broadcast(Time now);
  void obey(Order order, bool answered);
  void tell(ServoEvent::Kind kind) const;

  // Services (servo.cpp).
  void handle(const dronecan::Transfer& transfer);
  void hear_allocation(const dronecan::Transfer& transfer);
  void hear_commands(const dronecan::Transfer& transfer);
  void serve(const dronecan::Transfer& request);
  void serve_node_info(const dronecan::Transfer& request);
  void serve_get_set(const dronecan::Transfer& request);
  void serve_opcode(const dronecan::Transfer& request);
  void serve_restart(const dronecan::Transfer& request);
  void serve_order(Order order, const dronecan::Transfer& request, const dronecan::DataType& type,
                   const dronecan::Payload& done, const dronecan::Payload& refused);
  [[nodiscard]] static std::optional<Order> order_at(bla::Address address);
  [[nodiscard]] std::optional<bla::Address>
  addressed(const dronecan::GetSet::Request& request) const;
  [[nodiscard]] dronecan::Payload get_set_answer(const dronecan::GetSet::Request& request,
                                                 std::optional<std::int64_t> value) const;
  void answer(const dronecan::Transfer& request, const dronecan::DataType& type,
              const dronecan::Payload& payload);
  void send_answers(Time now);
  void send_message(const dronecan::DataType& type, dronecan::Priority priority,
                    const dronecan::Payload& payload);
  [[nodiscard]] dronecan::NodeStatus node_status(Time now);
  [[nodiscard]] dronecan::ActuatorStatus actuator_status(Time now);

  ServoSetup setup_; ///< its faults count down
  Random random_;
  Memory registers_;
  Motion motion_;
  Endpoint endpoint_;
  EventSink tell_;
  std::optional<Allocatee> allocatee_; ///< while it requests a node ID
  std::optional<Departure> departure_; ///< set from a request that ends the run
  std::uint32_t rom_writes_ = 0;
  std::uint32_t requests_ = 0; ///< of services, since power-on
  RequestCounter counter_;
  bool assigned_now_ = false; ///< no NodeStatus yet since an allocator assigned the ID
  bool rom_is_torn_ = false;  ///< power was lost during a write
  Phase phase_ = Phase::boot;
  Time wake_;    ///< the end of a phase other than `run`
  Time now_;     ///< of the present receive() or advance()
  Time started_; ///< the start of the run; uptime counts from here
  Time next_node_status_ = never;
  Time next_status_ = never;
  std::deque<Answer> answers_;
};

} // namespace blactl::sim
