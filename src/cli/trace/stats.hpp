#pragma once
// Statistics of a trace: the transfers of each node, their losses, and their share of the bus load
// (--stats).

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/statistics/bus_statistics.hpp"

#include "cli/output/page.hpp"
#include "cli/trace/output.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// Interfaces are separate; there are at most Tracer::most_interfaces, so that all of it takes at
/// most some 25 MB.
class TraceStats final : public TraceOutput {
 public:
  /// Not filtered: the load is that of all frames.
  struct Bus {
    std::string name;
    fleet::BusStatistics statistics{};
  };

  void frame(const Heard& heard, bool wanted) override;
  bool transfer(const Occasion& occasion, const dronecan::Transfer& transfer) override;
  void broken(const Occasion& occasion, TraceError error, std::uint32_t can_id) override;

  /// Advances to `now`, of the clock of the frames, without traffic.
  void pass(Time now);

  /// Tables for people.
  [[nodiscard]] std::string text(const Page& page) const;
  /// The members of the document.
  void write(JsonWriter& json) const;

 private:
  [[nodiscard]] fleet::BusStatistics& statistics_of(std::string_view interface);
  [[nodiscard]] std::string errors_text() const;
  void write_errors(JsonWriter& json) const;

  std::vector<Bus> buses_;
  std::size_t last_ = 0; ///< index in buses_ of the one looked up last
  std::array<std::uint64_t, trace_errors> errors_{};
};

/// Empty: the bus was heard for too short a time, or its times go backwards.
[[nodiscard]] std::optional<double> per_second(std::uint64_t count,
                                               const fleet::BusStatistics& bus);

/// "12.30"; empty without a number.
[[nodiscard]] std::string fixed(std::optional<double> number, int decimals);

} // namespace blactl::cli
