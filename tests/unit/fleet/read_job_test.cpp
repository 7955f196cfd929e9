#include "blactl/fleet/read_job.hpp"

#include "support.hpp"

#include <memory>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

constexpr const char* one_servo = R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
    "ram": {"angle_limit_cw": "90deg"}}])";

ReadJob::Plan reading(std::vector<const char*> names) {
  return [names =
              std::move(names)](const Member& servo) -> Result<std::vector<const bla::Parameter*>> {
    std::vector<const bla::Parameter*> wanted;
    for (const char* name : names) {
      wanted.push_back(servo.identity.parameter(parameter(name).address));
    }
    return wanted;
  };
}

} // namespace

TEST_CASE("a servo is identified, then its registers are read in the order of the plan") {
  Scene scene(one_servo);
  ReadJob job(scene.roster(), scene.member(11), profiles(), {},
              reading({"angle_limit_ccw", "angle_limit_cw"}));
  scene.run(job);
  CHECK_FALSE(job.error());
  REQUIRE(job.readings().size() == 2);
  CHECK(job.readings()[0].parameter->name == "angle_limit_ccw");
  CHECK(job.readings()[1].raw == 900);
  CHECK(job.raw(bla::address::angle_limit_cw) == 900);
  CHECK_FALSE(job.raw(bla::address::servo_id)); // of the identification, not of the plan
  CHECK(scene.requests(GetSet::type, 11) == 5 + 2);
}

TEST_CASE("a known servo is not identified again") {
  Scene scene(one_servo);
  scene.identify(11);
  scene.sent.clear();
  ReadJob job(scene.roster(), scene.member(11), profiles(), {}, reading({"angle_limit_cw"}));
  scene.run(job);
  CHECK(job.raw(bla::address::angle_limit_cw) == 900);
  CHECK(scene.sent.size() == 1);
}

TEST_CASE("an empty plan reads nothing") {
  Scene scene(one_servo);
  scene.identify(11);
  scene.sent.clear();
  ReadJob job(scene.roster(), scene.member(11), profiles(), {}, reading({}));
  scene.run(job);
  CHECK_FALSE(job.error());
  CHECK(job.readings().empty());
  CHECK(scene.sent.empty());
}

TEST_CASE("a plan that is refused reads nothing, and the error names the servo") {
  Scene scene(one_servo);
  scene.identify(11);
  scene.sent.clear();
  ReadJob job(scene.roster(), scene.member(11), profiles(), {},
              [](const Member&) -> Result<std::vector<const bla::Parameter*>> {
                return fail(Code::unsupported, "no");
              });
  scene.run(job);
  REQUIRE(job.error());
  CHECK(job.error()->code == Code::unsupported);
  CHECK(job.error()->node_id == 11);
  CHECK(scene.sent.empty());
}

TEST_CASE("of a node that is no servo no register is read") {
  Scene scene(R"("foreign": [{"kind": "node", "node_id": 30, "name": "gnss",
                              "serves_get_set": true}])");
  ReadJob job(scene.roster(), scene.member(30), profiles(), {}, reading({"angle_limit_cw"}));
  scene.run(job);
  REQUIRE(job.error());
  CHECK(job.error()->code == Code::not_found);
  CHECK(job.error()->message.find("gnss") != std::string::npos);
  CHECK(scene.requests(GetSet::type, 30) == 1); // 0x50, which told what it is
}

TEST_CASE("the name of a foreign node cannot write to the terminal") {
  Scene scene(R"("foreign": [{"kind": "node", "node_id": 30, "name": "\u001b[2Jx",
                              "serves_get_set": true}])");
  ReadJob job(scene.roster(), scene.member(30), profiles(), {}, reading({}));
  scene.run(job);
  REQUIRE(job.error());
  CHECK(job.error()->message.find('\x1b') == std::string::npos);
}

