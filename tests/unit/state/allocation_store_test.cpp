#include "blactl/base/text.hpp"
#include "blactl/state/allocation_store.hpp"
#include "blactl/state/state_folder.hpp"

#include "catch.hpp"
#include "database_files.hpp"
#include "processes.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::state;
using namespace blactl::state::test;
using namespace std::chrono_literals;
using dronecan::NodeId;
using dronecan::UniqueId;

namespace fs = std::filesystem;

namespace {

Result<void> put(AllocationStore& store, const UniqueId& unique_id, NodeId id, WallTime at) {
  return store.enter(std::array{AllocationStore::Wish{unique_id, id}}, at);
}

} // namespace

using Access = AllocationStore::Access;

namespace {

/// The unique ID of the unit with this number.
fs::path state_of(const Folder& folder) {
  return folder.path / "state";
}

fs::path table_of(const Folder& folder) {
  return state_of(folder) / "allocations.db";
}

Result<AllocationStore> try_open(const Folder& folder, Access access = Access::write) {
  return AllocationStore::open(state_of(folder).string(), access, 10s);
}

AllocationStore opened(const Folder& folder, Access access = Access::write) {
  auto store = try_open(folder, access);
  if (!store) {
    FAIL(store.error().message);
  }
  return std::move(*store);
}

/// 0: an error.
int assigned(AllocationStore& store, int number, const AllocationChoice& choice = {}) {
  const auto id = store.allocate(unit(number), choice, noon);
  return id ? id->node_id.value() : 0;
}

/// One entry or none.
template <class Id> std::vector<AllocationEntry> found(AllocationStore& store, Id id) {
  const auto entry = store.find(id);
  REQUIRE(entry);
  return *entry ? std::vector{**entry} : std::vector<AllocationEntry>();
}

AllocationChoice range(int first, int last) {
  return {.first = NodeId(static_cast<std::uint8_t>(first)),
          .last = NodeId(static_cast<std::uint8_t>(last))};
}

AllocationChoice preferring(int id, NodeIds taken = {}) {
  return {.preferred = NodeId(static_cast<std::uint8_t>(id)), .taken = taken};
}

std::string mode_of(const fs::path& path) {
  struct stat info{};
  REQUIRE(lstat(path.c_str(), &info) == 0);
  return fmt::format("{:o}", info.st_mode & 07777U);
}

/// A table with these units, as it lies on the disk when nobody uses it.
std::vector<AllocationEntry> fill_with(const Folder& folder, int units) {
  auto store = opened(folder);
  for (int i = 1; i <= units; ++i) {
    REQUIRE(assigned(store, i) != 0);
  }
  return *store.entries();
}

/// The file is refused for reading and writing, says where it is and how to go on, and stays as it
/// was with nothing laid beside it.
void check_refused(const Folder& folder, const std::string& message) {
  const std::string before = bytes_of(table_of(folder));
  const auto names = names_in(state_of(folder));
  for (const Access access : {Access::write, Access::read}) {
    const auto store = try_open(folder, access);
    REQUIRE_FALSE(store);
    CHECK(store.error().code == Code::bad_file);
    CHECK(store.error().message.find(table_of(folder).string()) != std::string::npos);
    CHECK(store.error().message.find(message) != std::string::npos);
    CHECK(store.error().hint.find("mv " + table_of(folder).string()) != std::string::npos);
    CHECK(store.error().hint.find("blactl alloc --import") != std::string::npos);
    CHECK(bytes_of(table_of(folder)) == before);
    CHECK(names_in(state_of(folder)) == names);
  }
}

/// What a child tells of one unit.
struct Report {
  int unit;
  int node_id; ///< 0: an error
};

/// Another process that reports each unit it has served, until it ends or is killed.
class Allocating {
 public:
  using Tell = std::function<void(int unit, int node_id)>;

  explicit Allocating(const std::function<void(const Tell&)>& work) {
    std::array<int, 2> ends{};
    REQUIRE(pipe(ends.data()) == 0);
    pid_ = fork();
    REQUIRE(pid_ >= 0);
    if (pid_ == 0) {
      close(ends[0]);
      work([&](int number, int node_id) {
        const Report report{number, node_id};
        (void)!write(ends[1], &report, sizeof report);
      });
      _exit(0);
    }
    close(ends[1]);
    from_ = ends[0];
  }

