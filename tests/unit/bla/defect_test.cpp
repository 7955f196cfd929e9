#include "blactl/bla/defect.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"

#include <cstdint>
#include <optional>

using namespace blactl;
using namespace blactl::bla;
using test::built_in;

namespace {

bool stalls(const char* name, std::optional<std::int64_t> firmware) {
  const Profile& model = test::model(name);
  return may_stall({built_in(), {model.model_number, 1, firmware, model.hardware_version}});
}

} // namespace

TEST_CASE("BLA15 and BLA21 before firmware 1.400 may stall at low speed", "[requirement-92]") {
  for (const char* name : {"BLA15-12U-A0", "BLA21-12U-AB"}) {
    INFO(name);
    CHECK(stalls(name, 1000));
    CHECK(stalls(name, 1399));
    CHECK_FALSE(stalls(name, 1400));
    CHECK_FALSE(stalls(name, 1500));
  }
  CHECK_FALSE(stalls("BLA34-28U-AB", 1000));
}

TEST_CASE("of an unknown model or firmware no defect is claimed") {
  CHECK_FALSE(stalls("BLA21-12U-AB", std::nullopt));
  CHECK_FALSE(may_stall({built_in(), {99, 1, 1000, 12050}}));
  CHECK_FALSE(may_stall(Identity()));
}
