#include "blactl/fleet/bus/read_job.hpp"

#include "support.hpp"

#include <memory>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

constexpr const char* one_servo = R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
    "ram": {"angle_limit_cw": "90deg"}}])";

/// A reading of a servo that is known, without its bus.
struct Reader {
  explicit Reader(std::vector<const char*> names, ReadJob::Proof proof = ReadJob::Proof::moment)
      : job(known.roster, NodeId(11), profiles(), {}, registers(std::move(names)), proof) {}

  std::string next(const Outcome& outcome) {
    step = job.next(outcome);
    return text(step);
  }

  std::string value(const char* name, std::int64_t value) {
    return next(script.value(name, value));
  }

  /// The uptime that a unit tells at a moment, after a while.
  std::string told(std::uint8_t by, std::uint32_t uptime_s, Duration at, Duration took = {}) {
    Outcome outcome = script.info(by, uptime_s);
    outcome.at = Time{} + at;
    outcome.asked = outcome.at - took;
    return next(outcome);
  }

  /// It reads all again: its servo ID, then the first register.
  std::string read_from_the_start(std::int64_t servo_id = 0) {
    CHECK(text(step) == "read 0x45");
    return value("0x45", servo_id);
  }

  /// Nothing that was read is shown.
  [[nodiscard]] Code given_up() const {
    CHECK(job.snapshot().readings.empty());
    REQUIRE(job.snapshot().error);
    CHECK(job.snapshot().error->node_id == 11);
    return job.snapshot().error->code;
  }

  Acquaintance known{bla21()};
  Script script;
  ReadJob job;
  dronecan::Step step = std::nullopt;
};

constexpr std::uint8_t unit = 11; // of bla21()

} // namespace

TEST_CASE("a servo is identified, then its registers are read in the order of the choice") {
  Scene scene(one_servo);
  scene.grow_old();
  ReadJob job(scene.roster(), NodeId(11), profiles(), {},
              registers({"angle_limit_ccw", "angle_limit_cw"}));
  scene.run(job);
  CHECK_FALSE(job.snapshot().error);
  REQUIRE(job.snapshot().readings.size() == 2);
  CHECK(job.snapshot().readings[0].parameter->name == "angle_limit_ccw");
  CHECK(job.snapshot().readings[1].raw == 900);
  CHECK(job.snapshot().raw(bla::address::angle_limit_cw) == 900);
  CHECK_FALSE(
      job.snapshot().raw(bla::address::servo_id)); // of the identification, not of the choice
  CHECK(scene.requests(GetSet::type, 11) == 5 + 2);
  CHECK(scene.requests(GetNodeInfo::type, 11) == 2); // the last one proves that it ran on
}

TEST_CASE("a known servo is not identified again") {
  Scene scene(one_servo);
  scene.grow_old();
  scene.identify(11);
  scene.sent.clear();
  ReadJob job(scene.roster(), NodeId(11), profiles(), {}, registers({"angle_limit_cw"}));
  scene.run(job);
  CHECK(job.snapshot().raw(bla::address::angle_limit_cw) == 900);
  CHECK(scene.requests(GetSet::type, 11) == 1);
  CHECK(scene.requests(GetNodeInfo::type, 11) == 1);
}

TEST_CASE("an empty choice reads nothing") {
  Scene scene(one_servo);
  scene.grow_old();
  scene.identify(11);
  scene.sent.clear();
  ReadJob job(scene.roster(), NodeId(11), profiles(), {}, registers({}));
  scene.run(job);
  CHECK_FALSE(job.snapshot().error);
  CHECK(job.snapshot().readings.empty());
  CHECK(scene.requests(GetSet::type, 11) == 0);
}

