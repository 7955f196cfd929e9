#include "blactl/base/text.hpp"

#include "catch.hpp"

using namespace blactl;

namespace {

constexpr Text test_text{"{} of {}", "{1} 個中 {0} 個"};

class Japanese {
 public:
  Japanese() { set_language(Language::japanese); }

  Japanese(const Japanese&) = delete;
  Japanese& operator=(const Japanese&) = delete;

  ~Japanese() { set_language(Language::english); }
};

} // namespace

TEST_CASE("texts are said in the language of the process") {
  CHECK(say<test_text>(2, "8") == "2 of 8");
  CHECK(choose("en", "ja") == "en");
  const Japanese japanese;
  CHECK(say<test_text>(2, "8") == "8 個中 2 個");
  CHECK(choose("en", "ja") == "ja");
  CHECK(choose("en", "") == "en");
}

TEST_CASE("well-formed text stays as it is") {
  for (const char* text : {"", "BLA21-12U-AB", "原点位置 °C …", "\U0001F916", "\xC2\xA0", "~"}) {
    CHECK(printable(text) == text);
  }
}

TEST_CASE("control characters and what hides in text are spelled out") {
  CHECK(printable("a\nb") == "a\\x0ab");
  CHECK(printable("\x1B[31m") == "\\x1b[31m");
  CHECK(printable("\x7F") == "\\x7f");
  CHECK(printable(std::string_view("\0", 1)) == "\\x00");
  CHECK(printable("\xC2\x9B") == "\\xc2\\x9b");          // C1: CSI
  CHECK(printable("\xE2\x80\xAE") == "\\xe2\\x80\\xae"); // right-to-left override
  CHECK(printable("\xE2\x81\xA6") == "\\xe2\\x81\\xa6"); // isolate
  CHECK(printable("\xE2\x80\x8B") == "\\xe2\\x80\\x8b"); // zero width space
  CHECK(printable("\xEF\xBB\xBF") == "\\xef\\xbb\\xbf"); // byte order mark
}

TEST_CASE("broken UTF-8 is spelled out byte by byte") {
  CHECK(printable("a\xFF") == "a\\xff");
  CHECK(printable("\xC0\xAF") == "\\xc0\\xaf");          // overlong
  CHECK(printable("\xE0\x80\xAF") == "\\xe0\\x80\\xaf"); // overlong
  CHECK(printable("\xED\xA0\x80") == "\\xed\\xa0\\x80"); // surrogate
  CHECK(printable("\xF4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");
  CHECK(printable("\xE5\x8E") == "\\xe5\\x8e"); // cut off
  CHECK(printable("\x80") == "\\x80");
}

TEST_CASE("a name is one word of a shell, whatever is in it") {
  CHECK(shell_word("wing.json") == "wing.json");
  CHECK(shell_word("翼.json") == "翼.json");
  CHECK(shell_word("") == "''");
  CHECK(shell_word("right aileron") == "'right aileron'");
  CHECK(shell_word("joe's") == R"('joe'\''s')");
  CHECK(shell_word("$(reboot)") == "'$(reboot)'");
  CHECK(shell_word("a\nb") == R"('a\x0ab')");
}
