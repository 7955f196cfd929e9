#include "blactl/state/interface_lock.hpp"

#include "catch.hpp"
#include "processes.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <utility>

using namespace blactl;
using namespace blactl::state;
using namespace blactl::state::test;

namespace fs = std::filesystem;

using Right = InterfaceLock::Right;

namespace {

Result<InterfaceLock> acquire(const Folder& folder, Right right = Right::write,
                              std::string_view interface = "vcan0") {
  return InterfaceLock::acquire({.interface = std::string(interface), .folder = folder.locks()},
                                right);
}

/// A child that holds the right it asked for; it says 0 if it was refused.
std::function<int()> holds(const Folder& folder, Right right = Right::write) {
  return [&folder, right] {
    static std::optional<InterfaceLock> held;
    auto lock = acquire(folder, right);
    if (!lock) {
      return 0;
    }
    held.emplace(std::move(*lock));
    return 1;
  };
}

fs::path lock_file(const Folder& folder, const char* suffix = "write") {
  return fs::path(folder.locks()) / (std::string("vcan0.") + suffix);
}

bool names(const Error& error, pid_t process) {
  return error.message.find(std::to_string(process)) != std::string::npos;
}

} // namespace

TEST_CASE("one process at a time writes on an interface, and the others are told which") {
  const Folder folder;
  const Right right = GENERATE(Right::write, Right::allocate);
  const Child child(holds(folder, right));
  REQUIRE(child.said == 1);
  const auto refused = acquire(folder, right);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == Code::busy);
  CHECK(names(refused.error(), child.pid));
  CHECK(refused.error().message.find("vcan0") != std::string::npos);
  CHECK_FALSE(refused.error().hint.empty());
}

TEST_CASE("the refusal of writing and that of allocating are not the same words") {
  const Folder folder;
  const auto write = acquire(folder, Right::write);
  const auto allocate = acquire(folder, Right::allocate);
  CHECK(acquire(folder, Right::write).error().message !=
        acquire(folder, Right::allocate).error().message);
}

TEST_CASE("two parts of one process exclude each other as well") {
  const Folder folder;
  const auto first = acquire(folder);
  REQUIRE(first);
  const auto second = acquire(folder);
  REQUIRE_FALSE(second);
  CHECK(second.error().code == Code::busy);
  CHECK(names(second.error(), getpid()));
}

TEST_CASE("to write and to allocate are two rights, and each interface has its own") {
  const Folder folder;
  const auto write = acquire(folder, Right::write);
  const auto allocate = acquire(folder, Right::allocate);
  const auto elsewhere = acquire(folder, Right::write, "vcan1");
  const auto path = acquire(folder, Right::write, "sim:/run/user/0/blactl/sim.sock");
  CHECK((write && allocate && elsewhere && path));
  CHECK(fs::exists(lock_file(folder, "write")));
  CHECK(fs::exists(lock_file(folder, "alloc")));
}

TEST_CASE("the right ends with its holder") {
  const Folder folder;
  SECTION("an object that is destroyed") {
    std::optional<Result<InterfaceLock>> lock(acquire(folder));
    REQUIRE(*lock);
    REQUIRE_FALSE(acquire(folder));
    lock.reset();
  }
  SECTION("a process that is killed") {
    Child child(holds(folder));
    REQUIRE(child.said == 1);
    REQUIRE_FALSE(acquire(folder));
    child.end();
  }
  CHECK(acquire(folder));
}

TEST_CASE("a right that was moved is held by its new owner alone") {
  const Folder folder;
  auto first = acquire(folder);
  REQUIRE(first);
  std::optional<InterfaceLock> moved(std::move(*first));
  first = fail(Code::busy, "gone");
  CHECK_FALSE(acquire(folder));
  moved.reset();
  CHECK(acquire(folder));
}

TEST_CASE("a refused process takes nothing from the holder") {
  const Folder folder;
  Child child(holds(folder));
  REQUIRE(child.said == 1);
  for (int i = 0; i < 3; ++i) {
    const auto refused = acquire(folder);
    REQUIRE_FALSE(refused);
    CHECK(names(refused.error(), child.pid));
  }
}

