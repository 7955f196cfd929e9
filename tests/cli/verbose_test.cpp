// What -v tells on stderr, and nothing else does.

#include "catch.hpp"
#include "scene.hpp"
#include "unit/can/slcan_adapter.hpp"

#include <algorithm>
#include <string>

using namespace blactl::test;
using blactl::can::test::SlcanAdapter;

namespace can = blactl::can;

namespace {

/// stderr lines without -v, with it, and with -q beside it; stdout must be the same with all.
Result verbose(const Bench& bench, Arguments arguments, const Options& options = {}) {
  arguments.emplace_back("-j");
  Result plain = bench.run(arguments, options);
  arguments.emplace_back("-v");
  Result told = bench.run(arguments, options);
  CHECK(told.status == plain.status);
  CHECK(told.out == plain.out);
  CHECK(std::ranges::count(told.err, '\n') > std::ranges::count(plain.err, '\n'));
  CHECK(is_fit_for_a_terminal(told.err));
  arguments.emplace_back("-q");
  CHECK(codes(bench.run(arguments, options)) == codes(plain));
  CHECK_FALSE(contains(bench.run(arguments, options).err, "blactl: own node ID"));
  return told;
}

} // namespace

TEST_CASE("-v says which node ID of our own, why, and which lock files were taken") {
  const Bench bench;
  const Background sim(bench, {"sim", "--clock", "virtual"});
  const Result first = verbose(bench, {"-i", "sim:", "get", "-n", "11", "servo_id"});
  CHECK(contains(first.err, "blactl: own node ID 127: it was free\n"));
  CHECK(contains(first.err, "blactl: lock file: " + (bench.folder() / "run").string()));
  const Result set = bench.run({"-i", "sim:", "-v", "set", "-n", "11", "servo_id=1"});
  CHECK(contains(set.err, ".write\n"));
  const Result wanted =
      verbose(bench, {"-i", "sim:", "get", "-n", "11", "servo_id", "--local-node-id", "50"});
  CHECK(contains(wanted.err, "blactl: own node ID 50: as --local-node-id says\n"));
  const Result japanese =
      bench.run({"-i", "sim:", "get", "-n", "11", "servo_id", "-v", "--lang", "ja"});
  CHECK(contains(japanese.err, "自ノード ID 127: 空いていました"));
}

TEST_CASE("a second process is noted to have 126, and why") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  const Background first(bench, {"-i", "sim:", "-v", "scan", "--listen", "15"}, {}, "lock file");
  const Result second = bench.run({"-i", "sim:", "get", "-n", "11", "servo_id"});
  CHECK(second.status == 0);
  CHECK(contains(second.err, "blactl: own node ID 126: 127 is held by process " +
                                 std::to_string(first.pid()) + "\n"));
}

TEST_CASE("-v says which answers were lost and which requests are repeated") {
  const Scene scene = Scene().servo("BLA21-12U-AB", 11);
  const Bench bench;
  const Result absent = verbose(
      bench, {"-i", "sim:" + scene.write(bench), "get", "-n", "55", "servo_id", "--retries", "1"});
  CHECK(absent.status == 4);
  CHECK(contains(absent.err, "blactl: own node ID 127: no other process reaches this bus\n"));
  CHECK(contains(absent.err,
                 "blactl: node 55: no answer to GetNodeInfo within 0.5 s: asked again (2 of 2)\n"));
  CHECK(contains(absent.err, "blactl: node 55: no answer to GetNodeInfo within 0.5 s, tries: 2\n"));
}

TEST_CASE("-v says that SAVE was lost and sent once more") {
  const Scene scene = Scene().servo("BLA21-12U-AB", 11, {{"faults", {{"ignore_opcodes", 1}}}});
  const Bench bench;
  const Result saved =
      bench.run({"-i", "sim:" + scene.write(bench), "save", "-n", "11", "-y", "-v"});
  INFO(saved.err);
  CHECK(saved.status == 0);
  CHECK(contains(saved.err, "node 11: no answer to ExecuteOpcode SAVE within"));
  CHECK(contains(saved.err, "node 11: ExecuteOpcode SAVE was not carried out: sent once more\n"));
}

TEST_CASE("-v says what came from the environment") {
  const Bench bench;
  const std::string scene = "sim:" + three_servos().write(bench);
  const Options options{
      .env = {{"BLACTL_INTERFACE", scene}, {"BLACTL_PROFILE_DIR", BLACTL_PROFILES}}};
  const Result told = verbose(bench, {"get", "-n", "11", "servo_id"}, options);
  CHECK(contains(told.err, "blactl: --interface " + scene + ": from BLACTL_INTERFACE\n"));
  CHECK(contains(told.err, "blactl: --profile-dir " BLACTL_PROFILES ": from BLACTL_PROFILE_DIR\n"));
}

TEST_CASE("-v says what was sent to an adapter and what it answered, escaped") {
  const Bench bench;
  const SlcanAdapter adapter(can::test::lawicel());
  const Result told = bench.run({"-i", "slcan:" + adapter.path(), "scan", "-v", "--listen", "0.1"});
  INFO(told.err);
  CHECK(contains(told.err, "blactl: to the adapter: C\\x0d\n"));
  CHECK(contains(told.err, "blactl: from the adapter: \\x07\n"));
  CHECK(contains(told.err, "blactl: to the adapter: S8\\x0d\n"));
  CHECK_FALSE(contains(told.err, "no answer to GetNodeInfo")); // a search is no lost answer
  CHECK(is_fit_for_a_terminal(told.err));
  const SlcanAdapter noisy(can::test::noisy());
  const Result flood = bench.run({"-i", "slcan:" + noisy.path(), "scan", "-v", "--listen", "0.1"});
  CHECK(contains(flood.err, " bytes)\n"));
}
