// Every parameter of every model: what is in range survives text and register in every unit, what
// is one step outside is refused with the range named.

#include "blactl/bla/value.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <random>
#include <set>

using namespace blactl;
using namespace blactl::bla;

namespace {

/// All ways to write `raw` that are exact, independently of the code under test.
std::vector<std::string> spellings(const Parameter& parameter, std::int64_t raw) {
  const std::string sign = raw < 0 ? "-" : "";
  const std::uint64_t size = static_cast<std::uint64_t>(raw < 0 ? -raw : raw);
  const auto decimal = [&](std::uint64_t steps, int decimals) {
    return decimals == 0 ? fmt::format("{}{}", sign, size)
                         : fmt::format("{}{}.{:0{}}", sign, size / steps, size % steps, decimals);
  };
  std::vector<std::string> all{fmt::format("{}raw", raw)};
  const std::string unit(name(parameter.unit));
  switch (parameter.unit) {
  case Unit::none:
  case Unit::year:
  case Unit::month:
  case Unit::day:
  case Unit::hour:
  case Unit::minute: all.push_back(decimal(1, 0)); break;
  case Unit::microsecond:
    all.insert(all.end(), {decimal(1, 0), decimal(1, 0) + "us", decimal(1'000, 3) + "ms",
                           decimal(1'000'000, 6) + "s"});
    break;
  case Unit::millisecond:
    all.insert(all.end(), {decimal(1, 0), decimal(1, 0) + "ms", decimal(1'000, 3) + "s",
                           fmt::format("{}{}us", sign, size * 1000)});
    break;
  case Unit::deg_or_rpm:
    all.insert(all.end(), {decimal(10, 1) + "deg", decimal(1, 0) + "rpm"});
    break;
  default:
    if (parameter.steps_per_unit == 10) {
      all.insert(all.end(), {decimal(10, 1) + unit, decimal(10, 1) + "000" + unit});
    } else {
      all.insert(all.end(), {decimal(1, 0), decimal(1, 0) + unit, decimal(1, 0) + ".0" + unit});
    }
  }
  return all;
}

/// Bounds, their neighbours, the default, zero's neighbours and random values: all in range.
std::set<std::int64_t> samples(const Parameter& parameter, std::mt19937_64& random) {
  std::set<std::int64_t> values{
      *parameter.min, *parameter.min + 1, *parameter.max, *parameter.max - 1, -1, 0, 1, 9, 10, 11};
  if (parameter.default_raw) {
    values.insert(*parameter.default_raw);
  }
  std::uniform_int_distribution<std::int64_t> any(*parameter.min, *parameter.max);
  for (int i = 0; i < 50; ++i) {
    values.insert(any(random));
  }
  std::erase_if(values, [&](std::int64_t value) {
    return value < *parameter.min || value > *parameter.max ||
           (!parameter.choices.empty() && parameter.choice(value) == nullptr);
  });
  return values;
}

void check_survival(const Parameter& parameter, std::int64_t raw) {
  CHECK(check_range(parameter, raw));
  for (const std::string& text : spellings(parameter, raw)) {
    const auto value = parse_value(parameter, NamedBy::name, text);
    INFO(text);
    REQUIRE(value);
    CHECK(value->raw == raw);
  }
  for (const std::optional<std::int64_t> mode : {std::optional<std::int64_t>{}, {0}, {1}}) {
    const auto value = parse_value(parameter, NamedBy::name, input_text(parameter, raw, mode));
    REQUIRE(value);
    CHECK(value->raw == raw);
  }
  const auto by_address = parse_value(parameter, NamedBy::address, std::to_string(raw));
  REQUIRE(by_address);
  CHECK(by_address->raw == raw);
  CHECK(parameter.width.narrow(raw) == raw);
}

} // namespace

TEST_CASE("every value in range of every parameter of every model survives") {
  std::mt19937_64 random(20251010); // the date of revision 1.11
  std::size_t parameters = 0;
  std::size_t values = 0;
  for (const Profile& profile : test::built_in().all()) {
    for (const Parameter& parameter : profile.parameters) {
      if (!parameter.min) {
        continue; // numbers of the maker, 0x49
      }
      INFO(profile.model << ' ' << parameter.name);
      for (const std::int64_t raw : samples(parameter, random)) {
        INFO(raw);
        check_survival(parameter, raw);
        ++values;
      }
      ++parameters;
    }
  }
  CHECK(parameters == 490);
  CHECK(values > 10'000);
}

TEST_CASE("one step outside of every range is refused with the range named") {
  std::size_t refused = 0;
  for (const Profile& profile : test::built_in().all()) {
    for (const Parameter& parameter : profile.parameters) {
      if (!parameter.min) {
        continue;
      }
      for (const std::int64_t raw : {*parameter.min - 1, *parameter.max + 1}) {
        INFO(profile.model << ' ' << parameter.name << ' ' << raw);
        const auto result = check_range(parameter, raw);
        REQUIRE_FALSE(result);
        CHECK(result.error().code == Code::out_of_range);
        const std::string& message = result.error().message;
        CHECK(message.find(input_text(parameter, *parameter.min)) != std::string::npos);
        CHECK(message.find(input_text(parameter, *parameter.max)) != std::string::npos);
        CHECK_FALSE(result.error().hint.empty());
        ++refused;
      }
    }
  }
  CHECK(refused == 980);
}

TEST_CASE("nothing finer than a register's step is taken") {
  for (const Parameter& parameter : test::built_in().registers()) {
    const std::string unit(name(parameter.unit));
    if (unit.empty() || parameter.unit == Unit::deg_or_rpm) {
      continue;
    }
    INFO(parameter.name);
    const std::string finer = parameter.steps_per_unit == 10 ? "1.05" : "1.5";
    const auto value = parse_value(parameter, NamedBy::name, finer + unit);
    REQUIRE_FALSE(value);
    CHECK(value.error().code == Code::usage);
  }
}