  ~Allocating() {
    end();
    close(from_);
  }

  Allocating(const Allocating&) = delete;
  Allocating& operator=(const Allocating&) = delete;

  /// Empty: the process has ended and all was read.
  std::optional<Report> next() const {
    Report report{};
    const bool is_whole = read(from_, &report, sizeof report) == sizeof report;
    return is_whole ? std::optional(report) : std::nullopt;
  }

  void end() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
      pid_ = 0;
    }
  }

 private:
  pid_t pid_ = 0;
  int from_ = -1;
};

} // namespace

// Which ID.

TEST_CASE("units that do not mind get 125, 124 and so on") {
  const Folder folder;
  auto store = opened(folder);
  CHECK(assigned(store, 1) == 125);
  CHECK(assigned(store, 2) == 124);
  CHECK(assigned(store, 3) == 123);
}

TEST_CASE("a unit that prefers an ID gets it, else the next free one above, then below") {
  const Folder folder;
  auto store = opened(folder);
  CHECK(assigned(store, 1, preferring(123)) == 123);
  CHECK(assigned(store, 2, preferring(123)) == 124);
  CHECK(assigned(store, 3, preferring(123)) == 125);
  CHECK(assigned(store, 4, preferring(123)) == 122);
  CHECK(assigned(store, 5, preferring(1)) == 1);
  CHECK(assigned(store, 6, preferring(1)) == 2);
}

TEST_CASE("126 and 127 are for tools: who prefers them gets 125") {
  const Folder folder;
  auto store = opened(folder);
  CHECK(assigned(store, 1, preferring(127)) == 125);
  CHECK(assigned(store, 2, preferring(126)) == 124);
  CHECK(assigned(store, 3, range(126, 127)) == 0);
  CHECK(assigned(store, 4, range(0, 0)) == 0);
}

TEST_CASE("what is taken on the bus is not given") {
  const Folder folder;
  auto store = opened(folder);
  NodeIds taken;
  taken.set(125).set(124).set(50).set(51);
  CHECK(assigned(store, 1, preferring(0, taken)) == 123);
  CHECK(assigned(store, 2, preferring(50, taken)) == 52);
}

TEST_CASE("new units get an ID of the range, whatever they prefer") {
  const Folder folder;
  auto store = opened(folder);
  AllocationChoice choice = range(10, 13);
  CHECK(assigned(store, 1, choice) == 13);
  choice.preferred = NodeId(11);
  CHECK(assigned(store, 2, choice) == 11);
  CHECK(assigned(store, 3, choice) == 12);
  choice.preferred = NodeId(3);
  CHECK(assigned(store, 4, choice) == 10);
  CHECK(assigned(store, 5, choice) == 10); // of the unit that was longest unseen
}

TEST_CASE("a unit keeps its ID, also where it is out of the range or in use by another node") {
  const Folder folder;
  auto store = opened(folder);
  REQUIRE(assigned(store, 1) == 125);
  AllocationChoice choice = range(10, 20);
  choice.preferred = NodeId(15);
  choice.taken.set(125);
  CHECK(store.allocate(unit(1), choice, noon + 1h) == Allocation{NodeId(125)});
  CHECK(store.entries() == std::vector{AllocationEntry{NodeId(125), unit(1), noon + 1h}});
}

TEST_CASE("an ID that is lost to another node is replaced by a new one") {
  const Folder folder;
  auto store = opened(folder);
  REQUIRE(assigned(store, 1) == 125);
  AllocationChoice choice{.is_lost = true};
  choice.taken.set(125);
  CHECK(store.allocate(unit(1), choice, noon + 1h) == Allocation{NodeId(124), true});
  CHECK(store.entries() == std::vector{AllocationEntry{NodeId(124), unit(1), noon + 1h}});
}

TEST_CASE("where all IDs were given, the unit that was longest unseen and is not here yields") {
  const Folder folder;
  auto store = opened(folder);
  for (int i = 1; i <= 3; ++i) {
    REQUIRE(store.allocate(unit(i), range(11, 13), noon + i * 1h)->is_new);
  }
  REQUIRE(store.allocate(unit(1), range(11, 13), noon + 9h)); // it was seen again
  AllocationChoice choice = range(11, 13);
  choice.taken.set(12); // of unit 2
  const Allocation expected{NodeId(11), true, unit(3)};
  CHECK(store.allocate(unit(4), choice, noon + 10h) == expected);
  CHECK(store.find(unit(3)).value() == std::nullopt);
  CHECK(store.entries()->size() == 3);
}

