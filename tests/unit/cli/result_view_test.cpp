#include "blactl/base/json_writer.hpp"

#include "catch.hpp"
#include "cli/change/result_view.hpp"
#include "cli/output/page.hpp"
#include "unit/bla/built_in.hpp"

#include <span>
#include <string>
#include <string_view>

using namespace blactl;
using cli::ResultView;
using fleet::ChangeResult;
using fleet::ChangeStatus;

namespace {

/// Servo 11, of which this register was set to 1.
ChangeResult written(const char* name) {
  ChangeResult result;
  result.servo.id = dronecan::NodeId(11);
  fleet::RegisterChange change;
  change.parameter = &test::parameter(name);
  change.before = 0;
  change.requested = 1;
  change.after = 1;
  change.status = ChangeStatus::written;
  result.changes = {change};
  return result;
}

std::string text_of(const ChangeResult& result) {
  return cli::text(ResultView::changes, std::span(&result, 1), cli::Page());
}

std::string json_of(const ChangeResult& result) {
  std::string out;
  JsonWriter json(out);
  json.begin_object();
  cli::write_json(json, ResultView::changes, std::span(&result, 1));
  json.end_object();
  return out;
}

bool has(const std::string& whole, std::string_view part) {
  return whole.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("that values are in RAM only is said of those that SAVE could keep") {
  CHECK(has(text_of(written("reverse")), "in RAM only"));
  CHECK_FALSE(has(text_of(written("command_angle")), "in RAM only"));
}

TEST_CASE("a warning stands beside the changes in JSON, and not among the data for people") {
  ChangeResult result = written("speed_p_gain");
  CHECK_FALSE(has(json_of(result), "warnings"));
  result.warnings = {{"leave_at_default", "better not"}};
  CHECK_FALSE(has(text_of(result), "better not")); // it is a note on stderr
  CHECK(has(json_of(result), R"("warnings":[{"code":"leave_at_default","text":"better not"}])"));
}
