#include "cli/stores.hpp"

#include "blactl/can/simbus.hpp"
#include "blactl/state/state_folder.hpp"

#include "cli/interface/scheme.hpp"

#include <filesystem>
#include <string>
#include <system_error>
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

/// Whether a simulation has begun since the last proof: those are of another ROM, with the same
/// unique IDs and, on a virtual clock, at the same time.
bool is_newer_than_proofs(std::string_view socket, const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  const auto proven = fs::last_write_time(folder + "/proofs.db", error);
  if (error) {
    return false;
  }
  const auto began =
      fs::last_write_time(socket.empty() ? can::default_socket_path() : fs::path(socket), error);
  return !error && proven < began;
}

/// A private simulation ends with the process.
Result<state::ProofStore> open_proofs(std::string_view interface, state::Access access) {
  const auto name = parse_interface(interface);
  if (!name || !name->is(Behind::simulator)) {
    return open_store<state::ProofStore>(interface, access);
  }
  const bool is_private = name->rest.empty() && !can::SimBus::is_served(can::default_socket_path());
  const bool is_new = is_newer_than_proofs(name->rest, stores_folder(interface));
  if (is_private || (is_new && access == state::Access::read)) {
    return state::ProofStore::unshared();
  }
  auto proofs = open_store<state::ProofStore>(interface, access);
  const auto cleared = proofs && is_new ? proofs->clear() : Result<void>();
  return cleared ? std::move(proofs) : std::unexpected(cleared.error());
}

} // namespace

std::string stores_folder(std::string_view interface) {
  std::string folder = state::state_folder();
  if (!folder.empty() && names(interface, Behind::simulator)) {
    folder.append("/").append(state::simulated_folder);
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
  auto proofs = open_proofs(interface, access);
  if (!proofs) {
    return std::unexpected(std::move(proofs.error()));
  }
  return fleet::History(std::string(command), std::move(*snapshots), std::move(*proofs));
}

Result<state::LedgerStore> open_ledger(std::string_view interface, state::Access access) {
  return open_store<state::LedgerStore>(interface, access);
}

Result<state::CounterStore> open_counters(std::string_view interface, state::Access access) {
  return open_store<state::CounterStore>(interface, access);
}

} // namespace blactl::cli
