#include "blactl/state/state_folder.hpp"

#include "catch.hpp"
#include "processes.hpp"

#include <string>

using blactl::state::state_folder;
using blactl::state::test::Variable;

TEST_CASE("the state folder is the one that is named, else that of XDG, else that of HOME") {
  const Variable home("HOME", "/home/somebody");
  const Variable named("BLACTL_STATE_DIR", "");
  const Variable xdg("XDG_STATE_HOME", "/var/state");
  CHECK(state_folder() == "/var/state/blactl");
  SECTION("what is named comes first") {
    const Variable now_named("BLACTL_STATE_DIR", "/srv/blactl");
    CHECK(state_folder() == "/srv/blactl");
  }
  SECTION("a relative one of XDG is none") {
    const Variable relative("XDG_STATE_HOME", GENERATE(as<std::string>{}, "", "relative"));
    CHECK(state_folder() == "/home/somebody/.local/state/blactl");
  }
}
