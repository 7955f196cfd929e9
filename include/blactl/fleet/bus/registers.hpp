#pragma once
// Registers of a servo as DroneCAN parameters: one question each by GetSet (specification 2.3).

#include "blactl/base/error.hpp"
#include "blactl/bla/parameter.hpp"
#include "blactl/dronecan/node.hpp"

#include <cstdint>

namespace blactl::fleet {

/// How patiently one question is asked (--timeout, --retries).
struct Patience {
  Duration timeout = std::chrono::milliseconds(500);
  int retries = 2;
};

/// A question of `type` with this payload, as patient as asked for.
[[nodiscard]] dronecan::Request ask(dronecan::NodeId server, const dronecan::DataType& type,
                                    const dronecan::Payload& payload, const Patience& patience);

[[nodiscard]] dronecan::Request read_register(dronecan::NodeId server, bla::Address address,
                                              const Patience& patience);

[[nodiscard]] dronecan::Request write_register(dronecan::NodeId server, bla::Address address,
                                               std::int64_t raw, const Patience& patience);

/// What stands behind an outcome without an answer. `subject` is what was asked, for the message.
/// Errors: timeout, no_acknowledge (it did not leave), interrupted, not_recorded.
[[nodiscard]] Error no_answer(const dronecan::Outcome& outcome, dronecan::NodeId server,
                              std::string_view subject);

/// The register's number that a GetSet answer carries. Errors: refused (no value, no integer, or
/// one that the register cannot hold), and those of no_answer().
[[nodiscard]] Result<std::int64_t> register_value(const dronecan::Outcome& outcome,
                                                  dronecan::NodeId server, bla::Address address,
                                                  bla::Width width);

} // namespace blactl::fleet
