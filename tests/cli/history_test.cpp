// What commands leave for `undo` and `apply`, in the state folder.

#include "blactl/state/proof_store.hpp"
#include "blactl/state/snapshot_store.hpp"

#include "catch.hpp"
#include "run.hpp"
#include "scene.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

using namespace blactl::test;
using blactl::state::Access;
using blactl::state::ProofStore;
using blactl::state::SnapshotEntry;
using blactl::state::SnapshotStore;

namespace {

/// Where a bench keeps what is known of the servos of a simulator.
std::filesystem::path simulated(const Bench& bench) {
  return bench.folder() / "state/blactl/simulated";
}

std::vector<SnapshotEntry> entries_in(const std::filesystem::path& folder) {
  const auto store = SnapshotStore::open(folder.string(), Access::read);
  INFO((store ? "" : store.error().message));
  REQUIRE(store);
  return store->entries().value();
}

bool is_proven(const std::filesystem::path& folder, const SnapshotEntry& entry) {
  return ProofStore::open(folder.string(), Access::read)->find(entry.unique_id)->has_value();
}

/// One command on a simulator with one servo.
Result run(const Bench& bench, const Arguments& more, const Options& options = {}) {
  const nlohmann::json servo{{"model", "BLA21-12U-AB"}, {"node_id", 11}, {"servo_id", 4}};
  const nlohmann::json scenario{
      {"schema", "blactl-scenario/1"}, {"clock", "virtual"}, {"servos", {servo}}};
  const Background sim(bench, {"sim", bench.file("s.json", scenario.dump())}, options);
  Arguments arguments{"-i", "sim:", "-y", "-n", "11"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return bench.run(arguments, options);
}

} // namespace

TEST_CASE("every command that changes a servo records what it replaces, and whether it saved") {
  struct Case {
    Arguments arguments;
    std::string command;
    blactl::state::Registers held;
    bool saved;
  };

  const auto [arguments, command, held, saved] =
      GENERATE(Case{{"set", "angle_limit_cw=90deg"}, "set", {{0x38, 1799}}, false},
               Case{{"set", "angle_limit_cw=90deg", "--save"}, "set", {{0x38, 1799}}, true},
               Case{{"pwm-config", "--neutral", "1500us"}, "pwm-config", {{0x34, 1520}}, false},
               Case{{"alloc", "--static", "--id", "30"}, "alloc --static", {{0x46, 11}}, true});
  const Bench bench;
  const Result result = run(bench, arguments);
  INFO(result.out << result.err);
  REQUIRE(result.status == 0);
  const auto entries = entries_in(simulated(bench));
  REQUIRE(entries.size() == 1);
  CHECK(entries[0].command == command);
  CHECK(entries[0].held == held);
  CHECK(entries[0].saved == saved);
  CHECK(is_proven(simulated(bench), entries[0]) == saved);
}

TEST_CASE("erase records the whole configuration; save and restart record no change") {
  const Bench bench;
  const bool saves = GENERATE(false, true);
  const Result erased = run(bench, saves ? Arguments{"erase", "--save"} : Arguments{"erase"});
  INFO(erased.err);
  REQUIRE(erased.status == 0);
  REQUIRE(run(bench, {"restart"}).status == 0);
  const auto entries = entries_in(simulated(bench));
  REQUIRE(entries.size() == 1);
  CHECK(entries[0].command == "erase");
  CHECK(entries[0].held.size() == 34);
  CHECK(entries[0].held.at(0x45) == 4);
  CHECK(entries[0].saved == saves);
  CHECK_FALSE(is_proven(simulated(bench), entries[0])); // it has restarted since
  REQUIRE(run(bench, {"save"}).status == 0);
  CHECK(entries_in(simulated(bench)).size() == 1);
  CHECK(is_proven(simulated(bench), entries[0]));
}

TEST_CASE("what changes nothing is not recorded, and makes no file") {
  const Bench bench;
  CHECK(run(bench, {"set", "angle_limit_cw=90deg", "--dry-run"}).status == 8);
  CHECK(run(bench, {"set", "torque_limit_cw=999%"}).status == 2);
  CHECK(bench.run({"-i", "replay:/dev/null", "set", "reverse=on"}).status != 0);
  CHECK(run(bench, {"set", "reverse=on", "--listen-only"}).status == 2);
  CHECK_FALSE(std::filesystem::exists(simulated(bench)));
  CHECK_FALSE(std::filesystem::exists(bench.folder() / "state/blactl/snapshots.db"));
  CHECK(run(bench, {"set", "servo_id=4"}).status == 0);
  CHECK(entries_in(simulated(bench)).empty());
}

TEST_CASE("a private simulation leaves nothing behind") {
  const Bench bench;
  REQUIRE(three_servos().run(bench, {"-n", "11", "set", "angle_limit_cw=90deg"}).status == 0);
  CHECK_FALSE(std::filesystem::exists(bench.folder() / "state/blactl"));
}

TEST_CASE("BLACTL_STATE_DIR says where changes are recorded") {
  const Bench bench;
  const std::filesystem::path folder = bench.folder() / "elsewhere";
  const Options options{.env = {{"BLACTL_STATE_DIR", folder.string()}}};
  REQUIRE(run(bench, {"set", "angle_limit_cw=90deg"}, options).status == 0);
  CHECK(entries_in(folder / "simulated").size() == 1);
  CHECK_FALSE(std::filesystem::exists(bench.folder() / "state/blactl"));
}

TEST_CASE("a state folder that cannot be used is said once, and stops no change") {
  const Bench bench;
  const std::string place = bench.file("no_folder", "a file");
  const auto [name, said] = GENERATE(std::pair("en", "this change is not recorded"),
                                     std::pair("ja", "変更履歴に記録されない"));
  const Result result = run(bench, {"set", "angle_limit_cw=90deg", "--save", "--lang", name},
                            {.env = {{"BLACTL_STATE_DIR", place}}});
  INFO(result.out << result.err);
  CHECK(result.status == 0);
  const auto first = result.err.find(said);
  CHECK(first != std::string::npos);
  CHECK(result.err.find(said, first + 1) == std::string::npos);
  CHECK(contains(result.err, place));
}

TEST_CASE("a history that is damaged stays as it is, and stops no change") {
  const Bench bench;
  std::filesystem::create_directories(simulated(bench));
  std::ofstream(simulated(bench) / "snapshots.db") << "no database";
  const Result result = run(bench, {"set", "angle_limit_cw=90deg"});
  CHECK(result.status == 0);
  CHECK(contains(result.err, "not a blactl change history"));
  std::ifstream file(simulated(bench) / "snapshots.db");
  std::string content;
  std::getline(file, content);
  CHECK(content == "no database");
}