TEST_CASE("a choice that is refused reads nothing, and the error names the servo") {
  Scene scene(one_servo);
  scene.grow_old();
  scene.identify(11);
  scene.sent.clear();
  ReadJob job(scene.roster(), NodeId(11), profiles(), {},
              [](const Servo&) -> Result<std::vector<const bla::Parameter*>> {
                return fail(Code::unsupported, "no");
              });
  scene.run(job);
  REQUIRE(job.snapshot().error);
  CHECK(job.snapshot().error->code == Code::unsupported);
  CHECK(job.snapshot().error->node_id == 11);
  CHECK(scene.requests(GetSet::type, 11) == 0);
}

TEST_CASE("of a node that is no servo no register is read") {
  Scene scene(R"("foreign": [{"kind": "node", "node_id": 30, "name": "gnss",
                              "serves_get_set": true}])");
  ReadJob job(scene.roster(), NodeId(30), profiles(), {}, registers({"angle_limit_cw"}));
  scene.run(job);
  REQUIRE(job.snapshot().error);
  CHECK(job.snapshot().error->code == Code::not_found);
  CHECK(job.snapshot().error->message.find("gnss") != std::string::npos);
  CHECK(scene.requests(GetSet::type, 30) == 1); // 0x50, which told what it is
}

TEST_CASE("the name of a foreign node cannot write to the terminal") {
  Scene scene(R"("foreign": [{"kind": "node", "node_id": 30, "name": "\u001b[2Jx",
                              "serves_get_set": true}])");
  ReadJob job(scene.roster(), NodeId(30), profiles(), {}, registers({}));
  scene.run(job);
  REQUIRE(job.snapshot().error);
  CHECK(job.snapshot().error->message.find('\x1b') == std::string::npos);
}

TEST_CASE("who does not answer is not read") {
  Scene scene(one_servo);
  ReadJob job(scene.roster(), NodeId(55), profiles(), {.patience = {.timeout = 20ms, .retries = 0}},
              registers({"angle_limit_cw"}));
  scene.run(job);
  REQUIRE(job.snapshot().error);
  CHECK(job.snapshot().error->code == Code::not_found);
  CHECK(job.snapshot().readings.empty());
}

TEST_CASE("a register that the servo refuses does not hinder the others", "[requirement-72]") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])");
  ReadJob job(scene.roster(), NodeId(11), profiles(), {},
              [](const Servo& servo) -> Result<std::vector<const bla::Parameter*>> {
                return std::vector{&parameter("write_rom"),
                                   servo.identity.parameter(bla::address::angle_limit_cw)};
              });
  scene.run(job);
  CHECK_FALSE(job.snapshot().error);
  REQUIRE(job.snapshot().readings.size() == 2);
  REQUIRE_FALSE(job.snapshot().readings[0].raw);
  CHECK(job.snapshot().readings[0].raw.error().code == Code::refused);
  CHECK(job.snapshot().readings[1].raw);
}

TEST_CASE("a register that is not answered does not hinder the others") {
  Scene scene(one_servo);
  scene.grow_old();
  scene.identify(11);
  Script script;
  ReadJob job(scene.roster(), NodeId(11), profiles(), {}, registers({"angle_limit_cw", "reverse"}));
  CHECK(text(job.next(Script::start())) == "read 0x38");
  CHECK(text(job.next(Script::timed_out())) == "read 0x23");
  CHECK(text(job.next(script.value("0x23", std::int64_t{1}))) == "GetNodeInfo");
  CHECK(job.snapshot().readings[0].raw.error().code == Code::timeout);
  CHECK(job.snapshot().raw(bla::address::reverse) == 1);
  CHECK_FALSE(job.snapshot().raw(bla::address::angle_limit_cw));
}

