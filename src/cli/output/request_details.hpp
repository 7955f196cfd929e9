#pragma once
// Details on the requests of a session for -v.

#include "blactl/dronecan/node.hpp"

#include "cli/output/reporter.hpp"

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace blactl::cli {

/// Prints lost responses, repeated requests, and those that are normally sent once only (save,
/// erase, restart) but had to be sent again.
class RequestDetails {
 public:
  /// `reporter` must outlive this.
  explicit RequestDetails(const Reporter& reporter) : reporter_(reporter) {}

  void asked(const dronecan::Request& request);
  void unanswered(const dronecan::Request& request, int tries) const;

 private:
  using Key = std::tuple<std::uint8_t, std::uint16_t, std::vector<std::uint8_t>>;

  const Reporter& reporter_;
  std::map<Key, unsigned> once_; ///< how often each was sent
};

} // namespace blactl::cli
