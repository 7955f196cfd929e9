#include "fleet/change/last_look.hpp"

#include "blactl/fleet/bus/run_proof.hpp"
#include "blactl/fleet/bus/texts.hpp"

#include <list>
#include <utility>
#include <vector>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

std::optional<Error> lost(const RunProof& proof, const Servo& servo, LastLook look) {
  const std::uint8_t id = servo.id.value();
  switch (proof.verdict()) {
  case RunProof::Verdict::ran_on: break;
  case RunProof::Verdict::restarted:
    if (look == LastLook::unit) {
      break;
    }
    return Error{Code::state, say<texts::lost_since>(id), say<texts::run_again_hint>(), id};
  case RunProof::Verdict::too_late:
    return Error{Code::state, say<texts::written_too_late>(id), say<texts::run_again_hint>(), id};
  case RunProof::Verdict::failed: return proof.error();
  }
  return std::nullopt;
}

} // namespace

bool may_have_restarted(const Roster& roster, NodeId id, std::uint32_t boots,
                        std::optional<dronecan::Health> health) {
  const Member member = roster.member(id);
  return member.boots != boots || roster.has_moved(member) ||
         (member.status && health && member.status->health != health);
}

std::optional<Error> unproven_since(const Roster& roster, NodeId id, std::uint32_t boots) {
  const Member member = roster.member(id);
  if (member.boots == boots && !roster.has_moved(member)) {
    return std::nullopt;
  }
  return Error{Code::state, say<texts::unproven_since>(id.value()), say<texts::run_again_hint>(),
               id.value()};
}

Result<std::map<NodeId, Error>> look_last(Session& session, std::span<const Servo> servos,
                                          Patience patience, LastLook look) {
  std::list<RunProof> proofs;
  std::vector<dronecan::Job*> group;
  for (const Servo& servo : servos) {
    const auto since = look == LastLook::run ? std::optional(servo.since) : std::nullopt;
    group.push_back(&proofs.emplace_back(session.roster(), servo, since, patience));
  }
  if (const auto ran = session.run(group); !ran) {
    return std::unexpected(ran.error());
  }
  std::map<NodeId, Error> all;
  auto servo = servos.begin();
  for (const RunProof& proof : proofs) {
    if (auto why = lost(proof, *servo, look)) {
      all.emplace(servo->id, std::move(*why));
    }
    ++servo;
  }
  return all;
}

} // namespace blactl::fleet
