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

Result<LocalNodeId> acquire(const Folder& folder, LocalNodeId::Candidates candidates = {},
                            std::string_view interface = "vcan0") {
  return LocalNodeId::acquire({.interface = std::string(interface), .folder = folder.locks()},
                              std::move(candidates));
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
  const auto wanted = acquire(folder, {NodeId(50)});
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
  const auto first = acquire(folder, {NodeId(50)});
  REQUIRE(first);
  const auto second = acquire(folder, {NodeId(50)});
  REQUIRE_FALSE(second);
  CHECK(second.error().code == Code::no_local_node_id);
  CHECK(second.error().message.find(std::to_string(getpid())) != std::string::npos);
  CHECK_FALSE(fs::exists(folder.file(127)));
}

TEST_CASE("an ID that another node has is left to it, and the next process does not try it first") {
  const Folder folder;
  {
    auto local = acquire(folder);
    REQUIRE(local);
    REQUIRE(local->give_way("vcan0"));
    CHECK(local->id() == NodeId(126));
    CHECK(local->passed_over() == "127 is used by another node");
    CHECK(local->lock_file() == folder.file(126));
    const Child other([&] { return acquire(folder, {NodeId(127)}) ? 127 : 0; });
    CHECK(other.said == 127); // nobody holds what is not used
  }
  const auto next = acquire(folder);
  REQUIRE(next);
  CHECK(next->id() == NodeId(126));
  CHECK(next->passed_over() == "127 was used by another node before");
  const auto elsewhere = acquire(folder, {}, "vcan1");
  REQUIRE(elsewhere);
  CHECK(elsewhere->id() == NodeId(127));
}

TEST_CASE("an ID that another node had is better than none") {
  const Folder folder;
  {
    auto local = acquire(folder);
    REQUIRE(local);
    REQUIRE(local->give_way("vcan0"));
  }
  const auto first = acquire(folder);
  REQUIRE(first);
  CHECK(first->id() == NodeId(126));
  const auto second = acquire(folder);
  REQUIRE(second);
  CHECK(second->id() == NodeId(127));
  CHECK(second->passed_over() == "126 is held by process " + std::to_string(getpid()));
}

TEST_CASE("where others have both IDs there is none") {
  const Folder folder;
  auto local = acquire(folder);
  REQUIRE(local);
  REQUIRE(local->give_way("vcan0"));
  const auto taken = local->give_way("vcan0");
  REQUIRE_FALSE(taken);
  CHECK(taken.error().code == Code::no_local_node_id);
  CHECK_FALSE(taken.error().node_id);
  CHECK(taken.error().message == "no node ID is free for this process on vcan0: 127 is used by "
                                 "another node, 126 is used by another node");
  CHECK(taken.error().hint ==
        "give a free node ID: --local-node-id ID; if 126 is a servo, give it another one for good: "
        "blactl --local-node-id ID set -n 126 static_node_id=N --save");
}

TEST_CASE("what another process holds is not given way to") {
  const Folder folder;
  auto first = acquire(folder);
  const auto second = acquire(folder);
  REQUIRE(first);
  REQUIRE(second);
  const auto none = first->give_way("vcan0");
  REQUIRE_FALSE(none);
  CHECK(none.error().code == Code::no_local_node_id);
  CHECK(none.error().message.find("127 is used by another node, 126 is held by process ") !=
        std::string::npos);
  CHECK(first->id() == NodeId(127));
}

TEST_CASE("an ID that was asked for is not changed for another one") {
  for (const bool shared : {false, true}) {
    const Folder folder;
    auto local = shared ? acquire(folder, {NodeId(50)})
                        : Result<LocalNodeId>(LocalNodeId::unshared({NodeId(50)}));
    REQUIRE(local);
    const auto taken = local->give_way("vcan0");
    REQUIRE_FALSE(taken);
    CHECK(taken.error().code == Code::duplicate_node_id);
    CHECK(taken.error().message == "node ID 50 is used by another node on vcan0");
    CHECK(taken.error().node_id == 50);
  }
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
  const auto local = acquire(folder, {NodeId(50)});
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
  const auto wanted = acquire(folder, {NodeId(50)});
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
  const auto first = LocalNodeId::acquire({.interface = "vcan0", .folder = nowhere}, {});
  const auto second = LocalNodeId::acquire({.interface = "vcan0", .folder = nowhere}, {});
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
  const auto first = LocalNodeId::acquire({.interface = "vcan0", .folder = nowhere}, {});
  const auto second = LocalNodeId::acquire({.interface = "vcan0", .folder = nowhere}, {});
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
  REQUIRE(LocalNodeId::acquire({.interface = "vcan0", .folder = "/proc/no/such/folder"}, {}));
  CHECK(fs::exists(folder.path / ".local" / "state" / "blactl" / "vcan0.127"));
}

