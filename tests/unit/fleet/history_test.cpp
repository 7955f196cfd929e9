// What is recorded of changes that are carried out on simulated servos.

#include "blactl/fleet/change/carry_out.hpp"
#include "blactl/fleet/change/history.hpp"
#include "blactl/fleet/change/undo.hpp"

#include "fleet/change/unnamed.hpp"
#include "support.hpp"
#include "unit/state/processes.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using state::Access;
using state::ProofStore;
using state::SnapshotEntry;
using state::SnapshotStore;
namespace at = bla::address;

namespace {

std::string servos(std::string_view more = "") {
  return fmt::format(R"("servos": [{{"model": "BLA21-12U-AB", "node_id": 11{}}},
                                   {{"model": "BLA21-12U-AB", "node_id": 12}}])",
                     more);
}

/// The stores of a test, as the next process finds them.
class Kept {
 public:
  [[nodiscard]] History history(std::string command = "set") const {
    auto snapshots = SnapshotStore::open(folder(), Access::write);
    auto proofs = ProofStore::open(folder(), Access::write);
    REQUIRE(snapshots);
    REQUIRE(proofs);
    return {std::move(command), std::move(*snapshots), std::move(*proofs)};
  }

  [[nodiscard]] std::vector<SnapshotEntry> entries() const {
    return SnapshotStore::open(folder(), Access::read)->entries().value();
  }

  /// What `undo` without -n finds.
  [[nodiscard]] std::vector<Undoing> to_undo() const {
    return last_changes(SnapshotStore::open(folder(), Access::read).value()).value();
  }

  [[nodiscard]] std::optional<state::RomProof> proof(const Scene& scene, std::uint8_t id) const {
    const auto info = scene.member(id).info;
    REQUIRE(info);
    return ProofStore::open(folder(), Access::read)->find(info->unique_id).value();
  }

  [[nodiscard]] std::string folder() const { return (folder_.path / "state").string(); }

 private:
  state::test::Folder folder_;
};

Wanted set(const char* assignment, bool saves = false) {
  return {.assignments = assignments({assignment}),
          .restart = saves ? std::optional(RestartKind::save) : std::nullopt};
}

const Wanted save{.restart = RestartKind::save};
const Wanted restart{.restart = RestartKind::restart};

CarriedOut change(const Scene& scene, const Wanted& wanted, History& history,
                  const std::vector<std::uint8_t>& ids = {11}) {
  return carry_out(*scene.session, profiles(), plans_for(scene, wanted, ids),
                   {.history = &history});
}

void end(History& history, const std::optional<dronecan::UniqueId>& unit) {
  const std::vector<dronecan::UniqueId> units{unit.value()};
  REQUIRE(history.end(units, true));
}

/// One command on one servo, recorded by itself.
ChangeResult change(const Scene& scene, const Wanted& wanted, const Kept& kept,
                    std::string command = "set") {
  History history = kept.history(std::move(command));
  const ChangeResult result = change(scene, wanted, history).servos.front();
  end(history, result.servo.unique_id);
  return result;
}

/// A command that was killed before it could say that it has ended.
void killed(const Scene& scene, const Wanted& wanted, const Kept& kept, std::string command,
            const std::vector<std::uint8_t>& ids = {11}) {
  History history = kept.history(std::move(command));
  REQUIRE(change(scene, wanted, history, ids).servos.front().is_done());
}

std::int64_t read(const Scene& scene, std::uint8_t id, const char* name) {
  return scene.read(id, registers({name})).raw(parameter(name).address).value();
}

/// As apply will ask.
bool holds_now(const Scene& scene, const state::RomProof& proof, std::uint8_t id) {
  scene.live(1100ms);
  const Member member = scene.member(id);
  const auto now = scene.session->wall() - (scene.session->now() - member.status_at);
  return holds(proof, std::chrono::seconds(member.status->uptime_s), now, clock_of(*scene.session));
}

} // namespace

TEST_CASE(
    "what a plan replaces are settings that it is going to write, and all that ERASE resets") {
  const Plan plan = plan_for(
      {.assignments = assignments({"angle_limit_cw=90deg", "reverse=off", "command_angle=0deg"})},
      {{at::angle_limit_cw, 1799}, {at::reverse, 0}});
  CHECK(replaced_by(plan) == bla::Values{{at::angle_limit_cw, 1799}});
  const Plan erase = plan_for({.erase = true, .keep_ids = true}, {{at::servo_id, 7}});
  CHECK(replaced_by(erase).size() == bla21().identity.configuration().size());
  CHECK(replaced_by(erase).at(at::servo_id) == 7);
  CHECK(replaced_by(plan_for(save)).empty());
}

TEST_CASE("a change in RAM is recorded with what it replaces, and proves nothing") {
  const Kept kept;
  const Scene scene(servos());
  const auto result = change(scene, set("angle_limit_cw=90deg"), kept);
  REQUIRE(result.is_done());
  const auto entries = kept.entries();
  REQUIRE(entries.size() == 1);
  CHECK(entries[0].command == "set");
  CHECK(entries[0].unique_id == result.servo.unique_id);
  CHECK(entries[0].held == state::Registers{{0x38, 1799}});
  CHECK_FALSE(entries[0].saved);
  CHECK_FALSE(kept.proof(scene, 11));
}

TEST_CASE("a saved change is recorded as such, and proves all of ROM") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("angle_limit_cw=90deg", true), kept).saved);
  CHECK(kept.entries().at(0).saved);
  const auto proof = kept.proof(scene, 11);
  REQUIRE(proof);
  CHECK(proof->rom.at(0x38) == 900);
  CHECK(proof->rom.size() == bla21().identity.configuration().size());
  CHECK(proof->rom.begin()->first == 0x20);
  CHECK(holds_now(scene, *proof, 11));
  scene.live(1h);
  CHECK(holds_now(scene, *proof, 11));
}

TEST_CASE("ERASE ends the proof of ROM, which it may have erased as well") {
  for (const bool clears : {false, true}) {
    const Kept kept;
    const Scene scene(servos(fmt::format(R"(, "behaviour": {{"erase_clears_rom": {}}})", clears)));
    REQUIRE(change(scene, save, kept, "save").saved);
    REQUIRE(kept.proof(scene, 11));
    REQUIRE(change(scene, {.erase = true, .keep_ids = true}, kept, "erase").is_done());
    CHECK_FALSE(kept.proof(scene, 11));
  }
}

TEST_CASE("a proof outlives a change in RAM, and ends with the next start") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, save, kept, "save").saved);
  CHECK(kept.entries().empty()); // it replaces nothing
  REQUIRE(change(scene, set("angle_limit_cw=90deg"), kept).is_done());
  const auto proof = kept.proof(scene, 11);
  REQUIRE(proof);
  CHECK(proof->rom.at(0x38) == 1799);
  CHECK(holds_now(scene, *proof, 11));
  scene.live(3s);
  History history = kept.history("restart");
  const auto plans = plans_for(scene, restart, {11});
  SECTION("that is not recorded") {
    REQUIRE(carry_out(*scene.session, profiles(), plans, {}).servos[0].is_done());
    CHECK_FALSE(holds_now(scene, *proof, 11));
  }
  SECTION("that is recorded") {
    const auto restarted =
        carry_out(*scene.session, profiles(), plans, {.history = &history}).servos[0];
    REQUIRE(restarted.is_done());
    CHECK_FALSE(kept.proof(scene, 11));
    REQUIRE(kept.entries().size() == 2); // what the restart has taken from RAM
    CHECK(kept.entries()[0].command == "restart");
    CHECK_FALSE(kept.entries()[0].saved);
  }
}

TEST_CASE("erasing is recorded whole, with IDs that are kept too") {
  const Kept kept;
  const bool keeps = GENERATE(false, true);
  const Scene scene(servos(R"(, "servo_id": 5)"));
  REQUIRE(change(scene, {.erase = true, .keep_ids = keeps}, kept, "erase").is_done());
  const auto entries = kept.entries();
  REQUIRE(entries.size() == 1);
  CHECK(entries[0].command == "erase");
  CHECK(entries[0].held.size() == bla21().identity.configuration().size());
  CHECK(entries[0].held.at(0x45) == 5);
  CHECK(entries[0].held.at(0x46) == 11);
}

TEST_CASE("a command alone is no change that could be taken back") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("command_angle=1deg"), kept).is_done());
  CHECK(kept.entries().empty());
}

