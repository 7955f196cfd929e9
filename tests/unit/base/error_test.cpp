#include "blactl/base/error.hpp"

#include "catch.hpp"

#include <map>
#include <string>

using namespace blactl;

TEST_CASE("every code has the word and the exit status of the contract") {
  const std::map<int, std::string> expected{
      {1, "io state internal "},
      {2, "usage bad_file unknown_parameter out_of_range read_only unsupported cross_check "},
      {3, "interface permission bus_off no_acknowledge "},
      {4, "timeout not_found not_back not_recorded "},
      {5, "refused mismatch "},
      {7, "not_confirmed "},
      {8, "faults "},
      {9,
       "duplicate_node_id duplicate_servo_id duplicate_unique_id other_allocator armed driven busy "
       "no_local_node_id no_profile model_mismatch rom_unread stale_plan table_full label_mismatch "
       "firmware_too_old several_servos counter_end attempts "},
      {130, "interrupted "}};
  std::map<int, std::string> found;
  for (int code = 0; code <= static_cast<int>(Code::interrupted); ++code) {
    found[exit_status(static_cast<Code>(code))] += std::string(name(static_cast<Code>(code))) + ' ';
  }
  CHECK(found == expected);
}

TEST_CASE("fail() makes an error that belongs to no servo yet") {
  const Result<int> result = fail(Code::timeout, "no answer", "try again");
  REQUIRE_FALSE(result);
  CHECK(result.error().code == Code::timeout);
  CHECK(result.error().message == "no answer");
  CHECK(result.error().hint == "try again");
  CHECK_FALSE(result.error().node_id);
}