TEST_CASE("what is read is narrowed to the width of its register", "[requirement-76]") {
  Scene scene(one_servo);
  scene.grow_old();
  scene.identify(11);
  Script script;
  ReadJob job(scene.roster(), NodeId(11), profiles(), {}, registers({"angle_limit_ccw"}));
  CHECK(text(job.next(Script::start())) == "read 0x39");
  CHECK(text(job.next(script.value("0x39", std::int64_t{0xFFFF'FC7C}))) == "GetNodeInfo");
  CHECK(job.snapshot().raw(bla::address::angle_limit_ccw) == -900);
}

TEST_CASE("a cancelled job asks nothing more") {
  Scene scene(one_servo);
  scene.grow_old();
  scene.identify(11);
  ReadJob job(scene.roster(), NodeId(11), profiles(), {}, registers({"angle_limit_cw", "reverse"}));
  CHECK(text(job.next(Script::start())) == "read 0x38");
  CHECK(text(job.next(Script::cancelled())) == "nothing");
  CHECK(job.snapshot().readings.empty()); // it is not proven that they are of one time
  REQUIRE(job.snapshot().error);
  CHECK(job.snapshot().error->code == Code::interrupted);
}

TEST_CASE("twenty servos are read at the same time") {
  std::string servos;
  for (int id = 1; id <= 20; ++id) {
    servos += fmt::format(R"({}{{"model": "BLA21-12U-AB", "node_id": {}, "servo_id": {}}})",
                          id == 1 ? "" : ",", id, id);
  }
  Scene scene(fmt::format(R"("servos": [{}])", servos));
  scene.grow_old();
  const Time begin = scene.session->now();
  std::vector<std::unique_ptr<ReadJob>> jobs;
  for (std::uint8_t id = 1; id <= 20; ++id) {
    jobs.push_back(std::make_unique<ReadJob>(scene.roster(), NodeId(id), profiles(),
                                             Identification::Options{}, registers({"servo_id"})));
    scene.session->start(*jobs.back());
  }
  REQUIRE(scene.session->run());
  for (std::uint8_t id = 1; id <= 20; ++id) {
    CHECK(jobs[id - 1U]->snapshot().raw(bla::address::servo_id) == id);
    CHECK(scene.requests(GetNodeInfo::type, id) == 2);
    CHECK(scene.requests(GetSet::type, id) == 6);
  }
  // One after the other it would take 20 times eight questions of a millisecond each, and 20 ms.
  CHECK(scene.session->now() - begin < 160ms);
}

TEST_CASE("what was read is true once the servo has told that it ran on, and no twin has shown") {
  Reader reader({"angle_limit_cw"});
  CHECK(reader.next(Script::start()) == "read 0x38");
  CHECK(reader.value("0x38", 900) == "GetNodeInfo");
  CHECK(reader.next(reader.script.info(unit)) == "pause");
  CHECK(reader.next(Script::start()) == "nothing");
  CHECK_FALSE(reader.job.snapshot().error);
  CHECK(reader.job.snapshot().raw(bla::address::angle_limit_cw) == 900);
}

TEST_CASE("on a recording nothing is proven") {
  Reader reader({"angle_limit_cw"}, ReadJob::Proof::none);
  CHECK(reader.next(Script::start()) == "read 0x38");
  CHECK(reader.value("0x38", 900) == "nothing");
  CHECK(reader.job.snapshot().raw(bla::address::angle_limit_cw) == 900);
  Reader empty({}, ReadJob::Proof::none);
  CHECK(empty.next(Script::start()) == "nothing");
}

TEST_CASE("a young servo is asked again when its uptime tells whether it ran on") {
  Reader reader({"angle_limit_cw", "reverse"});
  CHECK(reader.next(Script::start()) == "read 0x38");
  CHECK(reader.value("0x38", 900) == "read 0x23");
  CHECK(reader.value("0x23", 1) == "GetNodeInfo");
  CHECK(reader.told(unit, 0, 15ms) == "pause");
  CHECK(reader.next(Script::start()) == "GetNodeInfo");
  SECTION("it ran on") {
    CHECK(reader.told(unit, 1, 1001ms) == "pause"); // for a twin
    CHECK(reader.next(Script::start()) == "nothing");
    CHECK(reader.job.snapshot().raw(bla::address::angle_limit_cw) == 900);
    CHECK_FALSE(reader.job.snapshot().has_restarted);
  }
  SECTION("it restarted: all is read once more, and must be proven in the same way") {
    CHECK(reader.told(unit, 0, 1001ms) == "read 0x45");
    CHECK(reader.read_from_the_start() == "read 0x38");
    CHECK(reader.value("0x38", 1799) == "read 0x23");
    CHECK(reader.value("0x23", 0) == "GetNodeInfo");
    CHECK(reader.told(unit, 0, 1010ms) == "pause");
    CHECK(reader.next(Script::start()) == "GetNodeInfo");
    CHECK(reader.told(unit, 1, 2002ms) == "pause"); // for a twin
    CHECK(reader.next(Script::start()) == "nothing");
    CHECK(reader.job.snapshot().raw(bla::address::angle_limit_cw) == 1799);
    CHECK(reader.job.snapshot().raw(bla::address::reverse) == 0);
    CHECK(reader.job.snapshot().has_restarted);
  }
}

TEST_CASE(
    "whether a young servo ran on since it was first heard shows by its uptime a second later") {
  Reader reader({"angle_limit_cw"}, ReadJob::Proof::run);
  const Time heard = reader.known.member().first_heard;
  const auto told = [&](std::uint32_t uptime_s, Duration later) {
    return reader.told(unit, uptime_s, heard - Time{} + later);
  };
  CHECK(reader.next(Script::start()) == "read 0x38");
  CHECK(reader.value("0x38", 900) == "GetNodeInfo");
  CHECK(told(0, 15ms) == "pause");
  REQUIRE(reader.step.pause() != nullptr);
  CHECK(reader.step.pause()->until == heard + 1s);
  SECTION("it did") {
    CHECK(reader.next(Script::start()) == "GetNodeInfo");
    CHECK(told(1, 1001ms) == "pause"); // for a twin
    CHECK(reader.next(Script::start()) == "nothing");
    CHECK_FALSE(reader.job.snapshot().has_restarted);
  }
  SECTION("it did not: that is told, and what it holds now is read") {
    CHECK(reader.next(Script::start()) == "GetNodeInfo");
    CHECK(told(0, 1001ms) == "read 0x45");
    CHECK(reader.read_from_the_start() == "read 0x38");
    CHECK(reader.value("0x38", 900) == "GetNodeInfo");
    CHECK(told(1, 1501ms) == "pause"); // for a twin
    CHECK(reader.next(Script::start()) == "nothing");
    CHECK(reader.job.snapshot().has_restarted);
    CHECK_FALSE(reader.job.snapshot().error);
  }
  SECTION("an answer that is late is asked for again, and earlier") {
    CHECK(reader.next(Script::start()) == "GetNodeInfo");
    CHECK(told(1, 1100ms) == "pause"); // its way did not take long, but it was asked for late
    REQUIRE(reader.step.pause() != nullptr);
    // It started 900 ms before it was heard at the earliest, and the answer needs 90 ms of that.
    CHECK(reader.step.pause()->until == heard + 1505ms);
    CHECK(reader.next(Script::start()) == "GetNodeInfo");
    CHECK(told(2, 1605ms) == "pause");
    CHECK(reader.next(Script::start()) == "nothing");
    CHECK_FALSE(reader.job.snapshot().has_restarted);
  }
  SECTION("answers that are always late prove nothing") {
    for (std::uint32_t second = 1; second <= 7; ++second) {
      CHECK(reader.next(Script::start()) == "GetNodeInfo");
      CHECK(told(second, second * 1s + 100ms) == (second < 7 ? "pause" : "nothing"));
    }
    CHECK(reader.given_up() == Code::state);
  }
  SECTION("where answers take long it is asked earlier") {
    CHECK(reader.next(Script::start()) == "GetNodeInfo");
    CHECK(reader.told(unit, 1, heard - Time{} + 1030ms, 30ms) == "pause");
    REQUIRE(reader.step.pause() != nullptr);
    CHECK(reader.step.pause()->until == heard + 1490ms);
  }
  SECTION("a restart that is heard ends the pause") {
    CHECK_FALSE(reader.step.pause()->ready());
    reader.known.restart();
    CHECK(reader.step.pause()->ready());
  }
}

TEST_CASE("where answers are too late for a young servo it is read again when it is older") {
  Reader reader({"angle_limit_cw"});
  CHECK(reader.next(Script::start()) == "read 0x38");
  CHECK(reader.value("0x38", 900) == "GetNodeInfo");
  for (std::uint32_t second = 0; second < 7; ++second) {
    CHECK(reader.told(unit, second, second * 1s + 100ms) == "pause");
    CHECK(reader.next(Script::start()) == "GetNodeInfo");
  }
  CHECK(reader.told(unit, 7, 7100ms) == "read 0x45");
  CHECK(reader.read_from_the_start() == "read 0x38");
  CHECK(reader.value("0x38", 901) == "GetNodeInfo");
  SECTION("it ran on") {
    CHECK(reader.told(unit, 7, 7200ms) == "pause"); // for a twin
    CHECK(reader.next(Script::start()) == "nothing");
    CHECK(reader.job.snapshot().raw(bla::address::angle_limit_cw) == 901);
    CHECK_FALSE(reader.job.snapshot().has_restarted);
  }
  SECTION("it restarted meanwhile") {
    CHECK(reader.told(unit, 0, 8200ms) == "read 0x45");
    CHECK(reader.read_from_the_start() == "read 0x38");
    CHECK(reader.value("0x38", 902) == "GetNodeInfo");
    CHECK(reader.told(unit, 1, 8300ms) == "pause"); // for a twin
    CHECK(reader.next(Script::start()) == "nothing");
    CHECK(reader.job.snapshot().raw(bla::address::angle_limit_cw) == 902);
    CHECK(reader.job.snapshot().has_restarted);
  }
}

TEST_CASE("what another node changed while it was read is read again") {
  Reader reader({"angle_limit_cw", "reverse"});
  const auto other_writes = [&](const char* name) {
    const auto payload = GetSet::Request{.value = std::int64_t{0}, .name = name}.encode();
    reader.known.roster.receive({.header = {.kind = dronecan::Kind::request,
                                            .data_type_id = GetSet::type.id,
                                            .source = NodeId(40),
                                            .destination = NodeId(11)},
                                 .payload = payload.bytes(),
                                 .at = reader.known.now});
  };
  CHECK(reader.next(Script::start()) == "read 0x38");
  CHECK(reader.value("0x38", 900) == "read 0x23");
  SECTION("one of those that are read") {
    other_writes("0x38");
    CHECK(reader.value("0x23", 1) == "GetNodeInfo");
    CHECK(reader.next(reader.script.info(unit)) == "pause");
    CHECK(reader.next({Outcome::Kind::woken, {}, reader.known.now + 1s}) == "read 0x45");
    CHECK(reader.read_from_the_start() == "read 0x38");
    CHECK(reader.value("0x38", 0) == "read 0x23");
    CHECK(reader.value("0x23", 1) == "GetNodeInfo");
    CHECK(reader.told(unit, 5000, reader.known.now + 2s - Time{}) == "pause");
    CHECK(reader.next({Outcome::Kind::woken, {}, reader.known.now + 3s}) == "nothing");
    CHECK(reader.job.snapshot().raw(bla::address::angle_limit_cw) == 0);
    CHECK_FALSE(reader.job.snapshot().has_restarted);
  }
  SECTION("another one") {
    other_writes("0x45");
    CHECK(reader.value("0x23", 1) == "GetNodeInfo");
    CHECK(reader.next(reader.script.info(unit)) == "pause");
    CHECK(reader.next(Script::start()) == "nothing");
  }
}

TEST_CASE("what changed while a slower servo was still read is read again") {
  const auto* order =
      GENERATE(R"("order": "write", "address": 56, "value": 900)", R"("order": "restart")",
               R"("order": "write", "address": 69, "value": 3)");
  Scene scene(fmt::format(R"("servos": [
      {{"model": "BLA21-12U-AB", "node_id": 11, "ram": {{"angle_limit_cw": "45deg"}}}},
      {{"model": "BLA21-12U-AB", "node_id": 12, "answer_delay": "90ms"}}],
    "foreign": [{{"kind": "node", "node_id": 40, "orders": [{{"at": "60.6s", "to": 11, {}}}]}}])",
                          order));
  REQUIRE(scene.session->live_until(Time(60s)));
  const std::array ids{NodeId(11), NodeId(12)};
  const auto read = take_snapshots(*scene.session, profiles(), ids, {},
                                   registers({"angle_limit_cw", "angle_limit_ccw", "reverse",
                                              "servo_id", "soft_start", "smoothing"}));
  REQUIRE_FALSE(read.broken);
  REQUIRE(scene.session->now() > Time(60600ms));
  const bool is_write = std::string_view(order).contains("56");
  const bool is_restart = std::string_view(order).contains("restart");
  CHECK(read.servos[0].raw(bla::address::angle_limit_cw) == (is_write     ? 900
                                                             : is_restart ? 1799
                                                                          : 450));
  CHECK(read.servos[0].has_restarted == is_restart);
}

TEST_CASE("after SAVE it is enough that it is one servo, however young") {
  Reader reader({"angle_limit_cw"}, ReadJob::Proof::unit);
  CHECK(reader.next(Script::start()) == "read 0x38");
  CHECK(reader.value("0x38", 900) == "GetNodeInfo");
  SECTION("it is") {
    CHECK(reader.next(reader.script.young_info(unit)) == "pause"); // for a twin
    CHECK(reader.next(Script::start()) == "nothing");
    CHECK(reader.job.snapshot().raw(bla::address::angle_limit_cw) == 900);
  }
  SECTION("it is another one") {
    CHECK(reader.next(reader.script.young_info(unit + 1)) == "nothing");
    CHECK(reader.given_up() == Code::state);
  }
}

TEST_CASE("after SAVE all is read again where a request was lost: the servo may have restarted") {
  Reader reader({"angle_limit_cw", "reverse"}, ReadJob::Proof::unit);
  CHECK(reader.next(Script::start()) == "read 0x38");
  const auto late = [&](const char* name, std::int64_t value, Duration asked) {
    Outcome outcome = reader.script.value(name, value);
    outcome.asked = Time{} + asked;
    outcome.at = outcome.asked + 1ms;
    return reader.next(outcome);
  };
  CHECK(late("0x38", 900, 0ms) == "read 0x23");
  CHECK(late("0x23", 0, 501ms) == "read 0x45");
  CHECK(late("0x45", 0, 502ms) == "read 0x38");
  CHECK(late("0x38", 1799, 503ms) == "read 0x23");
  CHECK(late("0x23", 0, 504ms) == "GetNodeInfo");
  CHECK(reader.job.snapshot().raw(bla::address::angle_limit_cw) == 1799);
}

TEST_CASE("after a restart that was heard all is read again, and the servo stays known") {
  Reader reader({"angle_limit_cw"});
  CHECK(reader.next(Script::start()) == "read 0x38");
  reader.known.restart();
  CHECK(reader.value("0x38", 900) == "GetNodeInfo");
  CHECK(reader.next(reader.script.info(unit)) == "read 0x45");
  CHECK(reader.read_from_the_start(7) == "read 0x38");
  CHECK(reader.value("0x38", 1799) == "GetNodeInfo");
  CHECK(reader.next(reader.script.info(unit)) == "pause");
  CHECK(reader.next(Script::start()) == "nothing");
  CHECK(reader.job.snapshot().raw(bla::address::angle_limit_cw) == 1799);
  CHECK(reader.job.snapshot().servo.boot == 1);
  CHECK(reader.job.snapshot().servo.servo_id == 7);
  CHECK(reader.known.member().is_known());
  CHECK(reader.known.member().servo().servo_id == 7);
}

TEST_CASE("a servo that restarts with every reading is given up, and none of them is shown") {
  Reader reader({"angle_limit_cw"});
  CHECK(reader.next(Script::start()) == "read 0x38");
  for (int pass = 1; pass <= 4; ++pass) {
    reader.known.restart();
    reader.known.now += 10s;
    reader.known.hear_uptime(10);
    CHECK(reader.value("0x38", 900) == "GetNodeInfo");
    CHECK(reader.next(reader.script.info(unit)) == (pass < 4 ? "read 0x45" : "nothing"));
    CHECK((pass == 4 || reader.read_from_the_start() == "read 0x38"));
  }
  CHECK(reader.given_up() == Code::state);
}

TEST_CASE("what was read is shown of no other unit, and of none that is gone") {
  Reader reader({"angle_limit_cw"});
  CHECK(reader.next(Script::start()) == "read 0x38");
  CHECK(reader.value("0x38", 900) == "GetNodeInfo");
  SECTION("another unit answers") {
    CHECK(reader.next(reader.script.info(12)) == "nothing");
    CHECK(reader.given_up() == Code::state);
  }
  SECTION("nobody answers") {
    CHECK(reader.next(Script::timed_out()) == "nothing");
    CHECK(reader.given_up() == Code::timeout);
  }
  SECTION("the question does not leave") {
    CHECK(reader.next(Script::not_sent()) == "nothing");
    CHECK(reader.given_up() == Code::no_acknowledge);
  }
  SECTION("it is cancelled") {
    CHECK(reader.next(Script::cancelled()) == "nothing");
    CHECK(reader.given_up() == Code::interrupted);
  }
}

TEST_CASE("a servo that takes the node ID of another one meanwhile is not read for both") {
  constexpr const char* unit = "00112233445566778899aabbccddeeff";
  const Scene scene(fmt::format(
      R"("servos": [{{"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 1, "unique_id": "{0}"}},
                    {{"model": "BLA21-12U-AB", "node_id": 12, "serial_number": 2, "unique_id": "{0}"}}],
         "events": [{{"at": "0ms", "servo": 2, "world": {{"plugged": "off"}}}},
                    {{"at": "2s", "servo": 1, "world": {{"plugged": "off"}}}},
                    {{"at": "2500ms", "servo": 2, "world": {{"plugged": "on"}}}}])",
      unit));
  const auto read = take_snapshots(*scene.session, profiles(), std::vector{NodeId(11), NodeId(12)},
                                   {.patience = {.timeout = 500ms, .retries = 20}},
                                   registers({"angle_limit_cw"}), ReadJob::Proof::moment);
  REQUIRE_FALSE(read.broken);
  for (const Snapshot& servo : read.servos) {
    REQUIRE(servo.error);
    CHECK(servo.error->code == Code::state);
    CHECK(servo.readings.empty());
  }
}

