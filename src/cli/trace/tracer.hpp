#pragma once
// From frames to the output of a trace: reassembly for each interface, and the filter.

#include "blactl/dronecan/transfer.hpp"

#include "cli/trace/filter.hpp"
#include "cli/trace/output.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// A state machine without I/O: frames come from a bus or a log, transfers go to a view.
class Tracer {
 public:
  /// The number of separate interfaces. A log may name any number of them; the frames of further
  /// ones are counted, not decoded.
  static constexpr std::size_t most_interfaces = 32;

  struct Counts {
    std::uint64_t frames = 0;
    std::uint64_t transfers = 0; ///< that passed the filter
    std::uint64_t errors = 0;    ///< that passed the filter
    std::uint64_t skipped = 0;   ///< frames of too many interfaces
  };

  /// `output` outlives the tracer; `most` transfers are shown.
  Tracer(TraceFilter filter, TraceOutput& output, std::uint64_t most);

  void receive(const Heard& heard);

  /// Reports unfinished transfers that began more than 2 s before `now`.
  void expire(Time now);

  /// The time of the next expire() if nothing more is heard.
  [[nodiscard]] Time next_expiry() const { return next_expiry_; }

  /// Whether `most` transfers were shown: further ones are ignored.
  [[nodiscard]] bool full() const { return counts_.transfers >= most_; }

  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  /// The parts that belong to one interface.
  struct Network {
    std::string interface;
    std::unique_ptr<dronecan::Receiver> receiver;
    Duration to_wall{}; ///< converts a time of its clock to wall time
    Time sweep{};       ///< the next check for unfinished transfers

    [[nodiscard]] Occasion occasion(Time at) const {
      return {interface, WallTime(at.time_since_epoch() + to_wall)};
    }
  };

  [[nodiscard]] Network* network_of(std::string_view interface);
  [[nodiscard]] std::unique_ptr<Network> make_network(std::string_view interface);
  void show(const Network& network, const dronecan::Transfer& transfer);
  void show(const Network& network, TraceError error, std::uint32_t can_id, Time at);

  TraceFilter filter_;
  TraceOutput& output_;
  std::uint64_t most_;
  Counts counts_;
  std::vector<std::unique_ptr<Network>> networks_; ///< receivers know their addresses
  Network* last_ = nullptr;
  Time next_expiry_ = never;
};

} // namespace blactl::cli
