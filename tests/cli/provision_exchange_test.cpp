// Servos that follow each other at a station so fast that the bench was never seen empty.

#include "catch.hpp"
#include "line.hpp"
#include "run.hpp"
#include "scene.hpp"

#include <string>
#include <vector>

using namespace blactl::test;

namespace {

/// Two records, with an end for a run that waits in vain.
const Arguments two_records{"--count", "2", "--idle-timeout", "90"};

/// When each of these events happened, by a file of --events; seconds.
std::vector<double> times_of(const std::string& event, const std::string& file) {
  std::vector<double> times;
  for (const auto& line : json_lines(content(file))) {
    if (line["event"] == event) {
      times.push_back(line["time"]);
    }
  }
  return times;
}

const std::string dynamic_recipe = R"({
  "schema": "blactl-recipe/1", "name": "dynamic", "model": "BLA21-12U-AB",
  "set": {"servo_id": {"first": 1, "last": 8}, "angle_limit_cw": "45.0deg"}
})";

} // namespace

TEST_CASE("another unit in the place of the last one begins at once, however fast it came") {
  const double pause = GENERATE(0.1, 0.7, 1.5, 2.5);
  const int node_id = GENERATE(11, 1, 0); // that of the one before, another, none
  INFO(pause << " s, node ID " << node_id);
  const Provisioned run =
      provision(line({{.serial = 101, .from = 1, .to = 30, .node_id = 11},
                      {.serial = 102, .from = 30 + pause, .to = 70, .node_id = node_id}}),
                two_records);
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 11; pass 2 12");
  CHECK(run.records.back()["serial_number"] == 102);
  CHECK(run.result.status == 0);
}

TEST_CASE("another unit that came as soon as the last one had passed begins at once") {
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 8, .node_id = 11},
                                          {.serial = 102, .from = 8.3, .to = 16, .node_id = 11},
                                          {.serial = 103, .from = 16.3, .to = 60, .node_id = 12}}),
                                    {"--count", "3", "--idle-timeout", "90"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 11; pass 2 12; pass 3 13");
}

TEST_CASE("the unit that has ended is that also after a restart") {
  const double pause = GENERATE(0.1, 1.0, 2.5);
  INFO(pause);
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 30, .node_id = 11},
                                          {.serial = 101, .from = 30 + pause, .to = 60},
                                          {.serial = 102, .from = 70, .to = 100, .node_id = 11}}),
                                    two_records);
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 11; pass 2 12");
}

TEST_CASE("the unit that has ended is that also if it asks for a node ID again") {
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 30},
                                          {.serial = 101, .from = 30.5, .to = 60},
                                          {.serial = 102, .from = 60.5, .to = 100}}),
                                    two_records, {}, dynamic_recipe);
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 0; pass 2 0");
  CHECK(run.records.back()["serial_number"] == 102);
}

TEST_CASE("a unit that comes while the one before is still there is told at once") {
  const int node_id = GENERATE(0, 1);
  INFO(node_id);
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 50, .node_id = 11},
                                          {.serial = 102, .from = 30, .to = 50, .node_id = node_id},
                                          {.serial = 102, .from = 60, .to = 100}}),
                                    two_records);
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 11; error several_servos; pass 2 12");
}

TEST_CASE("a unit that came while the one before was worked on is told") {
  const auto [from, expected] =
      GENERATE(table<double, std::string>({{4.0, "error several_servos; pass 2 12"}, // before SAVE
                                           {5.0, "pass 1 11; error several_servos; pass 2 12"},
                                           {6.5, "pass 1 11; error several_servos; pass 2 12"}}));
  INFO(from << " s");
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 50, .node_id = 11},
                                          {.serial = 102, .from = from, .to = 50, .node_id = 8},
                                          {.serial = 103, .from = 60, .to = 100, .node_id = 5}}),
                                    {"--count", "2", "--idle-timeout", "90"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == expected);
}

TEST_CASE(
    "another unit that ran on a supply of its own, for as long as the last one, begins at once") {
  const Scene scene = Scene()
                          .servo("BLA34-12U-AB", 11, {{"serial_number", 101}})
                          .servo("BLA21-12U-AB", 11, {{"serial_number", 102}})
                          .world(102, {{"plugged", "off"}}, "0s")
                          .world(101, {{"plugged", "off"}}, "30s")
                          .world(102, {{"plugged", "on"}}, "30600ms");
  const Provisioned run = provision(scene, two_records);
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "fail model_mismatch; pass 1 11");
}

TEST_CASE("units whose unique IDs begin alike are told apart when they ask for a node ID") {
  const std::string alike = "000000000000000000000000000001";
  const Provisioned run = provision(
      line({{.serial = 101, .from = 1, .to = 30, .more = {{"unique_id", alike + "01"}}},
            {.serial = 101, .from = 30.4, .to = 50},
            {.serial = 102, .from = 50.5, .to = 90, .more = {{"unique_id", alike + "02"}}}}),
      two_records, {}, dynamic_recipe);
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 0; pass 2 0");
  CHECK(run.records.back()["node_id"] == 0); // it asked
}

