#pragma once
// One servo of a scenario file.

#include "blactl/base/json_reader.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/sim/scenario/scenario.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace blactl::sim {

/// Reads the servos of a scenario one by one; errors go to the faults of the document.
class ServoReader {
 public:
  /// All must outlive this. `usual`: the defaults for "behaviour".
  ServoReader(const bla::Profiles& profiles, const Behaviour& usual, json::Faults& faults)
      : profiles_(profiles), usual_(usual), faults_(faults) {}

  /// See Scenario::warnings; for all servos so far.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  /// `index`: its place among the servos, from which the default serial number follows.
  [[nodiscard]] ServoSetup read(const json::Value& value, std::size_t index);

 private:
  using Values = std::vector<std::pair<bla::Address, std::int64_t>>;

  /// A value of 0x36 whose unit is right for one value of 0x37 only.
  struct InPwmMode {
    const json::Value* where;
    std::int64_t mode;
  };

  enum class Memory : std::uint8_t { ram, rom };

  [[nodiscard]] const bla::Profile* model(json::Object& object, const std::string& wanted);
  void check_firmware(json::Object& object, const std::string& label, const ServoSetup& servo);
  [[nodiscard]] Values registers(json::Object object, Memory memory, const ServoSetup& servo);
  [[nodiscard]] std::optional<std::int64_t> register_value(const json::Value& value,
                                                           const bla::Parameter& parameter);
  [[nodiscard]] const bla::Parameter* parameter(const json::Value& value, Memory memory,
                                                const bla::Profile& profile);
  void check_pwm_modes(std::int64_t actual);

  const bla::Profiles& profiles_;
  const Behaviour& usual_;
  json::Faults& faults_;
  std::vector<std::string> warnings_;
  std::vector<InPwmMode> in_pwm_mode_; ///< of the memory being read
};

} // namespace blactl::sim
