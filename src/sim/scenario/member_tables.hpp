#pragma once
// The objects of a scenario whose keys are the members of a struct: "behaviour", "faults",
// "sending" and "wire".

#include "blactl/sim/node/delayed_device.hpp"
#include "blactl/sim/scenario/wire_faults.hpp"
#include "blactl/sim/servo/behaviour.hpp"
#include "blactl/sim/servo/servo_faults.hpp"

#include "sim/scenario/member.hpp"

#include <cstdint>
#include <limits>
#include <string_view>

namespace blactl::sim {

inline constexpr std::int64_t longest_delay = 10, longest_absence = 600,
                              longest_between_bursts = 3600; // s

inline constexpr Member<Behaviour> behaviour_members[]{
    {"out_of_range", word<&Behaviour::out_of_range, "refuse", "clamp", "fail">},
    {"reserved_reads", word<&Behaviour::reserved_reads, "fail", "zero">},
    {"gated_reads", word<&Behaviour::gated_reads, "fail", "zero">},
    {"write_only_reads", word<&Behaviour::write_only_reads, "fail", "zero">},
    {"index_only_access", to<&Behaviour::index_only_access>},
    {"failure_with_name", to<&Behaviour::failure_with_name>},
    {"ignores_disabled_commands", to<&Behaviour::ignores_disabled_commands>},
    {"answers_save_first", to<&Behaviour::answers_save_first>},
    {"array_command_shows", to<&Behaviour::array_command_shows>},
    {"start_angle", word<&Behaviour::start_angle, "present", "zero">},
    {"unused_fields", word<&Behaviour::unused_fields, "unknown", "zero">},
    {"notices_warn", to<&Behaviour::notices_warn>},
    {"assignment_shows", to<&Behaviour::assignment_shows>},
    {"first_node_status", up_to_seconds<&Behaviour::first_node_status, 1>},
    {"not_a_number", word<&Behaviour::not_a_number, "ignore", "zero">},
    {"beyond_unitless", word<&Behaviour::beyond_unitless, "limits", "clamp", "ignore">},
    {"array_out_of_range", word<&Behaviour::array_out_of_range, "ignore", "clamp">},
    {"obeys_servo_id_0", to<&Behaviour::obeys_servo_id_0>},
    {"slow_speed", word<&Behaviour::slow_speed, "stands", "turns_slowest">},
    {"array_command_feeds_timeout", to<&Behaviour::array_command_feeds_timeout>},
    {"get_set_feeds_timeout", to<&Behaviour::get_set_feeds_timeout>},
    {"timeout_beats_brake", to<&Behaviour::timeout_beats_brake>},
    {"keeps_disabled_command", to<&Behaviour::keeps_disabled_command>},
    {"keeps_limited_angle", to<&Behaviour::keeps_limited_angle>},
    {"erase_holds", to<&Behaviour::erase_holds>},
    {"erase_clears_rom", to<&Behaviour::erase_clears_rom>},
    {"settings_wait_for_start", to<&Behaviour::settings_wait_for_start>},
    {"reverse_turns_origin", to<&Behaviour::reverse_turns_origin>},
    {"speed_control_before_1100", to<&Behaviour::speed_control_before_1100>},
    {"inclusive_limits", to<&Behaviour::inclusive_limits>},
    {"inclusive_stops", to<&Behaviour::inclusive_stops>},
    {"failures_latch", to<&Behaviour::failures_latch>},
    {"restart_keeps_failures", to<&Behaviour::restart_keeps_failures>},
    {"command_at_limit_notifies", to<&Behaviour::command_at_limit_notifies>},
    {"restart_bits_stop", to<&Behaviour::restart_bits_stop>},
    {"boost_in_dead_band", to<&Behaviour::boost_in_dead_band>},
    {"pwm_end_points_move", to<&Behaviour::pwm_end_points_move>},
    {"pwm_waits_after_start", to<&Behaviour::pwm_waits_after_start>},
    {"pwm_yields_to_all", to<&Behaviour::pwm_yields_to_all>},
    {"soft_start_shows", to<&Behaviour::soft_start_shows>},
    {"soft_start_keeps_speed", to<&Behaviour::soft_start_keeps_speed>},
    {"output_write_ends_soft_start", to<&Behaviour::output_write_ends_soft_start>},
    {"soft_start_resumes", to<&Behaviour::soft_start_resumes>},
    {"rom_write_time", up_to_seconds<&Behaviour::rom_write_time, longest_delay>},
    {"answer_delay", up_to_seconds<&Behaviour::answer_delay, longest_delay>},
    {"boot_time", up_to_seconds<&Behaviour::boot_time, longest_delay>},
};

inline constexpr Member<RestartAfterAnswer> restart_members[]{
    {"to", word<&RestartAfterAnswer::to, "any", "node_info", "read", "write", "opcode", "restart">},
    {"number", integer<&RestartAfterAnswer::number, 1, std::numeric_limits<std::uint32_t>::max()>},
};

inline void read_restarts(json::Object& object, std::string_view key, ServoFaults& into,
                          json::Faults& faults) {
  for (const json::Value* item : object.optional_array(key)) {
    read_whole(json::Object(*item, faults), restart_members,
               into.restart_after_answer.emplace_back(), faults);
  }
}

inline constexpr Member<ServoFaults> servo_fault_members[]{
    {"lose_responses", to<&ServoFaults::lose_responses>},
    {"mute", to<&ServoFaults::mute>},
    {"no_node_status", to<&ServoFaults::no_node_status>},
    {"no_actuator_status", to<&ServoFaults::no_actuator_status>},
    {"lose_opcode_answers", to<&ServoFaults::lose_opcode_answers>},
    {"ignore_opcodes", to<&ServoFaults::ignore_opcodes>},
    {"refuse_opcodes", to<&ServoFaults::refuse_opcodes>},
    {"deny_opcodes", to<&ServoFaults::deny_opcodes>},
    {"rom_write_fails", to<&ServoFaults::rom_write_fails>},
    {"stays", to<&ServoFaults::stays>},
    {"never_returns", to<&ServoFaults::never_returns>},
    {"rom_unread_starts", to<&ServoFaults::rom_unread_starts>},
    {"restart_instead_of_answer", to<&ServoFaults::restart_instead_of_answer>},
    {"restart_after_answer", read_restarts},
    {"power_loss_in_save", up_to_seconds<&ServoFaults::power_loss_in_save, longest_delay>},
    {"return_delay", up_to_seconds<&ServoFaults::return_delay, longest_absence>},
};

inline constexpr Member<SendingFaults> sending_members[]{
    {"jitter", up_to_seconds<&SendingFaults::jitter, longest_delay>},
    {"late_answers", number<&SendingFaults::late_answers, 0, 1>},
    {"late_by", up_to_seconds<&SendingFaults::late_by, longest_absence>},
    {"double_answers", number<&SendingFaults::double_answers, 0, 1>},
};

inline constexpr Member<WireFaults> wire_members[]{
    {"loss", number<&WireFaults::loss, 0, 1>},
    {"duplication", number<&WireFaults::duplication, 0, 1>},
    {"errors", number<&WireFaults::errors, 0, 1>},
    {"bit_flips", number<&WireFaults::bit_flips, 0, 1>},
    {"burst_interval", up_to_seconds<&WireFaults::burst_interval, longest_between_bursts>},
    {"burst_length", up_to_seconds<&WireFaults::burst_length, longest_between_bursts>},
};

} // namespace blactl::sim
