#include "blactl/fleet/change/carry_out.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/dronecan/allocator.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/ticker.hpp"
#include "blactl/fleet/change/former_ids.hpp"

#include "fleet/change/id_texts.hpp"
#include "fleet/change/last_look.hpp"
#include "fleet/change/texts.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <list>
#include <map>
#include <span>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;
using dronecan::UniqueId;

namespace {

using namespace std::chrono_literals;

constexpr Duration start_up_time = 5s;
constexpr Duration allocation_time = 2s; // one servo after the other, about 1 s each
constexpr Duration leaving_time = 20ms;

/// The IDs of the servos that are changed.
std::map<UniqueId, NodeId> ids_of(std::span<const Plan> plans) {
  std::map<UniqueId, NodeId> ids;
  for (const Plan& plan : plans) {
    if (const Servo& servo = plan.before.servo; servo.unique_id) {
      ids.emplace(*servo.unique_id, servo.id);
    }
  }
  return ids;
}

/// Whether this servo will have to ask for a node ID when it starts, as far as known.
bool will_ask_for_id(const Plan& plan) {
  if (!plan.restart) {
    return false;
  }
  const auto expected = bla::find(plan.expected, bla::address::static_node_id);
  const auto id = expected ? expected : plan.before.raw(bla::address::static_node_id);
  // the contents of ROM are unknown before a restart; an ID equal to the static one is from there
  return id.value_or(0) == 0 ||
         (plan.restart == RestartKind::restart && *id != plan.before.servo.id.value());
}

Duration come_back_time(std::span<const Plan> plans) {
  return start_up_time + std::ranges::count_if(plans, will_ask_for_id) * allocation_time;
}

/// Requests still in the kernel's queue may take effect later.
std::optional<Error> check_sent(Session& session) {
  // our NodeStatus may be due: it is not a write, and leaves at once if anything does
  if (session.unsent() > 0) {
    if (const auto lived = session.live_until(session.now() + leaving_time); !lived) {
      return lived.error();
    }
  }
  const std::size_t frames = session.unsent();
  return frames == 0 ? std::nullopt
                     : std::optional(Error{Code::no_acknowledge,
                                           say<texts::not_written>(frames, session.interface()),
                                           {},
                                           std::nullopt});
}

Progress progress_of(const std::list<ChangeJob>& jobs, Duration elapsed) {
  Progress progress{.servos = jobs.size(), .elapsed = elapsed};
  for (const ChangeJob& job : jobs) {
    if (job.has_ended()) {
      ++progress.ended;
    } else {
      (job.is_away() ? progress.away : progress.at_work).push_back(job.result().servo.id);
    }
  }
  return progress;
}

/// Adds a hint for a servo that is not back because it asks for a node ID: its own job only knows
/// that it got none.
void explain_waiting(const Plan& plan, const FormerIds& table, ChangeResult& result) {
  const auto& unique_id = plan.before.servo.unique_id;
  if (!unique_id || !result.error || result.error->hint != say<texts::waits_for_id_hint>()) {
    return;
  }
  const auto saved = bla::find(plan.expected, bla::address::static_node_id).value_or(0);
  if (auto hint = table.hint(*unique_id)) {
    result.error->hint = std::move(*hint);
  } else if (plan.restart == RestartKind::save && saved != 0) {
    result.error->hint = say<texts::static_id_lost_hint>(saved, hex(*unique_id));
  }
}

/// The reason why nothing must be changed, once this was recorded or not. Then the bus is heard:
/// the kernel buffers little, and a disk may be slow.
std::optional<Error> judge(const Result<void>& recorded, Session& session, const Manner& manner) {
  if (!recorded && manner.not_recorded) {
    if (auto refused = manner.not_recorded(recorded.error())) {
      return refused;
    }
  }
  const auto heard = session.live_until(session.now());
  return heard ? std::nullopt : std::optional(heard.error());
}

/// Nothing was changed.
CarriedOut not_begun(std::span<const Plan> plans, Error reason) {
  CarriedOut none;
  none.broken = std::move(reason);
  std::ranges::transform(plans, std::back_inserter(none.servos), as_planned);
  return none;
}

/// Of servos that were saved before others, those that have restarted since. Errors: as
/// Session::run().
Result<void> read_restarted(Session& session, std::list<ChangeJob>& jobs) {
  std::vector<dronecan::Job*> group;
  for (ChangeJob& job : jobs) {
    if (job.has_restarted_since()) {
      job.read_again();
      group.push_back(&job);
    }
  }
  return session.run(group);
}

/// Of jobs that have ended, some before others. Errors: as Session::run().
Result<void> look_back(Session& session, std::list<ChangeJob>& jobs, Patience patience) {
  std::vector<Servo> in_ram, in_rom;
  for (const ChangeJob& job : jobs) {
    if (auto servo = jobs.size() > 1 ? job.in_ram_only() : std::nullopt) {
      in_ram.push_back(std::move(*servo));
    }
    if (auto servo = job.back_before(session.now() - long_ago)) {
      in_rom.push_back(std::move(*servo));
    }
  }
  auto lost = look_last(session, in_ram, patience, LastLook::run);
  if (auto away = lost ? look_last(session, in_rom, patience, LastLook::unit) : lost; away) {
    lost->merge(*away);
  } else {
    lost = std::unexpected(away.error());
  }
  const auto read = lost ? read_restarted(session, jobs) : std::unexpected(lost.error());
  for (ChangeJob& job : jobs) {
    const ChangeResult& result = job.result();
    const auto why = lost ? lost->extract(result.node_id_after.value_or(result.servo.id))
                          : std::map<NodeId, Error>::node_type();
    job.look_back(why ? std::optional(why.mapped()) : std::nullopt);
  }
  return read;
}

CarriedOut change(Session& session, const bla::Profiles& profiles, std::span<const Plan> plans,
                  const Manner& manner) {
  FormerIds table(session, ids_of(plans), manner.allocations, [&](const Error& reason) {
    if (manner.not_kept) { // no reason to leave a servo without its node ID
      [[maybe_unused]] const auto refused = manner.not_kept(reason);
    }
  });
  dronecan::Allocator allocator(session.node(), table);
  if (manner.may_allocate && session.roster().allocators().empty()) {
    session.attach(allocator);
  }
  Discovery recogniser(session, profiles, manner.identification);
  if (std::ranges::any_of(plans, [](const Plan& plan) { return plan.restart.has_value(); })) {
    recogniser.recognise();
  }
  RestartPace pace{.distance = manner.stagger,
                   .next = manner.next_restart != nullptr ? *manner.next_restart : Time{},
                   .stops_at_failure = manner.stops_at_failure,
                   .own = manner.own,
                   .surveyed = manner.surveyed};
  ChangeJob::Options options{.identification = manner.identification,
                             .come_back = manner.come_back.value_or(come_back_time(plans)),
                             .pace = &pace,
                             .while_driven = manner.while_driven,
                             .entered = manner.entered};
  std::list<ChangeJob> jobs;
  std::vector<dronecan::Job*> group;
  for (const Plan& plan : plans) {
    options.start = session.now() + static_cast<Duration::rep>(jobs.size()) * manner.stagger;
    group.push_back(&jobs.emplace_back(session.records(), profiles, plan, options));
  }
  const Ticker ticker(session, 1s, [&, begin = session.now()] {
    if (manner.progress) {
      manner.progress(progress_of(jobs, session.now() - begin));
    }
  });
  auto ran = session.run(group);
  if (const auto looked = look_back(session, jobs, manner.identification.patience); ran) {
    ran = looked;
  }
  session.detach(allocator);
  if (manner.next_restart != nullptr) {
    *manner.next_restart = pace.next;
  }
  CarriedOut carried_out;
  for (const ChangeJob& job : jobs) {
    carried_out.servos.push_back(job.result());
    ChangeResult& last = carried_out.servos.back();
    last.looked_at = session.now();
    const Member member = session.roster().member(last.node_id_after.value_or(last.servo.id));
    last.boots = member.boots;
    last.health = member.health();
    explain_waiting(plans[carried_out.servos.size() - 1], table, last);
  }
  carried_out.broken = ran ? check_sent(session) : std::optional(ran.error());
  return carried_out;
}

} // namespace

std::optional<Error> record(Session& session, std::span<const Plan> plans, const Manner& manner) {
  if (manner.history == nullptr || session.is_replay()) {
    return std::nullopt;
  }
  auto refused = judge(manner.history->keep(plans, session), session, manner); // by the proofs
  return refused ? refused : judge(manner.history->drop_proofs(plans), session, manner);
}

void record_end(Session& session, std::span<const ChangeResult> results, const Manner& manner) {
  if (manner.history == nullptr || session.is_replay()) {
    return;
  }
  const auto concluded = manner.history->conclude(results, session);
  if (!concluded && manner.end_not_recorded) {
    manner.end_not_recorded(concluded.error());
  }
}

CarriedOut carry_out(Session& session, const bla::Profiles& profiles, std::span<const Plan> plans,
                     const Manner& manner) {
  auto refused = record(session, plans, manner);
  auto carried_out =
      refused ? not_begun(plans, std::move(*refused)) : change(session, profiles, plans, manner);
  record_end(session, carried_out.servos, manner);
  return carried_out;
}

} // namespace blactl::fleet
