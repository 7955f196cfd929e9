#include "blactl/state/local_node_id.hpp"

#include "catch.hpp"
#include "processes.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::state;
using dronecan::Kind;
using dronecan::NodeId;
using dronecan::TransferId;
using dronecan::TransferIds;
using namespace blactl::state::test;

namespace fs = std::filesystem;

namespace {

Result<LocalNodeId> acquire(const Folder& folder, std::optional<NodeId> wanted = std::nullopt,
                            std::string_view interface = "vcan0") {
  return LocalNodeId::acquire(interface, wanted, folder.locks());
}

/// A child that holds the ID it got; it says 0 if it got none.
std::function<int()> holds_an_id(const Folder& folder) {
  return [&folder] {
    static std::optional<LocalNodeId> held;
    auto local = acquire(folder);
    if (!local) {
      return 0;
    }
    held.emplace(std::move(*local));
    return static_cast<int>(held->id().value());
  };
}

TransferId next(LocalNodeId& local) {
  return local.transfer_ids().next(Kind::request, 11, NodeId(10));
}

} // namespace

TEST_CASE("a process gets 127, or the ID it asks for") {
  const Folder folder;
  const auto local = acquire(folder);
  REQUIRE(local);
  CHECK(local->id() == NodeId(127));
  const auto wanted = acquire(folder, NodeId(50));
  REQUIRE(wanted);
  CHECK(wanted->id() == NodeId(50));
  CHECK(fs::exists(folder.file(127)));
  CHECK(fs::exists(folder.file(50)));
}

TEST_CASE("two processes get 127 and 126, the third is told who has them") {
  const Folder folder;
  const Child first(holds_an_id(folder));
  const Child second(holds_an_id(folder));
  CHECK(first.said == 127);
  CHECK(second.said == 126);
  const auto third = acquire(folder);
  REQUIRE_FALSE(third);
  CHECK(third.error().code == Code::no_local_node_id);
  CHECK(third.error().message.find(std::to_string(first.pid)) != std::string::npos);
  CHECK(third.error().message.find(std::to_string(second.pid)) != std::string::npos);
  CHECK(third.error().hint.find("--local-node-id") != std::string::npos);
}

TEST_CASE("a wanted ID that is taken is not replaced by another one") {
  const Folder folder;
  const auto first = acquire(folder, NodeId(50));
  REQUIRE(first);
  const auto second = acquire(folder, NodeId(50));
  REQUIRE_FALSE(second);
  CHECK(second.error().code == Code::no_local_node_id);
  CHECK(second.error().message.find(std::to_string(getpid())) != std::string::npos);
  CHECK_FALSE(fs::exists(folder.file(127)));
}

TEST_CASE("a process that is killed leaves its ID to the next one") {
  const Folder folder;
  Child child(holds_an_id(folder));
  REQUIRE(child.said == 127);
  child.end();
  const auto local = acquire(folder);
  REQUIRE(local);
  CHECK(local->id() == NodeId(127));
}

TEST_CASE("each interface has its own IDs, also one whose name is a path") {
  const Folder folder;
  const auto one = acquire(folder, {}, "vcan0");
  const auto other = acquire(folder, {}, "sim:/run/user/0/blactl/sim.sock");
  REQUIRE(one);
  REQUIRE(other);
  CHECK(one->id() == NodeId(127));
  CHECK(other->id() == NodeId(127));
  CHECK(fs::exists(folder.path / "locks" / "sim:_run_user_0_blactl_sim.sock.127"));
}

TEST_CASE("the next process goes on with the transfer IDs, even after a kill") {
  const Folder folder;
  Child child([&folder] {
    static std::optional<LocalNodeId> held;
    held.emplace(*acquire(folder));
    int last = 0;
    for (int i = 0; i < 10; ++i) {
      last = next(*held);
    }
    return last;
  });
  CHECK(child.said == 9);
  child.end();
  auto local = acquire(folder);
  REQUIRE(local);
  CHECK(next(*local) == 10);
}

TEST_CASE("a hundred processes in a row never repeat a transfer ID within 32 requests") {
  const Folder folder;
  std::map<int, std::vector<TransferId>> used; // by server
  for (int run = 0; run < 100; ++run) {
    auto local = acquire(folder);
    REQUIRE(local);
    for (int server = 1; server <= 3; ++server) {
      for (int request = 0; request < 1 + (run + server) % 5; ++request) {
        used[server].push_back(local->transfer_ids().next(
            Kind::request, 11, NodeId(static_cast<std::uint8_t>(server))));
      }
    }
  }
  for (const auto& [server, ids] : used) {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      REQUIRE(ids[i] == i % dronecan::transfer_id_modulus);
    }
  }
}

