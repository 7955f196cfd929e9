#include "blactl/fleet/bus/discovery.hpp"

#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <list>
#include <set>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

/// The number of concurrent probes and their timeout: all 125 fit into the listening time.
constexpr int probes_at_a_time = 8;
constexpr Duration probe_timeout = std::chrono::milliseconds(60);

/// Before this time nothing of ours is sent that nobody would acknowledge on an empty bus.
constexpr Duration empty_bus_time = std::chrono::milliseconds(900);

} // namespace

Discovery::Discovery(Session& session, const bla::Profiles& profiles,
                     Identification::Options options)
    : session_(session), profiles_(profiles), options_(options) {}

Discovery::~Discovery() {
  attend(Attention::none);
  for (const auto& job : identifications_) {
    session_.cancel(*job);
  }
  for (const auto& job : jobs_) {
    session_.cancel(*job);
  }
}

void Discovery::attend(Attention attention) {
  const Attention before = std::exchange(attention_, attention);
  if (before == Attention::none && attention != Attention::none) {
    session_.records().add(*this);
  } else if (before != Attention::none && attention == Attention::none) {
    session_.records().remove(*this);
  }
  if (attention == Attention::all) {
    for (const auto& [id, member] : session_.roster().members()) {
      if (session_.roster().heard(id) && !member.is_known()) { // before this search began
        identify(id);
      }
    }
  }
}

void Discovery::recognise() {
  attend(Attention::unit);
}

void Discovery::on_new_unit(const Member& member) {
  if (attention_ == Attention::all) {
    if (!is_ending_ || asked_late_.insert(member.id).second) {
      identify(member.id);
    }
  } else {
    start(std::make_unique<UnitJob>(session_.records(), member.id, options_.patience));
  }
}

void Discovery::identify(NodeId id) {
  identifications_.push_back(
      std::make_unique<IdentifyJob>(session_.records(), id, profiles_, options_));
  session_.start(*identifications_.back());
}

void Discovery::start(std::unique_ptr<dronecan::Job> job) {
  jobs_.push_back(std::move(job));
  session_.start(*jobs_.back());
}

std::vector<std::optional<Error>> Discovery::identifications() const {
  std::vector<std::optional<Error>> ends;
  ends.reserve(identifications_.size());
  for (const auto& job : identifications_) {
    ends.push_back(job->identification().error());
  }
  return ends;
}

/// "All" includes a servo that restarted since it was identified, and one that shares its ID:
/// reading them gives their state, or an error instead of silence.
bool Discovery::is_one_of_all(const Targets& targets, const Member& member) const {
  const bool shares = session_.roster().is_doubled(member.id) && member.sends_actuator_status();
  return targets.mean_all() && ((member.identified && member.is_servo) || shares);
}

/// A unit that restarted since it was identified is the same unit; its servo ID may be another.
bool Discovery::was_meant(const Targets& targets, const Member& member) const {
  return member.identified && !session_.roster().has_moved(member) &&
         std::ranges::any_of(targets.selectors, [&](const Selector& selector) {
           return selector.key != Selector::Key::servo_id &&
                  selector.matches(member.servo(), profiles_);
         });
}

/// Nothing needs to be known of a node that was only looked at because it is in a recording.
bool Discovery::is_bystander(const Error& error) const {
  return error.code == Code::not_recorded && error.node_id &&
         !session_.roster().member(NodeId(*error.node_id)).sends_actuator_status();
}

std::vector<Error> Discovery::unmet(const Targets& targets) const {
  return fleet::unmet(session_.roster(), targets.selectors, profiles_, session_.is_replay());
}

std::vector<Error> Discovery::absent(const Targets& targets) const {
  std::vector<Error> errors = unmet(targets);
  for (const NodeId id : targets.ids) {
    if (!session_.roster().heard(id)) {
      errors.push_back(session_.is_replay() ? unrecorded(id) : silent(session_.roster(), id));
    }
  }
  return errors;
}

/// A bus without servos, and one that has just been switched on, are told apart by time alone.
Result<void> Discovery::hear_servos(const Targets& targets, Duration listen) {
  const Time begin = session_.now();
  auto lived = session_.live_until(begin + listen);
  const bool is_empty = targets.ids.empty() && !session_.is_replay() &&
                        std::ranges::none_of(session_.roster().members(), [](const auto& entry) {
                          return entry.second.sends_actuator_status();
                        });
  return lived && is_empty ? session_.live_until(begin + std::max(listen, empty_bus_time)) : lived;
}

/// Those heard so far, and those heard while these are asked.
Result<void> Discovery::identify_servos() {
  std::set<NodeId> asked;
  for (std::size_t before = 0;; before = asked.size()) {
    for (const auto& [id, member] : session_.roster().members()) {
      // a recording may be too short for an actuator.Status, and no requests are possible
      if ((member.sends_actuator_status() || session_.is_replay()) && asked.insert(id).second) {
        identify(id);
      }
    }
    if (asked.size() == before) {
      return {};
    }
    if (auto ran = session_.run(); !ran) {
      return ran;
    }
  }
}

