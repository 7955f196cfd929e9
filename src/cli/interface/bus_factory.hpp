#pragma once
// From what stands behind -i to a bus (contract, section 2).

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/can/bus.hpp"
#include "blactl/can/replay.hpp"
#include "blactl/can/returning_bus.hpp"
#include "blactl/can/slcan.hpp"
#include "blactl/fleet/files/fleet_file.hpp"
#include "blactl/state/lock_file.hpp"

#include "cli/output/reporter.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::cli {

/// An open bus, and under which name processes of this machine share it.
struct OpenBus {
  std::unique_ptr<can::Bus> bus;
  state::LockPlace place{}; ///< of its lock files: those of a simulated bus lie beside its socket
  /// Opens the same interface once more; empty: what ends there does not come back.
  can::ReturningBus::Opener reopen{};
  const can::ReplayBus* log = nullptr; ///< the bus, if it is one
  can::Slcan* adapter = nullptr;       ///< the same
  /// What a session is told in its place, where it is no bus at all.
  std::optional<fleet::FleetFile> fleet{};
};

/// What kind of interface a name means.
enum class InterfaceKind : unsigned char {
  socketcan,
  slcan,
  mcast,
  simulator,
  scenario,
  replay,
  file,
};

struct InterfaceName {
  InterfaceKind kind = InterfaceKind::socketcan;
  std::string rest; ///< interface name, device with options, socket path, scenario file, log or
                    ///< fleet file; empty: the default
  std::uint8_t bus_number = 0; ///< of a multicast bus
};

/// `can0`, `socketcan:can0`, `slcan:DEV[?…]`, `mcast:N`, `mcast:N?if=IFACE`, `sim:`, `sim:SOCKET`,
/// `sim:SCENARIO.json`, `replay:FILE`, `file:FILE`. Errors: usage.
[[nodiscard]] Result<InterfaceName> parse_interface(std::string_view text);

/// Why nothing can be sent to what stands behind -i, a log or a fleet file; empty: it can, as far
/// as its name tells.
[[nodiscard]] std::optional<Error> takes_no_frames(std::string_view text);

/// What to look at where nothing was heard, by the kind of interface that `text` names; `name`: of
/// the open bus. Empty: what is said of servos on any CAN bus fits.
[[nodiscard]] std::string silence_hint(std::string_view text, std::string_view name);

/// Where lock files of a network interface lie.
[[nodiscard]] state::LockPlace lock_place(std::string link);

/// The interface that `text` names; empty: the only CAN interface that is up.
/// Errors: interface with the list of what is there, permission, bad_file (scenario, fleet file),
/// usage. `profiles` and `reporter` outlive the bus. `inquires`: an adapter is asked what it is.
[[nodiscard]] Result<OpenBus> open_bus(std::string_view text, const bla::Profiles& profiles,
                                       const Reporter& reporter, bool inquires = false);

} // namespace blactl::cli
