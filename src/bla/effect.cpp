#include "blactl/bla/effect.hpp"

namespace blactl::bla {

namespace at = address;

RestartMotion restart_motion(const Values& configuration) {
  const auto may_be = [&](Address address, std::int64_t raw) {
    return find(configuration, address).value_or(raw) == raw;
  };
  constexpr std::int64_t torque_on = 0; // 0x20 counts upside down (4.13)
  constexpr std::int64_t soft_start_on = 1;
  if (!may_be(at::torque_output, torque_on)) {
    return RestartMotion::none;
  }
  return may_be(at::soft_start, soft_start_on) ? RestartMotion::soft : RestartMotion::hard;
}

} // namespace blactl::bla