TEST_CASE("whether ROM was written is told by what was sent") {
  const auto [fault, saved] =
      GENERATE(std::pair(R"("refuse_opcodes": true)", false), // it runs on, and says so
               std::pair(R"("ignore_opcodes": 9)", false),    // its uptime says so
               std::pair(R"("never_returns": true)", true), std::pair(R"("stays": true)", true),
               std::pair(R"("lose_opcode_answers": 1)", true));
  INFO(fault);
  const Kept kept;
  const Scene scene(servos(fmt::format(R"(, "faults": {{{}}})", fault)));
  (void)change(scene, set("angle_limit_cw=90deg", true), kept);
  REQUIRE(kept.entries().size() == 1);
  CHECK(kept.entries()[0].saved == saved);
}

TEST_CASE("a servo to which nothing was sent keeps its last change") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("angle_limit_cw=90deg"), kept).is_done());
  const auto before = kept.entries();
  History history = kept.history();
  auto plans = plans_for(scene, set("angle_limit_cw=80deg"), {11, 12});
  plans[0].before.servo.unique_id->front() ^= 1; // another unit is there now
  const auto results = carry_out(*scene.session, profiles(), plans, {.history = &history}).servos;
  CHECK_FALSE(results[0].is_done());
  CHECK(results[1].is_done());
  const auto after = kept.entries();
  REQUIRE(after.size() == 2);
  CHECK(after[0].unique_id == results[1].servo.unique_id);
  CHECK(after[1] == before[0]);
}

TEST_CASE("what a command has given back by itself is no change that undo would look for") {
  const Kept kept;
  const Scene scene(servos());
  const auto first = change(scene, set("angle_limit_cw=90deg"), kept);
  const auto before = kept.entries();
  History history = kept.history("monitor --identify");
  const auto results = change(scene, set("torque_output=off"), history, {11, 12}).servos;
  REQUIRE(kept.entries().size() == 3);
  REQUIRE(history.take_back(std::vector{results[0].servo.unique_id.value()}));
  const auto after = kept.entries();
  REQUIRE(after.size() == 2);
  CHECK(after[0].unique_id == results[1].servo.unique_id);
  CHECK(after[1] == before[0]);
}

TEST_CASE(
    "what SAVE makes permanent counts as saved before SAVE leaves, and not if it never does") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("angle_limit_cw=90deg"), kept).is_done());
  History history = kept.history("save");
  const auto plans = plans_for(scene, save, {11});
  REQUIRE(history.keep(plans, *scene.session));
  CHECK(kept.entries().at(0).saved); // where the command is killed now
  const std::vector<ChangeResult> unsent{{.servo = plans.front().before.servo}};
  REQUIRE(history.conclude(unsent, *scene.session));
  CHECK_FALSE(kept.entries().at(0).saved);
}

TEST_CASE("in several rounds of one command the record tells what the first has found") {
  const Kept kept;
  const Scene scene(servos());
  History history = kept.history("alloc --static");
  REQUIRE(change(scene, set("static_node_id=21", true), history).servos[0].is_done());
  const auto servo = scene.member(21).servo();
  scene.live(3s);
  REQUIRE(change(scene, set("static_node_id=22"), history, {21}).servos[0].is_done());
  REQUIRE(change(scene, set("servo_id=3"), history, {21}).servos[0].is_done());
  const auto entries = kept.entries();
  REQUIRE(entries.size() == 1);
  CHECK(entries[0].held == state::Registers{{0x45, 0}, {0x46, 11}});
  CHECK(entries[0].saved);
}

TEST_CASE("what was recorded before the first round needs no disk in the others") {
  const Kept kept;
  const Scene scene(servos());
  History history = kept.history("apply");
  const auto plans = plans_for(scene, set("angle_limit_cw=90deg", true), {11, 12});
  std::vector<Error> told;
  const Manner manner{.history = &history, .not_recorded = [&](const Error& error) {
                        told.push_back(error);
                        return std::optional(error);
                      }};
  REQUIRE_FALSE(record(*scene.session, plans, manner));
  CHECK(kept.entries().size() == 2);
  std::filesystem::rename(kept.folder(), kept.folder() + ".away");
  const std::vector<Plan> first{plans[0]};
  CHECK(carry_out(*scene.session, profiles(), first, manner).servos[0].is_done());
  CHECK(told.empty());
}

TEST_CASE("a servo whose turn never came has no change") {
  const Kept kept;
  const Scene scene(servos());
  History history = kept.history("apply");
  const auto plans = plans_for(scene, set("angle_limit_cw=90deg"), {11, 12});
  const Manner manner{.history = &history};
  REQUIRE_FALSE(record(*scene.session, plans, manner));
  const std::vector<Plan> first{plans[0]};
  REQUIRE(carry_out(*scene.session, profiles(), first, manner).servos[0].is_done());
  record_end(*scene.session, std::vector{as_planned(plans[0]), as_planned(plans[1])}, manner);
  REQUIRE(kept.entries().size() == 1);
  CHECK(kept.entries()[0].unique_id == plans[0].before.servo.unique_id);
}

TEST_CASE("ROM is proven as long as the servo runs on, however slowly its clock drifts") {
  const Kept kept;
  const Scene scene(servos());
  History history = kept.history("save");
  REQUIRE(change(scene, save, history).servos[0].saved);
  const auto rom_of = [&] {
    scene.live(1100ms);
    const auto before = scene.read(11, registers({"angle_limit_cw"}));
    return history.proven_rom(before.servo, *scene.session);
  };
  REQUIRE(rom_of());
  CHECK(rom_of()->at(at::angle_limit_cw) == 1799);
  const auto first = kept.proof(scene, 11);
  CHECK(kept.proof(scene, 11) == first);
  scene.live(2h);
  REQUIRE(rom_of());
  CHECK(kept.proof(scene, 11)->uptime >= 2h);
  REQUIRE(carry_out(*scene.session, profiles(), plans_for(scene, restart, {11}), {})
              .servos[0]
              .is_done());
  CHECK_FALSE(rom_of());
}

TEST_CASE("recording takes no frame: the same ones are on the bus") {
  const bool saves = GENERATE(false, true);
  const auto frames = [&](bool records) {
    const Kept kept;
    const Scene scene(servos());
    History history = kept.history();
    const auto plans = plans_for(scene, set("angle_limit_cw=90deg", saves), {11, 12});
    REQUIRE(carry_out(*scene.session, profiles(), plans, {.history = records ? &history : nullptr})
                .servos[1]
                .is_done());
    CHECK(kept.entries().size() == (records ? 2 : 0));
    return scene.sent.size();
  };
  CHECK(frames(true) == frames(false));
}

TEST_CASE("what cannot be recorded is told, and the caller decides") {
  const Kept kept;
  const Scene scene(servos());
  const bool goes_on = GENERATE(false, true);
  History history = kept.history();
  std::filesystem::rename(kept.folder(), kept.folder() + ".away");
  std::vector<Error> told;
  const auto plans = plans_for(scene, set("angle_limit_cw=90deg", true), {11});
  const std::size_t sent = scene.sent.size();
  const auto carried_out = carry_out(*scene.session, profiles(), plans,
                                     {.history = &history, .not_recorded = [&](const Error& error) {
                                        told.push_back(error);
                                        return goes_on ? std::nullopt : std::optional(error);
                                      }});
  REQUIRE_FALSE(told.empty());
  CHECK(told.front().code == Code::io);
  CHECK(carried_out.servos.at(0).is_done() == goes_on);
  CHECK(carried_out.broken.has_value() != goes_on);
  CHECK((scene.sent.size() > sent) == goes_on);
}

TEST_CASE("what took a change back puts it there again the second time") {
  const Kept kept;
  const Scene scene(servos());
  const bool saves = GENERATE(false, true);
  REQUIRE(change(scene, set("angle_limit_cw=90deg", saves), kept).is_done());
  for (const std::int64_t expected : {1799, 900, 1799}) {
    scene.live(3s);
    const auto wanted = to_undo(kept.entries().front(), profiles());
    REQUIRE(wanted);
    CHECK(wanted->restart.has_value() == saves);
    CHECK_FALSE(wanted->erase);
    REQUIRE(change(scene, *wanted, kept, "undo").is_done());
    CHECK(read(scene, 11, "angle_limit_cw") == expected);
  }
  CHECK(kept.entries().size() == 4);
}