TEST_CASE("all 125 IDs are given once before one is given to another unit") {
  const Folder folder;
  auto store = opened(folder);
  std::set<int> given;
  for (int i = 1; i <= 125; ++i) {
    given.insert(assigned(store, i, preferring(i % 128)));
  }
  CHECK(given.size() == 125);
  CHECK(*given.begin() == 1);
  CHECK(*given.rbegin() == 125);
  CHECK(store.allocate(unit(126), {}, noon)->former);
  CHECK(store.entries()->size() == 125);
  CHECK(assigned(store, 77) != 0);
}

TEST_CASE(
    "a table that has served 320 units on 40 buses gives every one on its bus an ID of its own") {
  constexpr int buses = 40, units = 8, range_of = 10;
  const Folder folder;
  auto store = opened(folder);
  for (int visit = 0; visit < 2; ++visit) { // the first buses come back, and count as new
    for (int bus = 0; bus < buses; ++bus) {
      AllocationChoice choice = range(11, 11 + range_of - 1);
      for (int i = 0; i < units; ++i) {
        const auto now = noon + (visit * buses + bus) * 1h;
        const auto given = store.allocate(unit(bus * units + i), choice, now);
        REQUIRE(given);
        const std::size_t id = given->node_id.value();
        CHECK_FALSE(choice.taken[id]);
        choice.taken.set(id);
      }
    }
  }
  CHECK(store.entries()->size() == range_of);
}

TEST_CASE("a full range leaves the table as it was") {
  const Folder folder;
  auto store = opened(folder);
  NodeIds taken;
  taken.set(30);
  AllocationChoice choice = range(30, 30);
  choice.taken = taken;
  const auto full = store.allocate(unit(1), choice, noon);
  REQUIRE_FALSE(full);
  CHECK(full.error().code == Code::table_full);
  CHECK(full.error().message == "nodes on the bus have all node IDs from 30 to 30");
  CHECK(full.error().hint.find("--range") != std::string::npos);
  CHECK(store.entries()->empty());
}

// What the user wishes.

TEST_CASE("entries come by node ID, with the time of their allocation") {
  const Folder folder;
  auto store = opened(folder);
  CHECK(store.entries()->empty());
  REQUIRE(assigned(store, 1) == 125);
  REQUIRE(put(store, unit(2), NodeId(7), noon + 1us));
  const std::vector<AllocationEntry> expected{{NodeId(7), unit(2), noon + 1us},
                                              {NodeId(125), unit(1), noon}};
  CHECK(store.entries() == expected);
  CHECK(found(store, unit(2)) == std::vector{expected[0]});
  CHECK(found(store, NodeId(125)) == std::vector{expected[1]});
  CHECK(found(store, unit(3)).empty());
  CHECK(found(store, NodeId(8)).empty());
}

TEST_CASE("the user gives a unit another ID, and the old one is free") {
  const Folder folder;
  auto store = opened(folder);
  REQUIRE(assigned(store, 1) == 125);
  REQUIRE(put(store, unit(1), NodeId(21), noon + 1h));
  CHECK(store.entries() == std::vector{AllocationEntry{NodeId(21), unit(1), noon + 1h}});
  CHECK(assigned(store, 1) == 21);
  CHECK(assigned(store, 2) == 125);
}

TEST_CASE("to wish the ID that a unit has tells that it was seen, to the hour") {
  const Folder folder;
  auto store = opened(folder);
  REQUIRE(put(store, unit(1), NodeId(21), noon));
  REQUIRE(put(store, unit(1), NodeId(21), noon + 59min));
  CHECK(store.find(unit(1)).value()->at == noon);
  REQUIRE(put(store, unit(1), NodeId(21), noon + 1h));
  CHECK(store.find(unit(1)).value()->at == noon + 1h);
}

TEST_CASE("an ID that another unit has is not given by a wish") {
  const Folder folder;
  auto store = opened(folder);
  REQUIRE(put(store, unit(1), NodeId(21), noon));
  REQUIRE(put(store, unit(2), NodeId(22), noon));
  const int number = GENERATE(2, 3); // one in the table and a new one
  const auto before = *store.entries();
  const auto refused = put(store, unit(number), NodeId(21), noon);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == Code::duplicate_node_id);
  CHECK(refused.error().node_id == 21);
  CHECK(refused.error().message.find("0100a5a5") != std::string::npos);
  CHECK(refused.error().hint.find("blactl alloc --forget 0100a5a5") != std::string::npos);
  CHECK(store.entries() == before);
}

