// The published schemas know the same keys as the reader: what each object takes is what the reader
// names beside an unknown key.

#include "blactl/sim/scenario/facts.hpp"
#include "blactl/sim/scenario/scenario.hpp"
#include "blactl/sim/scenario/world_change.hpp"

#include "unit/sim/support.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <set>

using namespace blactl;
using namespace blactl::sim;

namespace {

using Keys = std::set<std::string>;

nlohmann::json schema(const std::string& name) {
  std::ifstream file(std::string(BLACTL_SCHEMAS) + "/" + name);
  REQUIRE(file);
  return nlohmann::json::parse(file);
}

/// "a, b, c" up to the end of the line.
Keys listed(std::string_view text) {
  text = text.substr(0, text.find('\n'));
  Keys keys;
  while (!text.empty()) {
    const auto comma = text.find(", ");
    keys.emplace(text.substr(0, comma));
    text = comma == std::string_view::npos ? "" : text.substr(comma + 2);
  }
  return keys;
}

/// What the reader names beside the key "unknown" of a file; the file has no other unknown key.
template <class Value> Keys known(const Result<Value>& parsed) {
  constexpr std::string_view before = "known here: ";
  REQUIRE_FALSE(parsed);
  const std::string& message = parsed.error().message;
  INFO(message);
  const auto at = message.find(before);
  REQUIRE(at != std::string::npos);
  return listed(std::string_view(message).substr(at + before.size()));
}

Keys known_in_scenario(std::string_view members) {
  return known(parse_scenario(fmt::format(R"({{"schema": "blactl-scenario/1", {}}})", members),
                              "test.json", testing::profiles()));
}

Keys known_in_servo(std::string_view member) {
  return known_in_scenario(fmt::format(R"("servos": [{{"model": "BLA21-12U-AB", {}}}])", member));
}

/// The keys of the object that a schema describes, those that it forbids left out.
Keys described(const nlohmann::json& object) {
  Keys keys;
  for (const auto& [key, value] : object.at("properties").items()) {
    keys.insert(key);
  }
  CHECK(object.at("additionalProperties") == false);
  return keys;
}

} // namespace

TEST_CASE("the schema of scenarios has the keys that the reader has") {
  const nlohmann::json scenario = schema("scenario.schema.json");
  const auto& parts = scenario.at("$defs");
  CHECK(described(scenario) == known_in_scenario(R"("unknown": 0)"));
  CHECK(described(parts.at("servo")) == known_in_servo(R"("unknown": 0)"));
  CHECK(described(parts.at("behaviour")) == known_in_servo(R"("behaviour": {"unknown": 0})"));
  CHECK(described(parts.at("servo_faults")) == known_in_servo(R"("faults": {"unknown": 0})"));
  CHECK(described(parts.at("sending")) == known_in_servo(R"("sending": {"unknown": 0})"));
  CHECK(described(parts.at("wire")) == known_in_scenario(R"("wire": {"unknown": 0})"));
  CHECK(described(parts.at("commands")) ==
        known_in_scenario(R"("foreign": [{"kind": "node", "node_id": 1,
                             "commands": {"servo_ids": [1], "unknown": 0}}])"));
  CHECK(described(parts.at("world")) == [] {
    const auto change = parse_world_change("unknown", "");
    REQUIRE_FALSE(change);
    const std::string& hint = change.error().hint;
    return listed(std::string_view(hint).substr(hint.find("are ") + 4));
  }());
  Keys event = known_in_scenario(R"("events": [{"clients": "cut", "unknown": 0}])");
  event.merge(known_in_scenario(R"("servos": [{"model": "BLA21-12U-AB"}],
      "events": [{"servo": 240900001, "world": {}, "unknown": 0}])"));
  CHECK(described(parts.at("event")) == event);
}

TEST_CASE("the schema of scenarios has the kinds of foreign nodes, and the keys of each") {
  const nlohmann::json scenario = schema("scenario.schema.json");
  const auto& foreign = scenario.at("$defs").at("foreign");
  Keys all;
  for (const std::string kind : foreign.at("properties").at("kind").at("enum")) {
    INFO(kind);
    all.merge(known_in_scenario(
        fmt::format(R"("foreign": [{{"kind": "{}", "node_id": 1, "unknown": 0}}])", kind)));
  }
  CHECK(described(foreign) == all);
}

TEST_CASE("the schema of facts has the keys that the reader has") {
  const nlohmann::json facts = schema("facts.schema.json");
  CHECK(described(facts) ==
        known(parse_facts(R"({"schema": "blactl-facts/1", "behaviour": {}, "unknown": 0})", "x")));
  CHECK(facts.at("properties").at("behaviour").at("$ref") ==
        "scenario.schema.json#/$defs/behaviour");
}

TEST_CASE("every key of behaviour in the schema takes the values that the schema lists") {
  const nlohmann::json scenario = schema("scenario.schema.json");
  const auto& parts = scenario.at("$defs");
  for (const auto& [key, value] : parts.at("behaviour").at("properties").items()) {
    INFO(key);
    std::vector<std::string> values;
    if (value.contains("type")) {
      CHECK(value.at("type") == "boolean");
      values = {"true", "false"};
    } else if (value.contains("enum")) {
      for (const auto& word : value.at("enum")) {
        values.push_back(word.dump());
      }
    } else if (value.at("allOf").at(0).at("$ref") == "#/$defs/missing_read") {
      values = {"\"fail\"", "\"zero\""};
    } else {
      const bool short_time = value.at("allOf").at(0).at("$ref") == "#/$defs/up_to_1_s";
      values = short_time ? std::vector<std::string>{"0", "\"1s\"", "1000000"}
                          : std::vector<std::string>{"0", "\"10s\"", "10000000"};
    }
    for (const std::string& one : values) {
      const auto parsed = parse_facts(
          fmt::format(R"({{"schema": "blactl-facts/1", "behaviour": {{"{}": {}}}}})", key, one),
          "test.json");
      INFO((parsed ? "" : parsed.error().message));
      CHECK(parsed);
    }
  }
}
