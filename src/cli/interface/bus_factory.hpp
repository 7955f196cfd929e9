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

#include <functional>
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

/// What is to be opened.
struct OpenRequest {
  std::string_view text;         ///< as typed
  const bla::Profiles& profiles; ///< this and the next outlive the bus
  const Reporter& reporter;
  bool inquires = false; ///< an adapter is asked what it is
  std::string rest{};    ///< of `text`, behind the colon
};

/// Where lock files of a network interface lie.
[[nodiscard]] state::LockPlace lock_place(std::string link);

/// Opens the interface named by `request.text`; empty: the only CAN interface that is up; `rest` is
/// filled in here. Errors: interface with the list of interfaces, permission, bad_file (scenario,
/// fleet file), usage.
[[nodiscard]] Result<OpenBus> open_bus(const OpenRequest& request);

/// Such a function: whoever runs commands in its own process may bring its own bus.
using BusOpener = std::function<Result<OpenBus>(const OpenRequest&)>;

} // namespace blactl::cli
