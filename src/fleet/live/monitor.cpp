#include "blactl/fleet/live/monitor.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>

namespace blactl::fleet {

using bla::Address;
using dronecan::ActuatorStatus;
using dronecan::GetNodeInfo;
using dronecan::GetSet;
using dronecan::Kind;
using dronecan::NodeId;
using dronecan::Transfer;

namespace {

constexpr std::array places{bla::address::current_angle,   bla::address::current_speed,
                            bla::address::current_torque,  bla::address::current_temperature,
                            bla::address::current_voltage, bla::address::fault_summary};
static_assert(places.size() == live_fields);

struct Limits {
  Address low, high;
};

/// In the order of LiveField; faults have no limits.
constexpr std::array limits{
    Limits{bla::address::angle_limit_ccw, bla::address::angle_limit_cw},
    Limits{bla::address::speed_limit_ccw, bla::address::speed_limit_cw},
    Limits{bla::address::torque_limit_ccw, bla::address::torque_limit_cw},
    Limits{bla::address::temperature_limit_low, bla::address::temperature_limit_high},
    Limits{bla::address::voltage_limit_low, bla::address::voltage_limit_high}};

/// Fields that change as fast as a shaft turns.
constexpr bool is_fast(LiveField field) {
  return field == LiveField::angle || field == LiveField::speed || field == LiveField::torque;
}

/// The duration of a register's request and response on a bus of 1 Mbit/s.
constexpr Duration read_time = std::chrono::microseconds(533);

template <class Told> bla::Values values_of(const Told& told) {
  bla::Values values;
  for (const auto& [address, value] : told) {
    values[address] = value.raw;
  }
  return values;
}

/// After this time without an actuator.Status the angle is read.
constexpr Duration status_silence = std::chrono::seconds(1);

/// The range in which actuator.Status resolves tenths of a degree: it is a float16 (errata C11).
constexpr std::int64_t most_exact_tenths = 2000;

/// Beyond that range, an angle read this recently is better than one from actuator.Status.
constexpr Duration exact_for = std::chrono::seconds(2);

} // namespace

Address address_of(LiveField field) {
  return places[static_cast<std::size_t>(field)];
}

Monitor::Monitor(Session& session, const bla::Profiles& profiles, Targets targets, Options options)
    : session_(session), profiles_(profiles), targets_(std::move(targets)),
      options_(std::move(options)),
      due_(session.is_replay() ? Time::min() : session.now() + options_.period) {
  for (const LiveField field : options_.fields) {
    if (field != LiveField::angle) {
      (is_fast(field) ? plan_.often : plan_.seldom).push_back(address_of(field));
    }
  }
  session_.records().accept_exchanges();
  session_.attach(*this);
  for (const NodeId id : targets_.ids) {
    attend(id);
  }
}

Monitor::~Monitor() {
  session_.detach(*this);
  for (auto& [id, node] : nodes_) {
    if (node.poll) {
      session_.cancel(*node.poll);
    }
  }
}

/// A missed moment is skipped: samples do not come in bursts.
void Monitor::advance(Time now) {
  if (now < due_) {
    return;
  }
  const bool is_first = due_ == Time::min(); // start of a recording: nothing was heard before
  const bool is_late = is_first || now >= due_ + options_.period;
  due_ = (is_late ? now : due_) + options_.period;
  if (!is_first) {
    session_.records().forget_doubled(now - doubt_time);
  }
  plan_rounds();
  if (!is_first && options_.sample) {
    options_.sample(now);
  }
}

void Monitor::receive(const Transfer& transfer) {
  if (session_.is_replay()) {
    advance(transfer.at);
  }
  const auto& header = transfer.header;
  if (!header.source.is_unicast() || header.source == session_.node().id()) {
    return;
  }
  const Member* member = session_.roster().find(header.source);
  if (member == nullptr) {
    return;
  }
  Watched& node = nodes_[header.source];
  meet(node, *member);
  if (std::exchange(node.boot, member->boots) != member->boots) {
    node.values.clear(); // of the previous run, or of another unit
    node.unique_id.reset();
    node.name.clear();
    node.status_at.reset();
    node.turns.forget();
  }
  if (header.kind == Kind::message && header.data_type_id == ActuatorStatus::type.id) {
    take_angle(node, transfer);
  } else if (header.kind == Kind::response && header.data_type_id == GetSet::type.id) {
    take_register(node, transfer);
  } else if (header.kind == Kind::response && header.data_type_id == GetNodeInfo::type.id) {
    if (auto info = GetNodeInfo::Response::decode(transfer.payload)) {
      node.unique_id = info->unique_id;
      node.name = std::move(info->name);
    }
  }
  attend(header.source);
  for (const Selector& selector : targets_.selectors) {
    if (selector.matches(servo(*member, node), profiles_)) {
      met_.insert(selector.text);
    }
  }
}

/// Counts the restarts of the unit that answers now.
void Monitor::meet(Watched& node, const Member& member) {
  if (!member.info || member.info_at == node.unit_at) {
    return;
  }
  const bool is_other = node.unit && member.info->unique_id != *node.unit;
  node.first_boot = is_other ? member.boots : node.first_boot;
  node.unit = member.info->unique_id;
  node.unit_at = member.info_at;
}

/// Degrees are the field times 100 (errata C10).
void Monitor::take_angle(Watched& node, const Transfer& transfer) {
  const auto status = ActuatorStatus::decode(transfer.payload);
  if (!status || !std::isfinite(status->position)) {
    return;
  }
  node.status_at = transfer.at;
  const auto tenths = static_cast<std::int64_t>(std::lround(status->position * 1000));
  node.is_far = std::abs(tenths) > most_exact_tenths;
  const auto known = node.values.find(bla::address::current_angle);
  const bool is_better_known =
      node.is_far && known != node.values.end() && transfer.at - known->second.at < exact_for;
  if (!is_better_known) {
    tell_angle(node, tenths, transfer.at);
  }
}

void Monitor::tell_angle(Watched& node, std::int64_t decideg, Time at) {
  node.values[bla::address::current_angle] = {decideg, at};
  node.turns.take(decideg, at);
}

/// Responses to any node's request are used.
void Monitor::take_register(Watched& node, const Transfer& transfer) {
  const auto response = GetSet::Response::decode(transfer.payload);
  const auto address = response ? bla::find_address(response->name) : std::nullopt;
  const bla::Parameter* parameter = address ? profiles_.find(*address) : nullptr;
  const auto* raw = parameter != nullptr ? std::get_if<std::int64_t>(&response->value) : nullptr;
  if (raw == nullptr) {
    return;
  }
  if (parameter->width.holds(*raw)) {
    const std::int64_t value = parameter->width.narrow(*raw);
    if (*address == bla::address::current_angle) {
      tell_angle(node, value, transfer.at);
    } else {
      node.values[*address] = {value, transfer.at};
    }
  }
  if (*address == bla::address::fault_summary) {
    forget_past_faults(node);
  }
}

/// A register without a bit in 0x18 is not read any more: its earlier faults are over.
void Monitor::forget_past_faults(Watched& node) {
  const bla::Values values = values_of(node.values);
  for (const Address reg : bla::fault_registers) {
    if (!bla::is_summed_up(values, reg)) {
      node.values.erase(reg);
    }
  }
}

/// By the servo's responses to us or to others: on a recording nothing is requested.
bool Monitor::is_meant(const Member& member, const Watched& node) const {
  const bool is_servo = member.sends_actuator_status() || member.is_servo;
  if (targets_.mean_all()) {
    return is_servo;
  }
  const auto matches = [known = servo(member, node), this](const Selector& selector) {
    return selector.matches(known, profiles_);
  };
  return std::ranges::count(targets_.ids, member.id) > 0 ||
         std::ranges::any_of(targets_.selectors, matches);
}

/// A servo is asked as soon as it is heard: its responses show whether a selector matches.
void Monitor::attend(NodeId id) {
  const Member* member = session_.roster().find(id);
  const bool is_named = std::ranges::count(targets_.ids, id) > 0;
  const bool may_be_meant = is_named || (member != nullptr && targets_.need_search() &&
                                         (member->sends_actuator_status() || member->is_servo));
  if (!may_be_meant || !asks()) {
    return;
  }
  Watched& node = nodes_[id];
  if (node.poll) {
    return;
  }
  node.poll = std::make_unique<PollJob>(session_.records(), id, profiles_, options_.identification,
                                        plan_, [this, id, &node] { return further(id, node); });
  plan_rounds();
  session_.start(*node.poll);
}

/// All rounds together take no more than their share of the bus.
void Monitor::plan_rounds() {
  std::int64_t reads = 0;
  for (const auto& [id, node] : nodes_) {
    if (node.poll && node.poll->polls()) {
      const bool reads_seldom = !plan_.seldom.empty() || limits_of_ == id;
      reads += static_cast<std::int64_t>(plan_.often.size()) + (reads_seldom ? 1 : 0) +
               (needs_angle(node) ? 1 : 0);
    }
  }
  plan_.round = std::max<Duration>(options_.period, reads * read_time * 100 / share_percent);
}

bool Monitor::asks() const {
  return !session_.is_replay() && session_.may_ask();
}

/// Whether it does not send its angle, or not exactly.
bool Monitor::needs_angle(const Watched& node) const {
  const bool is_silent = !node.status_at || session_.now() - *node.status_at > status_silence;
  return (is_silent || node.is_far) && std::ranges::count(options_.fields, LiveField::angle) > 0;
}

std::optional<PollPlan> Monitor::further(NodeId id, const Watched& node) const {
  if (!is_meant(session_.roster().member(id), node)) {
    return std::nullopt;
  }
  PollPlan more;
  if (needs_angle(node)) {
    more.often.push_back(bla::address::current_angle);
  }
  const bla::Values values = values_of(node.values);
  if (std::ranges::count(plan_.seldom, bla::address::fault_summary) > 0) {
    for (const Address reg : bla::fault_registers) {
      if (bla::is_summed_up(values, reg)) {
        more.seldom.push_back(reg);
      }
    }
  }
  if (limits_of_ == id) {
    for (const Limits& each : limits) {
      more.seldom.insert(more.seldom.end(), {each.low, each.high});
    }
  }
  return more;
}

/// From its responses to us, else to others. Where nobody asks after a silence, who it is stays
/// open.
Servo Monitor::servo(const Member& member, const Watched& node) const {
  if (!asks() && member.may_be_another()) {
    return {.id = member.id, .is_servo = member.sends_actuator_status() || member.is_servo};
  }
  if (member.is_known()) {
    return member.servo();
  }
  const auto overheard = [&node](Address address) -> std::optional<std::int64_t> {
    const auto it = node.values.find(address);
    return it != node.values.end() ? std::optional(it->second.raw) : std::nullopt;
  };
  Servo servo{.id = member.id, .unique_id = node.unique_id, .name = node.name};
  servo.identity =
      bla::Identity(profiles_, {.model_number = overheard(bla::address::model_number),
                                .serial_number = overheard(bla::address::serial_number),
                                .firmware_version = overheard(bla::address::firmware_version),
                                .hardware_version = overheard(bla::address::hardware_version)});
  servo.servo_id = overheard(bla::address::servo_id);
  servo.static_node_id = overheard(bla::address::static_node_id);
  servo.is_servo = member.sends_actuator_status() || servo.identity.readings().model_number;
  return servo;
}

LiveServo Monitor::live(const Member& member, const Watched& node, Time now) const {
  const bool is_doubled = session_.roster().is_doubled(member.id);
  const bool is_in_doubt = asks() && member.may_be_another();
  const auto status = is_in_doubt ? std::nullopt : member.status_as_of(now);
  LiveServo out{.servo = is_doubled ? Servo{.id = member.id} : servo(member, node),
                .status = status,
                .first_heard = member.first_heard,
                .last_heard = member.last_heard,
                .restarts = member.boots - node.first_boot,
                .is_gone = now - member.last_heard >= offline_time,
                .is_doubled = is_doubled,
                .is_stale = is_doubled || is_in_doubt};
  for (const auto& [id, other] : session_.roster().members()) {
    // in this order: whether it has moved is checked against all others
    if (id != member.id && other.unique_id() && other.unique_id() == out.servo.unique_id &&
        session_.roster().has_moved(other)) {
      out.former_id = id;
    }
  }
  for (std::size_t field = 0; field < live_fields; ++field) {
    const bla::Parameter* parameter = out.servo.identity.parameter(places[field]);
    out.parameters[field] = parameter != nullptr ? parameter : profiles_.find(places[field]);
  }
  if (out.is_stale) {
    return out;
  }
  const bla::Values values = values_of(node.values);
  out.faults = bla::faults(values, profiles_);
  for (std::size_t field = 0; field < live_fields; ++field) {
    const auto it = node.values.find(places[field]);
    if (it != node.values.end()) {
      out.values[field] = it->second;
    }
  }
  for (std::size_t field = 0; field < limits.size(); ++field) {
    out.limits[field] = {bla::find(values, limits[field].low),
                         bla::find(values, limits[field].high)};
  }
  out.is_stale = (member.status && !status) || is_stale(out, now);
  out.has_turned = options_.watches_turns && node.turns.has_turned(now);
  return out;
}

/// Two of its turns have passed without a response.
bool Monitor::is_stale(const LiveServo& servo, Time now) const {
  const auto turns = static_cast<std::int64_t>(std::max<std::size_t>(plan_.seldom.size(), 1));
  return std::ranges::any_of(options_.fields, [&](LiveField field) {
    const auto& value = servo.value(field);
    const Duration turn = field == LiveField::angle ? Duration{}
                          : is_fast(field)          ? plan_.round
                                                    : plan_.round * turns;
    return value && now - value->at > status_silence + 2 * turn;
  });
}

} // namespace blactl::fleet
