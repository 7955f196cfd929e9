#pragma once
// What is wrong with an interface, a bus and its nodes, how bad it is, and what mends it.

#include "blactl/bla/profile.hpp"
#include "blactl/can/link.hpp"
#include "blactl/can/link_setup.hpp"
#include "blactl/can/slcan_adapter.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/bus/traffic.hpp"
#include "blactl/fleet/characterize/findings.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

struct Diagnosis {
  std::string code; ///< one word for scripts: "bit_rate"
  bla::Level level = bla::Level::notice;
  std::optional<dronecan::NodeId> node{};
  std::string text; ///< what is wrong
  std::string fix;  ///< the command that mends it, or where to look
};

using Diagnoses = std::vector<Diagnosis>;

/// How the kernel has set the controller up: BLA servos talk at 1 Mbit/s with the sample point at
/// 87.5 % (Futaba 2.1); what an interface that is no controller lacks is not missed.
[[nodiscard]] Diagnoses diagnose_link(const can::Link& link);

/// The part of it that mending() mends.
[[nodiscard]] Diagnoses diagnose_setup(const can::Link& link);

/// What is to be done to an interface so that diagnose_setup() has nothing left: a controller is
/// set up, anything else is raised.
[[nodiscard]] can::LinkSetup mending(const can::Link& link);

/// What an slcan adapter says of itself, and what speaks on its port instead of slcan.
[[nodiscard]] Diagnoses diagnose_adapter(const can::SlcanAnswers& answers,
                                         can::ForeignSpeech speech);

/// What was heard: nothing, much, other than DroneCAN, error frames. `silence`: what the transport
/// knows of why nothing was heard.
[[nodiscard]] Diagnoses diagnose_traffic(const Traffic& traffic,
                                         const std::optional<Error>& silence);

/// Conflicts, and what single nodes do or lack. `limits`: what was read of the angle limits.
[[nodiscard]] Diagnoses diagnose_nodes(const Findings& findings, const Traffic& traffic,
                                       std::span<const Snapshot> limits);

/// The nodes that could not be identified. `ends`: how each identification ended; what a recording
/// lacks is no finding.
[[nodiscard]] Diagnoses diagnose_identifications(const Findings& findings,
                                                 const std::vector<std::optional<Error>>& ends);

/// What diagnose_nodes() wants to know of a servo that somebody commands.
[[nodiscard]] std::vector<const bla::Parameter*> registers_to_diagnose(const Servo& servo);

/// An error that ended the looking, where it tells of the bus: bus_off, no_acknowledge.
[[nodiscard]] std::optional<Diagnosis> diagnose_end(const Error& error);

} // namespace blactl::fleet
