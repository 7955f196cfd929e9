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

TEST_CASE("columns that do not fit the page stand below the second one, or indented") {
  Table table({"NODE", "MODEL", "UNIQUE ID"});
  table.add({"1", "BLA21-12U-AB", "0123456789"});
  table.add({"2", "BLA34", ""});
  const Page narrow{.width = 24};
  CHECK(table.text("", narrow) == "NODE  MODEL\n" // one column below tells itself
                                  "1     BLA21-12U-AB\n"
                                  "      0123456789\n"
                                  "2     BLA34\n");
  Table wide({"NODE", "MODEL", "UNIQUE ID", "STATE"});
  wide.add({"1", "BLA21-12U-AB", "0123456789", "ok"});
  CHECK(wide.text("", narrow) == "NODE  MODEL\n"
                                 "      UNIQUE ID   STATE\n"
                                 "1     BLA21-12U-AB\n"
                                 "      0123456789  ok\n");
  Table broad({"MODEL NAME", "UNIQUE ID"});
  broad.add({"BLA21-12U-AB", "0123456789abcdef"});
  CHECK(broad.text("", narrow) == "MODEL NAME\nBLA21-12U-AB\n    0123456789abcdef\n");
  CHECK(table.text("", {.width = 30}) == table.text());
  CHECK(table.text("  ", {.width = 31}) != table.text("  "));
}

TEST_CASE("colour takes no cells, and is there only where it is shown") {
  const Page colourful{.colour = true};
  CHECK(display_width(colourful.paint(Tone::bad, "角 x")) == 4);
  CHECK(Page().paint(Tone::bad, "x") == "x");
  CHECK(colourful.paint(Tone::good, "") == "");
  Table table({"A", "B"});
  table.add({colourful.paint(Tone::good, "ok"), "x"});
  table.add({"long", "y"});
  CHECK(table.text() == "A     B\n\x1b[32mok\x1b[0m    x\nlong  y\n");
}

TEST_CASE("a line that is longer than the page is broken at words") {
  const Page page{.width = 20};
  CHECK(page.fit("  one two three four five\nshort  line\n") ==
        "  one two three four\n      five\nshort  line\n");
  CHECK(Page().fit("any  line") == "any  line");
}

TEST_CASE("a command in backquotes stays on one line if one can hold it") {
  const Page page{.width = 30};
  CHECK(page.fit("which of them have one: `blactl models`\n") ==
        "which of them have one:\n    `blactl models`\n");
  CHECK(page.fit("この機種の値: `blactl models all` で確認\n") ==
        "この機種の値:\n    `blactl models all` で確認\n");
  CHECK(page.fit("x `blactl models BLA21-12U-AB pwm_neutral` y\n") ==
        "x `blactl models BLA21-12U-AB\n    pwm_neutral` y\n");
  CHECK(page.fit("an odd ` is no quotation of anything\n") ==
        "an odd ` is no quotation of\n    anything\n");
}

TEST_CASE("an address stays on one line with the name behind it") {
  const Page page{.width = 20};
  CHECK(page.fit("see also 0x38 angle_limit_cw\n") == "see also\n    0x38 angle_limit_cw\n");
  CHECK(page.fit("between 0x38 angle and (0x39 b) c\n") ==
        "between 0x38 angle\n    and (0x39 b) c\n");
}

TEST_CASE("what is to be typed stands in a line of its own where a hint is long") {
  const Page page{.width = 34};
  CHECK(page.fit_hint("  the nearest that is possible: --endpoints 1us:2deg") ==
        "  the nearest that is possible:\n      --endpoints 1us:2deg");
  CHECK(page.fit_hint("  check the cable, then: sudo ip link set can0 down") ==
        "  check the cable, then:\n      sudo ip link set can0 down");
}

TEST_CASE("a line below a row begins at the second column, and widens none") {
  Table table({"", "NAME", "VALUE"});
  table.add({"0x1A", "warnings", "1"});
  table.add_below("bit 0: a text longer than the columns");
  table.add({"0x1B", "failures", "0"});
  CHECK(table.text("  ") == "        NAME      VALUE\n"
                            "  0x1A  warnings  1\n"
                            "        bit 0: a text longer than the columns\n"
                            "  0x1B  failures  0\n");
}
