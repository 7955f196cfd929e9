#include "catch.hpp"
#include "cli/repeat_interface.hpp"

#include <string>
#include <utility>
#include <vector>

using namespace blactl;

namespace {

std::string repeated(std::string hint, const std::string& interface) {
  cli::Shared shared;
  shared.interface = interface;
  cli::repeat_interface(hint, shared);
  return hint;
}

} // namespace

TEST_CASE("commands in hints repeat -i where they use a bus") {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"blactl restart -n 12", "blactl -i can1 restart -n 12"},
      {"see why: `blactl faults -n 3`, or blactl monitor",
       "see why: `blactl -i can1 faults -n 3`, or blactl -i can1 monitor"},
      {"原因を確認: blactl alloc --once。", "原因を確認: blactl -i can1 alloc --once。"},
      {"blactl --local-node-id ID set", "blactl -i can1 --local-node-id ID set"},
  };
  for (const auto& [hint, wanted] : cases) {
    CHECK(repeated(hint, "can1") == wanted);
    CHECK(repeated(hint, "") == hint);
    CHECK(repeated(hint, "replay:bus.log") == hint);
  }
  for (const char* other : {"see blactl --help", "see blactl get --help", "blactl models all",
                            "once no blactl runs they can be removed", "blactl sim x.json",
                            "use it with `blactl -i sim: scan`"}) {
    CHECK(repeated(other, "can1") == other);
  }
}

TEST_CASE("what a shell would not take for one word is quoted") {
  CHECK(repeated("blactl scan", "slcan:/dev/ttyACM0?open=s8&ack=none") ==
        "blactl -i 'slcan:/dev/ttyACM0?open=s8&ack=none' scan");
  CHECK(repeated("blactl scan", "sim:a b's.json") == R"(blactl -i 'sim:a b'\''s.json' scan)");
}

TEST_CASE("an interface from the environment holds for the next command, too") {
  cli::Shared shared;
  shared.interface = "can1";
  shared.from_environment.push_back({"--interface", "can1", "BLACTL_INTERFACE"});
  std::string hint = "blactl scan";
  cli::repeat_interface(hint, shared);
  CHECK(hint == "blactl scan");
}
