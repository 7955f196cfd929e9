#include "blactl/fleet/bus/identification.hpp"

#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include <chrono>
#include <utility>

namespace blactl::fleet {

using dronecan::GetNodeInfo;
using dronecan::GetSet;
using dronecan::Outcome;
using dronecan::Step;

namespace {

/// A servo that restarts again and again does not grow older; its reading shows that.
constexpr int most_pauses = 4;

/// On a bus with so many silences nothing else is to be had.
constexpr int most_silences = 4;

/// Whether it is a response with the value of a register, even if out of its range.
bool is_number(const Outcome& outcome) {
  const auto response =
      outcome.answered() ? GetSet::Response::decode(outcome.payload) : std::nullopt;
  return response && std::holds_alternative<std::int64_t>(response->value);
}

} // namespace

Identification::Identification(Roster& roster, dronecan::NodeId id, const bla::Profiles& profiles,
                               Options options)
    : roster_(roster), profiles_(profiles), options_(options), servo_{.id = id} {}

bla::Address Identification::address_of(At at) {
  switch (at) {
  case At::model_number: return bla::address::model_number;
  case At::serial_number: return bla::address::serial_number;
  case At::firmware_version: return bla::address::firmware_version;
  case At::hardware_version: return bla::address::hardware_version;
  case At::servo_id: return bla::address::servo_id;
  default: return bla::address::static_node_id;
  }
}

std::optional<std::int64_t>& Identification::slot(At at) {
  switch (at) {
  case At::model_number: return readings_.model_number;
  case At::serial_number: return readings_.serial_number;
  case At::firmware_version: return readings_.firmware_version;
  case At::hardware_version: return readings_.hardware_version;
  case At::servo_id: return servo_.servo_id;
  default: return servo_.static_node_id;
  }
}

Step Identification::question(At at) {
  at_ = at;
  if (at == At::node_info) {
    return ask(servo_.id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), options_.patience);
  }
  return read_register(servo_.id, address_of(at), options_.patience);
}

Step Identification::begin(Time now) {
  const Member* member = roster_.find(servo_.id);
  if (member == nullptr || !member->is_known()) {
    servo_.since = now;
    return question(At::node_info);
  }
  if (options_.settled && member->is_young) {
    return grow(member->info_start);
  }
  servo_ = member->servo();
  done_ = true;
  return std::nullopt;
}

/// `started`: at the latest.
Step Identification::grow(Time started) {
  at_ = At::young;
  ++pauses_;
  return dronecan::Pause{.until = started + std::chrono::seconds(1)};
}

Step Identification::next(const Outcome& outcome) {
  switch (at_) {
  case At::begin: return begin(outcome.at);
  case At::young:
    if (outcome.kind != Outcome::Kind::cancelled) {
      return question(At::node_info);
    }
    [[fallthrough]];
  case At::node_info: take_node_info(outcome); break;
  default: take_register(outcome); break;
  }
  if (error_) {
    return std::nullopt;
  }
  if (at_ == At::node_info && options_.settled && servo_.is_young && pauses_ < most_pauses) {
    return grow(outcome.at);
  }
  const bool is_decided = at_ == At::serial_number || (at_ == At::model_number && !model_silent_);
  const bool foreign = is_decided && !servo_.is_servo && !recording_lacks_model_;
  const auto following = static_cast<At>(std::to_underlying(at_) + 1);
  const bool last =
      following == At::end || (following == At::static_node_id && !options_.static_node_id);
  return foreign || last ? conclude() : question(following);
}

void Identification::take_node_info(const Outcome& outcome) {
  auto response =
      outcome.answered() ? GetNodeInfo::Response::decode(outcome.payload) : std::nullopt;
  if (!response && outcome.kind != Outcome::Kind::not_recorded) {
    error_ = no_answer(outcome, servo_.id, "GetNodeInfo");
    if (error_->code == Code::timeout) {
      error_ = silent(roster_, servo_.id);
    }
    return;
  }
  info_ = std::move(response);
  if (info_) {
    roster_.learn(servo_.id, *info_, outcome.at);
    servo_.unique_id = info_->unique_id;
    servo_.name = info_->name;
    servo_.since = outcome.asked; // it may have started after an earlier request that got lost
    servo_.is_young = info_->status.uptime_s == 0;
  }
  servo_.boot = roster_.member(servo_.id).boots;
}

bool Identification::sends_actuator_status() const {
  return roster_.member(servo_.id).sends_actuator_status();
}

/// Two units on an ID disturb each other's responses, which must not make a foreign node of them.
/// The node name of BLA servos is not in the specification. unproven: it contains the maker or the
/// series. Another run of this program does not answer GetSet.
bool Identification::may_be_servo() const {
  const auto has = [this](std::string_view part) {
    return servo_.name.find(part) != std::string::npos;
  };
  const bool has_name = servo_.name != own_name && (has("futaba") || has("bla") || has("BLA"));
  return has_name || roster_.is_doubled(servo_.id);
}

