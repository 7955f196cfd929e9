// Servos that are let go get back what they held, or it is said why not.

#include "blactl/fleet/change/loan.hpp"

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
  explicit Loose(std::string_view more = "", Change::Options options = {})
      : scene(three(more)), loan(*scene.session, profiles(), torque_off(profiles()), options) {
    scene.live(3s);
    REQUIRE(loan.prepare(std::vector{NodeId(11), NodeId(12), NodeId(13)}).empty());
    CHECK(loan.look_again().empty());
    CHECK(loan.change().question().find("node 11: torque_output") != std::string::npos);
    CHECK(loan.change().question().find("node 13") == std::string::npos);
    CHECK(loan.take().empty());
    for (const GoalResult& result : loan.change().results()) {
      CHECK(result.is_done);
    }
    CHECK(outputs() == std::vector<std::int64_t>{1, 1, 1});
    CHECK(loan.taken() == std::vector{NodeId(11), NodeId(12)});
  }

  /// Node 40 sets 0x20 of this servo, heard or not.
  void set_by_another(std::uint8_t id, std::int64_t output, bool is_heard) {
    const auto plans = plans_for(
        scene, {.assignments = assignments({fmt::format("torque_output={}", output)})}, {id});
    REQUIRE_FALSE(carry_out(*scene.session, profiles(), plans, {}).broken);
    if (is_heard) {
      hear_write(id, output);
    }
  }

  void hear_write(std::uint8_t id, std::int64_t output) const {
    GetSet::Request request{.name = "0x20"};
    request.value = output;
    scene.roster().receive({.header = {.kind = dronecan::Kind::request,
                                       .data_type_id = GetSet::type.id,
                                       .source = NodeId(40),
                                       .destination = NodeId(id)},
                            .payload = request.encode().bytes(),
                            .at = scene.session->now()});
  }

  /// Node 30 says something to all.
  void hear_message(dronecan::DataType type, std::vector<std::uint8_t> payload) const {
    scene.roster().receive(
        {.header = {.kind = dronecan::Kind::message, .data_type_id = type.id, .source = NodeId(30)},
         .payload = payload,
         .at = scene.session->now()});
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
  Loan loan;
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
  CHECK(loose.loan.servos() == std::vector{NodeId(11), NodeId(12)});
  const std::size_t asked = loose.scene.requests(GetSet::type, 13);
  const auto given = loose.loan.give_back();
  CHECK(given.errors.empty());
  CHECK(given.notes.empty());
  CHECK(given.servos.size() == 2);
  CHECK(loose.loan.servos().empty());
  CHECK(loose.scene.requests(GetSet::type, 13) == asked + 1); // a read
  CHECK(loose.outputs() == std::vector<std::int64_t>{0, 2, 1});
}

/// This servo has no power for a second.
std::string restarts(int serial_number) {
  return fmt::format(R"(, "events": [{{"at": "6s", "servo": {0}, "happens": "power_off"}},
                                     {{"at": "7s", "servo": {0}, "happens": "power_on"}}])",
                     serial_number);
}

TEST_CASE("a servo that restarted is left to its ROM, and that is an error if it differs") {
  Loose same(restarts(1));
  same.scene.live(8s);
  const auto given = same.loan.give_back();
  CHECK(given.errors.empty());
  REQUIRE(given.notes.size() == 1);
  CHECK(given.notes[0] == "node 11 restarted meanwhile: torque_output is on now");
  CHECK(given.servos.size() == 2);
  CHECK(same.outputs() == std::vector<std::int64_t>{0, 2, 1});

  for (const int serial_number : {2, 3}) { // brake before, off before: on by their ROM
    Loose other(restarts(serial_number));
    other.scene.live(8s);
    const auto differs = other.loan.give_back();
    REQUIRE(codes(differs) == std::vector{Code::state});
    CHECK(differs.errors[0].message ==
          fmt::format("node {} restarted meanwhile: torque_output is on now, and was {} before",
                      10 + serial_number, serial_number == 2 ? "brake" : "off"));
    CHECK(other.output(static_cast<std::uint8_t>(10 + serial_number)) == 0);
  }
}

TEST_CASE("what somebody else has set meanwhile stays, and is told as it is") {
  const std::int64_t there = GENERATE(0, 2);
  Loose unheard;
  unheard.set_by_another(11, there, false);
  unheard.set_by_another(12, there, false);
  const auto given = unheard.loan.give_back();
  CHECK(given.notes.empty());
  REQUIRE(codes(given) == std::vector{Code::state});
  CHECK(given.errors[0].node_id == (there == 0 ? 12 : 11));
  CHECK(unheard.outputs() == std::vector<std::int64_t>{there, there, 1});
}