TEST_CASE("the next holder's name replaces that of the last one") {
  const Folder folder;
  pid_t before = 0;
  {
    const Child child(holds(folder));
    before = child.pid;
  }
  const Child child(holds(folder));
  REQUIRE(child.said == 1);
  const auto refused = acquire(folder);
  REQUIRE_FALSE(refused);
  CHECK(names(refused.error(), child.pid));
  CHECK_FALSE(names(refused.error(), before));
}

TEST_CASE("a lock file that is cut short is still held, by nobody with a name") {
  const Folder folder;
  const Child child(holds(folder));
  REQUIRE(child.said == 1);
  fs::resize_file(lock_file(folder), GENERATE(0U, 5U, 15U));
  const auto refused = acquire(folder);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == Code::busy);
  CHECK_FALSE(names(refused.error(), child.pid));
}

TEST_CASE("on a full disk the right is held all the same") {
  const Folder folder;
  SECTION("under no name") {
    const Child child([&folder] {
      fill_the_disk();
      return holds(folder)();
    });
    REQUIRE(child.said == 1);
    const auto refused = acquire(folder);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == Code::busy);
  }
  SECTION("and not under the name of the holder before") {
    pid_t before = 0;
    {
      const Child child(holds(folder));
      before = child.pid;
    }
    const Child child([&folder] {
      fill_the_disk();
      return holds(folder)();
    });
    REQUIRE(child.said == 1);
    const auto refused = acquire(folder);
    REQUIRE_FALSE(refused);
    CHECK_FALSE(names(refused.error(), before));
  }
}

TEST_CASE("a lock file with anything in it is no obstacle") {
  const Folder folder;
  fs::create_directory(folder.locks());
  std::ofstream(lock_file(folder))
      << GENERATE(as<std::string>{}, "", "x", "garbage of some bytes and more");
  const auto lock = acquire(folder);
  REQUIRE(lock);
  const auto refused = acquire(folder);
  REQUIRE_FALSE(refused);
  CHECK(names(refused.error(), getpid()));
}

TEST_CASE("a lock file that cannot be opened keeps away, and says what it is") {
  const Folder folder;
  fs::create_directory(folder.locks());
  SECTION("a folder in its place") {
    fs::create_directory(lock_file(folder));
  }
  SECTION("a symbolic link, which is not followed") {
    std::ofstream(folder.path / "victim") << "precious";
    fs::create_symlink(folder.path / "victim", lock_file(folder));
  }
  const auto refused = acquire(folder);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == Code::busy);
  CHECK(refused.error().message.find(lock_file(folder).string()) != std::string::npos);
  CHECK(refused.error().hint.find("ls -ld " + lock_file(folder).string()) != std::string::npos);
}

TEST_CASE("without a common folder the processes of one user exclude each other") {
  const Folder folder;
  const Variable runtime("XDG_RUNTIME_DIR", folder.path.string());
  const auto first = InterfaceLock::acquire(
      {.interface = "vcan0", .folder = "/proc/no/such/folder"}, Right::write);
  REQUIRE(first);
  CHECK_FALSE(InterfaceLock::acquire({.interface = "vcan0", .folder = "/proc/no/such/folder"},
                                     Right::write));
  CHECK(fs::exists(folder.path / "blactl" / "vcan0.write"));
}

TEST_CASE("where nothing can be written nobody is kept away") {
  const std::string nowhere = "/proc/no/such/folder";
  const Variable runtime("XDG_RUNTIME_DIR", nowhere);
  const Variable state("BLACTL_STATE_DIR", nowhere);
  const auto first =
      InterfaceLock::acquire({.interface = "vcan0", .folder = nowhere}, Right::write);
  const auto second =
      InterfaceLock::acquire({.interface = "vcan0", .folder = nowhere}, Right::write);
  CHECK(first);
  CHECK(second);
}