TEST_CASE("who does not answer is not read") {
  Scene scene(one_servo);
  ReadJob job(scene.roster(), scene.member(55), profiles(),
              {.patience = {.timeout = 20ms, .retries = 0}}, reading({"angle_limit_cw"}));
  scene.run(job);
  REQUIRE(job.error());
  CHECK(job.error()->code == Code::not_found);
  CHECK(job.readings().empty());
}

TEST_CASE("a register that the servo refuses does not hinder the others") {
  Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])");
  ReadJob job(scene.roster(), scene.member(11), profiles(), {},
              [](const Member& servo) -> Result<std::vector<const bla::Parameter*>> {
                return std::vector{&parameter("write_rom"),
                                   servo.identity.parameter(bla::address::angle_limit_cw)};
              });
  scene.run(job);
  CHECK_FALSE(job.error());
  REQUIRE(job.readings().size() == 2);
  REQUIRE_FALSE(job.readings()[0].raw);
  CHECK(job.readings()[0].raw.error().code == Code::refused);
  CHECK(job.readings()[1].raw);
}

TEST_CASE("a register that is not answered does not hinder the others") {
  Scene scene(one_servo);
  Member& servo = scene.identify(11);
  Script script;
  ReadJob job(scene.roster(), servo, profiles(), {}, reading({"angle_limit_cw", "reverse"}));
  CHECK(text(job.next(Script::start())) == "read 0x38");
  CHECK(text(job.next(Script::timed_out())) == "read 0x23");
  CHECK(text(job.next(script.value("0x23", std::int64_t{1}))) == "nothing");
  CHECK(job.readings()[0].raw.error().code == Code::timeout);
  CHECK(job.raw(bla::address::reverse) == 1);
  CHECK_FALSE(job.raw(bla::address::angle_limit_cw));
}

TEST_CASE("what is read is narrowed to the width of its register") {
  Scene scene(one_servo);
  Member& servo = scene.identify(11);
  Script script;
  ReadJob job(scene.roster(), servo, profiles(), {}, reading({"angle_limit_ccw"}));
  CHECK(text(job.next(Script::start())) == "read 0x39");
  CHECK(text(job.next(script.value("0x39", std::int64_t{0xFFFF'FC7C}))) == "nothing");
  CHECK(job.raw(bla::address::angle_limit_ccw) == -900);
}

TEST_CASE("a cancelled job asks nothing more") {
  Scene scene(one_servo);
  Member& servo = scene.identify(11);
  ReadJob job(scene.roster(), servo, profiles(), {}, reading({"angle_limit_cw", "reverse"}));
  CHECK(text(job.next(Script::start())) == "read 0x38");
  CHECK(text(job.next(Script::cancelled())) == "nothing");
  REQUIRE(job.readings().size() == 1);
  CHECK(job.readings()[0].raw.error().code == Code::interrupted);
}

TEST_CASE("twenty servos are read at the same time") {
  std::string servos;
  for (int id = 1; id <= 20; ++id) {
    servos += fmt::format(R"({}{{"model": "BLA21-12U-AB", "node_id": {}, "servo_id": {}}})",
                          id == 1 ? "" : ",", id, id);
  }
  Scene scene(fmt::format(R"("servos": [{}])", servos));
  const Time begin = scene.session->now();
  std::vector<std::unique_ptr<ReadJob>> jobs;
  for (std::uint8_t id = 1; id <= 20; ++id) {
    jobs.push_back(std::make_unique<ReadJob>(scene.roster(), scene.member(id), profiles(),
                                             Identification::Options{}, reading({"servo_id"})));
    scene.session->start(*jobs.back());
  }
  REQUIRE(scene.session->run());
  for (std::uint8_t id = 1; id <= 20; ++id) {
    CHECK(jobs[id - 1U]->raw(bla::address::servo_id) == id);
    CHECK(scene.requests(GetNodeInfo::type, id) == 1);
    CHECK(scene.requests(GetSet::type, id) == 6);
  }
  // One after the other it would take 20 times seven questions of a millisecond each.
  CHECK(scene.session->now() - begin < 140ms);
}