TEST_CASE("several wishes are granted together, an exchange too, or none of them") {
  const Folder folder;
  auto store = opened(folder);
  REQUIRE(put(store, unit(1), NodeId(21), noon));
  REQUIRE(put(store, unit(2), NodeId(22), noon));
  const std::array swapped{AllocationStore::Wish{unit(1), NodeId(22)},
                           AllocationStore::Wish{unit(2), NodeId(21)}};
  REQUIRE(store.enter(swapped, noon + 1h));
  const std::vector<AllocationEntry> expected{{NodeId(21), unit(2), noon + 1h},
                                              {NodeId(22), unit(1), noon + 1h}};
  CHECK(store.entries() == expected);
  const std::array impossible{AllocationStore::Wish{unit(3), NodeId(30)},
                              AllocationStore::Wish{unit(4), NodeId(21)}};
  CHECK(store.enter(impossible, noon).error().code == Code::duplicate_node_id);
  const std::array twice{AllocationStore::Wish{unit(3), NodeId(30)},
                         AllocationStore::Wish{unit(4), NodeId(30)}};
  CHECK(store.enter(twice, noon).error().code == Code::duplicate_node_id);
  CHECK(store.entries() == expected);
}

TEST_CASE("a table that nobody shares is in no file") {
  auto store = AllocationStore::unshared().value();
  CHECK(store.path().empty());
  CHECK(assigned(store, 1) == 125);
  CHECK(assigned(store, 2) == 124);
  CHECK(assigned(store, 1) == 125);
  CHECK(AllocationStore::unshared()->entries()->empty());
}

TEST_CASE("0, 126 and 127 are not given by a wish either") {
  const Folder folder;
  auto store = opened(folder);
  for (const NodeId id : {NodeId(0), NodeId(126), NodeId(127)}) {
    const auto refused = put(store, unit(1), id, noon);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == Code::out_of_range);
    CHECK_FALSE(refused.error().hint.empty());
  }
  CHECK(store.entries()->empty());
  CHECK(put(store, unit(1), NodeId(1), noon));
  CHECK(put(store, unit(2), NodeId(125), noon));
}

TEST_CASE("what is forgotten is free, once") {
  const Folder folder;
  auto store = opened(folder);
  REQUIRE(assigned(store, 1) == 125);
  REQUIRE(assigned(store, 2) == 124);
  CHECK(store.forget(unit(1)) == true);
  CHECK(store.forget(unit(1)) == false);
  CHECK(store.entries()->size() == 1);
  CHECK(assigned(store, 3) == 125);
  CHECK(assigned(store, 1) == 123);
}

// What outlives a process.

TEST_CASE("a table is there for ever, in a file and a folder of its user alone") {
  const Folder folder;
  const mode_t before = umask(0);
  const auto entries = fill_with(folder, 3);
  umask(before);
  CHECK(mode_of(table_of(folder)) == "600");
  CHECK(mode_of(state_of(folder)) == "700");
  CHECK(names_in(state_of(folder)) == std::set<std::string>{"allocations.db"});
  CHECK(opened(folder, Access::read).entries() == entries);
  auto store = opened(folder);
  CHECK(mode_of(table_of(folder)) == "600");
  CHECK(assigned(store, 2) == 124);
  CHECK(assigned(store, 4) == 122);
}

TEST_CASE("the file says whose it is, and of which version") {
  const Folder folder;
  const auto store = opened(folder);
  CHECK(store.path() == fs::canonical(table_of(folder)).string());
  const std::string bytes = bytes_of(table_of(folder));
  CHECK(bytes.substr(0, 15) == "SQLite format 3");
  CHECK(bytes.substr(68, 4) == "blac");
  CHECK(bytes.substr(60, 4) == std::string("\0\0\0\1", 4));
}

TEST_CASE("reading makes no file and no folder: where there is none the table is empty") {
  const Folder folder;
  auto store = opened(folder, Access::read);
  CHECK(store.entries()->empty());
  CHECK(found(store, unit(1)).empty());
  CHECK(found(store, NodeId(1)).empty());
  CHECK(store.path() == table_of(folder).string());
  CHECK_FALSE(fs::exists(state_of(folder)));
}