TEST_CASE("what may be of either of two units is not shown") {
  Reader reader({"angle_limit_cw", "reverse"});
  const auto double_it = [&] { reader.known.roster.mark_doubled(NodeId(11), {11}, {12}); };
  CHECK(reader.next(Script::start()) == "read 0x38");
  SECTION("they show while registers are read") {
    double_it();
    CHECK(reader.value("0x38", 900) == "nothing");
  }
  SECTION("they show by the last answer") {
    CHECK(reader.value("0x38", 900) == "read 0x23");
    CHECK(reader.value("0x23", 1) == "GetNodeInfo");
    double_it();
    CHECK(reader.next(reader.script.info(unit)) == "nothing");
  }
  SECTION("the second one answers later than the first") {
    CHECK(reader.value("0x38", 900) == "read 0x23");
    CHECK(reader.value("0x23", 1) == "GetNodeInfo");
    CHECK(reader.next(reader.script.info(unit)) == "pause");
    const auto* pause = reader.step.pause();
    REQUIRE(pause != nullptr);
    CHECK_FALSE(pause->ready());
    double_it();
    CHECK(pause->ready());
    CHECK(reader.next(Script::start()) == "nothing");
  }
  CHECK(reader.given_up() == Code::duplicate_node_id);
  CHECK(reader.job.snapshot().error->message.find("uid:0b") != std::string::npos);
}

