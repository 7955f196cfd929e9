#include "fleet/change/last_look.hpp"

#include "blactl/fleet/bus/run_proof.hpp"
#include "blactl/fleet/bus/texts.hpp"

#include <list>

namespace blactl::fleet {
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

Result<std::vector<std::optional<Error>>> look_last(Session& session, std::span<const Servo> servos,
                                                    Patience patience, LastLook look) {
  std::list<RunProof> proofs;
  std::vector<dronecan::Job*> group;
  for (const Servo& servo : servos) {
    group.push_back(&proofs.emplace_back(
        session.roster(), servo, look == LastLook::run ? std::optional(servo.since) : std::nullopt,
        patience));
  }
  if (const auto ran = session.run(group); !ran) {
    return std::unexpected(ran.error());
  }
  std::vector<std::optional<Error>> all;
  for (const RunProof& proof : proofs) {
    all.push_back(lost(proof, servos[all.size()], look));
  }
  return all;
}

} // namespace blactl::fleet
