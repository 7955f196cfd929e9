#pragma once
// A file for one test.

#include "catch.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace blactl::can::test {

class ScratchFile {
 public:
  explicit ScratchFile(std::string_view text = {}) {
    std::string path = (std::filesystem::temp_directory_path() / "blactl-test-XXXXXX").string();
    const int descriptor = mkstemp(path.data());
    REQUIRE(descriptor >= 0);
    close(descriptor);
    path_ = path;
    std::ofstream(path_, std::ios::binary) << text;
  }

  ~ScratchFile() { std::filesystem::remove(path_); }

  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

  [[nodiscard]] std::string text() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  std::string path_;
};

} // namespace blactl::can::test