TEST_CASE("an apply that did not end and comes again is one change") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("servo_id=3"), kept, "apply").is_done());
  killed(scene, set("angle_limit_cw=90deg"), kept, "apply", {11, 12});
  History again = kept.history("apply");
  REQUIRE(change(scene, set("reverse=on"), again).servos[0].is_done());
  auto entries = kept.entries();
  REQUIRE(entries.size() == 3);
  CHECK(entries[0].held == state::Registers{{0x23, 0}, {0x38, 1799}});
  CHECK(entries[1].run == entries[0].run); // undo takes both servos back
  CHECK_FALSE(entries[0].ended);
  // Another command, and one after the end, are changes of their own.
  end(again, entries[0].unique_id);
  REQUIRE(change(scene, set("smoothing=off"), kept, "apply").is_done());
  REQUIRE(change(scene, set("soft_start=off"), kept).is_done());
  CHECK(kept.entries().size() == 5);
}

TEST_CASE("a servo that has run on since an apply was killed has saved nothing") {
  const Kept kept;
  const Scene scene(servos());
  scene.live(8s);
  History history = kept.history("apply");
  REQUIRE(history.keep(plans_for(scene, set("angle_limit_cw=90deg", true), {11}), *scene.session));
  const auto left = kept.to_undo(); // as if it had been killed before its first request
  REQUIRE(left.size() == 1);
  REQUIRE(left[0].perhaps_saved_since);
  const auto found = [&](Undoing change) {
    return as_left(std::move(change), NodeId(11), *scene.session, profiles(), {}).value().entry;
  };
  CHECK_FALSE(found(left[0]).saved);
  CHECK(found(left[0]).held == left[0].entry.held);
  Undoing near_start = left[0]; // clocks are not that exact
  *near_start.perhaps_saved_since -= 6s;
  CHECK(found(near_start).saved);
  Undoing of_another_clock = left[0]; // set back for longer than the servo runs
  *of_another_clock.entry.clock -= 1s;
  CHECK(found(of_another_clock).saved);
  of_another_clock.entry.clock.reset(); // this machine has restarted since
  CHECK(found(of_another_clock).saved);
  Undoing of_set_clock = left[0];
  *of_set_clock.perhaps_saved_since += 1h;
  CHECK(found(of_set_clock).saved); // then ROM is looked at
  const Kept of_another;
  REQUIRE(change(scene, set("angle_limit_cw=60deg", true), of_another).is_done());
  CHECK(found(left[0]).held.empty()); // that is somebody else's
  const std::string before = std::to_string(left[0].entry.held.at(0x38)) + "raw";
  REQUIRE(change(scene, set(("angle_limit_cw=" + before).c_str()), of_another).is_done());
  CHECK(found(left[0]).held == left[0].entry.held); // in RAM alone: ROM may hold another value
  CHECK(found(left[0]).saved);
  REQUIRE(change(scene, set("angle_limit_cw=90deg", true), of_another).is_done());
  CHECK(found(left[0]).held == left[0].entry.held);
  CHECK(found(left[0]).saved);
}

TEST_CASE("what certainly was saved is taken back in ROM") {
  const Kept kept;
  const Scene scene(servos());
  killed(scene, set("angle_limit_cw=90deg", true), kept, "apply");
  killed(scene, set("reverse=on"), kept, "apply");
  for (const Undoing& each : kept.to_undo()) {
    CHECK_FALSE(each.perhaps_saved_since);
  }
}

TEST_CASE("where ROM is unknown, the node ID of a servo is the one on which it started") {
  const Kept kept;
  const Scene scene(servos());
  const Kept of_another;
  REQUIRE(change(scene, set("static_node_id=13"), of_another).is_done());
  REQUIRE(change(scene, set("static_node_id=14", true), kept, "alloc --static").is_done());
  const auto last = kept.to_undo();
  REQUIRE(last.size() == 1);
  CHECK(last[0].entry.held.at(0x46) == 11);
}

TEST_CASE("an apply that comes again after another command is the last one") {
  const Kept kept;
  const Scene scene(servos());
  killed(scene, set("angle_limit_cw=90deg"), kept, "apply", {12});
  REQUIRE(change(scene, set("smoothing=off"), kept).is_done());
  History again = kept.history("apply");
  REQUIRE(change(scene, set("angle_limit_cw=45deg"), again, {12}).servos[0].is_done());
  const auto last = kept.to_undo();
  REQUIRE(last.size() == 1);
  CHECK(last[0].entry.command == "apply");
  CHECK(last[0].entry.held == state::Registers{{0x38, 1799}});
  CHECK(kept.entries().size() == 2);
}

TEST_CASE("an apply that is repeated with other wishes is one change of each servo") {
  const Kept kept;
  const Scene scene(servos());
  History first = kept.history("apply");
  const auto tried = change(scene, set("angle_limit_cw=90deg"), first, {11, 12});
  end(first, tried.servos[0].servo.unique_id); // the other one is not as it was wished
  History second = kept.history("apply");
  REQUIRE(change(scene, set("angle_limit_cw=45deg"), second, {11, 12}).servos[0].is_done());
  const auto store = SnapshotStore::open(kept.folder(), Access::read);
  REQUIRE(kept.entries().size() == 3);
  for (const auto& changes :
       {last_changes(*store).value(),
        std::vector{**last_change(*store, *tried.servos[0].servo.unique_id)}}) {
    for (const Undoing& change : changes) {
      const bool is_first = change.entry.unique_id == tried.servos[0].servo.unique_id;
      CHECK(change.entry.held == state::Registers{{0x38, 1799}});
      CHECK(change.numbers.size() == (is_first ? 2 : 1));
    }
  }
  CHECK(last_changes(*store)->size() == 2);
}

TEST_CASE("a try that goes on for one servo leaves the record of the others") {
  const Kept kept;
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11},
                                  {"model": "BLA21-12U-AB", "node_id": 12,
                                   "faults": {"ignore_opcodes": 9}}])");
  for (const char* angle : {"angle_limit_cw=90deg", "angle_limit_cw=80deg"}) {
    History tried = kept.history("apply");
    const auto servos = change(scene, set(angle, true), tried, {11, 12}).servos;
    REQUIRE(servos[0].is_done());
    REQUIRE_FALSE(servos[1].is_done());
  }
  const auto first = scene.member(11).info->unique_id;
  const auto changes = kept.to_undo();
  REQUIRE(changes.size() == 2);
  for (const Undoing& each : changes) {
    CHECK(each.entry.held == state::Registers{{0x38, 1799}});
    CHECK(each.numbers.size() == (each.entry.unique_id == first ? 2 : 1));
    CHECK(each.entry.written == state::Registers{{0x38, 800}});
  }
}

TEST_CASE(
    "a try that one servo took nothing of goes on for all, also after a restart of that one") {
  const Kept kept;
  const Scene scene(servos());
  const bool restarts = GENERATE(false, true);
  const auto plans = plans_for(scene, restart, {11, 12});
  const std::vector<dronecan::UniqueId> done{plans[0].before.servo.unique_id.value()};
  const std::vector<dronecan::UniqueId> all{done[0], plans[1].before.servo.unique_id.value()};
  const std::vector<Servo> both{plans[0].before.servo, plans[1].before.servo};
  {
    History tried = kept.history("apply");
    REQUIRE(tried.go_on(both, scene.session->wall()));
    REQUIRE(change(scene, set("angle_limit_cw=90deg", true), tried, {11}).servos[0].is_done());
    REQUIRE(tried.end(done, false));
  }
  scene.live(3s);
  if (restarts) {
    REQUIRE(change(scene, set("reverse=on"), kept, "set").is_done());
  }
  History again = kept.history("apply");
  REQUIRE(again.go_on(both, scene.session->wall()));
  REQUIRE(change(scene, set("angle_limit_cw=90deg", true), again, {12}).servos[0].is_done());
  REQUIRE(again.end(all, true));
  CHECK(kept.to_undo().size() == (restarts ? 1 : 2)); // the set has come after it on 11
}

TEST_CASE("tries of single servos, and then one of all, are one change") {
  const Kept kept;
  const Scene scene(servos());
  const bool is_saved = GENERATE(false, true);
  for (const std::vector<std::uint8_t>& one : {std::vector<std::uint8_t>{11}, {12}}) {
    killed(scene, set("angle_limit_cw=90deg", true), kept, "apply", one);
  }
  scene.live(3s);
  const std::vector<dronecan::UniqueId> all{scene.member(11).info->unique_id,
                                            scene.member(12).info->unique_id};
  History again = kept.history("apply");
  if (is_saved) {
    REQUIRE(again.go_on(std::array{scene.member(11).servo(), scene.member(12).servo()},
                        scene.session->wall()));
  }
  const auto done = change(scene, set("angle_limit_cw=80deg", is_saved), again, {11, 12});
  REQUIRE(done.servos[1].is_done());
  REQUIRE(again.end(all, true));
  const auto changes = kept.to_undo();
  REQUIRE(changes.size() == 2);
  for (const Undoing& each : changes) {
    CHECK(each.entry.held == state::Registers{{0x38, is_saved ? 1799 : 900}});
    CHECK(each.entry.saved == is_saved);
  }
}

