#include "blactl/bla/faults.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string_view>
#include <vector>

using namespace blactl;
using namespace blactl::bla;
using test::built_in;

namespace {

/// What 0x18 sums up of the other three (4.12).
std::int64_t summary_of(Values values) {
  std::int64_t summary = 0;
  for (const Fault& fault : faults(values, built_in())) {
    summary |= std::int64_t{1} << summary_bit(fault.level, fault.bit);
  }
  return summary;
}

std::vector<std::string_view> codes(const Values& values) {
  std::vector<std::string_view> found;
  for (const Fault& fault : faults(values, built_in())) {
    found.push_back(fault.known != nullptr ? std::string_view(fault.known->code) : "?");
  }
  return found;
}

} // namespace

TEST_CASE("every bit of the profiles is found, alone and beside every other") {
  for (const FaultBit& one : built_in().fault_bits()) {
    for (const FaultBit& other : built_in().fault_bits()) {
      INFO(one.code << " " << other.code);
      Values values{
          {address::fault_notice, 0}, {address::fault_warning, 0}, {address::fault_failure, 0}};
      values[one.reg] |= std::int64_t{1} << one.bit;
      values[other.reg] |= std::int64_t{1} << other.bit;
      const auto found = codes(values);
      CHECK(std::set(found.begin(), found.end()) ==
            std::set<std::string_view>{one.code, other.code});
      CHECK(found.size() == (one.code == other.code ? 1U : 2U));
    }
  }
}

TEST_CASE("the worst faults come first") {
  CHECK(codes({{address::fault_notice, 1 << 20},
               {address::fault_warning, 1 << 8 | 1 << 10},
               {address::fault_failure, 1}}) ==
        std::vector<std::string_view>{"motor_driver", "temperature_high", "voltage_high",
                                      "pwm_missing"});
}

TEST_CASE("a bit that no document describes is a fault without a code", "[requirement-169]") {
  const auto found = faults({{address::fault_failure, 1 << 31 | 1 << 2}}, built_in());
  REQUIRE(found.size() == 2);
  CHECK(found[0].bit == 2);
  CHECK(found[0].known == nullptr);
  CHECK(found[0].group == "hardware");
  CHECK(found[1].bit == 31);
  CHECK(found[1].group == "other");
  CHECK(found[1].level == Level::failure);
}

TEST_CASE("0x18 tells which of the others need to be read", "[requirement-168]") {
  const auto details = [](std::int64_t summary) {
    return fault_details({{address::fault_summary, summary}}, built_in());
  };
  CHECK(details(0).empty());
  CHECK(details(1 << 16) == std::vector{address::fault_notice});
  CHECK(details(1 << 9) == std::vector{address::fault_warning});
  CHECK(details(1 << 26 | 1 << 1) == std::vector{address::fault_warning, address::fault_failure});
  CHECK(fault_details({}, built_in()).size() == 3); // 0x18 itself is not known
}

TEST_CASE("what 0x18 says of every known bit leads to its register") {
  for (const FaultBit& bit : built_in().fault_bits()) {
    INFO(bit.code);
    const Values all{{bit.reg, std::int64_t{1} << bit.bit}};
    const Values summary{{address::fault_summary, summary_of(all)}};
    CHECK(fault_details(summary, built_in()) == std::vector{bit.reg});
    for (const Address reg : fault_registers) {
      CHECK(fault_register(summary, reg).has_value() == (reg != bit.reg));
    }
  }
}

TEST_CASE("then what is measured and its limit are read, once") {
  Values values{{address::fault_summary, 1 << 9},
                {address::fault_warning, 1 << 8 | 1 << 9}}; // hot and cold at once
  CHECK(fault_details(values, built_in()) == std::vector{address::current_temperature,
                                                         address::temperature_limit_high,
                                                         address::temperature_limit_low});
  values[address::current_temperature] = 90;
  values[address::temperature_limit_high] = 80;
  values[address::temperature_limit_low] = -40;
  CHECK(fault_details(values, built_in()).empty());
}

TEST_CASE("the condition of a bit names the registers that tell more") {
  for (const FaultBit& bit : built_in().fault_bits()) {
    for (const Address address : bit.values) {
      INFO(bit.code);
      CHECK(bit.condition_en.find('[' + address.name() + ']') != std::string::npos);
      CHECK(built_in().find(address) != nullptr);
    }
  }
}
