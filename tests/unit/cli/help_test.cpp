#include "catch.hpp"
#include "cli/commands.hpp"
#include "cli/help.hpp"
#include "cli/output/table.hpp"

#include <sstream>
#include <string>

using namespace blactl;
using namespace blactl::cli;

namespace {

/// The language for the time of a test.
class Speaking {
 public:
  explicit Speaking(Language language) { set_language(language); }

  ~Speaking() { set_language(Language::english); }

  Speaking(const Speaking&) = delete;
  Speaking& operator=(const Speaking&) = delete;
};

bool tells(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

std::size_t widest(const std::string& text) {
  std::istringstream lines(text);
  std::size_t width = 0;
  for (std::string line; std::getline(lines, line);) {
    width = std::max(width, display_width(line));
  }
  return width;
}

} // namespace

TEST_CASE("lines break at spaces, never within a word") {
  CHECK(wrap("one two three", 80, 0, 0) == "one two three");
  CHECK(wrap("one two three", 7, 2, 0) == "one two\n  three");
  CHECK(wrap("one two three", 7, 0, 4) == "one\ntwo\nthree");
  CHECK(wrap("angle_limit_cw=90deg x", 8, 1, 0) == "angle_limit_cw=90deg\n x");
  CHECK(wrap("", 8, 1, 0).empty());
}

TEST_CASE("Japanese breaks behind words and punctuation, never within them") {
  CHECK(wrap("全設定を初期値に", 8, 0, 0) == "全設定を\n初期値に");
  CHECK(wrap("全設定を初期値に", 10, 0, 0) == "全設定を\n初期値に");
  CHECK(wrap("全てのサーボを", 8, 0, 0) == "全ての\nサーボを");
  CHECK(wrap("待つ時間、秒", 8, 0, 0) == "待つ\n時間、秒");
  CHECK(wrap("値は--lang ja", 8, 0, 0) == "値は\n--lang\nja");
  CHECK(wrap("インターフェース", 8, 0, 0) == "インターフェース");
}

TEST_CASE("help keeps to the width and names every option, in both languages") {
  for (const Language language : {Language::english, Language::japanese}) {
    const Speaking speaking(language);
    for (const std::size_t width : {40U, 60U, 80U, 120U}) {
      CAPTURE(width);
      const std::string program = help(nullptr, width);
      CHECK(widest(program) <= width);
      for (const Command* command : all_commands()) {
        CAPTURE(command->name);
        CHECK(tells(program, command->name));
        const std::string own = help(command, width);
        CHECK(widest(own) <= width);
        for (const Option& option : command->options) {
          CHECK(tells(own, option.name));
        }
        for (const Option& argument : command->arguments) {
          CHECK(tells(own, argument.name));
        }
      }
      for (const Option& option : shared_options()) {
        CHECK(tells(program, option.name) != option.hidden);
      }
    }
  }
}

TEST_CASE("help speaks the chosen language") {
  CHECK(tells(help(&commands::erase, 80), "factory defaults"));
  const Speaking speaking(Language::japanese);
  const std::string japanese = help(&commands::erase, 80);
  CHECK(tells(japanese, "初期値"));
  CHECK_FALSE(tells(japanese, "factory defaults"));
  CHECK(tells(help(nullptr, 80), "使い方"));
}

TEST_CASE("help lists the words that a value may be") {
  CHECK(tells(help(&commands::sim, 80), "real, virtual"));
  CHECK(tells(help(&commands::trace, 80), "message, request, response"));
}
