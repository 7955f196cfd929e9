#pragma once
// What is sent on one bus, added up: who sends what how often and how regularly, what of it was
// lost, and how busy the bus is with all of it.

#include "blactl/base/time.hpp"
#include "blactl/can/bus.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/fleet/bus/bus_load.hpp"
#include "blactl/fleet/statistics/lost_transfers.hpp"
#include "blactl/fleet/statistics/periods.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

namespace blactl::fleet {

/// The transfers of one type and kind that one node sends.
struct TransferStream {
  dronecan::Kind kind{};
  std::uint16_t data_type_id = 0;
  dronecan::NodeId source{};
  dronecan::NodeId destination{}; ///< of all of them; 0: messages, or to several nodes

  std::uint64_t count = 0, bytes = 0; ///< transfers that came whole, their payloads
  std::uint64_t frames = 0, bits = 0; ///< on the wire, with the intermission
  std::uint64_t errors = 0;           ///< transfers that came broken
  Periods periods{};                  ///< of messages, from start to start
  LostTransfers losses{};             ///< of messages

  /// Whether what is missing can be told: services are asked when somebody wants to, and nodes
  /// without an ID cannot be told apart.
  [[nodiscard]] bool is_regular() const {
    return kind == dronecan::Kind::message && source.is_unicast();
  }
};

/// A state machine without I/O. Bounded: some 300 bytes a stream, `most_streams` of them; what
/// further ones send is added up in one, rest().
class BusStatistics {
 public:
  /// A full bus of 127 nodes with 16 types each.
  static constexpr std::size_t most_streams = 2048;

  BusStatistics() = default;
  ~BusStatistics() = default;
  BusStatistics(BusStatistics&&) = default;
  BusStatistics& operator=(BusStatistics&&) = default;
  BusStatistics(const BusStatistics&) = delete; // it points into itself
  BusStatistics& operator=(const BusStatistics&) = delete;

  /// Every frame, for the load; those that are `counted`, and are DroneCAN, also for their stream.
  void hear(const can::Received& received, bool counted);

  /// A transfer of frames that were counted.
  void take(const dronecan::Transfer& transfer);

  /// One that came broken.
  void take_broken(const dronecan::Header& header);

  /// Nothing more was heard until `now`.
  void pass(Time now) { load_.pass(now); }

  [[nodiscard]] std::uint64_t frames() const { return frames_; }

  [[nodiscard]] const BusLoad& load() const { return load_; }

  /// Of the first frame and of the latest; nothing if there was none.
  [[nodiscard]] WallTime begin() const { return begin_; }

  [[nodiscard]] WallTime end() const { return end_; }

  /// In the order of source, kind and type.
  [[nodiscard]] const std::map<std::uint32_t, TransferStream>& streams() const { return streams_; }

  /// The streams for which there was no place; empty: all had one. It has neither source nor type,
  /// nor a rhythm.
  [[nodiscard]] const std::optional<TransferStream>& rest() const { return rest_; }

 private:
  [[nodiscard]] TransferStream& stream_of(const dronecan::Header& header);

  std::uint64_t frames_ = 0;
  BusLoad load_;
  WallTime begin_{}, end_{};
  std::map<std::uint32_t, TransferStream> streams_;
  std::optional<TransferStream> rest_;
  std::uint32_t last_key_ = 0;            ///< of the stream that was looked for last
  TransferStream* last_stream_ = nullptr; ///< never the rest
};

} // namespace blactl::fleet