TEST_CASE("what was opened for reading cannot be changed") {
  const Folder folder;
  if (GENERATE(false, true)) {
    fill_with(folder, 1);
  }
  auto store = opened(folder, Access::read);
  const auto entries = *store.entries();
  CHECK(store.allocate(unit(2), {}, noon).error().code == Code::permission);
  CHECK(put(store, unit(2), NodeId(5), noon).error().code == Code::permission);
  CHECK(store.forget(unit(1)).error().code == Code::permission);
  CHECK(store.entries() == entries);
}

TEST_CASE("a store that was moved goes on") {
  const Folder folder;
  auto first = opened(folder);
  REQUIRE(assigned(first, 1) == 125);
  AllocationStore moved = std::move(first);
  CHECK(assigned(moved, 2) == 124);
  moved = opened(folder);
  CHECK(assigned(moved, 1) == 125);
}

TEST_CASE("two stores on one file see what the other has given") {
  const Folder folder;
  auto one = opened(folder);
  auto other = opened(folder);
  auto reader = opened(folder, Access::read);
  CHECK(assigned(one, 1) == 125);
  CHECK(assigned(other, 2) == 124);
  CHECK(assigned(one, 2) == 124);
  CHECK(assigned(other, 1) == 125);
  REQUIRE(one.forget(unit(2)));
  CHECK(reader.entries()->size() == 1);
}

TEST_CASE("threads with a store each never give one ID twice, nor two IDs to one unit") {
  const Folder folder;
  constexpr int units = 40;
  std::array<std::map<int, int>, 4> given;
  std::vector<std::thread> threads;
  for (auto& mine : given) {
    threads.emplace_back([&] {
      auto store = try_open(folder);
      for (int i = 1; store && i <= units; ++i) {
        mine[i] = assigned(*store, i);
      }
    });
  }
  for (auto& thread : threads) {
    thread.join();
  }
  std::set<int> different;
  for (const auto& [number, id] : given[0]) {
    different.insert(id);
  }
  CHECK(different.size() == units);
  CHECK_FALSE(different.contains(0));
  for (const auto& mine : given) {
    CHECK(mine == given[0]);
  }
}

TEST_CASE("processes that begin at once make one table and never give one ID twice") {
  const Folder folder;
  constexpr int each = 25;
  std::vector<std::unique_ptr<Allocating>> children;
  for (int child = 0; child < 4; ++child) {
    children.push_back(std::make_unique<Allocating>([&, child](const Allocating::Tell& tell) {
      auto store = try_open(folder);
      for (int i = 0; i < each; ++i) {
        const int number = child * each + i;
        tell(number, store ? assigned(*store, number) : 0);
      }
    }));
  }
  std::map<int, int> unit_of;
  for (const auto& child : children) {
    while (const auto report = child->next()) {
      CHECK(report->node_id != 0);
      CHECK(unit_of.emplace(report->node_id, report->unit).second);
    }
  }
  CHECK(unit_of.size() == 4 * each);
  CHECK(opened(folder).entries()->size() == 4 * each);
  CHECK(names_in(state_of(folder)) == std::set<std::string>{"allocations.db"});
}

TEST_CASE("what a process told before it was killed is there, and no ID is there twice") {
  const Folder folder;
  constexpr int each = 8;
  std::map<int, int> told; // node ID by unit
  for (int round = 0; round < 15; ++round) {
    Allocating child([&, round](const Allocating::Tell& tell) {
      auto store = try_open(folder);
      for (int i = 0; store && i < each; ++i) {
        const int number = round * each + i;
        tell(number, assigned(*store, number, preferring(number % 7)));
      }
    });
    const auto keep = [&](const Report& report) {
      CHECK(report.node_id != 0);
      told[report.unit] = report.node_id;
    };
    for (int i = 0; i < round % each; ++i) {
      const auto report = child.next();
      REQUIRE(report);
      keep(*report);
    }
    std::this_thread::sleep_for(round * 100us); // anywhere in the next allocation
    child.end();
    while (const auto report = child.next()) {
      keep(*report);
    }
    auto store = opened(folder, Access::read);
    std::set<UniqueId> units;
    for (const auto& entry : *store.entries()) {
      CHECK(units.insert(entry.unique_id).second);
    }
    for (const auto& [number, id] : told) {
      const auto entry = store.find(unit(number));
      REQUIRE(entry);
      REQUIRE(*entry);
      CHECK((*entry)->node_id.value() == id);
    }
  }
  CHECK(told.size() > 40);
}