TEST_CASE("tries of single servos that left nothing to do for one of all are undone together") {
  const Kept kept;
  const Scene scene(servos());
  for (const std::vector<std::uint8_t>& one : {std::vector<std::uint8_t>{11}, {12}}) {
    killed(scene, set("angle_limit_cw=90deg", true), kept, "apply", one);
  }
  const std::vector<dronecan::UniqueId> all{scene.member(11).info->unique_id,
                                            scene.member(12).info->unique_id};
  History again = kept.history("apply");
  REQUIRE(again.go_on(std::array{scene.member(11).servo(), scene.member(12).servo()},
                      scene.session->wall()));
  REQUIRE(again.end(all, true));
  const auto changes = kept.to_undo();
  REQUIRE(changes.size() == 2);
  for (const Undoing& each : changes) {
    CHECK(each.entry.held == state::Registers{{0x38, 1799}});
    CHECK(each.entry.ended);
  }
}

TEST_CASE("an undo that did not end goes on when it is typed again, and then is one change") {
  const Kept kept;
  const Scene scene(servos());
  const auto changes = [&kept] {
    return last_changes(*SnapshotStore::open(kept.folder(), Access::read)).value();
  };
  {
    History both = kept.history("set");
    REQUIRE(change(scene, set("angle_limit_cw=90deg"), both, {11, 12}).servos[1].is_done());
  }
  REQUIRE(changes().size() == 2);
  // It comes to the first servo alone.
  History undo = kept.history("undo");
  const auto wanted = to_undo(changes()[0].entry, profiles());
  const auto plans = plans_for(scene, *wanted, {11, 12});
  REQUIRE_FALSE(record(*scene.session, plans, {.history = &undo}));
  const std::vector<Plan> first{plans[0]};
  REQUIRE(carry_out(*scene.session, profiles(), first, {.history = &undo}).servos[0].is_done());
  end(undo, plans[0].before.servo.unique_id);
  REQUIRE(changes().size() == 1);
  const Undoing left = changes()[0];
  CHECK(left.goes_on);
  CHECK(left.entry.command == "set");
  CHECK(left.entry.unique_id == *plans[1].before.servo.unique_id);
  // The rest of it.
  History again = kept.history("undo");
  REQUIRE(change(scene, *to_undo(left.entry, profiles()), again, {12}).servos[0].is_done());
  end(again, left.entry.unique_id);
  REQUIRE(changes().size() == 2);
  for (const Undoing& change : changes()) {
    CHECK(change.entry.command == "undo");
    CHECK(change.entry.held == state::Registers{{0x38, 900}});
    CHECK_FALSE(change.goes_on);
  }
}

TEST_CASE("an erase that broke off before a restart is over: the next one is a change of its own") {
  const Kept kept;
  const Scene scene(servos());
  const Wanted erase{.erase = true, .keep_ids = true};
  const std::string command(erase_keeping_ids);
  killed(scene, erase, kept, command);
  if (const bool restarts = GENERATE(false, true); restarts) {
    REQUIRE(change(scene, restart, kept, "restart").is_done());
    scene.live(3s);
    REQUIRE(change(scene, set("angle_limit_cw=90deg"), kept).is_done());
    scene.live(3s);
    REQUIRE(change(scene, erase, kept, command).is_done());
    CHECK(kept.entries().front().held.at(0x38) == 900);
  } else {
    REQUIRE(change(scene, erase, kept, command).is_done());
    CHECK(kept.entries().size() == 1);
  }
}

TEST_CASE("IDs that an erase has lost are known as long as nobody gives others") {
  const Kept kept;
  const Scene scene(servos(R"(, "servo_id": 5)"));
  const bool gives_another = GENERATE(false, true);
  killed(scene, {.erase = true, .keep_ids = true}, kept, std::string(erase_keeping_ids));
  const Wanted none{.assignments = assignments({"servo_id=0", "static_node_id=0"})};
  REQUIRE(carry_out(*scene.session, profiles(), plans_for(scene, none, {11}), {})
              .servos[0]
              .is_done()); // as it broke off
  REQUIRE(change(scene, set(gives_another ? "servo_id=9" : "smoothing=off"), kept).is_done());
  const Snapshot ram = scene.read(11, registers({"servo_id", "static_node_id"}));
  const LostIds lost = kept.history("erase").lost_ids(ram, *scene.session);
  CHECK(bla::find(lost.ids, at::servo_id) == (gives_another ? std::nullopt : std::optional(5)));
  CHECK(bla::find(lost.ids, at::static_node_id) == 11);
  CHECK(lost.is_certain);
}

TEST_CASE("whether IDs that are gone after a restart are lost or meant is not certain") {
  const Kept kept;
  const Scene scene(servos(R"(, "servo_id": 5)"));
  const std::string command(erase_keeping_ids);
  killed(scene, {.erase = true, .keep_ids = true}, kept, command);
  const auto unrecorded = [&](const Wanted& wanted) {
    REQUIRE(carry_out(*scene.session, profiles(), plans_for(scene, wanted, {11}), {})
                .servos[0]
                .is_done());
    scene.live(3s);
  };
  unrecorded(set("servo_id=0")); // as it broke off, or meant by somebody
  unrecorded(save);
  const auto lost = [&] {
    const Snapshot ram = scene.read(11, registers({"servo_id", "static_node_id"}));
    return kept.history(command).lost_ids(ram, *scene.session);
  };
  for (int i = 0; i < 12; ++i) {
    REQUIRE(change(scene, set(i % 2 == 0 ? "reverse=on" : "reverse=off"), kept).is_done());
  }
  CHECK(lost().ids == bla::Values{{at::servo_id, 5}});
  CHECK_FALSE(lost().is_certain);
  REQUIRE(change(scene, set("servo_id=0"), kept).is_done()); // this user means it
  REQUIRE(change(scene, set("servo_id=6"), kept).is_done());
  REQUIRE(change(scene, set("servo_id=0"), kept).is_done());
  CHECK(lost().ids.empty());
}

TEST_CASE("a saved change is taken back to what ROM held, one that was not saved to RAM's value") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("angle_limit_cw=90deg"), kept).is_done());
  const bool is_armed = GENERATE(false, true); // then SAVE is withheld
  History history = kept.history();
  const auto plans = plans_for(scene, set("angle_limit_cw=45deg", true), {11});
  REQUIRE_FALSE(record(*scene.session, plans, {.history = &history}));
  CHECK(kept.entries().front().held == state::Registers{{0x38, 1799}});
  auto done = carry_out(*scene.session, profiles(), plans, {});
  if (is_armed) {
    done.servos[0].may_have_saved = false;
    done.servos[0].rom.reset(); // no restart has shown anything
  }
  REQUIRE(history.conclude(done.servos, *scene.session));
  CHECK(kept.entries().front().held == state::Registers{{0x38, is_armed ? 900 : 1799}});
  CHECK(kept.entries().front().saved == !is_armed);
}

TEST_CASE("a change that was to be saved, and was killed before, is in RAM only till a restart") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(kept.history().keep(plans_for(scene, set("angle_limit_cw=90deg", true), {11}),
                              *scene.session));
  CHECK_FALSE(kept.entries().front().settled);
  const auto unrecorded = [&](const Wanted& wanted) {
    REQUIRE(carry_out(*scene.session, profiles(), plans_for(scene, wanted, {11}), {})
                .servos[0]
                .is_done());
    const Snapshot ram = scene.read(11, registers({"angle_limit_cw"}));
    return kept.history().known_rom(ram, *scene.session);
  };
  CHECK(unrecorded(set("angle_limit_cw=90deg")) == bla::Values{{at::angle_limit_cw, 1799}});
  const Goal goal{.id = dronecan::NodeId(11), .wanted = set("smoothing=off", true)};
  const Snapshot ram = scene.read(11, registers({"angle_limit_cw", "smoothing"}));
  History history = kept.history();
  const auto warnings =
      unnamed(goal, ram, told_rom(goal, ram, &history, *scene.session), Need::write);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].code == "unnamed_saved");
  CHECK(warnings[0].text.find("since a change that is not known to be saved") != std::string::npos);
  scene.live(3s);
  CHECK(unrecorded(restart).empty());
}

