// The labels of a run of provision: a line for each servo, from stdin or typed.

#include "cli/line/provision_run.hpp"
#include "cli/line/texts.hpp"

#include <utility>

namespace blactl::cli {

/// Keys belong to the screen; without labels they mean nothing.
void ProvisionRun::open_labels() {
  const bool has_keys = view_ && Screen::input() >= 0;
  if (!options_.label.empty()) {
    lines_.emplace(context_.session(),
                   has_keys ? LabelLines::Source::keys : LabelLines::Source::stdin_itself);
  }
  if (has_keys) {
    context_.session().on_input(Screen::input(), [this] {
      const std::string typed = view_->typed();
      if (lines_) {
        take_typed(typed);
      }
    });
  }
}

/// A bad scan is told at once, also one that was made ahead.
void ProvisionRun::take_typed(const std::string& typed) {
  lines_->type(typed);
  if (typed.find('\n') != std::string::npos) {
    view_->refuse_label(lines_->take_out_unless([this](const std::string& line) {
      const auto label = fleet::parse_label(line, lines_->number() + 1, context_.known());
      label ? void() : context_.reporter().error(label.error());
      return label.has_value();
    }));
  }
  show_label();
}

/// The one that counts, else what was typed so far; and that more were typed ahead.
void ProvisionRun::show_label() {
  if (view_ && lines_) {
    view_->show_label(label_ ? label_->text : std::string(lines_->unfinished()), lines_->waiting());
  }
}

void ProvisionRun::ask_for_label() {
  view_ ? view_->wait_for_label()
        : context_.reporter().progress(say<texts::provision_label_waits>());
}

/// Waits for what comes first: a line, or a servo, under which no result of another one shall be
/// shown. Returns whether the run goes on.
bool ProvisionRun::wait_for_line(const fleet::Station& station, bool& is_recognised) {
  const auto lived = context_.session().live_until(idle_deadline(), [&] {
    return lines_->is_ready() || (!is_recognised && station.is_servo_there());
  });
  if (!lived) {
    const bool goes_on = goes_on_after(lived.error());
    goes_on ? ask_for_label() : void();
    return goes_on;
  }
  if (!*lived) {
    end_by_idling();
    return false;
  }
  if (!lines_->is_ready()) {
    is_recognised = true;
    tell(fleet::StationStage::recognised);
    ask_for_label();
  }
  return true;
}

/// A line that is no label is told, and the next one is waited for.
bool ProvisionRun::wait_for_label(const fleet::Station& station) {
  ask_for_label();
  bool is_recognised = station.is_servo_there(); // it was told
  while (!label_) {
    const auto line = lines_->next();
    if (!line && lines_->has_ended()) {
      if (options_.count) {
        stop({Code::not_found, say<texts::provision_labels_end>(counted_, *options_.count),
              say<texts::provision_labels_end_hint>(), std::nullopt});
      }
      return false;
    }
    if (!line) {
      if (!wait_for_line(station, is_recognised)) {
        return false;
      }
      continue;
    }
    auto label = fleet::parse_label(*line, lines_->number(), context_.known());
    if (label) {
      label_ = std::move(*label);
      view_ ? view_->refuse_label({}) : void();
      show_label();
    } else {
      view_ ? view_->refuse_label(*line) : void();
      context_.reporter().error(label.error());
      ask_for_label();
    }
  }
  return true;
}

} // namespace blactl::cli