TEST_CASE("the lock file is for all users, and so is its folder") {
  const Folder folder;
  const mode_t before = umask(077);
  const auto local = acquire(folder);
  umask(before);
  REQUIRE(local);
  struct stat info{};
  REQUIRE(stat(folder.locks().c_str(), &info) == 0);
  CHECK((info.st_mode & 07777U) == 01777);
  REQUIRE(stat(folder.file(127).c_str(), &info) == 0);
  CHECK((info.st_mode & 07777U) == 0666);
}

TEST_CASE("a lock file with anything in it is a fresh one") {
  const Folder folder;
  fs::create_directory(folder.locks());
  const auto content =
      GENERATE(as<std::string>{}, "", "x", "garbage of some bytes", std::string(100'000, '\xFF'));
  std::ofstream(folder.file(127)) << content;
  auto local = acquire(folder);
  REQUIRE(local);
  CHECK(local->id() == NodeId(127));
  CHECK(next(*local) == 0);
  CHECK(next(*local) == 1);
}

TEST_CASE(
    "a lock file full of foreign counters costs the memory of transfer IDs and nothing else") {
  const Folder folder;
  {
    const auto local = acquire(folder);
  }
  std::fstream file(folder.file(127), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(16);
  file << std::string(fs::file_size(folder.file(127)) - 16, '\xFF');
  file.close();
  auto local = acquire(folder);
  REQUIRE(local);
  CHECK(local->id() == NodeId(127));
  const TransferId first = next(*local);
  CHECK(next(*local) == (first + 1) % dronecan::transfer_id_modulus);
}

TEST_CASE("a lock file that another user cuts short costs its memory and nothing else") {
  const Folder folder;
  {
    auto local = acquire(folder);
    REQUIRE(local);
    CHECK(next(*local) == 0);
    fs::resize_file(folder.file(127), 0);
    CHECK(next(*local) == 1);
    CHECK(next(*local) == 2);
  }
  auto local = acquire(folder);
  REQUIRE(local);
  CHECK(local->id() == NodeId(127));
  const TransferId first = next(*local);
  CHECK(next(*local) == (first + 1) % dronecan::transfer_id_modulus);
}

TEST_CASE("on a disk that becomes full the transfer IDs count on in memory") {
  const Folder folder;
  const Child child([&folder] {
    auto local = acquire(folder);
    std::ignore = next(*local);
    fill_the_disk();
    std::ignore = next(*local);
    return static_cast<int>(next(*local));
  });
  CHECK(child.said == 2);
}

TEST_CASE("on a full disk the ID is held all the same, and counting starts anywhere") {
  const Folder folder;
  const Child child([&folder] {
    fill_the_disk();
    static std::optional<LocalNodeId> held;
    held.emplace(*acquire(folder));
    const TransferId first = next(*held);
    return next(*held) == (first + 1) % dronecan::transfer_id_modulus ? int{held->id().value()} : 0;
  });
  CHECK(child.said == 127);
  CHECK(acquire(folder)->id() == NodeId(126));
}

TEST_CASE("a held lock file that names no process is held by somebody") {
  const Folder folder;
  fs::create_directory(folder.locks());
  std::ofstream(folder.file(50)) << GENERATE(as<std::string>{}, "", "garbage");
  const int descriptor = open(folder.file(50).c_str(), O_RDWR | O_CLOEXEC);
  REQUIRE(descriptor >= 0);
  REQUIRE(flock(descriptor, LOCK_EX) == 0);
  const auto local = acquire(folder, NodeId(50));
  close(descriptor);
  REQUIRE_FALSE(local);
  CHECK(local.error().code == Code::no_local_node_id);
  CHECK(local.error().message.find("another process") != std::string::npos);
}

TEST_CASE("a symbolic link in the place of a lock file is not followed") {
  const Folder folder;
  fs::create_directory(folder.locks());
  const fs::path victim = folder.path / "victim";
  std::ofstream(victim) << "precious";
  fs::create_symlink(victim, folder.file(127));
  const auto local = acquire(folder);
  REQUIRE(local);
  CHECK(local->id() == NodeId(126));
  fs::create_symlink(victim, folder.file(50));
  const auto wanted = acquire(folder, NodeId(50));
  REQUIRE_FALSE(wanted);
  CHECK(wanted.error().code == Code::no_local_node_id);
  CHECK(wanted.error().message.find("held by") == std::string::npos);
  CHECK(wanted.error().message.find(folder.file(50).string()) != std::string::npos);
  std::string content;
  std::getline(std::ifstream(victim), content);
  CHECK(content == "precious");
}

TEST_CASE("a symbolic link in the place of the folder is not followed") {
  const Folder folder;
  fs::create_directory(folder.path / "elsewhere");
  fs::create_symlink(folder.path / "elsewhere", folder.locks());
  const Variable runtime("XDG_RUNTIME_DIR", folder.path.string());
  REQUIRE(acquire(folder));
  CHECK(fs::is_empty(folder.path / "elsewhere"));
  CHECK(fs::exists(folder.path / "blactl" / "vcan0.127"));
}

TEST_CASE("where the common folder cannot be written the user's own is taken") {
  const Folder folder;
  const std::string nowhere = "/proc/no/such/folder";
  const Variable runtime("XDG_RUNTIME_DIR", folder.path.string());
  const auto first = LocalNodeId::acquire("vcan0", {}, nowhere);
  const auto second = LocalNodeId::acquire("vcan0", {}, nowhere);
  REQUIRE(first);
  REQUIRE(second);
  CHECK(second->id() == NodeId(126));
  CHECK(fs::exists(folder.path / "blactl" / "vcan0.126"));
}

TEST_CASE("without a runtime folder the state folder is taken, made with its parents") {
  const Folder folder;
  const std::string nowhere = "/proc/no/such/folder";
  const Variable runtime("XDG_RUNTIME_DIR", GENERATE(as<std::string>{}, "", "/proc/no/such"));
  const Variable state("BLACTL_STATE_DIR", (folder.path / "home" / "state" / "blactl").string());
  const auto first = LocalNodeId::acquire("vcan0", {}, nowhere);
  const auto second = LocalNodeId::acquire("vcan0", {}, nowhere);
  REQUIRE(first);
  REQUIRE(second);
  CHECK(second->id() == NodeId(126));
  CHECK(fs::exists(folder.path / "home" / "state" / "blactl" / "vcan0.126"));
}

TEST_CASE("an empty variable is as good as none") {
  const Folder folder;
  const Variable runtime("XDG_RUNTIME_DIR", "");
  const Variable state("BLACTL_STATE_DIR", "");
  const Variable xdg("XDG_STATE_HOME", "");
  const Variable home("HOME", folder.path.string());
  REQUIRE(LocalNodeId::acquire("vcan0", {}, "/proc/no/such/folder"));
  CHECK(fs::exists(folder.path / ".local" / "state" / "blactl" / "vcan0.127"));
}

TEST_CASE("where nothing can be written the process works all the same, without a lock") {
  const std::string nowhere = "/proc/no/such/folder";
  const Variable runtime("XDG_RUNTIME_DIR", nowhere);
  const Variable state("BLACTL_STATE_DIR", nowhere);
  auto first = LocalNodeId::acquire("vcan0", {}, nowhere);
  auto second = LocalNodeId::acquire("vcan0", {}, nowhere);
  REQUIRE(first);
  REQUIRE(second);
  CHECK(first->id() == NodeId(127));
  CHECK(second->id() == NodeId(127));
  const TransferId start = next(*first);
  CHECK(start < dronecan::transfer_id_modulus);
  CHECK(next(*first) == (start + 1) % dronecan::transfer_id_modulus);
}

TEST_CASE("on a bus that nobody else can reach there is no lock, and counters start at 0") {
  auto first = LocalNodeId::unshared({});
  auto second = LocalNodeId::unshared(NodeId(3));
  CHECK(first.id() == NodeId(127));
  CHECK(second.id() == NodeId(3));
  CHECK(next(first) == 0);
  CHECK(next(second) == 0);
}

TEST_CASE("an ID that was moved is still held, once") {
  const Folder folder;
  auto first = acquire(folder);
  REQUIRE(first);
  LocalNodeId moved = std::move(*first);
  CHECK(moved.id() == NodeId(127));
  CHECK(acquire(folder)->id() == NodeId(126));
  moved = *acquire(folder, NodeId(50));
  CHECK(acquire(folder)->id() == NodeId(127));
}
