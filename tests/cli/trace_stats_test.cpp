// blactl trace --stats.

#include "catch.hpp"
#include "run.hpp"
#include "scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace blactl::test;

namespace {

using Json = nlohmann::json;
using Names = std::vector<std::string>;

/// A NodeStatus of node 42 with this transfer ID.
std::string status_at(int transfer_id, std::string_view time, std::string_view interface = "can0") {
  return fmt::format("({}) {} 1401552A#D2040000000700{:02X}\n", time, interface,
                     0xC0 | transfer_id);
}

std::size_t occurrences(std::string_view text, std::string_view what) {
  std::size_t count = 0;
  for (auto at = text.find(what); at != std::string_view::npos; at = text.find(what, at + 1)) {
    ++count;
  }
  return count;
}

/// A NodeStatus each 100 ms from 42 for two seconds, 4 of which are lost, and an error from 43.
std::string statuses_with_a_gap() {
  std::string log;
  for (int i = 0; i <= 20; ++i) {
    if (i < 10 || i > 13) {
      log += status_at(i % 32, fmt::format("14365090{:.6f}", 10 + 0.1 * i));
    }
  }
  return log + "(1436509012.000000) can0 1403F32B#00BD1160\n";
}

} // namespace

TEST_CASE("--stats is one document: who sends what how often, what is lost, and the load") {
  const Bench bench;
  const std::string file = bench.file("x.log", statuses_with_a_gap());
  const Result result = bench.run({"trace", "--stats", "-j", file});
  REQUIRE(json_lines(result.out).size() == 1);
  const auto end = ordered_json(result.out);
  CHECK(keys(end) == Names{"schema", "command", "interface", "exit_status", "types",
                           "errors_by_kind", "load", "begin", "end", "duration_s", "frames",
                           "interfaces", "counts", "errors"});
  REQUIRE(end["types"].size() == 2);
  const auto& row = end["types"][0];
  // 17 frames of 144 bits with the intermission.
  CHECK(row.dump() == R"({"interface":"can0","type":"uavcan.protocol.NodeStatus",)"
                      R"("data_type_id":341,"kind":"message","source":42,"destination":null,)"
                      R"("count":17,"rate_hz":8.5,"period_ms":{"mean":125.0,"min":100.0,)"
                      R"("max":500.0,"jitter":96.825},"lost":4,"jumps":0,"errors":0,)"
                      R"("frames":17,"bytes":119,"bits":)" +
                          row["bits"].dump() + "}");
  CHECK(row["bits"].get<int>() / 17 >= 140);
  CHECK(row["bits"].get<int>() / 17 <= 150);
  CHECK(end["types"][1]["source"] == 43);
  CHECK(end["types"][1]["errors"] == 1);
  CHECK(end["types"][1]["lost"].is_null());
  CHECK(end["types"][1]["period_ms"]["mean"].is_null());
  CHECK(end["errors_by_kind"].dump() ==
        R"({"crc":0,"toggle":0,"missing_start":1,"transfer_id":0,"truncated":0,"timeout":0,)"
        R"("short":0})");
  CHECK(end["load"].dump() == R"({"mean_permille":1,"max_permille":1,"last_permille":0})");
  CHECK(contains(result.out, R"("begin":1436509010.000000,"end":1436509012.000000,)"
                             R"("duration_s":2.000,"frames":18,)"));
  CHECK(end["interfaces"][0]["load"] == end["load"]);
  CHECK(end["counts"]["transfers"] == 17);
  CHECK(end["counts"]["errors"] == 1);
}

TEST_CASE("--stats tells people the same in a table, with the time from when to when") {
  const Bench bench;
  const std::string file = bench.file("x.log", statuses_with_a_gap());
  const Result text = bench.run({"trace", "--stats", file}, {.env = {{"TZ", "UTC"}}});
  CHECK(text.status == 0);
  CHECK(contains(text.out, "NODE  TYPE             COUNT  PER S  MEAN ms  MIN-MAX ms   JITTER  "
                           "LOST  LOAD %  ERRORS\n"
                           "42    NodeStatus       17     8.5    125.0    100.0-500.0  96.8    "
                           "4     0.12    0\n"
                           "43    actuator.Status  0      0.0    -        -            -       "
                           "-     0.01    1\n"));
  CHECK(contains(text.out, "can0: frames: 18 in 2.0 s, load 0.1 %, "
                           "busiest second 0.1 %, last second 0.0 %\n"
                           "from 2015-07-10 06:16:50.000000 to 2015-07-10 06:16:52.000000\n"
                           "errors: missing_start: 1\n"));
}

