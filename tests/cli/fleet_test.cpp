// export and diff: servos as files, and files against servos.

#include "catch.hpp"
#include "fleet.hpp"

#include <algorithm>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

/// Three servos and the file that export makes of them.
struct Exported {
  Exported() {
    const Result result = three_servos().run(bench, {"export", path});
    REQUIRE(result.status == 0);
    CHECK(result.out == path + " written, servos: 3\n");
  }

  /// The file with one setting of one entry changed; null: left out.
  [[nodiscard]] std::string changed(std::size_t entry, const std::string& name,
                                    const nlohmann::ordered_json& value) const {
    auto document = ordered_json(content(path));
    auto& set = document["servos"][entry]["set"];
    value.is_null() ? void(set.erase(name)) : void(set[name] = value);
    return bench.file("changed.json", document.dump(2));
  }

  Bench bench;
  std::string path = (bench.folder() / "fleet.json").string();
};

} // namespace

TEST_CASE("export writes every setting of every servo, and reads well") {
  const Exported exported;
  const auto document = ordered_json(content(exported.path));
  CHECK(keys(document) == std::vector<std::string>{"schema", "servos"});
  REQUIRE(document["servos"].size() == 3);
  const auto& first = document["servos"][0];
  CHECK(keys(first) == std::vector<std::string>{"name", "match", "set", "about"});
  CHECK(first["match"]["unique_id"].get<std::string>().size() == 32);
  CHECK(first["match"]["serial_number"].is_number_integer());
  CHECK(first["set"]["angle_limit_cw"] == "179.9deg");
  CHECK(first["set"]["timeout_action"] == "off");
  CHECK(first["set"]["angle_p_gain"].is_number_integer());
  CHECK(first["set"]["static_node_id"] == 11);
  CHECK(first["about"]["firmware_version"] == 1400);
  CHECK_FALSE(first["set"].contains("command_angle"));
  CHECK(content(exported.path).starts_with("{\n  \"schema\": \"blactl-fleet/1\",\n"));
}

TEST_CASE("what was exported is what the servos hold") {
  const Exported exported;
  const Result same = three_servos().run({"diff", exported.path});
  CHECK(same.status == 0);
  CHECK(contains(same.out, "as in the file (settings: 3"));
  const Result piped = three_servos().run({"export"});
  REQUIRE(piped.status == 0);
  CHECK(three_servos().run({"diff", "-"}, {.stdin_text = piped.out}).status == 0);
}