TEST_CASE("two silent registers in a row raise the question whether the servo is there") {
  Reader reader({"angle_limit_cw", "angle_limit_ccw", "reverse"});
  CHECK(reader.next(Script::start()) == "read 0x38");
  CHECK(reader.next(Script::timed_out()) == "read 0x39");
  SECTION("one that answers was only silent about them") {
    CHECK(reader.next(Script::timed_out()) == "GetNodeInfo");
    CHECK(reader.next(reader.script.info(unit)) == "read 0x23");
    CHECK(reader.value("0x23", 1) == "GetNodeInfo");
    CHECK(reader.next(reader.script.info(unit)) == "pause");
    REQUIRE(reader.job.snapshot().readings.size() == 3);
    CHECK(reader.job.snapshot().readings[1].raw.error().code == Code::timeout);
    CHECK(reader.job.snapshot().raw(bla::address::reverse) == 1);
  }
  SECTION("one that does not is gone: that is one error, not one a register") {
    CHECK(reader.next(Script::timed_out()) == "GetNodeInfo");
    CHECK(reader.next(Script::timed_out()) == "nothing");
    CHECK(reader.given_up() == Code::timeout);
  }
  SECTION("two whose answers disturb each other are there: that is a conflict") {
    CHECK(reader.next(Script::timed_out()) == "GetNodeInfo");
    reader.known.roster.mark_doubled(NodeId(11), {11}, {12});
    CHECK(reader.next(Script::timed_out()) == "nothing");
    CHECK(reader.given_up() == Code::duplicate_node_id);
  }
  SECTION("so they are when they show by the proof alone") {
    CHECK(reader.value("0x39", 0) == "read 0x23");
    CHECK(reader.value("0x23", 1) == "GetNodeInfo");
    reader.known.roster.mark_doubled(NodeId(11), {11}, {12});
    CHECK(reader.next(Script::timed_out()) == "nothing");
    CHECK(reader.given_up() == Code::duplicate_node_id);
  }
  SECTION("an answer in between ends the row") {
    CHECK(reader.value("0x39", 0) == "read 0x23");
    CHECK(reader.next(Script::timed_out()) == "GetNodeInfo"); // the proof
    CHECK(reader.next(reader.script.info(unit)) == "pause");
  }
}

