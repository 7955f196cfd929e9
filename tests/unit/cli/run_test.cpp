#include "catch.hpp"
#include "cli/run.hpp"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

using namespace blactl::cli;

namespace {

/// What is written to a descriptor while `work` runs.
std::string written(int descriptor, const std::function<void()>& work) {
  std::array<int, 2> ends{};
  REQUIRE(pipe2(ends.data(), O_CLOEXEC) == 0);
  std::fflush(nullptr);
  const int kept = dup(descriptor);
  dup2(ends[1], descriptor);
  close(ends[1]);
  work();
  dup2(kept, descriptor);
  close(kept);
  std::string text(65'536, '\0'); // more than a pipe holds
  const auto size = read(ends[0], text.data(), text.size());
  close(ends[0]);
  text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  return text;
}

struct Outcome {
  int status = -1;
  std::string out, err;
};

Outcome outcome(const std::vector<std::string>& arguments, const std::function<int()>& work) {
  Outcome outcome;
  outcome.err = written(STDERR_FILENO, [&] {
    outcome.out = written(STDOUT_FILENO, [&] { outcome.status = guarded(arguments, work); });
  });
  return outcome;
}

int throw_a_text() {
  throw std::runtime_error("cannot\x1b[2J do it");
}

int throw_a_number() {
  throw 7;
}

int run_out_of_memory() {
  throw std::bad_alloc();
}

} // namespace

TEST_CASE("what is thrown is exit status 1 and an error like any other") {
  for (const auto& work : {throw_a_text, throw_a_number, run_out_of_memory}) {
    const Outcome text = outcome({"get", "-n", "11"}, work);
    CHECK(text.status == 1);
    CHECK(text.out.empty());
    CHECK(text.err.find("[internal] blactl itself failed: ") != std::string::npos);
    CHECK(text.err.find("\n  this should not happen") != std::string::npos);
    CHECK(text.err.find('\x1b') == std::string::npos);
  }
}

TEST_CASE("with --json what is thrown is a document") {
  const auto document = nlohmann::json::parse(outcome({"get", "--json"}, throw_a_text).out);
  CHECK(document["schema"] == "blactl/1");
  CHECK(document["command"] == "get");
  CHECK(document["exit_status"] == 1);
  CHECK(document["errors"][0]["code"] == "internal");
  const auto line = outcome({"sim", "-j"}, throw_a_text).out;
  CHECK(std::count(line.begin(), line.end(), '\n') == 1); // the end of a stream
}

TEST_CASE("what throws nothing has its own exit status") {
  const Outcome fine = outcome({"get"}, [] { return 9; });
  CHECK(fine.status == 9);
  CHECK(fine.out.empty());
  CHECK(fine.err.empty());
}
