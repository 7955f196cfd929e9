#include "blactl/fleet/identification.hpp"

#include "blactl/fleet/texts.hpp"

#include <utility>

namespace blactl::fleet {

using dronecan::GetNodeInfo;
using dronecan::Outcome;
using dronecan::Request;

Identification::Identification(Roster& roster, Member& member, const bla::Profiles& profiles,
                               Options options)
    : roster_(roster), member_(member), profiles_(profiles), options_(options) {}

bla::Address Identification::address_of(Step step) {
  switch (step) {
  case Step::model_number: return bla::address::model_number;
  case Step::serial_number: return bla::address::serial_number;
  case Step::firmware_version: return bla::address::firmware_version;
  case Step::hardware_version: return bla::address::hardware_version;
  case Step::servo_id: return bla::address::servo_id;
  default: return bla::address::static_node_id;
  }
}

std::optional<std::int64_t>& Identification::slot(Step step) {
  switch (step) {
  case Step::model_number: return readings_.model_number;
  case Step::serial_number: return readings_.serial_number;
  case Step::firmware_version: return readings_.firmware_version;
  case Step::hardware_version: return readings_.hardware_version;
  case Step::servo_id: return member_.servo_id;
  default: return member_.static_node_id;
  }
}

std::optional<Request> Identification::question(Step step) {
  step_ = step;
  if (step == Step::node_info) {
    return ask(member_.id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), options_.patience);
  }
  return read_register(member_.id, address_of(step), options_.patience);
}

std::optional<Request> Identification::next(const Outcome& outcome) {
  if (step_ == Step::begin) {
    if (member_.is_known()) {
      done_ = true;
      return std::nullopt;
    }
    return question(Step::node_info);
  }
  if (step_ == Step::node_info) {
    take_node_info(outcome);
  } else {
    take_register(outcome);
  }
  if (error_) {
    return std::nullopt;
  }
  const bool foreign = step_ == Step::model_number && !member_.is_servo && !recording_lacks_model_;
  const auto following = static_cast<Step>(std::to_underlying(step_) + 1);
  const bool last =
      following == Step::end || (following == Step::static_node_id && !options_.static_node_id);
  return foreign || last ? conclude() : question(following);
}

void Identification::take_node_info(const Outcome& outcome) {
  auto response =
      outcome.answered() ? GetNodeInfo::Response::decode(outcome.payload) : std::nullopt;
  if (!response && outcome.kind != Outcome::Kind::not_recorded) {
    error_ = no_answer(outcome, member_.id, "GetNodeInfo");
    if (error_->code == Code::timeout) {
      const std::uint8_t id = member_.id.value();
      *error_ = roster_.heard(member_.id) ? Error{Code::timeout, say<texts::node_mute>(id),
                                                  say<texts::no_answer_hint>(), id}
                                          : Error{Code::not_found, say<texts::node_not_found>(id),
                                                  say<texts::node_not_found_hint>(), id};
    }
    return;
  }
  // Whatever was known may be that of another unit.
  member_.info = std::move(response);
  member_.identity = {};
  member_.is_servo = false;
  member_.servo_id = member_.static_node_id = std::nullopt;
  boot_ = member_.info_boot = member_.boots;
}

void Identification::take_register(const Outcome& outcome) {
  const auto value = register_value(outcome, member_.id, address_of(step_));
  const bool first = step_ == Step::model_number;
  // A node without parameters (a GPS, a battery) answers GetNodeInfo and nothing else.
  const bool foreign =
      first && !value && !member_.sends_actuator_status() && value.error().code == Code::timeout;
  const bool not_recorded = outcome.kind == Outcome::Kind::not_recorded;
  if (!value && value.error().code != Code::refused && !foreign && !not_recorded) {
    error_ = value.error();
    return;
  }
  recording_lacks_model_ = recording_lacks_model_ || (first && not_recorded);
  member_.is_servo = member_.is_servo || value.has_value();
  auto& destination = slot(step_);
  destination = std::nullopt;
  if (value) {
    const auto* parameter = profiles_.find(address_of(step_));
    destination = parameter != nullptr ? parameter->width.narrow(*value) : *value;
  }
}

/// What a recording holds of a node may not tell whether it is a servo.
std::optional<Error> Identification::undecided() const {
  const bool foreign = member_.info && !member_.sends_actuator_status();
  if (!recording_lacks_model_ || member_.is_servo || foreign) {
    return std::nullopt;
  }
  const std::uint8_t id = member_.id.value();
  return Error{Code::not_recorded,
               roster_.heard(member_.id) ? say<texts::identity_not_recorded>(id)
                                         : say<texts::node_not_recorded>(id),
               say<texts::not_recorded_hint>(), id};
}

std::optional<Request> Identification::conclude() {
  error_ = undecided();
  if (error_) {
    return std::nullopt;
  }
  if (member_.is_servo) {
    member_.identity = bla::Identity(profiles_, readings_);
    if (options_.assumed != nullptr) {
      if (auto agreed = member_.identity.assume(*options_.assumed); !agreed) {
        error_ = agreed.error();
        error_->node_id = member_.id.value();
        error_->message = say<texts::about_node>(member_.id.value(), error_->message);
        return std::nullopt;
      }
    }
  }
  member_.identified = true;
  member_.identified_boot = boot_; // not the present one: it may have restarted in between
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

dronecan::Step DoubleCheckJob::next(const Outcome& outcome) {
  if (outcome.kind == Outcome::Kind::start) {
    return ask(member_.id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), patience_);
  }
  const auto info =
      outcome.answered() ? GetNodeInfo::Response::decode(outcome.payload) : std::nullopt;
  if (info && member_.info && info->unique_id != member_.info->unique_id &&
      member_.identified_boot == member_.boots) {
    roster_.mark_doubled(member_.id);
  }
  return std::nullopt;
}

} // namespace blactl::fleet
