// State files between processes: what a killed one leaves, what older versions left, who waits for
// whom, and where damage is met.

#include "blactl/base/hex.hpp"
#include "blactl/state/allocation_store.hpp"
#include "blactl/state/counter_store.hpp"
#include "blactl/state/ledger_store.hpp"
#include "blactl/state/proof_store.hpp"
#include "blactl/state/snapshot_store.hpp"
#include "blactl/state/state_folder.hpp"

#include "catch.hpp"
#include "database_files.hpp"
#include "processes.hpp"

#include <fmt/format.h>

#include <signal.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::state;
using namespace blactl::state::test;
using namespace std::chrono_literals;
using dronecan::NodeId;

namespace fs = std::filesystem;

namespace {

std::atomic<int> syncs{0}, folder_syncs{0};
std::atomic<int> last_sync{0}; ///< this process is killed in its place; 0: never

void note_sync(int descriptor) {
  struct stat info{};
  folder_syncs += fstat(descriptor, &info) == 0 && S_ISDIR(info.st_mode) ? 1 : 0;
  if (++syncs == last_sync) {
    kill(getpid(), SIGKILL);
  }
}

} // namespace

// In place of those of the C library, which SQLite would call: counting is the only way to see what
// a power cut would leave.

extern "C" int fsync(int descriptor) {
  note_sync(descriptor);
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}

extern "C" int fdatasync(int descriptor) {
  note_sync(descriptor);
  return static_cast<int>(syscall(SYS_fdatasync, descriptor));
}

namespace {

fs::path state_of(const Folder& folder) {
  return folder.path / "state";
}

fs::path table_of(const Folder& folder) {
  return state_of(folder) / "allocations.db";
}

fs::path beside(const fs::path& file, const std::string& suffix) {
  return file.string() + suffix;
}

Result<AllocationStore> try_open(const Folder& folder, Access access = Access::write,
                                 std::chrono::milliseconds patience = 10s) {
  return AllocationStore::open(state_of(folder).string(), access, patience);
}

AllocationStore opened(const Folder& folder, Access access = Access::write,
                       std::chrono::milliseconds patience = 10s) {
  auto store = try_open(folder, access, patience);
  if (!store) {
    FAIL(store.error().message);
  }
  return std::move(*store);
}

std::vector<AllocationEntry> entries_in(const Folder& folder, Access access = Access::read) {
  return opened(folder, access).entries().value();
}

/// Gives IDs to units 1 and so on.
std::vector<AllocationEntry> fill_with(const Folder& folder, int units) {
  auto store = opened(folder);
  for (int i = 1; i <= units; ++i) {
    REQUIRE(store.allocate(unit(i), {}, noon));
  }
  return store.entries().value();
}

/// The header tells it (Database File Format, 1.3).
bool is_write_ahead(const Folder& folder) {
  const std::string versions = bytes_of(table_of(folder)).substr(18, 2);
  REQUIRE((versions == "\1\1" || versions == "\2\2"));
  return versions == "\2\2";
}

/// Units 1 and 2 exchange their IDs, and 3 gets one.
Result<void> exchange(AllocationStore& store) {
  return store.enter(std::array{AllocationStore::Wish{unit(1), NodeId(124)},
                                AllocationStore::Wish{unit(2), NodeId(125)},
                                AllocationStore::Wish{unit(3), NodeId(7)}},
                     noon + 1h);
}

/// Whether a process that exchanges was killed in place of the sync with this number.
bool is_killed_at(const Folder& folder, int sync) {
  const pid_t pid = fork();
  REQUIRE(pid >= 0);
  if (pid == 0) {
    auto store = try_open(folder);
    syncs = 0;
    last_sync = sync;
    _exit(store && exchange(*store) ? 0 : 1);
  }
  int status = 0;
  REQUIRE(waitpid(pid, &status, 0) == pid);
  REQUIRE((WIFSIGNALED(status) || WEXITSTATUS(status) == 0));
  return WIFSIGNALED(status);
}

/// Leaves a transaction that was broken off while it wrote into the table.
void leave_unfinished(const Folder& folder) {
  const std::string before = bytes_of(table_of(folder));
  for (int sync = 1; bytes_of(table_of(folder)) == before; ++sync) {
    REQUIRE(is_killed_at(folder, sync));
  }
  REQUIRE(fs::exists(beside(table_of(folder), "-journal")));
}

/// A connection of another program.
class Other {
 public:
  explicit Other(const fs::path& path) {
    sqlite3* handle = nullptr;
    REQUIRE(sqlite3_open(path.c_str(), &handle) == SQLITE_OK);
    handle_.reset(handle);
  }

