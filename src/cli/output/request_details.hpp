#pragma once
// What -v tells of the requests of a session.

#include "blactl/dronecan/node.hpp"

#include "cli/output/reporter.hpp"

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace blactl::cli {

/// Tells of answers that were lost, of requests that are repeated, and of those that are sent once
/// only (save, erase, restart) and had to be sent once more all the same.
class RequestDetails {
 public:
  /// `reporter` must outlive this.
  explicit RequestDetails(const Reporter& reporter) : reporter_(reporter) {}

  void asked(const dronecan::Request& request);
  void unanswered(const dronecan::Request& request, int tries) const;

 private:
  using Key = std::tuple<std::uint8_t, std::uint16_t, std::vector<std::uint8_t>>;

  const Reporter& reporter_;
  std::map<Key, unsigned> once_; ///< how often each went out
};

} // namespace blactl::cli
