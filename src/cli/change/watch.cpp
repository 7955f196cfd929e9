#include "cli/change/watch.hpp"

#include "cli/change/entries_view.hpp"
#include "cli/change/texts.hpp"
#include "cli/output/fleet_view.hpp"
#include "cli/output/page.hpp"

#include <algorithm>

namespace blactl::cli {

using fleet::ChangeStage;
using fleet::GoalResult;

namespace {

std::string stage_text(std::optional<ChangeStage> stage) {
  if (!stage) {
    return say<texts::stage_waits>();
  }
  switch (*stage) {
  case ChangeStage::erase: return say<texts::stage_erase>();
  case ChangeStage::write: return say<texts::stage_write>();
  case ChangeStage::save: return say<texts::stage_save>();
  case ChangeStage::restart: return say<texts::stage_restart>();
  case ChangeStage::read: return say<texts::stage_read>();
  case ChangeStage::end: return say<texts::stage_end>();
  }
  return {};
}

} // namespace

void ApplyWatch::begin(std::span<const GoalResult> planned) {
  for (const GoalResult& result : planned) {
    tell(result.servo(), "plan", fleet::name(entry_status(result, true)));
    lines_.push_back({.servo = result.servo(),
                      .name = result.goal.name,
                      .has_work = result.need != fleet::Need::nothing});
  }
}

void ApplyWatch::enter(const fleet::Servo& servo, ChangeStage stage) {
  if (stage != ChangeStage::end) { // the outcome is known when all have ended
    tell(servo, fleet::name(stage), "running");
  }
  const auto line = std::ranges::find_if(
      lines_, [&](const Line& each) { return each.servo.unique_id == servo.unique_id; });
  if (line != lines_.end()) {
    line->stage = stage;
  }
  draw();
}

void ApplyWatch::end(std::span<const GoalResult> results) {
  for (const GoalResult& result : results) {
    fleet::Servo servo = result.servo();
    servo.id = result.change.node_id_after.value_or(servo.id);
    tell(servo, "end", fleet::name(entry_status(result, false)));
  }
  if (context_.reporter().has_screen()) {
    show({});
  }
}

void ApplyWatch::tell(const fleet::Servo& servo, std::string_view stage, std::string_view status) {
  if (events_ != nullptr) {
    events_->tell(context_.session().wall(), servo, stage, status);
  }
}

/// If there are more servos than lines on the screen, finished ones are left out.
void ApplyWatch::draw() {
  if (!context_.reporter().has_screen()) {
    return;
  }
  const Page page = context_.reporter().page();
  const bool fits = lines_.size() + 2 < page.height; // the progress is below
  std::string list;
  for (const Line& line : lines_) {
    if (line.has_work && (fits || line.stage != ChangeStage::end)) {
      list += title(line.name, line.servo) + ": " + stage_text(line.stage) + '\n';
    }
  }
  show(list);
}

/// If the reader has left, nothing more is printed; the work goes on.
void ApplyWatch::show(const std::string& list) {
  has_reader_ = has_reader_ && context_.reporter().show(list).value_or(false);
}

} // namespace blactl::cli
