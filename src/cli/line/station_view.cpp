#include "cli/line/station_view.hpp"

#include <string_view>
#include <utility>

namespace blactl::cli {

using fleet::StationStage;
using state::LedgerRecord;

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

void StationView::enter(StationStage stage, std::optional<std::int64_t> serial_number) {
  picture_.enter(stage, serial_number);
  if (stage == StationStage::recognised) {
    told_ = held_.size(); // notes about the one before are over
  }
  draw();
}

void StationView::wait_for_label() {
  picture_.deed = LineDeed::scan;
  draw();
}

void StationView::show_label(std::string label, std::size_t waiting) {
  picture_.label = std::move(label);
  picture_.waiting_labels = waiting;
  if (waiting > 0 && picture_.deed == LineDeed::scan) {
    picture_.deed = LineDeed::connect;
  }
  draw();
}

void StationView::refuse_label(const std::string& line) {
  picture_.bad_label = line;
  ring(line.empty() ? 0 : 2);
}

void StationView::lose_bus(bool is_away) {
  picture_.deed = is_away ? LineDeed::plug_in : LineDeed::mend;
  draw();
}

void StationView::stop() {
  if (!std::exchange(picture_.is_stopping, true)) {
    draw();
  }
}

void StationView::take(const LedgerRecord& record, const std::optional<Error>& reason,
                       bool is_repeating, bool is_occupied) {
  picture_.take(record, reason, is_repeating, is_occupied);
  ring(picture_.bells());
}

void StationView::join(const LedgerRecord& record, const std::optional<Error>& reason) {
  picture_.join(record, reason);
  ring(picture_.bells());
}

/// Draws, and begins to ring.
void StationView::ring(int times) {
  draw();
  bells_ = times;
  tick();
}

void StationView::tick() {
  if (bells_ > 0) {
    --bells_;
    Screen::ring();
  }
  if (picture_.tick()) {
    draw();
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
