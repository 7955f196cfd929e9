// Restarts that come between two requests.

#include "unit/sim/servo_rig.hpp"

#include <set>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using dronecan::ExecuteOpcode;
using testing::bla21;
using testing::frame;
using testing::Frames;
using testing::Rig;
using testing::uptimes;

namespace {

std::string with(const std::string& members) {
  return std::string(bla21) + ", " + members;
}

std::string restarting(const char* list) {
  return with(fmt::format(R"("faults": {{"restart_after_answer": {}}})", list));
}

/// Asks five things of different kinds, each after time enough for a restart; which were followed
/// by one, counted from 1.
std::set<int> restarted_after(const char* list) {
  Rig rig(restarting(list));
  std::set<int> out;
  int asked = 0;
  const auto note = [&] {
    ++asked;
    rig.settle();
    if (!rig.events.empty()) {
      out.insert(asked);
    }
    rig.events.clear();
  };
  CHECK(rig.read("0x38") == 1799);
  note();
  CHECK(rig.write("0x38", 900) == 900);
  note();
  CHECK_FALSE(rig.bench.ask({frame("1E018BFF#C0")}).empty()); // GetNodeInfo
  note();
  CHECK(rig.read("0x45") == 1);
  note();
  CHECK(rig.restart_node(0) == "refused");
  note();
  CHECK(rig.opcode(7) == "refused");
  note();
  return out;
}

} // namespace

TEST_CASE("faults: a servo can restart after the answer to any request, or to one of a kind") {
  CHECK(restarted_after("[]").empty());
  for (int number = 1; number <= 6; ++number) {
    CHECK(restarted_after(fmt::format(R"([{{"to": "any", "number": {}}}])", number).c_str()) ==
          std::set{number});
  }
  CHECK(restarted_after("[{}]") == std::set{1});
  CHECK(restarted_after(R"([{"to": "read", "number": 2}])") == std::set{4});
  CHECK(restarted_after(R"([{"to": "write"}])") == std::set{2});
  CHECK(restarted_after(R"([{"to": "node_info"}])") == std::set{3});
  CHECK(restarted_after(R"([{"to": "restart"}])") == std::set{5});
  CHECK(restarted_after(R"([{"to": "opcode"}])") == std::set{6});
  CHECK(restarted_after(R"([{"to": "read", "number": 3}])").empty());
  CHECK(restarted_after(R"([{"to": "read"}, {"to": "any", "number": 2}])") == std::set{1, 2});
}

TEST_CASE("faults: the answer leaves before the restart, then RAM is what ROM holds") {
  Rig rig(R"("model": "BLA21-12U-AB", "node_id": 11, "answer_delay": "5ms",
             "faults": {"restart_after_answer": [{"to": "write"}]})");
  const auto write = testing::request(
      dronecan::GetSet::type, dronecan::GetSet::Request{0, std::int64_t{900}, "0x38"}, 11, 1);
  CHECK(rig.bench.ask(write, 4ms).empty());
  CHECK(rig.events.empty());
  CHECK(rig.bench.ask({}, 1ms).size() == 3);
  CHECK(rig.told() == Frames{"restart 11"});
  CHECK(uptimes(rig.bench.run(300ms)).front().first == 0);
  rig.servo.look(rig.bench.now());
  CHECK(rig.ram(bla::address::angle_limit_cw) == 1799);
}

TEST_CASE("faults: what the request ordered does not happen any more, be the answer lost or not") {
  for (const char* more : {"", R"(, "lose_responses": 1)", R"(, "stays": true)"}) {
    Rig rig(
        with(fmt::format(R"("faults": {{"restart_after_answer": [{{"to": "opcode"}}]{}}})", more)));
    CHECK(rig.write("0x38", 900).has_value() == !std::string_view(more).contains("lose"));
    (void)rig.opcode(ExecuteOpcode::save);
    rig.settle();
    CHECK(rig.told() == Frames{"restart 11"});
    CHECK(rig.servo.rom_writes() == 0);
    CHECK(rig.read("0x38") == 1799);
  }
}
