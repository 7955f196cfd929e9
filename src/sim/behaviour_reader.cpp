#include "sim/behaviour_reader.hpp"

#include "sim/scenario_values.hpp"

#include <chrono>
#include <string_view>
#include <utility>

namespace blactl::sim {
namespace {

constexpr std::chrono::seconds longest_rom_write(10);

/// A word of the file and what it stands for.
template <class Choice> using Word = std::pair<std::string_view, Choice>;

} // namespace

void read_behaviour(json::Object object, Behaviour& into, json::Faults& faults) {
  if (!object.exists()) {
    return;
  }
  const auto flag = [&](std::string_view key, bool fallback) {
    return object.optional_boolean(key).value_or(fallback);
  };
  const auto choice = [&]<class Choice>(std::string_view key, Choice fallback, Word<Choice> one,
                                        Word<Choice> other) {
    const auto word = object.optional_word(key, {one.first, other.first});
    return !word ? fallback : *word == one.first ? one.second : other.second;
  };
  const auto reads = [&](std::string_view key, MissingRead fallback) {
    return choice(key, fallback, Word<MissingRead>{"fail", MissingRead::fail},
                  Word<MissingRead>{"zero", MissingRead::zero});
  };
  into.out_of_range =
      choice("out_of_range", into.out_of_range, Word<OutOfRange>{"refuse", OutOfRange::refuse},
             Word<OutOfRange>{"clamp", OutOfRange::clamp});
  into.reserved_reads = reads("reserved_reads", into.reserved_reads);
  into.gated_reads = reads("gated_reads", into.gated_reads);
  into.write_only_reads = reads("write_only_reads", into.write_only_reads);
  into.index_only_access = flag("index_only_access", into.index_only_access);
  into.failure_with_name = flag("failure_with_name", into.failure_with_name);
  into.ignores_disabled_commands =
      flag("ignores_disabled_commands", into.ignores_disabled_commands);
  into.answers_save_first = flag("answers_save_first", into.answers_save_first);
  into.array_command_feeds_timeout =
      flag("array_command_feeds_timeout", into.array_command_feeds_timeout);
  into.get_set_feeds_timeout = flag("get_set_feeds_timeout", into.get_set_feeds_timeout);
  into.inclusive_limits = flag("inclusive_limits", into.inclusive_limits);
  into.failures_latch = flag("failures_latch", into.failures_latch);
  into.notices_warn = flag("notices_warn", into.notices_warn);
  into.pwm_end_points_move = flag("pwm_end_points_move", into.pwm_end_points_move);
  into.soft_start_shows = flag("soft_start_shows", into.soft_start_shows);
  into.not_a_number =
      choice("not_a_number", into.not_a_number, Word<NotANumber>{"ignore", NotANumber::ignore},
             Word<NotANumber>{"zero", NotANumber::zero});
  into.unused_fields = choice("unused_fields", into.unused_fields,
                              Word<UnusedFields>{"unknown", UnusedFields::unknown},
                              Word<UnusedFields>{"zero", UnusedFields::zero});
  into.slow_speed =
      choice("slow_speed", into.slow_speed, Word<SlowSpeed>{"stands", SlowSpeed::stands},
             Word<SlowSpeed>{"turns_slowest", SlowSpeed::turns_slowest});
  into.rom_write_time =
      read_duration(object, "rom_write_time", into.rom_write_time, longest_rom_write, faults);
  object.finish();
}

} // namespace blactl::sim
