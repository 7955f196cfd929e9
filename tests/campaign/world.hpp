#pragma once
// Simulated servos that live on from one command to the next, and commands that run in this
// process: from their arguments to their exit status.

#include "blactl/can/bus.hpp"
#include "blactl/sim/bus/simulator.hpp"
#include "blactl/sim/servo/event.hpp"

#include "disturbance.hpp"
#include "record.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::campaign {

inline constexpr std::uint8_t servo_id = 0x45, static_node_id = 0x46;

using Registers = std::map<std::uint8_t, std::int64_t>;

/// A command line.
struct Command {
  std::vector<std::string> words;
  nlohmann::json fleet{};  ///< the fleet file that words[1] names; null: none
  std::int64_t broken = 0; ///< replace: the serial number that the file has at first
  bool is_right = false;   ///< no servo has a reason to refuse it, and it changes no ID

  [[nodiscard]] const std::string& verb() const { return words.front(); }

  [[nodiscard]] bool has(std::string_view word) const;
  [[nodiscard]] std::string text() const;

  /// The fleet file; of `replace` before its end, or after.
  [[nodiscard]] std::string file(bool has_ended) const;
};

struct Outcome {
  int status = 0;
  std::string out, err;
  std::string file;        ///< the fleet file afterwards
  nlohmann::json document; ///< what it printed as JSON; of a stream the last line; null: none
  Record record;
};

/// A servo at one moment.
struct ServoState {
  std::string unique_id; ///< hexadecimal
  std::uint8_t node_id = 0;
  Registers ram, rom;
  std::uint32_t rom_writes = 0; ///< since power-on
  bool is_powered = true;

  /// 0x1A bit 15: its ROM could not be read at its start, so RAM has initial values.
  [[nodiscard]] bool has_lost_rom() const;
};

/// By serial number.
using States = std::map<std::int64_t, ServoState>;

class World {
 public:
  /// `folder`: for state and fleet files; it exists, and is this world's alone.
  World(const nlohmann::json& scenario, std::filesystem::path folder);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Puts one bus around another.
  using Around = std::function<std::unique_ptr<can::Bus>(std::unique_ptr<can::Bus>)>;

  /// Runs a command to its end, with --json. `disturbances`: of it; one at most is not of frames.
  /// `around`: who else looks on, if anybody does.
  [[nodiscard]] Outcome run(const Command& command, std::span<Disturbance> disturbances = {},
                            const Around& around = {});

  /// Lets time pass: what was sent before a command broke off happens all the same.
  void pass(Duration time);

  /// All is switched off, and on again without anything that goes wrong: but for `events`, if
  /// there are any.
  void repair(const nlohmann::json& events = {});

  [[nodiscard]] States states();

  /// What happened in the servos since the last call.
  [[nodiscard]] std::vector<sim::ServoEvent> take_events();

  [[nodiscard]] Time now() const;

 private:
  void write_file(const Command& command) const;
  void power_on(const nlohmann::json& scenario, Time at);
  [[nodiscard]] static ServoState state_of(const sim::Servo& servo);
  [[nodiscard]] static nlohmann::json rom_of(const sim::Servo& servo);

  nlohmann::json scenario_;
  std::filesystem::path folder_;
  std::shared_ptr<sim::Simulator> simulator_;
  std::vector<sim::ServoEvent> events_;
};

} // namespace blactl::campaign
