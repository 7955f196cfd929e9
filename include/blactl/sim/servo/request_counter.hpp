#pragma once
// Counts the requests to a simulated servo, for faults after a given number of them.

#include "blactl/dronecan/transfer.hpp"
#include "blactl/sim/servo/servo_faults.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace blactl::sim {

/// The kind of a request to one of the four services (section 2.2). Empty: another service, or a
/// malformed request.
[[nodiscard]] std::optional<RequestKind> request_kind(const dronecan::Transfer& request);

class RequestCounter {
 public:
  /// `faults`: ServoFaults::restart_after_answer.
  explicit RequestCounter(std::vector<RestartAfterAnswer> faults) : faults_(std::move(faults)) {}

  /// Counts a request. Returns whether the servo restarts after its response.
  [[nodiscard]] bool restarts_after(RequestKind kind);

 private:
  static constexpr std::size_t kinds = 6;

  std::vector<RestartAfterAnswer> faults_;
  std::array<std::uint32_t, kinds> counts_{}; ///< by RequestKind; `any` counts all
};

} // namespace blactl::sim
