// The statistics of a trace as a document.

#include "blactl/dronecan/standard_types.hpp"

#include "cli/trace/stats.hpp"
#include "cli/trace/time.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::cli {
namespace {

using fleet::TransferStream;

void member_number(JsonWriter& json, const char* name, std::optional<double> number) {
  json.key(name);
  number ? json.number(fixed(number, 3)) : json.value(nullptr);
}

std::optional<double> in_ms(std::optional<double> us) {
  return us ? std::optional(*us / 1000) : std::nullopt;
}

std::optional<double> in_ms(std::optional<Duration> time) {
  return time ? in_ms(static_cast<double>(time->count())) : std::nullopt;
}

std::optional<double> seconds(std::optional<Duration> time) {
  return time ? std::optional(std::chrono::duration<double>(*time).count()) : std::nullopt;
}

void write_periods(JsonWriter& json, const fleet::Periods& periods) {
  json.key("period_ms");
  json.begin_object();
  member_number(json, "mean", in_ms(periods.mean_us()));
  member_number(json, "min", in_ms(periods.min()));
  member_number(json, "max", in_ms(periods.max()));
  member_number(json, "jitter", in_ms(periods.jitter_us()));
  json.end_object();
}

/// Writes the counts of `stream`, after its identification.
void write_counts(JsonWriter& json, const TransferStream& stream, std::optional<double> rate) {
  json.member("count", stream.count);
  member_number(json, "rate_hz", rate);
  write_periods(json, stream.periods);
  json.member("lost", stream.losses.lost());
  json.member("jumps", stream.is_regular() ? std::optional(stream.losses.jumps()) : std::nullopt);
  json.member("errors", stream.errors);
  json.member("frames", stream.frames);
  json.member("bytes", stream.bytes);
  json.member("bits", stream.bits);
}

void write_stream(JsonWriter& json, const TraceStats::Bus& bus, const TransferStream& stream) {
  const auto* type = dronecan::find_standard_type(stream.kind, stream.data_type_id);
  json.begin_object();
  json.member("interface", bus.name);
  json.member("type", type != nullptr ? std::optional(type->name) : std::nullopt);
  json.member("data_type_id", stream.data_type_id);
  json.member("kind", name(stream.kind));
  json.member("source", stream.source.value());
  json.member("destination", stream.destination.is_unicast()
                                 ? std::optional(stream.destination.value())
                                 : std::nullopt);
  write_counts(json, stream, per_second(stream.count, bus.statistics));
  json.end_object();
}

void write_rest(JsonWriter& json, const TraceStats::Bus& bus) {
  json.begin_object();
  json.member("interface", bus.name);
  for (const char* unknown : {"type", "data_type_id", "kind", "source", "destination"}) {
    json.member(unknown, nullptr);
  }
  write_counts(json, *bus.statistics.rest(), std::nullopt);
  json.end_object();
}

/// `load`: null if several buses have one each.
void write_load(JsonWriter& json, const fleet::BusLoad* load) {
  const auto value = [&](auto permille) {
    return load != nullptr ? (load->*permille)() : std::nullopt;
  };
  json.key("load");
  json.begin_object();
  json.member("mean_permille", value(&fleet::BusLoad::mean_permille));
  json.member("max_permille", value(&fleet::BusLoad::max_permille));
  json.member("last_permille", value(&fleet::BusLoad::last_permille));
  json.end_object();
}

void write_time(JsonWriter& json, const char* name, std::optional<WallTime> time) {
  json.key(name);
  time ? json.number(UnixTime(*time).text()) : json.value(nullptr);
}

/// From the first frame on any bus to the last.
struct Span {
  std::optional<WallTime> begin{}, end{};
  std::optional<Duration> duration{};
};

Span span_of(const std::vector<TraceStats::Bus>& buses) {
  Span all;
  bool is_known = true;
  for (const auto& [name, bus] : buses) {
    const auto time = bus.load().duration();
    is_known = is_known && (time || bus.begin() == bus.end());
    all.begin = std::min(all.begin.value_or(bus.begin()), bus.begin());
    // the clock of a silent bus goes on
    all.end = std::max(all.end.value_or(bus.end()),
                       std::max(bus.end(), bus.begin() + time.value_or(Duration())));
  }
  if (is_known && all.begin) {
    all.duration = *all.end - *all.begin;
  }
  return all;
}

} // namespace

void TraceStats::write_errors(JsonWriter& json) const {
  json.key("errors_by_kind");
  json.begin_object();
  for (std::size_t i = 0; i < errors_.size(); ++i) {
    json.member(name(static_cast<TraceError>(i)), errors_[i]);
  }
  json.end_object();
}

void TraceStats::write(JsonWriter& json) const {
  json.key("types");
  json.begin_array();
  std::uint64_t frames = 0;
  for (const Bus& bus : buses_) {
    frames += bus.statistics.frames();
    for (const auto& [key, stream] : bus.statistics.streams()) {
      write_stream(json, bus, stream);
    }
    if (bus.statistics.rest()) {
      write_rest(json, bus);
    }
  }
  json.end_array();
  write_errors(json);
  write_load(json, buses_.size() == 1 ? &buses_.front().statistics.load() : nullptr);
  const Span all = span_of(buses_);
  write_time(json, "begin", all.begin);
  write_time(json, "end", all.end);
  member_number(json, "duration_s", seconds(all.duration));
  json.member("frames", frames);
  json.objects("interfaces", buses_, [&](const Bus& bus) {
    json.member("interface", bus.name);
    json.member("frames", bus.statistics.frames());
    member_number(json, "duration_s", seconds(bus.statistics.load().duration()));
    write_load(json, &bus.statistics.load());
  });
}

} // namespace blactl::cli
