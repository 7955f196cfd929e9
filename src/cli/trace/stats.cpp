#include "cli/trace/stats.hpp"

#include "blactl/dronecan/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::cli {
namespace {

using dronecan::Bytes;
using dronecan::FieldsResult;

/// Only checks that a payload is long enough.
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

/// Shorter times give no meaningful rate.
constexpr Duration shortest_time = std::chrono::milliseconds(1);

} // namespace

std::optional<double> per_second(std::uint64_t count, const fleet::BusStatistics& bus) {
  const auto time = bus.load().duration();
  return time && *time >= shortest_time
             ? std::optional(static_cast<double>(count) /
                             std::chrono::duration<double>(*time).count())
             : std::nullopt;
}

std::string fixed(std::optional<double> number, int decimals) {
  return number ? fmt::format("{:.{}f}", *number, decimals) : std::string();
}

fleet::BusStatistics& TraceStats::statistics_of(std::string_view interface) {
  if (last_ >= buses_.size() || buses_[last_].name != interface) {
    const auto found = std::ranges::find(buses_, interface, &Bus::name);
    last_ = static_cast<std::size_t>(found - buses_.begin());
    if (found == buses_.end()) {
      buses_.push_back({.name = std::string(interface)});
    }
  }
  return buses_[last_].statistics;
}

void TraceStats::frame(const Heard& heard, bool wanted) {
  statistics_of(heard.interface).hear({heard.frame, heard.at, heard.wall}, wanted);
}

bool TraceStats::transfer(const Occasion& occasion, const dronecan::Transfer& transfer) {
  const auto& header = transfer.header;
  Nothing sink;
  if (dronecan::write_fields(sink, header.kind, header.data_type_id, transfer.payload) ==
      FieldsResult::too_short) {
    return false;
  }
  statistics_of(occasion.interface).take(transfer);
  return true;
}

void TraceStats::broken(const Occasion& occasion, TraceError error, std::uint32_t can_id) {
  ++errors_[std::to_underlying(error)];
  if (const auto header = dronecan::decode_id(can_id)) {
    statistics_of(occasion.interface).take_broken(*header);
  }
}

void TraceStats::pass(Time now) {
  for (Bus& bus : buses_) {
    bus.statistics.pass(now);
  }
}

} // namespace blactl::cli
