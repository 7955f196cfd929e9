#pragma once
// What most tests include, read once for all of them (BLACTL_UNITY): half of a test's compile time.

#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/sim/bus/simulator.hpp"

#include "catch.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <ranges>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

namespace blactl::precompiled {

// Most tests read and compare JSON: instantiated here, it costs once what it would cost in each.
template <class Json> bool instantiate_json(const std::string& text) {
  Json json = Json::parse(text);
  std::ostringstream stream;
  stream << json << json.dump();
  for (const auto& [key, value] : json.items()) {
    stream << key << value.template get<std::string>();
  }
  CHECK(json["key"] == "text");
  CHECK(json.at("key").at(0) == 1);
  CHECK(json == Json::array({1, "two", 3.0, true}));
  CHECK(json == Json{{"key", "text"}, {"number", 1}});
  return std::ranges::find(json, "text") != json.end();
}

inline bool instantiate_json(const std::string& text) {
  return instantiate_json<nlohmann::json>(text) || instantiate_json<nlohmann::ordered_json>(text);
}

} // namespace blactl::precompiled