/// A servo that responds, but not with its model.
Error Identification::silence_of_model() const {
  return no_answer({Outcome::Kind::timed_out, {}, {}}, servo_.id,
                   bla::address::model_number.name());
}

void Identification::take_register(const Outcome& outcome) {
  const auto* parameter = profiles_.find(address_of(at_));
  const bla::Width width = parameter != nullptr ? parameter->width : bla::Width{.bits = 64};
  const auto value = register_value(outcome, servo_.id, address_of(at_), width);
  const bool first = at_ == At::model_number;
  const bool silent = !value && value.error().code == Code::timeout;
  // A node without parameters (a GPS, a battery) responds to GetNodeInfo only. For an actuator,
  // which may be of another make, only the second silent register proves it.
  const bool foreign = silent && (first || model_silent_);
  const bool may_have_started = foreign && first && !sends_actuator_status();
  if ((model_silent_ && value) || ((model_silent_ || may_have_started) && may_be_servo())) {
    error_ = silence_of_model();
    return;
  }
  model_silent_ = foreign && first && sends_actuator_status();
  const bool not_recorded = outcome.kind == Outcome::Kind::not_recorded;
  if (!value && value.error().code != Code::refused && !foreign && !not_recorded) {
    error_ = value.error();
    return;
  }
  recording_lacks_model_ = recording_lacks_model_ || (first && not_recorded);
  servo_.is_servo = servo_.is_servo || is_number(outcome);
  slot(at_) = value ? std::optional(*value) : std::nullopt;
}

/// Whether a recording leaves open if a node is a servo.
std::optional<Error> Identification::undecided() const {
  const bool foreign = info_ && !sends_actuator_status();
  if (!recording_lacks_model_ || servo_.is_servo || foreign) {
    return std::nullopt;
  }
  return roster_.heard(servo_.id) ? identity_unrecorded(servo_.id) : unrecorded(servo_.id);
}

/// An actuator is heard ten times a second: in a silence its place may have become another's, and
/// what it told before and after would be of two.
bool Identification::may_be_of_two() const {
  return info_ && sends_actuator_status() && roster_.member(servo_.id).back_at > servo_.since;
}

Step Identification::conclude() {
  if (may_be_of_two() && silences_++ < most_silences) {
    readings_ = {};
    servo_.is_servo = model_silent_ = false;
    return question(At::node_info);
  }
  error_ = undecided();
  if (error_) {
    return std::nullopt;
  }
  if (servo_.is_servo) {
    servo_.identity = bla::Identity(profiles_, readings_);
    if (options_.assumed != nullptr) {
      if (auto agreed = servo_.identity.assume(*options_.assumed); !agreed) {
        error_ = agreed.error();
        error_->node_id = servo_.id.value();
        error_->message = say<texts::about_node>(servo_.id.value(), error_->message);
        return std::nullopt;
      }
    }
  }
  roster_.learn(servo_, info_); // of the boot of the response: it may have restarted since
  done_ = true;
  return std::nullopt;
}

dronecan::Step ProbeJob::next(const Outcome& outcome) {
  if (outcome.kind == Outcome::Kind::cancelled) {
    return std::nullopt;
  }
  while (cursor_ < last) {
    const dronecan::NodeId id(++cursor_);
    if (!roster_.heard(id) && id != roster_.local()) {
      return ask(id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), {timeout_, 0});
    }
  }
  return std::nullopt;
}

dronecan::Step UnitJob::next(const Outcome& outcome) {
  if (outcome.kind == Outcome::Kind::start) {
    return ask(id_, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), patience_);
  }
  const auto info =
      outcome.answered() ? GetNodeInfo::Response::decode(outcome.payload) : std::nullopt;
  if (info) {
    roster_.learn(id_, *info, outcome.at);
  }
  return std::nullopt;
}

dronecan::Step DoubleCheckJob::next(const Outcome& outcome) {
  if (outcome.kind == Outcome::Kind::start) {
    return ask(servo_.id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), patience_);
  }
  const auto info =
      outcome.answered() ? GetNodeInfo::Response::decode(outcome.payload) : std::nullopt;
  is_answered_ = info.has_value();
  const bool has_restarted = roster_.member(servo_.id).boots != servo_.boot;
  if (info && servo_.unique_id && info->unique_id != *servo_.unique_id && !has_restarted) {
    roster_.mark_doubled(servo_.id, *servo_.unique_id, info->unique_id);
  }
  return std::nullopt;
}

} // namespace blactl::fleet
