#include "cli/trace/stats.hpp"

#include "blactl/can/frame_bits.hpp"
#include "blactl/dronecan/fields.hpp"
#include "blactl/dronecan/standard_types.hpp"

#include "cli/output/table.hpp"
#include "cli/texts.hpp"
#include "cli/trace/texts.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace blactl::cli {
namespace {

using dronecan::Bytes;
using dronecan::FieldsResult;

/// Only whether a payload is long enough is asked.
class Nothing final : public dronecan::FieldSink {
 public:
  void begin_object() override {}

  void end_object() override {}

  void begin_array() override {}

  void end_array() override {}

  void key(std::string_view) override {}

  void natural(std::uint64_t, std::string_view) override {}

  void integer(std::int64_t) override {}

  void truth(bool) override {}

  void real(float) override {}

  void text(std::string_view) override {}

  void bytes(Bytes) override {}
};

/// Shorter times say nothing of a rate.
constexpr Duration shortest_time = std::chrono::milliseconds(1);

/// The key of a row sorts by interface, node, kind and type; the rest comes last.
constexpr std::uint64_t rest_key = ~std::uint64_t{0};

std::uint64_t key_of(std::size_t bus, const dronecan::Header& header) {
  return static_cast<std::uint64_t>(bus) << 32U |
         static_cast<std::uint64_t>(header.source.value()) << 24U |
         static_cast<std::uint64_t>(std::to_underlying(header.kind)) << 16U | header.data_type_id;
}

/// Empty: heard for too short a time.
std::optional<double> per_second(std::uint64_t count, Duration time) {
  return time < shortest_time ? std::nullopt
                              : std::optional(static_cast<double>(count) /
                                              std::chrono::duration<double>(time).count());
}

/// BLA servos speak 1 Mbit/s: a bit takes a microsecond.
std::optional<double> load_percent(std::uint64_t bits, Duration time) {
  const auto per = per_second(bits, time);
  return per ? std::optional(*per / 1e4) : std::nullopt;
}

std::string fixed(std::optional<double> number, int decimals) {
  return number ? fmt::format("{:.{}f}", *number, decimals) : std::string();
}

std::string or_dash(std::string text) {
  return text.empty() ? "-" : std::move(text);
}

void member_fixed(JsonWriter& json, const char* name, std::optional<double> number) {
  json.key(name);
  number ? json.number(fixed(number, 3)) : json.value(nullptr);
}

} // namespace

std::size_t TraceStats::bus_of(std::string_view name) {
  const auto it = std::ranges::find(buses_, name, &Bus::name);
  if (it != buses_.end()) {
    return static_cast<std::size_t>(it - buses_.begin());
  }
  buses_.push_back({.name = std::string(name)});
  return buses_.size() - 1;
}

TraceStats::Row& TraceStats::row_of(std::string_view interface, const dronecan::Header& header) {
  const auto bus = bus_of(interface);
  const auto key = key_of(bus, header);
  if (const auto it = rows_.find(key); it != rows_.end()) {
    return it->second;
  }
  if (rows_.size() >= most_rows) {
    return rows_.try_emplace(rest_key, Row{.is_rest = true}).first->second;
  }
  return rows_
      .try_emplace(key, Row{.bus = bus,
                            .kind = header.kind,
                            .data_type_id = header.data_type_id,
                            .source = header.source.value()})
      .first->second;
}

void TraceStats::frame(const Occasion& occasion, const can::Frame& frame, bool wanted) {
  const auto bits = can::frame_length(frame) + can::intermission_bits;
  Bus& bus = buses_[bus_of(occasion.interface)];
  if (bus.frames == 0) {
    bus.first = bus.last = occasion.at;
  }
  bus.first = std::min(bus.first, occasion.at);
  bus.last = std::max(bus.last, occasion.at);
  ++bus.frames;
  bus.bits += bits;
  const auto header = wanted ? dronecan::decode_id(frame.id) : std::nullopt;
  if (header) {
    Row& row = row_of(occasion.interface, *header);
    ++row.frames;
    row.bits += bits;
  }
}

