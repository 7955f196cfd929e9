#pragma once
// What is found of a servo on the way from the command to the shaft.

#include "blactl/fleet/doctor/motion.hpp"

#include "fleet/doctor/motion_facts.hpp"

#include <string>
#include <utility>

namespace blactl::fleet {

/// Whether a finding about a servo shows that it cannot follow a command, or help who asks about
/// it.
enum class Weight : std::uint8_t { obstacle, remark };

class MotionFindings {
 public:
  MotionFindings(dronecan::NodeId servo, MotionLook look) : servo_(servo), look_(look) {}

  void add(std::string code, bla::Level level, Weight weight, std::string text, std::string fix) {
    if (look_ == MotionLook::named || weight == Weight::obstacle) {
      found_.push_back({std::move(code), level, servo_, std::move(text), std::move(fix)});
    }
  }

  [[nodiscard]] Diagnoses take() { return std::move(found_); }

 private:
  dronecan::NodeId servo_;
  MotionLook look_;
  Diagnoses found_;
};

/// Who commands it, how often, and what it makes of that.
void find_in_commands(const MotionFacts& facts, MotionFindings& found);

/// What holds its output off, and its limits.
void find_in_output(const MotionFacts& facts, MotionFindings& found);

} // namespace blactl::fleet
