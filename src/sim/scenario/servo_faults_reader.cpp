#include "sim/scenario/servo_faults_reader.hpp"

#include "sim/scenario/scenario_values.hpp"

#include <array>
#include <chrono>
#include <limits>
#include <string_view>
#include <utility>

namespace blactl::sim {
namespace {

constexpr std::chrono::seconds longest_delay(10);
constexpr std::chrono::seconds longest_absence(600);
constexpr std::int64_t max_count = std::numeric_limits<std::uint32_t>::max();

RestartAfterAnswer restart_after_answer(const json::Value& value, json::Faults& faults) {
  constexpr std::array kinds{
      std::pair{std::string_view("any"), RequestKind::any},
      std::pair{std::string_view("node_info"), RequestKind::node_info},
      std::pair{std::string_view("read"), RequestKind::read},
      std::pair{std::string_view("write"), RequestKind::write},
      std::pair{std::string_view("opcode"), RequestKind::opcode},
      std::pair{std::string_view("restart"), RequestKind::restart},
  };
  RestartAfterAnswer restart;
  json::Object object(value, faults);
  const auto word =
      object.optional_word("to", {"any", "node_info", "read", "write", "opcode", "restart"});
  for (const auto& [name, kind] : kinds) {
    restart.to = word == name ? kind : restart.to;
  }
  restart.number =
      static_cast<std::uint32_t>(object.optional_integer("number", 1, max_count).value_or(1));
  object.finish();
  return restart;
}

} // namespace

void read_servo_faults(json::Object object, ServoFaults& into, json::Faults& faults) {
  if (!object.exists()) {
    return;
  }
  const auto number = [&](std::string_view key) {
    return static_cast<std::uint32_t>(object.optional_integer(key, 0, max_count).value_or(0));
  };
  const auto flag = [&](std::string_view key) {
    return object.optional_boolean(key).value_or(false);
  };
  into.lose_responses = number("lose_responses");
  into.mute = flag("mute");
  into.no_node_status = flag("no_node_status");
  into.no_actuator_status = flag("no_actuator_status");
  into.lose_opcode_answers = number("lose_opcode_answers");
  into.ignore_opcodes = number("ignore_opcodes");
  into.refuse_opcodes = flag("refuse_opcodes");
  into.rom_write_fails = flag("rom_write_fails");
  into.stays = flag("stays");
  into.never_returns = flag("never_returns");
  into.restart_instead_of_answer = number("restart_instead_of_answer");
  for (const json::Value* item : object.optional_array("restart_after_answer")) {
    into.restart_after_answer.push_back(restart_after_answer(*item, faults));
  }
  constexpr Duration never_lost(-1);
  const Duration lost_after =
      read_duration(object, "power_loss_in_save", never_lost, longest_delay, faults);
  if (lost_after >= Duration::zero()) {
    into.power_loss_in_save = lost_after;
  }
  into.return_delay =
      read_duration(object, "return_delay", into.return_delay, longest_absence, faults);
  object.finish();
}

void read_sending(json::Object object, SendingFaults& into, json::Faults& faults) {
  if (!object.exists()) {
    return;
  }
  into.jitter = read_duration(object, "jitter", into.jitter, longest_delay, faults);
  into.late_answers = read_probability(object, "late_answers");
  into.late_by = read_duration(object, "late_by", into.late_by, longest_absence, faults);
  into.double_answers = read_probability(object, "double_answers");
  object.finish();
}

} // namespace blactl::sim
