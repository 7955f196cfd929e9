#include "cli/stores.hpp"

#include "blactl/can/simbus.hpp"
#include "blactl/state/state_folder.hpp"

#include "cli/interface/scheme.hpp"

#include <string>
#include <utility>

namespace blactl::cli {
namespace {

/// Opens the store for the servos behind `interface`: in memory for a private simulation, which
/// ends with the process.
template <class Store> Result<Store> open_store(std::string_view interface, state::Access access) {
  if (names(interface, Behind::scenario)) {
    return Store::unshared();
  }
  return Store::open(stores_folder(interface), access);
}

} // namespace

std::string stores_folder(std::string_view interface) {
  std::string folder = state::state_folder();
  if (!folder.empty() && names(interface, Behind::simulator)) {
    folder += "/simulated";
  }
  return folder;
}

Result<state::AllocationStore> open_allocations(std::string_view interface, state::Access access) {
  return open_store<state::AllocationStore>(interface, access);
}

Result<state::SnapshotStore> open_snapshots(std::string_view interface, state::Access access) {
  return open_store<state::SnapshotStore>(interface, access);
}

Result<fleet::History> open_history(std::string_view interface, std::string_view command,
                                    state::Access access) {
  auto snapshots = open_store<state::SnapshotStore>(interface, access);
  if (!snapshots) {
    return std::unexpected(std::move(snapshots.error()));
  }
  // a private simulation has the unique IDs of the one before it, but another ROM
  const auto name = parse_interface(interface);
  const bool is_private = name && name->is(Behind::simulator) && name->rest.empty() &&
                          !can::SimBus::is_served(can::default_socket_path());
  auto proofs =
      is_private ? state::ProofStore::unshared() : open_store<state::ProofStore>(interface, access);
  if (!proofs) {
    return std::unexpected(std::move(proofs.error()));
  }
  return fleet::History(std::string(command), std::move(*snapshots), std::move(*proofs));
}

} // namespace blactl::cli