TEST_CASE("a repeated apply counts as saved only where the first try may have been") {
  const Kept kept;
  const Scene scene(servos());
  const auto carry = [&](const Wanted& wanted) { // with no record: as before a kill
    const auto plans = plans_for(scene, wanted, {11});
    REQUIRE(carry_out(*scene.session, profiles(), plans, {}).servos[0].is_done());
    scene.live(3s);
  };
  const auto begin = [&] {
    REQUIRE(kept.history("apply").keep(plans_for(scene, set("angle_limit_cw=90deg", true), {11}),
                                       *scene.session));
  };
  begin();
  carry(set("angle_limit_cw=90deg"));
  SECTION("repeated in RAM only") {
    History again = kept.history("apply");
    REQUIRE(change(scene, set("angle_limit_cw=80deg"), again).servos[0].is_done());
    CHECK_FALSE(kept.entries().front().saved);
    CHECK(kept.entries().front().held == state::Registers{{0x38, 1799}});
  }
  SECTION("repeated after a restart, and killed again") {
    carry(restart);
    begin();
    carry(set("angle_limit_cw=90deg"));
    const Snapshot ram = scene.read(11, registers({"angle_limit_cw"}));
    CHECK(kept.history().known_rom(ram, *scene.session) == bla::Values{{at::angle_limit_cw, 1799}});
  }
  SECTION("repeated after its SAVE") {
    carry(save);
    History again = kept.history("apply");
    REQUIRE(change(scene, set("angle_limit_cw=80deg"), again).servos[0].is_done());
    CHECK_FALSE(kept.entries().front().saved);
    CHECK(kept.entries().front().held == state::Registers{{0x38, 900}});
    CHECK(kept.entries().front().run != kept.entries().back().run); // a change of its own
  }
}

TEST_CASE("a repetition that finds what was written in ROM has been saved by an earlier try") {
  const Kept kept;
  const Scene scene(servos());
  const auto begin = [&] {
    REQUIRE(kept.history("apply").keep(plans_for(scene, set("angle_limit_cw=90deg", true), {11}),
                                       *scene.session));
  };
  begin();
  REQUIRE(carry_out(*scene.session, profiles(),
                    plans_for(scene, set("angle_limit_cw=90deg", true), {11}), {})
              .servos[0]
              .is_done());
  scene.live(3s);
  begin(); // killed before its restart has shown anything
  History again = kept.history("apply");
  const Wanted proof{.restart = RestartKind::restart, .proves_rom = true};
  REQUIRE(change(scene, proof, again).servos[0].is_done());
  CHECK(kept.entries().front().saved);
  CHECK(kept.entries().front().held == state::Registers{{0x38, 1799}});
}

TEST_CASE("a restart that is to show ROM, and broke off, leaves only what it takes for certain") {
  const Kept kept;
  const Scene scene(servos());
  const Wanted proof{.restart = RestartKind::restart, .proves_rom = true};
  REQUIRE(kept.history("apply").keep(plans_for(scene, proof, {11}), *scene.session));
  CHECK(kept.entries().empty());
  REQUIRE(change(scene, set("angle_limit_cw=90deg"), kept).is_done());
  scene.live(3s);
  REQUIRE(kept.history("apply").keep(plans_for(scene, proof, {11}), *scene.session));
  REQUIRE(kept.entries().size() == 2);
  CHECK(kept.entries().front().command == "apply");
  CHECK(kept.entries().front().held == state::Registers{{0x38, 900}});
}

TEST_CASE("a restart that is to show ROM records what it has taken from RAM") {
  const Kept kept;
  const Scene scene(servos());
  const bool is_recorded = GENERATE(false, true);
  const auto trial = plans_for(scene, set("angle_limit_cw=90deg"), {11});
  History trying = kept.history();
  REQUIRE(carry_out(*scene.session, profiles(), trial, {.history = is_recorded ? &trying : nullptr})
              .servos[0]
              .is_done());
  scene.live(3s);
  const Wanted proof{.restart = RestartKind::restart, .proves_rom = true};
  History proving = kept.history("apply");
  REQUIRE(change(scene, proof, proving).servos[0].is_done());
  REQUIRE(kept.entries().size() == (is_recorded ? 2 : 1));
  const SnapshotEntry taken = kept.entries().front();
  CHECK(taken.command == "apply");
  CHECK(taken.held == state::Registers{{0x38, 900}});
  CHECK(taken.written.empty());
  CHECK_FALSE(taken.saved);
  scene.live(3s);
  REQUIRE(change(scene, proof, proving).servos[0].is_done()); // RAM is like ROM now
  CHECK(kept.entries().size() == (is_recorded ? 2 : 1));
}

TEST_CASE("a SAVE of which nothing is known leaves the change unsettled") {
  const Kept kept;
  const Scene scene(servos());
  History history = kept.history();
  const auto plans = plans_for(scene, set("angle_limit_cw=90deg", true), {11});
  REQUIRE(history.keep(plans, *scene.session));
  ChangeResult result = as_planned(plans[0]);
  result.was_sent = result.may_have_changed = result.may_have_saved = true;
  result.saved = false;
  REQUIRE(history.conclude(std::vector{result}, *scene.session));
  CHECK(kept.entries().front().saved);
  CHECK_FALSE(kept.entries().front().settled);
}

TEST_CASE("a named value that the servo changed at another write was changed, too") {
  const Kept kept;
  const Scene scene(servos());
  History history = kept.history();
  const Wanted wanted{.assignments = assignments({"angle_limit_cw=90deg", "smoothing=on"})};
  const auto plans = plans_for(scene, wanted, {11});
  REQUIRE(history.keep(plans, *scene.session));
  ChangeResult result = as_planned(plans[0]);
  result.was_sent = result.may_have_changed = true;
  const bool is_written_again = GENERATE(true, false);
  RegisterChange& smoothing = result.changes.at(1);
  REQUIRE(smoothing.status == ChangeStatus::unchanged);
  smoothing.status = is_written_again ? ChangeStatus::written : ChangeStatus::mismatch;
  smoothing.after = is_written_again ? 1 : 0;
  REQUIRE(history.conclude(std::vector{result}, *scene.session));
  CHECK(kept.entries().front().held == state::Registers{{0x38, 1799}, {0x22, 1}});
  CHECK(kept.entries().front().settled);
}

TEST_CASE("values that were written again after a restart, and not saved, are in RAM only") {
  const Kept kept;
  const Scene scene(servos(R"(, "faults": {"ignore_opcodes": 9,
      "restart_after_answer": [{"to": "write", "number": 1}]})"));
  scene.live(3s);
  CHECK_FALSE(change(scene, set("angle_limit_cw=90deg", true), kept).is_done());
  const Snapshot ram = scene.read(11, registers({"angle_limit_cw"}));
  REQUIRE(ram.raw(at::angle_limit_cw) == 900);
  CHECK(kept.history().known_rom(ram, *scene.session) == bla::Values{{at::angle_limit_cw, 1799}});
}

TEST_CASE("a trial that a killed save has made permanent is in ROM") {
  const Kept kept;
  const Scene scene(servos());
  scene.live(3s);
  REQUIRE(change(scene, set("angle_limit_cw=90deg"), kept).is_done());
  const auto plans = plans_for(scene, save, {11});
  REQUIRE(kept.history("save").keep(plans, *scene.session));
  REQUIRE(carry_out(*scene.session, profiles(), plans, {}).servos[0].is_done());
  scene.live(1100ms);
  const Snapshot ram = scene.read(11, registers({"angle_limit_cw"}));
  CHECK(kept.history().unsaved(ram.servo, *scene.session, &ram).empty());
}

TEST_CASE("a change in RAM is no longer so once another tool has saved it, however soon") {
  const Kept kept;
  const Scene scene(servos());
  scene.live(3s);
  REQUIRE(change(scene, set("angle_limit_cw=90deg"), kept).is_done());
  scene.live(1500ms);
  REQUIRE(
      carry_out(*scene.session, profiles(), plans_for(scene, save, {11}), {}).servos[0].is_done());
  scene.live(1100ms);
  const Snapshot ram = scene.read(11, registers({"angle_limit_cw"}));
  CHECK(kept.history().unsaved(ram.servo, *scene.session, &ram).empty());
}

