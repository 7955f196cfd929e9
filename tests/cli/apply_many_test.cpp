// apply for a whole machine: every model, every parameter, every ID, and the simulator tells what
// each servo's ROM holds.

#include "catch.hpp"
#include "mixed_fleet.hpp"
#include "scene.hpp"

#include <algorithm>
#include <set>
#include <string>

using namespace blactl::test;

namespace {

constexpr int machine = 64;
constexpr int exchanging = machine / 2; // of two that exchange their IDs one is saved twice

/// Address by name, of `get --json` and of the reference alike.
std::map<std::string, std::string> addresses() {
  std::map<std::string, std::string> found;
  const auto document = json(run({"models", "BLA21-12U-AB", "--json"}).out);
  for (const auto& parameter : document["models"][0]["parameters"]) {
    found[parameter["name"]] = parameter["address"];
  }
  return found;
}

/// Whether ROM of every servo holds what the file says of it, and how many values that were.
std::size_t check_rom(const MixedFleet::States& states, const nlohmann::ordered_json& document) {
  static const auto address = addresses();
  std::size_t values = 0;
  for (const auto& entry : document["servos"]) {
    const auto& rom = states.at(entry["match"]["serial_number"])["rom"];
    for (const auto& [name, value] : entry["set"].items()) {
      INFO(entry["name"] << " " << name);
      CHECK(rom.at(address.at(name)) == raw(value));
      ++values;
    }
  }
  return values;
}

/// Of all nodes of a document.
std::set<std::string> ends(const Result& result) {
  std::set<std::string> found;
  const auto document = json(result.out);
  for (const auto& node : document["nodes"]) {
    const bool is_proven = node["verified_after_restart"] == true;
    found.insert(node["status"].get<std::string>() + (is_proven ? ", proven" : ""));
  }
  return found;
}

using Ends = std::set<std::string>;

} // namespace

TEST_CASE("64 servos of all models take a file that changes every parameter and every ID") {
  MixedFleet fleet(machine);
  const auto document = fleet.changed();
  const std::string file = fleet.file(document);

  const Result first = fleet.run({"apply", file, "-y", "--json"});
  INFO(first.err);
  REQUIRE(first.status == 0);
  CHECK(ends(first) == Ends{"changed, proven"});
  CHECK(json(first.out)["counts"]["changed"] == machine);
  const auto changed = fleet.look();
  CHECK(check_rom(changed, document) > machine * std::size_t{30});
  CHECK(fleet.happened("rom_write") == machine + exchanging);
  CHECK(fleet.happened("restart") == machine + exchanging);
  CHECK(std::ranges::all_of(changed, [](const auto& servo) { return servo.second["count"] <= 2; }));
  CHECK(fleet.run({"diff", file}).status == 0);

  const Result second = fleet.run({"apply", file, "-y", "--json"});
  CHECK(second.status == 0);
  CHECK(ends(second) == Ends{"unchanged, proven"});
  static_cast<void>(fleet.look());
  CHECK(fleet.happened("rom_write") == 0);
  CHECK(fleet.happened("restart") == 0);

  // Their ROM may have lost what RAM holds.
  fleet.cycle_power();
  static_cast<void>(fleet.look());
  const Result third = fleet.run({"apply", file, "-y", "--json"});
  INFO(third.err);
  CHECK(third.status == 0);
  CHECK(ends(third) == Ends{"unchanged, proven"});
  check_rom(fleet.look(), document);
  CHECK(fleet.happened("rom_write") == 0);
}
