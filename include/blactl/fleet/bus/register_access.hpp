#pragma once
// Registers of a servo as DroneCAN parameters: one GetSet request each (specification 2.3).

#include "blactl/base/error.hpp"
#include "blactl/bla/parameter.hpp"
#include "blactl/dronecan/node.hpp"

#include <cstdint>

namespace blactl::fleet {

/// Timeout and retries of a request (--timeout, --retries).
struct Patience {
  Duration timeout = std::chrono::milliseconds(500);
  int retries = 2;
};

/// A request of `type` with this payload and patience.
[[nodiscard]] dronecan::Request ask(dronecan::NodeId server, const dronecan::DataType& type,
                                    const dronecan::Payload& payload, const Patience& patience);

[[nodiscard]] dronecan::Request read_register(dronecan::NodeId server, bla::Address address,
                                              const Patience& patience);

[[nodiscard]] dronecan::Request write_register(dronecan::NodeId server, bla::Address address,
                                               std::int64_t raw, const Patience& patience);

/// The error of an outcome without a response. `subject` is what was requested, for the message.
/// Errors: timeout, no_acknowledge (it did not leave), interrupted, not_recorded.
[[nodiscard]] Error no_answer(const dronecan::Outcome& outcome, dronecan::NodeId server,
                              std::string_view subject);

/// The raw value in a GetSet response. Errors: refused (no value, not an integer, or outside of the
/// register's width), and those of no_answer().
[[nodiscard]] Result<std::int64_t> register_value(const dronecan::Outcome& outcome,
                                                  dronecan::NodeId server, bla::Address address,
                                                  bla::Width width);

} // namespace blactl::fleet
