#pragma once
// A trace added up: who sends what how often, and what it costs the bus (--stats).

#include "blactl/base/json_writer.hpp"
#include "blactl/dronecan/ids.hpp"

#include "cli/output/page.hpp"
#include "cli/trace/output.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

class TraceStats final : public TraceOutput {
 public:
  /// Rows beyond these are added up in one: senders, types and interfaces are foreign, memory is
  /// bounded.
  static constexpr std::size_t most_rows = 4096;

  void frame(const Occasion& occasion, const can::Frame& frame, bool wanted) override;
  bool transfer(const Occasion& occasion, const dronecan::Transfer& transfer) override;
  void broken(const Occasion& occasion, TraceError error, std::uint32_t can_id) override;

  /// Tables for people.
  [[nodiscard]] std::string text(const Page& page) const;
  /// The members "stats" and "buses".
  void write(JsonWriter& json) const;

 private:
  struct Row {
    std::size_t bus = 0; ///< place in buses_
    dronecan::Kind kind{};
    std::uint16_t data_type_id = 0;
    std::uint8_t source = 0;
    bool is_rest = false; ///< of all for which there was no row
    std::uint64_t frames = 0, bits = 0, transfers = 0, bytes = 0, errors = 0;
  };

  /// All that was heard on one interface, whatever the filter says.
  struct Bus {
    std::string name;
    WallTime first{}, last{};
    std::uint64_t frames = 0, bits = 0;

    [[nodiscard]] Duration duration() const { return last - first; }
  };

  [[nodiscard]] std::size_t bus_of(std::string_view name);
  [[nodiscard]] std::vector<std::string> cells(const Row& row) const;
  [[nodiscard]] Row& row_of(std::string_view interface, const dronecan::Header& header);

  std::vector<Bus> buses_;
  std::map<std::uint64_t, Row> rows_; ///< in the order of the table
};

} // namespace blactl::cli
