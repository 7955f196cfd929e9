// Parameter files of the common GUI tools: export --params writes one, diff compares with one.

#include "catch.hpp"
#include "scene.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

using namespace blactl::test;

namespace {

std::string kept(const std::string& name) {
  return std::string(BLACTL_TEST_DATA) + "/params/" + name;
}

/// What the kept files were saved from: the servo of an example.
Scene one_servo() {
  return Scene().servo("BLA21-12U-AB", 11,
                       {{"servo_id", 3}, {"serial_number", 240900558}, {"rom", {{"0x38", 450}}}});
}

} // namespace

TEST_CASE("export --params writes the settings of one servo, a line each") {
  const Result result = three_servos().run({"export", "--params", "-n", "11"});
  REQUIRE(result.status == 0);
  CHECK(result.out.starts_with("# BLA21-12U-AB "));
  CHECK(contains(result.out, "\n0x20 "));
  CHECK(contains(result.out, "\n0x38 1799\n"));
  CHECK(contains(result.out, "\n0x46 11\n"));
  CHECK_FALSE(contains(result.out, "0x00"));
  CHECK_FALSE(contains(result.out, "0x50"));
  check_error(three_servos().run({"export", "--params"}), 2, "usage", "of one servo, not of 3");
  check_error(three_servos().run({"export", "--params", "--recipe", "-n", "11"}), 2, "usage",
              "two forms");
}

TEST_CASE("what export --params wrote is what the servo holds") {
  const Result written = three_servos().run({"export", "--params", "-n", "12"});
  REQUIRE(written.status == 0);
  const Result same = three_servos().run({"diff", "-", "-n", "12"}, {.stdin_text = written.out});
  CHECK(same.status == 0);
  CHECK(contains(same.out, "as in the file"));
  CHECK(same.err.empty());
}

TEST_CASE("an empty file holds no setting") {
  for (const char* text : {"", "\n\n", "# saved by hand\n"}) {
    CAPTURE(text);
    check_error(one_servo().run({"diff", "-"}, {.stdin_text = text}), 2, "bad_file",
                "no setting of a BLA servo");
  }
}

TEST_CASE("diff compares the one servo with what either tool has saved") {
  for (const char* name : {"gui_tool.parm", "mission_planner.param"}) {
    CAPTURE(name);
    const Result same = one_servo().run({"diff", kept(name)});
    CHECK(same.status == 0);
    CHECK(contains(same.err, "skipped, as they are not settings"));
    CHECK(contains(same.err, "0x50"));
    const Result other = one_servo().run({"diff", kept(name), "--json"});
    CHECK(json(other.out)["nodes"][0]["name"] == nullptr);
    CHECK(json(other.out)["nodes"][0]["node_id"] == 11);
    const Result changed =
        Scene().servo("BLA21-12U-AB", 11, {{"servo_id", 3}}).run({"diff", kept(name)});
    CHECK(changed.status == 8);
    CHECK(contains(changed.out, "1 of "));
    CHECK(contains(changed.out, "450  (45.0 deg)"));
  }
}

TEST_CASE("a parameter file does not say which servo it is for") {
  const Bench bench;
  const std::string file = bench.file("wing.param", "0x22,0\n");
  check_error(three_servos().run({"diff", file}), 2, "usage", "nodes 11, 12, 13");
  CHECK(three_servos().run({"diff", file, "-n", "11,12"}).status == 8);
  CHECK(three_servos().run({"diff", file, "-n", "11"}).status == 8);
}

TEST_CASE("parameter files are compared with each other, and with a fleet file of one servo") {
  const Bench bench;
  const std::string one = bench.file("one.param", "0x38,900\n0x22,1\n");
  const std::string other = bench.file("other.parm", "0x38 901\n0x22 1\n");
  CHECK(bench.run({"diff", one, one}).status == 0);
  const Result differs = bench.run({"diff", one, other});
  CHECK(differs.status == 8);
  CHECK(contains(differs.out, "1 of 2"));
  const std::string entry = R"({"name":"aileron","match":{"serial_number":1},)"
                            R"("set":{"0x38":900,"0x22":1}})";
  const std::string head = R"({"schema":"blactl-fleet/1","servos":[)";
  const std::string fleet = bench.file("fleet.json", head + entry + "]}");
  const Result same = bench.run({"diff", one, fleet});
  CHECK(same.status == 0);
  CHECK(contains(same.out, "aileron"));
  CHECK(contains(bench.run({"diff", fleet, other}).out, "aileron"));
  const std::string two =
      bench.file("two.json", head + entry + R"(,{"name":"b","match":{"serial_number":2}}]})");
  check_error(bench.run({"diff", one, two}), 2, "usage", "is of one servo");
}

TEST_CASE("a parameter file with faults is refused whole, and nothing is sent") {
  const Bench bench;
  const std::string file = bench.file("bad.param", "56,900\n0x38,90.0\n0x38,900\n0x39\n");
  const Result result = bench.run({"-i", "nosuchcan0", "diff", file});
  CHECK(result.status == 2);
  CHECK(codes(result) == std::vector<std::string>{"bad_file"});
  CHECK(contains(result.err, "bad.param:1: 56: "));
  CHECK(contains(result.err, "bad.param:2: 0x38: "));
  CHECK(contains(result.err, "bad.param:4: 0x39: "));
  const Result japanese = bench.run({"-i", "nosuchcan0", "--lang", "ja", "diff", file});
  CHECK(contains(japanese.err, "16 進数"));
}
