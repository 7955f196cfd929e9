#include "fleet/change/asking_copies.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/dronecan/allocator.hpp"

#include "fleet/change/id_texts.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <ranges>
#include <set>

namespace blactl::fleet {
namespace {

using dronecan::NodeId;
using dronecan::UniqueId;

/// A unit repeats its request after 0.6 s to 1 s and waits up to 0.4 s before each further part
/// (1.Allocation.uavcan); one part may be lost.
constexpr Duration asking_time = std::chrono::seconds(4);

/// Hears whole unique IDs and gives no ID.
class UniqueIds final : public dronecan::AllocationTable {
 public:
  explicit UniqueIds(std::set<UniqueId> awaited) : awaited_(std::move(awaited)) {}

  [[nodiscard]] bool serves(dronecan::Bytes prefix) const override {
    return std::ranges::any_of(awaited_, [&](const UniqueId& unique_id) {
      return dronecan::begins_with(unique_id, prefix);
    });
  }

  [[nodiscard]] std::optional<NodeId> assign(const UniqueId& unique_id,
                                             NodeId /*preferred*/) override {
    awaited_.erase(unique_id);
    return std::nullopt;
  }

  [[nodiscard]] const std::set<UniqueId>& awaited() const { return awaited_; }

 private:
  std::set<UniqueId> awaited_;
};

/// A unit asks before it is heard under its ID; later it is another one, or has restarted.
bool may_be_asked_for(const Roster& roster, const Member& member) {
  const auto unique_id = member.unique_id();
  const auto asked = unique_id ? roster.asked_at(*unique_id) : std::nullopt;
  return asked && *asked > member.first_heard;
}

} // namespace

std::vector<Error> asking_copies(Session& session, std::span<const NodeId> nodes) {
  const Roster& roster = session.roster();
  std::map<UniqueId, NodeId> servos;
  for (const NodeId id : nodes) {
    if (const Member member = roster.member(id); may_be_asked_for(roster, member)) {
      servos.emplace(*member.unique_id(), id);
    }
  }
  if (servos.empty() || !roster.allocators().empty()) {
    return {};
  }
  const auto unique_ids = servos | std::views::keys;
  UniqueIds heard(std::set<UniqueId>(unique_ids.begin(), unique_ids.end()));
  dronecan::Allocator allocator(session.node(), heard);
  session.attach(allocator);
  const auto lived =
      session.live_until(session.now() + asking_time, [&] { return heard.awaited().empty(); });
  session.detach(allocator);
  if (!lived) {
    return {lived.error()};
  }
  std::vector<Error> errors;
  for (const auto& [unique_id, id] : servos) {
    const Member member = roster.member(id);
    const bool runs_beside = member.is_unit(unique_id) &&
                             member.last_heard > roster.asked_at(unique_id).value_or(Time::max());
    if (runs_beside && !heard.awaited().contains(unique_id)) {
      errors.push_back({Code::duplicate_unique_id,
                        say<texts::same_unique_id>(id.value(), hex(unique_id)),
                        say<texts::same_unique_id_hint>(), id.value()});
    }
  }
  return errors;
}

} // namespace blactl::fleet
