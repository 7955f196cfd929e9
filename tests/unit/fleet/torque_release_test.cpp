// Servos that are let go get back what they held, or it is said why not.

#include "blactl/fleet/torque_release.hpp"

#include "support.hpp"

#include <signal.h>

#include <string>
#include <string_view>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

/// Three servos: 11 holds its angle, 12 brakes, 13 is off.
std::string three(std::string_view more = "") {
  return fmt::format(
      R"("servos": [{{"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 1,
                      "servo_id": 1}},
                    {{"model": "BLA21-12U-AB", "node_id": 12, "serial_number": 2, "servo_id": 2,
                      "ram": {{"torque_output": "brake"}}}},
                    {{"model": "BLA21-12U-AB", "node_id": 13, "serial_number": 3,
                      "ram": {{"torque_output": "off"}}}}]{})",
      more);
}

/// A scene in which all three are let go.
struct Loose {
  explicit Loose(std::string_view more = "") : scene(three(more)) {
    scene.live(3s);
    const auto plans = plans_for(scene, wanted_to_let_go(profiles()), {11, 12, 13});
    CHECK(question(plans).find("node 11: torque_output") != std::string::npos);
    CHECK(question(plans).find("node 13") == std::string::npos);
    const auto carried_out = release.let_go(plans, {});
    for (const ChangeResult& result : carried_out.servos) {
      CHECK(result.is_done());
    }
    CHECK(outputs() == std::vector<std::int64_t>{1, 1, 1});
  }

  [[nodiscard]] std::int64_t output(std::uint8_t id) const {
    return scene.read(id, registers({"torque_output"}))
        .raw(bla::address::torque_output)
        .value_or(-1);
  }

  [[nodiscard]] std::vector<std::int64_t> outputs() const {
    return {output(11), output(12), output(13)};
  }

  Scene scene;
  TorqueRelease release{*scene.session, profiles(), {}};
};

std::vector<Code> codes(const GivenBack& given) {
  std::vector<Code> all;
  for (const Error& error : given.errors) {
    all.push_back(error.code);
  }
  return all;
}

} // namespace

TEST_CASE("each servo gets back what it held, and who was off is not touched") {
  Loose loose;
  CHECK(loose.release.servos() == std::vector{NodeId(11), NodeId(12)});
  const std::size_t writes = loose.scene.requests(GetSet::type, 13);
  const auto given = loose.release.give_back(false, nullptr);
  CHECK(given.errors.empty());
  CHECK(given.notes.empty());
  CHECK(given.servos.size() == 2);
  CHECK(loose.release.servos().empty());
  CHECK(loose.scene.requests(GetSet::type, 13) == writes);
  CHECK(loose.outputs() == std::vector<std::int64_t>{0, 2, 1});
}

TEST_CASE("a servo that restarted is left to its ROM") {
  Loose loose(R"(, "events": [{"at": "6s", "servo": 1, "happens": "power_off"},
                              {"at": "7s", "servo": 1, "happens": "power_on"}])");
  loose.scene.live(8s);
  const auto given = loose.release.give_back(false, nullptr);
  CHECK(given.errors.empty());
  REQUIRE(given.notes.size() == 1);
  CHECK(given.notes[0].find("node 11 restarted") == 0);
  CHECK(loose.outputs() == std::vector<std::int64_t>{0, 2, 1});
}

TEST_CASE("what somebody else has set meanwhile stays") {
  const std::int64_t there = GENERATE(0, 2);
  Loose loose;
  const auto plans =
      plans_for(loose.scene, {.assignments = assignments({fmt::format("torque_output={}", there)})},
                {11, 12});
  REQUIRE_FALSE(carry_out(*loose.scene.session, profiles(), plans, {}).broken);
  const auto given = loose.release.give_back(false, nullptr);
  CHECK(given.errors.empty());
  REQUIRE(given.notes.size() == 1);
  CHECK(given.notes[0].find(there == 0 ? "node 12: another" : "node 11: another") == 0);
  CHECK(loose.outputs() == std::vector<std::int64_t>{there, there, 1});
}

TEST_CASE("of a servo that does not answer it is said what to type") {
  Loose loose(R"(, "events": [{"at": "6s", "servo": 2, "happens": "power_off"}])");
  loose.scene.live(8s);
  const auto given = loose.release.give_back(false, nullptr);
  REQUIRE(codes(given) == std::vector{Code::timeout});
  CHECK(given.errors[0].hint == "to put it back: blactl set torque_output=brake -n 12");
  CHECK(given.errors[0].node_id == 12);
  CHECK(loose.output(11) == 0);
}

TEST_CASE("on a bus that is armed nothing is written, and on one that is driven only if told to") {
  Loose armed(R"(, "foreign": [{"kind": "node", "node_id": 30, "armed": true}])");
  CHECK(codes(armed.release.give_back(true, nullptr)) == std::vector{Code::armed, Code::armed});
  CHECK(armed.outputs() == std::vector<std::int64_t>{1, 1, 1});
  Loose driven(R"(, "foreign": [{"kind": "node", "node_id": 30,
                    "commands": {"servo_ids": [1, 2], "type": 1, "value": 0, "rate": 10}}])");
  CHECK(codes(driven.release.give_back(false, nullptr)) == std::vector{Code::driven, Code::driven});
  CHECK(driven.outputs() == std::vector<std::int64_t>{1, 1, 1});
  CHECK(driven.release.give_back(true, nullptr).errors.empty());
  CHECK(driven.outputs() == std::vector<std::int64_t>{0, 2, 1});
}

TEST_CASE("a first signal does not keep torque from coming back, a second one does") {
  Loose before;
  before.scene.session->set_grace(10s);
  REQUIRE(raise(SIGINT) == 0);
  CHECK_FALSE(before.scene.session->live_until(never));
  CHECK(before.release.give_back(false, nullptr).servos.size() == 2);

  Loose meanwhile;
  meanwhile.scene.session->set_grace(10s);
  REQUIRE(raise(SIGINT) == 0);
  CHECK(meanwhile.release.give_back(false, nullptr).servos.size() == 2);

  Loose twice;
  twice.scene.session->set_grace(10s);
  REQUIRE(raise(SIGINT) == 0);
  CHECK_FALSE(twice.scene.session->live_until(never));
  REQUIRE(raise(SIGTERM) == 0);
  const auto given = twice.release.give_back(false, nullptr);
  CHECK(codes(given) == std::vector{Code::state, Code::state});
  CHECK(given.errors[0].hint == "to put it back: blactl set torque_output=on -n 11");
}