TEST_CASE("an old verdict does not stand over another unit that asks for a node ID") {
  const std::string first = "00000000000000000000000000000101";
  const auto [second, delay] = GENERATE(table<std::string, double>({
      {"ff000000000000000000000000000102", 0.7}, // its first request tells that it is another
      {"00000000000000000000000000000102", 1.6}, // all of its unique ID does
  }));
  const double pause = GENERATE(0.1, 1.0, 2.0);
  INFO(second << " after " << pause << " s");
  const Bench bench;
  const std::string events = (bench.folder() / "events").string();
  const Provisioned run = provision(
      line({{.serial = 101, .from = 1, .to = 30, .more = {{"unique_id", first}}},
            {.serial = 102, .from = 30 + pause, .to = 90, .more = {{"unique_id", second}}}}),
      {"--count", "2", "--idle-timeout", "90", "--events", events}, {}, dynamic_recipe);
  INFO(run.result.out << run.result.err << content(events));
  CHECK(run.told() == "pass 1 0; pass 2 0");
  const auto recognised = times_of("recognised", events);
  REQUIRE(recognised.size() >= 2);
  CHECK(recognised[1] - recognised[0] < 29 + pause + delay); // as long after it came as the first
  for (const double waits : times_of("waiting", events)) {   // nobody shall connect one more
    CHECK((waits < recognised[0] || waits - recognised[1] < 0.01));
  }
}

TEST_CASE("another unit that asks for a node ID beside the last one is told at once") {
  const std::string alike = "000000000000000000000000000001";
  const Bench bench;
  const std::string events = (bench.folder() / "events").string();
  const Provisioned run =
      provision(line({{.serial = 101, .from = 1, .to = 50, .more = {{"unique_id", alike + "01"}}},
                      {.serial = 102, .from = 30, .to = 50, .more = {{"unique_id", alike + "02"}}},
                      {.serial = 102, .from = 60, .to = 90}}),
                {"--count", "2", "--idle-timeout", "90", "--events", events}, {}, dynamic_recipe);
  INFO(run.result.out << run.result.err << content(events));
  CHECK(run.told() == "pass 1 0; error several_servos; pass 2 0");
  const auto told = times_of("error", events);
  REQUIRE(told.size() == 1);
  CHECK(told[0] - times_of("recognised", events).at(0) < 29 + 0.7);
}

TEST_CASE("a result stands until its unit is off the bench, whatever lies beside it") {
  const double from = GENERATE(5.0, 6.5, 15.0); // in the work on the other one, after it
  const int node_id = GENERATE(8, 0);
  INFO(from << " " << node_id);
  const Bench bench;
  const std::string events = (bench.folder() / "events").string();
  const Provisioned run =
      provision(line({{.serial = 101, .from = 1, .to = 20, .node_id = 11},
                      {.serial = 102, .from = from, .to = 30, .node_id = node_id},
                      {.serial = 102, .from = 40, .to = 60}}),
                {"--count", "2", "--idle-timeout", "90", "--events", events});
  INFO(run.result.out << run.result.err << content(events));
  CHECK(run.told() == "pass 1 11; error several_servos; pass 2 12");
  const double start = times_of("recognised", events).at(0) - 1; // about
  CHECK(times_of("recognised", events).size() == 2);
  REQUIRE(times_of("other", events).size() == 1);
  CHECK(times_of("other", events)[0] - start > 20 - 0.5);
  CHECK(times_of("other", events)[0] - start < 20 + 0.8);
  REQUIRE(times_of("left", events).size() == 1);
  CHECK(times_of("left", events)[0] - start > 30 - 0.5);
}

TEST_CASE("an empty bench is told within a second, and a unit that is back has to be taken off") {
  const Bench bench;
  const std::string events = (bench.folder() / "events").string();
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 20, .node_id = 11},
                                          {.serial = 101, .from = 22, .to = 30},
                                          {.serial = 102, .from = 31.5, .to = 60}}),
                                    {"--count", "2", "--idle-timeout", "90", "--events", events});
  INFO(run.result.out << run.result.err << content(events));
  CHECK(run.told() == "pass 1 11; pass 2 12");
  constexpr double begin = 1735689600; // of the simulation
  const auto left = times_of("left", events);
  REQUIRE(left.size() == 2);
  CHECK(left[0] - begin > 20);
  CHECK(left[0] - begin < 20.8);
  CHECK(left[1] - begin < 30.8);
  const auto take_off = times_of("take_off", events);
  REQUIRE(take_off.size() == 2);
  CHECK(take_off[1] - begin < 23);
}

TEST_CASE("a label is that of the unit that took the place of the last one") {
  const Provisioned run =
      provision(line({{.serial = 101, .from = 1, .to = 30, .node_id = 11},
                      {.serial = 102, .from = 30.5, .to = 70, .node_id = 11}}),
                {"--label", "-", "--idle-timeout", "90"}, {.stdin_text = "101\n102\n"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 11; pass 2 12");
}

TEST_CASE("a unit that was pulled early is done again as soon as it is back") {
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 4, .node_id = 7},
                                          {.serial = 101, .from = 6.5, .to = 60}}),
                                    {"--count", "1", "--idle-timeout", "90"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "error not_back; pass 1 11");
}

