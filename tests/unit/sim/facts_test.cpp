#include "blactl/sim/scenario/facts.hpp"

#include "unit/sim/support.hpp"

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;

namespace {

Behaviour facts(std::string_view behaviour) {
  const auto parsed = parse_facts(
      fmt::format(R"({{"schema": "blactl-facts/1", "behaviour": {{{}}}}})", behaviour), "facts");
  INFO((parsed ? "" : parsed.error().message));
  REQUIRE(parsed);
  return *parsed;
}

std::string faults(std::string_view text) {
  const auto parsed = parse_facts(text, "facts.json");
  REQUIRE_FALSE(parsed);
  CHECK(parsed.error().code == Code::bad_file);
  return parsed.error().message;
}

bool has(const std::string& message, std::string_view part) {
  INFO(message);
  return message.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("facts say how servos behave, and leave the rest as it is likely") {
  const Behaviour measured = facts(R"("out_of_range": "clamp", "index_only_access": false,
      "slow_speed": "turns_slowest", "rom_write_time": "80ms")");
  CHECK(measured.out_of_range == OutOfRange::clamp);
  CHECK_FALSE(measured.index_only_access);
  CHECK(measured.slow_speed == SlowSpeed::turns_slowest);
  CHECK(measured.rom_write_time == 80ms);
  CHECK(measured.reserved_reads == Behaviour{}.reserved_reads);
  CHECK(measured.answers_save_first == Behaviour{}.answers_save_first);
}

TEST_CASE("what a scenario says of a servo's behaviour stands above the facts, key by key") {
  Behaviour measured =
      facts(R"("out_of_range": "clamp", "gated_reads": "zero", "failures_latch": true,
               "unused_fields": "zero", "rom_write_time": "80ms")");
  const auto parsed = parse_scenario(R"({"schema": "blactl-scenario/1", "servos": [
      {"model": "BLA21-12U-AB", "behaviour": {"out_of_range": "refuse", "gated_reads": "fail",
          "failures_latch": false, "unused_fields": "unknown", "rom_write_time": "20ms"}},
      {"model": "BLA21-12U-AB", "behaviour": {"notices_warn": true}},
      {"model": "BLA21-12U-AB"}]})",
                                     "test.json", testing::profiles(), measured);
  REQUIRE(parsed);
  const Behaviour& own = parsed->servos[0].behaviour;
  CHECK(own.out_of_range == OutOfRange::refuse);
  CHECK(own.gated_reads == MissingRead::fail);
  CHECK_FALSE(own.failures_latch);
  CHECK(own.unused_fields == UnusedFields::unknown);
  CHECK(own.rom_write_time == 20ms);
  CHECK(parsed->servos[1].behaviour.notices_warn);
  for (const std::size_t i : {1U, 2U}) {
    const Behaviour& usual = parsed->servos[i].behaviour;
    CHECK(usual.out_of_range == OutOfRange::clamp);
    CHECK(usual.gated_reads == MissingRead::zero);
    CHECK(usual.failures_latch);
    CHECK(usual.unused_fields == UnusedFields::zero);
    CHECK(usual.rom_write_time == 80ms);
  }
  const auto standard = default_scenario(testing::profiles(), measured);
  REQUIRE(standard);
  CHECK(standard->servos[2].behaviour.out_of_range == OutOfRange::clamp);
}

TEST_CASE("every fault of a facts file is named with file, line, pointer and reason") {
  const std::string message = faults(R"({
  "schema": "blactl-facts/1",
  "behaviour": {
    "out_of_range": "wrap",
    "rom_write_time": "11s",
    "colour": "red"
  },
  "servos": []
})");
  CHECK(has(message, "facts.json:4: /behaviour/out_of_range: "));
  CHECK(has(message, "facts.json:5: /behaviour/rom_write_time: "));
  CHECK(has(message, "facts.json:6: /behaviour/colour: this key is not known; known here: "));
  CHECK(has(message, "facts.json:8: /servos: "));
  CHECK(has(faults(R"({"schema": "blactl-scenario/1", "behaviour": {}})"), "/schema"));
  CHECK(has(faults(R"({"schema": "blactl-facts/1"})"), "behaviour"));
  CHECK(has(faults("{"), "facts.json:1"));
  const auto absent = read_facts("/nonexistent/facts.json");
  REQUIRE_FALSE(absent);
  CHECK(absent.error().code == Code::bad_file);
}
