#pragma once
// The condition of each cross-check; cross_check.cpp has their table.

#include "blactl/bla/cross_check.hpp"

namespace blactl::bla {

// Refusals and warnings require known values; questions assume the worst of unknown ones.
[[nodiscard]] bool meets_control_off(const Proposal& change);
[[nodiscard]] bool meets_no_stop(const Proposal& change);
[[nodiscard]] bool meets_reversed_limits(const Proposal& change);
[[nodiscard]] bool meets_soft_start(const Proposal& change);
[[nodiscard]] bool meets_pulled_back(const Proposal& change);
[[nodiscard]] bool meets_let_go_on(const Proposal& change);
[[nodiscard]] bool meets_no_torque(const Proposal& change);
[[nodiscard]] bool meets_no_torque_later(const Proposal& change);
[[nodiscard]] bool meets_trips(const Proposal& change);
[[nodiscard]] bool meets_protection_ends(const Proposal& change);
[[nodiscard]] bool meets_pwm_present(const Proposal& change);
[[nodiscard]] bool meets_limits_without_effect(const Proposal& change);
[[nodiscard]] bool meets_pwm_cut_off(const Proposal& change);
[[nodiscard]] bool meets_pwm_speed_limited(const Proposal& change);
[[nodiscard]] bool meets_pwm_without_control(const Proposal& change);
[[nodiscard]] bool meets_no_motion(const Proposal& change);
[[nodiscard]] bool meets_negative_pulse(const Proposal& change);
[[nodiscard]] bool meets_zero(const Proposal& change);
[[nodiscard]] bool meets_near_supply(const Proposal& change);
[[nodiscard]] bool meets_short_timeout(const Proposal& change);
[[nodiscard]] bool meets_not_default(const Proposal& change);
[[nodiscard]] bool meets_hard_start(const Proposal& change);
[[nodiscard]] bool meets_stall(const Proposal& change);

} // namespace blactl::bla
