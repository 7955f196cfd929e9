#include "blactl/can/candump.hpp"
#include "blactl/can/log_reader.hpp"

#include "allocations.hpp"
#include "catch.hpp"
#include "gzip.hpp"
#include "scratch_file.hpp"
#include "time_zone.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;
using blactl::can::test::ScratchFile;
using blactl::can::test::TimeZone;
using blactl::test::allocations;
using blactl::test::gzipped;

namespace {

std::unique_ptr<LogReader> open(const std::string& path) {
  auto reader = LogReader::open(path);
  REQUIRE(reader);
  return std::move(*reader);
}

/// The IDs of all frames from here on.
std::vector<std::uint32_t> ids(LogReader& reader) {
  std::vector<std::uint32_t> found;
  while (const auto line = reader.next()) {
    if (line->kind == LogLine::Kind::frame) {
      found.push_back(line->frame.id);
    }
  }
  return found;
}

using Ids = std::vector<std::uint32_t>;

constexpr std::string_view first = "(1436509052.249713) can0 00000001#11\n";
constexpr std::string_view second = "(1436509052.249714) can0 00000002#22\n";

/// A pipe whose reading end is standard input for a while.
class StdinPipe {
 public:
  StdinPipe() : before_(dup(STDIN_FILENO)) {
    std::array<int, 2> ends{};
    REQUIRE(pipe(ends.data()) == 0);
    dup2(ends[0], STDIN_FILENO);
    close(ends[0]);
    input_ = ends[1];
  }

  ~StdinPipe() {
    end();
    dup2(before_, STDIN_FILENO);
    close(before_);
  }

  StdinPipe(const StdinPipe&) = delete;
  StdinPipe& operator=(const StdinPipe&) = delete;

