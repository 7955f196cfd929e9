#include "blactl/bla/explain.hpp"

#include "bla/texts.hpp"

#include <fmt/format.h>

#include <chrono>

namespace blactl::bla {

namespace at = address;

std::optional<std::string> production_time(const Values& values) {
  const auto year = find(values, at::production_year);
  const auto month = find(values, at::production_month);
  const auto day = find(values, at::production_day);
  const auto holds = [](std::optional<std::int64_t> part, std::int64_t first, std::int64_t last) {
    return part && *part >= first && *part <= last;
  };
  if (!holds(year, 1, 9999) || !holds(month, 1, 12) || !holds(day, 1, 31)) {
    return std::nullopt;
  }
  const std::chrono::year_month_day date(std::chrono::year(static_cast<int>(*year)),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day)));
  if (!date.ok()) {
    return std::nullopt;
  }
  std::string text = fmt::format("{:04}-{:02}-{:02}", *year, *month, *day);
  const auto hour = find(values, at::production_hour);
  const auto minute = find(values, at::production_minute);
  if (holds(hour, 0, 23) && holds(minute, 0, 59)) {
    text += fmt::format(" {:02}:{:02}", *hour, *minute);
  }
  return text;
}

std::string bit_title(const FaultBit* known) {
  return known != nullptr ? std::string(choose(known->text_en, known->text_ja))
                          : say<texts::unknown_bit>();
}

namespace {

/// The bits that are set, one per line.
std::vector<std::string> bit_lines(const Parameter& parameter, std::int64_t raw,
                                   const Profiles& profiles) {
  std::vector<std::string> lines;
  for (std::uint8_t bit = 0; bit < fault_register_bits; ++bit) {
    if ((raw >> bit & 1) != 0) {
      const FaultBit* known = profiles.fault_bit(parameter.address, bit);
      // The bits of 0x18 have one title in common.
      const bool is_summary = known != nullptr && known->code.empty();
      lines.push_back(
          fmt::format("bit {}: {}", bit,
                      is_summary ? std::string(choose(known->condition_en, known->condition_ja))
                                 : bit_title(known)));
    }
  }
  return lines;
}

} // namespace

std::vector<std::string> explained(const Parameter& parameter, std::int64_t raw,
                                   const Values& values, const Profiles& profiles) {
  if (parameter.group == Group::fault) {
    return bit_lines(parameter, raw, profiles);
  }
  const Address last =
      find(values, at::production_minute) ? at::production_minute : at::production_day;
  const auto date = parameter.address == last ? production_time(values) : std::nullopt;
  return date ? std::vector{say<texts::made>(*date)} : std::vector<std::string>{};
}

} // namespace blactl::bla
