#include "blactl/base/nearest.hpp"

#include "catch.hpp"

#include <array>
#include <string>

using namespace blactl;

TEST_CASE("edit distance counts insertions, removals, replacements and swaps") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("abc", "") == 3);
  CHECK(edit_distance("abc", "abc") == 0);
  CHECK(edit_distance("abc", "abd") == 1);
  CHECK(edit_distance("abc", "ac") == 1);
  CHECK(edit_distance("abc", "acb") == 1);
  CHECK(edit_distance("angel", "angle") == 1);
  CHECK(edit_distance("kitten", "sitting") == 3);
}

TEST_CASE("the nearest words come first, and only those that resemble") {
  constexpr std::array<std::string_view, 6> words{"scan", "save", "set", "sim", "faults", "fault"};
  using Words = std::vector<std::string_view>;
  CHECK(nearest("scna", words) == Words{"scan"});
  CHECK(nearest("sav", words) == Words{"save"});
  CHECK(nearest("fault", words) == Words{"fault", "faults"});
  CHECK(nearest("ault", words) == Words{"fault", "faults"});
  CHECK(nearest("provision", words).empty());
  CHECK(nearest("", words).empty());
  CHECK(nearest(std::string(100'000, 's'), words).empty());
}

TEST_CASE("words are found by their parts, and without separators") {
  constexpr std::array<std::string_view, 6> words{"overcurrent_limit", "angle_dead_band",
                                                  "speed_dead_band",   "angle_limit_cw",
                                                  "servo_id",          "static_node_id"};
  using Words = std::vector<std::string_view>;
  CHECK(nearest("anglelimit", words) == Words{"angle_limit_cw"});
  CHECK(nearest("AngleLimitCW", words) == Words{"angle_limit_cw"});
  CHECK(nearest("nodeid", words) == Words{"static_node_id"});
  CHECK(nearest("node-id", words) == Words{"static_node_id"});
  CHECK(nearest("deadband", words) == Words{"angle_dead_band", "speed_dead_band"});
  CHECK(nearest("limits", words) == Words{"angle_limit_cw", "overcurrent_limit"});
  CHECK(nearest("xy", words).empty());
}