/// A servo may be exchanged for another one while it is identified, or before it is read. One that
/// was chosen by its servo ID is known by its unique ID: the command itself may change the former.
void Discovery::choose(const Targets& targets, std::set<NodeId> chosen) {
  std::set<dronecan::UniqueId> units;
  for (const NodeId id : targets.ids) {
    chosen.erase(id);
  }
  for (const NodeId id : chosen) {
    if (const auto unit = session_.roster().member(id).unique_id()) {
      units.insert(*unit);
    }
  }
  if (targets.selectors.empty()) {
    return;
  }
  session_.records().choose(std::move(chosen),
                            [selectors = targets.selectors, units = std::move(units),
                             &profiles = profiles_](const Servo& servo) {
                              return std::ranges::any_of(selectors, [&](const Selector& selector) {
                                return selector.key == Selector::Key::servo_id
                                           ? !servo.unique_id || units.contains(*servo.unique_id)
                                           : selector.matches(servo, profiles);
                              });
                            });
}

Result<Selection> Discovery::select(const Targets& targets, Duration listen) {
  Selection selection;
  if (targets.need_search()) {
    if (auto lived = hear_servos(targets, listen); !lived) {
      return std::unexpected(lived.error());
    }
    if (auto identified = identify_servos(); !identified) {
      return std::unexpected(identified.error());
    }
    for (auto& error : identifications()) {
      // with a selector it may be another's, and who is chosen is told of when it is read
      if (error && targets.selectors.empty() && !is_bystander(*error) &&
          error->code != Code::duplicate_node_id) {
        selection.errors.push_back(std::move(*error));
      }
    }
  }
  if (auto ambiguous = targets.ambiguity(session_.roster(), profiles_)) {
    return std::unexpected(std::move(*ambiguous));
  }
  std::set<NodeId> chosen;
  for (const NodeId id : targets.ids) {
    if (session_.roster().member(id).id_is_known) {
      chosen.insert(id);
    } else { // not a real ID: a placeholder for a servo whose ID is unknown
      selection.errors.push_back(unrecorded(id));
    }
  }
  for (const auto& [id, member] : session_.roster().members()) {
    if (member.is_known() && !member.is_servo && member.sends_actuator_status()) {
      selection.notes.push_back(
          say<texts::foreign_actuator>(id.value(), printable(member.servo().name)));
    }
  }
  for (const auto& [id, member] : session_.roster().members()) {
    if (targets.mean(member, profiles_) || is_one_of_all(targets, member) ||
        was_meant(targets, member)) {
      chosen.insert(id);
    }
  }
  std::ranges::copy_if(unmet(targets), std::back_inserter(selection.errors), [&](const Error& one) {
    return !one.node_id || !chosen.contains(NodeId(*one.node_id)); // it is read, or its error told
  });
  selection.ids.assign(chosen.begin(), chosen.end());
  choose(targets, std::move(chosen));
  if (selection.ids.empty() && selection.errors.empty()) {
    selection.errors.push_back(unless_shared(session_.roster(), no_servo(session_.roster())));
  }
  return selection;
}

Result<Selection> Discovery::select_for_writing(const Targets& targets) {
  auto selection = select(targets, targets.given ? servo_search_time : bus_watch_time);
  if (!selection || !selection->errors.empty() || targets.given || selection->ids.size() <= 1) {
    return selection;
  }
  std::string ids;
  for (const NodeId id : selection->ids) {
    ids += (ids.empty() ? "" : ", ") + std::to_string(id.value());
  }
  return fail(Code::usage, say<texts::several_servos>(ids),
              say<texts::several_servos_hint>(selection->ids.front().value()));
}

Result<void> Discovery::find_all(Duration listen) {
  options_.static_node_id = true;
  if (session_.may_ask()) {
    attend(Attention::all);
    for (int i = 0; i < probes_at_a_time; ++i) {
      start(std::make_unique<ProbeJob>(session_.roster(), cursor_, probe_timeout));
    }
  }
  if (auto lived = session_.live_until(session_.now() + listen); !lived) {
    return lived;
  }
  is_ending_ = true;
  auto ran = end_search();
  is_ending_ = false;
  asked_late_.clear();
  return ran;
}

/// Until nobody has come while the last ones were asked: each new node ID once.
Result<void> Discovery::end_search() {
  auto ran = session_.run();
  for (std::set<NodeId> asked; ran;) {
    std::vector<const Member*> servos;
    for (const auto& [id, member] : session_.roster().members()) {
      if (member.is_known() && member.is_servo && asked.insert(id).second) {
        servos.push_back(&member);
      }
    }
    if (servos.empty()) {
      break;
    }
    ran = look_for_twins(servos);
    if (ran) {
      ran = session_.run();
    }
  }
  return ran;
}

Result<void> Discovery::look_for_twins(const std::vector<const Member*>& members) {
  if (session_.is_replay()) { // it would only repeat itself
    return {};
  }
  std::list<DoubleCheckJob> checks;
  std::vector<dronecan::Job*> group;
  group.reserve(members.size());
  for (const Member* member : members) {
    group.push_back(&checks.emplace_back(session_.records(), member->servo(), options_.patience));
  }
  if (auto ran = session_.run(group); !ran || members.empty()) {
    return ran;
  }
  for (const DoubleCheckJob& check : checks) {
    check.is_answered() ? gone_.erase(check.id()) : gone_.insert(check.id()).second;
  }
  return session_.live_until(session_.now() + RunProof::twin_time);
}

Result<void> hear_bus(Session& session) {
  if (auto lived = session.live_until(session.opened() + bus_watch_time); !lived) {
    return lived;
  }
  if (session.lost_frames() > 0) {
    return fail(Code::state, say<texts::lost_while_listening>(), say<texts::run_again_hint>());
  }
  return {};
}

} // namespace blactl::fleet