// What goes wrong.

TEST_CASE("a file that is no database is not touched") {
  const Folder folder;
  write_bytes(table_of(folder), GENERATE(as<std::string>{}, "", "x", "my precious notes\n",
                                         std::string(20000, '\7')));
  check_refused(folder, "is not a blactl allocation table");
}

TEST_CASE("the database of another program is not touched, not even beside it") {
  const Folder folder;
  fs::create_directory(state_of(folder));
  run_sql(table_of(folder), "PRAGMA journal_mode = WAL; CREATE TABLE notes (line TEXT);" +
                                GENERATE(as<std::string>{}, "", "PRAGMA application_id = 7;"));
  check_refused(folder, "is not a blactl allocation table");
}

TEST_CASE("what is no file is refused") {
  const Folder folder;
  fs::create_directory(state_of(folder));
  SECTION("a folder") {
    fs::create_directory(table_of(folder));
  }
  SECTION("a pipe, which is not waited for") {
    REQUIRE(mkfifo(table_of(folder).c_str(), 0600) == 0);
  }
  const auto store = try_open(folder);
  REQUIRE_FALSE(store);
  CHECK(store.error().code == Code::bad_file);
}

TEST_CASE("a symbolic link in the place of the file is not followed") {
  const Folder folder;
  fs::create_directory(state_of(folder));
  SECTION("to another table") {
    const Folder other;
    fill_with(other, 1);
    fs::rename(table_of(other), folder.path / "victim");
  }
  SECTION("to nothing") {}
  const bool was_there = fs::exists(folder.path / "victim");
  fs::create_symlink(folder.path / "victim", table_of(folder));
  check_refused(folder, "is a symbolic link");
  CHECK(fs::exists(folder.path / "victim") == was_there);
}

TEST_CASE("folders above the file may be symbolic links") {
  const Folder folder;
  fs::create_directory(folder.path / "elsewhere");
  fs::create_symlink(folder.path / "elsewhere", state_of(folder));
  auto store = opened(folder);
  CHECK(assigned(store, 1) == 125);
  CHECK(fs::exists(folder.path / "elsewhere" / "allocations.db"));
}

TEST_CASE("a folder may be named from where the process stands, and need not be there") {
  const Folder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path);
  const auto store = AllocationStore::open("some/state", Access::write);
  fs::current_path(before);
  REQUIRE(store);
  CHECK(fs::exists(folder.path / "some/state/allocations.db"));
  CHECK(mode_of(folder.path / "some/state") == "700");
}

TEST_CASE("a table of a newer blactl is left to that") {
  const Folder folder;
  fill_with(folder, 2);
  run_sql(table_of(folder), "PRAGMA user_version = 2");
  check_refused(folder, "has version 2; this blactl knows version 1 at most");
  CHECK(try_open(folder).error().hint.starts_with("update blactl"));
}

TEST_CASE("a table without a version, or of another shape, is damaged") {
  const Folder folder;
  fill_with(folder, 2);
  run_sql(table_of(folder),
          GENERATE(as<std::string>{}, "PRAGMA user_version = 0", "PRAGMA user_version = -1",
                   "DROP TABLE allocations", "ALTER TABLE allocations ADD COLUMN more TEXT",
                   "CREATE TABLE more (line TEXT)",
                   "CREATE TRIGGER more AFTER INSERT ON allocations BEGIN "
                   "DELETE FROM allocations; END"));
  check_refused(folder, "is damaged");
}

TEST_CASE("a table that is cut short is damaged, wherever it ends") {
  const Folder folder;
  fill_with(folder, 40);
  const auto size = fs::file_size(table_of(folder));
  SECTION("behind its header") {
    fs::resize_file(table_of(folder), GENERATE_COPY(100U, 4096U, 5000U, size - 4096));
    check_refused(folder, "is damaged");
  }
  SECTION("in its last page, which only the check reads for sure") {
    fs::resize_file(table_of(folder), size - 1);
    CHECK(check_state_files(state_of(folder).string()).size() == 1);
  }
  SECTION("in its header") {
    fs::resize_file(table_of(folder), GENERATE(1U, 16U, 70U));
    check_refused(folder, "is not a blactl allocation table");
  }
}

