#include "settings.hpp"

namespace blactl::campaign {

const std::map<std::string, Setting>& settings() {
  static const std::map<std::string, Setting> all{
      {"angle_limit_cw",
       {0x38, {{"90deg", 900}, {"45.5deg", 455}, {"120deg", 1200}, {"175.5deg", 1755}}}},
      {"angle_limit_ccw", {0x39, {{"-90deg", -900}, {"-10.1deg", -101}, {"-175.5deg", -1755}}}},
      {"smoothing", {0x22, {{"on", 1}, {"off", 0}}}},
      {"reverse", {0x23, {{"on", 1}, {"off", 0}}}},
      {"soft_start", {0x21, {{"on", 1}, {"off", 0}}}},
      {"timeout_time", {0x27, {{"500ms", 500}, {"1500ms", 1500}, {"2s", 2000}}}},
      {"timeout_action", {0x26, {{"hold", 0}, {"off", 1}, {"brake", 2}}}},
      {"torque_output", {0x20, {{"off", 1}, {"on", 0}}}}, // it counts upside down
      {"angle_dead_band", {0x2E, {{"0.1deg", 1}, {"0.5deg", 5}}}},
      {"angle_p_gain", {0x2C, {{"30", 30}, {"100", 100}}}},
  };
  return all;
}

} // namespace blactl::campaign
