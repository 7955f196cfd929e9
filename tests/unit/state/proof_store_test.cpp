#include "blactl/base/text.hpp"
#include "blactl/state/proof_store.hpp"
#include "blactl/state/state_folder.hpp"

#include "catch.hpp"
#include "database_files.hpp"
#include "processes.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::state;
using namespace blactl::state::test;
using namespace std::chrono_literals;
using dronecan::UniqueId;

namespace {

RomProof proof(std::uint8_t number, std::int64_t value = 900) {
  return {.unique_id = unit(number),
          .rom = {{0x20, 0}, {0x38, value}, {0x39, -1799}},
          .started = noon - 100s,
          .uptime = 100s};
}

std::filesystem::path file_of(const Folder& folder) {
  return folder.path / "state" / "proofs.db";
}

Result<ProofStore> try_open(const Folder& folder, Access access = Access::write) {
  return ProofStore::open((folder.path / "state").string(), access, 10s);
}

ProofStore opened(const Folder& folder, Access access = Access::write) {
  auto store = try_open(folder, access);
  if (!store) {
    FAIL(store.error().message);
  }
  return std::move(*store);
}

Result<void> put(ProofStore& store, const RomProof& one) {
  return store.put(std::array{one});
}

std::optional<RomProof> found(const ProofStore& store, std::uint8_t number) {
  const auto result = store.find(unit(number));
  INFO((result ? "" : result.error().message));
  REQUIRE(result);
  return *result;
}

} // namespace

// How long a proof holds.

TEST_CASE("a proof holds while the uptime runs on, give or take two seconds") {
  const RomProof old = proof(1);
  CHECK(holds(old, 100s, noon, {}));
  CHECK(holds(old, 3700s, noon + 1h, {}));
  CHECK(holds(old, 3702s, noon + 1h, {}));
  CHECK(holds(old, 3698s, noon + 1h, {}));
  CHECK_FALSE(holds(old, 3703s, noon + 1h, {}));
  CHECK_FALSE(holds(old, 3697s, noon + 1h, {}));
  CHECK_FALSE(holds(old, 3700s, noon + 1h + 2001ms, {}));
  CHECK_FALSE(holds(old, 0s, noon + 1h, {}));
}

TEST_CASE("an uptime that went back is a restart, however close the starts are") {
  RomProof young = proof(1);
  young.started = noon - 1s;
  young.uptime = 1s;
  CHECK(holds(young, 1s, noon, {}));
  CHECK_FALSE(holds(young, 0s, noon, {}));
}

TEST_CASE("a clock that was set makes a proof worthless, and never makes one") {
  const RomProof old = proof(1);
  CHECK_FALSE(holds(old, 160s, noon + 1min - 1h, {}));
  CHECK_FALSE(holds(old, 160s, noon + 1min + 1h, {}));
  CHECK_FALSE(holds(old, 50s, noon - 50s, {})); // the times agree, the uptime does not
}

TEST_CASE("a clock that was set, or stood still in sleep, makes every proof worthless") {
  const RomProof old = proof(1);
  CHECK(holds(old, 160s, noon + 1min, WallTime(200ms)));
  CHECK_FALSE(holds(old, 160s, noon + 1min, WallTime(201ms)));
  CHECK_FALSE(holds(old, 160s, noon + 1min, WallTime(-7s)));
}

TEST_CASE("what was proven before the machine started, or by an older version, is not known") {
  const Folder folder;
  {
    auto store = opened(folder);
    REQUIRE(put(store, proof(1)));
  }
  SECTION("another start") {
    run_sql(file_of(folder), "UPDATE proofs SET boot = 'another'");
  }
  SECTION("a machine that does not tell") {
    run_sql(file_of(folder), "UPDATE proofs SET boot = ''");
  }
  SECTION("an older version") {
    run_sql(file_of(folder),
            "DROP TABLE proofs; CREATE TABLE proofs ("
            "unique_id BLOB PRIMARY KEY NOT NULL CHECK (length(unique_id) = 16), "
            "rom BLOB NOT NULL, "
            "started INTEGER NOT NULL CHECK (started BETWEEN "
            "-253402300799999999 AND 253402300799999999), "
            "uptime INTEGER NOT NULL CHECK (uptime BETWEEN 0 AND 4294967295), "
            "UNIQUE (unique_id, rom, started, uptime)) STRICT; "
            "INSERT INTO proofs VALUES (zeroblob(16), x'', 0, 0); PRAGMA user_version = 1");
  }
  auto store = opened(folder);
  CHECK_FALSE(found(store, 1));
  REQUIRE(put(store, proof(2)));
  CHECK(found(store, 2) == proof(2));
}

