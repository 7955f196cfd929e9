#include "cli/output/pwm_view.hpp"

#include "cli/output/table.hpp"
#include "cli/pwm_texts.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace blactl::cli {

using bla::PwmInput;
using bla::PwmMapping;

namespace {

constexpr std::int64_t tenths = 10;

/// A command in the unit of the mode: "-70.0", "150".
std::string number(const PwmMapping& mapping, std::int64_t command) {
  if (!mapping.is_angle()) {
    return std::to_string(command);
  }
  const std::int64_t size = std::abs(command);
  return fmt::format("{}{}.{}", command < 0 ? "-" : "", size / tenths, size % tenths);
}

std::string_view unit(const PwmMapping& mapping) {
  return mapping.is_angle() ? "deg" : "rpm";
}

std::string input_text(PwmInput input) {
  switch (input) {
  case PwmInput::ok: return say<texts::pwm_input_ok>();
  case PwmInput::none: return say<texts::pwm_input_none>();
  case PwmInput::too_short: return say<texts::pwm_input_short>();
  case PwmInput::too_long: break;
  }
  return say<texts::pwm_input_long>();
}

/// No pulse is shorter than 0.
std::int64_t first_pulse(const PwmMapping& mapping) {
  return std::max<std::int64_t>(mapping.shortest_us(), 0);
}

/// The reason why a pulse is in the table.
std::string remark(const PwmMapping& mapping, std::int64_t pulse) {
  const auto cuts = mapping.cut_off_us();
  return pulse == mapping.neutral_us                    ? say<texts::pwm_neutral_point>()
         : pulse == first_pulse(mapping)                ? say<texts::pwm_shortest_point>()
         : pulse == mapping.longest_us()                ? say<texts::pwm_longest_point>()
         : std::ranges::find(cuts, pulse) != cuts.end() ? say<texts::pwm_limit_point>()
                                                        : say<texts::pwm_autopilot_point>();
}

std::string points_table(const PwmMapping& mapping, const Page& page) {
  Table table({say<texts::column_pulse>(), say<texts::column_command>(), ""});
  for (const std::int64_t pulse : mapping.points_us()) {
    const auto given = mapping.command(pulse);
    const auto limited = mapping.limited_command(pulse);
    std::string command = given ? pwm_command_text(mapping, *given) : std::string("-");
    if (given && limited != given) {
      command += say<texts::pwm_limited_to>(pwm_command_text(mapping, *limited));
    }
    table.add({fmt::format("{} us", pulse), std::move(command), remark(mapping, pulse)});
  }
  for (const std::int64_t pulse : mapping.missed_us()) {
    table.add(
        {fmt::format("{} us", pulse), say<texts::pwm_missed>(), say<texts::pwm_autopilot_point>()});
  }
  return table.text("  ", page);
}

/// A grid of characters, one per cell of the terminal.
class Plot {
 public:
  Plot(const PwmMapping& mapping, const Page& page)
      : mapping_(mapping),
        signs_(page.unicode ? Signs{"│", "─", "┼", "●", "·"} : Signs{"|", "-", "+", "*", "."}) {
    cells_.assign(rows, std::vector<std::string>(columns, " "));
  }

  std::string text();

 private:
  struct Signs {
    std::string_view vertical, horizontal, cross, curve, cut;
  };

  static constexpr std::size_t rows = 11, columns = 57; // odd: neutral is in the middle
  static constexpr std::int64_t half_rows = rows / 2;
  static constexpr std::size_t label = 12;

  [[nodiscard]] std::int64_t pulse_at(std::size_t column) const {
    const auto half = static_cast<std::int64_t>(columns / 2);
    return mapping_.neutral_us +
           (static_cast<std::int64_t>(column) - half) * mapping_.range_us / half;
  }

  /// The number of rows above neutral.
  [[nodiscard]] std::int64_t height_of(std::int64_t command) const {
    const std::int64_t most = std::max<std::int64_t>(mapping_.output_raw, 1);
    const std::int64_t twice = 2 * command * half_rows;
    return (twice + (twice < 0 ? -most : most)) / (2 * most); // rounded
  }

  /// The outermost rows are labelled with the ends of the range, which commands beyond a limit
  /// never reach.
  [[nodiscard]] std::int64_t height_of_limited(std::int64_t command) const {
    return std::clamp(height_of(command), mapping_.cut_off_below_us() ? 1 - half_rows : -half_rows,
                      mapping_.cut_off_above_us() ? half_rows - 1 : half_rows);
  }

  [[nodiscard]] std::string& cell(std::int64_t height, std::size_t column) {
    return cells_[static_cast<std::size_t>(half_rows - height)][column];
  }

  void draw_axes();
  void draw_curve();
  [[nodiscard]] std::string scale(std::size_t row) const;
  [[nodiscard]] std::string legend() const;