TEST_CASE("a unit that is pulled early is told at once, whatever was done to it") {
  const auto [to, delay] = GENERATE(table<double, double>({
      {2.5, 1.0}, // nobody knew yet who it was
      {4.5, 1.0},
      {5.6, 3.5}, // it had been ordered to restart
  }));
  const int node_id = GENERATE(7, 0);
  INFO(to << " s, node ID " << node_id);
  const Bench bench;
  const std::string events = (bench.folder() / "events").string();
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = to, .node_id = node_id},
                                          {.serial = 101, .from = 20, .to = 60}}),
                                    {"--count", "1", "--idle-timeout", "90", "--events", events});
  INFO(run.result.out << run.result.err << content(events));
  CHECK(run.records.back()["verdict"] == "pass");
  constexpr double begin = 1735689600; // of the simulation
  const auto gone = times_of("gone", events);
  REQUIRE(gone.size() == 1);
  CHECK(gone[0] - begin > to);
  for (const auto& line : json_lines(content(events))) {
    if (line["event"] == "gone" && to > 4) { // by then it has told
      CHECK(line["serial_number"] == 101);
    }
  }
  CHECK(gone[0] - begin < to + (node_id == 0 && to < 3 ? 2.1 : delay));
}

TEST_CASE("a unit that was pulled and is back as its answers are given up was pulled") {
  const double back = GENERATE(4.5, 6.0, 7.0, 7.5, 8.0);
  INFO(back);
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 3.3, .node_id = 7},
                                          {.serial = 101, .from = back, .to = 60}}),
                                    {"--count", "1", "--idle-timeout", "90"});
  INFO(run.result.out << run.result.err);
  CHECK(run.records.back()["verdict"] == "pass");
  for (std::size_t i = 0; i + 1 < run.records.size(); ++i) {
    CHECK(run.records[i]["code"] == "not_back");
  }
}

TEST_CASE("a unit that restarts for ever is given up, and done again after it was taken off") {
  std::vector<Visit> visits;
  constexpr double period = 5.4;
  for (int i = 0; i < 10; ++i) { // it never comes to its end, and is never silent for 3 s
    visits.push_back({.serial = 101, .from = 1 + period * i, .to = 4 + period * i, .node_id = 7});
  }
  visits.push_back({.serial = 101, .from = 70, .to = 110});
  const Provisioned run = provision(line(visits), {"--count", "1", "--idle-timeout", "90"});
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "error not_back; error not_back; error not_back; pass 1 11");
}

TEST_CASE("a unit whose answers do not come is told in the place of one that has passed") {
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = 30, .node_id = 11},
                                          {.serial = 102,
                                           .from = 31,
                                           .to = 70,
                                           .node_id = 11,
                                           .more = {{"faults", {{"mute", true}}}}}}),
                                    two_records);
  INFO(run.result.out << run.result.err);
  CHECK(run.told() == "pass 1 11; fail timeout");
}

TEST_CASE("a second unit under the same node ID ends the display of a pass at once") {
  const Bench bench;
  const Scene scene = line({{.serial = 101, .from = 1, .to = 30, .node_id = 11},
                            {.serial = 102, .from = 15, .to = 30, .node_id = 11}});
  const Result shown = scene.run(
      bench, {"provision", bench.file("recipe.json", line_recipe), "-y", "--idle-timeout", "20"},
      {.terminal = true, .terminal_stdout = true, .columns = 80});
  INFO(shown.out << shown.err);
  const std::size_t told = shown.out.find("TAKE ALL OFF");
  REQUIRE(told != std::string::npos);
  const std::size_t bell = shown.out.find('\a', told); // it follows what was drawn
  REQUIRE(bell != std::string::npos);
  CHECK(contains(shown.out.substr(told, bell - told), "several_servos"));
}

TEST_CASE(
    "a unit that was told as gone by its number, and stands in no record, is told to have none") {
  const double to = GENERATE(2.4, 2.6, 2.8);
  INFO(to);
  const Bench bench;
  const std::string events = (bench.folder() / "events").string();
  const Provisioned run = provision(line({{.serial = 101, .from = 1, .to = to, .node_id = 7},
                                          {.serial = 102, .from = 20, .to = 60, .node_id = 8}}),
                                    {"--count", "1", "--idle-timeout", "90", "--events", events});
  INFO(run.result.out << run.result.err << content(events));
  CHECK(run.told() == "pass 1 11");
  bool was_told = false;
  for (const auto& event : json_lines(content(events))) {
    was_told = was_told || (event["event"] == "gone" && event["serial_number"] == 101);
  }
  REQUIRE(was_told);
  CHECK(contains(run.result.err, "serial number 101 was taken off before"));
  CHECK_FALSE(contains(run.result.err, "must come back")); // nothing was written to it
}
