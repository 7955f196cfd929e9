#pragma once
// One run of `blactl command`: proof, question, motion, end.

#include "blactl/fleet/motion/motion_run.hpp"

#include "cli/change/writing_run.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace blactl::cli {

/// Each step may end it, with errors in the report.
class MotionRun : WritingRun {
 public:
  /// `svg`: the file for the drawing; empty: none.
  MotionRun(fleet::CommandWanted wanted, std::string svg, Context& context, Report& report);

  void all();

 private:
  [[nodiscard]] bool select();
  [[nodiscard]] bool plan();
  [[nodiscard]] bool prove_servo_id();
  [[nodiscard]] bool check();
  [[nodiscard]] bool confirm();
  void move();
  [[nodiscard]] bool show(const fleet::MotionSample& sample);
  bool print(const std::string& lines);
  void conclude(const fleet::Commanded& commanded);
  void draw(const fleet::MotionResult& result);

  fleet::CommandWanted wanted_;
  std::string svg_;
  dronecan::NodeId id_{};
  std::optional<fleet::MotionPlan> plan_;
  std::uint64_t samples_ = 0;
  Time shown_at_{};
  std::string unread_; ///< lines waiting for room on stdout
  bool has_reader_ = true;
};

} // namespace blactl::cli