TEST_CASE("a SAVE of another node in the middle of a change that was to be saved is recorded") {
  bool was_cut = false;
  for (int at = 4'000; at < 4'300; at += 4) {
    const Kept kept;
    const Scene scene(fmt::format(
        R"("servos": [{{"model": "BLA21-12U-AB", "node_id": 11, "rom": {{"reverse": "on"}}}}],
           "foreign": [{{"kind": "node", "node_id": 91,
                         "orders": [{{"order": "save", "to": 11, "at": "{}ms"}}]}}])",
        at));
    scene.live(3s);
    const Wanted erase{.erase = true, .keep_ids = true, .restart = RestartKind::save};
    const auto plans = plans_for(scene, erase, {11});
    REQUIRE(scene.session->live_until(Time{} + 3'990ms));
    History history = kept.history(std::string(erase_keeping_ids));
    const Manner manner{.may_allocate = true, .history = &history};
    const auto done = carry_out(*scene.session, profiles(), plans, manner).servos[0];
    scene.live(3s);
    if (scene.roster().heard(NodeId(11)) && scene.member(11).last_heard > done.looked_at) {
      was_cut = !done.is_done() || was_cut;
      const bool is_saved = read(scene, 11, "reverse") == 0; // since its restart, which SAVE brings
      INFO(at);
      CHECK(kept.entries().front().saved == is_saved);
    }
  }
  CHECK(was_cut);
}

TEST_CASE("a change in RAM that another node saves meanwhile is taken back to what ROM held") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, save, kept).is_done());
  REQUIRE(change(scene, set("angle_limit_cw=90deg"), kept).is_done());
  History history = kept.history();
  const auto plans = plans_for(scene, set("angle_limit_cw=45deg"), {11});
  REQUIRE(history.keep(plans, *scene.session));
  CHECK(kept.entries().front().held == state::Registers{{0x38, 900}});
  auto done = carry_out(*scene.session, profiles(), plans, {});
  const bool is_saved = GENERATE(true, false);
  done.servos[0].may_have_saved = is_saved;
  REQUIRE(history.conclude(done.servos, *scene.session));
  CHECK(kept.entries().front().held == state::Registers{{0x38, is_saved ? 1799 : 900}});
  CHECK(kept.entries().front().saved == is_saved);
}

TEST_CASE("a change in RAM that was killed and is repeated after a restart stays one in RAM") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("angle_limit_cw=77deg", true), kept).is_done());
  REQUIRE(change(scene, set("angle_limit_cw=33deg"), kept).is_done());
  killed(scene, set("angle_limit_cw=77deg"), kept, "apply");
  scene.live(15s);
  REQUIRE(carry_out(*scene.session, profiles(), plans_for(scene, restart, {11}), {})
              .servos[0]
              .is_done());
  scene.live(3s);
  REQUIRE(change(scene, set("angle_limit_ccw=-90deg"), kept, "apply").is_done());
  CHECK_FALSE(kept.entries().front().saved);
}

TEST_CASE("a try that was to save, broke off, and was lost in a restart, leaves nothing") {
  const Kept kept;
  const Scene scene(servos());
  const auto unrecorded = [&](const Wanted& wanted) {
    REQUIRE(carry_out(*scene.session, profiles(), plans_for(scene, wanted, {11}), {})
                .servos[0]
                .is_done());
    scene.live(3s);
  };
  unrecorded(set("angle_limit_cw=33deg")); // a trial of another tool
  REQUIRE(kept.history("apply").keep(plans_for(scene, set("angle_limit_cw=77deg", true), {11}),
                                     *scene.session));
  unrecorded(set("angle_limit_cw=77deg"));
  scene.live(15s);
  unrecorded(restart);
  REQUIRE(change(scene, set("angle_limit_cw=77deg"), kept, "apply").is_done());
  CHECK_FALSE(kept.entries().front().saved);
  CHECK(kept.entries().front().held == state::Registers{{0x38, 1799}});
  CHECK(kept.entries().front().run != kept.entries().back().run);
}

/// An apply that is killed, and another user who saves another value of it.
static void saved_since_a_try(const Scene& scene, const Kept& kept) {
  killed(scene, set("angle_limit_cw=77deg", true), kept, "apply");
  scene.live(3s);
  REQUIRE(carry_out(*scene.session, profiles(),
                    plans_for(scene, set("angle_limit_cw=90deg", true), {11}), {})
              .servos[0]
              .is_done());
  scene.live(3s);
}

TEST_CASE("what another user has saved since a try broke off comes back") {
  const Kept kept;
  const Scene scene(servos());
  saved_since_a_try(scene, kept);
  REQUIRE(change(scene, set("angle_limit_cw=77deg", true), kept, "apply").is_done());
  CHECK(kept.entries().front().held == state::Registers{{0x38, 900}});
  const auto last = kept.to_undo();
  REQUIRE(last.size() == 1);
  CHECK(last[0].entry.held == state::Registers{{0x38, 900}});
}

TEST_CASE("what another user has saved since, and the repetition does not name, stays") {
  const Kept kept;
  const Scene scene(servos());
  saved_since_a_try(scene, kept);
  REQUIRE(change(scene, set("reverse=on", true), kept, "apply").is_done());
  const auto last = kept.to_undo();
  REQUIRE(last.size() == 1);
  CHECK(last[0].entry.held == state::Registers{{0x23, 0}});
}

TEST_CASE("a try in RAM only, repeated in full, leaves undo what ROM held, and no trial") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("angle_limit_cw=77deg", true), kept).is_done());
  scene.live(3s);
  REQUIRE(change(scene, set("angle_limit_cw=33deg"), kept).is_done());
  killed(scene, set("angle_limit_cw=90deg"), kept, "apply");
  REQUIRE(change(scene, set("angle_limit_cw=90deg", true), kept, "apply").is_done());
  CHECK(kept.entries().front().held == state::Registers{{0x38, 770}});
}

TEST_CASE("undo leaves no servo on the temporary ID of a circle that broke off") {
  const Kept kept;
  const Scene scene(servos());
  const std::vector<Plan> to_30 = plans_for(scene, set("static_node_id=30", true), {11});
  const std::vector<Plan> to_125 = plans_for(scene, set("static_node_id=125", true), {11});
  {
    History apply = kept.history("apply");
    REQUIRE(apply.keep(to_30, *scene.session));
    REQUIRE(apply.keep(to_125, *scene.session));
  }
  REQUIRE(carry_out(*scene.session, profiles(), to_125, {}).servos[0].is_done());
  scene.live(3s);
  const bool names_it = GENERATE(true, false);
  History again = kept.history("apply");
  const Wanted wanted = set(names_it ? "static_node_id=30" : "reverse=on", true);
  REQUIRE(change(scene, wanted, again, {125}).servos[0].is_done());
  end(again, to_30[0].before.servo.unique_id);
  const auto last = kept.to_undo();
  REQUIRE(last.size() == 1);
  CHECK(last[0].entry.held.at(0x46) == 11);
}

TEST_CASE("an undo that broke off and was repeated after a restart is over") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("angle_limit_cw=77deg", true), kept).is_done());
  scene.live(3s);
  const auto back = set("angle_limit_cw=179.9deg", true);
  REQUIRE(kept.history("undo").keep(plans_for(scene, back, {11}), *scene.session));
  REQUIRE(carry_out(*scene.session, profiles(), plans_for(scene, restart, {11}), {})
              .servos[0]
              .is_done());
  scene.live(3s);
  REQUIRE(change(scene, back, kept, "undo").is_done());
  const auto last = kept.to_undo();
  REQUIRE(last.size() == 1);
  CHECK(last[0].entry.command == "undo");
  CHECK(last[0].entry.held == state::Registers{{0x38, 770}});
  CHECK_FALSE(last[0].goes_on);
}

TEST_CASE("what a try was to write, and was killed before, was not changed by somebody else") {
  const Kept kept;
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11},
                                  {"model": "BLA21-12U-AB", "node_id": 12,
                                   "faults": {"ignore_opcodes": 2}}])");
  {
    History tried = kept.history("apply");
    const auto servos = change(scene, set("angle_limit_cw=77deg", true), tried, {11, 12}).servos;
    REQUIRE(servos[0].is_done());
    REQUIRE_FALSE(servos[1].is_done());
  }
  REQUIRE(kept.history("apply").keep(plans_for(scene, set("angle_limit_cw=88deg"), {11, 12}),
                                     *scene.session));
  for (const Wanted& wanted : {restart, set("angle_limit_cw=99deg", true)}) {
    History again = kept.history(wanted.assignments.empty() ? "restart" : "apply");
    const auto plans = plans_for(scene, wanted, {11, 12});
    const Manner manner{.history = wanted.assignments.empty() ? nullptr : &again};
    const auto servos = carry_out(*scene.session, profiles(), plans, manner).servos;
    REQUIRE((servos[0].is_done() && servos[1].is_done()));
    scene.live(3s);
  }
  for (const Undoing& each : kept.to_undo()) {
    CHECK(each.entry.held == state::Registers{{0x38, 1799}});
  }
}

