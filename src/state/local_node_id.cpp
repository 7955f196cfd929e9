#include "blactl/state/local_node_id.hpp"

#include "state/texts.hpp"

#include <unistd.h>

#include <array>
#include <cstring>
#include <random>
#include <utility>
#include <vector>

namespace blactl::state {

using dronecan::NodeId;
using dronecan::TransferId;
using dronecan::TransferIds;

namespace {

using Table = std::array<TransferIds::Slot, TransferIds::slots>;

/// What stands in the way of an ID, for a person.
std::string text(const LockRefusal& refusal, NodeId id) {
  if (refusal.error != 0) {
    return say<texts::node_id_lock_failed>(id.value(), printable(refusal.path),
                                           std::strerror(refusal.error));
  }
  return refusal.pid ? say<texts::node_id_held_by>(id.value(), *refusal.pid)
                     : say<texts::node_id_held>(id.value());
}

/// The file may be shorter than the table. The worst that wrong counters do is one repeated
/// request.
void load(const LockFile& file, Table& table) {
  if (pread(file.descriptor(), table.data(), sizeof table, LockFile::data_offset) < 0) {
    table = {};
  }
}

} // namespace

struct LocalNodeId::State {
  State(NodeId node_id, std::optional<LockFile> lock, TransferId first)
      : id(node_id), file(std::move(lock)),
        transfer_ids(table, first, [this](std::size_t index) { keep(index); }) {
    if (file) {
      load(*file, table);
    }
  }

  /// A full disk loses the memory for the next process, no more.
  void keep(std::size_t index) const {
    if (file) {
      const auto at = LockFile::data_offset + static_cast<long>(index * sizeof table[index]);
      (void)pwrite(file->descriptor(), &table[index], sizeof table[index], at);
    }
  }

  NodeId id;
  std::optional<LockFile> file;
  Table table{};
  TransferIds transfer_ids;
};

LocalNodeId::LocalNodeId(std::unique_ptr<State> state) : state_(std::move(state)) {}

LocalNodeId::LocalNodeId(LocalNodeId&&) noexcept = default;
LocalNodeId& LocalNodeId::operator=(LocalNodeId&&) noexcept = default;
LocalNodeId::~LocalNodeId() = default;

NodeId LocalNodeId::id() const {
  return state_->id;
}

TransferIds& LocalNodeId::transfer_ids() {
  return state_->transfer_ids;
}

Result<LocalNodeId> LocalNodeId::acquire(std::string_view interface, std::optional<NodeId> wanted,
                                         const std::string& shared) {
  const std::vector<NodeId> choices =
      wanted ? std::vector{*wanted} : std::vector{NodeId(127), NodeId(126)};
  const std::string folder = LockFile::folder(shared);
  if (folder.empty()) {
    // Nothing is known of other processes: a random start makes a repeated transfer ID unlikely.
    const auto first =
        static_cast<TransferId>(std::random_device{}() % dronecan::transfer_id_modulus);
    return LocalNodeId(std::make_unique<State>(choices.front(), std::nullopt, first));
  }
  std::string holders;
  for (const NodeId id : choices) {
    auto locked = LockFile::take(folder, interface, std::to_string(id.value()));
    if (locked) {
      return LocalNodeId(std::make_unique<State>(id, std::move(*locked), TransferId{0}));
    }
    holders += holders.empty() ? "" : ", ";
    holders += text(locked.error(), id);
  }
  return fail(Code::no_local_node_id, say<texts::no_local_node_id>(interface, holders),
              say<texts::no_local_node_id_hint>());
}

LocalNodeId LocalNodeId::unshared(std::optional<NodeId> wanted) {
  return LocalNodeId(
      std::make_unique<State>(wanted.value_or(NodeId(127)), std::nullopt, TransferId{0}));
}

} // namespace blactl::state
