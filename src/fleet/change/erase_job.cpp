#include "blactl/fleet/change/erase_job.hpp"

#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "fleet/change/texts.hpp"

namespace blactl::fleet {

using dronecan::ExecuteOpcode;
using dronecan::GetNodeInfo;
using dronecan::Outcome;
using dronecan::Step;

namespace {

constexpr std::int64_t erased_servo_id = 0; // the default of 0x45

} // namespace

Step EraseJob::next(const Outcome& outcome) {
  const std::uint8_t id = servo_.id.value();
  switch (at_) {
  case At::begin:
    at_ = At::unit;
    return ask(servo_.id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), patience_);
  case At::unit: {
    const auto info =
        outcome.answered() ? GetNodeInfo::Response::decode(outcome.payload) : std::nullopt;
    const bool is_same = info && info->unique_id == servo_.unique_id;
    if (roster_.is_doubled(servo_.id)) {
      error_ = doubled(roster_, servo_.id);
    } else if (!info) {
      error_ = no_answer(outcome, servo_.id, "GetNodeInfo");
    } else if (!is_same || roster_.member(servo_.id).boots != servo_.boot) {
      error_ =
          Error{Code::state,
                is_same ? say<texts::restarted_before_erase>(id) : say<texts::another_servo>(id),
                say<texts::run_again_hint>(), id};
    }
    if (error_) {
      return std::nullopt;
    }
    at_ = At::request;
    Patience once = patience_;
    once.retries = 0;
    return guard_.guarded(ask(servo_.id, ExecuteOpcode::type,
                              ExecuteOpcode::Request{.opcode = ExecuteOpcode::erase}.encode(),
                              once),
                          servo_, erased_servo_id);
  }
  case At::request: break;
  }
  if (outcome.answered()) {
    const auto response = ExecuteOpcode::Response::decode(outcome.payload);
    is_confirmed_ = response && response->ok;
    is_refused_ = !is_confirmed_;
  } else if (outcome.kind == Outcome::Kind::withheld) {
    is_withheld_ = true;
    error_ = guard_.forbids(servo_, outcome.at, erased_servo_id);
  } else if (outcome.kind != Outcome::Kind::timed_out) {
    error_ = no_answer(outcome, servo_.id, "ERASE");
  }
  return std::nullopt;
}

} // namespace blactl::fleet