  void run(const char* sql) {
    INFO(sql);
    REQUIRE(sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr) == SQLITE_OK);
  }

 private:
  struct Closer {
    void operator()(sqlite3* handle) const { sqlite3_close(handle); }
  };

  std::unique_ptr<sqlite3, Closer> handle_;
};

/// Makes the index of the table tell another unit than the table itself.
void change_index(const Folder& folder) {
  std::string bytes = bytes_of(table_of(folder));
  const auto id = unit(2);
  const std::string in_file(id.begin(), id.end());
  const auto at = bytes.rfind(in_file);
  REQUIRE(at > 8192); // on the page of the index
  bytes[at + 15] ^= 1;
  write_bytes(table_of(folder), bytes);
}

std::vector<Error> faults_in(const Folder& folder) {
  return check_state_files(state_of(folder).string());
}

} // namespace

// What outlives a process, and a power cut.

TEST_CASE("a table is in rollback mode: no transaction can be lost by a checkpoint") {
  const Folder folder;
  auto store = opened(folder);
  REQUIRE(store.allocate(unit(1), {}, noon));
  CHECK_FALSE(is_write_ahead(folder));
  CHECK(names_in(state_of(folder)) == std::set<std::string>{"allocations.db"});
}

TEST_CASE("what was told is on the disk, and what changes nothing costs nothing") {
  const Folder folder;
  syncs = 0;
  auto store = opened(folder);
  CHECK(syncs > 0);
  const auto syncs_of = [](const auto& work) {
    syncs = folder_syncs = 0;
    REQUIRE(work());
    return syncs.load();
  };
  CHECK(syncs_of([&] { return store.allocate(unit(1), {}, noon); }) > 0);
  CHECK(folder_syncs == 2); // the journal is there, and gone for good
  CHECK(syncs_of([&] { return store.allocate(unit(2), {}, noon); }) > 0);
  CHECK(syncs_of([&] { return store.allocate(unit(1), {}, noon); }) == 0);
  CHECK(syncs_of([&] { return exchange(store); }) > 0);
  CHECK(syncs_of([&] { return exchange(store); }) == 0);
  CHECK(syncs_of([&] { return store.forget(unit(3)); }) > 0);
  CHECK(syncs_of([&] { return store.entries(); }) == 0);
  CHECK(syncs_of([&] { return try_open(folder); }) == 0);
}

TEST_CASE("a process that is killed at any moment leaves all of a transaction, or nothing of it") {
  const Access access = GENERATE(Access::read, Access::write);
  std::set<std::size_t> sizes;
  for (int sync = 1;; ++sync) {
    INFO("killed at sync " << sync);
    const Folder folder;
    const auto before = fill_with(folder, 2);
    if (!is_killed_at(folder, sync)) {
      CHECK(sync > 4);
      break;
    }
    const auto after = entries_in(folder, access);
    CHECK((after.size() == 3 || after == before));
    sizes.insert(after.size());
    auto store = opened(folder);
    REQUIRE(exchange(store));
    CHECK(store.entries()->size() == 3);
    CHECK(names_in(state_of(folder)) == std::set<std::string>{"allocations.db"});
    CHECK(faults_in(folder).empty());
  }
  CHECK(sizes == std::set<std::size_t>{2, 3});
}

