#pragma once
// The transfers that the user wants to see: --type, --kind, -n.

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
  /// A filter that everything passes.
  TraceFilter() { kinds_.fill(true); }

  /// The values of --type and --kind; empty: everything.
  struct Wish {
    std::optional<std::string> types{}; ///< names or numbers, comma-separated
    std::optional<std::string> kinds{}; ///< message, request, response
  };

  /// `nodes`: the value of -n, which must be node IDs, as a listener cannot identify servos. Types
  /// may be in upper or lower case. Errors: usage, all errors, with the nearest type names.
  [[nodiscard]] static std::expected<TraceFilter, std::vector<Error>>
  make(const Wish& wish, const std::optional<std::string>& nodes);

  /// Whether a transfer with this header is wanted; for a node, its own transfers and those to it.
  [[nodiscard]] bool passes(const dronecan::Header& header) const;

 private:
  /// A plain number matches the message and the service.
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