TEST_CASE("a proof that is renewed while it holds outlives the drift of a crystal") {
  RomProof kept = proof(1);
  const RomProof first = kept;
  constexpr auto hour = 3600s;
  for (int hours = 1; hours <= 24 * 365; ++hours) {
    const auto now = noon + hours * hour;
    const auto uptime = 100s + hours * hour + std::chrono::seconds(hours / 10); // 28 ppm
    REQUIRE(holds(kept, uptime, now, {}));
    kept = renewed(kept, uptime, now);
  }
  CHECK(kept.rom == first.rom);
  CHECK(kept.unique_id == first.unique_id);
  CHECK_FALSE(holds(first, kept.uptime, noon + 365 * 24h, {}));
}

// What is kept.

TEST_CASE("what was proven is found again, by the next process too") {
  const Folder folder;
  {
    auto store = opened(folder);
    CHECK_FALSE(found(store, 1));
    REQUIRE(store.put(std::array{proof(1), proof(2, -5)}));
    CHECK(found(store, 1) == proof(1));
  }
  const auto store = opened(folder, Access::read);
  CHECK(found(store, 1) == proof(1));
  CHECK(found(store, 2) == proof(2, -5));
  CHECK_FALSE(found(store, 3));
  CHECK(bytes_of(file_of(folder)).substr(68, 4) == "blap");
  CHECK(std::filesystem::status(file_of(folder)).permissions() == std::filesystem::perms(0600));
}

TEST_CASE("a new proof takes the place of the old one, and what is dropped is gone") {
  auto store = ProofStore::unshared().value();
  REQUIRE(store.put(std::array{proof(1), proof(2), proof(3)}));
  REQUIRE(put(store, proof(1, 77)));
  CHECK(found(store, 1) == proof(1, 77));
  REQUIRE(store.drop(std::array{unit(1), unit(3), unit(9)}));
  CHECK_FALSE(found(store, 1));
  CHECK(found(store, 2) == proof(2));
  CHECK_FALSE(found(store, 3));
}

TEST_CASE("every number of a register is kept as it was, and a clock that was never set is none") {
  auto store = ProofStore::unshared().value();
  RomProof odd = proof(1);
  odd.rom = {{0x00, std::numeric_limits<std::int64_t>::min()},
             {0x01, -1},
             {0x7F, 0},
             {0x80, std::numeric_limits<std::int64_t>::max()},
             {0xFF, 555'555'555}};
  odd.started = WallTime(-3600s);
  REQUIRE(put(store, odd));
  CHECK(found(store, 1) == odd);
}

TEST_CASE("reading proofs makes no file and changes nothing") {
  const Folder folder;
  if (GENERATE(false, true)) {
    auto store = opened(folder);
    REQUIRE(put(store, proof(1)));
  }
  const bool was_there = std::filesystem::exists(folder.path / "state");
  auto store = opened(folder, Access::read);
  const auto before = found(store, 1);
  CHECK(before.has_value() == was_there);
  CHECK(put(store, proof(1, 7)).error().code == Code::permission);
  CHECK(store.drop(std::vector{unit(1)}).error().code == Code::permission);
  CHECK(found(store, 1) == before);
  CHECK(std::filesystem::exists(folder.path / "state") == was_there);
}

// What others do to the file.