TEST_CASE("who only reads rolls a broken transaction back, and leaves nothing of it") {
  const Folder folder;
  const auto before = fill_with(folder, 2);
  leave_unfinished(folder);
  SECTION("a store") {
    CHECK(entries_in(folder) == before);
  }
  SECTION("the check") {
    CHECK(faults_in(folder).empty());
  }
  CHECK(names_in(state_of(folder)) == std::set<std::string>{"allocations.db"});
  CHECK(entries_in(folder) == before);
}

TEST_CASE("where a broken transaction cannot be rolled back that is said, and nothing is read") {
  const Folder folder;
  fill_with(folder, 2);
  leave_unfinished(folder);
  const std::string file = bytes_of(table_of(folder));
  const std::string journal = bytes_of(beside(table_of(folder), "-journal"));
  const auto [of_file, of_folder] =
      GENERATE(std::pair(0444U, 0555U), std::pair(0444U, 0777U), std::pair(0666U, 0555U));
  for (const auto& name : names_in(state_of(folder))) {
    fs::permissions(state_of(folder) / name, fs::perms(of_file));
  }
  fs::permissions(folder.path, fs::perms(0755));
  fs::permissions(state_of(folder), fs::perms(of_folder));
  const Child child([&] {
    become_nobody();
    const auto store = try_open(folder, Access::read);
    const bool is_told = !store &&
                         store.error().message.find("was broken off") != std::string::npos &&
                         store.error().message.find("Permission denied") != std::string::npos;
    return is_told ? said(store) : -1;
  });
  CHECK(child.said == as_said(Code::permission));
  CHECK(bytes_of(beside(table_of(folder), "-journal")) == journal);
  if (of_file == 0444U) {
    CHECK(bytes_of(table_of(folder)) == file);
  }
  fs::permissions(state_of(folder), fs::perms(0755)); // to be removed
}

TEST_CASE("who may only read reads") {
  const Folder folder;
  fill_with(folder, 2);
  fs::permissions(folder.path, fs::perms(0755));
  fs::permissions(table_of(folder), fs::perms(0444));
  fs::permissions(state_of(folder), fs::perms(0555));
  const Child child([&] {
    become_nobody();
    const auto store = try_open(folder, Access::read);
    return store && store->entries() ? static_cast<int>(store->entries()->size()) : -said(store);
  });
  CHECK(child.said == 2);
  fs::permissions(state_of(folder), fs::perms(0755)); // to be removed
}

TEST_CASE("who may write the file but not beside it is told before anything is begun") {
  const Folder folder;
  fill_with(folder, 2);
  fs::permissions(folder.path, fs::perms(0755));
  fs::permissions(table_of(folder), fs::perms(0666));
  fs::permissions(state_of(folder), fs::perms(0555));
  const Child child([&] {
    become_nobody();
    return said(try_open(folder));
  });
  CHECK(child.said == as_said(Code::permission));
  fs::permissions(state_of(folder), fs::perms(0755)); // to be removed
}

// Files of older versions, which are in write-ahead mode.

TEST_CASE("a file in write-ahead mode leaves it when it is opened") {
  const Folder folder;
  const auto entries = fill_with(folder, 2);
  run_sql(table_of(folder), "PRAGMA journal_mode = WAL");
  REQUIRE(is_write_ahead(folder));
  CHECK(entries_in(folder, GENERATE(Access::read, Access::write)) == entries);
  CHECK_FALSE(is_write_ahead(folder));
  CHECK(names_in(state_of(folder)) == std::set<std::string>{"allocations.db"});
}

