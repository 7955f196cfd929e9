#include "catch.hpp"
#include "cli/line/station_picture.hpp"

#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::cli;

namespace {

state::LedgerRecord record(const std::string& verdict, const std::string& unit = "a") {
  state::LedgerRecord one;
  one.verdict = verdict;
  one.unique_id = unit;
  one.serial_number = 240900558;
  one.servo_id = 3;
  one.static_node_id = 13;
  return one;
}

std::string text_of(const ScreenLine& line) {
  std::string text;
  for (const Piece& piece : line) {
    text += piece.text;
  }
  return text;
}

std::string text_of(const std::vector<ScreenLine>& lines) {
  std::string text;
  for (const ScreenLine& line : lines) {
    text += text_of(line) + "\n";
  }
  return text;
}

/// How many cells have this look.
std::size_t cells(const std::vector<ScreenLine>& lines, Look look) {
  std::size_t count = 0;
  for (const ScreenLine& line : lines) {
    for (const Piece& piece : line) {
      count += piece.look == look ? display_width(piece.text) : 0;
    }
  }
  return count;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("the verdict fills the screen, whatever its size, and what to do is in both languages") {
  const auto [width, height] = GENERATE(std::pair<std::size_t, std::size_t>{80, 24},
                                        std::pair<std::size_t, std::size_t>{53, 16});
  StationPicture picture{.title = "station A", .deed = LineDeed::take_off};

  struct Case {
    const char* verdict;
    Look look;
    const char* deed_en;
    const char* deed_ja;
  };

  for (const Case& each : {Case{"pass", Look::good_block, "TAKE IT OFF", "外して下さい"},
                           Case{"fail", Look::bad_block, "PUT IT ASIDE", "不合格品置き場へ"},
                           Case{"error", Look::warning_block, "TAKE IT OFF", "外して下さい"},
                           Case{"skip", Look::skip_block, "TAKE IT OFF", "外して下さい"}}) {
    INFO(each.verdict);
    picture.last = record(each.verdict);
    const auto lines = lines_of(picture, width, height);
    REQUIRE(lines.size() == height);
    for (const ScreenLine& line : lines) {
      CHECK(display_width(text_of(line)) <= width);
    }
    constexpr std::size_t others = 8; // title, totals, note, and what to do
    CHECK(cells(lines, each.look) > width * (height - others) * 7 / 10);
    const std::string text = text_of(lines);
    CHECK(has(text, each.deed_en));
    CHECK(has(text, each.deed_ja));
    CHECK(has(text, "240900558"));
  }
}

TEST_CASE("what has to come and what has to go differ by colour, place and symbol, not by words") {
  const auto [width, height] = GENERATE(std::pair<std::size_t, std::size_t>{80, 24},
                                        std::pair<std::size_t, std::size_t>{53, 16});
  const auto* const verdict = GENERATE("pass", "fail", "error", "skip");
  INFO(width << " " << verdict);
  StationPicture picture{.deed = LineDeed::take_off, .last = record(verdict)};
  const auto go = lines_of(picture, width, height);
  picture.deed = LineDeed::connect;
  const auto come = lines_of(picture, width, height);
  const auto row_of = [](const std::vector<ScreenLine>& lines, Look look) {
    std::size_t row = 0;
    while (row < lines.size() && cells({lines[row]}, look) == 0) {
      ++row;
    }
    return row;
  };
  CHECK(cells(go, Look::in_block) == 0);
  CHECK(cells(come, Look::out_block) == 0);
  CHECK(cells(go, Look::out_block) > 3 * width);
  CHECK(cells(come, Look::in_block) > 3 * width);
  CHECK(row_of(go, Look::out_block) == 2);           // below title and totals
  CHECK(row_of(come, Look::in_block) == height - 6); // above the note
  CHECK(has(text_of(come), "240900558"));            // the result is still there,
  const Look colour = record(verdict).verdict == "pass" ? Look::good_block : Look::plain;
  CHECK(cells(come, Look::good_block) < cells(go, Look::good_block) + 1);
  CHECK((colour == Look::plain || cells(come, colour) > 20)); // written, no more filling
  CHECK((colour == Look::plain || cells(come, colour) < width * 3));
}

TEST_CASE("without an adapter or a bus the operator is told so") {
  StationPicture picture{.deed = LineDeed::plug_in, .last = record("error")};
  CHECK(has(text_of(lines_of(picture, 80, 24)), "PLUG IN THE ADAPTER"));
  picture.deed = LineDeed::mend;
  CHECK(has(text_of(lines_of(picture, 53, 16)), "CHECK THE CABLE"));
}

TEST_CASE("the last result stays until the next servo, and an error asks for the same one") {
  StationPicture picture{.deed = LineDeed::connect, .last = record("error")};
  picture.last->code = "not_back";
  CHECK(has(text_of(lines_of(picture, 80, 24)), "CONNECT IT AGAIN"));
  CHECK(has(text_of(lines_of(picture, 80, 24)), "not_back"));
  picture.last->code = "several_servos";
  picture.deed = LineDeed::take_off;
  CHECK(has(text_of(lines_of(picture, 80, 24)), "TAKE ALL OFF"));
  picture.deed = LineDeed::connect;
  CHECK(has(text_of(lines_of(picture, 80, 24)), "CONNECT ONE SERVO"));
  picture.last.reset();
  picture.deed = LineDeed::hands_off;
  CHECK(has(text_of(lines_of(picture, 80, 24)), "DO NOT TAKE IT OFF"));
  picture.deed = LineDeed::connect;
  CHECK(cells(lines_of(picture, 80, 24), Look::block) > 50); // READY
}

TEST_CASE("a unit that was spoilt has its small place until it was finished") {
  const auto [width, height] = GENERATE(std::pair<std::size_t, std::size_t>{80, 24},
                                        std::pair<std::size_t, std::size_t>{53, 16});
  INFO(width);
  const Error pulled{Code::not_back, "it was taken off too early"};
  StationPicture picture;
  const auto lines = [&] {
    auto all = lines_of(picture, width, height);
    REQUIRE(all.size() == height);
    for (const ScreenLine& line : all) {
      CHECK(display_width(text_of(line)) <= width);
    }
    return all;
  };
  const auto is_owed = [&](const std::string& number) {
    return has(text_of(lines().front()), number) && cells({lines().front()}, Look::warning_block);
  };
  const auto is_large = [&] {
    auto all = lines();
    all.erase(all.begin());
    return cells(all, Look::warning_block) > 50;
  };
  auto spoilt = record("error", "a");
  spoilt.code = "not_back";
  picture.take(spoilt, pulled, true, true);
  CHECK(is_owed("! 240900558"));
  CHECK(is_large()); // the verdict
  picture.enter(fleet::StationStage::take_off);
  picture.enter(fleet::StationStage::recognised); // another one was there already
  CHECK(is_owed("! 240900558"));
  CHECK(is_large()); // the verdict is still to be seen
  CHECK(has(text_of(lines()), "WAIT"));
  picture.enter(fleet::StationStage::working);
  CHECK(is_owed("! 240900558"));
  CHECK_FALSE(is_large());
  picture.enter(fleet::StationStage::gone, 240900559); // this one, too: its own number counts
  CHECK(is_large());
  picture.enter(fleet::StationStage::working);
  picture.take(record("pass", "b"), std::nullopt, false, true);
  CHECK(is_owed("! 240900558"));
  CHECK_FALSE(is_large());
  picture.enter(fleet::StationStage::left);
  CHECK_FALSE(is_large());                        // the last result stays
  picture.enter(fleet::StationStage::recognised); // and has gone, unknown
  picture.enter(fleet::StationStage::waiting);
  CHECK(is_large()); // nothing else is to be done
  picture.enter(fleet::StationStage::recognised);
  picture.take(record("pass", "a"), std::nullopt, false, true);
  CHECK(cells(lines(), Look::warning_block) == 0);
  for (const auto* unit : {"c", "d", "e", "f", "g", "h", "i", "j", "k"}) { // more than have room
    picture.take(record("error", unit), pulled, true, false);
  }
  CHECK(is_owed("+"));
}

TEST_CASE(
    "an error stays over the unit beside it until that is worked on, and not over the next one") {
  const Error pulled{Code::not_back, "it was taken off too early"};
  StationPicture picture;
  const auto says = [&](const char* text) { return has(text_of(lines_of(picture, 53, 16)), text); };
  picture.take(record("error"), pulled, true, true);
  SECTION("that one has a result at once") {
    picture.enter(fleet::StationStage::recognised);
    CHECK(says("240900558"));
    picture.take(record("skip", "b"), std::nullopt, false, true);
    CHECK(cells(lines_of(picture, 53, 16), Look::skip_block) > 100);
  }
  SECTION("that one goes, too") {
    picture.enter(fleet::StationStage::recognised);
    picture.enter(fleet::StationStage::gone, 7);
    CHECK_FALSE(picture.last);
  }
  SECTION("the bench was empty meanwhile") {
    picture.enter(fleet::StationStage::left);
    picture.enter(fleet::StationStage::recognised);
    CHECK_FALSE(picture.last);
  }
}

TEST_CASE("the number of the last one is large, and of a swapped label both are") {
  const auto [width, height] = GENERATE(std::pair<std::size_t, std::size_t>{80, 24},
                                        std::pair<std::size_t, std::size_t>{53, 16});
  INFO(width);
  StationPicture picture;
  const auto rows_with_ink = [&](Look ground) {
    std::size_t rows = 0;
    for (const ScreenLine& line : lines_of(picture, width, height)) {
      std::size_t ink = 0;
      for (const Piece& piece : line) {
        ink += piece.look == ground && (piece.text == "▀" || piece.text == "▄") ? 1U : 0U;
      }
      const bool is_full = cells({line}, ground) > 0 && cells({line}, Look::plain) > 2;
      rows += is_full || ink > 2 ? 1U : 0U;
    }
    return rows;
  };
  picture.take(record("pass"), std::nullopt, false, true);
  CHECK(rows_with_ink(Look::good_block) >= 5 + 3);
  CHECK(has(text_of(lines_of(picture, width, height)), "servo_id 3"));
  picture.take(record("error"), Error{Code::not_back, "it was taken off too early"}, true, false);
  CHECK(rows_with_ink(Look::warning_block) >= 5 + 3);
  auto swapped = record("fail");
  swapped.code = "label_mismatch";
  swapped.expected = 240900559;
  swapped.actual = swapped.serial_number;
  picture.take(swapped, Error{Code::label_mismatch, "another one"}, false, true);
  CHECK(rows_with_ink(Look::bad_block) >= 3 + 3);
  CHECK(has(text_of(lines_of(picture, width, height)), "240900559 ≠ 240900558"));
  CHECK(has(text_of(lines_of(picture, width, height)), "label_mismatch"));
}

TEST_CASE("a servo that has gone too early is told by signs, also one that was not known yet") {
  StationPicture picture;
  picture.enter(fleet::StationStage::recognised);
  picture.enter(fleet::StationStage::working);
  picture.enter(fleet::StationStage::gone);
  const auto is_told = [&] {
    const auto lines = lines_of(picture, 53, 16);
    return cells(lines, Look::in_block) > 100 && cells(lines, Look::warning) == 0 &&
           cells(lines, Look::warning_block) > 30 && !has(text_of(lines), "DO NOT");
  };
  CHECK(is_told());
  picture.enter(fleet::StationStage::working); // it was not
  CHECK(has(text_of(lines_of(picture, 53, 16)), "DO NOT TAKE IT OFF"));
  picture.enter(fleet::StationStage::gone);
  picture.enter(fleet::StationStage::waiting); // without a record
  CHECK(is_told());
  picture.enter(fleet::StationStage::recognised);
  CHECK_FALSE(is_told());
  picture.enter(fleet::StationStage::waiting);
  CHECK_FALSE(is_told());
}

TEST_CASE("a result stands while its unit is there, and over no other one") {
  const auto [width, height] = GENERATE(std::pair<std::size_t, std::size_t>{80, 24},
                                        std::pair<std::size_t, std::size_t>{53, 16});
  StationPicture picture;
  const auto filled = [&](Look look) {
    return cells(lines_of(picture, width, height), look) > width * 5;
  };
  const auto says = [&](const char* text) {
    return has(text_of(lines_of(picture, width, height)), text);
  };
  picture.take(record("pass"), std::nullopt, false, true);
  CHECK(filled(Look::good_block));
  auto several = record("error");
  several.unique_id.reset();
  several.serial_number.reset();
  several.code = "several_servos";
  picture.join(several, Error{Code::several_servos, "two"});
  CHECK(picture.bells() == 2);
  CHECK(filled(Look::good_block));
  CHECK(says("TAKE ALL OFF"));
  SECTION("the finished one is taken off first") {
    picture.enter(fleet::StationStage::other);
    CHECK(cells(lines_of(picture, width, height), Look::good_block) == 0);
    CHECK(filled(Look::warning_block));
    CHECK(says("TAKE ALL OFF"));
    CHECK_FALSE(says("240900558"));
  }
  SECTION("both are taken off") {
    picture.enter(fleet::StationStage::left);
    CHECK_FALSE(filled(Look::good_block));
    CHECK(says("240900558"));
    CHECK(cells(lines_of(picture, width, height), Look::in_block) == 0); // not yet
    CHECK(cells(lines_of(picture, width, height), Look::out_block) == 0);
    picture.enter(fleet::StationStage::waiting);
    CHECK(says("CONNECT ONE SERVO"));
  }
  picture.enter(fleet::StationStage::recognised);
  CHECK_FALSE(picture.are_several());
}

TEST_CASE("what is to be done follows what lies on the bench") {
  StationPicture picture;
  const auto has_sign = [&](Look look) { return cells(lines_of(picture, 53, 16), look) > 100; };
  picture.take(record("pass"), std::nullopt, false, true);
  CHECK(has_sign(Look::out_block));
  picture.enter(fleet::StationStage::left);
  CHECK(has_sign(Look::in_block));
  CHECK_FALSE(has_sign(Look::out_block));
  CHECK(cells(lines_of(picture, 53, 16), Look::good_block) > 20); // written
  CHECK(cells(lines_of(picture, 53, 16), Look::good_block) < 150);
  picture.enter(fleet::StationStage::other); // it, or another one
  CHECK(cells(lines_of(picture, 53, 16), Look::good_block) < 150);
  CHECK_FALSE(has_sign(Look::in_block));
  CHECK_FALSE(has_sign(Look::out_block));
  picture.enter(fleet::StationStage::take_off);
  CHECK(has_sign(Look::out_block));
  CHECK(has_sign(Look::good_block));
  const Error pulled{Code::not_back, "it was taken off too early"};
  picture.take(record("error"), pulled, true, false);
  CHECK(has_sign(Look::in_block));
  picture.take(record("error"), pulled, true, true); // another one is there already
  picture.enter(fleet::StationStage::take_off);
  CHECK_FALSE(has_sign(Look::in_block));
  CHECK_FALSE(has_sign(Look::out_block));
  picture.enter(fleet::StationStage::left); // it has gone, too
  CHECK(has_sign(Look::in_block));
}

TEST_CASE("a run that was stopped says so by a sign while it brings its servo to the end") {
  for (const auto stage : {fleet::StationStage::working, fleet::StationStage::recognised}) {
    StationPicture picture;
    picture.enter(stage);
    CHECK(cells(lines_of(picture, 53, 16), Look::warning_block) == 0);
    picture.is_stopping = true;
    CHECK(cells(lines_of(picture, 53, 16), Look::warning_block) > 50);
    CHECK(cells(lines_of(picture, 80, 24), Look::warning_block) > 100);
    CHECK(cells(lines_of(picture, 53, 16), Look::block) > 100); // what is to be left stays
    picture.totals.owed.push_back({"a", "104"});                // and does not hide it
    CHECK(has(text_of(lines_of(picture, 53, 16)), "104"));
  }
}

TEST_CASE("labels that were scanned ahead are counted, and of swapped ones both are shown") {
  StationPicture picture{.deed = LineDeed::hands_off, .label = "403", .waiting_labels = 2};
  CHECK(has(text_of(lines_of(picture, 53, 16)), "label 403   +2"));
  picture.label.clear();
  CHECK(has(text_of(lines_of(picture, 53, 16)), "+2"));
  picture.waiting_labels = 0;
  picture.note = "a note";
  CHECK(has(text_of(lines_of(picture, 53, 16)), "a note"));
  auto swapped = record("fail");
  swapped.code = "label_mismatch";
  swapped.parameter = "serial_number";
  swapped.expected = 240900559;
  swapped.actual = swapped.serial_number;
  picture.take(swapped, Error{Code::label_mismatch, "its serial number is another one"}, false,
               false);
  CHECK(has(text_of(lines_of(picture, 53, 16)), "240900559 ≠ 240900558"));
  picture.totals.owed.push_back({"b", "104"});
  CHECK(has(text_of(lines_of(picture, 53, 16)), "240900559 ≠ 240900558"));
}

TEST_CASE("a line that is no label has a sign of its own") {
  const auto [width, height] = GENERATE(std::pair<std::size_t, std::size_t>{80, 24},
                                        std::pair<std::size_t, std::size_t>{53, 16});
  StationPicture picture{.deed = LineDeed::scan, .last = record("pass"), .bad_label = "hello"};
  CHECK(cells(lines_of(picture, width, height), Look::in_block) == 0);
  CHECK(cells(lines_of(picture, width, height), Look::warning_block) > 3 * width);
  CHECK(has(text_of(lines_of(picture, width, height)), "hello"));
  CHECK(has(text_of(lines_of(picture, width, height)), "SCAN IT AGAIN"));
  picture.deed = LineDeed::hands_off; // it was read ahead
  CHECK(cells({lines_of(picture, width, height).back()}, Look::warning_block) > 5);
  CHECK(has(text_of(lines_of(picture, width, height)), "hello"));
  picture.bad_label.clear();
  CHECK(cells(lines_of(picture, width, height), Look::warning_block) == 0);
}

TEST_CASE("a unit that was finished before has the symbol of a pass beside that of a skip") {
  const auto [width, height] = GENERATE(std::pair<std::size_t, std::size_t>{80, 24},
                                        std::pair<std::size_t, std::size_t>{53, 16});
  StationPicture picture;
  picture.take(record("skip"), std::nullopt, false, true);
  CHECK(cells(lines_of(picture, width, height), Look::skip_block) > 3 * width);
  CHECK(cells(lines_of(picture, width, height), Look::good_block) > 15);
  picture.enter(fleet::StationStage::left);
  CHECK(cells(lines_of(picture, width, height), Look::skip_block) > 20);
  CHECK(cells(lines_of(picture, width, height), Look::good_block) > 10);
}

TEST_CASE("while the station is busy something moves") {
  StationPicture picture{.deed = LineDeed::leave};
  for (const auto deed : {LineDeed::leave, LineDeed::hands_off}) {
    picture.deed = deed;
    std::set<std::size_t> lit;
    for (int i = 0; i < 4; ++i) {
      CHECK(picture.tick());
      lit.insert(cells(lines_of(picture, 53, 16), Look::block));
    }
    CHECK(lit.size() > 2);
  }
  picture.deed = LineDeed::connect;
  CHECK_FALSE(picture.tick()); // nothing to draw
}

TEST_CASE("a unit that restarts for ever has to be taken off, not connected again") {
  StationPicture picture;
  for (const bool is_repeating : {true, false}) {
    auto spoilt = record("error");
    spoilt.code = "not_back";
    picture.take(spoilt, Error{Code::not_back, "it was taken off too early"}, is_repeating, false);
    const auto lines = lines_of(picture, 80, 24);
    CHECK((cells(lines, Look::in_block) > 0) == is_repeating);
    CHECK((cells(lines, Look::out_block) > 0) != is_repeating);
  }
}

TEST_CASE("a tiny screen is no reason to fail") {
  const StationPicture picture{.last = record("pass")};
  CHECK(has(text_of(lines_of(picture, 20, 24)), "PASS"));
  for (std::size_t height : {0U, 1U, 4U, 5U, 6U}) {
    for (std::size_t width : {0U, 1U, 10U}) {
      CHECK(lines_of(picture, width, height).size() >= height);
    }
  }
}

TEST_CASE("the first-pass yield is of units, by their first result") {
  LineTotals totals;
  CHECK_FALSE(totals.first_pass_yield());
  totals.add(record("error", "a"));
  totals.add(record("skip", "b"));
  CHECK_FALSE(totals.first_pass_yield());
  totals.add(record("pass", "a"));
  totals.add(record("fail", "c"));
  totals.add(record("pass", "c"));
  CHECK(totals.first_pass_yield() == 50);
  CHECK(totals.verdicts.at("pass") == 2);
}
