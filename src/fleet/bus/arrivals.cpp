// Waits until servos are there: identified, operational, and answering at the end.

#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <set>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

/// Between two tries to identify those that are waited for.
constexpr Duration asking_period = std::chrono::seconds(1);

bool is_operational(const Member& member) {
  return member.is_known() && member.status && member.status->mode == dronecan::Mode::operational;
}

/// The reason why a node that was heard is not ready.
Error not_ready(const Member& member, bool is_gone, const std::string& seconds) {
  const std::uint8_t id = member.id.value();
  if (is_gone) {
    return {Code::timeout, say<texts::node_gone>(id), say<texts::no_answer_hint>(), id};
  }
  return member.is_known()
             ? Error{Code::timeout, say<texts::wait_not_operational>(id, seconds),
                     say<texts::opcode_refused_hint>(id), id}
             : Error{Code::timeout, say<texts::node_mute>(id), say<texts::no_answer_hint>(), id};
}

} // namespace

std::vector<const Member*> Discovery::meant(const Targets& targets) const {
  std::vector<const Member*> members;
  for (const auto& [id, member] : session_.roster().members()) {
    if (targets.mean(member, profiles_) && !member.is_foreign() && session_.roster().heard(id) &&
        !session_.roster().has_moved(member)) {
      members.push_back(&member);
    }
  }
  return members;
}

/// One servo, not one of two on its ID, as far as recently heard.
bool Discovery::seems_ready(const Member& member) const {
  return is_operational(member) && !session_.roster().is_doubled(member.id) &&
         session_.now() - member.last_heard < offline_time;
}

/// It was there, and is not heard or does not respond any more.
bool Discovery::is_gone(const Member& member) const {
  return gone_.contains(member.id) || session_.now() - member.last_heard >= offline_time;
}

bool Discovery::is_ready(const Member& member) const {
  return seems_ready(member) && !gone_.contains(member.id);
}

bool Discovery::all_there(const Targets& targets) const {
  const auto members = meant(targets);
  const auto may_be_there = [this](NodeId id) {
    const Member* member = session_.roster().find(id);
    return session_.roster().heard(id) && !member->is_foreign() &&
           !session_.roster().has_moved(*member);
  };
  const Roster& roster = session_.roster();
  const bool is_known = !targets.mean_all() || unidentified(roster).empty();
  const auto is_settled = [&](const Selector& selector) {
    return is_met(roster, selector, profiles_) && may_be_meant(roster, selector, profiles_).empty();
  };
  return !members.empty() && is_known && std::ranges::all_of(targets.ids, may_be_there) &&
         std::ranges::all_of(targets.selectors, is_settled) &&
         std::ranges::all_of(members,
                             [this](const Member* member) { return seems_ready(*member); });
}

/// Those that have not said who they are.
void Discovery::ask_again() {
  if (session_.node().jobs() == 0) {
    for (const NodeId id : unidentified(session_.roster())) {
      identify(id);
    }
  }
}

/// Returns whether they are; false also as soon as one of them is known not to be alone on its ID.
Result<bool> Discovery::wait_until_there(const Targets& targets, Time deadline) {
  // without IDs all present nodes must have had the time to be heard
  const Time heard = session_.now() + (targets.need_search() ? bus_watch_time : Duration::zero());
  for (;;) {
    const Time next = std::min(deadline, session_.now() + asking_period);
    auto there = session_.live_until(next, [&] {
      return session_.now() >= heard && session_.node().jobs() == 0 && all_there(targets);
    });
    if (!there || (!*there && next == deadline)) {
      return there;
    }
    if (!*there) {
      ask_again();
      continue;
    }
    const auto members = meant(targets);
    if (auto looked = look_for_twins(members); !looked) {
      return std::unexpected(looked.error());
    }
    const bool is_shared = std::ranges::any_of(
        members, [this](const Member* member) { return session_.roster().is_doubled(member->id); });
    const bool is_over = session_.now() >= deadline;
    if (is_shared || is_over || (all_there(targets) && gone_.empty())) {
      return !is_shared && all_there(targets) && gone_.empty();
    }
  }
}

Arrivals Discovery::wait_for(const Targets& targets, Duration wait) {
  const Time begin = session_.now();
  attend(Attention::all);
  auto there = wait_until_there(targets, begin + wait);
  attend(Attention::none);
  if (there && !*there) { // pending requests are not waited for beyond their timeout
    if (auto ran = session_.run(); !ran) {
      there = std::unexpected(ran.error());
    }
  }
  Arrivals arrivals{.servos = those_there(targets), .errors = {}, .broken = {}};
  if (!there) {
    arrivals.broken = there.error();
    arrivals.errors = not_there_yet(targets, there.error().code);
  } else if (!*there) {
    arrivals.errors = missing(targets, wait);
  }
  if (auto ambiguous = targets.ambiguity(session_.roster(), profiles_); ambiguous && there) {
    arrivals.broken = std::move(*ambiguous);
  }
  return arrivals;
}

std::vector<Arrival> Discovery::those_there(const Targets& targets) const {
  std::vector<Arrival> servos;
  for (const Member* member : meant(targets)) {
    // facts about one of two units on an ID may be the other's
    const bool is_one = !session_.roster().is_doubled(member->id);
    servos.push_back({is_one ? member->servo() : Servo{.id = member->id}, is_ready(*member)});
  }
  return servos;
}

/// The errors for those that were waited for when the session ended for this reason.
std::vector<Error> Discovery::not_there_yet(const Targets& targets, Code reason) const {
  std::set<NodeId> awaited(targets.ids.begin(), targets.ids.end());
  for (const Member* member : meant(targets)) {
    is_ready(*member) ? awaited.erase(member->id) : awaited.insert(member->id).second;
  }
  std::vector<Error> errors;
  errors.reserve(awaited.size());
  for (const NodeId id : awaited) {
    errors.push_back({reason, say<texts::not_there_yet>(id.value()), {}, id.value()});
  }
  return errors;
}

std::vector<Error> Discovery::missing(const Targets& targets, Duration wait) const {
  const auto seconds = fmt::format("{}", std::chrono::duration<double>(wait).count());
  const auto members = meant(targets);
  std::vector<Error> errors;
  for (const Member* member : members) {
    if (!is_ready(*member)) {
      errors.push_back(session_.roster().is_doubled(member->id)
                           ? doubled(session_.roster(), member->id)
                           : not_ready(*member, is_gone(*member), seconds));
    }
  }
  if (targets.mean_all()) {
    for (const NodeId id : unidentified(session_.roster())) {
      errors.push_back(not_ready(session_.roster().member(id), false, seconds));
    }
  }
  for (const NodeId id : targets.ids) {
    const Member* member = session_.roster().find(id);
    if (!session_.roster().heard(id) || session_.roster().has_moved(*member)) {
      errors.push_back({Code::not_found, say<texts::wait_not_heard>(id.value(), seconds),
                        not_found_hint(session_.roster()), id.value()});
    } else if (member->is_foreign()) {
      errors.push_back(not_a_servo(id, member->info->name));
    }
  }
  std::ranges::copy_if(unmet(targets), std::back_inserter(errors), [&](const Error& one) {
    return one.code != Code::duplicate_node_id || // of a servo that is there: told already
           std::ranges::find(members, one.node_id, [](const Member* member) {
             return std::optional(member->id.value());
           }) == members.end();
  });
  if (members.empty() && errors.empty()) {
    errors.push_back(unless_shared(session_.roster(), no_servo(session_.roster())));
  }
  return errors;
}

} // namespace blactl::fleet
