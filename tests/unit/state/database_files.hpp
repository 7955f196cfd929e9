#pragma once
// What tests of databases put into them and do with their files, and what a child says of a store.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"

#include "catch.hpp"

#include <signal.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>

namespace blactl::state::test {

/// When tests of stores begin.
constexpr WallTime noon{std::chrono::sys_days{std::chrono::year{2026} / 11 / 22} +
                        std::chrono::hours(12)};

/// One of many units.
inline dronecan::UniqueId unit(int number) {
  dronecan::UniqueId id{};
  id.fill(0xA5);
  id[0] = static_cast<std::uint8_t>(number);
  id[1] = static_cast<std::uint8_t>(number >> 8);
  return id;
}

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

inline std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

/// What another program does to the file.
inline void run_sql(const std::filesystem::path& path, const std::string& sql) {
  sqlite3* handle = nullptr;
  REQUIRE(sqlite3_open(path.c_str(), &handle) == SQLITE_OK);
  INFO(sql);
  REQUIRE(sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
  sqlite3_close(handle);
}

/// What a process of an older version leaves that is killed: committed to the log of write-ahead
/// mode (-wal), and not yet in the file.
inline void leave_in_log(const std::filesystem::path& path, const std::string& sql) {
  const pid_t pid = fork();
  REQUIRE(pid >= 0);
  if (pid == 0) {
    sqlite3* handle = nullptr;
    const std::string all = "PRAGMA journal_mode = WAL;" + sql;
    if (sqlite3_open(path.c_str(), &handle) == SQLITE_OK &&
        sqlite3_exec(handle, all.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK) {
      kill(getpid(), SIGKILL);
    }
    _exit(1);
  }
  int status = 0;
  REQUIRE(waitpid(pid, &status, 0) == pid);
  REQUIRE(WIFSIGNALED(status));
}

/// From here on files of this process cannot grow beyond this: only a child may call it.
inline void limit_files_to(rlim_t size) {
  signal(SIGXFSZ, SIG_IGN); // NOLINT: the macro casts
  const rlimit limit{size, size};
  setrlimit(RLIMIT_FSIZE, &limit);
}

/// The number of an error in what a Child says; 0: none.
template <class T> int said(const Result<T>& result) {
  return result ? 0 : std::to_underlying(result.error().code) + 1;
}

inline int as_said(Code code) {
  return std::to_underlying(code) + 1;
}

/// Root may write everywhere; this user may not.
inline void become_nobody() {
  constexpr uid_t nobody = 65534;
  if (geteuid() == 0 && setresuid(nobody, nobody, nobody) != 0) {
    _exit(1);
  }
}

} // namespace blactl::state::test
