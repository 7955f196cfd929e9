// Another tool on the bus that erases, saves and restarts servos while a command is at work.

#include "fleet.hpp"

#include <string>

using namespace blactl::test;

namespace {

/// Node 90 writes soft_start=off to node 11, ten times a second from power-on on; at some moment
/// another value.
Scene with_writer(int differs_at_ms = -1) {
  nlohmann::json orders = nlohmann::json::array();
  for (int at = 0; at < 20000; at += 100) {
    orders.push_back({{"at", std::to_string(at) + "ms"},
                      {"to", 11},
                      {"order", "write"},
                      {"address", 0x21},
                      {"value", at == differs_at_ms ? 1 : 0}});
  }
  return Scene()
      .servo("BLA21-12U-AB", 11, {{"servo_id", 1}, {"ram", {{"soft_start", "off"}}}})
      .servo("BLA21-12U-AB", 12, {{"servo_id", 2}, {"behaviour", {{"answer_delay", "40ms"}}}})
      .foreign(90, {{"orders", orders}});
}

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
  for (int at = 1050; at < 1700; at += 90) {
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
  for (int at = 1050; at < 1700; at += 90) {
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

TEST_CASE("a servo that was done in the first step is looked at again in the end") {
  // 12 holds the file in RAM only: its proving restart shows that, and a second step saves it.
  int told = 0;
  for (int at = 4500; at < 10500; at += 500) {
    const Fleet fleet(with_order("erase", at));
    REQUIRE(fleet.run({"set", "-n", "12", "angle_p_gain=30", "-y"}).status == 0);
    const Result apply = fleet.apply(
        {{"schema", "blactl-fleet/1"},
         {"servos",
          {{{"name", "a"}, {"match", {{"servo_id", 1}}}, {"set", {{"smoothing", "off"}}}},
           {{"name", "b"}, {"match", {{"servo_id", 2}}}, {"set", {{"angle_p_gain", 30}}}}}}});
    INFO(at << " ms: " << apply.out << apply.err);
    told += contains(apply.err, "node 90 wrote to node 11 meanwhile") ? 1 : 0;
    if (apply.status == 0) {
      CHECK(fleet.ram("11", "smoothing") == 0);
    }
  }
  CHECK(told > 0);
}

TEST_CASE("apply --no-save looks again at a servo that held the file already") {
  int told = 0;
  for (int at = 1100; at < 1170; at += 10) {
    const Fleet fleet(Scene()
                          .servo("BLA21-12U-AB", 11,
                                 {{"servo_id", 1}, {"serial_number", 1}, {"ram", {{"0x22", 0}}}})
                          .servo("BLA21-12U-AB", 12, {{"servo_id", 2}, {"serial_number", 2}})
                          .event(1, "clock_error", std::to_string(at) + "ms"));
    const Result apply = fleet.apply(
        {{"schema", "blactl-fleet/1"},
         {"servos",
          {{{"name", "a"}, {"match", {{"serial_number", 1}}}, {"set", {{"smoothing", "off"}}}},
           {{"name", "b"}, {"match", {{"serial_number", 2}}}, {"set", {{"smoothing", "off"}}}}}}},
        {"--no-save"});
    INFO(at << " ms: " << apply.err);
    told += contains(apply.err, "node 11 has restarted since") ? 1 : 0;
    if (apply.status == 0) {
      CHECK(fleet.ram("11", "smoothing") == 0);
    }
  }
  CHECK(told > 0);
}

TEST_CASE("what another tool has saved meanwhile is not in RAM only, and undo puts ROM back") {
  int told = 0;
  for (int at = 1650; at < 2600; at += 90) {
    const Fleet fleet(with_order("save", at));
    const Result set = fleet.run({"set", "-n", "11,12", "smoothing=off", "-y"});
    INFO(at << " ms: " << set.out << set.err);
    if (contains(set.err, "node 90 ordered SAVE of node 11 meanwhile")) {
      ++told;
      CHECK(fleet.run({"undo", "-n", "11", "-y"}).status == 0);
      CHECK(fleet.rom("11", "smoothing") == 1);
    }
  }
  CHECK(told > 0);
}

TEST_CASE("characterize makes nothing permanent that another tool has erased or written") {
  for (int at = 3000; at < 12000; at += 1300) {
    const Fleet fleet(with_order("erase", at));
    const Result run = fleet.run({"characterize", "-n", "11", "-y"});
    INFO(at << " ms: " << run.err);
    CHECK(fleet.rom("11", "static_node_id") == 11); // the factory's is 0
  }
}

TEST_CASE("after another tool's SAVE undo puts back what characterize measured with") {
  int saved = 0;
  for (int at = 3000; at < 12000; at += 1300) {
    const Fleet fleet(with_order("save", at));
    if (contains(fleet.run({"characterize", "-n", "11", "-y"}).err, "blactl undo -n 11")) {
      ++saved;
      CHECK(fleet.run({"undo", "-n", "11", "-y"}).status == 0);
      CHECK(fleet.rom("11", "angle_limit_cw") == 1799);
      CHECK(fleet.ram("11", "torque_output") == 0);
    }
  }
  CHECK(saved > 0);
}

TEST_CASE("what another tool writes again and again changes nothing, and is in nobody's way") {
  const Fleet fleet(with_writer());
  const Arguments arguments = GENERATE(
      Arguments{"get", "-n", "all", "--all"}, Arguments{"export", "-n", "all"},
      Arguments{"faults", "-n", "all"}, Arguments{"set", "-n", "all", "angle_limit_cw=45deg", "-y"},
      Arguments{"set", "-n", "all", "soft_start=off", "-y"});
  const Result run = fleet.run(arguments);
  INFO(arguments.front() << ": " << run.out << run.err);
  CHECK(run.status == 0);
}

TEST_CASE("one other value among those that another tool repeats is a change") {
  int told = 0;
  for (int at = 900; at < 2600; at += 200) {
    const Fleet fleet(with_writer(at));
    const Result set = fleet.run({"set", "-n", "all", "soft_start=off", "-y"});
    INFO(at << " ms: " << set.out << set.err);
    told += contains(set.err, "node 90") ? 1 : 0;
  }
  CHECK(told > 0);
}

TEST_CASE("what another tool repeats undoes a change of the same register") {
  const Fleet fleet(with_writer());
  const Result set = fleet.run({"set", "-n", "all", "soft_start=on", "-y"});
  INFO(set.out << set.err);
  CHECK(set.status != 0);
  CHECK(contains(set.err, "node 90"));
}

TEST_CASE("one write of another tool while the servo is read does not keep it from being saved") {
  for (int at = 900; at < 2600; at += 200) {
    const Fleet fleet(Scene()
                          .servo("BLA21-12U-AB", 11, {{"servo_id", 1}})
                          .foreign(90, {{"orders",
                                         {{{"at", std::to_string(at) + "ms"},
                                           {"to", 11},
                                           {"order", "write"},
                                           {"address", 0x22},
                                           {"value", 1}}}}}));
    const Result set = fleet.run({"set", "-n", "11", "reverse=on", "--save", "-y"});
    INFO(at << " ms: " << set.out << set.err);
    CHECK_FALSE(contains(set.err, "restarts again and again"));
    if (set.status == 0) {
      CHECK(fleet.rom("11", "reverse") == 1);
    } else { // a restart takes its time: it wrote before ROM could be proven
      CHECK(contains(set.err, "node 90"));
    }
  }
}

TEST_CASE(
    "what another node writes to a servo that is proven, while others are waited for, is told") {
  const Fleet fleet(
      Scene()
          .servo("BLA21-12U-AB", 11, {{"serial_number", 1}, {"faults", {{"never_returns", true}}}})
          .servo("BLA21-12U-AB", 12, {{"serial_number", 2}})
          .foreign(90, {{"orders",
                         {{{"at", "4s"},
                           {"to", 12},
                           {"order", "write"},
                           {"address", 0x22},
                           {"value", 0}}}}}));
  const Document file{
      {"schema", "blactl-fleet/1"},
      {"servos",
       {{{"name", "a"}, {"match", {{"serial_number", 1}}}, {"set", {{"reverse", "on"}}}},
        {{"name", "b"}, {"match", {{"serial_number", 2}}}, {"set", {{"smoothing", "on"}}}}}}};
  const Result applied = fleet.apply(file, {"--json"});
  INFO(applied.out << applied.err);
  const auto proven = json(applied.out)["nodes"][1];
  CHECK(proven["status"] == "failed");
  CHECK(proven["changes"][0]["after"].is_null());
  CHECK(contains(applied.err, "node 90"));
}
