#pragma once
// Requests and commands of other nodes to servos, as far as heard: motion commands, writes to
// settings, and whether the vehicle is armed.

#include "blactl/base/time.hpp"
#include "blactl/bla/address.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/fleet/bus/servo.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <set>

namespace blactl::fleet {

/// Another node that commands servos: by ArrayCommand, or writes to 0x00-0x02.
struct Commander {
  /// The last command to one servo ID.
  struct Command {
    Time at{};
    std::uint8_t type = 0; ///< ArrayCommand::Command::command_type
  };

  dronecan::NodeId source;
  std::map<std::uint8_t, Command> servo_ids; ///< by ArrayCommand; 255: all servos
  std::map<dronecan::NodeId, Time> nodes;    ///< by GetSet
};

class CommandWatch {
 public:
  /// Takes every transfer of other nodes.
  void receive(const dronecan::Transfer& transfer);

  [[nodiscard]] const std::map<dronecan::NodeId, Commander>& commanders() const {
    return commanders_;
  }

  /// A node whose last ArmingStatus reports that the vehicle is armed.
  [[nodiscard]] std::optional<dronecan::NodeId> armed_by() const {
    return armed_.empty() ? std::nullopt : std::optional(*armed_.begin());
  }

  /// Another node that changed a setting of this one after `since`. Motion commands (0x00-0x02) are
  /// not settings. With `reg`: this register, or all at once.
  [[nodiscard]] std::optional<dronecan::NodeId>
  writer_to(dronecan::NodeId id, Time since, std::optional<bla::Address> reg = std::nullopt) const;

  /// Another node that commanded this servo to move after `since`. `actuator_id`: the servo ID of
  /// its actuator.Status.
  [[nodiscard]] std::optional<dronecan::NodeId>
  commander_of(const Servo& servo, std::optional<std::uint8_t> actuator_id, Time since) const;

 private:
  struct Write {
    dronecan::NodeId source{};
    Time at{};
  };

  void on_command(const dronecan::Transfer& transfer);
  void on_arming(const dronecan::Transfer& transfer);
  void on_write(const dronecan::Transfer& transfer);
  void on_opcode(const dronecan::Transfer& transfer);
  Commander& commander(dronecan::NodeId source);

  std::map<dronecan::NodeId, Commander> commanders_;
  std::set<dronecan::NodeId> armed_;
  /// The last writes to settings, by server and register; empty: to all registers.
  std::map<dronecan::NodeId, std::map<std::optional<bla::Address>, Write>> writes_;
};

} // namespace blactl::fleet
