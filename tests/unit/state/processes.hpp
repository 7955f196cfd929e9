#pragma once
// What tests of files that processes share need: a folder, an environment, and another process.

#include "catch.hpp"

#include <fmt/format.h>

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace blactl::state::test {

/// A folder for this test alone.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "blactl-test-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path = name;
  }

  ~Folder() { std::filesystem::remove_all(path); }

  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  /// Where the lock files go: not there yet.
  [[nodiscard]] std::string locks() const { return (path / "locks").string(); }

  [[nodiscard]] std::filesystem::path file(int id) const {
    return path / "locks" / fmt::format("vcan0.{}", id);
  }

  std::filesystem::path path;
};

/// An environment variable for the time of a test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) {
      before_ = before;
    }
    setenv(name, value.c_str(), 1);
  }

  ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }

  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

/// Another process; it does its work, says so, and lives until it is killed.
class Child {
 public:
  /// `work` returns the number that the child says.
  explicit Child(const std::function<int()>& work) {
    std::array<int, 2> pipe{};
    REQUIRE(::pipe(pipe.data()) == 0);
    pid = fork();
    REQUIRE(pid >= 0);
    if (pid == 0) {
      const int result = work();
      if (write(pipe[1], &result, sizeof result) == sizeof result) {
        pause();
      }
      _exit(1);
    }
    close(pipe[1]);
    REQUIRE(read(pipe[0], &said, sizeof said) == sizeof said);
    close(pipe[0]);
  }

  ~Child() { end(); }

  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void end() {
    if (pid > 0) {
      kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
      pid = 0;
    }
  }

  pid_t pid = 0;
  int said = 0;
};

/// Several processes work at once, each with its number; whether all of them gave true.
inline bool all_at_once(int processes, const std::function<bool(int number)>& work) {
  for (int number = 0; number < processes; ++number) {
    const pid_t pid = fork();
    REQUIRE(pid >= 0);
    if (pid == 0) {
      _exit(work(number) ? 0 : 1);
    }
  }
  bool all = true;
  for (int i = 0; i < processes; ++i) {
    int status = -1;
    REQUIRE(waitpid(-1, &status, 0) > 0);
    all = all && status == 0;
  }
  return all;
}

/// From here on every write of this process to a file fails: only a Child may call it.
inline void fill_the_disk() {
  signal(SIGXFSZ, SIG_IGN); // NOLINT: the macro casts
  const rlimit nothing{0, 0};
  setrlimit(RLIMIT_FSIZE, &nothing);
}

} // namespace blactl::state::test