TEST_CASE("a servo that has run for a moment only is read once, and asked twice how long it ran") {
  Scene scene(one_servo);
  const Snapshot snapshot = scene.read(11, registers({"angle_limit_cw"}));
  CHECK_FALSE(snapshot.error);
  CHECK(snapshot.raw(bla::address::angle_limit_cw) == 900);
  CHECK(scene.requests(GetNodeInfo::type, 11) == 3);
  CHECK(scene.requests(GetSet::type, 11) == 5 + 1);
}

TEST_CASE("what was read may ask for more, until it names nothing new") {
  Acquaintance known{bla21()};
  Script script;
  ReadJob job(known.roster, NodeId(11), profiles(), {}, registers({"fault_summary"}),
              ReadJob::Proof::moment, [](const Snapshot& so_far) {
                const auto summary = so_far.raw(bla::address::fault_summary);
                return summary == 2 ? std::vector{&parameter("fault_warning")}
                                    : std::vector<const bla::Parameter*>{};
              });
  CHECK(text(job.next(Script::start())) == "read 0x18");
  SECTION("there is more") {
    CHECK(text(job.next(script.value("0x18", std::int64_t{2}))) == "read 0x1A");
    CHECK(text(job.next(script.value("0x1A", std::int64_t{64}))) == "GetNodeInfo");
    CHECK(text(job.next(script.info(unit))) == "pause");
    CHECK(job.snapshot().raw(bla::address::fault_warning) == 64);
  }
  SECTION("there is not") {
    CHECK(text(job.next(script.value("0x18", std::int64_t{0}))) == "GetNodeInfo");
    CHECK(text(job.next(script.info(unit))) == "pause");
    CHECK(job.snapshot().readings.size() == 1);
  }
}
