// characterize of the built binary on simulated servos.

#include "catch.hpp"
#include "scene.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

Scene one_servo(const nlohmann::json& behaviour = nlohmann::json::object(),
                const nlohmann::json& more = {}) {
  nlohmann::json members = more.is_null() ? nlohmann::json::object() : more;
  members["behaviour"] = behaviour.is_null() ? nlohmann::json::object() : behaviour;
  return Scene().servo("BLA21-12U-AB", 11, members);
}

/// The writes of a `trace` of what was recorded: "0x38=900".
std::vector<std::string> writes(const Bench& bench, const std::string& log) {
  std::vector<std::string> found;
  for (const auto& line : json_lines(bench.run({"trace", log, "--json"}).out)) {
    const bool is_request = line.value("kind", "") == "request";
    if (is_request && line["type"] == "uavcan.protocol.param.GetSet" &&
        line["fields"]["value"].contains("integer_value")) {
      found.push_back(line["fields"]["name"].get<std::string>() + "=" +
                      line["fields"]["value"]["integer_value"].dump());
    }
  }
  return found;
}

std::vector<std::string> reads(const Bench& bench, const std::string& log) {
  std::vector<std::string> found;
  for (const auto& line : json_lines(bench.run({"trace", log, "--json"}).out)) {
    const bool is_request = line.value("kind", "") == "request";
    if (is_request && line["type"] == "uavcan.protocol.param.GetSet" &&
        line["fields"]["value"].contains("empty")) {
      found.push_back(line["fields"]["name"].get<std::string>());
    }
  }
  return found;
}

} // namespace

TEST_CASE("characterize prints what it measured, and what it did not with the reason") {
  const Result result =
      one_servo({{"out_of_range", "clamp"}}).run({"characterize", "-n", "11", "-y"});
  INFO(result.out << result.err);
  CHECK(result.status == 0);
  CHECK(contains(result.out, "out_of_range"));
  CHECK(contains(result.out, "clamp"));
  CHECK(contains(result.out, "jp.co.futaba.bla21"));
  CHECK(contains(result.out, "not measured:"));
  CHECK(contains(result.out, "slow_speed"));
  CHECK(contains(result.out, "would take a turning shaft"));
  CHECK(is_fit_for_a_terminal(result.out));
  const Result japanese = one_servo().run({"characterize", "-n", "11", "-y", "--lang", "ja"});
  CHECK(japanese.status == 0);
  CHECK(contains(japanese.out, "測定できなかった項目"));
  CHECK_FALSE(contains(japanese.out, "measured"));
}

TEST_CASE("characterize writes facts that sim loads, and that make a servo just so") {
  const Bench bench;
  const nlohmann::json behaviour{{"out_of_range", "fail"},
                                 {"failure_with_name", true},
                                 {"reserved_reads", "zero"},
                                 {"index_only_access", false},
                                 {"ignores_disabled_commands", false},
                                 {"answers_save_first", false},
                                 {"array_command_shows", false},
                                 {"notices_warn", true},
                                 {"keeps_disabled_command", false},
                                 {"inclusive_limits", false},
                                 {"unused_fields", "zero"},
                                 {"boot_time", "120ms"},
                                 {"rom_write_time", "250ms"},
                                 {"answer_delay", "3ms"}};
  const std::string path = (bench.folder() / "facts.json").string();
  const Result first =
      one_servo(behaviour).run(bench, {"characterize", path, "-n", "11", "-y", "--json"});
  INFO(first.out << first.err);
  REQUIRE(first.status == 0);
  const auto document = ordered_json(first.out);
  REQUIRE(document["nodes"].size() == 1);
  CHECK(keys(document["nodes"][0]) ==
        std::vector<std::string>{"node_id", "unique_id", "model", "serial_number", "servo_id",
                                 "firmware_version", "hardware_version", "file", "status",
                                 "measurements"});
  CHECK(document["nodes"][0]["file"] == path);
  CHECK(document["nodes"][0]["status"] == "done");
  const auto facts = json(content(path));
  for (const auto& [key, value] : behaviour.items()) {
    INFO(key << " " << facts["behaviour"][key]);
    if (value.is_string() && value.get<std::string>().ends_with("ms")) {
      CHECK(facts["behaviour"].contains(key));
    } else {
      CHECK(facts["behaviour"][key] == value);
    }
  }
  for (const auto& each : document["nodes"][0]["measurements"]) {
    const std::string setting = each["setting"];
    CHECK(facts["behaviour"].contains(setting) == !each["value"].is_null());
    CHECK(each["reason"].is_null() == !each["value"].is_null());
  }
  // A servo that is simulated by the facts gives the same facts.
  const std::string again = (bench.folder() / "again.json").string();
  const Background sim(bench,
                       {"sim", Scene().servo("BLA21-12U-AB", 11).write(bench), "--facts", path});
  REQUIRE(bench.run({"-i", "sim:", "characterize", again, "-n", "11", "-y"}).status == 0);
  auto copied = json(content(again))["behaviour"];
  for (const auto& [key, value] : facts["behaviour"].items()) {
    INFO(key);
    if (!value.is_string() || !value.get<std::string>().ends_with("s")) {
      CHECK(copied[key] == value);
    }
  }
}

