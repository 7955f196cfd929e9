// The statistics of a trace as a table.

#include "cli/output/table.hpp"
#include "cli/texts.hpp"
#include "cli/trace/stats.hpp"
#include "cli/trace/texts.hpp"
#include "cli/trace/time.hpp"
#include "cli/trace/type_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::cli {
namespace {

using fleet::BusStatistics;
using fleet::TransferStream;

/// candump's timestamps of the time of day have ten digits; others count from something else.
constexpr WallTime first_date{std::chrono::seconds(1'000'000'000)};

std::string or_dash(std::string text) {
  return text.empty() ? "-" : std::move(text);
}

/// "100.2", "1002": the significant digits only.
std::string ms_text(std::optional<double> us) {
  constexpr double long_us = 999'950;
  return or_dash(us ? fixed(*us / 1000, *us < long_us ? 1 : 0) : std::string());
}

std::string ms_text(std::optional<Duration> time) {
  return ms_text(time ? std::optional(static_cast<double>(time->count())) : std::nullopt);
}

/// The share of a bus at 1 Mbit/s, the bit rate of BLA servos.
std::string percent_text(const TransferStream& stream, const BusStatistics& bus) {
  const auto bits = per_second(stream.bits, bus);
  return or_dash(bits ? fixed(*bits / 1e4, 2) : std::string());
}

std::string permille_text(std::optional<std::uint64_t> permille) {
  return permille ? fmt::format("{}.{} %", *permille / 10, *permille % 10) : "-";
}

/// "3"; "3+" if there were gaps that cannot be counted.
std::string lost_text(const TransferStream& stream) {
  const auto lost = stream.losses.lost();
  const char* more = stream.losses.jumps() > 0 ? "+" : "";
  return lost ? std::to_string(*lost) + more : "-";
}

std::string node_text(const TransferStream& stream) {
  return stream.destination.is_unicast()
             ? fmt::format("{} > {}", stream.source.value(), stream.destination.value())
             : std::to_string(stream.source.value());
}

/// "99.0-100.9"
std::string range_text(const fleet::Periods& periods) {
  return periods.count() > 0 ? ms_text(periods.min()) + '-' + ms_text(periods.max()) : "-";
}

/// Senders of broken transfers are listed only if there are any: 80 columns have room for the rest.
bool has_errors(const BusStatistics& bus) {
  return (bus.rest() && bus.rest()->errors > 0) ||
         std::ranges::any_of(bus.streams(), [](const auto& row) { return row.second.errors > 0; });
}

std::vector<std::string> header(const BusStatistics& bus) {
  std::vector<std::string> all{say<texts::column_node>(),      say<texts::column_type>(),
                               say<texts::column_transfers>(), say<texts::column_per_second>(),
                               say<texts::column_period_ms>(), say<texts::column_range_ms>(),
                               say<texts::column_jitter>(),    say<texts::column_lost>(),
                               say<texts::column_load>()};
  if (has_errors(bus)) {
    all.push_back(say<texts::column_errors>());
  }
  return all;
}

std::vector<std::string> cells(const TransferStream& stream, const BusStatistics& bus) {
  std::vector<std::string> all{node_text(stream),
                               type_text(stream.kind, stream.data_type_id),
                               std::to_string(stream.count),
                               or_dash(fixed(per_second(stream.count, bus), 1)),
                               ms_text(stream.periods.mean_us()),
                               range_text(stream.periods),
                               ms_text(stream.periods.jitter_us()),
                               lost_text(stream),
                               percent_text(stream, bus)};
  if (has_errors(bus)) {
    all.push_back(std::to_string(stream.errors));
  }
  return all;
}

std::string table_text(const BusStatistics& bus, const Page& page) {
  Table table(header(bus));
  for (const auto& [key, stream] : bus.streams()) {
    table.add(cells(stream, bus));
  }
  if (bus.rest()) {
    auto rest = cells(*bus.rest(), bus);
    rest[0] = rest[1] = "*";
    table.add(std::move(rest));
  }
  return table.text("", page);
}

std::string bus_text(const TraceStats::Bus& bus) {
  const BusStatistics& all = bus.statistics;
  const auto time = all.load().duration();
  const auto seconds =
      time ? std::optional(std::chrono::duration<double>(*time).count()) : std::nullopt;
  std::string out = say<texts::trace_load>(
      printable(bus.name), all.frames(), or_dash(fixed(seconds, 1)),
      permille_text(all.load().mean_permille()), permille_text(all.load().max_permille()),
      permille_text(all.load().last_permille()));
  if (all.begin() >= first_date) {
    out += say<texts::trace_span>(wall_text(all.begin()), wall_text(all.end()));
  }
  return out;
}

bool has_jumps(const BusStatistics& bus) {
  return std::ranges::any_of(bus.streams(), [](const auto& row) {
    return row.second.losses.lost() && row.second.losses.jumps() > 0;
  });
}

} // namespace

std::string TraceStats::errors_text() const {
  std::string list;
  for (std::size_t i = 0; i < errors_.size(); ++i) {
    if (errors_[i] > 0) {
      list += fmt::format("{}{}: {}", list.empty() ? "" : ", ", name(static_cast<TraceError>(i)),
                          errors_[i]);
    }
  }
  return list.empty() ? list : say<texts::trace_errors_by_kind>(list);
}

std::string TraceStats::text(const Page& page) const {
  std::string out, note;
  for (const Bus& bus : buses_) {
    const BusStatistics& all = bus.statistics;
    out += table_text(all, page) + bus_text(bus) + (buses_.size() > 1 ? "\n" : "");
    note = note.empty() && has_jumps(all) ? say<texts::trace_jumps>() : note;
  }
  return page.fit((buses_.empty() ? say<texts::trace_no_frames>() : out) + errors_text() + note);
}

} // namespace blactl::cli