TEST_CASE("torque that another node takes is not switched on") {
  Loose loose;
  loose.hear_write(11, 1);
  const auto given = loose.loan.give_back();
  REQUIRE(codes(given) == std::vector{Code::state});
  CHECK(
      given.errors[0].message ==
      "node 11: node 40 has written to it meanwhile: torque_output is off now, and was on before");
  CHECK(given.servos == std::vector{NodeId(12)});
  CHECK(loose.outputs() == std::vector<std::int64_t>{1, 2, 1});

  Loose to_another; // who had none before
  to_another.set_by_another(13, 0, true);
  const auto other = to_another.loan.give_back();
  REQUIRE(codes(other) == std::vector{Code::state});
  CHECK(other.errors[0].node_id == 13);
  CHECK(to_another.outputs() == std::vector<std::int64_t>{0, 2, 0});
}

TEST_CASE("what another node has changed before the yes is not agreed to") {
  Scene scene(three());
  scene.live(3s);
  Loan loan(*scene.session, profiles(), torque_off(profiles()), {});
  REQUIRE(loan.prepare(std::vector{NodeId(11), NodeId(12), NodeId(13)}).empty());
  const auto others = plans_for(scene, {.assignments = assignments({"torque_output=off"})}, {11});
  REQUIRE_FALSE(carry_out(*scene.session, profiles(), others, {}).broken);
  const auto errors = loan.look_again();
  REQUIRE(errors.size() == 1);
  CHECK(errors[0].code == Code::state);
  CHECK(errors[0].node_id == 11);
}

TEST_CASE("a servo that restarts as soon as it was let go is left to its ROM, too") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
      "faults": {"restart_after_answer": [{"to": "write"}]}}])");
  scene.live(3s);
  Loan loan(*scene.session, profiles(), torque_off(profiles()), {});
  REQUIRE(loan.prepare(std::vector{NodeId(11)}).empty());
  REQUIRE(loan.take().empty());
  scene.live(3s);
  const auto given = loan.give_back();
  CHECK(given.errors.empty());
  CHECK(given.servos == std::vector{NodeId(11)});
  REQUIRE(given.notes.size() == 1);
  CHECK(given.notes[0].find("node 11 restarted meanwhile") == 0);
}

TEST_CASE("of a servo that does not answer it is said what to type") {
  Loose loose(R"(, "events": [{"at": "6s", "servo": 2, "happens": "power_off"}])");
  loose.scene.live(8s);
  const auto given = loose.loan.give_back();
  REQUIRE(codes(given) == std::vector{Code::timeout});
  CHECK(given.errors[0].hint == "to put it back: blactl set torque_output=brake -n 12");
  CHECK(given.errors[0].node_id == 12);
  CHECK(loose.output(11) == 0);
}

TEST_CASE("on a bus that is armed nothing is written, and on one that is driven only if told to") {
  Loose armed;
  armed.hear_message(dronecan::ArmingStatus::type, {255});
  CHECK(codes(armed.loan.give_back()) == std::vector{Code::armed, Code::armed});
  CHECK(armed.outputs() == std::vector<std::int64_t>{1, 1, 1});

  const auto drive = [](const Loose& loose) {
    const dronecan::ArrayCommand command{
        {{.actuator_id = 1, .command_type = 1}, {.actuator_id = 2, .command_type = 1}}};
    const auto payload = command.encode();
    loose.hear_message(dronecan::ArrayCommand::type,
                       {payload.bytes().begin(), payload.bytes().end()});
  };
  Loose driven;
  drive(driven);
  CHECK(codes(driven.loan.give_back()) == std::vector{Code::driven, Code::driven});
  CHECK(driven.outputs() == std::vector<std::int64_t>{1, 1, 1});
  Loose told("", {.manner = {.while_driven = true}});
  drive(told);
  CHECK(told.loan.give_back().errors.empty());
  CHECK(told.outputs() == std::vector<std::int64_t>{0, 2, 1});
}

TEST_CASE("a first signal does not keep torque from coming back, a second one does") {
  Loose before;
  before.scene.session->set_grace(10s);
  REQUIRE(raise(SIGINT) == 0);
  CHECK_FALSE(before.scene.session->live_until(never));
  CHECK(before.loan.give_back().servos.size() == 2);

  Loose meanwhile;
  meanwhile.scene.session->set_grace(10s);
  REQUIRE(raise(SIGINT) == 0);
  CHECK(meanwhile.loan.give_back().servos.size() == 2);

  Loose twice;
  twice.scene.session->set_grace(10s);
  REQUIRE(raise(SIGINT) == 0);
  CHECK_FALSE(twice.scene.session->live_until(never));
  REQUIRE(raise(SIGTERM) == 0);
  const auto given = twice.loan.give_back();
  CHECK(codes(given) == std::vector{Code::state, Code::state});
  CHECK(given.errors[0].hint == "to put it back: blactl set torque_output=on -n 11");
}
