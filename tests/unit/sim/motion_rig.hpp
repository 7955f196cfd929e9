#pragma once
// The shaft of one servo without a bus, and a hand on everything around it.

#include "blactl/sim/servo/motion.hpp"

#include "sim/servo/names.hpp"
#include "unit/sim/support.hpp"

#include <cstdlib>
#include <string>

namespace blactl::sim::testing {

/// A BLA21 that starts in place and holds without commands, or as `members` have it.
struct MotionRig {
  static constexpr const char* calm =
      R"("model": "BLA21-12U-AB", "rom": {"soft_start": "off", "timeout_action": "hold"})";

  explicit MotionRig(const std::string& members = calm)
      : setup(servo_setup(members)), registers(setup), motion(setup, registers, Time{}) {
    motion.start(now);
  }

  /// A calm one that has 0x25 on and is set up by more members.
  static std::string cascade(const std::string& more = "") {
    return std::string(calm) + R"(, "ram": {"speed_torque_control": "on"})" + more;
  }

  /// A calm one with more members.
  static std::string with(const std::string& more) { return std::string(calm) + ", " + more; }

  MotionRig(const MotionRig&) = delete;
  MotionRig& operator=(const MotionRig&) = delete;

  std::int64_t write(bla::Address address, std::int64_t value) {
    return motion.write(address, value, now).value_or(-1);
  }

  std::int64_t read(bla::Address address) { return motion.read(address, now).value_or(-1); }

  /// Looks once, at the end.
  void run(Duration duration) {
    now += duration;
    motion.look(now);
  }

  template <class Change> void around(Change change) {
    World world = motion.world();
    change(world);
    motion.surround(world, now);
  }

  void restart() {
    motion.stop(now);
    registers.restart();
    run(std::chrono::milliseconds(100));
    motion.start(now);
  }

  std::int64_t angle() { return read(address::current_angle); }

  std::int64_t rpm() { return read(address::current_speed); }

  std::int64_t torque() { return read(address::current_torque); }

  bool noticed(std::int64_t bits) { return (read(address::fault_notice) & bits) == bits; }

  /// Within the dead band and a little friction.
  bool stands_at(std::int64_t decideg) { return rpm() == 0 && std::abs(angle() - decideg) <= 5; }

  /// The shaft itself, CW of the horn notch.
  [[nodiscard]] std::int64_t shaft_decideg() const {
    return motion.shaft().angle / angle_per_decideg;
  }

  ServoSetup setup;
  Memory registers;
  Motion motion;
  Time now{};
};

} // namespace blactl::sim::testing
