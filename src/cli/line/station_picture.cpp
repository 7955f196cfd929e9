#include "cli/line/station_picture.hpp"

#include "blactl/fleet/line/line_record.hpp"

#include "cli/line/big_letters.hpp"
#include "cli/line/texts.hpp"
#include "cli/output/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace blactl::cli {

using fleet::StationStage;
using state::LedgerRecord;

namespace {

/// How a state fills the screen.
struct Face {
  std::string word;
  Glyph symbol;
  Look look;
  int bells;
};

Face face_of(const std::string& verdict) {
  return verdict == fleet::verdict::pass   ? Face{"PASS", ring, Look::good_block, 1}
         : verdict == fleet::verdict::fail ? Face{"FAIL", cross, Look::bad_block, 3}
         : verdict == fleet::verdict::skip ? Face{"SKIP", equal, Look::skip_block, 1}
                                           : Face{"ERROR", exclamation, Look::warning_block, 2};
}

ScreenLine centred(std::string text, std::size_t width, Look look) {
  const std::size_t used = std::min(display_width(text), width);
  const std::size_t before = (width - used) / 2;
  return {
      {std::string(before, ' ') + std::move(text) + std::string(width - used - before, ' '), look}};
}

/// Of its symbol and its word, with their gaps.
std::size_t squares_of(const Face& face) {
  constexpr std::size_t of_symbol = 7, of_letter = 5;
  return of_symbol + of_letter * face.word.size();
}

/// Symbol and word beside each other; squares as wide as fits.
ScreenLine big_row(const Face& face, std::size_t row, std::size_t width, Paint paint) {
  const std::size_t squares = squares_of(face);
  const std::size_t square = squares * 2 <= width ? 2 : 1;
  const std::size_t margin = width > squares * square ? (width - squares * square) / 2 : 0;
  ScreenLine line{{std::string(margin, ' '), paint.ground}};
  add_row(line, face.symbol.at(row), square, paint);
  add_row(line, "..", square, paint);
  for (const char each : face.word) {
    add_row(line, letter(each).at(row), square, paint);
    add_row(line, ".", square, paint);
  }
  const std::size_t used = margin + squares * square;
  line.push_back({std::string(width > used ? width - used : 0, ' '), paint.ground});
  return line;
}

/// That it goes on: one more dot with every beat.
Glyph moving_dots(const StationPicture& picture) {
  constexpr std::array<std::string_view, 4> rows{".....", "#....", "#.#..", "#.#.#"};
  return {".....", ".....", rows.at(picture.beat % rows.size()), ".....", "....."};
}

bool is_busy(const StationPicture& picture) {
  return picture.deed == LineDeed::leave || picture.deed == LineDeed::hands_off;
}

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
  const bool are_several = picture.are_several();
  switch (picture.deed) {
  case LineDeed::connect:
    return {arrow_down, Look::in_block, false,
            are_several                 ? texts::deed_connect_one
            : is(fleet::verdict::error) ? texts::deed_connect_again
                                        : texts::deed_connect};
  case LineDeed::scan: return {bars, Look::in_block, false, texts::deed_scan};
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
  if (record.code == name(Code::label_mismatch) && record.expected && record.actual) {
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
  return lines;
}

Face face_of(const StationPicture& picture) {
  if (picture.last) {
    return face_of(picture.last->verdict.value_or(""));
  }
  switch (picture.deed) {
  case LineDeed::bring_back: return {"GONE", exclamation, Look::warning_block, 0};
  case LineDeed::leave:
  case LineDeed::hands_off:
    return picture.is_stopping ? Face{"STOP", barrier, Look::warning_block, 0}
                               : Face{"BUSY", moving_dots(picture), Look::block, 0};
  default: return {"READY", ring, Look::plain, 0};
  }
}

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
  const ScreenLine empty = centred("", width, paint.ground);
  for (std::size_t row = 0; row < glyph_height && room >= glyph_height; ++row) {
    lines.push_back(big_row(face, row, width, paint));
  }
  if (picture.last) {
    const auto texts = details(picture);
    if (room > lines.size() + texts.size()) {
      lines.push_back(empty);
    }
    for (const std::string& text : texts) {
      lines.push_back(centred(text, width, paint.ground));
    }
  }
  lines.resize(std::min(lines.size(), room));
  lines.insert(lines.begin(), (room - lines.size()) / 2, empty);
  lines.insert(lines.end(), room - lines.size(), empty);
  return lines;
}

/// The units that have to come back: large where the verdict leaves the room for it.
std::vector<ScreenLine> owed_lines(const StationPicture& picture, std::size_t width,
                                   std::size_t room) {
  if (picture.owed.empty() || room == 0) {
    return {};
  }
  Face face{"", exclamation, Look::warning_block, 0};
  for (const StationPicture::Owed& each : picture.owed) {
    face.word += (face.word.empty() ? "" : " ") + each.number;
  }
  const bool is_news = picture.last || face_of(picture).look == Look::warning_block;
  const std::size_t of_verdict =
      is_news ? glyph_height + (picture.last ? 1 + details(picture).size() : 0) : 0;
  if (room < of_verdict + glyph_height || squares_of(face) > width) {
    return {centred("!  " + face.word + "  !", width, face.look)};
  }
  std::vector<ScreenLine> lines;
  lines.reserve(glyph_height);
  for (std::size_t row = 0; row < glyph_height; ++row) {
    lines.push_back(big_row(face, row, width, {face.look, Look::plain}));
  }
  return lines;
}

/// Labels, else the note.
ScreenLine last_line(const StationPicture& picture) {
  if (picture.label.empty() && picture.waiting_labels == 0) {
    return {{picture.note, Look::dim}};
  }
  const std::string waiting =
      picture.waiting_labels > 0 ? fmt::format("   +{}", picture.waiting_labels) : std::string();
  return {{say<texts::station_label>(printable(picture.label)) + waiting, Look::head}};
}

} // namespace