TEST_CASE("characterize - writes the facts to stdout, and nothing else") {
  const Result result = one_servo().run({"characterize", "-", "-n", "11", "-y"});
  CHECK(result.status == 0);
  CHECK(json(result.out)["schema"] == "blactl-facts/1");
}

TEST_CASE("characterize sends nothing that is forbidden, and 0x27 alone once out of range") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  const Scene scene = one_servo({{"out_of_range", "clamp"}});
  REQUIRE(scene.run(bench, {"characterize", "-n", "11", "-y", "--record", log}).status == 0);
  const auto written = writes(bench, log);
  CHECK(std::ranges::count(written, "0x27=60001") == 1);
  const auto limits = json(bench.run({"models", "BLA21-12U-AB", "--json"}).out)["models"][0];
  for (const std::string& each : written) {
    INFO(each);
    const auto equals = each.find('=');
    const std::string address = each.substr(0, equals);
    const std::int64_t raw = std::stoll(each.substr(equals + 1));
    const auto& all = limits["parameters"];
    const auto found = std::ranges::find_if(
        all, [&](const nlohmann::json& parameter) { return parameter["address"] == address; });
    REQUIRE(found != all.end()); // not reserved
    CHECK((*found)["access"] == "RW");
    if (each != "0x27=60001") {
      CHECK(raw >= (*found)["min"].get<std::int64_t>());
      CHECK(raw <= (*found)["max"].get<std::int64_t>());
    }
  }
  const auto read = reads(bench, log);
  CHECK(std::ranges::count(read, "0x49") == 0);
  CHECK(std::ranges::count(read, "0x12") == 0);
  std::size_t saves = 0;
  for (const auto& line : json_lines(bench.run({"trace", log, "--json"}).out)) {
    saves += line.value("kind", "") == "request" &&
             line["type"] == "uavcan.protocol.param.ExecuteOpcode";
  }
  CHECK(saves == 1);
}

TEST_CASE("characterize asks, and without a terminal the answer is no") {
  const Bench bench;
  const std::string log = (bench.folder() / "bus.log").string();
  const std::string before = R"({"schema": "blactl-facts/1"})"; // as it was
  const std::string path = bench.file("facts.json", before);
  const Result result = one_servo().run(bench, {"characterize", path, "-n", "11", "--record", log});
  CHECK(result.status == 7);
  CHECK(codes(result) == std::vector<std::string>{"not_confirmed"});
  CHECK(contains(result.err, "restarted 3 times"));
  CHECK(contains(result.err, "out of range"));
  CHECK(writes(bench, log).empty());
  CHECK(content(path) == before);
}

TEST_CASE("the question says what happens, to whom it may concern") {
  const Result result = one_servo().run({"characterize", "-n", "11"},
                                        {.answers = {{"[y/N]", "n\n"}}, .terminal = true});
  CHECK(result.status == 7);
  CHECK(contains(result.err, "node 11: measures this servo and leaves nothing changed"));
}

TEST_CASE("characterize takes just one servo") {
  const Result several = three_servos().run({"characterize", "-y"});
  CHECK(several.status == 2);
  CHECK(codes(several) == std::vector<std::string>{"usage"});
  const Result named = three_servos().run({"characterize", "-n", "11,12", "-y"});
  CHECK(named.status == 2);
  CHECK(contains(named.err, "one servo, not 2"));
  CHECK(three_servos().run({"characterize", "-n", "99", "-y"}).status == 4);
  CHECK(one_servo().run({"characterize", "-y"}).status == 0); // the one there is
}