TEST_CASE("random bytes in the place of pages are told where they are met, and stay") {
  const Folder folder;
  fill_with(folder, 40);
  std::string bytes = bytes_of(table_of(folder));
  std::minstd_rand random(GENERATE(1U, 2U, 3U)); // NOLINT: the same in every run
  const std::size_t from = GENERATE(100U, 4096U, 8192U);
  for (std::size_t i = from; i < from + 2000; ++i) {
    bytes[i] = static_cast<char>(random());
  }
  write_bytes(table_of(folder), bytes);
  auto store = try_open(folder);
  const auto refused = store ? store->allocate(unit(1), {}, noon) : std::unexpected(store.error());
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == Code::bad_file);
  CHECK(refused.error().message.find("is damaged") != std::string::npos);
  CHECK(refused.error().hint.find("mv " + table_of(folder).string()) != std::string::npos);
  CHECK(check_state_files(state_of(folder).string()).size() == 1);
  CHECK(bytes_of(table_of(folder)) == bytes);
}

TEST_CASE("damage that comes while the table is in use is told, and nothing is written into it") {
  const Folder folder;
  fill_with(folder, 3);
  std::string bytes = bytes_of(table_of(folder));
  bytes.replace(4096, bytes.size() - 4096, bytes.size() - 4096, '\x55');
  auto store = opened(folder);
  write_bytes(table_of(folder), bytes);
  const auto refused = store.allocate(unit(5), {}, noon);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == Code::bad_file);
  CHECK(refused.error().hint.find("mv " + table_of(folder).string()) != std::string::npos);
  CHECK(store.entries().error().code == Code::bad_file);
  CHECK(bytes_of(table_of(folder)) == bytes);
}

TEST_CASE("a log without its table is not played back into a new one") {
  const Folder folder;
  fs::create_directory(state_of(folder));
  const fs::path log = table_of(folder).string() + GENERATE(as<std::string>{}, "-wal", "-journal");
  write_bytes(log, "what was not moved away");
  const auto store = try_open(folder);
  REQUIRE_FALSE(store);
  CHECK(store.error().code == Code::bad_file);
  CHECK(store.error().message.find(log.string()) != std::string::npos);
  CHECK(names_in(state_of(folder)) == std::set<std::string>{log.filename().string()});
  fs::resize_file(log, 0);
  CHECK(try_open(folder));
}

TEST_CASE(
    "a table that was moved away under a running process gets no entry that nobody would see") {
  const Folder folder;
  auto store = opened(folder);
  REQUIRE(assigned(store, 1) == 125);
  fs::rename(table_of(folder), folder.path / "away.db");
  const auto refused = store.allocate(unit(2), {}, noon);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == Code::io);
  CHECK(refused.error().message.find("moved away") != std::string::npos);
  CHECK_FALSE(fs::exists(table_of(folder)));
}

TEST_CASE("who must wait for another process for too long is told so, and reads all the same") {
  const Folder folder;
  fill_with(folder, 1);
  auto store = AllocationStore::open(state_of(folder).string(), Access::write, 20ms);
  REQUIRE(store);
  sqlite3* other = nullptr;
  REQUIRE(sqlite3_open(table_of(folder).c_str(), &other) == SQLITE_OK);
  REQUIRE(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr) == SQLITE_OK);
  const auto busy = store->allocate(unit(2), {}, noon);
  REQUIRE_FALSE(busy);
  CHECK(busy.error().code == Code::busy);
  CHECK(busy.error().message.find(table_of(folder).string()) != std::string::npos);
  CHECK_FALSE(busy.error().hint.empty());
  CHECK(store->find(unit(1)).value()->node_id == NodeId(125));
  CHECK(AllocationStore::open(state_of(folder).string(), Access::write, 20ms));
  sqlite3_close(other);
  CHECK(assigned(*store, 2) == 124);
}

