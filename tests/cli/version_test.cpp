#include "catch.hpp"
#include "run.hpp"

using namespace blactl::test;

TEST_CASE("--version prints the name and the version") {
  const auto result = run({"--version"});
  CHECK(result.status == 0);
  CHECK(result.out == "blactl " BLACTL_VERSION "\n");
  CHECK(result.err.empty());
}

TEST_CASE("--version fails when its output cannot be written") {
  const auto result = run({"--version"}, {.stdout_file = "/dev/full"});
  CHECK(result.status == 1);
  CHECK(result.err.find("blactl: [io]") != std::string::npos);
}

TEST_CASE("blactl alone, help and version are other words for --help and --version") {
  const auto same = [](const Arguments& one, const Arguments& other) {
    const Result shown = run(one);
    INFO(shown.err);
    CHECK(shown.status == 0);
    CHECK(shown.out == run(other).out);
    CHECK(shown.err.empty());
  };
  same({}, {"--help"});
  same({"help"}, {"--help"});
  same({"--lang", "ja", "help", "get"}, {"--lang", "ja", "get", "--help"});
  same({"version"}, {"--version"});
  CHECK(run({"help", "gte"}).status == 2);
}