TEST_CASE("a named value that RAM alone held before the first try is not what ROM goes back to") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("angle_limit_cw=70deg"), kept).is_done());
  const Wanted named{.assignments = assignments({"angle_limit_cw=70deg", "reverse=on"}),
                     .restart = RestartKind::save};
  killed(scene, named, kept, "apply");
  scene.live(3s);
  REQUIRE(change(scene, set("angle_limit_cw=50deg", true), kept, "apply").is_done());
  const auto changes = kept.to_undo();
  REQUIRE(changes.size() == 1);
  CHECK(changes[0].entry.held == state::Registers{{0x23, 0}, {0x38, 1799}});
}

TEST_CASE("a trial that a killed try has written over is not what ROM goes back to") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("angle_limit_cw=70deg"), kept).is_done());
  for (const char* angle : {"reverse=on", "angle_limit_cw=50deg"}) { // each killed before its SAVE
    REQUIRE(kept.history("apply").keep(plans_for(scene, set(angle, true), {11}), *scene.session));
    REQUIRE(carry_out(*scene.session, profiles(), plans_for(scene, set(angle), {11}), {})
                .servos[0]
                .is_done());
    scene.live(3s);
  }
  const auto changes = kept.to_undo();
  REQUIRE(changes.size() == 1);
  CHECK(changes[0].entry.held == state::Registers{{0x23, 0}, {0x38, 1799}});
}

TEST_CASE("a repetition in RAM only is a change beside what the first try has saved") {
  const Kept kept;
  const Scene scene(servos());
  killed(scene, set("angle_limit_cw=77deg", true), kept, "apply");
  scene.live(3s);
  REQUIRE(change(scene, set("reverse=on"), kept, "apply").is_done());
  const auto entries = kept.entries();
  REQUIRE(entries.size() == 2);
  CHECK(entries[0].held == state::Registers{{0x23, 0}});
  CHECK_FALSE(entries[0].saved);
  CHECK(entries[0].run != entries[1].run); // undo takes back this one
  CHECK(entries[1].saved);
  const Snapshot ram = scene.read(11, registers({"reverse"}));
  CHECK(kept.history().recorded_rom(ram, *scene.session).values == bla::Values{{at::reverse, 0}});
}

TEST_CASE("undo of an erase leaves the IDs that it kept") {
  const Kept kept;
  const Scene scene(servos(R"(, "servo_id": 5)"));
  REQUIRE(change(scene, restart, kept, "restart").is_done());
  scene.live(3s);
  REQUIRE(change(scene, set("servo_id=7"), kept).is_done());
  const Wanted erase{.erase = true, .keep_ids = true};
  REQUIRE(change(scene, erase, kept, std::string(erase_keeping_ids)).is_done());
  REQUIRE(change(scene, save, kept, "save").is_done());
  CHECK(kept.entries().front().held.at(0x45) == 7);
}

TEST_CASE("what was erased comes back") {
  const Kept kept;
  const Scene scene(servos(R"(, "servo_id": 5)"));
  REQUIRE(change(scene, set("torque_output=brake"), kept).is_done());
  REQUIRE(change(scene, {.erase = true}, kept, "erase").is_done());
  REQUIRE(read(scene, 11, "servo_id") == 0);
  const auto wanted = to_undo(kept.entries().front(), profiles());
  REQUIRE(wanted);
  REQUIRE(change(scene, *wanted, kept, "undo").is_done());
  CHECK(read(scene, 11, "servo_id") == 5);
  CHECK(read(scene, 11, "torque_output") == 2);
  CHECK(read(scene, 11, "static_node_id") == 11);
}

TEST_CASE("what a recorded restart has taken is not in RAM, however clocks drift") {
  const Kept kept;
  const Scene scene(servos());
  scene.live(3s);
  const Snapshot ram = scene.read(11, registers({"angle_limit_cw"}));
  const Member member = scene.member(11);
  const WallTime started = scene.session->wall() - (scene.session->now() - member.status_at) -
                           std::chrono::seconds(member.status->uptime_s);
  auto store = SnapshotStore::open(kept.folder(), Access::write);
  const SnapshotEntry trial{.at = started - 1h,
                            .command = "set",
                            .unique_id = *ram.servo.unique_id,
                            .held = {{0x38, 1799}},
                            .written = {{0x38, 900}},
                            .clock = clock_of(*scene.session)};
  const SnapshotEntry restart{.at = started + 1s, // the uptime runs fast
                              .command = "restart",
                              .unique_id = *ram.servo.unique_id,
                              .held = {{0x38, 900}},
                              .settled = started + 2s,
                              .clock = clock_of(*scene.session)};
  REQUIRE(store->keep(std::vector{trial, restart}, scene.session->wall()));
  CHECK(kept.history().unsaved(ram.servo, *scene.session, &ram).empty());
  CHECK(kept.history().known_rom(ram, *scene.session).empty());
}

TEST_CASE("a restart that was killed has taken nothing from a servo that runs on") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("angle_limit_cw=77deg"), kept).is_done());
  REQUIRE(kept.history("restart").keep(plans_for(scene, restart, {11}), *scene.session));
  const Snapshot ram = scene.read(11, registers({"angle_limit_cw"}));
  CHECK(kept.history().known_rom(ram, *scene.session) == bla::Values{{at::angle_limit_cw, 1799}});
}

TEST_CASE("what RAM shows of a change is not forgotten as clocks are set ahead") {
  const Kept kept;
  const Scene scene(servos());
  REQUIRE(change(scene, set("angle_limit_cw=90deg"), kept).is_done());
  SnapshotEntry trial = kept.entries().front();
  trial.at -= 1h;
  *trial.settled -= 1h;
  const bool is_known = GENERATE(true, false);
  trial.clock = is_known ? std::optional(*trial.clock - 1h) : std::nullopt;
  const auto keep = [&] {
    REQUIRE(SnapshotStore::open(kept.folder(), Access::write)
                ->keep(std::vector{trial}, scene.session->wall()));
  };
  keep();
  const Snapshot ram = scene.read(11, registers({"angle_limit_cw"}));
  CHECK(kept.history().known_rom(ram, *scene.session) == bla::Values{{at::angle_limit_cw, 1799}});
  REQUIRE(change(scene, restart, kept).is_done());
  keep();
  const Snapshot other = scene.read(11, registers({"angle_limit_cw"}));
  CHECK(kept.history().recorded_rom(other, *scene.session).values.empty());
}

TEST_CASE("what a killed change may have left in RAM is not forgotten as clocks drift") {
  const Kept kept;
  const Scene scene(servos());
  const Kept elsewhere;
  REQUIRE(change(scene, set("angle_limit_cw=90deg"), elsewhere).is_done());
  scene.live(6h);
  const Snapshot ram = scene.read(11, registers({"angle_limit_cw"}));
  const auto started = kept.history().start_of(ram.servo, *scene.session);
  REQUIRE(started);
  const auto unsaved = [&](Duration before_start) {
    auto store = SnapshotStore::open(kept.folder(), Access::write);
    REQUIRE(store->keep(std::vector{SnapshotEntry{.at = *started - before_start,
                                                  .command = "set",
                                                  .unique_id = *ram.servo.unique_id,
                                                  .held = {{0x38, 1799}},
                                                  .written = {{0x38, 900}},
                                                  .saved = true,
                                                  .clock = clock_of(*scene.session)}},
                        scene.session->wall()));
    return kept.history().recorded_rom(ram, *scene.session);
  };
  CHECK(unsaved(5s).values.empty());
  CHECK(unsaved(1s).values == bla::Values{{at::angle_limit_cw, 1799}}); // 50 ppm of six hours
  CHECK(unsaved(1s).perhaps_saved.contains(at::angle_limit_cw));
}

