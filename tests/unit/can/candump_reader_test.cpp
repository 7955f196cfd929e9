#include "blactl/can/candump_reader.hpp"

#include "allocations.hpp"
#include "catch.hpp"
#include "gzip.hpp"
#include "scratch_file.hpp"

#include <unistd.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

using namespace blactl;
using namespace blactl::can;
using blactl::can::test::ScratchFile;
using blactl::test::allocations;
using blactl::test::gzipped;

namespace {

std::unique_ptr<CandumpReader> open(const std::string& path) {
  auto reader = CandumpReader::open(path);
  REQUIRE(reader);
  return std::move(*reader);
}

/// The IDs of all frames from here on.
std::vector<std::uint32_t> ids(CandumpReader& reader) {
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

TEST_CASE("lines that are no comments and not candump's are passed over, counted, told by number") {
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
    const auto reader = CandumpReader::open(path);
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
