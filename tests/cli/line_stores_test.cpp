// The ledger and the table of assigned IDs of a line: their copies, their loss, and where they are.

#include "catch.hpp"
#include "line.hpp"

#include <filesystem>
#include <string>
#include <vector>

using namespace blactl::test;

namespace {

namespace fs = std::filesystem;

fs::path counters_of(const Hall& hall) {
  for (const auto& entry : fs::recursive_directory_iterator(hall.bench().folder())) {
    if (entry.path().filename() == "counters.db") {
      return entry.path();
    }
  }
  return {};
}

} // namespace

TEST_CASE("a table of IDs that is behind the ledger gives none, until its copy is put back") {
  const Hall hall({{.serial = 101, .from = 1, .to = 20},
                   {.serial = 102, .from = 25, .to = 45},
                   {.serial = 103, .from = 50, .to = 3000}});
  REQUIRE(hall.provision({"--count", "1"}).status == 0);
  const std::string copy = (hall.bench().folder() / "copy.db").string();
  REQUIRE(hall.run({"ledger", "--backup", copy}).status == 0);
  REQUIRE(fs::exists(copy + ".counters"));
  REQUIRE(hall.provision({"--count", "2"}).status == 0); // the first is still there
  const fs::path table = counters_of(hall);
  const std::string late = (hall.bench().folder() / "late.db").string();
  REQUIRE(hall.run({"ledger", "--backup", late}).status == 0);

  const auto refused = [&] {
    const Result run = hall.provision({"--count", "1"});
    INFO(run.out << run.err);
    CHECK(run.status == 1);
    CHECK(codes(run) == std::vector<std::string>{"state"});
    CHECK(contains(run.err, "ledger --backup"));
    CHECK(json_lines(run.out).size() == 1); // no record
  };
  fs::remove(table); // lost
  refused();
  refused(); // the new one is empty
  fs::copy_file(copy + ".counters", table, fs::copy_options::overwrite_existing); // an old copy
  refused();
  fs::copy_file(late + ".counters", table, fs::copy_options::overwrite_existing);
  const Result run = hall.provision({"--count", "2"});
  INFO(run.out << run.err);
  CHECK(run.status == 0);
  CHECK(json_lines(run.out)[1]["servo_id"] == 3);
}

TEST_CASE("a table of IDs need not know a unit that was taken out") {
  const Hall hall({{.serial = 101, .from = 1, .to = 20}, {.serial = 102, .from = 25, .to = 3000}});
  REQUIRE(hall.provision({"--count", "1"}).status == 0);
  const std::string passed = hall.ledger()[0]["record_id"];
  REQUIRE(hall.run({"ledger", "--scrap", passed, "--reason", "x", "-y"}).status == 0);
  CHECK(hall.provision({"--count", "1"}).status == 0);
}

TEST_CASE("a damaged table of IDs says how it comes back without giving IDs twice") {
  const Hall hall({{.serial = 101, .from = 1, .to = 3000}});
  REQUIRE(hall.provision({"--count", "1"}).status == 0);
  fs::resize_file(counters_of(hall), 5000);
  const Result run = hall.provision({"--count", "1"});
  CHECK(codes(run) == std::vector<std::string>{"bad_file"});
  CHECK(contains(run.err, "ledger --backup"));
  CHECK_FALSE(contains(run.err, "begin with their first ID again"));
}