bool TraceStats::transfer(const Occasion& occasion, const dronecan::Transfer& transfer) {
  const auto& header = transfer.header;
  Nothing sink;
  if (dronecan::write_fields(sink, header.kind, header.data_type_id, transfer.payload) ==
      FieldsResult::too_short) {
    return false;
  }
  Row& row = row_of(occasion.interface, header);
  ++row.transfers;
  row.bytes += transfer.payload.size();
  return true;
}

void TraceStats::broken(const Occasion& occasion, TraceError, std::uint32_t can_id) {
  if (const auto header = dronecan::decode_id(can_id)) {
    ++row_of(occasion.interface, *header).errors;
  }
}

std::vector<std::string> TraceStats::cells(const Row& row) const {
  std::vector<std::string> sums{std::to_string(row.transfers), "-",
                                std::to_string(row.frames),    std::to_string(row.bytes),
                                std::to_string(row.errors),    "-"};
  if (row.is_rest) {
    sums.insert(sums.begin(), 4, "*");
    return sums;
  }
  const Bus& bus = buses_[row.bus];
  sums[1] = or_dash(fixed(per_second(row.transfers, bus.duration()), 1));
  sums[5] = or_dash(fixed(load_percent(row.bits, bus.duration()), 2));
  const auto* type = dronecan::find_standard_type(row.kind, row.data_type_id);
  std::vector<std::string> all{
      printable(bus.name), std::to_string(row.source), std::string(name(row.kind)),
      type != nullptr ? std::string(type->name) : std::to_string(row.data_type_id)};
  all.insert(all.end(), sums.begin(), sums.end());
  return all;
}

std::string TraceStats::text(const Page& page) const {
  Table table({say<texts::column_interface>(), say<texts::column_node>(), say<texts::column_kind>(),
               say<texts::column_type>(), say<texts::column_transfers>(),
               say<texts::column_per_second>(), say<texts::column_frames>(),
               say<texts::column_bytes>(), say<texts::column_errors>(), say<texts::column_load>()});
  for (const auto& [key, row] : rows_) {
    table.add(cells(row));
  }
  std::string out = table.text("", page);
  for (const Bus& bus : buses_) {
    out += say<texts::trace_load>(
        printable(bus.name), bus.frames,
        or_dash(fixed(std::chrono::duration<double>(bus.duration()).count(), 1)),
        or_dash(fixed(load_percent(bus.bits, bus.duration()), 2)));
  }
  return out;
}

void TraceStats::write(JsonWriter& json) const {
  json.key("stats");
  json.begin_array();
  for (const auto& [key, row] : rows_) {
    const auto& bus = buses_[row.bus];
    const auto* type = dronecan::find_standard_type(row.kind, row.data_type_id);
    const auto or_null = [&](const char* name, const auto& value) {
      json.key(name);
      row.is_rest ? json.value(nullptr) : json.value(value);
    };
    const auto time = row.is_rest ? Duration() : bus.duration();
    json.begin_object();
    or_null("interface", bus.name);
    or_null("source", row.source);
    or_null("kind", name(row.kind));
    or_null("type", type != nullptr ? std::optional(type->name) : std::nullopt);
    or_null("data_type_id", row.data_type_id);
    json.member("transfers", row.transfers);
    member_fixed(json, "transfers_per_s", per_second(row.transfers, time));
    json.member("frames", row.frames);
    json.member("bytes", row.bytes);
    json.member("errors", row.errors);
    member_fixed(json, "load_pct", load_percent(row.bits, time));
    json.end_object();
  }
  json.end_array();
  json.key("buses");
  json.begin_array();
  for (const Bus& bus : buses_) {
    json.begin_object();
    json.member("interface", bus.name);
    json.member("frames", bus.frames);
    member_fixed(json, "duration_s", std::chrono::duration<double>(bus.duration()).count());
    member_fixed(json, "load_pct", load_percent(bus.bits, bus.duration()));
    json.end_object();
  }
  json.end_array();
}

} // namespace blactl::cli
