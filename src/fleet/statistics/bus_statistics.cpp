#include "blactl/fleet/statistics/bus_statistics.hpp"

#include "blactl/can/frame_bits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace blactl::fleet {
namespace {

std::uint32_t key_of(const dronecan::Header& header) {
  return static_cast<std::uint32_t>(header.source.value()) << 18U |
         static_cast<std::uint32_t>(std::to_underlying(header.kind)) << 16U | header.data_type_id;
}

} // namespace

void Periods::take(Time at) {
  const auto last = std::exchange(last_, at);
  if (!last || at < *last) {
    return;
  }
  const Duration period = at - *last;
  min_ = count_ == 0 ? period : std::min(min_, period);
  max_ = std::max(max_, period);
  ++count_;
  const auto us = static_cast<double>(period.count());
  const double before = us - mean_;
  mean_ += before / static_cast<double>(count_);
  squares_ += before * (us - mean_);
}

std::optional<double> Periods::mean_us() const {
  return count_ > 0 ? std::optional(mean_) : std::nullopt;
}

std::optional<Duration> Periods::min() const {
  return count_ > 0 ? std::optional(min_) : std::nullopt;
}

std::optional<Duration> Periods::max() const {
  return count_ > 0 ? std::optional(max_) : std::nullopt;
}

std::optional<double> Periods::jitter_us() const {
  return count_ > 1 ? std::optional(std::sqrt(squares_ / static_cast<double>(count_)))
                    : std::nullopt;
}

void BusStatistics::hear(const can::Received& received, bool counted) {
  const auto bits = can::frame_length(received.frame) + can::intermission_bits;
  load_.hear(bits, received.at);
  begin_ = frames_ == 0 ? received.wall : begin_;
  end_ = frames_ == 0 ? received.wall : std::max(end_, received.wall);
  ++frames_;
  const auto header =
      counted && received.frame.extended ? dronecan::decode_id(received.frame.id) : std::nullopt;
  if (header) {
    TransferStream& stream = stream_of(*header);
    ++stream.frames;
    stream.bits += bits;
  }
}

void BusStatistics::take(const dronecan::Transfer& transfer) {
  TransferStream& stream = stream_of(transfer.header);
  const bool is_first = stream.count == 0;
  ++stream.count;
  stream.bytes += transfer.payload.size();
  if (is_first) {
    stream.destination = transfer.header.destination;
  } else if (stream.destination != transfer.header.destination) {
    stream.destination = {};
  }
  if (stream.is_regular()) {
    stream.periods.take(transfer.at);
    stream.losses.take(transfer.transfer_id, transfer.at);
  }
}

void BusStatistics::take_broken(const dronecan::Header& header) {
  ++stream_of(header).errors;
}

TransferStream& BusStatistics::stream_of(const dronecan::Header& header) {
  const auto key = key_of(header);
  if (last_stream_ != nullptr && last_key_ == key) {
    return *last_stream_;
  }
  auto found = streams_.find(key);
  if (found == streams_.end()) {
    if (streams_.size() >= most_streams) {
      return rest_ ? *rest_ : rest_.emplace();
    }
    found = streams_
                .try_emplace(key, TransferStream{.kind = header.kind,
                                                 .data_type_id = header.data_type_id,
                                                 .source = header.source})
                .first;
  }
  last_key_ = key;
  last_stream_ = &found->second;
  return *last_stream_;
}

} // namespace blactl::fleet
