#pragma once
// How much waits for a client of the simulated bus that does not read.

#include <cstddef>

namespace blactl::sim {

/// Frames that are kept for a client while it does not run, beyond what its socket holds: as many
/// as can::SocketCan asks the kernel for, 2.5 s of a full bus. What comes beyond is lost, and told.
/// The socket alone holds some 280, 37 ms: on a busy machine a process may wait longer than that.
constexpr std::size_t backlog_capacity = 20'000;

} // namespace blactl::sim