TEST_CASE("a file that is no record of ours is refused by its name, and stays as it is") {
  const Folder folder;
  const auto [content, message] = GENERATE(
      std::pair("what is this", "not a blactl record of ROM contents"),
      std::pair("PRAGMA user_version = 4", "has version 4; this blactl knows version 3"),
      std::pair("PRAGMA application_id = 1", "not a blactl record of ROM contents"),
      std::pair("UPDATE proofs SET rom = x'38'", "is damaged"),
      std::pair("UPDATE proofs SET rom = x'380000000000000001380000000000000002'", "is damaged"),
      std::pair("PRAGMA ignore_check_constraints = 1; UPDATE proofs SET uptime = -1", "is damaged"),
      std::pair("PRAGMA ignore_check_constraints = 1; "
                "UPDATE proofs SET started = 9223372036854775807",
                "is damaged"));
  {
    auto store = opened(folder);
    REQUIRE(put(store, proof(1)));
  }
  content == std::string("what is this") ? write_bytes(file_of(folder), content)
                                         : run_sql(file_of(folder), content);
  const std::string before = bytes_of(file_of(folder));
  const auto store = try_open(folder, GENERATE(Access::read, Access::write));
  const auto result = store ? store->find(unit(1)) : std::unexpected(store.error());
  REQUIRE_FALSE(result);
  CHECK(result.error().code == Code::bad_file);
  INFO(result.error().message);
  CHECK(result.error().message.find(message) != std::string::npos);
  CHECK(result.error().hint.find("mv " + file_of(folder).string()) != std::string::npos);
  CHECK(result.error().hint.find("alloc") == std::string::npos);
  CHECK(bytes_of(file_of(folder)) == before);
}

TEST_CASE("a number that changed in the file is found out by the check") {
  const Folder folder;
  {
    auto store = opened(folder);
    REQUIRE(put(store, proof(1)));
  }
  std::string bytes = bytes_of(file_of(folder));
  const std::string value("\x38\0\0\0\0\0\0\x03\x84", 9);
  const auto at = bytes.find(value);
  REQUIRE(at != std::string::npos);
  bytes[at + 8] = '\x85';
  write_bytes(file_of(folder), bytes);
  const auto faults = check_state_files(file_of(folder).parent_path().string());
  REQUIRE(faults.size() == 1);
  CHECK(faults.front().code == Code::bad_file);
}

TEST_CASE("on a full disk nothing is half done, and what was proven stays") {
  const Folder folder;
  const rlim_t limit = GENERATE(0U, 1000U, 12000U);
  {
    auto store = opened(folder);
    REQUIRE(store.put(std::array{proof(1), proof(2)}));
  }
  const Child child([&] {
    auto store = try_open(folder);
    limit_files_to(limit);
    int first = 0;
    for (int i = 0; store && i < 200 && first == 0; ++i) {
      first = said(store->put(std::array{proof(1, i), proof(2, i)}));
    }
    return first;
  });
  CHECK(child.said == as_said(Code::io));
  const auto store = opened(folder);
  CHECK(found(store, 1)->rom == found(store, 2)->rom);
}

TEST_CASE("what a process told that was killed is there") {
  const Folder folder;
  Child child([&] {
    auto store = try_open(folder);
    return store ? said(put(*store, proof(1))) : -1;
  });
  REQUIRE(child.said == 0);
  child.end();
  CHECK(found(opened(folder), 1) == proof(1));
}

TEST_CASE("errors name the record in Japanese too") {
  const Folder folder;
  write_bytes(file_of(folder), "no record");
  set_language(Language::japanese);
  const auto store = try_open(folder);
  set_language(Language::english);
  REQUIRE_FALSE(store);
  CHECK(store.error().message.find("ROM 照合記録ではありません") != std::string::npos);
}

TEST_CASE("a start that could not read ROM is kept like any other") {
  const Folder folder;
  auto store = opened(folder);
  RomProof unread = proof(1);
  unread.rom.clear();
  REQUIRE(put(store, unread));
  CHECK(found(store, 1) == unread);
}

TEST_CASE("all proofs are told, with the serial numbers of their units") {
  const Folder folder;
  auto store = opened(folder);
  RomProof numbered = proof(2);
  numbered.serial_number = 102;
  REQUIRE(store.put(std::array{proof(1), numbered}));
  CHECK(store.proofs().value() == std::vector{proof(1), numbered});
  CHECK(store.find(unit(2)).value() == numbered);
}
