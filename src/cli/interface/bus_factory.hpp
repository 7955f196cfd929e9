#pragma once
// Opens the bus named by -i (contract, section 2).

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

/// An open bus, and the name under which processes of this machine share it.
struct OpenBus {
  std::unique_ptr<can::Bus> bus;
  state::LockPlace place{}; ///< of its lock files: for a simulated bus beside its socket
  /// Opens the same interface again; empty: it does not come back once ended.
  can::ReturningBus::Opener reopen{};
  const can::ReplayBus* log = nullptr; ///< the bus, if it is a log
  can::Slcan* adapter = nullptr;       ///< the bus, if it is an adapter
  /// The data for the session in place of a bus.
  std::optional<fleet::FleetFile> fleet{};
};

/// The kind of an interface, by its name.
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
  std::uint8_t bus_number = 0; ///< for a multicast bus
};

/// `can0`, `socketcan:can0`, `slcan:DEV[?…]`, `mcast:N`, `mcast:N?if=IFACE`, `sim:`, `sim:SOCKET`,
/// `sim:SCENARIO.json`, `replay:FILE`, `file:FILE`. Errors: usage.
[[nodiscard]] Result<InterfaceName> parse_interface(std::string_view text);

/// The reason why nothing can be sent to this interface, a log or a fleet file; empty: it can,
/// judging by its name.
[[nodiscard]] std::optional<Error> takes_no_frames(std::string_view text);

/// The hint if nothing was heard, by the kind of interface of `text`; `name`: of the open bus.
/// Empty: the general hint for servos on a CAN bus fits.
[[nodiscard]] std::string silence_hint(std::string_view text, std::string_view name);

/// The place of a network interface's lock files.
[[nodiscard]] state::LockPlace lock_place(std::string link);

/// Opens the interface named by `text`; empty: the only CAN interface that is up. Errors: interface
/// with the list of interfaces, permission, bad_file (scenario, fleet file), usage. `profiles` and
/// `reporter` outlive the bus. `inquires`: asks an adapter for its identification.
[[nodiscard]] Result<OpenBus> open_bus(std::string_view text, const bla::Profiles& profiles,
                                       const Reporter& reporter, bool inquires = false);

} // namespace blactl::cli
