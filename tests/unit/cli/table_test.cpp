#include "catch.hpp"
#include "cli/output/table.hpp"

using namespace blactl::cli;

TEST_CASE("Japanese characters take two cells, others one") {
  CHECK(display_width("") == 0);
  CHECK(display_width("angle_limit_cw") == 14);
  CHECK(display_width("角度") == 4);
  CHECK(display_width("サーボ ID") == 9);
  CHECK(display_width("ｻｰﾎﾞ") == 4); // half-width
  CHECK(display_width("0.1°～") == 6);
  CHECK(display_width("Grüße…") == 6);
  CHECK(display_width("😀") == 2);
}

TEST_CASE("a text that ends in the middle of a character is measured without harm") {
  CHECK(display_width("a\xE8") == 2);
  CHECK(display_width("\xF0\x9F") == 1);
}

TEST_CASE("columns line up, and lines end without blanks") {
  Table table({"NODE", "MODEL", ""});
  table.add({"1", "BLA21-12U-AB", "x"});
  table.add({"125", "", ""});
  CHECK(table.text() == "NODE  MODEL\n"
                        "1     BLA21-12U-AB  x\n"
                        "125\n");
}

TEST_CASE("columns line up in Japanese") {
  Table table({"ノード", "値"});
  table.add({"1", "x"});
  table.add({"角度制限", "y"});
  CHECK(table.text() == "ノード    値\n"
                        "1         x\n"
                        "角度制限  y\n");
}

TEST_CASE("every line is indented, an empty one is empty") {
  Table table({"A"});
  table.add({""});
  table.add({"b"});
  CHECK(table.text("  ") == "  A\n\n  b\n");
}

TEST_CASE("comma-separated values are quoted where they must be (RFC 4180)") {
  CHECK(csv_line({"a", "", "b c"}) == "a,,b c\n");
  CHECK(csv_line({"a,b", "say \"x\"", "1\n2", "\r"}) ==
        "\"a,b\",\"say \"\"x\"\"\",\"1\n2\",\"\r\"\n");
  CHECK(csv_line({}) == "\n");
}