TEST_CASE("export writes all of 0x20 to 0x46 that can be set; IDs are left out of a recipe",
          "[requirement-83]") {
  std::vector<std::string> settings;
  const auto params = ordered_json(three_servos().run({"get", "-n", "11", "--json"}).out);
  for (const auto& param : params["nodes"][0]["params"]) {
    const std::string address = param["address"];
    if (address >= "0x20" && address <= "0x46" && param["access"] == "RW") {
      settings.push_back(param["name"]);
    }
  }
  CHECK(settings.size() == 34);
  const auto written = [](const Arguments& more) {
    Arguments arguments{"export", "-n", "11"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return ordered_json(three_servos().run(arguments).out);
  };
  CHECK(keys(written({})["servos"][0]["set"]) == settings);
  CHECK(settings.back() == "static_node_id");
  settings.resize(settings.size() - 2); // and the servo ID before it
  CHECK(keys(written({"--recipe"})["set"]) == settings);
}

TEST_CASE("a file that names the zeros of a model without PWM input is what the servo holds") {
  const Fleet fleet(Scene().servo("BLA21-12U-A0", 11));
  Document document = fleet.exported();
  document["servos"][0]["match"]["model"] = "BLA21-12U-A0";
  document["servos"][0]["set"].update(
      {{"pwm_neutral", "0us"}, {"pwm_range", "0us"}, {"pwm_output_range", "0deg"}, {"0x37", 0}});
  CHECK(fleet.run({"diff", fleet.file(document)}).status == 0);
  CHECK(statuses(fleet.apply(document)) == std::vector<std::string>{"unchanged"});
  const std::string params = fleet.run({"export", "-n", "11", "--params"}).out;
  CHECK(fleet.run({"diff", fleet.params(params + "0x34 0\n0x35 0\n0x36 0\n0x37 0\n")}).status == 0);
  document["servos"][0]["set"]["pwm_neutral"] = "1520us";
  check_error(fleet.run({"apply", fleet.file(document)}), 2, "bad_file",
              "BLA21-12U-A0 has no PWM input: pwm_neutral (0x34) can only be 0");
}

TEST_CASE("diff tells each register that differs, and counts the others") {
  const Exported exported;
  const std::string file = exported.changed(0, "angle_limit_cw", "45.0deg");
  const Result result = three_servos().run({"diff", file});
  CHECK(result.status == 8);
  CHECK(contains(result.out, "1 of "));
  CHECK(contains(result.out, "angle_limit_cw"));
  CHECK(contains(result.out, "450  (45.0 deg)"));
  CHECK_FALSE(contains(result.out, "angle_limit_ccw"));
  const auto document = json(three_servos().run({"diff", file, "--json"}).out);
  CHECK(document["counts"]["differences"] == 1);
  const auto& node = document["nodes"][0];
  CHECK(node["status"] == "different");
  CHECK(document["nodes"][1]["status"] == "unchanged");
  for (const auto& change : node["changes"]) {
    const bool differs = change["name"] == "angle_limit_cw";
    CHECK(change["status"] == (differs ? "planned" : "unchanged"));
    CHECK((change["before"] == change["requested"]) != differs);
  }
}

TEST_CASE("a servo that is not there, and one that is in no entry, are differences") {
  const Exported exported;
  const std::string uid = "77000000000000000000000000000000";
  Scene two = Scene().servo("BLA21-12U-AB", 11, {{"servo_id", 1}});
  const Result result =
      two.servo("BLA21-12U-AB", 40, {{"servo_id", 9}, {"serial_number", 77}, {"unique_id", uid}})
          .run({"diff", exported.path, "--json"});
  CHECK(result.status == 8);
  const auto nodes = json(result.out)["nodes"];
  std::vector<std::string> statuses;
  for (const auto& node : nodes) {
    statuses.push_back(node["status"]);
  }
  CHECK(std::ranges::count(statuses, "missing") == 2);
  CHECK(std::ranges::count(statuses, "extra") == 1);
}

TEST_CASE("while a servo does not say who it is, no entry is told to be without its servo") {
  const Exported exported;
  Scene two = Scene().servo("BLA21-12U-AB", 11, {{"servo_id", 1}});
  const Result result = two.servo("BLA21-12U-AB", 12, {{"faults", {{"mute", true}}}})
                            .run({"diff", exported.path, "--json"});
  CHECK(result.status == 6); // the first one was compared
  CHECK(contains(result.err, "node 12 is on the bus, but has not said who it is"));
  const auto nodes = json(result.out)["nodes"];
  REQUIRE(nodes.size() == 3);
  for (const auto& node : nodes) {
    CHECK(node["status"] != "missing");
    CHECK(node["status"] != "extra");
  }
}

TEST_CASE("with -n only those servos are compared") {
  const Exported exported;
  const std::string file = exported.changed(0, "angle_limit_cw", "45.0deg");
  const Result others = three_servos().run({"diff", "-n", "12,13", file});
  CHECK(others.status == 0);
  CHECK(contains(others.out, "left out (-n)"));
  CHECK(three_servos().run({"diff", "-n", "11", file}).status == 8);
  check_error(three_servos().run({"diff", "-n", "55", file}), 4, "not_found", "55");
}

TEST_CASE("two files are compared without a bus, also registers that one of them lacks") {
  const Exported exported;
  CHECK(exported.bench.run({"diff", exported.path, exported.path}).status == 0);
  check_error(exported.bench.run({"diff", "-n", "11", exported.path, exported.path}), 2, "usage",
              "leave -n out");
  const std::string other = exported.changed(1, "smoothing", nullptr);
  const Result result = exported.bench.run({"diff", exported.path, other, "--json"});
  CHECK(result.status == 8);
  const auto document = json(result.out);
  CHECK(document["counts"]["differences"] == 1);
  CHECK(document["nodes"][1]["status"] == "different");
  const Result text = exported.bench.run({"diff", exported.path, other});
  CHECK(contains(text.out, "smoothing"));
}

TEST_CASE("entries of two files are paired by unit before they are paired by name, each once") {
  const Bench bench;
  const auto file = [&](const std::string& name, const std::string& servos) {
    return bench.file(name, R"({"schema": "blactl-fleet/1", "servos": [)" + servos + "]}");
  };
  // The servos of left and right were exchanged, that of the tail was replaced.
  const std::string before = file("before.json", R"(
      {"name": "left", "match": {"serial_number": 1}, "set": {"smoothing": "on"}},
      {"name": "tail", "match": {"serial_number": 3}, "set": {"smoothing": "on"}},
      {"name": "right", "match": {"serial_number": 2}, "set": {"smoothing": "off"}})");
  const std::string after = file("after.json", R"(
      {"name": "right", "match": {"serial_number": 1}, "set": {"smoothing": "on"}},
      {"name": "left", "match": {"serial_number": 2}, "set": {"smoothing": "off"}},
      {"name": "tail", "match": {"serial_number": 4}, "set": {"smoothing": "on"}})");
  CHECK(bench.run({"diff", before, after}).status == 0);
  // Unit 1 is called left there: nothing is left for the entry that is called so here.
  const std::string young = file("young.json", R"(
      {"name": "left", "match": {"serial_number": 5}, "set": {"smoothing": "on"}},
      {"name": "right", "match": {"serial_number": 1}, "set": {"smoothing": "on"}})");
  const std::string old = file("old.json", R"(
      {"name": "left", "match": {"serial_number": 1}, "set": {"smoothing": "on"}})");
  const auto document = json(bench.run({"diff", young, old, "--json"}).out);
  REQUIRE(document["nodes"].size() == 2);
  CHECK(document["nodes"][0]["status"] == "missing");
  CHECK(document["nodes"][1]["status"] == "unchanged");
}

TEST_CASE("a fleet file with faults is refused whole, with all of them, and nothing is sent") {
  const Exported exported;
  auto document = ordered_json(content(exported.path));
  document["servos"][0]["set"]["angle_limit_cw"] = 90;
  document["servos"][1]["colour"] = "red";
  const std::string file = exported.bench.file("bad.json", document.dump(2));
  const Result result = exported.bench.run({"-i", "nosuchcan0", "diff", file});
  CHECK(result.status == 2);
  CHECK(codes(result) == std::vector<std::string>{"bad_file"});
  CHECK(contains(result.err, "/servos/0/set/angle_limit_cw: "));
  CHECK(contains(result.err, "/servos/1/colour: "));
  check_error(exported.bench.run({"diff", "-", "-"}), 2, "usage", "stdin");
  check_error(exported.bench.run({"diff", file, file, file}), 2, "usage", "not 3");
}

TEST_CASE("a fleet file with twenty faults: twenty places are named, and nothing is sent") {
  const std::string file = BLACTL_TEST_DATA "/faulty/fleet.json";
  for (const auto* command : {"apply", "diff"}) {
    const Result result = run({"-i", "nosuchcan0", command, file});
    CHECK(result.status == 2);
    for (int entry = 0; entry < 20; ++entry) {
      const int line = entry + 3;
      INFO(line);
      CHECK(contains(result.err,
                     file + ":" + std::to_string(line) + ": /servos/" + std::to_string(entry)));
    }
    const std::string start = file + ":";
    std::size_t places = 0;
    for (auto at = result.err.find(start); at != std::string::npos;
         at = result.err.find(start, at + 1)) {
      ++places;
    }
    CHECK(places == 20);
  }
}

TEST_CASE("export leaves the file as it was where not everything was read") {
  const Exported exported;
  const std::string before = content(exported.path);
  const Scene mute = three_servos().servo("BLA21-12U-AB", 14, {{"faults", {{"mute", true}}}});
  const Result result = mute.run(exported.bench, {"export", exported.path, "-n", "11,14"});
  CHECK(result.status != 0);
  CHECK(content(exported.path) == before);
  check_error(three_servos().run({"export", "/nonexistent/x.json"}), 1, "io", "/nonexistent");
  check_error(three_servos().run({"export", "--json"}), 2, "usage", "--json reports");
}

TEST_CASE("a recipe is of one servo and has no IDs") {
  const Result result = three_servos().run({"export", "--recipe", "-n", "11"});
  REQUIRE(result.status == 0);
  const auto recipe = ordered_json(result.out);
  CHECK(keys(recipe) == std::vector<std::string>{"schema", "name", "model", "firmware_min", "set"});
  CHECK(recipe["model"] == "BLA21-12U-AB");
  CHECK_FALSE(recipe["set"].contains("servo_id"));
  CHECK_FALSE(recipe["set"].contains("static_node_id"));
  check_error(three_servos().run({"export", "--recipe"}), 2, "usage",
              "--recipe makes a file of one servo, not of 3");
}

TEST_CASE("export asks on a terminal before it replaces a file of something else") {
  const Fleet fleet(Scene().servo("BLA21-12U-AB", 11));
  const std::string notes = fleet.bench().file("notes.txt", "do not lose this");
  const Options no{.answers = {{"[y/N]", "n\n"}}, .terminal = true};
  CHECK(fleet.run({"export", notes}, no).status == 7);
  CHECK(content(notes) == "do not lose this");
  CHECK(fleet.run({"export", notes}, {.answers = {{"[y/N]", "y\n"}}, .terminal = true}).status ==
        0);
  CHECK(fleet.run({"export", notes}, {.terminal = true}).status == 0); // of the same servo
  CHECK(fleet.run({"export", notes}).status == 0);                     // a script is not asked
}

TEST_CASE("export replaces a parameter file of the same servo, and a recipe without counters") {
  const Fleet fleet(Scene()
                        .servo("BLA21-12U-AB", 11, {{"servo_id", 1}})
                        .servo("BLA21-12U-AB", 12, {{"servo_id", 2}}));
  const Options no{.answers = {{"[y/N]", "n\n"}}, .terminal = true};
  const std::string params = fleet.file_name("a.param");
  REQUIRE(fleet.run({"export", params, "--params", "-n", "11"}).status == 0);
  CHECK(fleet.run({"export", params, "--params", "-n", "11"}, {.terminal = true}).status == 0);
  const Result other = fleet.run({"export", params, "--params", "-n", "12"}, no);
  CHECK(other.status == 7);
  CHECK_FALSE(contains(other.err, "not everything was read"));
  const std::string recipe = fleet.file_name("a.json");
  REQUIRE(fleet.run({"export", recipe, "--recipe", "-n", "11"}).status == 0);
  CHECK(fleet.run({"export", recipe, "--recipe", "-n", "12"}, {.terminal = true}).status == 0);
  const std::string own = fleet.bench().file("own.json", R"({"schema": "blactl-recipe/1",
      "name": "BLA21-12U-AB", "model": "BLA21-12U-AB", "set": {"servo_id": {"first": 1}}})");
  CHECK(fleet.run({"export", own, "--recipe", "-n", "12"}, no).status == 7);
}

TEST_CASE("15.0 deg and 150 rpm are not the same, though their number is") {
  const Fleet fleet(Scene().servo("BLA21-12U-AB", 11));
  REQUIRE(
      fleet.run({"set", "-n", "11", "pwm_mode=speed", "pwm_output_range=150rpm", "--save", "-y"})
          .status == 0);
  const auto file = [&](const char* range) {
    Document document = fleet.exported();
    document["servos"][0]["set"] = {{"pwm_output_range", range}};
    return fleet.bench().file(std::string(range) + ".json", document.dump());
  };
  const std::string angle = file("15.0deg");
  const std::string speed = file("150rpm");
  CHECK(fleet.run({"diff", speed}).status == 0);
  CHECK(fleet.run({"apply", speed, "-y"}).status == 0);
  const char* why = "this servo has pwm_mode=speed, the unit is rpm";
  check_error(fleet.run({"diff", angle}), 2, "usage", why);
  check_error(fleet.run({"apply", angle, "-y"}), 2, "usage", why);
  check_error(fleet.run({"set", "-n", "11", "pwm_output_range=15.0deg", "--save", "-y"}), 2,
              "usage", why);
  CHECK(fleet.run({"diff", angle, speed}).status == 8);
}