TEST_CASE("what a killed older version has committed to its log is not lost") {
  const Folder folder;
  auto entries = fill_with(folder, 2);
  leave_in_log(table_of(folder),
               fmt::format("INSERT INTO allocations VALUES (7, x'{}', 5)", hex(unit(3))));
  REQUIRE(is_write_ahead(folder));
  REQUIRE(fs::file_size(beside(table_of(folder), "-wal")) > 4096);
  entries.insert(entries.begin(), {NodeId(7), unit(3), WallTime(5us)});
  CHECK(entries_in(folder, GENERATE(Access::read, Access::write)) == entries);
  CHECK_FALSE(is_write_ahead(folder));
  CHECK(names_in(state_of(folder)) == std::set<std::string>{"allocations.db"});
  CHECK(entries_in(folder) == entries);
}

TEST_CASE(
    "a file that somebody has open in write-ahead mode is used as it is, until the next time") {
  const Folder folder;
  fill_with(folder, 2);
  {
    Other other(table_of(folder));
    other.run("PRAGMA journal_mode = WAL; SELECT count(*) FROM allocations");
    auto store = opened(folder, Access::write, 0ms);
    REQUIRE(exchange(store));
    CHECK(is_write_ahead(folder));
    other.run("INSERT INTO allocations VALUES (9, x'00112233445566778899aabbccddeeff', 5)");
    CHECK(store.entries()->size() == 4);
  }
  CHECK(entries_in(folder).size() == 4);
  CHECK_FALSE(is_write_ahead(folder));
}

TEST_CASE("a damaged file and its log of write-ahead mode stay as they are") {
  const Folder folder;
  fill_with(folder, 3);
  leave_in_log(table_of(folder), "DELETE FROM allocations WHERE node_id = 125");
  std::string bad = bytes_of(table_of(folder));
  bad.replace(100, 1, 1, '\0'); // no kind of page
  write_bytes(table_of(folder), bad);
  const std::string log = bytes_of(beside(table_of(folder), "-wal"));
  for (const Access access : {Access::write, Access::read}) {
    const auto store = try_open(folder, access);
    REQUIRE_FALSE(store);
    CHECK(store.error().code == Code::bad_file);
    CHECK(bytes_of(table_of(folder)) == bad);
    CHECK(bytes_of(beside(table_of(folder), "-wal")) == log);
  }
}

// Who waits for whom.

TEST_CASE("who cannot read because another process writes waits no longer than it should") {
  const Folder folder;
  fill_with(folder, 1);
  const auto store = opened(folder, Access::read, 20ms);
  Other other(table_of(folder));
  other.run("BEGIN EXCLUSIVE");
  CHECK(store.find(unit(1)).error().code == Code::busy);
  CHECK(try_open(folder, GENERATE(Access::read, Access::write), 20ms).error().code == Code::busy);
  other.run("COMMIT");
  CHECK(store.find(unit(1)).value()->node_id == NodeId(125));
}

TEST_CASE("what cannot be committed because another process reads is not half done") {
  const Folder folder;
  const auto before = fill_with(folder, 2);
  auto store = opened(folder, Access::write, 20ms);
  Other other(table_of(folder));
  other.run("BEGIN; SELECT count(*) FROM allocations");
  const auto refused = exchange(store);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == Code::busy);
  CHECK(refused.error().message.find("is using") != std::string::npos);
  CHECK(store.entries() == before);
  other.run("COMMIT");
  CHECK(entries_in(folder) == before);
  CHECK(exchange(store));
}

// Where damage is met.

TEST_CASE("not every opening reads the whole file") {
  const Folder folder;
  fill_with(folder, 3);
  change_index(folder);
  const std::string bad = bytes_of(table_of(folder));
  CHECK(try_open(folder));
  SECTION("the check does") {
    const auto faults = faults_in(folder);
    REQUIRE(faults.size() == 1);
    CHECK(faults.front().code == Code::bad_file);
    CHECK(faults.front().message.find("is damaged") != std::string::npos);
    CHECK(faults.front().hint.find("mv " + table_of(folder).string()) != std::string::npos);
  }
  SECTION("the first one does after a process ended in the middle of something") {
    write_bytes(beside(table_of(folder), GENERATE(as<std::string>{}, "-journal", "-wal")),
                std::string(512, '\0'));
    const auto store = try_open(folder, GENERATE(Access::read, Access::write));
    REQUIRE_FALSE(store);
    CHECK(store.error().code == Code::bad_file);
    CHECK(store.error().message.find("is damaged") != std::string::npos);
  }
  CHECK(bytes_of(table_of(folder)) == bad);
}

