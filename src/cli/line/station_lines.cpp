// How the picture of a station is drawn.

#include "blactl/fleet/line/line_record.hpp"

#include "cli/line/big_letters.hpp"
#include "cli/line/station_picture.hpp"
#include "cli/line/texts.hpp"
#include "cli/output/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::cli {

using state::LedgerRecord;

namespace {

/// How a state fills the screen.
struct Face {
  Glyph symbol;
  std::string word;
  Look look;
  bool was_good = false; ///< before: the symbol of a pass stands beside it
};

Face face_of(const std::string& verdict) {
  return verdict == fleet::verdict::pass   ? Face{ring, "PASS", Look::good_block}
         : verdict == fleet::verdict::fail ? Face{cross, "FAIL", Look::bad_block}
         : verdict == fleet::verdict::skip ? Face{equal, "SKIP", Look::skip_block, true}
                                           : Face{exclamation, "ERROR", Look::warning_block};
}

ScreenLine centred(std::string text, std::size_t width, Look look) {
  const std::size_t used = std::min(display_width(text), width);
  const std::size_t before = (width - used) / 2;
  return {
      {std::string(before, ' ') + std::move(text) + std::string(width - used - before, ' '), look}};
}

/// That it goes on: one more dot with every beat.
Glyph moving_dots(const StationPicture& picture) {
  constexpr std::array<std::string_view, 4> rows{".....", "#....", "#.#..", "#.#.#"};
  return {".....", ".....", rows.at(picture.beat % rows.size()), ".....", "....."};
}

/// How what is to be done now is told.
struct Sign {
  Glyph symbol;
  Look look;
  bool is_on_top; ///< something has to go; else below
  const Text& text;
  std::string between{};              ///< the words: what it is about
  const Glyph* last_symbol = nullptr; ///< at the right end; null: the same one
};

Sign sign_of(const StationPicture& picture) {
  const auto is = [&](std::string_view verdict) {
    return picture.last && picture.last->verdict == verdict;
  };
  const bool are_several = picture.are_several();
  switch (picture.deed) {
  case LineDeed::connect:
    return {arrow_down, Look::in_block, false,
            are_several                 ? texts::deed_connect_one
            : is(fleet::verdict::error) ? texts::deed_connect_again
                                        : texts::deed_connect};
  case LineDeed::scan:
    return picture.bad_label.empty() ? Sign{bars, Look::in_block, false, texts::deed_scan}
                                     : Sign{bars,
                                            Look::warning_block,
                                            false,
                                            texts::deed_scan_again,
                                            printable(picture.bad_label),
                                            &cross};
  case LineDeed::leave: return {moving_dots(picture), Look::block, false, texts::deed_leave};
  case LineDeed::hands_off: return {barrier, Look::block, false, texts::deed_hands_off};
  case LineDeed::bring_back: return {arrow_down, Look::in_block, false, texts::deed_connect_again};
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
    const bool has_room = display_width(sign.between) <= between;
    const std::string_view text = row == of_en           ? sign.text.en
                                  : row == of_ja         ? sign.text.ja
                                  : row == 2 && has_room ? std::string_view(sign.between)
                                                         : std::string_view();
    ScreenLine line;
    const auto add_side = [&](const Glyph& symbol) {
      add_row(line, ".", 2, paint);
      add_row(line, symbol.at(row), 2, paint);
      add_row(line, ".", 2, paint);
    };
    has_symbols ? add_side(sign.symbol) : void();
    line.push_back(centred(std::string(text), between, sign.look).front());
    has_symbols ? add_side(sign.last_symbol != nullptr ? *sign.last_symbol : sign.symbol) : void();
    lines.push_back(std::move(line));
  }
  return lines;
}

bool has_other_label(const LedgerRecord& record) {
  return record.code == name(Code::label_mismatch) && record.expected && record.actual;
}

/// Serial number, code and IDs: what is said about the last one.
std::vector<std::string> details(const StationPicture& picture) {
  if (!picture.last) {
    return {};
  }
  const LedgerRecord& record = *picture.last;
  if (has_other_label(record)) {
    return {fmt::format("{} ≠ {}", *record.expected, *record.actual), *record.code};
  }
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
  std::erase(lines, "");
  return lines;
}

/// What is said of the last one in large digits: its number, or the two of a label that is
/// another unit's.
std::vector<DrawnRow> numbers(const StationPicture& picture, Paint paint) {
  std::vector<DrawnRow> rows;
  const auto add = [&](std::int64_t number, const Glyph* symbol) {
    DrawnRow& row = rows.emplace_back();
    symbol != nullptr ? add_symbol(row, *symbol, paint) : void();
    add_word(row, std::to_string(number), paint);
  };
  if (picture.last && has_other_label(*picture.last)) {
    add(*picture.last->expected, &bars);
    add(*picture.last->actual, &unequal);
  } else if (picture.last && picture.last->serial_number) {
    add(*picture.last->serial_number, nullptr);
  }
  return rows;
}

Face face_of(const StationPicture& picture) {
  if (picture.last) {
    return face_of(picture.last->verdict.value_or(""));
  }
  if (picture.is_busy()) {
    return picture.is_stopping ? Face{barrier, "STOP", Look::warning_block}
                               : Face{moving_dots(picture), "BUSY", Look::block};
  }
  if (picture.deed == LineDeed::bring_back) {
    return {exclamation, picture.gone ? std::to_string(*picture.gone) : "GONE",
            Look::warning_block};
  }
  if (picture.deed == LineDeed::connect &&
      !picture.totals.owed.empty()) { // nothing else is to be done
    return {exclamation, picture.totals.owed.back().number, Look::warning_block};
  }
  return {ring, "READY", Look::block};
}

DrawnRow row_of(const Face& face, Paint paint) {
  DrawnRow row;
  add_symbol(row, face.symbol, paint);
  add_word(row, face.word, paint);
  if (face.was_good) {
    const bool fills = paint.ground != Look::plain;
    row.push_back({{".", ".", ".", ".", "."}, paint});
    add_symbol(row, ring,
               fills ? Paint{Look::good_block, Look::plain} : Paint{Look::plain, Look::good_block});
  }
  return row;
}

void append(std::vector<ScreenLine>& lines, std::vector<ScreenLine> more) {
  std::ranges::move(more, std::back_inserter(lines));
}

/// While its servo is there the verdict fills its part of the screen; after that it is written.
/// Details that have no room stay in `rest`.
std::vector<ScreenLine> verdict_lines(const StationPicture& picture, std::size_t width,
                                      std::size_t room, std::vector<std::string>& rest) {
  const Face face = face_of(picture);
  const bool fills = picture.last && picture.deed == LineDeed::take_off;
  const Paint paint = fills ? Paint{face.look, Look::plain} : Paint{Look::plain, face.look};
  const auto rows = numbers(picture, paint);
  const std::size_t halves = rows.size() * static_cast<std::size_t>(GlyphSize::half);
  const ScreenLine empty = centred("", width, paint.ground);
  std::vector<ScreenLine> lines;
  if (room >= glyph_height + halves) {
    append(lines, lines_of(row_of(face, paint), GlyphSize::full, width, paint.ground));
  }
  if (lines.empty() && room > halves) { // the numbers are more than the word
    lines.push_back(centred(face.word, width, paint.ground));
  }
  const bool is_wide = room >= glyph_height + 2 + rows.size() * (glyph_height + 1) + rest.size();
  const bool has_gap = room > lines.size() + halves + rest.size();
  for (const DrawnRow& row : rows) {
    if (is_wide || (has_gap && &row == &rows.front())) {
      lines.push_back(empty);
    }
    append(lines, lines_of(row, is_wide ? GlyphSize::full : GlyphSize::half, width, paint.ground));
  }
  if (room > lines.size() + rest.size()) {
    lines.push_back(empty);
  }
  while (!rest.empty() && lines.size() < room) {
    lines.push_back(centred(rest.front(), width, paint.ground));
    rest.erase(rest.begin());
  }
  lines.resize(std::min(lines.size(), room));
  lines.insert(lines.begin(), (room - lines.size()) / 2, empty);
  lines.insert(lines.end(), room - lines.size(), empty);
  return lines;
}

/// The units that have to come back, always in the same place; then the title.
ScreenLine first_line(const StationPicture& picture, std::size_t width) {
  if (picture.totals.owed.empty()) {
    return {{picture.title, Look::head}};
  }
  constexpr std::size_t of_rest = 6;
  std::string owed;
  std::size_t count = 0;
  for (const LineTotals::Owed& each : picture.totals.owed) {
    if (count > 0 && owed.size() + each.number.size() + of_rest > width) {
      break;
    }
    owed += " " + each.number;
    ++count;
  }
  const std::size_t more = picture.totals.owed.size() - count;
  return {{" !" + owed + (more > 0 ? fmt::format(" +{} ", more) : " "), Look::warning_block},
          {"  " + picture.title, Look::head}};
}

/// Labels, else the note; and what had no room above.
ScreenLine last_line(const StationPicture& picture, const std::vector<std::string>& rest) {
  ScreenLine line;
  if (!picture.bad_label.empty() && picture.deed != LineDeed::scan) {
    line.push_back({" X  " + printable(picture.bad_label) + "  X ", Look::warning_block});
    line.push_back({"  ", Look::plain});
  }
  if (!picture.label.empty() || picture.waiting_labels > 0) {
    const std::string waiting =
        picture.waiting_labels > 0 ? fmt::format("   +{}", picture.waiting_labels) : std::string();
    line.push_back(
        {say<texts::station_label>(printable(picture.label)) + waiting + "   ", Look::head});
  }
  for (const std::string& text : rest) {
    line.push_back({text + "   ", Look::plain});
  }
  if (line.empty() || picture.label.empty()) {
    line.push_back({picture.note, Look::dim});
  }
  return line;
}

} // namespace

std::vector<ScreenLine> lines_of(const StationPicture& picture, std::size_t width,
                                 std::size_t height) {
  constexpr std::size_t around = 3; // title, totals, note
  constexpr std::size_t enough = around + glyph_height + 2 + glyph_height;
  const Sign sign = sign_of(picture);
  auto signs = lines_of(sign, width, height >= enough);
  const std::size_t used = around + signs.size();
  auto rest = details(picture);
  auto middle = verdict_lines(picture, width, height > used ? height - used : 0, rest);
  std::vector<ScreenLine> lines{first_line(picture, width), {{text_of(picture.totals)}}};
  append(lines, std::move(sign.is_on_top ? signs : middle));
  append(lines, std::move(sign.is_on_top ? middle : signs));
  lines.push_back(last_line(picture, rest));
  return lines;
}

} // namespace blactl::cli