TEST_CASE("where nothing can be written the process works all the same, without a lock") {
  const std::string nowhere = "/proc/no/such/folder";
  const Variable runtime("XDG_RUNTIME_DIR", nowhere);
  const Variable state("BLACTL_STATE_DIR", nowhere);
  auto first = LocalNodeId::acquire({.interface = "vcan0", .folder = nowhere}, {});
  auto second = LocalNodeId::acquire({.interface = "vcan0", .folder = nowhere}, {});
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
  auto second = LocalNodeId::unshared({NodeId(3)});
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
  moved = *acquire(folder, {NodeId(50)});
  CHECK(acquire(folder)->id() == NodeId(127));
}

TEST_CASE("interfaces of one name in two network namespaces have their own IDs") {
  const Folder folder;
  const LockPlace here{.interface = "can0", .network = "@1", .folder = folder.locks()};
  const LockPlace there{.interface = "can0", .network = "@2", .folder = folder.locks()};
  const auto first = LocalNodeId::acquire(here, {});
  const auto second = LocalNodeId::acquire(there, {});
  const auto third = LocalNodeId::acquire(here, {});
  REQUIRE((first && second && third));
  CHECK(first->id() == NodeId(127));
  CHECK(second->id() == NodeId(127));
  CHECK(third->id() == NodeId(126));
  CHECK(first->lock_file() == folder.locks() + "/can0@1.127");
}

TEST_CASE("an ID that is not the first one says what became of that") {
  const Folder folder;
  const auto first = acquire(folder);
  const auto second = acquire(folder);
  REQUIRE((first && second));
  CHECK(first->passed_over().empty());
  CHECK(second->passed_over() == fmt::format("127 is held by process {}", getpid()));
}

TEST_CASE("a folder that cannot be used is passed over, whatever names it") {
  const Folder folder;
  fs::create_symlink("loop", folder.path / "loop");
  std::ofstream(folder.path / "file") << "no folder";
  const std::string useless =
      GENERATE_COPY(std::string("loop"), std::string("file"), std::string(5000, 'x'));
  const std::string path = (folder.path / useless).string();
  const Variable runtime("XDG_RUNTIME_DIR", path);
  SECTION("then the state folder is taken") {
    const Variable state("BLACTL_STATE_DIR", (folder.path / "state").string());
    const auto local = LocalNodeId::acquire({.interface = "can0", .folder = path}, {});
    REQUIRE(local);
    CHECK(local->lock_file() == (folder.path / "state" / "can0.127").string());
  }
  SECTION("and where none is left there is no lock") {
    const Variable state("BLACTL_STATE_DIR", path);
    const auto local = LocalNodeId::acquire({.interface = "can0", .folder = path}, {});
    REQUIRE(local);
    CHECK(local->lock_file().empty());
  }
}

TEST_CASE("a relative folder in the environment is none: processes start anywhere") {
  const Folder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path);
  const Variable runtime("XDG_RUNTIME_DIR", ".");
  const Variable state("BLACTL_STATE_DIR", "");
  const Variable xdg("XDG_STATE_HOME", "relative");
  const Variable home("HOME", (folder.path / "home").string());
  const auto local = LocalNodeId::acquire({.interface = "can0", .folder = "/proc/no/such"}, {});
  fs::current_path(before);
  REQUIRE(local);
  CHECK(local->lock_file() == (folder.path / "home/.local/state/blactl/can0.127").string());
}

TEST_CASE("the name of an interface may be longer than that of a file") {
  const Folder folder;
  const std::string end(300, 'x');
  const auto one = acquire(folder, {}, "slcan:/dev/a/" + end);
  const auto other = acquire(folder, {}, "slcan:/dev/b/" + end);
  REQUIRE((one && other));
  CHECK(one->id() == NodeId(127));
  CHECK(other->id() == NodeId(127));
  CHECK_FALSE(one->lock_file().empty());
}

TEST_CASE("lock files that nobody can open are told with what to look at") {
  const Folder folder;
  fs::create_directories(folder.file(127));
  fs::create_directories(folder.file(126));
  const auto local = acquire(folder);
  REQUIRE_FALSE(local);
  CHECK(local.error().code == Code::no_local_node_id);
  CHECK(local.error().message.find(folder.file(126).string()) != std::string::npos);
  CHECK(local.error().hint.find("ls -ld " + folder.locks()) != std::string::npos);
}
