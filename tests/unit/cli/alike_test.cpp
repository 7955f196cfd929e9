#include "catch.hpp"
#include "cli/output/alike.hpp"

using namespace blactl::cli;

TEST_CASE("texts that differ in the node ID alone are one") {
  const std::vector<AboutNode> told{{11, "node 11 is ill: -n 11"},
                                    {12, "node 12 is ill: -n 12"},
                                    {std::nullopt, "the bus is ill"},
                                    {1, "node 1 is ill: -n 1"},
                                    {13, "node 13 is hot"}};
  const auto groups = alike(told);
  REQUIRE(groups.size() == 3);
  CHECK(groups[0].first == 0);
  CHECK(groups[0].others == std::vector<std::uint8_t>{12, 1});
  CHECK(groups[1].first == 2);
  CHECK(groups[2].first == 4);
  CHECK(groups[2].others.empty());
  CHECK(likewise(told[0].text, groups[0].others) == "node 11 is ill: -n 11 (likewise nodes 12, 1)");
  CHECK(likewise(told[4].text, groups[2].others) == "node 13 is hot");
}

TEST_CASE("a number that only holds the digits of a node ID is no node ID") {
  const std::vector<AboutNode> told{{1, "node 1: 10 of 21"}, {2, "node 2: 20 of 22"}};
  CHECK(alike(told).size() == 2);
}
