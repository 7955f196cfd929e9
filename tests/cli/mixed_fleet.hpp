#pragma once
// Servos of every model side by side, and a fleet file that leaves nothing of them as it was.
//
//     MixedFleet fleet(64);
//     CHECK(fleet.run({"apply", fleet.file(fleet.changed()), "-y"}).status == 0);
//     CHECK(fleet.look().at(1).at("rom").at("0x38") == 900);

#include "run.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::test {

class MixedFleet {
 public:
  /// Serial number, node ID and servo ID of each are 1, 2, …
  explicit MixedFleet(int servos);

  /// Runs the binary on their bus, whose clock is virtual: they live on.
  [[nodiscard]] Result run(Arguments arguments) const;

  /// Every parameter of each has another value than from the factory, within its range and as
  /// the others of the servo permit. Neighbours exchange their static node IDs, the servo IDs go
  /// round.
  [[nodiscard]] nlohmann::ordered_json changed() const;

  [[nodiscard]] std::string file(const nlohmann::ordered_json& document) const;

  /// A file of this name in the folder of the test.
  [[nodiscard]] std::string path(std::string_view name) const;

  /// What the simulator tells of a servo, by serial number: "ram", "rom" by address, and how often
  /// ROM was written.
  using States = std::map<int, nlohmann::json>;

  /// The simulator's own view of their memories.
  [[nodiscard]] States look();

  /// How often this event has happened to any of them between the last two looks.
  [[nodiscard]] std::ptrdiff_t happened(std::string_view event) const;

  /// All of them lose their supply, get it back, and run for some seconds.
  void cycle_power();

 private:
  [[nodiscard]] std::string scenario() const;
  [[nodiscard]] const nlohmann::json& parameters(int serial) const;
  void set_voltage(std::string_view voltage);

  int servos_;
  Bench bench_;
  std::vector<std::string> models_;
  std::map<std::string, nlohmann::json> parameters_; ///< of `models --json`, by model
  Background sim_;
  std::vector<nlohmann::json> events_;
};

/// The raw number that a value of changed() stands for.
[[nodiscard]] std::int64_t raw(const nlohmann::ordered_json& value);

} // namespace blactl::test
