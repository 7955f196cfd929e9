#include "sim/scenario/behaviour_reader.hpp"

#include "sim/scenario/scenario_values.hpp"

#include <chrono>
#include <string_view>
#include <type_traits>
#include <utility>

namespace blactl::sim {
namespace {

constexpr std::chrono::seconds longest_rom_write(10);
constexpr std::chrono::seconds longest_until_first_status(1);
constexpr std::chrono::seconds longest_usual_delay(10);
constexpr std::chrono::seconds longest_boot(10);

/// Reads keys into members; members without a key stay unchanged.
class Reader {
 public:
  explicit Reader(json::Object& object) : object_(object) {}

  void flag(std::string_view key, bool& into) {
    into = object_.optional_boolean(key).value_or(into);
  }

  /// A word and its meaning.
  template <class Choice> using Word = std::pair<std::string_view, Choice>;

  template <class Choice>
  void choice(std::string_view key, Choice& into, const Word<std::type_identity_t<Choice>>& one,
              const Word<std::type_identity_t<Choice>>& other) {
    if (const auto word = object_.optional_word(key, {one.first, other.first})) {
      into = *word == other.first ? other.second : one.second;
    }
  }

  template <class Choice>
  void choice(std::string_view key, Choice& into, const Word<std::type_identity_t<Choice>>& one,
              const Word<std::type_identity_t<Choice>>& other,
              const Word<std::type_identity_t<Choice>>& third) {
    if (const auto word = object_.optional_word(key, {one.first, other.first, third.first})) {
      into = *word == third.first ? third.second : *word == other.first ? other.second : one.second;
    }
  }

  void reads(std::string_view key, MissingRead& into) {
    choice(key, into, {"fail", MissingRead::fail}, {"zero", MissingRead::zero});
  }

 private:
  json::Object& object_;
};

void read_commands(Reader reader, Behaviour& into) {
  reader.flag("array_command_shows", into.array_command_shows);
  reader.flag("array_command_feeds_timeout", into.array_command_feeds_timeout);
  reader.flag("get_set_feeds_timeout", into.get_set_feeds_timeout);
  reader.flag("notices_warn", into.notices_warn);
  reader.flag("assignment_shows", into.assignment_shows);
  reader.flag("timeout_beats_brake", into.timeout_beats_brake);
  reader.flag("keeps_disabled_command", into.keeps_disabled_command);
  reader.flag("keeps_limited_angle", into.keeps_limited_angle);
  reader.flag("erase_holds", into.erase_holds);
  reader.flag("speed_control_before_1100", into.speed_control_before_1100);
  reader.choice("not_a_number", into.not_a_number, {"ignore", NotANumber::ignore},
                {"zero", NotANumber::zero});
  reader.choice("beyond_unitless", into.beyond_unitless, {"limits", BeyondUnitless::limits},
                {"clamp", BeyondUnitless::clamp}, {"ignore", BeyondUnitless::ignore});
  reader.choice("unused_fields", into.unused_fields, {"unknown", UnusedFields::unknown},
                {"zero", UnusedFields::zero});
  reader.choice("slow_speed", into.slow_speed, {"stands", SlowSpeed::stands},
                {"turns_slowest", SlowSpeed::turns_slowest});
  reader.choice("start_angle", into.start_angle, {"present", StartAngle::present},
                {"zero", StartAngle::zero});
}

void read_motion(Reader reader, Behaviour& into) {
  reader.flag("inclusive_limits", into.inclusive_limits);
  reader.flag("inclusive_stops", into.inclusive_stops);
  reader.flag("failures_latch", into.failures_latch);
  reader.flag("restart_bits_stop", into.restart_bits_stop);
  reader.flag("pwm_end_points_move", into.pwm_end_points_move);
  reader.flag("pwm_waits_after_start", into.pwm_waits_after_start);
  reader.flag("pwm_yields_to_all", into.pwm_yields_to_all);
  reader.flag("boost_in_dead_band", into.boost_in_dead_band);
  reader.flag("soft_start_shows", into.soft_start_shows);
  reader.flag("soft_start_resumes", into.soft_start_resumes);
}

} // namespace

void read_behaviour(json::Object object, Behaviour& into, json::Faults& faults) {
  if (!object.exists()) {
    return;
  }
  Reader reader(object);
  reader.choice("out_of_range", into.out_of_range, {"refuse", OutOfRange::refuse},
                {"clamp", OutOfRange::clamp}, {"fail", OutOfRange::fail});
  reader.reads("reserved_reads", into.reserved_reads);
  reader.reads("gated_reads", into.gated_reads);
  reader.reads("write_only_reads", into.write_only_reads);
  reader.flag("index_only_access", into.index_only_access);
  reader.flag("failure_with_name", into.failure_with_name);
  reader.flag("ignores_disabled_commands", into.ignores_disabled_commands);
  reader.flag("answers_save_first", into.answers_save_first);
  into.rom_write_time =
      read_duration(object, "rom_write_time", into.rom_write_time, longest_rom_write, faults);
  into.first_node_status = read_duration(object, "first_node_status", into.first_node_status,
                                         longest_until_first_status, faults);
  into.answer_delay =
      read_duration(object, "answer_delay", into.answer_delay, longest_usual_delay, faults);
  const bool has_boot_time = object.has("boot_time");
  const Duration boot_time = read_duration(object, "boot_time", {}, longest_boot, faults);
  into.boot_time = has_boot_time ? std::optional(boot_time) : into.boot_time;
  read_commands(reader, into);
  read_motion(reader, into);
  object.finish();
}

} // namespace blactl::sim