  const PwmMapping& mapping_;
  Signs signs_;
  std::vector<std::vector<std::string>> cells_;
};

void Plot::draw_axes() {
  for (std::size_t column = 0; column < columns; ++column) {
    cell(0, column) = signs_.horizontal;
  }
  for (auto& row : cells_) {
    row[columns / 2] = signs_.vertical;
  }
  cell(0, columns / 2) = signs_.cross;
}

void Plot::draw_curve() {
  for (std::size_t column = 0; column < columns; ++column) {
    const std::int64_t pulse = pulse_at(column);
    const auto given = mapping_.command(pulse);
    if (pulse < 0 || !given) {
      continue; // no such pulse
    }
    const std::int64_t limited = *mapping_.limited_command(pulse);
    if (limited != *given) {
      cell(height_of(*given), column) = signs_.cut;
    }
    cell(height_of_limited(limited), column) = signs_.curve;
  }
}

std::string Plot::scale(std::size_t row) const {
  return row == 0          ? pwm_command_text(mapping_, mapping_.output_raw)
         : row == rows / 2 ? pwm_command_text(mapping_, 0)
         : row == rows - 1 ? pwm_command_text(mapping_, -mapping_.output_raw)
                           : std::string();
}

/// If nothing is cut off, there is only one sign.
std::string Plot::legend() const {
  return mapping_.cut_off_us().empty()
             ? std::string()
             : fmt::format("  {:>{}} {}\n", "", label,
                           say<texts::pwm_legend>(signs_.curve, signs_.cut));
}

std::string Plot::text() {
  draw_axes();
  draw_curve();
  std::string out;
  for (std::size_t row = 0; row < rows; ++row) {
    out += fmt::format("  {:>{}} ", scale(row), label);
    for (const std::string& cell : cells_[row]) {
      out += cell;
    }
    out.erase(out.find_last_not_of(' ') + 1);
    out += '\n';
  }
  const auto shortest = mapping_.shortest_us() < 0 ? "" : std::to_string(mapping_.shortest_us());
  const auto neutral = std::to_string(mapping_.neutral_us);
  out += fmt::format("  {:>{}} {:<{}}{:^{}}{:>{}} us\n", "", label, shortest, (columns - 9) / 2,
                     neutral, 9, mapping_.longest_us(), (columns - 9) / 2);
  return out + legend();
}

} // namespace

std::string pwm_command_text(const PwmMapping& mapping, std::int64_t command) {
  return number(mapping, command) + ' ' + std::string(unit(mapping));
}

void write_pwm(JsonWriter& json, const bla::Values& values) {
  const auto mapping = bla::pwm_mapping(values);
  const auto member = [&](std::string_view key, auto value) {
    json.key(key);
    mapping ? json.value(value(*mapping)) : json.value(nullptr);
  };
  member("neutral_us", [](const PwmMapping& it) { return it.neutral_us; });
  member("range_us", [](const PwmMapping& it) { return it.range_us; });
  member("output_range_raw", [](const PwmMapping& it) { return it.output_raw; });
  member("mode",
         [](const PwmMapping& it) { return std::string_view(it.is_angle() ? "angle" : "speed"); });
  member("unit", [](const PwmMapping& it) { return unit(it); });
  member("pulse_min_us", [](const PwmMapping& it) { return it.shortest_us(); });
  member("pulse_max_us", [](const PwmMapping& it) { return it.longest_us(); });
  const auto input = bla::pwm_input(values);
  json.member("input", input ? std::optional(name(*input)) : std::nullopt);
  json.member("fallback_after_ms", bla::pwm_fallback_ms(values));
  json.array("cut_off_us", mapping ? mapping->cut_off_us() : std::vector<std::int64_t>(),
             [&](std::int64_t pulse) { json.value(pulse); });
  json.objects("points", mapping ? mapping->points_us() : std::vector<std::int64_t>(),
               [&](std::int64_t pulse) {
                 const auto command = mapping->command(pulse);
                 json.member("pulse_us", pulse);
                 json.key("command");
                 command ? json.number(number(*mapping, *command)) : json.value(nullptr);
               });
}

std::string pwm_text(const bla::Values& values, const Page& page) {
  const auto mapping = bla::pwm_mapping(values);
  if (!mapping) {
    return "  " + say<texts::pwm_unknown>() + '\n';
  }
  const auto timeout = bla::pwm_fallback_ms(values);
  std::string out = say<texts::pwm_pulses>(mapping->neutral_us, mapping->range_us,
                                           first_pulse(*mapping), mapping->longest_us()) +
                    say<texts::pwm_output>(pwm_command_text(*mapping, mapping->output_raw),
                                           mapping->is_angle() ? say<texts::pwm_angle>()
                                                               : say<texts::pwm_speed>());
  if (const auto input = bla::pwm_input(values)) {
    out += say<texts::pwm_input_now>(input_text(*input));
  }
  if (timeout) {
    out += say<texts::pwm_fallback>(*timeout);
  }
  out += mapping->is_idle ? say<texts::pwm_idle>() : "";
  if (const auto pulse = mapping->cut_off_below_us()) {
    out += say<texts::pwm_cut_below>(*pulse, pwm_command_text(*mapping, *mapping->limit_ccw));
  }
  if (const auto pulse = mapping->cut_off_above_us()) {
    out += say<texts::pwm_cut_above>(*pulse, pwm_command_text(*mapping, *mapping->limit_cw));
  }
  out += say<texts::pwm_beyond>();
  out = page.fit(out);
  constexpr std::size_t plot_width = 75;
  if (mapping->range_us > 0 && mapping->output_raw > 0 && page.width >= plot_width) {
    out += '\n' + Plot(*mapping, page).text();
  }
  return out + '\n' + points_table(*mapping, page);
}

std::string pwm_summary(const PwmMapping& mapping) {
  std::string out;
  for (const std::int64_t pulse :
       {first_pulse(mapping), mapping.neutral_us, mapping.longest_us()}) {
    out += fmt::format("{}{} us {}", out.empty() ? "" : ", ", pulse,
                       pwm_command_text(mapping, mapping.command(pulse).value_or(0)));
  }
  return out;
}

} // namespace blactl::cli
