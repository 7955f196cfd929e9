// A register that only one series has, described by --profile-dir: a setting as any other.

#include "fleet.hpp"

#include <filesystem>
#include <string>

using namespace blactl::test;

namespace {

/// The built-in profile of BLA21, and in it my_param at 0x47: 7 from the factory, 0 to 9.
std::string bla21(bool saved = true) {
  auto profile =
      nlohmann::json::parse(content(std::filesystem::path(BLACTL_PROFILES) / "BLA21.json"));
  profile["parameters"]["0x47"] = {{"name", "my_param"}, {"group", "option"}, {"name_en", "Mine"},
                                   {"name_ja", "独自"},  {"access", "RW"},    {"width", "uint8"},
                                   {"default", 7},       {"min", 0},          {"max", 9},
                                   {"saved", saved}};
  return profile.dump();
}

struct ProfileFolder {
  explicit ProfileFolder(bool saved = true) { (void)bench.file("BLA21.json", bla21(saved)); }

  Bench bench;
};

/// 11 has my_param, 12 has not.
struct TwoSeries : ProfileFolder {
  explicit TwoSeries(const nlohmann::json& more = {})
      : fleet(Scene().servo("BLA21-12U-AB", 11, more).servo("BLA15-06U-A0", 12),
              {"--profile-dir", bench.folder()}) {}

  Fleet fleet;
};

/// The fleet file of both, with 11's my_param, or with it for both.
Document changed(Document document, int value, bool common = false) {
  (common ? document["common"] : document["servos"][0]["set"])["my_param"] = value;
  if (common) {
    document["servos"][0]["set"].erase("my_param");
  }
  return document;
}

} // namespace

TEST_CASE("get finds the register of one series by name and address, where a servo has it") {
  const TwoSeries two;
  for (const char* name : {"my_param", "my-param", "0x47"}) {
    CHECK(two.fleet.ram("11", name) == 7);
  }
  const Result all = two.fleet.run({"get", "--json"});
  CHECK(all.status == 0);
  CHECK(contains(json(all.out)["nodes"][0].dump(), "my_param"));
  CHECK_FALSE(contains(json(all.out)["nodes"][1].dump(), "my_param"));
}

TEST_CASE("a servo of another series is said to lack it, and hides nothing of those that have it") {
  const TwoSeries two;
  check_error(two.fleet.run({"get", "my_param", "-n", "12"}), 2, "unsupported",
              "node 12: BLA15-06U-A0 has no parameter my_param (0x47)");
  const Result both = two.fleet.run({"get", "my_param", "-n", "11,12", "--json"});
  CHECK(both.status == 6);
  CHECK(json(both.out)["nodes"][0]["params"][0]["raw"] == 7);
}

TEST_CASE("without its profile the register is unknown, and nothing is asked of a servo") {
  const Scene scene = Scene().servo("BLA21-12U-AB", 11);
  check_error(scene.run({"get", "my_param"}), 2, "unknown_parameter", "my_param");
  check_error(scene.run({"set", "0x47=5"}), 2, "unsupported", "0x47");
}

TEST_CASE("set --save keeps it, and the range is that of the profile") {
  const TwoSeries two;
  const Result set = two.fleet.run({"set", "my_param=5", "-n", "11", "--save", "-y"});
  INFO(set.err);
  CHECK(set.status == 0);
  CHECK(two.fleet.rom("11", "my_param") == 5);
  check_error(two.fleet.run({"set", "my_param=10", "-n", "11"}), 2, "out_of_range", "my_param");
  check_error(two.fleet.run({"set", "my_param=4", "-n", "12"}), 2, "unsupported",
              "BLA15-06U-A0 has no parameter my_param (0x47)");
  CHECK(two.fleet.run({"set", "my_param=4", "-n", "11,12"}).status == 2);
  CHECK(two.fleet.ram("11", "my_param") == 5);
}

TEST_CASE("erase sets its default, and save keeps that") {
  const TwoSeries two(nlohmann::json{{"rom", {{"my_param", 3}}}});
  CHECK(two.fleet.ram("11", "my_param") == 3);
  CHECK(two.fleet.run({"erase", "--keep-ids", "--save", "-n", "11", "-y"}).status == 0);
  CHECK(two.fleet.rom("11", "my_param") == 7);
}

TEST_CASE("export writes it, apply brings and proves it, diff sees it, undo takes it back") {
  TwoSeries two;
  const Document exported = two.fleet.exported();
  CHECK(exported["servos"][0]["set"]["my_param"] == 7);
  CHECK_FALSE(exported["servos"][1]["set"].contains("my_param"));
  CHECK(two.fleet.apply(exported).status == 0);

  const Document wished = changed(exported, 5);
  CHECK(two.fleet.run({"diff", two.fleet.file(wished)}).status == 8);
  const Result applied = two.fleet.apply(wished);
  INFO(applied.err);
  CHECK(applied.status == 0);
  const auto node = json(applied.out)["nodes"][0];
  CHECK(node["saved"] == true);
  CHECK(node["verified_after_restart"] == true);
  const auto& changes = node["changes"];
  const auto own = std::ranges::find(changes, "my_param", [](auto& each) { return each["name"]; });
  REQUIRE(own != changes.end());
  CHECK((*own)["before"] == 7);
  CHECK((*own)["after"] == 5);
  CHECK(two.fleet.run({"diff", two.fleet.file(wished)}).status == 0);
  CHECK(two.fleet.rom("11", "my_param") == 5);
  CHECK(statuses(two.fleet.apply(wished)) == std::vector<std::string>{"unchanged", "unchanged"});

  CHECK(two.fleet.run({"undo", "-y"}).status == 0);
  CHECK(two.fleet.rom("11", "my_param") == 7);
  CHECK(two.fleet.rom_writes() == 2);
}

