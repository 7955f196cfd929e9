#include "blactl/fleet/restart.hpp"

#include "blactl/dronecan/allocator.hpp"

#include "fleet/recognizer.hpp"

#include <algorithm>
#include <chrono>
#include <ranges>

namespace blactl::fleet {

using dronecan::NodeId;
using dronecan::UniqueId;

namespace {

using namespace std::chrono_literals;

constexpr Duration start_up_time = 5s;
constexpr Duration allocation_time = 2s; // one servo after the other, about 1 s each

/// The IDs that the servos had: each gets its own again, and nobody else gets any.
class FormerIds final : public dronecan::AllocationTable {
 public:
  FormerIds(const Roster& roster, std::span<Member* const> servos) : roster_(roster) {
    for (const Member* servo : servos) {
      ids_.emplace_back(servo->info->unique_id, servo->id);
    }
  }

  [[nodiscard]] bool serves(dronecan::Bytes prefix) const override {
    return std::ranges::any_of(ids_ | std::views::keys, [&](const UniqueId& unique_id) {
      return std::ranges::equal(std::span(unique_id).first(prefix.size()), prefix);
    });
  }

  [[nodiscard]] std::optional<NodeId> assign(const UniqueId& unique_id) override {
    const auto it = std::ranges::find(ids_, unique_id, &std::pair<UniqueId, NodeId>::first);
    if (it == ids_.end()) {
      return std::nullopt;
    }
    // Somebody else may have taken the ID in the meantime, and not have said yet who it is.
    const Member* now = roster_.find(it->second);
    const bool is_taken = now != nullptr && !now->is_unit(unique_id);
    return is_taken ? std::nullopt : std::optional(it->second);
  }

 private:
  const Roster& roster_;
  std::vector<std::pair<UniqueId, NodeId>> ids_;
};

Duration come_back_time(std::span<Member* const> servos, RestartKind kind) {
  const auto asking = std::ranges::count_if(
      servos, [&](const Member* servo) { return will_ask_for_id(*servo, kind); });
  return start_up_time + asking * allocation_time;
}

} // namespace

bool will_ask_for_id(const Member& servo, RestartKind kind) {
  // What ROM holds is not known before a restart; an ID that is the static one comes from there.
  return !servo.static_node_id || *servo.static_node_id == 0 ||
         (kind == RestartKind::restart && *servo.static_node_id != servo.id.value());
}

RestartResult restart(Session& session, std::span<Member* const> servos, const RestartPlan& plan) {
  const Duration come_back = plan.come_back.value_or(come_back_time(servos, plan.kind));
  FormerIds table(session.roster(), servos);
  dronecan::Allocator allocator(session.node(), table);
  if (plan.may_allocate && session.roster().allocators().empty()) {
    session.attach(allocator);
  }
  const Recognizer recognizer(session, plan.patience);
  RestartPace pace{.distance = plan.stagger};
  std::vector<std::unique_ptr<RestartJob>> jobs;
  for (std::size_t i = 0; i < servos.size(); ++i) {
    const Time start = session.now() + static_cast<Duration::rep>(i) * plan.stagger;
    jobs.push_back(std::make_unique<RestartJob>(
        session.roster(), *servos[i],
        RestartJob::Options{plan.kind, start, come_back, plan.patience, &pace}));
    session.start(*jobs.back());
  }
  RestartResult result;
  if (auto ran = session.run(); !ran) {
    result.broken = ran.error();
  }
  session.detach(allocator);
  result.other_allocator = allocator.other();
  for (std::size_t i = 0; i < servos.size(); ++i) {
    result.servos.push_back({servos[i], jobs[i]->returned(), jobs[i]->error(), jobs[i]->duration(),
                             jobs[i]->is_sent()});
  }
  return result;
}

} // namespace blactl::fleet