TEST_CASE("a row that nobody can have written is damage, not a crash") {
  const Folder folder;
  fill_with(folder, 2);
  run_sql(table_of(folder), "PRAGMA ignore_check_constraints = 1;" +
                                GENERATE(as<std::string>{}, "UPDATE allocations SET node_id = 300",
                                         "UPDATE allocations SET node_id = 0",
                                         "UPDATE allocations SET node_id = -9223372036854775808",
                                         "UPDATE allocations SET unique_id = x'00'",
                                         "UPDATE allocations SET unique_id = zeroblob(17)") +
                                " WHERE node_id = 124");
  auto store = opened(folder);
  const auto entries = store.entries();
  REQUIRE_FALSE(entries);
  CHECK(entries.error().code == Code::bad_file);
  CHECK(entries.error().message.find("is damaged") != std::string::npos);
  CHECK(faults_in(folder).size() == 1);
}

TEST_CASE("no flipped byte changes an ID unseen: the check finds it, or it means nothing") {
  const Folder folder;
  const auto entries = fill_with(folder, 5);
  const std::string good = bytes_of(table_of(folder));
  int found = 0;
  for (std::size_t at = 0; at < good.size(); ++at) {
    if (good[at] == '\0' && at % 97 != 0 && at > 100) {
      continue; // most of the file is empty
    }
    INFO("byte " << at);
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ (1 << at % 8));
    write_bytes(table_of(folder), bad);
    const auto store = try_open(folder, Access::read);
    const auto read = store ? store->entries() : std::unexpected(store.error());
    REQUIRE((read || read.error().code == Code::bad_file));
    const auto faults = faults_in(folder);
    REQUIRE(bytes_of(table_of(folder)) == bad);
    REQUIRE(names_in(state_of(folder)).size() == 1);
    if (!faults.empty()) {
      ++found;
      REQUIRE(faults.front().code == Code::bad_file);
      continue;
    }
    REQUIRE(read);
    REQUIRE(read->size() == entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
      REQUIRE(read->at(i).node_id == entries[i].node_id);
      REQUIRE(read->at(i).unique_id == entries[i].unique_id);
    }
  }
  CHECK(found > 300);
}

TEST_CASE("every state file is checked, and none is made by that") {
  const Folder folder;
  const std::string state = state_of(folder).string();
  CHECK(faults_in(folder).empty());
  CHECK_FALSE(fs::exists(state));
  CHECK(check_state_files("").empty());
  REQUIRE(AllocationStore::open(state, Access::write));
  CHECK(faults_in(folder).empty());
  CHECK(names_in(state).size() == 1);
  REQUIRE(CounterStore::open(state, Access::write));
  REQUIRE(LedgerStore::open(state, Access::write));
  REQUIRE(ProofStore::open(state, Access::write));
  REQUIRE(SnapshotStore::open(state, Access::write));
  CHECK(faults_in(folder).empty());
  const auto names = names_in(state);
  REQUIRE(names.size() == 5);
  for (const auto& name : names) {
    write_bytes(fs::path(state) / name, "no database");
  }
  const auto faults = faults_in(folder);
  REQUIRE(faults.size() == 5);
  for (const auto& name : names) {
    INFO(name);
    CHECK(std::ranges::any_of(
        faults, [&](const Error& fault) { return fault.message.find(name) != std::string::npos; }));
  }
}
