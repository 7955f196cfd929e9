#include "blactl/base/json_writer.hpp"
#include "blactl/base/text.hpp"

#include "catch.hpp"
#include "cli/output/page.hpp"
#include "cli/output/snapshots_view.hpp"

#include <array>
#include <chrono>
#include <optional>
#include <string>

using namespace blactl;
using namespace std::chrono_literals;

namespace {

constexpr WallTime morning{std::chrono::sys_days{std::chrono::year{2026} / 11 / 22} + 8h + 15min};

std::array<state::SnapshotEntry, 3> changes() {
  return {state::SnapshotEntry{.number = 8,
                               .run = 8,
                               .at = morning + 1500ms,
                               .command = "alloc --static",
                               .unique_id = {0xC3},
                               .held = {{0x46, 0}},
                               .written = {{0x46, 18}},
                               .saved = true,
                               .settled = morning + 3s},
          state::SnapshotEntry{.number = 7,
                               .run = 7,
                               .at = morning,
                               .command = "set\x1b[31m",
                               .unique_id = {0xC4},
                               .held = {{0x38, 1}, {0x39, 2}},
                               .saved = false},
          state::SnapshotEntry{.number = 6,
                               .run = 6,
                               .at = morning - 1s,
                               .command = "apply",
                               .unique_id = {0xC4},
                               .held = {{0x38, 1}},
                               .saved = true}};
}

} // namespace

TEST_CASE("recorded changes are told in the keys of the contract") {
  std::string out;
  JsonWriter json(out);
  json.begin_object();
  cli::write_snapshots(json, changes(), bla::Profiles::load(std::nullopt).value());
  json.end_object();
  CHECK(out == R"({"snapshots":[{"number":8,"time":"2026-11-22T08:15:01Z",)"
               R"("unique_id":"c3000000000000000000000000000000",)"
               R"("command":"alloc --static","changed_count":1,)"
               R"("changes":[{"address":"0x46","name":"static_node_id","before":0,"after":18}],)"
               R"("saved":true},)"
               R"({"number":7,"time":"2026-11-22T08:15:00Z",)"
               R"("unique_id":"c4000000000000000000000000000000",)"
               R"("command":"set\\x1b[31m","changed_count":2,)"
               R"("changes":[{"address":"0x38","name":"angle_limit_cw","before":1,"after":null},)"
               R"({"address":"0x39","name":"angle_limit_ccw","before":2,"after":null}],)"
               R"("saved":false},)"
               R"({"number":6,"time":"2026-11-22T08:14:59Z",)"
               R"("unique_id":"c4000000000000000000000000000000",)"
               R"("command":"apply","changed_count":1,)"
               R"("changes":[{"address":"0x38","name":"angle_limit_cw","before":1,"after":null}],)"
               R"("saved":null}]})");
}

TEST_CASE("people see when, what, and whether ROM was changed") {
  const bla::Profiles profiles = bla::Profiles::load(std::nullopt).value();
  CHECK(cli::text(changes(), profiles, cli::Page{.width = 80}) ==
        "NUMBER  TIME                  UNIQUE ID  COMMAND         CHANGED IN\n"
        "8       2026-11-22T08:15:01Z  c3000000   alloc --static  RAM and ROM\n"
        "        static_node_id 0 -> 18\n"
        "7       2026-11-22T08:15:00Z  c4000000   set\\x1b[31m     RAM\n"
        "        angle_limit_cw was 0.1 deg, angle_limit_ccw was 0.2 deg\n"
        "6       2026-11-22T08:14:59Z  c4000000   apply           RAM, ROM not known\n"
        "        angle_limit_cw was 0.1 deg\n");
  CHECK(
      cli::text(changes(), profiles, cli::Page{}).find("c3000000000000000000000000000000  alloc") !=
      std::string::npos);
  CHECK(cli::text({}, profiles, cli::Page()) == "no change is recorded\n");
  set_language(Language::japanese);
  CHECK(cli::text({}, profiles, cli::Page()) == "変更履歴は空です\n");
  set_language(Language::english);
}
