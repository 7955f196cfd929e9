#include "blactl/base/replace_file.hpp"

#include "catch.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

using namespace blactl;

namespace {

/// A folder that goes with the test.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "blactl-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }

  ~Folder() { std::filesystem::remove_all(path_); }

  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string file(const char* name) const { return path_ / name; }

  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(std::filesystem::directory_iterator(path_), {});
  }

 private:
  std::filesystem::path path_;
};

std::string content(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

} // namespace

TEST_CASE("a file is put in place as a whole, with the rights of a new file") {
  const Folder folder;
  const std::string path = folder.file("map.svg");
  REQUIRE(replace_file(path, "one"));
  REQUIRE(replace_file(path, "two"));
  CHECK(content(path) == "two");
  CHECK(folder.files() == 1);
  const mode_t mask = umask(0);
  umask(mask);
  struct stat status{};
  REQUIRE(stat(path.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777U) == (0666U & ~mask));
}

TEST_CASE("a file that cannot be written leaves what was there, and nothing beside it") {
  const Folder folder;
  const auto nowhere = replace_file(folder.file("none/map.svg"), "x");
  REQUIRE_FALSE(nowhere);
  CHECK(nowhere.error().code == Code::io);
  const std::string taken = folder.file("taken"); // a folder cannot be replaced by a file
  std::filesystem::create_directory(taken);
  CHECK_FALSE(replace_file(taken, "x"));
  CHECK(std::filesystem::is_directory(taken));
  CHECK(folder.files() == 1);
}

TEST_CASE("what is no regular file is not replaced by one; a symbolic link stays one") {
  const Folder folder;
  const std::string pipe = folder.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_FALSE(check_replaceable(pipe));
  CHECK_FALSE(replace_file(pipe, "x"));
  CHECK(std::filesystem::is_fifo(pipe));
  const std::string target = folder.file("map.svg");
  const std::string link = folder.file("link.svg");
  REQUIRE(replace_file(target, "one"));
  std::filesystem::create_symlink(target, link);
  CHECK(check_replaceable(link));
  CHECK(replace_file(link, "two"));
  CHECK(std::filesystem::is_symlink(link));
  CHECK(content(target) == "two");
}

TEST_CASE("whether a file can be replaced is known before, and asking leaves nothing") {
  const Folder folder;
  CHECK(check_replaceable(folder.file("map.svg")));
  CHECK(folder.files() == 0);
  CHECK_FALSE(check_replaceable(folder.file("none/map.svg")));
  std::filesystem::create_directory(folder.file("taken"));
  CHECK_FALSE(check_replaceable(folder.file("taken")));
  CHECK(folder.files() == 1);
}