TEST_CASE("whether a change from before the start is in RAM, RAM itself tells") {
  const Kept kept;
  const Scene scene(servos());
  scene.live(3s);
  const Snapshot ram = scene.read(11, registers({"angle_limit_cw"})); // 1799
  const Member member = scene.member(11);
  const WallTime started = scene.session->wall() - (scene.session->now() - member.status_at) -
                           std::chrono::seconds(member.status->uptime_s);
  const auto is_unsaved = [&](Duration before_start, const state::Registers& held,
                              const state::Registers& written, const Snapshot* snapshot) {
    auto store = SnapshotStore::open(kept.folder(), Access::write);
    REQUIRE(store->keep(std::vector{SnapshotEntry{.at = started - before_start,
                                                  .command = "set",
                                                  .unique_id = *ram.servo.unique_id,
                                                  .held = held,
                                                  .written = written,
                                                  .clock = clock_of(*scene.session)}},
                        scene.session->wall()));
    return !kept.history().unsaved(ram.servo, *scene.session, snapshot).empty();
  };
  CHECK(is_unsaved(5s, {{0x38, 900}}, {{0x38, 1799}}, &ram));
  CHECK_FALSE(is_unsaved(1h, {{0x38, 900}}, {{0x38, 1799}}, &ram)); // ROM has brought it back
  CHECK_FALSE(is_unsaved(1h, {{0x38, 900}}, {{0x38, 450}}, &ram));  // another tool's, since
  CHECK_FALSE(is_unsaved(5s, {{0x38, 900}}, {{0x38, 450}}, &ram));
  CHECK_FALSE(is_unsaved(1h, {{0x38, 900}}, {{0x38, 1799}}, nullptr));
  CHECK(is_unsaved(5s, {{0x38, 900}}, {{0x38, 450}}, nullptr)); // perhaps written after the start
  CHECK(is_unsaved(5s, {{0x22, 1}}, {{0x22, 0}}, &ram));        // not read
  CHECK_FALSE(is_unsaved(1h, {{0x38, 900}}, {}, &ram));         // what a restart took
  CHECK(is_unsaved(-1s, {{0x38, 900}}, {{0x38, 450}}, &ram));   // another tool's, in this run
  CHECK_FALSE(is_unsaved(-1h, {{0x38, 900}}, {{0x38, 450}}, &ram)); // the clock was set back
}

TEST_CASE("an undo that broke off several times still means the change before it") {
  auto store = SnapshotStore::unshared().value();
  const dronecan::UniqueId unit{7};
  const auto keep = [&](std::string command, std::int64_t run, bool ended) {
    return store
        .keep(std::vector{SnapshotEntry{.run = run,
                                        .command = std::move(command),
                                        .unique_id = unit,
                                        .held = {{0x2C, 60}},
                                        .written = {{0x2C, 77}},
                                        .saved = true,
                                        .ended = ended}},
              WallTime{})
        .value()
        .front();
  };
  keep("set", 0, true);
  const std::int64_t first = keep("undo", 0, false);
  keep("undo", first, false);
  const auto meant = last_change(store, unit).value();
  REQUIRE(meant);
  CHECK(meant->entry.command == "set");
  CHECK(meant->goes_on);
}

TEST_CASE("undo of a run of several tries saves nothing that only RAM held") {
  auto store = SnapshotStore::unshared().value();
  const dronecan::UniqueId unit{7};
  const auto keep = [&](SnapshotEntry entry) {
    entry.command = "apply";
    entry.unique_id = unit;
    return store.keep(std::vector{std::move(entry)}, WallTime{}).value().front();
  };
  const bool has_saved = GENERATE(true, false); // else others have changed that since
  const std::int64_t first =
      keep({.held = has_saved ? state::Registers{{0x2C, 60}} : state::Registers{},
            .written = {{0x2C, 77}},
            .saved = true});
  keep({.run = first, .held = {{0x2D, 21}}, .written = {{0x2D, 30}}});
  keep({.run = first, .held = {{0x2E, 12}}}); // a restart took it
  const auto meant = last_change(store, unit).value();
  REQUIRE(meant);
  CHECK(meant->entry.saved == has_saved);
  CHECK(meant->entry.held == (has_saved ? state::Registers{{0x2C, 60}, {0x2D, 21}}
                                        : state::Registers{{0x2D, 21}, {0x2E, 12}}));
  CHECK(meant->numbers.size() == 3);
}

TEST_CASE("what others saved after a try that was done, while another servo was not, stays") {
  const Kept kept;
  const Scene scene(servos());
  const auto two = [&](const Wanted& wanted) { return plans_for(scene, wanted, {11, 12}); };
  const Wanted wanted{.assignments = assignments({"angle_limit_cw=90deg", "smoothing=off"}),
                      .restart = RestartKind::save};
  {
    History first = kept.history("apply");
    const CarriedOut done = carry_out(*scene.session, profiles(), two(wanted), {.history = &first});
    end(first, done.servos[0].servo.unique_id); // 12 has not come back
  }
  scene.live(3s);
  const bool is_saved = GENERATE(true, false), is_trial = GENERATE(false, true);
  if (is_saved) { // by somebody else, who may only try
    REQUIRE(carry_out(*scene.session, profiles(),
                      plans_for(scene, set("angle_limit_cw=70deg", !is_trial), {11}), {})
                .servos[0]
                .is_done());
    scene.live(3s);
  }
  History again = kept.history("apply");
  const auto plans = two(is_saved ? wanted : set("angle_limit_cw=80deg"));
  const CarriedOut done = carry_out(*scene.session, profiles(), plans, {.history = &again});
  if (is_saved) { // else something goes wrong after that
    end(again, done.servos[0].servo.unique_id);
    end(again, done.servos[1].servo.unique_id);
  }
  const auto of_first = last_change(SnapshotStore::open(kept.folder(), Access::read).value(),
                                    *done.servos[0].servo.unique_id)
                            .value();
  REQUIRE(of_first);
  const std::int64_t before = is_trial ? 1799 : 700; // the first try, or the repetition
  CHECK(of_first->entry.held ==
        (is_saved ? state::Registers{{0x22, 1}, {0x38, before}} : state::Registers{{0x38, 900}}));
  CHECK(of_first->entry.saved == is_saved);
}

TEST_CASE("what others saved after two tries is left out of both") {
  const Kept kept;
  const Scene scene(servos());
  const Snapshot ram = scene.read(11, registers({"angle_limit_cw"})); // 1799
  const bool is_saved = GENERATE(true, false); // else it broke off as it proved the first
  {
    auto store = SnapshotStore::open(kept.folder(), Access::write);
    const auto tried = [&](std::int64_t run, std::int64_t value, bool saved = true) {
      return store
          ->keep(std::vector{SnapshotEntry{.run = run,
                                           .at = scene.session->wall() - std::chrono::hours(1),
                                           .command = "apply",
                                           .unique_id = *ram.servo.unique_id,
                                           .held = {{0x38, 900}, {0x22, 1}},
                                           .written = saved ? state::Registers{{0x38, value}}
                                                            : state::Registers{},
                                           .saved = saved}},
                 scene.session->wall())
          .value()
          .front();
    };
    const std::int64_t run = tried(0, 450);
    tried(run, 460, is_saved);
  }
  const bool is_another_run = GENERATE(false, true); // of the other servo
  if (is_another_run) {
    killed(scene, set("angle_limit_cw=77deg", true), kept, "apply", {12});
    scene.live(3s);
  }
  REQUIRE(kept.history("apply").keep(plans_for(scene, set("smoothing=off", true), {12, 11}),
                                     *scene.session));
  const auto change =
      last_change(SnapshotStore::open(kept.folder(), Access::read).value(), *ram.servo.unique_id);
  REQUIRE(change.value());
  CHECK((*change)->numbers.size() == (is_another_run ? 1 : is_saved ? 3 : 2));
  for (const SnapshotEntry& entry : kept.entries()) {
    CHECK((entry.unique_id != *ram.servo.unique_id || !entry.held.contains(0x38)));
  }
  CHECK((*change)->entry.held.contains(0x22));
}

TEST_CASE("a file that was tampered with moves nothing") {
  for (const int address : {0x00, 0x02, 0x10, 0x12, 0x1F, 0x47, 0x49, 0x51, 0xFF}) {
    const auto refused = to_undo({.held = {{static_cast<std::uint8_t>(address), 1}}}, profiles());
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == Code::bad_file);
  }
  CHECK(to_undo({.held = {{0x3C, 999}}}, profiles()).error().code == Code::out_of_range);
  CHECK(to_undo({.held = {{0x46, 127}}}, profiles()).error().code == Code::out_of_range);
}

TEST_CASE("what a servo refused is no change that undo would look for") {
  const Wanted wanted =
      GENERATE(as<Wanted>{}, Wanted{.erase = true, .keep_ids = true},
               Wanted{.restart = RestartKind::restart}, Wanted{.restart = RestartKind::save});
  const Kept kept;
  const Scene scene(servos(R"(, "ram": {"angle_d_gain": 9}, "faults": {"refuse_opcodes": true})"));
  const ChangeResult result = change(scene, wanted, kept, "erase");
  REQUIRE(result.error);
  CHECK(result.error->code == Code::refused);
  CHECK_FALSE(result.may_have_changed);
  CHECK(kept.entries().empty());
}
