#pragma once
// Which transfers a person wants to see: --type, --kind, -n.

#include "blactl/base/error.hpp"
#include "blactl/dronecan/transfer.hpp"

#include "cli/options.hpp"

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace blactl::cli {

class TraceFilter {
 public:
  /// Everything passes.
  TraceFilter() { kinds_.fill(true); }

  /// `nodes`: what -n says, which must be node IDs: who a servo is, a listener cannot ask.
  /// Errors: usage, with the nearest names of types.
  [[nodiscard]] static Result<TraceFilter> make(const TraceOptions& options,
                                                const std::optional<std::string>& nodes);

  /// Whether a transfer with this header is wanted; of a node, what it sends and what is sent to
  /// it.
  [[nodiscard]] bool passes(const dronecan::Header& header) const;

 private:
  /// A number alone means the message and the service.
  struct Type {
    std::uint16_t id;
    std::optional<bool> service;
  };

  [[nodiscard]] Result<void> take_types(const std::string& list);
  [[nodiscard]] Result<void> take_kinds(const std::string& list);
  [[nodiscard]] Result<void> take_nodes(const std::string& list);

  std::vector<Type> types_; ///< empty: all
  std::array<bool, 3> kinds_{};
  std::optional<std::bitset<dronecan::NodeId::max + 1>> nodes_;
};

} // namespace blactl::cli
