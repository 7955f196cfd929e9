#pragma once
// Which transfers a person wants to see: --type, --kind, -n.

#include "blactl/base/error.hpp"
#include "blactl/dronecan/transfer.hpp"

#include <array>
#include <bitset>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

namespace blactl::cli {

class TraceFilter {
 public:
  /// Everything passes.
  TraceFilter() { kinds_.fill(true); }

  /// What --type and --kind say; empty: everything.
  struct Wish {
    std::optional<std::string> types{}; ///< names or numbers, comma-separated
    std::optional<std::string> kinds{}; ///< message, request, response
  };

  /// `nodes`: what -n says, which must be node IDs: who a servo is, a listener cannot ask.
  /// Types go in letters of either case. Errors: usage, every fault, with the nearest names of
  /// types.
  [[nodiscard]] static std::expected<TraceFilter, std::vector<Error>>
  make(const Wish& wish, const std::optional<std::string>& nodes);

  /// Whether a transfer with this header is wanted; of a node, what it sends and what is sent to
  /// it.
  [[nodiscard]] bool passes(const dronecan::Header& header) const;

 private:
  /// A number alone means the message and the service.
  struct Type {
    std::uint16_t id;
    std::optional<bool> service;
  };

  void take_types(const std::string& list, std::vector<Error>& faults);
  void take_kinds(const std::string& list);
  void take_nodes(const std::string& list, std::vector<Error>& faults);

  std::vector<Type> types_; ///< empty: all
  std::array<bool, 3> kinds_{};
  std::optional<std::bitset<dronecan::NodeId::max + 1>> nodes_;
};

} // namespace blactl::cli