TEST_CASE("characterize leaves a servo alone that is armed, driven or doubled") {
  const auto refused = [](Scene scene, const char* code) {
    const Bench bench;
    const std::string log = (bench.folder() / "bus.log").string();
    const Result result =
        scene.run(bench, {"characterize", "-n", "11", "-y", "--json", "--record", log});
    INFO(code << result.err);
    CHECK(result.status == 9);
    CHECK(json(result.out)["errors"][0]["code"] == code);
    CHECK(writes(bench, log).empty());
  };
  refused(one_servo().foreign(40, {{"armed", true}}), "armed");
  refused(one_servo({}, {{"servo_id", 3}})
              .foreign(40, {{"commands", {{"servo_ids", {3}}, {"type", 1}, {"rate", 20}}}}),
          "driven");
  refused(one_servo().servo("BLA21-12U-AB", 11), "duplicate_node_id");
}

TEST_CASE("characterize refuses a servo that is commanded to turn, and one it does not know") {
  const Result unknown =
      Scene().servo("BLA21-12U-AB", 11, {{"hardware_version", 9}}).run({"characterize", "-y"});
  CHECK(unknown.status == 9);
  CHECK(codes(unknown) == std::vector<std::string>{"no_profile"});
}

TEST_CASE("characterize looks at its file before it looks at the bus") {
  const Result result = one_servo().run({"characterize", "/nowhere/facts.json", "-n", "11", "-y"});
  CHECK(result.status == 1);
  CHECK(codes(result) == std::vector<std::string>{"io"});
}

TEST_CASE("characterize that is interrupted puts back what it changed and says so") {
  const Bench bench;
  const nlohmann::json scenario{
      {"schema", "blactl-scenario/1"},
      {"servos",
       {{{"model", "BLA21-12U-AB"}, {"node_id", 11}, {"ram", {{"angle_limit_cw", "90deg"}}}}}}};
  Background sim(bench, {"sim", "--json", bench.file("scene.json", scenario.dump())});
  const auto ram = [&] {
    return json(bench.run({"-i", "sim:", "get", "-n", "11", "--all", "--json"}).out);
  };
  const auto settings = [](const nlohmann::json& document) {
    std::set<std::string> all;
    for (const auto& each : document["nodes"][0]["params"]) {
      if (each["access"] == "RW") {
        all.insert(each["address"].get<std::string>() + "=" + each["raw"].dump());
      }
    }
    return all;
  };
  const auto before = settings(ram());
  Background command(bench, {"-i", "sim:", "characterize", "-n", "11", "-y", "-v"}, {}, "supply");
  sim.expect("\"restart\"");
  const Result ended = command.stop(SIGINT);
  INFO(ended.err);
  CHECK(ended.status == 130);
  CHECK(contains(ended.err, "putting back what was changed"));
  CHECK(contains(ended.err, "what was changed has been put back"));
  CHECK(settings(ram()) == before);
}

TEST_CASE("characterize moves no servo that tells its servo ID by its register alone") {
  const Bench bench;
  const Background sim(
      bench, {"sim",
              Scene()
                  .servo("BLA21-12U-AB", 11, {{"serial_number", 1}, {"servo_id", 3}})
                  .servo("BLA21-12U-AB", 12,
                         {{"serial_number", 2}, {"faults", {{"no_actuator_status", true}}}})
                  .write(bench),
              "--clock", "virtual"});
  const Result measured = bench.run({"-i", "sim:", "characterize", "-n", "11", "-y"});
  INFO(measured.err);
  CHECK(measured.status == 0);
  const Result other = bench.run({"-i", "sim:", "get", "-n", "12", "command_angle", "--json"});
  CHECK(contains(other.out, "\"raw\": 0"));
}

TEST_CASE("characterize moves no servo that is switched on meanwhile") {
  // the second time just before commands to servo ID 0, which is what a new servo has
  const auto* at = GENERATE("2s", "3.4s");
  const Scene scene = Scene()
                          .servo("BLA21-12U-AB", 11, {{"serial_number", 1}, {"servo_id", 3}})
                          .servo("BLA21-12U-AB", 12, {{"serial_number", 2}})
                          .joins(2, at);
  check_error(scene.run({"characterize", "-n", "11", "-y"}), 9, "duplicate_servo_id",
              "node 12 appeared, restarted or reports servo ID");
}