TEST_CASE("on a full disk nothing is half done, and what was given stays") {
  const Folder folder;
  const auto before = fill_with(folder, 20);
  const rlim_t limit = GENERATE(0U, 600U, 1000U, 5000U, 8000U, 12300U);
  std::map<int, int> told;
  {
    const Allocating child([&](const Allocating::Tell& tell) {
      auto store = try_open(folder);
      limit_files_to(limit);
      for (int i = 21; store && i <= 60; ++i) {
        const auto id = store->allocate(unit(i), {}, noon);
        if (!id) {
          tell(i, -said(id));
          const bool still_reads = store->find(unit(1)).value()->node_id == NodeId(125);
          tell(0, still_reads ? 1 : 0);
          break;
        }
        tell(i, id->node_id.value());
      }
    });
    while (const auto report = child.next()) {
      told[report->unit] = report->node_id;
    }
  }
  CHECK(told.contains(0));
  CHECK(told[0] == 1);
  told.erase(0);
  REQUIRE_FALSE(told.empty());
  CHECK(told.rbegin()->second == -as_said(Code::io));
  told.erase(told.rbegin()->first);
  auto store = opened(folder);
  CHECK(store.entries()->size() == before.size() + told.size());
  for (const auto& [number, id] : told) {
    CHECK(assigned(store, number) == id);
  }
  CHECK(assigned(store, 20) == 106);
  CHECK(assigned(store, 100) != 0);
}

TEST_CASE("on a full disk no half of a table is made") {
  const Folder folder;
  fs::create_directory(state_of(folder));
  const rlim_t limit = GENERATE(0U, 600U, 4096U, 8000U);
  const Child child([&] {
    limit_files_to(limit);
    return said(try_open(folder));
  });
  CHECK(child.said == as_said(Code::io));
  CHECK(names_in(state_of(folder)).empty());
}

TEST_CASE("where nothing can be written that is said, with what to look at") {
  const Folder folder;
  std::ofstream(folder.path / "file") << "no folder";
  const std::string place =
      GENERATE(as<std::string>{}, "file", "file/below", "file/far/below", "/proc/no/such");
  const auto store = AllocationStore::open((folder.path / place).string(), Access::write);
  REQUIRE_FALSE(store);
  CHECK(store.error().code == Code::permission);
  CHECK(store.error().message.find((folder.path / place).string()) != std::string::npos);
  CHECK(store.error().hint.find("BLACTL_STATE_DIR") != std::string::npos);
  CHECK(bytes_of(folder.path / "file") == "no folder");
}

TEST_CASE("without any folder for state there is no table, and the variable is named") {
  const auto store = AllocationStore::open("", Access::write);
  REQUIRE_FALSE(store);
  CHECK(store.error().code == Code::state);
  CHECK(store.error().hint.find("BLACTL_STATE_DIR") != std::string::npos);
}

TEST_CASE("who may not write is told so") {
  const Folder folder;
  fs::permissions(folder.path, fs::perms(0755));
  SECTION("no folder can be made") {
    fs::permissions(folder.path, fs::perms(0555));
    const Child child([&] {
      become_nobody();
      return said(try_open(folder));
    });
    CHECK(child.said == as_said(Code::permission));
    CHECK_FALSE(fs::exists(state_of(folder)));
  }
  SECTION("a folder without a file") {
    fs::create_directory(state_of(folder));
    fs::permissions(state_of(folder), fs::perms(0555));
    const Child child([&] {
      become_nobody();
      return said(try_open(folder));
    });
    CHECK(child.said == as_said(Code::permission));
    CHECK(fs::is_empty(state_of(folder)));
  }
  SECTION("a table that may be read at most") {
    fill_with(folder, 2);
    const std::string before = bytes_of(table_of(folder));
    fs::permissions(table_of(folder), fs::perms(GENERATE(0000U, 0444U)));
    fs::permissions(state_of(folder), fs::perms(0555));
    const Child child([&] {
      become_nobody();
      return said(try_open(folder));
    });
    CHECK(child.said == as_said(Code::permission));
    CHECK(bytes_of(table_of(folder)) == before);
    CHECK(names_in(state_of(folder)).size() == 1);
  }
  fs::permissions(folder.path, fs::perms(0755)); // to be removed
  if (fs::exists(state_of(folder))) {
    fs::permissions(state_of(folder), fs::perms(0755));
  }
}

TEST_CASE("errors speak Japanese too") {
  const Folder folder;
  write_bytes(table_of(folder), "no table");
  set_language(Language::japanese);
  const auto store = try_open(folder);
  set_language(Language::english);
  REQUIRE_FALSE(store);
  CHECK(store.error().message.find("割当て表ではありません") != std::string::npos);
  CHECK(store.error().hint.find("移動") != std::string::npos);
}
