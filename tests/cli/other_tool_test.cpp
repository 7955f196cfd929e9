// Another tool on the bus that erases, saves and restarts servos while a command is at work.

#include "fleet.hpp"

#include <string>

using namespace blactl::test;

namespace {

/// Node 90 orders this of node 11, after so many milliseconds.
Scene with_order(const char* order, int at_ms) {
  return Scene()
      .servo("BLA21-12U-AB", 11, {{"servo_id", 1}})
      .servo("BLA21-12U-AB", 12, {{"servo_id", 2}, {"behaviour", {{"answer_delay", "40ms"}}}})
      .foreign(
          90, {{"orders", {{{"at", std::to_string(at_ms) + "ms"}, {"to", 11}, {"order", order}}}}});
}

} // namespace

TEST_CASE("a change in RAM is not done where another tool has undone it meanwhile") {
  const auto* order = GENERATE("erase", "initialize", "restart");
  int done = 0;
  for (int at = 1050; at < 1700; at += 50) {
    const Fleet fleet(with_order(order, at));
    const Result set = fleet.run({"set", "-n", "11,12", "angle_limit_cw=45deg", "-y", "--json"});
    INFO(order << " at " << at << " ms: " << set.out << set.err);
    const auto changes = json(set.out)["nodes"];
    const bool says_so =
        set.status == 0 || (!changes.empty() && changes[0]["changes"][0]["status"] == "written");
    done += set.status == 0 ? 1 : 0;
    if (says_so) {
      CHECK(fleet.ram("11", "angle_limit_cw") == 450);
    }
  }
  CHECK(done > 0);
}

TEST_CASE("nothing is saved over what another tool has erased") {
  const auto* order = GENERATE("erase", "initialize");
  for (int at = 1050; at < 1700; at += 50) {
    const Fleet fleet(with_order(order, at));
    const Result set =
        fleet.run({"set", "-n", "11,12", "angle_limit_cw=45deg", "--save", "-y", "--json"});
    INFO(order << " at " << at << " ms: " << set.out << set.err);
    CHECK(fleet.rom("11", "static_node_id") == 11); // the factory's is 0
    if (set.status == 0) {
      CHECK(fleet.ram("11", "angle_limit_cw") == 450);
    }
  }
}

TEST_CASE("torque that was off for a moment and saved by another tool is no success") {
  for (int at = 1500; at < 4000; at += 500) {
    const Fleet fleet(with_order("save", at));
    const Result run =
        fleet.run({"monitor", "--identify", "-n", "11", "-y", "--duration", "2", "--json"});
    INFO(at << " ms: " << run.out << run.err);
    if (run.status == 0) {
      CHECK(fleet.rom("11", "torque_output") == 0);
    } else {
      CHECK(contains(run.err, "blactl set torque_output=on -n 11 --save"));
    }
  }
}

TEST_CASE("characterize says that another tool has saved what it measured with") {
  for (int at = 3000; at < 15000; at += 1500) {
    const Fleet fleet(with_order("save", at));
    const Result run = fleet.run({"characterize", "-n", "11", "-y"});
    INFO(at << " ms: " << run.err);
    if (run.status == 0) {
      CHECK(fleet.rom("11", "angle_limit_cw") == 1799);
      CHECK(fleet.ram("11", "torque_output") == 0);
    } else {
      CHECK_FALSE(contains(run.err, "look at its supply"));
    }
  }
}
