#pragma once
// What tests of whole changes share: servos of a scene, goals, and the record of one command.

#include "blactl/fleet/change/change.hpp"
#include "blactl/fleet/change/history.hpp"

#include "support.hpp"
#include "unit/state/processes.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::fleet::test {

/// A servo of a scene, with its node ID as serial number; `more`: further members, with a comma
/// before each.
inline std::string servo_at(int node_id, std::string_view more = "") {
  return fmt::format(R"({{"model": "BLA21-12U-AB", "node_id": {0}, "serial_number": {0}{1}}})",
                     node_id, more);
}

inline std::string scene_of(const std::vector<std::string>& servos) {
  return fmt::format(R"("servos": [{}])", fmt::join(servos, ", "));
}

/// In RAM only.
inline Goal goal(std::uint8_t id, const std::vector<std::string>& texts,
                 Evidence evidence = Evidence::none) {
  return {.id = NodeId(id), .wanted = {.assignments = assignments(texts)}, .evidence = evidence};
}

inline Goal saved_goal(std::uint8_t id, const std::vector<std::string>& texts,
                       Evidence evidence = Evidence::none) {
  Goal saved = goal(id, texts, evidence);
  saved.wanted.restart = RestartKind::save;
  return saved;
}

inline std::vector<Code> codes(const std::vector<Error>& errors) {
  std::vector<Code> all;
  for (const Error& error : errors) {
    all.push_back(error.code);
  }
  return all;
}

/// The stores of this machine, as each command opens them.
class Stores {
 public:
  [[nodiscard]] History history(std::string command,
                                state::Access access = state::Access::write) const {
    const std::string folder = (folder_.path / "state").string();
    auto snapshots = state::SnapshotStore::open(folder, access);
    auto proofs = state::ProofStore::open(folder, access);
    REQUIRE(snapshots);
    REQUIRE(proofs);
    return {std::move(command), std::move(*snapshots), std::move(*proofs)};
  }

 private:
  state::test::Folder folder_;
};

/// This command, with its record, to its end.
inline void command(const Scene& scene, const Stores& stores, std::string name,
                    std::vector<Goal> goals) {
  History history = stores.history(std::move(name));
  Change change(*scene.session, profiles(), {.manner = {.history = &history, .proofs = &history}});
  REQUIRE(change.prepare(std::move(goals)).empty());
  REQUIRE(change.carry_out().empty());
  for (const GoalResult& result : change.results()) {
    REQUIRE(result.is_done);
  }
  scene.live(3s);
}

/// What nobody records, and this process does not hear: by another machine.
inline void elsewhere(const Scene& scene, std::uint8_t id, const Wanted& wanted) {
  const auto plans = plans_for(scene, wanted, {id});
  REQUIRE(carry_out(*scene.session, profiles(), plans, {}).servos[0].is_done());
}

} // namespace blactl::fleet::test
