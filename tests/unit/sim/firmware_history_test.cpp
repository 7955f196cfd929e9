#include "sim/scenario/firmware_history.hpp"
#include "unit/sim/support.hpp"

using namespace blactl;
using namespace blactl::sim;

namespace {

using Versions = std::vector<std::int64_t>;

Versions shipped(const char* model) {
  return shipped_firmware(testing::profiles(), model);
}

Scenario with_firmware(const char* model, int version) {
  return testing::scenario(
      fmt::format(R"("servos": [{{"model": "{}", "firmware_version": {}}}])", model, version));
}

bool warned(const char* model, int version) {
  return !with_firmware(model, version).warnings.empty();
}

} // namespace

TEST_CASE("requirement 184: which firmware left the factory in which model", "[requirement-184]") {
  CHECK(shipped("BLA21-12U-AB") == Versions{1100, 1200, 1300, 1400});
  CHECK(shipped("BLA21-12U-AB2") == Versions{1100, 1200, 1300, 1400});
  CHECK(shipped("BLA21-12U-AB1") == Versions{1300, 1400});
  CHECK(shipped("BLA21-28U-A0") == Versions{1010, 1300, 1400});
  CHECK(shipped("BLA21-28U-A03") == Versions{1010, 1300, 1400});
  CHECK(shipped("BLA15-06U-A0") == Versions{1010, 1300, 1400});
  CHECK(shipped("BLA15-12U-A01") == Versions{1200, 1300, 1400});
  CHECK(shipped("BLA34-12U-AB1") == Versions{1500});
  CHECK(shipped("BLA34-12U-AB2").empty());
  CHECK(shipped("BLA99-12U-AB").empty());
  CHECK(shipped("BLA21-12U").empty());
  CHECK(shipped("").empty());
}

TEST_CASE("requirement 184: a scenario with a firmware that the model never had has a warning",
          "[requirement-184]") {
  CHECK(with_firmware("BLA21-12U-AB", 1010).warnings ==
        std::vector<std::string>{
            "test.json:1: /servos/0/firmware_version: BLA21-12U-AB never had firmware 1.010; "
            "there were 1.100, 1.200, 1.300, 1.400"});
  CHECK(warned("BLA21-12U-AB", 1500));
  CHECK(warned("BLA21-12U-A0", 1100));
  CHECK(warned("BLA34-28U-AB", 1400));
  CHECK(warned("BLA15-12U-A01", 1010));
  CHECK(warned("bla21-12u-ab1", 1200));
  CHECK_FALSE(warned("BLA21-12U-AB2", 1200));
  CHECK_FALSE(warned("BLA21-12U-A0", 1010));
  CHECK_FALSE(warned("BLA34-28U-AB", 1500));
  CHECK(testing::scenario(R"("servos": [{"model": "BLA34-28U-AB"}])").warnings.empty());
}

TEST_CASE("a model may be given by its label, in letters of either case") {
  const auto model = [](const char* name) {
    return testing::servo_setup(fmt::format(R"("model": "{}")", name)).profile->model;
  };
  CHECK(model("BLA21-12U-AB2") == "BLA21-12U-AB");
  CHECK(model("bla15-06u-a01") == "BLA15-06U-A0");
  CHECK(model("BLA34-28U-AB") == "BLA34-28U-AB");
  for (const char* wrong : {"BLA34-28U", "BLA21", "BLA21-12U-ABX", "BLA21-12U-AB22", ""}) {
    INFO(wrong);
    CHECK_FALSE(parse_scenario(
        fmt::format(R"({{"schema": "blactl-scenario/1", "servos": [{{"model": "{}"}}]}})", wrong),
        "x", testing::profiles()));
  }
}
