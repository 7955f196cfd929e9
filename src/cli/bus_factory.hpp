#pragma once
// From what stands behind -i to a bus (contract, section 2).

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/can/bus.hpp"

#include "reporter.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace blactl::cli {

/// An open bus, and under which name processes of this machine share it.
struct OpenBus {
  std::unique_ptr<can::Bus> bus;
  std::string lock_name; ///< empty: nobody else can reach it
};

/// What kind of interface a name means.
enum class InterfaceKind : unsigned char { socketcan, slcan, simulator, scenario };

struct InterfaceName {
  InterfaceKind kind = InterfaceKind::socketcan;
  std::string rest; ///< interface name, device with options, socket path or scenario file;
                    ///< empty: the default
};

/// `can0`, `socketcan:can0`, `slcan:DEV[?…]`, `sim:`, `sim:SOCKET`, `sim:SCENARIO.json`. Errors:
/// usage.
[[nodiscard]] Result<InterfaceName> parse_interface(std::string_view text);

/// The interface that `text` names; empty: the only CAN interface that is up.
/// Errors: interface with the list of what is there, permission, bad_file (scenario), usage.
/// `profiles` outlives the bus.
[[nodiscard]] Result<OpenBus> open_bus(std::string_view text, const bla::Profiles& profiles,
                                       const Reporter& reporter);

} // namespace blactl::cli
