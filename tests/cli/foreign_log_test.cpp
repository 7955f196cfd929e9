// Logs that customers mail: of Vector and of PEAK, read wherever those of candump are.

#include "catch.hpp"
#include "gzip.hpp"
#include "run.hpp"
#include "scene.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

using namespace blactl::test;

namespace {

std::string path_of(std::string_view name) {
  return std::string(BLACTL_TEST_DATA) + "/logs/" + std::string(name);
}

std::string bytes_of(std::string_view name) {
  std::ifstream file(path_of(name), std::ios::binary);
  REQUIRE(file);
  return {std::istreambuf_iterator<char>(file), {}};
}

constexpr std::array<std::string_view, 8> logs{"canoe.asc",    "german.asc",   "fd_channel.asc",
                                               "pcan_1_1.trc", "pcan_1_2.trc", "pcan_1_3.trc",
                                               "pcan_2_0.trc", "pcan_2_1.trc"};

} // namespace

TEST_CASE("a log of Vector or PEAK is traced, from a file, an interface and a pipe") {
  const Bench bench;
  for (const auto name : logs) {
    INFO(name);
    const Result traced = bench.run({"trace", path_of(name)});
    CHECK(traced.status == 0);
    CHECK(traced.err.empty());
    CHECK(std::ranges::count(traced.out, '\n') == 2);
    CHECK(traced.out.starts_with("    0.000000  can"));
    CHECK(contains(traced.out, "\n    1.250000  can"));
    CHECK(contains(traced.out, "NodeStatus"));
    CHECK(bench.run({"-i", "replay:" + path_of(name), "trace"}).out == traced.out);
    CHECK(bench.run({"trace", "-"}, {.stdin_text = bytes_of(name)}).out == traced.out);
    CHECK(bench.run({"trace", "-"}, {.stdin_text = gzipped(bytes_of(name))}).out == traced.out);
    const Result scanned = bench.run({"-i", "replay:" + path_of(name), "scan", "--json"});
    CHECK(json(scanned.out)["nodes"].size() == 1);
    CHECK(json(scanned.out)["nodes"][0]["node_id"] == 42);
  }
}

TEST_CASE("the time of day of a log is what its clock showed, in every time zone") {
  const Bench bench;
  for (const auto* zone : {"UTC0", "JST-9", "CET-1CEST,M3.5.0,M10.5.0/3"}) {
    for (const auto name : logs) {
      INFO(zone << " " << name);
      const Result traced =
          bench.run({"trace", path_of(name), "--absolute"}, {.env = {{"TZ", zone}}});
      const bool is_german = name == "german.asc";
      CHECK(traced.out.starts_with(is_german ? "2017-03-04 15:06:14.19100"
                                             : "2017-09-30 15:06:14.19100"));
    }
  }
  const Result unix_time =
      bench.run({"trace", path_of("canoe.asc"), "-j"}, {.env = {{"TZ", "JST-9"}}});
  CHECK(contains(unix_time.out, "1506751574.191000"));
}

TEST_CASE("lines of such a log that are wrong are told by number, in both languages") {
  const Bench bench;
  const std::string log = bench.file(
      "x.log", "date Sat Sep 30 15:06:13.191 2017\r\nbase hex  timestamps absolute\r\n"
               "1.0 1 1401552Ax Rx d 8 D2 04 00 00 00 07 00\r\n"
               "2.0 1 1401552Ax Rx d 8 D2 04 00 00 00 07 00 C0\r\n3.0 1 1401552Ax Rx d 8 D2 04 0");
  const Result traced = bench.run({"trace", log});
  CHECK(traced.status == 0);
  CHECK(std::ranges::count(traced.out, '\n') == 1);
  CHECK(contains(traced.err,
                 "x.log: lines skipped because they are not frames: 2, the first is line 3"));
  CHECK(contains(bench.run({"trace", log, "--lang", "ja"}).err,
                 "フレームではない 2 行を無視しました (最初は 3 行目)"));
}

TEST_CASE("a TRC of an unknown version is a bad file, and the hint says which are known") {
  const Bench bench;
  const std::string log = bench.file("x.trc", ";$FILEVERSION=3.0\r\n1) 1.0 Rx 0123 0\r\n");
  const Result traced = bench.run({"trace", log});
  CHECK(traced.status == 2);
  CHECK(codes(traced) == std::vector<std::string>{"bad_file"});
  CHECK(contains(traced.err, "x.trc contains no frame in the format of candump, Vector ASC or PEAK "
                             "TRC 1.1 to 2.1"));
  CHECK(contains(bench.run({"trace", log, "--lang", "ja"}).err, "PEAK TRC 1.1～2.1"));
}