  void type(std::string_view text) const {
    REQUIRE(write(input_, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }

  void end() {
    if (input_ >= 0) {
      close(input_);
    }
    input_ = -1;
  }

 private:
  int before_;
  int input_ = -1;
};

} // namespace

TEST_CASE("a log is read line by line to its end") {
  const ScratchFile file(std::string(first) + std::string(second));
  const auto reader = open(file.path());
  CHECK(reader->next()->frame.id == 1);
  CHECK(reader->line_number() == 1);
  CHECK_FALSE(reader->ended());
  CHECK(reader->next()->frame.id == 2);
  CHECK_FALSE(reader->next());
  CHECK(reader->ended());
  CHECK_FALSE(reader->next());
  CHECK_FALSE(reader->error());
  CHECK(reader->bad_lines() == 0);
  CHECK(reader->name() == file.path());
}

TEST_CASE("the last line of a log may lack its end") {
  const ScratchFile file(std::string(first) + std::string(second.substr(0, second.size() - 1)));
  CHECK(ids(*open(file.path())) == Ids{1, 2});
}

TEST_CASE("an empty file has ended") {
  const ScratchFile file;
  const auto reader = open(file.path());
  CHECK_FALSE(reader->next());
  CHECK(reader->ended());
  CHECK(reader->line_number() == 0);
}

TEST_CASE(
    "lines that are no comments and not of the format are passed over, counted, told by number") {
  const ScratchFile file(std::string(first) + "\n# a remark\n\x01\x02\xFF\n" +
                         std::string("\0\0", 2) + "\n" + std::string(second));
  const auto reader = open(file.path());
  CHECK(ids(*reader) == Ids{1, 2});
  CHECK(reader->bad_lines() == 2);
  CHECK(reader->first_bad_line() == 4);
  CHECK(reader->line_number() == 6);
}

TEST_CASE("a line without an end in sight is one bad line") {
  for (const std::size_t length :
       {std::size_t{65'535}, std::size_t{65'536}, std::size_t{65'537}, std::size_t{1'000'000}}) {
    INFO(length);
    const std::string noise(length, 'x');
    const ScratchFile between(std::string(first) + noise + "\n" + std::string(second));
    const auto reader = open(between.path());
    CHECK(ids(*reader) == Ids{1, 2});
    CHECK(reader->bad_lines() == 1);
    CHECK(reader->first_bad_line() == 2);
    CHECK(reader->line_number() == 3);
    const ScratchFile at_end(std::string(first) + noise);
    const auto other = open(at_end.path());
    CHECK(ids(*other) == Ids{1});
    CHECK(other->bad_lines() == 1);
    CHECK(other->ended());
  }
}

TEST_CASE("a file that is not there, or is a folder, is refused") {
  for (const auto* path : {"/nonexistent/log", "/tmp"}) {
    const auto reader = LogReader::open(path);
    REQUIRE_FALSE(reader);
    CHECK(reader.error().code == Code::bad_file);
    CHECK(reader.error().message.find(path) != std::string::npos);
    CHECK(reader.error().hint.find("candump") != std::string::npos);
  }
}

TEST_CASE("a pipe that has nothing yet is not waited for") {
  StdinPipe input;
  const auto reader = open("-");
  CHECK(reader->name() == "standard input");
  CHECK_FALSE(reader->next());
  CHECK_FALSE(reader->ended());
  input.type(first);
  input.type(second.substr(0, 20));
  CHECK(reader->next()->frame.id == 1);
  CHECK_FALSE(reader->next());
  CHECK_FALSE(reader->ended());
  input.type(second.substr(20));
  CHECK(reader->next()->frame.id == 2);
  input.end();
  CHECK_FALSE(reader->next());
  CHECK(reader->ended());
}

TEST_CASE("a log that gzip has packed is read like any other, whatever its name") {
  const ScratchFile file(gzipped(std::string(first) + "dear diary\n" + std::string(second)));
  const auto reader = open(file.path());
  CHECK(ids(*reader) == Ids{1, 2});
  CHECK(reader->ended());
  CHECK_FALSE(reader->error());
  CHECK(reader->bad_lines() == 1);
  CHECK(reader->line_number() == 3);
}

TEST_CASE("what several runs of gzip wrote one after the other is one log") {
  const std::string half(second.substr(0, 20)), rest(second.substr(20));
  const ScratchFile file(gzipped(std::string(first) + half) + gzipped("") + gzipped(rest));
  const auto reader = open(file.path());
  CHECK(ids(*reader) == Ids{1, 2});
  CHECK_FALSE(reader->error());
}

TEST_CASE("wherever a packed log is cut off, whole lines are read and the rest is an error") {
  const std::string packed = gzipped(std::string(first) + std::string(second));
  for (std::size_t size = 2; size < packed.size(); ++size) {
    INFO(size);
    const ScratchFile file(std::string_view(packed).substr(0, size));
    const auto reader = open(file.path());
    const Ids found = ids(*reader);
    CHECK((found.empty() || found == Ids{1} || found == Ids{1, 2}));
    CHECK(reader->ended());
    REQUIRE(reader->error());
    CHECK(reader->error()->code == Code::bad_file);
    CHECK(reader->error()->message == file.path() +
                                          " is cut off: its gzip data ends too early; "
                                          "lines read before: " +
                                          std::to_string(found.size()));
    CHECK(reader->bad_lines() == 0); // half a line is none
  }
}

TEST_CASE("one byte of the magic number alone is a plain file with a bad line") {
  const ScratchFile file("\x1f");
  const auto reader = open(file.path());
  CHECK(ids(*reader).empty());
  CHECK_FALSE(reader->error());
  CHECK(reader->bad_lines() == 1);
}

TEST_CASE("a packed log that is damaged is an error, and so is what does not belong to it") {
  std::string bad_sum = gzipped(first);
  bad_sum[bad_sum.size() - 5] ^= 1;
  const std::string packed = gzipped(first);
  for (const auto& bytes : {bad_sum, packed + "(1436509052.249714) can0 00000002#22\n",
                            std::string("\x1f\x8b no gzip at all"), packed + packed.substr(1)}) {
    const ScratchFile file(bytes);
    const auto reader = open(file.path());
    (void)ids(*reader);
    REQUIRE(reader->error());
    CHECK(reader->error()->code == Code::bad_file);
    CHECK(reader->error()->message.starts_with(file.path() + " is damaged"));
    CHECK_FALSE(reader->next());
  }
}

TEST_CASE("a packed log comes through a pipe byte by byte") {
  StdinPipe input;
  const auto reader = open("-");
  const std::string packed = gzipped(std::string(first) + std::string(second));
  Ids found;
  for (const char byte : packed) {
    input.type({&byte, 1});
    CHECK_FALSE(reader->ended());
    for (const std::uint32_t id : ids(*reader)) {
      found.push_back(id);
    }
  }
  CHECK(found == Ids{1, 2});
  input.end();
  CHECK_FALSE(reader->next());
  CHECK(reader->ended());
  CHECK_FALSE(reader->error());
}

TEST_CASE("a small file that holds a huge line takes no memory, and next() comes back from it") {
  std::string packed;
  const std::string piece = gzipped(std::string(10'000'000, 'x'));
  for (int i = 0; i < 20; ++i) {
    packed += piece;
  }
  const ScratchFile file(packed + gzipped("\n" + std::string(second)));
  const auto reader = open(file.path());
  (void)reader->next(); // what unpacks is made
  const std::size_t before = allocations();
  std::size_t pauses = 0;
  while (!reader->next() && !reader->ended()) {
    CHECK(reader->has_paused());
    ++pauses;
  }
  CHECK(allocations() == before);
  CHECK(pauses >= 1);
  CHECK_FALSE(reader->ended()); // it was the frame behind the line
  CHECK(reader->bad_lines() == 1);
}

TEST_CASE("a million lines are read without one allocation") {
  const ScratchFile file;
  constexpr std::uint32_t count = 1'000'000;
  {
    std::ofstream out(file.path(), std::ios::binary);
    LineBuffer buffer;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Frame frame{.id = i, .size = 8, .data = {1, 2, 3, 4, 5, 6, 7, 8}};
      out << format_line(frame, WallTime(Duration(1436509052'000000 + i)), "vcan0", buffer);
    }
  }
  const auto reader = open(file.path());
  const std::size_t before = allocations();
  std::uint32_t found = 0;
  bool in_order = true;
  while (const auto line = reader->next()) {
    in_order = in_order && line->frame.id == found && line->frame.size == 8;
    ++found;
  }
  CHECK(allocations() == before);
  CHECK(found == count);
  CHECK(in_order);
  CHECK(reader->bad_lines() == 0);
}

namespace {

std::string log_named(const std::string& name) {
  std::ifstream file(std::string(BLACTL_TEST_DATA) + "/logs/" + name, std::ios::binary);
  REQUIRE(file);
  return {std::istreambuf_iterator<char>(file), {}};
}

constexpr std::array<std::string_view, 8> foreign_logs{
    "canoe.asc",    "german.asc",   "fd_channel.asc", "pcan_1_1.trc",
    "pcan_1_2.trc", "pcan_1_3.trc", "pcan_2_0.trc",   "pcan_2_1.trc"};

/// What the logs of tests/data/logs say in their own way.
struct Told {
  std::vector<Frame> frames{};
  std::vector<std::string> interfaces{};
  std::vector<Duration> times{}; ///< since the start, which is the time of the first less a second
  WallTime first{};
  int errors = 0;
};

Told told_by(LogReader& reader) {
  Told told;
  while (const auto line = reader.next()) {
    if (line->kind == LogLine::Kind::frame) {
      told.first = told.frames.empty() ? line->at : told.first;
      told.frames.push_back(line->frame);
      told.interfaces.emplace_back(line->interface);
      told.times.push_back(line->at - told.first);
    }
    told.errors += line->kind == LogLine::Kind::error ? 1 : 0;
  }
  return told;
}

const Frame first_status{.id = 0x1401552A, .size = 8, .data = {0xD2, 4, 0, 0, 0, 7, 0, 0xC0}};
const Frame last_status{.id = 0x1401552A, .size = 8, .data = {0xD3, 4, 0, 0, 0, 7, 0, 0xC1}};
const Frame greeting{.id = 0x123, .extended = false, .size = 2, .data = {0xDE, 0xAD}};

} // namespace

TEST_CASE("logs of Vector and PEAK are told by their content and read with all that they say") {
  const TimeZone utc("UTC0");
  for (const auto name : foreign_logs) {
    INFO(name);
    const ScratchFile file(log_named(std::string(name))); // its name says nothing
    const auto reader = open(file.path());
    const Told told = told_by(*reader);
    CHECK(reader->bad_lines() == 0);
    CHECK_FALSE(reader->error());
    CHECK(told.errors == 1);
    const bool is_german = name == "german.asc"; // its remote frame has no length
    const auto remote_size = static_cast<std::uint8_t>(is_german ? 0 : 5);
    const Frame remote{.id = 0x7FF, .extended = false, .remote = true, .size = remote_size};
    CHECK(told.frames == std::vector<Frame>{first_status, greeting, remote, last_status});
    const bool has_buses = name != "pcan_1_1.trc" && name != "pcan_2_0.trc";
    CHECK(told.interfaces == (has_buses ? std::vector<std::string>{"can1", "can2", "can1", "can1"}
                                        : std::vector<std::string>{"can", "can", "can", "can"}));
    REQUIRE(told.times.size() == 4);
    CHECK(told.times[1] >= 250ms);
    CHECK(told.times[1] <= 250ms + 130us);
    CHECK(told.times[2] == 500ms);
    CHECK(told.times[3] == 1250ms);
    const auto day = is_german ? std::chrono::year(2017) / 3 / 4 : std::chrono::year(2017) / 9 / 30;
    const WallTime start = std::chrono::sys_days(day) + 15h + 6min + 13s + 191ms;
    CHECK(told.first - (start + 1s) >= 0us);
    CHECK(told.first - (start + 1s) <= 1us); // PEAK's days have ten decimals
  }
}

TEST_CASE(
    "logs of Vector and PEAK come packed, through pipes, with other line ends, behind a mark") {
  for (const auto name : foreign_logs) {
    INFO(name);
    const std::string log = log_named(std::string(name));
    const ScratchFile plain(log);
    const auto expected = told_by(*open(plain.path())).frames;
    std::string bare;
    std::ranges::copy_if(log, std::back_inserter(bare), [](char c) { return c != '\r'; });
    std::string marked = "\xEF\xBB\xBF" + log;
    while (marked.ends_with('\n') || marked.ends_with('\r')) {
      marked.pop_back(); // and without the last line end
    }
    for (const auto& text : {gzipped(log), bare, marked}) {
      const ScratchFile file(text);
      const auto reader = open(file.path());
      CHECK(told_by(*reader).frames == expected);
      CHECK(reader->bad_lines() == 0);
    }
    StdinPipe input;
    const auto reader = open("-");
    std::vector<Frame> found;
    for (const char byte : log) {
      input.type({&byte, 1});
      for (const auto& frame : told_by(*reader).frames) {
        found.push_back(frame);
      }
    }
    CHECK(found == expected);
  }
}

TEST_CASE("wherever a log of Vector or PEAK is cut off, no frame is read that it does not have") {
  for (const auto name : foreign_logs) {
    const std::string log = log_named(std::string(name));
    const ScratchFile whole(log);
    const auto all = told_by(*open(whole.path())).frames;
    for (std::size_t size = 0; size < log.size(); ++size) {
      INFO(name << " " << size);
      const ScratchFile file(std::string_view(log).substr(0, size));
      auto found = told_by(*open(file.path())).frames;
      REQUIRE(found.size() <= all.size());
      // of a length that is cut off nothing is known, nor whether a decimal number is complete
      const bool is_open = !found.empty() && (name == "german.asc" || found.back().remote);
      found.resize(found.size() - (is_open ? 1 : 0));
      CHECK(std::ranges::equal(found, std::span(all).first(found.size())));
    }
  }
}

TEST_CASE("the first header or frame decides what a log is") {
  const std::string asc = "base hex timestamps absolute\n1.0 1 3x Rx d 0\n";
  const std::string trc = ";$FILEVERSION=1.1\n1) 1.0 Rx 00000004 0\n";
  const auto read = [](const std::string& text) {
    const ScratchFile file(text);
    const auto reader = open(file.path());
    const Ids found = ids(*reader);
    return std::pair(found, reader->bad_lines());
  };
  const std::string candump(first);
  CHECK(read("dear customer\n" + asc) == std::pair(Ids{3}, std::uint64_t{1}));
  CHECK(read("dear customer\n\n# trace\n" + trc) == std::pair(Ids{4}, std::uint64_t{1}));
  CHECK(read(candump + asc + trc) == std::pair(Ids{1}, std::uint64_t{4}));
  CHECK(read(asc + trc + candump) == std::pair(Ids{3}, std::uint64_t{3}));
  CHECK(read(trc + asc + candump) == std::pair(Ids{4}, std::uint64_t{3}));
  CHECK(read(trc + trc) == std::pair(Ids{4, 4}, std::uint64_t{0}));
}

TEST_CASE("a line of a log of Vector or PEAK that is huge or of zero bytes is a bad one") {
  for (const std::string header : {"base hex timestamps absolute\n", ";$FILEVERSION=1.1\n"}) {
    const ScratchFile file(header + std::string(300'000, '1') + "\n" + std::string(100, '\0') +
                           "\n1.0 1 3x Rx d 0\n1) 1.0 Rx 00000003 0\n");
    const auto reader = open(file.path());
    CHECK(ids(*reader) == Ids{3});
    CHECK(reader->bad_lines() == 3);
    CHECK(reader->first_bad_line() == 2);
  }
}

TEST_CASE("lines of Vector and PEAK are read without one allocation") {
  const TimeZone utc("UTC0");
  for (const auto name : foreign_logs) {
    const ScratchFile file(log_named(std::string(name)));
    const auto reader = open(file.path());
    (void)reader->next();
    (void)reader->next(); // the time zone has been looked up
    const std::size_t before = allocations();
    while (reader->next()) {
    }
    CHECK(allocations() == before);
  }
}
