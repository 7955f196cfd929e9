#include "catch.hpp"
#include "cli/output/reporter.hpp"

#include <nlohmann/json.hpp>

using namespace blactl;
using namespace blactl::cli;

namespace {

nlohmann::ordered_json document(const Report& report) {
  return nlohmann::ordered_json::parse(render_json(report));
}

} // namespace

TEST_CASE("a document has schema, command, interface, exit status, data, counts and errors") {
  Report report{.command = "get", .interface = "vcan0"};
  report.json = [](JsonWriter& json) {
    json.key("nodes");
    json.begin_array();
    json.value(12);
    json.end_array();
  };
  report.counts = {{"nodes", 1}, {"failed", 0}};
  CHECK(render_json(report) == R"({
  "schema": "blactl/1",
  "command": "get",
  "interface": "vcan0",
  "exit_status": 0,
  "nodes": [
    12
  ],
  "counts": {
    "nodes": 1,
    "failed": 0
  },
  "errors": []
}
)");
}

TEST_CASE("a failure before anything was known is a document, too") {
  Report report;
  report.fail({Code::usage, "there is no command 'gte'", "did you mean get?"});
  const auto json = document(report);
  CHECK(json["command"].is_null());
  CHECK(json["interface"].is_null());
  CHECK(json["exit_status"] == 2);
  CHECK(json["nodes"].empty());
  CHECK(json["errors"].dump() ==
        R"([{"node_id":null,"code":"usage","message":"there is no command 'gte'",)"
        R"("hint":"did you mean get?"}])");
}

TEST_CASE("an error names its servo") {
  Report report;
  report.fail({Code::timeout, "no answer", "", 12});
  CHECK(document(report)["errors"][0]["node_id"] == 12);
  CHECK(document(report)["errors"][0]["hint"] == "");
}

TEST_CASE("the last object of a stream is one line without nodes") {
  Report report{.command = "sim"};
  report.is_stream = true;
  CHECK(render_json(report) == R"({"schema":"blactl/1","command":"sim","interface":null,)"
                               R"("exit_status":0,"counts":{},"errors":[]})"
                               "\n");
}

TEST_CASE("whatever a name or message holds, the document is JSON") {
  Report report{.command = "get", .interface = "sim:\xFF\"\n\x1b.json"};
  report.fail({Code::bad_file, "\xC3(\x01", "\xE8\xA7"});
  CHECK(document(report)["interface"] == "sim:\uFFFD\"\n\x1b.json");
  CHECK(document(report)["errors"][0]["message"] == "\uFFFD(\x01");
}
