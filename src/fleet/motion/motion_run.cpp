#include "blactl/fleet/motion/motion_run.hpp"

#include "blactl/fleet/change/guard.hpp"
#include "blactl/fleet/change/survey.hpp"

#include "fleet/motion/motion_texts.hpp"

#include <array>
#include <vector>

namespace blactl::fleet {

namespace at = bla::address;
using dronecan::NodeId;

namespace {

Error shared(const MotionPlan& plan, std::string message) {
  return {Code::duplicate_servo_id, std::move(message), say<texts::motion_servo_id_hint>(),
          plan.servo().id.value()};
}

/// unproven: whether a new 0x45 counts at once, or from the next start on.
std::optional<Error> refuse_pending_id(const Roster& roster, NodeId servo, std::int64_t servo_id) {
  const auto told = roster.member(servo).actuator_id;
  const std::uint8_t id = servo.value();
  return told && *told != servo_id
             ? std::optional(Error{Code::state,
                                   say<texts::motion_servo_id_later>(id, servo_id, *told),
                                   say<texts::motion_servo_id_later_hint>(id), id})
             : std::nullopt;
}

} // namespace

std::optional<Error> refuse_servo_id(Session& session, const bla::Profiles& profiles,
                                     const MotionPlan& plan,
                                     const Identification::Options& options) {
  const std::int64_t servo_id = plan.plan.before.raw(at::servo_id).value_or(0);
  if (auto later = refuse_pending_id(session.roster(), plan.servo().id, servo_id)) {
    return later;
  }
  const auto others = neighbours(session, profiles, options, Unidentified::asked, plan.servo().id);
  if (!others) {
    return others.error();
  }
  if (!session.roster().pending().empty()) {
    return shared(plan, say<texts::motion_servo_id_pending>(servo_id));
  }
  for (const Neighbour& other : *others) {
    const auto told = session.roster().member(other.id).actuator_id;
    if (!other.servo_id || session.roster().is_doubled(other.id)) {
      return shared(plan, say<texts::motion_servo_id_unknown>(other.id.value(), servo_id));
    }
    // it is not known which of the two it obeys
    if (other.servo_id == servo_id || told == servo_id) {
      return shared(plan, say<texts::motion_servo_id_shared>(plan.servo().id.value(),
                                                             other.id.value(), servo_id));
    }
  }
  return std::nullopt;
}

std::optional<Error> refuse_to_command(const Session& session, const MotionPlan& plan,
                                       bool while_driven) {
  return forbidden(session.roster(), session.now(), plan.plan, while_driven);
}

Commanded command(Session& session, const MotionPlan& plan, const MotionManner& manner) {
  constexpr Duration end_time = std::chrono::seconds(10); // contract, section 2
  MotionJob* running = nullptr;
  MotionJob job(session.roster(), plan,
                {.patience = manner.patience,
                 .while_driven = manner.while_driven,
                 .now = [&] { return session.now(); },
                 .sampled =
                     [&](const MotionSample& sample) {
                       if (manner.sampled && !manner.sampled(sample)) {
                         running->stop();
                       }
                     },
                 .broadcast =
                     [&](const dronecan::ArrayCommand& message) {
                       session.node().broadcast(dronecan::ArrayCommand::type,
                                                dronecan::priority_medium, message.encode());
                     }});
  running = &job;
  session.set_grace(end_time);
  session.on_stopping([&] {
    job.stop();
    if (manner.ending) {
      manner.ending();
    }
  });
  const auto ran = session.run(std::array<dronecan::Job*, 1>{&job});
  session.on_stopping({});
  return {job.result(), ran ? std::nullopt : std::optional(ran.error())};
}

} // namespace blactl::fleet
