#include "blactl/bla/explain.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"

#include <array>

using namespace blactl;
using namespace blactl::bla;

namespace {

std::optional<std::string> time_of(const std::vector<std::int64_t>& numbers) {
  constexpr std::array registers{address::production_year, address::production_month,
                                 address::production_day, address::production_hour,
                                 address::production_minute};
  Values values;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    values[registers.at(i)] = numbers[i];
  }
  return production_time(values);
}

} // namespace

TEST_CASE("the registers of the date make one date") {
  CHECK(time_of({2020, 6, 22, 15, 30}) == "2020-06-22 15:30"); // the example of 4.44
  CHECK(time_of({2024, 2, 29, 0, 0}) == "2024-02-29 00:00");
  CHECK(time_of({2020, 6, 22}) == "2020-06-22");
  CHECK(time_of({2020, 6, 22, 15}) == "2020-06-22");
  CHECK(time_of({2020, 6, 22, 24, 0}) == "2020-06-22");
}

TEST_CASE("what is no date is none") {
  CHECK_FALSE(time_of({}));
  CHECK_FALSE(time_of({2020, 6}));
  CHECK_FALSE(time_of({0, 0, 0, 0, 0}));
  CHECK_FALSE(time_of({2023, 2, 29}));
  CHECK_FALSE(time_of({2020, 13, 1}));
  CHECK_FALSE(time_of({65535, 1, 1}));
  CHECK_FALSE(time_of({2020, 258, 257})); // 258 is 2 in eight bits
  CHECK_FALSE(time_of({-2020, 6, 22}));
}

TEST_CASE("the last register of the date of production tells the whole date") {
  const Values values{{address::production_year, 2020},
                      {address::production_month, 6},
                      {address::production_day, 22}};
  const auto lines = [](const char* name, std::int64_t raw, const Values& among) {
    return explained(test::parameter(name), raw, among, test::built_in());
  };
  using Lines = std::vector<std::string>;
  CHECK(lines("production_day", 22, values) == Lines{"made 2020-06-22"});
  CHECK(lines("production_day", 22, {}).empty());
  CHECK(lines("production_month", 6, values).empty());
  Values whole = values;
  whole[address::production_hour] = 15;
  whole[address::production_minute] = 30;
  CHECK(lines("production_day", 22, whole).empty());
  CHECK(lines("production_minute", 30, whole) == Lines{"made 2020-06-22 15:30"});
}

TEST_CASE("the bits of fault registers are told, known or not") {
  const auto lines = [](const char* name, std::int64_t raw) {
    return explained(test::parameter(name), raw, {}, test::built_in());
  };
  using Lines = std::vector<std::string>;
  CHECK(lines("fault_warning", 0x400) == Lines{"bit 10: Voltage upper limit"});
  CHECK(lines("fault_warning", 0x80000400).size() == 2);
  CHECK(lines("fault_summary", 0x200).size() == 1);
  CHECK(lines("fault_failure", 0).empty());
  CHECK(lines("angle_limit_cw", 0x400).empty());
}
