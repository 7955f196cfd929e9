#include "cli/line/station_view.hpp"

#include "blactl/fleet/line/line_record.hpp"

#include "cli/line/texts.hpp"
#include "cli/output/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

namespace blactl::cli {

using fleet::StationStage;
using state::LedgerRecord;

namespace {

constexpr std::size_t glyph_height = 5;

using Glyph = std::array<std::string_view, glyph_height>;

/// Capitals of the words below, in squares.
const std::map<char, Glyph>& letters() {
  static const std::map<char, Glyph> all{{'A', {".##.", "#..#", "####", "#..#", "#..#"}},
                                         {'B', {"###.", "#..#", "###.", "#..#", "###."}},
                                         {'D', {"###.", "#..#", "#..#", "#..#", "###."}},
                                         {'E', {"####", "#...", "###.", "#...", "####"}},
                                         {'F', {"####", "#...", "###.", "#...", "#..."}},
                                         {'I', {".###", "..#.", "..#.", "..#.", ".###"}},
                                         {'K', {"#..#", "#.#.", "##..", "#.#.", "#..#"}},
                                         {'L', {"#...", "#...", "#...", "#...", "####"}},
                                         {'O', {".##.", "#..#", "#..#", "#..#", ".##."}},
                                         {'P', {"###.", "#..#", "###.", "#...", "#..."}},
                                         {'R', {"###.", "#..#", "###.", "#.#.", "#..#"}},
                                         {'S', {".###", "#...", ".##.", "...#", "###."}},
                                         {'U', {"#..#", "#..#", "#..#", "#..#", ".##."}},
                                         {'Y', {"#..#", "#..#", ".##.", ".#..", ".#.."}}};
  return all;
}

/// How a state fills the screen.
struct Face {
  std::string_view word;
  Glyph symbol;
  Look look;
  int bells;
};

constexpr Glyph arrow_down{"..#..", "..#..", "#.#.#", ".###.", "..#.."};
constexpr Glyph arrow_up{"..#..", ".###.", "#.#.#", "..#..", "..#.."};
constexpr Glyph arrows_up{"..#..", ".###.", "#.#.#", ".###.", "#.#.#"};
constexpr Glyph arrow_aside{"..#..", "...#.", "#####", "...#.", "..#.."};
constexpr Glyph bars{"#.#.#", "#.#.#", "#.#.#", "#.#.#", "#.#.#"};
constexpr Glyph barrier{"#####", "#####", "#####", "#####", "#####"};
constexpr Glyph ring{".###.", "#...#", "#...#", "#...#", ".###."};
constexpr Glyph cross{"#...#", ".#.#.", "..#..", ".#.#.", "#...#"};
constexpr Glyph exclamation{"..#..", "..#..", "..#..", ".....", "..#.."};
constexpr Glyph equal{".....", "#####", ".....", "#####", "....."};
constexpr Glyph dots{".....", ".....", "#.#.#", ".....", "....."};

Face face_of(const std::string& verdict) {
  return verdict == fleet::verdict::pass   ? Face{"PASS", ring, Look::good_block, 1}
         : verdict == fleet::verdict::fail ? Face{"FAIL", cross, Look::bad_block, 3}
         : verdict == fleet::verdict::skip ? Face{"SKIP", equal, Look::block, 1}
                                           : Face{"ERROR", exclamation, Look::warning_block, 2};
}

/// The colours of an area and of what is drawn on it.
struct Paint {
  Look ground, ink;
};

/// One row of a glyph: squares of `square` cells.
void add_row(ScreenLine& line, std::string_view row, std::size_t square, Paint paint) {
  for (const char dot : row) {
    line.push_back({std::string(square, ' '), dot == '#' ? paint.ink : paint.ground});
  }
}

ScreenLine centred(std::string text, std::size_t width, Look look) {
  const std::size_t used = std::min(display_width(text), width);
  const std::size_t before = (width - used) / 2;
  return {
      {std::string(before, ' ') + std::move(text) + std::string(width - used - before, ' '), look}};
}

/// Symbol and word beside each other; squares as wide as fits.
ScreenLine big_row(const Face& face, std::size_t row, std::size_t width, Paint paint) {
  constexpr std::size_t letter = 5; // with its gap
  constexpr std::size_t symbol = 7;
  const std::size_t squares = symbol + letter * face.word.size();
  const std::size_t square = squares * 2 <= width ? 2 : 1;
  const std::size_t margin = width > squares * square ? (width - squares * square) / 2 : 0;
  ScreenLine line{{std::string(margin, ' '), paint.ground}};
  add_row(line, face.symbol.at(row), square, paint);
  add_row(line, "..", square, paint);
  for (const char each : face.word) {
    add_row(line, letters().at(each).at(row), square, paint);
    add_row(line, ".", square, paint);
  }
  const std::size_t used = margin + squares * square;
  line.push_back({std::string(width > used ? width - used : 0, ' '), paint.ground});
  return line;
}

} // namespace

std::string text_of(const LineTotals& totals) {
  const auto count = [&](std::string_view verdict) {
    const auto found = totals.verdicts.find(std::string(verdict));
    return found != totals.verdicts.end() ? found->second : 0;
  };
  const auto yield = totals.first_pass_yield();
  return say<texts::station_totals>(count(fleet::verdict::pass), count(fleet::verdict::fail),
                                    count(fleet::verdict::error), count(fleet::verdict::skip)) +
         (yield ? " " + say<texts::station_yield>(fmt::format("{:.1f}", *yield)) : std::string());
}

namespace {

/// How what is to be done now is told.
struct Sign {
  Glyph symbol;
  Look look;
  bool is_on_top; ///< something has to go; else below
  const Text& text;
};

Sign sign_of(const StationPicture& picture) {
  const auto is = [&](std::string_view verdict) {
    return picture.last && picture.last->verdict == verdict;
  };
  const bool are_several = picture.last && picture.last->code == name(Code::several_servos);
  switch (picture.deed) {
  case LineDeed::connect:
    return {arrow_down, Look::in_block, false,
            are_several                 ? texts::deed_connect_one
            : is(fleet::verdict::error) ? texts::deed_connect_again
                                        : texts::deed_connect};
  case LineDeed::scan: return {bars, Look::in_block, false, texts::deed_scan};
  case LineDeed::leave: return {dots, Look::block, false, texts::deed_leave};
  case LineDeed::hands_off: return {barrier, Look::block, false, texts::deed_hands_off};
  case LineDeed::plug_in: return {exclamation, Look::warning_block, false, texts::deed_plug_in};
  case LineDeed::mend: return {exclamation, Look::warning_block, false, texts::deed_mend};
  case LineDeed::take_off: break;
  }
  return are_several ? Sign{arrows_up, Look::out_block, true, texts::deed_take_all_off}
         : is(fleet::verdict::fail)
             ? Sign{arrow_aside, Look::out_block, true, texts::deed_put_aside}
             : Sign{arrow_up, Look::out_block, true, texts::deed_take_off};
}

/// The symbol at both ends, the words in both languages between them; without the height for that
/// the words alone.
std::vector<ScreenLine> lines_of(const Sign& sign, std::size_t width, bool is_tall) {
  constexpr std::size_t side = 14; // a symbol and its gap, in squares of two cells
  const bool has_symbols = is_tall && width > 2 * side + 20;
  const std::size_t between = has_symbols ? width - 2 * side : width;
  const Paint paint{sign.look, Look::plain};
  std::vector<ScreenLine> lines;
  for (std::size_t row = 0; row < (is_tall ? glyph_height : 2); ++row) {
    const std::size_t of_en = is_tall ? 1 : 0, of_ja = is_tall ? 3 : 1;
    const std::string_view text = row == of_en   ? sign.text.en
                                  : row == of_ja ? sign.text.ja
                                                 : std::string_view();
    ScreenLine line;
    const auto add_symbol = [&] {
      add_row(line, ".", 2, paint);
      add_row(line, sign.symbol.at(row), 2, paint);
      add_row(line, ".", 2, paint);
    };
    has_symbols ? add_symbol() : void();
    line.push_back(centred(std::string(text), between, sign.look).front());
    has_symbols ? add_symbol() : void();
    lines.push_back(std::move(line));
  }
  return lines;
}

/// Serial number, code and IDs: what is said about the last one.
std::vector<std::string> details(const StationPicture& picture) {
  const LedgerRecord& record = *picture.last;
  std::vector<std::string> lines{record.serial_number ? std::to_string(*record.serial_number)
                                                      : printable(record.label.value_or(""))};
  if (record.code) {
    lines.push_back(*record.code);
    if (picture.reason) {
      lines.push_back(printable(picture.reason->message));
    }
  } else if (record.servo_id && record.static_node_id) {
    lines.push_back(
        fmt::format("servo_id {}   static_node_id {}", *record.servo_id, *record.static_node_id));
  }
  return lines;
}

Face face_of(const StationPicture& picture) {
  return picture.last ? face_of(picture.last->verdict.value_or(""))
         : picture.deed == LineDeed::hands_off || picture.deed == LineDeed::leave
             ? Face{"BUSY", dots, Look::block, 0}
             : Face{"READY", ring, Look::plain, 0};
}

} // namespace

void LineTotals::add(const LedgerRecord& record) {
  ++verdicts[record.verdict.value_or("")];
  const bool is_result =
      record.verdict == fleet::verdict::pass || record.verdict == fleet::verdict::fail;
  if (is_result && record.unique_id) {
    first_passed.emplace(*record.unique_id, record.verdict == fleet::verdict::pass);
  }
}

std::optional<double> LineTotals::first_pass_yield() const {
  if (first_passed.empty()) {
    return std::nullopt;
  }
  const auto passed =
      std::ranges::count_if(first_passed, [](const auto& unit) { return unit.second; });
  constexpr double percent = 100;
  return percent * static_cast<double>(passed) / static_cast<double>(first_passed.size());
}

namespace {

/// While its servo is there the verdict fills its part of the screen; after that it is written.
std::vector<ScreenLine> verdict_lines(const StationPicture& picture, std::size_t width,
                                      std::size_t room) {
  const Face face = face_of(picture);
  const bool fills = picture.deed == LineDeed::take_off || face.look == Look::plain;
  const Paint paint{fills ? face.look : Look::plain, face.look == Look::plain ? Look::block
                                                     : fills                  ? Look::plain
                                                                              : face.look};
  std::vector<ScreenLine> lines;
  lines.reserve(room + glyph_height);
  for (std::size_t row = 0; row < glyph_height; ++row) {
    lines.push_back(big_row(face, row, width, paint));
  }
  if (picture.last) {
    lines.push_back(centred("", width, paint.ground));
    for (std::string& text : details(picture)) {
      lines.push_back(centred(std::move(text), width, paint.ground));
    }
  }
  lines.resize(std::min(lines.size(), room));
  const ScreenLine empty = centred("", width, paint.ground);
  lines.insert(lines.begin(), (room - lines.size()) / 2, empty);
  lines.insert(lines.end(), room - lines.size(), empty);
  return lines;
}

} // namespace

std::vector<ScreenLine> lines_of(const StationPicture& picture, std::size_t width,
                                 std::size_t height) {
  constexpr std::size_t around = 3; // title, totals, note
  constexpr std::size_t enough = around + glyph_height + 2 + glyph_height;
  const Sign sign = sign_of(picture);
  const auto signs = lines_of(sign, width, height >= enough);
  const std::size_t used = around + signs.size();
  const auto verdict = verdict_lines(picture, width, height > used ? height - used : 0);
  std::vector<ScreenLine> lines{{{picture.title, Look::head}}, {{text_of(picture.totals)}}};
  const auto& first = sign.is_on_top ? signs : verdict;
  const auto& second = sign.is_on_top ? verdict : signs;
  lines.insert(lines.end(), first.begin(), first.end());
  lines.insert(lines.end(), second.begin(), second.end());
  lines.push_back(
      picture.label.empty()
          ? ScreenLine{{picture.note, Look::dim}}
          : ScreenLine{{say<texts::station_label>(printable(picture.label)), Look::head}});
  return lines;
}

StationView::StationView(std::unique_ptr<Screen> screen, const Reporter& reporter,
                         std::string title)
    : screen_(std::move(screen)), reporter_(reporter), picture_{.title = std::move(title)} {
  reporter_.hold(&held_);
}

StationView::~StationView() {
  screen_.reset();
  reporter_.hold(nullptr);
  if (!held_.empty()) {
    reporter_.repeat(held_);
  }
}

void StationView::enter(StationStage stage) {
  switch (stage) {
  case StationStage::waiting: picture_.deed = LineDeed::connect; break;
  case StationStage::recognised:
    picture_.deed = LineDeed::leave;
    picture_.last.reset();
    told_ = held_.size(); // notes about the one before are over
    break;
  case StationStage::working: picture_.deed = LineDeed::hands_off; break;
  case StationStage::ended: return; // its record comes
  case StationStage::take_off:
    picture_.deed = picture_.reason && fleet::is_done_again(picture_.reason->code)
                        ? LineDeed::connect
                        : LineDeed::take_off;
    break;
  }
  draw();
}

void StationView::wait_for_label() {
  picture_.deed = LineDeed::scan;
  draw();
}

void StationView::show_label(std::string label) {
  picture_.label = std::move(label);
  draw();
}

void StationView::lose_bus(bool is_away) {
  picture_.deed = is_away ? LineDeed::plug_in : LineDeed::mend;
  draw();
}

void StationView::take(const LedgerRecord& record, const std::optional<Error>& reason) {
  picture_.totals.add(record);
  picture_.last = record;
  picture_.reason = reason;
  enter(StationStage::take_off);
  bells_ = face_of(picture_).bells;
  tick();
}

void StationView::tick() {
  if (bells_ > 0) {
    --bells_;
    Screen::ring();
  }
}

void StationView::draw() {
  const std::string_view recent = std::string_view(held_).substr(told_);
  const std::string_view text = recent.substr(0, recent.find_last_not_of('\n') + 1);
  picture_.note = text.substr(text.rfind('\n') + 1);
  screen_->fit();
  screen_->draw(lines_of(picture_, screen_->width(), screen_->height()));
}

std::string StationView::typed() {
  std::string text;
  constexpr Key first_printable = U' ', last_printable = U'~';
  while (const auto key = screen_->read()) {
    if (*key == keys::enter) {
      text += '\n';
    } else if (*key == keys::back) {
      text += '\b';
    } else if (*key == keys::end_of_input) {
      text += '\x04';
    } else if (*key >= first_printable && *key <= last_printable) {
      text += static_cast<char>(*key);
    }
  }
  return text;
}

} // namespace blactl::cli