void StationPicture::enter(StationStage stage) {
  switch (stage) {
  case StationStage::waiting: // one that left before it was known has no record
    deed = deed == LineDeed::bring_back ? deed : LineDeed::connect;
    return;
  case StationStage::recognised:
    deed = LineDeed::leave;
    last.reset();
    joined.reset();
    return;
  case StationStage::working: deed = LineDeed::hands_off; return;
  case StationStage::gone: deed = LineDeed::bring_back; return;
  case StationStage::ended: return; // its record comes
  case StationStage::left:          // an error needs the full time without a frame
    deed = are_several() || (last && last->verdict == fleet::verdict::error) ? LineDeed::leave
                                                                             : LineDeed::connect;
    return;
  case StationStage::other:
    if (joined) {
      last = std::exchange(joined, std::nullopt);
      reason = joined_reason;
    }
    deed = are_several() ? LineDeed::take_off : LineDeed::leave;
    return;
  case StationStage::take_off: break;
  }
  deed = is_repeating ? LineDeed::connect : LineDeed::take_off;
}

bool StationPicture::are_several() const {
  return joined || (last && last->code == name(Code::several_servos));
}

void StationPicture::join(const LedgerRecord& record, const std::optional<Error>& why) {
  totals.add(record);
  joined = record;
  joined_reason = why;
}

void StationPicture::take(const LedgerRecord& record, const std::optional<Error>& why,
                          bool is_again, bool is_occupied) {
  totals.add(record);
  last = record;
  reason = why;
  is_repeating = is_again;
  deed = !is_again     ? LineDeed::take_off
         : is_occupied ? LineDeed::leave // it is asked next
                       : LineDeed::connect;
  if (!record.unique_id) {
    return;
  }
  std::erase_if(owed, [&](const Owed& each) { return each.unit == *record.unique_id; });
  if (record.verdict == fleet::verdict::error && record.serial_number) {
    owed.push_back({*record.unique_id, std::to_string(*record.serial_number)});
  }
}

bool StationPicture::tick() {
  ++beat;
  return is_busy(*this);
}

int StationPicture::bells() const {
  return joined ? face_of(joined->verdict.value_or("")).bells : face_of(*this).bells;
}

std::vector<ScreenLine> lines_of(const StationPicture& picture, std::size_t width,
                                 std::size_t height) {
  constexpr std::size_t around = 3; // title, totals, note
  constexpr std::size_t enough = around + glyph_height + 2 + glyph_height;
  const Sign sign = sign_of(picture);
  const auto signs = lines_of(sign, width, height >= enough);
  const std::size_t used = around + signs.size();
  const std::size_t room = height > used ? height - used : 0;
  const auto owed = owed_lines(picture, width, room);
  auto middle = verdict_lines(picture, width, room - owed.size());
  middle.insert(middle.end(), owed.begin(), owed.end());
  std::vector<ScreenLine> lines{{{picture.title, Look::head}}, {{text_of(picture.totals)}}};
  const auto& first = sign.is_on_top ? signs : middle;
  const auto& second = sign.is_on_top ? middle : signs;
  lines.insert(lines.end(), first.begin(), first.end());
  lines.insert(lines.end(), second.begin(), second.end());
  lines.push_back(last_line(picture));
  return lines;
}

} // namespace blactl::cli
