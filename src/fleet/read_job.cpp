#include "blactl/fleet/read_job.hpp"

#include "blactl/fleet/texts.hpp"

#include <utility>

namespace blactl::fleet {

using dronecan::Outcome;
using dronecan::Request;

ReadJob::ReadJob(Roster& roster, Member& member, const bla::Profiles& profiles,
                 Identification::Options options, Plan plan)
    : member_(member), patience_(options.patience),
      identification_(roster, member, profiles, options), plan_(std::move(plan)) {}

dronecan::Step ReadJob::next(const Outcome& outcome) {
  if (!identification_.done()) {
    if (auto question = identification_.next(outcome)) {
      return question;
    }
    return make_plan();
  }
  const bla::Parameter& parameter = *wanted_[readings_.size()];
  auto raw = register_value(outcome, member_.id, parameter.address);
  if (raw) {
    *raw = parameter.width.narrow(*raw);
  }
  readings_.push_back({&parameter, std::move(raw)});
  return outcome.kind == Outcome::Kind::cancelled ? std::nullopt : read_next();
}

std::optional<Request> ReadJob::make_plan() {
  if (identification_.error()) {
    error_ = identification_.error();
    return std::nullopt;
  }
  if (!member_.is_servo) {
    const std::uint8_t id = member_.id.value();
    const std::string name = member_.info ? printable(member_.info->name) : std::string();
    error_ = Error{Code::not_found, say<texts::not_a_servo>(id, name),
                   say<texts::node_not_found_hint>(), id};
    return std::nullopt;
  }
  auto wanted = plan_(member_);
  if (!wanted) {
    error_ = std::move(wanted.error());
    error_->node_id = member_.id.value();
    error_->message = say<texts::about_node>(member_.id.value(), error_->message);
    return std::nullopt;
  }
  wanted_ = std::move(*wanted);
  readings_.reserve(wanted_.size());
  return read_next();
}

std::optional<Request> ReadJob::read_next() {
  if (readings_.size() == wanted_.size()) {
    return std::nullopt;
  }
  return read_register(member_.id, wanted_[readings_.size()]->address, patience_);
}

std::optional<std::int64_t> ReadJob::raw(bla::Address address) const {
  for (const Reading& reading : readings_) {
    if (reading.parameter->address == address && reading.raw) {
      return *reading.raw;
    }
  }
  return std::nullopt;
}

} // namespace blactl::fleet