TEST_CASE("the check of the ledger tells a file that was lost or damaged") {
  const Hall hall({{.serial = 101, .from = 1, .to = 3000}});
  CHECK(hall.run({"ledger", "--check"}).status == 0); // nothing was made yet
  REQUIRE(hall.provision({"--count", "1"}).status == 0);
  REQUIRE(hall.run({"ledger", "--check"}).status == 0);
  const fs::path table = counters_of(hall), ledger = fs::path(table).replace_filename("ledger.db");
  const auto check = [&](const std::string& code, const std::string& file) {
    const Result checked = hall.run({"ledger", "--check"});
    INFO(checked.out << checked.err);
    CHECK(checked.status != 0);
    CHECK(codes(checked) == std::vector{code});
    CHECK(contains(checked.err, file));
    CHECK_FALSE(contains(checked.out, "complete"));
  };
  fs::copy_file(table, hall.bench().folder() / "table");
  fs::remove(table);
  check("state", "counters.db is not there");
  const std::string copy = (hall.bench().folder() / "copy").string();
  for (int i = 0; i < 2; ++i) { // the second time as the first
    CHECK(codes(hall.run({"ledger", "--backup", copy})) == std::vector<std::string>{"state"});
  }
  fs::copy_file(hall.bench().folder() / "table", table);
  fs::resize_file(table, 5000);
  check("bad_file", "counters.db");
  fs::copy_file(hall.bench().folder() / "table", table, fs::copy_options::overwrite_existing);
  CHECK(hall.run({"ledger", "--check"}).status == 0);
  fs::remove(ledger);
  check("state", "ledger.db is not there");
}

TEST_CASE("IDs by labels are not given while the table of IDs is lost") {
  const Hall hall({{.serial = 101, .from = 1, .to = 20}, {.serial = 102, .from = 25, .to = 3000}});
  const std::string recipe = hall.bench().file(
      "labels.json", R"({"schema": "blactl-recipe/1", "name": "labels", "model": "BLA21-12U-AB",
                         "set": {"angle_limit_cw": "45.0deg"}})");
  const auto labelled = [&](const char* label) {
    return hall.run({"provision", recipe, "-y", "--json", "--count", "1", "--label", "-"},
                    {.stdin_text = label});
  };
  REQUIRE(labelled(R"({"serial_number": 101, "servo_id": 7})").status == 0);
  fs::remove(counters_of(hall));
  for (int i = 0; i < 2; ++i) { // no new table is made
    const Result run = labelled(R"({"serial_number": 102, "servo_id": 7})");
    INFO(run.out << run.err);
    CHECK(codes(run) == std::vector<std::string>{"state"});
    CHECK(contains(run.err, "counters.db is not there"));
    CHECK(json_lines(run.out).size() == 1); // no record
  }
}

TEST_CASE("both files of a copy are new ones") {
  const Hall hall({{.serial = 101, .from = 1, .to = 3000}});
  REQUIRE(hall.provision({"--count", "1"}).status == 0);
  const std::string copy = hall.bench().file("copy.db.counters", "mine");
  const std::string name = copy.substr(0, copy.rfind(".counters"));
  CHECK(hall.run({"ledger", "--backup", name}).status == 2);
  CHECK(content(copy) == "mine");
  CHECK_FALSE(fs::exists(name));
}

#ifndef BLACTL_SANITIZED

TEST_CASE("ledger and table of IDs are not kept on a disk of another machine") {
  const Bench bench;
  const Background sim(bench, {"sim", line({{.serial = 101, .from = 1, .to = 3000}}).write(bench)});
  const auto on = [&](const char* type) {
    return bench.run({"-i", "sim:", "provision", bench.file("recipe.json", line_recipe), "-y",
                      "--json", "--count", "1"},
                     {.env = {{"LD_PRELOAD", BLACTL_LINE_CALLS}, {"FAKED_FILES", type}}});
  };
  for (const char* network : {"0x6969", "0xFF534D42", "0xFE534D42", "0x517B"}) {
    INFO(network);
    const Result run = on(network);
    CHECK(run.status == 1);
    CHECK(codes(run) == std::vector<std::string>{"state"});
    CHECK(contains(run.err, "BLACTL_STATE_DIR"));
    CHECK(json_lines(run.out).size() == 1); // no record
  }
  CHECK(on("0x65735546").status == 0); // FUSE may be anything
  CHECK(on("0x6969").status == 1);     // also where they are already
}

#endif
