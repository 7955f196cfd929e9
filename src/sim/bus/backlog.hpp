#pragma once
// The backlog of a client of the simulated bus that does not read.

#include <cstddef>

namespace blactl::sim {

/// Frames kept for a client while it does not run, in addition to those in its socket: as many as
/// can::SocketCan asks the kernel for, 2.5 s of a full bus. Further frames are lost, and reported
/// as such. The socket alone holds some 280, 37 ms: on a busy machine a process may wait longer
/// than that.
constexpr std::size_t backlog_capacity = 20'000;

} // namespace blactl::sim
