#pragma once
// Traffic statistics of one bus: the transfers of each node with their rates and regularity, the
// losses, and the load of the bus.

#include "blactl/base/time.hpp"
#include "blactl/can/bus.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/fleet/bus/bus_load.hpp"
#include "blactl/fleet/statistics/lost_transfers.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

namespace blactl::fleet {

/// The times between consecutive events. An event earlier than the one before (a clock was set)
/// ends no period, but begins the next. In microseconds, as measured; nothing is omitted, so that a
/// lost transfer shows as a long period.
class Periods {
 public:
  void take(Time at);

  /// The number of periods: one less than the events, if no clock went back.
  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// Empty, as all below: there are no periods.
  [[nodiscard]] std::optional<double> mean_us() const;
  [[nodiscard]] std::optional<Duration> min() const;
  [[nodiscard]] std::optional<Duration> max() const;

  /// The standard deviation; empty: there are fewer than two periods.
  [[nodiscard]] std::optional<double> jitter_us() const;

 private:
  std::optional<Time> last_;
  std::uint64_t count_ = 0;
  double mean_ = 0, squares_ = 0; ///< squares of the distances from the mean (Welford)
  Duration min_{}, max_{};
};

/// The transfers of one data type and kind from one node.
struct TransferStream {
  dronecan::Kind kind{};
  std::uint16_t data_type_id = 0;
  dronecan::NodeId source{};
  dronecan::NodeId destination{}; ///< of all of them; 0: broadcast, or several nodes

  std::uint64_t count = 0, bytes = 0; ///< complete transfers, and their payloads
  std::uint64_t frames = 0, bits = 0; ///< on the wire, including the intermission
  std::uint64_t errors = 0;           ///< broken transfers
  Periods periods{};                  ///< of messages, from start to start
  LostTransfers losses{};             ///< of messages

  /// Whether losses can be detected: services are called irregularly, and nodes without an ID
  /// cannot be distinguished.
  [[nodiscard]] bool is_regular() const {
    return kind == dronecan::Kind::message && source.is_unicast();
  }
};

/// A state machine without I/O. Bounded: some 300 bytes per stream, at most `most_streams` of them;
/// all further ones are added up in rest().
class BusStatistics {
 public:
  /// Enough for a bus of 127 nodes with 16 types each.
  static constexpr std::size_t most_streams = 2048;

  BusStatistics() = default;
  ~BusStatistics() = default;
  BusStatistics(BusStatistics&&) = default;
  BusStatistics& operator=(BusStatistics&&) = default;
  BusStatistics(const BusStatistics&) = delete; // it points into itself
  BusStatistics& operator=(const BusStatistics&) = delete;

  /// Takes every frame, for the load; `counted` DroneCAN frames also count for their stream.
  void hear(const can::Received& received, bool counted);

  /// Takes a transfer of counted frames.
  void take(const dronecan::Transfer& transfer);

  /// Takes a broken transfer.
  void take_broken(const dronecan::Header& header);

  /// Advances to `now` without traffic.
  void pass(Time now) { load_.pass(now); }

  [[nodiscard]] std::uint64_t frames() const { return frames_; }

  [[nodiscard]] const BusLoad& load() const { return load_; }

  /// The times of the first and of the latest frame; zero if there was none.
  [[nodiscard]] WallTime begin() const { return begin_; }

  [[nodiscard]] WallTime end() const { return end_; }

  /// In the order of source, kind and type.
  [[nodiscard]] const std::map<std::uint32_t, TransferStream>& streams() const { return streams_; }

  /// The sum of all streams beyond `most_streams`; empty: there are none. It has no source, type or
  /// period.
  [[nodiscard]] const std::optional<TransferStream>& rest() const { return rest_; }

 private:
  [[nodiscard]] TransferStream& stream_of(const dronecan::Header& header);

  std::uint64_t frames_ = 0;
  BusLoad load_;
  WallTime begin_{}, end_{};
  std::map<std::uint32_t, TransferStream> streams_;
  std::optional<TransferStream> rest_;
  std::uint32_t last_key_ = 0;            ///< of the stream looked up last
  TransferStream* last_stream_ = nullptr; ///< never rest()
};

} // namespace blactl::fleet