TEST_CASE("apply saves what RAM holds already and ROM does not") {
  TwoSeries two;
  const Document wished = changed(two.fleet.exported(), 5);
  CHECK(two.fleet.run({"set", "my_param=5", "-n", "11"}).status == 0);
  CHECK(two.fleet.apply(wished).status == 0);
  CHECK(two.fleet.rom("11", "my_param") == 5);
}

TEST_CASE("a plan holds it") {
  const TwoSeries two;
  const Result planned = two.fleet.run(
      {"apply", two.fleet.file(changed(two.fleet.exported(), 5)), "--dry-run", "--json"});
  REQUIRE(planned.status == 8);
  const std::string plan = two.fleet.plan(ordered_json(planned.out));
  CHECK(two.fleet.run({"apply", "--plan", plan, "-y"}).status == 0);
  CHECK(two.fleet.rom("11", "my_param") == 5);
}

TEST_CASE("a file that wishes it for a servo without it is refused as a whole, and names both") {
  TwoSeries two;
  const Document common = changed(two.fleet.exported(), 5, true);
  for (const Arguments& more : {Arguments{}, Arguments{"--dry-run"}}) {
    const Result refused = two.fleet.apply(common, more);
    CHECK(refused.status == 2);
    CHECK(contains(refused.err, "[unsupported]"));
    CHECK(contains(refused.err, "BLA15-06U-A0 has no parameter my_param (0x47)"));
  }
  const Result differs = two.fleet.run({"diff", two.fleet.file(common)});
  CHECK(differs.status == 6);
  CHECK(contains(differs.err, "node 12: BLA15-06U-A0 has no parameter my_param (0x47)"));
  CHECK(two.fleet.ram("11", "my_param") == 7);
  CHECK(two.fleet.rom_writes() == 0);
}

TEST_CASE("a file that names the model is checked against it without a bus") {
  const ProfileFolder profiles;
  const auto file = [&](const std::string& model) {
    Document document = {{"schema", "blactl-fleet/1"}, {"common", {{"my_param", 5}}}};
    document["servos"] = Document::array();
    document["servos"].push_back({{"name", "one"}, {"match", {{"model", model}}}});
    return profiles.bench.file(model + ".txt", document.dump());
  };
  const auto compared = [&](const std::string& model) {
    return profiles.bench.run(
        {"diff", file("BLA21-12U"), file(model), "--profile-dir", profiles.bench.folder()});
  };
  CHECK(compared("BLA21").status == 0);
  check_error(compared("BLA15-06U-A0"), 2, "bad_file",
              "BLA15-06U-A0 has no parameter my_param (0x47)");
}

TEST_CASE("a recipe and a parameter file hold it") {
  const TwoSeries two(nlohmann::json{{"rom", {{"0x47", 3}}}});
  CHECK(contains(two.fleet.run({"export", "-n", "11", "--recipe"}).out, "\"my_param\": 3"));
  const Result params = two.fleet.run({"export", "-n", "11", "--params"});
  CHECK(contains(params.out, "\n0x47 3\n"));
  CHECK(two.fleet.run({"set", "my_param=1", "-n", "11", "--save", "-y"}).status == 0);
  CHECK(two.fleet.run({"apply", two.fleet.params(params.out), "-n", "11", "-y"}).status == 0);
  CHECK(two.fleet.rom("11", "my_param") == 3);
}

TEST_CASE("what the profile does not mark as saved is no setting, wherever its address is") {
  const ProfileFolder profiles(false);
  const Fleet fleet(Scene().servo("BLA21-12U-AB", 11), {"--profile-dir", profiles.bench.folder()});
  const Document exported = fleet.exported();
  CHECK_FALSE(exported["servos"][0]["set"].contains("my_param"));
  const Result refused = fleet.apply(changed(exported, 5));
  CHECK(refused.status == 2);
  CHECK(contains(refused.err, "my_param is not a setting"));
  CHECK(fleet.run({"set", "my_param=5", "-n", "11"}).status == 0);
}

TEST_CASE("models tells who has it") {
  const ProfileFolder profiles;
  const auto told = [&](const std::string& model) {
    return profiles.bench.run({"models", model, "--profile-dir", profiles.bench.folder()}).out;
  };
  CHECK(contains(told("BLA21-12U-AB"), "my_param"));
  CHECK_FALSE(contains(told("BLA15-06U-A0"), "my_param"));
  CHECK(contains(told("BLA21"), "my_param"));
  CHECK_FALSE(contains(told("BLA15"), "my_param"));
  const std::string all = told("all");
  CHECK(all.find("my_param") > all.find("reverse")); // among what differs, with who has it
  CHECK(contains(all, "0x47  my_param\n"));
  check_error(
      profiles.bench.run({"models", "BLA15", "my_param", "--profile-dir", profiles.bench.folder()}),
      2, "unsupported", "BLA15 has no parameter my_param (0x47)");
}

TEST_CASE("a simulated servo of another series has no memory for it") {
  const ProfileFolder profiles;
  const Bench bench; // a profile folder holds nothing else
  const std::string file =
      Scene().servo("BLA15-06U-A0", 12, {{"rom", {{"my_param", 3}}}}).write(bench);
  const Result refused =
      bench.run({"-i", "sim:" + file, "scan", "--profile-dir", profiles.bench.folder()});
  check_error(refused, 2, "bad_file", "BLA15-06U-A0");
}
