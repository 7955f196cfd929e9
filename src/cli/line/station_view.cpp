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

/// One row of a glyph: squares of `square` cells.
void add_row(ScreenLine& line, std::string_view row, std::size_t square, Look ground) {
  for (const char dot : row) {
    const Look ink = ground == Look::plain ? Look::block : Look::plain;
    line.push_back({std::string(square, ' '), dot == '#' ? ink : ground});
  }
}

ScreenLine centred(std::string text, std::size_t width, Look look) {
  const std::size_t used = std::min(display_width(text), width);
  const std::size_t before = (width - used) / 2;
  return {
      {std::string(before, ' ') + std::move(text) + std::string(width - used - before, ' '), look}};
}

/// Symbol and word beside each other; squares as wide as fits.
ScreenLine big_row(const Face& face, std::size_t row, std::size_t width) {
  constexpr std::size_t letter = 5; // with its gap
  constexpr std::size_t symbol = 7;
  const std::size_t squares = symbol + letter * face.word.size();
  const std::size_t square = squares * 2 <= width ? 2 : 1;
  const std::size_t margin = width > squares * square ? (width - squares * square) / 2 : 0;
  ScreenLine line{{std::string(margin, ' '), face.look}};
  add_row(line, face.symbol.at(row), square, face.look);
  add_row(line, "..", square, face.look);
  for (const char each : face.word) {
    add_row(line, letters().at(each).at(row), square, face.look);
    add_row(line, ".", square, face.look);
  }
  const std::size_t used = margin + squares * square;
  line.push_back({std::string(width > used ? width - used : 0, ' '), face.look});
  return line;
}

std::string totals_text(const LineTotals& totals) {
  const auto count = [&](std::string_view verdict) {
    const auto found = totals.verdicts.find(std::string(verdict));
    return found != totals.verdicts.end() ? found->second : 0;
  };
  const auto yield = totals.first_pass_yield();
  return say<texts::station_totals>(count(fleet::verdict::pass), count(fleet::verdict::fail),
                                    count(fleet::verdict::error), count(fleet::verdict::skip)) +
         (yield ? " " + say<texts::station_yield>(fmt::format("{:.1f}", *yield)) : std::string());
}

const Text& deed_text(const StationPicture& picture) {
  const auto is = [&](std::string_view verdict) {
    return picture.last && picture.last->verdict == verdict;
  };
  switch (picture.deed) {
  case LineDeed::connect:
    return is(fleet::verdict::error) ? texts::deed_connect_again : texts::deed_connect;
  case LineDeed::scan: return texts::deed_scan;
  case LineDeed::leave: return texts::deed_leave;
  case LineDeed::hands_off: return texts::deed_hands_off;
  case LineDeed::take_off: break;
  }
  const bool are_several = picture.last && picture.last->code == name(Code::several_servos);
  return is(fleet::verdict::fail) ? texts::deed_put_aside
         : are_several            ? texts::deed_take_all_off
                                  : texts::deed_take_off;
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

std::vector<ScreenLine> lines_of(const StationPicture& picture, std::size_t width,
                                 std::size_t height) {
  constexpr std::size_t around = 5; // title, totals, note, and what to do in two languages
  const Face face = face_of(picture);
  std::vector<ScreenLine> middle;
  middle.reserve(height);
  for (std::size_t row = 0; row < glyph_height; ++row) {
    middle.push_back(big_row(face, row, width));
  }
  if (picture.last) {
    middle.push_back(centred("", width, face.look));
    for (std::string& text : details(picture)) {
      middle.push_back(centred(std::move(text), width, face.look));
    }
  }
  const std::size_t room = height > around ? height - around : 0;
  middle.resize(std::min(middle.size(), room));
  const std::size_t before = (room - middle.size()) / 2;
  std::vector<ScreenLine> lines{{{picture.title, Look::head}}, {{totals_text(picture.totals)}}};
  lines.insert(lines.end(), before, centred("", width, face.look));
  lines.insert(lines.end(), middle.begin(), middle.end());
  lines.insert(lines.end(), room - middle.size() - before, centred("", width, face.look));
  lines.push_back(
      picture.label.empty()
          ? ScreenLine{{picture.note, Look::dim}}
          : ScreenLine{{say<texts::station_label>(printable(picture.label)), Look::head}});
  const Text& deed = deed_text(picture);
  lines.push_back(centred(std::string(deed.en), width, Look::chosen));
  lines.push_back(centred(std::string(deed.ja), width, Look::chosen));
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
  case StationStage::take_off: picture_.deed = LineDeed::take_off; break;
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

void StationView::take(const LedgerRecord& record, const std::optional<Error>& reason) {
  picture_.totals.add(record);
  picture_.last = record;
  picture_.reason = reason;
  picture_.deed = LineDeed::take_off;
  bells_ = face_of(picture_).bells;
  tick();
  draw();
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
