// One spelling of each Japanese word, that of the specification, in everything that people read.

#include "catch.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  // A string that the source divides over lines is one text.
  return std::regex_replace(text, std::regex("\"\\s*\n\\s*\""), "");
}

} // namespace

TEST_CASE("Japanese texts are spelled as in the specification") {
  const std::filesystem::path profiles(BLACTL_PROFILES);
  const std::filesystem::path project = profiles.parent_path();
  // Nouns are written 書込み, 読出し, 割当て; verbs 書き込む, 読み出す, 割り当てる.
  const std::vector<std::string> forbidden{
      "ユニーク ?ID",   "インタフェース",    "ヘルス",
      "ください",       "パラメーター",      "サーバー",
      "書き込み(?!ま)", "読み出し(?!ま|て)", "割り当て(?!ま|る|て|ら)",
  };
  std::size_t files = 0;
  for (const auto* folder : {"src", "include", "profiles"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(project / folder)) {
      if (!entry.is_regular_file()) {
        continue;
      }
      ++files;
      const std::string text = content(entry.path());
      for (const std::string& word : forbidden) {
        INFO(entry.path().string() << ": " << word);
        CHECK_FALSE(std::regex_search(text, std::regex(word)));
      }
    }
  }
  CHECK(files > 100);
}
