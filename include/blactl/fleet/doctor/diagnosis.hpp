#pragma once
// Diagnoses of an interface, a bus and its nodes: what is wrong, how severe it is, and how to fix
// it.

#include "blactl/bla/profile.hpp"
#include "blactl/can/link.hpp"
#include "blactl/can/link_setup.hpp"
#include "blactl/can/slcan_adapter.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/bus/traffic.hpp"
#include "blactl/fleet/characterize/findings.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

struct Diagnosis {
  std::string code; ///< one word for scripts: "bit_rate"
  bla::Level level = bla::Level::notice;
  std::optional<dronecan::NodeId> node{};
  std::string text; ///< the problem
  std::string fix;  ///< the command that fixes it, or where to look
};

using Diagnoses = std::vector<Diagnosis>;

/// Checks the setup of the controller by the kernel: BLA servos use 1 Mbit/s with the sample point
/// at 87.5 % (Futaba 2.1). Interfaces without a controller need no such setup.
[[nodiscard]] Diagnoses diagnose_link(const can::Link& link);

/// The part of diagnose_link() that mending() fixes.
[[nodiscard]] Diagnoses diagnose_setup(const can::Link& link);

/// The setup that leaves diagnose_setup() without findings: it sets up a controller, and brings any
/// other interface up.
[[nodiscard]] can::LinkSetup mending(const can::Link& link);

/// Checks an slcan adapter's responses, or whatever else uses its port instead of slcan.
[[nodiscard]] Diagnoses diagnose_adapter(const can::SlcanAnswers& answers,
                                         can::ForeignSpeech speech);

/// Checks the traffic: none, a high load, other than DroneCAN, error frames. `silence`: the
/// transport's reason why nothing was heard.
[[nodiscard]] Diagnoses diagnose_traffic(const Traffic& traffic,
                                         const std::optional<Error>& silence);

/// Whether a node has sent one NodeStatus in a time in which two are due: a second one tells its
/// period.
[[nodiscard]] bool awaits_status(const Roster& roster, const Traffic& traffic);

/// Why servos are looked at.
enum class MotionLook : std::uint8_t {
  named,    ///< somebody asks about these: everything is told
  commanded ///< they are commanded: only what keeps them from following is told
};

/// Conflicts, and problems of single nodes. `limits`: the angle limits as read. Who commands servos
/// is no problem to somebody who asks why one does not move.
[[nodiscard]] Diagnoses diagnose_nodes(const Findings& findings, const Traffic& traffic,
                                       std::span<const Snapshot> limits, MotionLook look);

/// The nodes that could not be identified. `ends`: the end of each identification; missing parts of
/// a recording are not findings.
[[nodiscard]] Diagnoses diagnose_identifications(const Findings& findings,
                                                 const std::vector<std::optional<Error>>& ends);

/// The diagnosis for an error that ended the examination, if it concerns the bus: bus_off,
/// no_acknowledge.
[[nodiscard]] std::optional<Diagnosis> diagnose_end(const Error& error);

} // namespace blactl::fleet
