#include "cli/output/faults_view.hpp"

#include "blactl/bla/explain.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/status_words.hpp"

#include "cli/output/node_head.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <vector>

namespace blactl::cli {

using bla::Fault;
using bla::Level;
using fleet::FaultState;

std::string level_word(Level level) {
  switch (level) {
  case Level::notice: return say<texts::level_notice>();
  case Level::warning: return say<texts::level_warning>();
  case Level::failure: break;
  }
  return say<texts::level_failure>();
}

namespace {

Tone tone(Level level) {
  return level == Level::notice ? Tone::good : level == Level::warning ? Tone::warning : Tone::bad;
}

std::string condition(const FaultState& servo, const Fault& fault) {
  const bla::Cause cause = bla::cause(fault, servo.snapshot.values());
  return std::string(choose(cause.condition_en, cause.condition_ja));
}

std::string action_text(const Fault& fault) {
  return fault.known != nullptr
             ? std::string(choose(fault.known->action_en, fault.known->action_ja))
             : say<texts::unknown_bit_action>();
}

/// "0x1A.8 temperature_high"
std::string place(const Fault& fault) {
  return fmt::format("{}.{}{}", fault.reg.name(), fault.bit,
                     fault.known != nullptr ? " " + fault.known->code : std::string());
}

bool is_latched(const Fault& fault) {
  return fault.known != nullptr && fault.known->latched;
}

/// "current_temperature 85 degC, temperature_limit_high 80 degC"
std::string values_text(const FaultState& servo, const Fault& fault) {
  std::string out;
  for (const fleet::Reading& reading : servo.values_of(fault)) {
    out += out.empty() ? "" : ", ";
    out += reading.parameter->name + ' ' + bla::display(*reading.parameter, *reading.raw);
  }
  return out;
}

/// Whether one of the values is measured; for PWM pulses only the target is known.
bool has_measured(const FaultState& servo, const Fault& fault) {
  return std::ranges::any_of(servo.values_of(fault), [](const fleet::Reading& reading) {
    return !reading.parameter->writable();
  });
}

std::string fault_text(const FaultState& servo, const Fault& fault, const Page& page) {
  std::string out = "  " + fault_line(fault, page) + '\n';
  const auto line = [&](const std::string& text) {
    out += text.empty() ? "" : "      " + text + '\n';
  };
  line(condition(servo, fault));
  if (const auto values = values_text(servo, fault); !values.empty()) {
    line(has_measured(servo, fault) ? say<texts::fault_now>(values)
                                    : say<texts::fault_settings>(values));
  }
  line(bla::holds_output_off(fault, servo.snapshot.values()).value_or(false)
           ? say<texts::fault_output_off>()
           : std::string());
  line(is_latched(fault) ? say<texts::fault_latched>() : std::string());
  line(action_text(fault));
  return out;
}

std::string servo_text(const FaultState& servo, Level level, const Page& page) {
  std::string out = head_line(servo.snapshot.servo);
  if (!servo.errors.empty()) {
    out += "  " +
           page.paint(Tone::bad, servo.faults.empty() ? say<texts::faults_unknown>()
                                                      : say<texts::faults_of_before>()) +
           '\n';
  }
  std::size_t hidden = 0;
  for (const Fault& fault : servo.faults) {
    fault.level >= level ? out += fault_text(servo, fault, page) : std::string();
    hidden += static_cast<std::size_t>(fault.level < level);
  }
  if (const auto worse = servo.unexplained_health()) {
    out += "  " +
           page.paint(tone(*worse),
                      say<texts::health_unexplained>(fleet::health_word(*servo.health))) +
           '\n';
  } else if (servo.faults.empty() && servo.errors.empty()) {
    out += "  " + page.paint(Tone::good, say<texts::no_faults>()) + '\n';
  } else if (hidden > 0) {
    out += "  " + say<texts::faults_hidden>(hidden, level_word(level)) + '\n';
  }
  return out;
}

void write_registers(JsonWriter& json, const FaultState& servo) {
  json.key("registers");
  json.begin_object();
  for (const bla::Address reg : bla::all_fault_registers) {
    json.member(reg.name(), servo.fault_register(reg));
  }
  json.end_object();
}

} // namespace

void write_fault(JsonWriter& json, const FaultState& servo, const Fault& fault) {
  json.member("register", fault.reg.name());
  json.member("bit", fault.bit);
  json.member("level", bla::name(fault.level));
  json.member("group", fault.group);
  json.member("code", fault.known != nullptr ? std::optional(fault.known->code) : std::nullopt);
  json.member("latched", is_latched(fault));
  json.member("text", bla::bit_title(fault.known));
  json.member("condition", condition(servo, fault));
  json.member("action", action_text(fault));
  json.key("values");
  json.begin_object();
  for (const fleet::Reading& reading : servo.values_of(fault)) {
    json.key(reading.parameter->name);
    json.number(bla::value_text(*reading.parameter, *reading.raw));
  }
  json.end_object();
  json.member("output_off", bla::holds_output_off(fault, servo.snapshot.values()));
}

std::string fault_line(const Fault& fault, const Page& page) {
  return fmt::format("{}  {}  [{}]", page.paint(tone(fault.level), level_word(fault.level)),
                     bla::bit_title(fault.known), place(fault));
}

void write_json(JsonWriter& json, std::span<const FaultState> servos, Level level) {
  json.objects("nodes", servos, [&](const FaultState& servo) {
    write_head(json, servo.snapshot.servo);
    json.member("health", servo.health ? std::optional(name(*servo.health)) : std::nullopt);
    write_registers(json, servo);
    json.array("active", servo.faults, [&](const Fault& fault) {
      if (fault.level >= level) {
        json.begin_object();
        write_fault(json, servo, fault);
        json.end_object();
      }
    });
  });
}

std::string text(std::span<const FaultState> servos, Level level, const Page& page) {
  std::vector<const FaultState*> order;
  for (const FaultState& servo : servos) {
    order.push_back(&servo);
  }
  std::ranges::stable_sort(order, [](const FaultState* a, const FaultState* b) {
    return a->worst() > b->worst(); // empty is the least
  });
  std::string out;
  for (const FaultState* servo : order) {
    out += (out.empty() ? "" : "\n") + servo_text(*servo, level, page);
  }
  return page.fit(out);
}

} // namespace blactl::cli
