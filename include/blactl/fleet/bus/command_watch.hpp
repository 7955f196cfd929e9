#pragma once
// Requests and commands of other nodes to servos, as far as heard: motion commands, writes to
// settings, and whether the vehicle is armed.

#include "blactl/base/time.hpp"
#include "blactl/bla/address.hpp"
#include "blactl/dronecan/node.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/fleet/bus/array_command.hpp"
#include "blactl/fleet/bus/servo.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace blactl::fleet {

/// The time of a message that a node repeats. It counts for three of its periods, at least 2 s and
/// at most 10 s (contract, section 4).
class Repeated {
 public:
  static constexpr Duration least = std::chrono::seconds(2);
  static constexpr Duration most = std::chrono::seconds(10);

  /// `usual`: the time for which it counts while its period is unknown.
  void hear(Time at, Duration usual = least);

  /// The last time; meaningless before hear().
  [[nodiscard]] Time at() const { return at_; }

  [[nodiscard]] bool counts(Time now) const { return now - at_ <= lasts_; }

  /// The shortest time between two of them; empty: it was heard once.
  [[nodiscard]] std::optional<Duration> shortest_period() const { return shortest_; }

 private:
  Time at_{};
  Duration since_{}; ///< the period before: a message sent out of turn does not shorten it
  Duration lasts_{}; ///< zero: never heard
  std::optional<Duration> shortest_{};
};

/// Another node that commands servos: by ArrayCommand, or writes to 0x00-0x02.
struct Commander {
  /// The register that commands write, and the values heard since they began to write it.
  struct Asked {
    bla::Address reg; ///< 0x00, 0x01 or 0x02
    std::int64_t least = 0, greatest = 0;
  };

  /// The commands to one servo.
  struct Command {
    Repeated heard{};
    std::uint8_t type = 0;        ///< ArrayCommand::Command::command_type, of the last one
    std::optional<Asked> asked{}; ///< empty: the last one was not one that BLA servos take

    void ask(const std::optional<MotionCommand>& command);
  };

  dronecan::NodeId source;
  std::map<std::uint8_t, Command> servo_ids; ///< by ArrayCommand; 255: every servo
  std::map<dronecan::NodeId, Command> nodes; ///< by GetSet; `type` is not used
};

class CommandWatch {
 public:
  /// Takes every transfer of other nodes.
  void receive(const dronecan::Transfer& transfer);

  /// Takes every request of this node when it is sent: what it changes, another one may change
  /// back.
  void ask(const dronecan::Request& request, Time at);

  /// A unit begins to be there, or starts: what was repeated before is new to it.
  void begin(dronecan::NodeId id, Time at) { others_[id][std::nullopt].at = at; }

  [[nodiscard]] const std::map<dronecan::NodeId, Commander>& commanders() const {
    return commanders_;
  }

  /// A node whose last ArmingStatus reports that the vehicle is armed, however old.
  [[nodiscard]] std::optional<dronecan::NodeId> said_armed() const {
    return armed_.empty() ? std::nullopt : std::optional(armed_.begin()->first);
  }

  /// A node whose ArmingStatus reports that the vehicle is armed, and still counts.
  [[nodiscard]] std::optional<dronecan::NodeId> armed_by(Time now) const;

  /// Another servo than `except` to which another node wrote this value last, after `since`.
  [[nodiscard]] std::optional<dronecan::NodeId> giver_of(bla::Address reg, std::int64_t value,
                                                         dronecan::NodeId except, Time since) const;

  /// Another node that changed a setting of this one after `since`. ERASE changes all of them; a
  /// restart does not count, nor do motion commands (0x00-0x02), nor a value that is written again
  /// and again while nothing else is heard to change it. With `reg`: only this register.
  [[nodiscard]] std::optional<dronecan::NodeId>
  setter_of(dronecan::NodeId id, Time since, std::optional<bla::Address> reg = std::nullopt) const;

  /// Likewise, or one that ordered a restart, which puts RAM back to ROM.
  [[nodiscard]] std::optional<dronecan::NodeId>
  writer_to(dronecan::NodeId id, Time since, std::optional<bla::Address> reg = std::nullopt) const;

  /// What another node wrote to a setting.
  struct Written {
    bla::Address reg;
    std::int64_t raw;
    dronecan::NodeId source;
    Time at; ///< of the last that may have changed something
  };

  /// The settings of this node that others wrote by name or address after `since`, each once.
  [[nodiscard]] std::vector<Written> written_to(dronecan::NodeId id, Time since) const;

  /// Another node that ordered SAVE of this one after `since`.
  [[nodiscard]] std::optional<dronecan::NodeId> saver_of(dronecan::NodeId id, Time since) const;

  /// Another node that commanded this servo to move, by a command that `matters`. `actuator_id`:
  /// the servo ID of its actuator.Status.
  [[nodiscard]] std::optional<dronecan::NodeId>
  commander_of(const Servo& servo, std::optional<std::uint8_t> actuator_id,
               const std::function<bool(const Repeated&)>& matters) const;

  /// Another node whose ArrayCommand to this servo ID counts now, whoever has it.
  [[nodiscard]] std::optional<dronecan::NodeId> commander_of_id(std::int64_t servo_id,
                                                                Time now) const;

 private:
  struct Write {
    dronecan::NodeId source{};
    Time at{}; ///< of the last that may have changed something
  };

  /// The same value, written again and again.
  struct Repetition {
    dronecan::GetSet::Value value{};
    Time last{};
    int times = 0;
  };

  /// A register; empty: all of them.
  using Register = std::optional<bla::Address>;

  void on_command(const dronecan::Transfer& transfer);
  void on_arming(const dronecan::Transfer& transfer);
  void on_write(const dronecan::Transfer& transfer);
  void on_opcode(const dronecan::Transfer& transfer);
  void on_restart(const dronecan::Transfer& transfer);
  void write(const dronecan::Transfer& transfer, Register reg,
             const dronecan::GetSet::Value& value);
  using Writes = std::map<dronecan::NodeId, std::map<Register, Write>>; ///< by server
  [[nodiscard]] static Time last(const Writes& writes, dronecan::NodeId server, Register reg);
  [[nodiscard]] Time disturbed(dronecan::NodeId server, Register reg) const;
  Commander& commander(dronecan::NodeId source);

  std::map<dronecan::NodeId, Commander> commanders_;
  std::map<dronecan::NodeId, Repeated> armed_; ///< by nodes that reported it last
  Writes writes_;                              ///< to settings
  std::map<dronecan::NodeId, std::map<Register, Repetition>> repetitions_; ///< by server
  Writes others_; ///< whatever else may have changed registers: writes of this node, starts
  std::map<dronecan::NodeId, Write> saves_;    ///< by server
  std::map<dronecan::NodeId, Write> restarts_; ///< by server
};

} // namespace blactl::fleet