TEST_CASE("--type, --kind and -n choose rows of --stats, not the load") {
  const Bench bench;
  const std::string file = bench.file("x.log", statuses_with_a_gap());
  const auto all = json(bench.run({"trace", "--stats", "-j", file}).out);
  const auto sources = [](const Json& end) {
    std::vector<int> found;
    for (const auto& row : end["types"]) {
      found.push_back(row["source"]);
    }
    return found;
  };
  for (const auto& [filter, left] : std::vector<std::pair<Arguments, std::vector<int>>>{
           {{"--type", "NodeStatus"}, {42}}, {{"-n", "43"}, {43}}, {{"--kind", "request"}, {}}}) {
    Arguments arguments{"trace", "--stats", "-j", file};
    arguments.insert(arguments.end(), filter.begin(), filter.end());
    const auto some = json(bench.run(arguments).out);
    CHECK(sources(some) == left);
    CHECK(some["load"] == all["load"]);
    CHECK(some["frames"] == 18);
  }
}

TEST_CASE("--stats says null and - where it cannot be told") {
  const Bench bench;
  // One frame; two interfaces; stamps that run backwards; a restart.
  const auto one = json(
      bench.run({"trace", "--stats", "-j", bench.file("a.log", status_at(0, "1436509052.249713"))})
          .out);
  CHECK(one["load"]["mean_permille"].is_null());
  CHECK(one["load"]["max_permille"].is_null());
  CHECK(one["types"][0]["rate_hz"].is_null());
  CHECK(one["types"][0]["lost"].is_null());
  const auto two =
      json(bench
               .run({"trace", "--stats", "-j",
                     bench.file("b.log",
                                statuses_with_a_gap() + status_at(0, "1436509012.000000", "can1"))})
               .out);
  CHECK(two["load"]["mean_permille"].is_null());
  REQUIRE(two["interfaces"].size() == 2);
  CHECK(two["interfaces"][0]["load"]["mean_permille"] == 1);
  const std::string backwards =
      bench.file("c.log", statuses_with_a_gap() + status_at(0, "1436500000.000000"));
  const auto back = json(bench.run({"trace", "--stats", "-j", backwards}).out);
  CHECK(back["duration_s"].is_null());
  CHECK(back["load"]["mean_permille"].is_null());
  CHECK(back["load"]["max_permille"] == 1);
  CHECK(back["types"][0]["period_ms"]["mean"] == 125.0);
  CHECK(back["types"][0]["jumps"] == 1);
  const Result text = bench.run({"trace", "--stats", backwards});
  CHECK(contains(text.out, "4+"));
  CHECK(contains(text.out, "+: the transfer IDs also jumped"));
}

TEST_CASE("--stats of a bus is printed at the end, also by --count") {
  const auto end = json(three_servos().run({"trace", "--stats", "-j", "--duration", "3"}).out);
  CHECK(end["types"].size() == 6);
  CHECK(end["duration_s"].get<double>() > 2.8);
  CHECK(end["load"]["max_permille"].get<int>() > 0);
  for (const auto& row : end["types"]) {
    CHECK(row["lost"] == 0);
  }
  const auto counted = json(three_servos().run({"trace", "--stats", "-j", "--count", "30"}).out);
  CHECK(counted["counts"]["transfers"] == 30);
}

TEST_CASE("Ctrl-C ends --stats with all that was heard") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  Background trace(bench, {"-i", "sim:", "trace", "--stats"}, {.terminal_stdout = true},
                   "last second");
  const Result stopped = trace.stop(SIGINT);
  CHECK(stopped.status == 130);
  CHECK(occurrences(stopped.out, "sim:: frames: ") >= 2);
}

TEST_CASE("on a terminal --stats is redrawn in place once a second") {
  const Result result = three_servos().run({"trace", "--stats", "--duration", "3.5"},
                                           {.terminal_stdout = true, .columns = 80});
  CHECK(result.status == 0);
  CHECK(occurrences(result.out, "NODE  TYPE") == 4); // after 1, 2, 3 s, and the end
  CHECK(occurrences(result.out, "\x1b[J") == 3);     // each but the first takes its place
}

TEST_CASE("trace --stats fits a terminal of 80 columns, a line each") {
  for (const char* language : {"en", "ja"}) {
    const Result result =
        three_servos().run({"trace", "--stats", "--duration", "1.2", "--lang", language},
                           {.terminal_stdout = true, .columns = 80});
    CHECK(result.status == 0);
    const std::string last = result.out.substr(result.out.rfind("\x1b[J") + 3);
    CHECK(longest_line(last) <= 80);
    // A column that stands below has no header.
    CHECK(contains(last, language == std::string_view("en") ? "  LOAD %" : "  負荷 %"));
  }
}
