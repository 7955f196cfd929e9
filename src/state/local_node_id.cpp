#include "blactl/state/local_node_id.hpp"

#include "blactl/base/system_error.hpp"

#include "state/texts.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <random>
#include <tuple>
#include <utility>

namespace blactl::state {

using dronecan::NodeId;
using dronecan::TransferId;
using dronecan::TransferIds;

namespace {

using Table = std::array<TransferIds::Slot, TransferIds::slots>;

/// The obstacle to an ID, for people.
std::string text(const LockRefusal& refusal, NodeId id) {
  if (refusal.error != 0) {
    return say<texts::node_id_lock_failed>(id.value(), printable(refusal.path),
                                           system_reason(refusal.error));
  }
  return refusal.pid ? say<texts::node_id_held_by>(id.value(), *refusal.pid)
                     : say<texts::node_id_held>(id.value());
}

/// The file may be shorter than the table. Wrong counters cause at worst one repeated request.
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

  /// A full disk only loses the counters for the next process.
  void keep(std::size_t index) const {
    if (file) {
      const auto at = LockFile::data_offset + static_cast<long>(index * sizeof table[index]);
      (void)pwrite(file->descriptor(), &table[index], sizeof table[index], at);
    }
  }

  /// The offset, after the counters, of the mark that another node was heard with this ID.
  static constexpr long mark_offset = LockFile::data_offset + sizeof(Table);

  void mark_as_foreign() const {
    constexpr char mark = 1;
    if (file) {
      (void)pwrite(file->descriptor(), &mark, sizeof mark, mark_offset);
    }
  }

  [[nodiscard]] bool was_foreign() const {
    char mark = 0;
    return file && pread(file->descriptor(), &mark, sizeof mark, mark_offset) == sizeof mark &&
           mark != 0;
  }

  NodeId id;
  std::optional<LockFile> file;
  Table table{};
  TransferIds transfer_ids;
};

LocalNodeId::LocalNodeId(LockPlace place, Candidates candidates)
    : place_(std::move(place)), candidates_(std::move(candidates)) {
  if (candidates_.empty()) {
    candidates_.assign(tool_ids.begin(), tool_ids.end());
  }
}

LocalNodeId::LocalNodeId(LocalNodeId&&) noexcept = default;
LocalNodeId& LocalNodeId::operator=(LocalNodeId&&) noexcept = default;
LocalNodeId::~LocalNodeId() = default;

NodeId LocalNodeId::id() const {
  return state_->id;
}

TransferIds& LocalNodeId::transfer_ids() {
  return state_->transfer_ids;
}

std::string LocalNodeId::passed_over() const {
  std::string all;
  for (const auto& [id, obstacle] : obstacles_) {
    all += (all.empty() ? "" : ", ") + obstacle;
  }
  return all;
}

std::string LocalNodeId::lock_file() const {
  return state_->file ? state_->file->path() : std::string();
}

/// Takes the first available candidate. One that another node had is the last resort: that node may
/// be gone.
Result<void> LocalNodeId::take_one() {
  const bool is_shared = !place_.interface.empty();
  const std::string folder = is_shared ? LockFile::folder(place_) : std::string();
  if (folder.empty()) {
    // If nothing is known of other processes, a random start makes a repeated transfer ID unlikely.
    const unsigned first = is_shared ? std::random_device{}() % dronecan::transfer_id_modulus : 0;
    state_ =
        std::make_unique<State>(candidates_.front(), std::nullopt, static_cast<TransferId>(first));
    return {};
  }
  std::erase_if(obstacles_, [this](const auto& obstacle) {
    return std::ranges::find(candidates_, obstacle.first) != candidates_.end();
  });
  std::unique_ptr<State> last_resort;
  bool somebody_holds = false;
  for (const NodeId id : candidates_) {
    auto locked = LockFile::take(folder, place_, std::to_string(id.value()));
    if (!locked) {
      somebody_holds = somebody_holds || locked.error().error == 0;
      obstacles_.emplace_back(id, text(locked.error(), id));
      continue;
    }
    auto free = std::make_unique<State>(id, std::move(*locked), TransferId{0});
    if (!free->was_foreign()) {
      state_ = std::move(free);
      return {};
    }
    obstacles_.emplace_back(id, say<texts::node_id_was_foreign>(id.value()));
    if (!last_resort) {
      last_resort = std::move(free);
    }
  }
  if (last_resort) {
    state_ = std::move(last_resort);
    std::erase_if(obstacles_, [this](const auto& obstacle) { return obstacle.first == id(); });
    return {};
  }
  return fail(Code::no_local_node_id,
              say<texts::no_local_node_id>(printable(place_.interface), passed_over()),
              somebody_holds ? say<texts::no_local_node_id_hint>()
                             : say<texts::lock_files_block_hint>(printable(folder)));
}

Result<LocalNodeId> LocalNodeId::acquire(LockPlace place, Candidates candidates) {
  LocalNodeId local(std::move(place), std::move(candidates));
  if (auto taken = local.take_one(); !taken) {
    return std::unexpected(taken.error());
  }
  return local;
}

LocalNodeId LocalNodeId::unshared(Candidates candidates) {
  LocalNodeId local({}, std::move(candidates));
  std::ignore = local.take_one(); // nobody can refuse it
  return local;
}

Result<void> LocalNodeId::give_way(std::string_view interface) {
  const NodeId taken = id();
  state_->mark_as_foreign();
  std::erase(candidates_, taken);
  obstacles_.emplace_back(taken, say<texts::node_id_foreign>(taken.value()));
  if (!candidates_.empty()) {
    return take_one();
  }
  const bool is_alone = obstacles_.size() == 1;
  return std::unexpected(Error{is_alone ? Code::duplicate_node_id : Code::no_local_node_id,
                               is_alone ? say<texts::own_id_in_use>(taken.value(), interface)
                                        : say<texts::no_local_node_id>(interface, passed_over()),
                               say<texts::own_id_in_use_hint>(taken.value()),
                               is_alone ? std::optional(taken.value()) : std::nullopt});
}

} // namespace blactl::state
