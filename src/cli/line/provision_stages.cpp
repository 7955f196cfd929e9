// What a run of provision tells as things happen: on its screen, to a lamp, in lines.

#include "blactl/base/json_writer.hpp"

#include "cli/line/provision_run.hpp"
#include "cli/line/texts.hpp"
#include "cli/trace/time.hpp"

#include <utility>

namespace blactl::cli {

using fleet::StationStage;
using state::LedgerRecord;

/// Before the bus: a lamp that shows nothing is worse than no work.
bool ProvisionRun::open_events() {
  if (options_.events.empty()) {
    return true;
  }
  auto file = EventFile::open(options_.events);
  if (!file) {
    return stop(file.error());
  }
  events_ = std::move(*file);
  return true;
}

/// "waiting", "pass": for a lamp or a controller.
void ProvisionRun::tell_event(std::string_view event, const LedgerRecord* record,
                              const std::string& message) const {
  if (!events_) {
    return;
  }
  const LedgerRecord none;
  const LedgerRecord& told = record != nullptr ? *record : none;
  std::string line;
  JsonWriter json(line);
  json.begin_object();
  json.key("time");
  json.number(UnixTime(context_.session().wall()).text());
  json.member("event", event);
  json.member("code", told.code);
  json.member("serial_number", told.serial_number);
  json.member("record_id", told.record_id);
  json.member("message", message.empty() ? std::optional<std::string>() : std::optional(message));
  json.end_object();
  events_->tell(std::move(line));
}

/// Without a terminal that can be drawn on, lines tell all.
void ProvisionRun::open_screen() {
  const Reporter& reporter = context_.reporter();
  if (reporter.format() != Format::text || !reporter.has_screen()) {
    return;
  }
  auto screen = Screen::open(reporter.page().colour);
  if (!screen) {
    return reporter.note(screen.error().message);
  }
  view_ = std::make_unique<StationView>(
      std::move(*screen), reporter,
      say<texts::station_title>(printable(*common_.station), printable(recipe_.name)));
  context_.session().on_resize([this] { view_->draw(); });
}

/// A number that was shown as gone, and owes nothing: that it stands in no record is said.
void ProvisionRun::end_without_record() {
  if (const auto number = std::exchange(gone_, std::nullopt)) {
    context_.reporter().note(say<texts::provision_without_record>(*number));
  }
}

void ProvisionRun::tell(StationStage stage, std::optional<std::int64_t> serial_number) {
  if (stage == StationStage::waiting) {
    logs_.begin();
    end_without_record();
  }
  gone_ = stage == StationStage::gone ? serial_number : std::nullopt;
  if (stage != StationStage::ended) { // its verdict is told
    LedgerRecord known;
    known.serial_number = serial_number;
    tell_event(name(stage), &known);
  }
  const bool has_no_label = lines_ && !label_ && !lines_->is_ready();
  if (view_) {
    view_->enter(stage, serial_number);
    return stage == StationStage::left && has_no_label ? view_->wait_for_label() : void();
  }
  switch (stage) {
  case StationStage::waiting: return context_.reporter().progress(say<texts::provision_waits>());
  case StationStage::recognised: return context_.reporter().progress(say<texts::provision_asks>());
  case StationStage::working: return context_.reporter().progress(say<texts::provision_works>());
  case StationStage::gone: return context_.reporter().progress(say<texts::provision_gone>());
  case StationStage::ended: return;
  case StationStage::left:
    return context_.reporter().progress(has_no_label ? say<texts::provision_label_waits>()
                                                     : say<texts::provision_waits>());
  case StationStage::other:
  case StationStage::take_off: break;
  }
  context_.reporter().progress(say<texts::provision_take_off>());
}

} // namespace blactl::cli
