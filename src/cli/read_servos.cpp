#include "cli/read_servos.hpp"

#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "cli/interface/scheme.hpp"
#include "cli/texts.hpp"

#include <utility>

namespace blactl::cli {
namespace {

/// Nothing may be sent, and it is not a recording.
bool must_be_silent(const Context& context) {
  return context.shared().listen_only && !takes_no_frames(context.shared().interface);
}

} // namespace

bool open_for_reading(std::string_view command, Context& context, Report& report) {
  if (must_be_silent(context)) {
    report.fail({Code::usage, say<texts::listen_only_refused>(command),
                 say<texts::listen_only_hint>(), std::nullopt});
    return false;
  }
  if (auto session = context.open(fleet::Session::Hearing::commands); !session) {
    report.fail(session.error());
    return false;
  }
  report.interface = context.session().interface();
  return true;
}

std::optional<std::vector<dronecan::NodeId>> select_for_reading(std::string_view command,
                                                                Context& context, Report& report) {
  const auto targets = context.targets();
  if (!targets) {
    report.fail(targets.error());
    return std::nullopt;
  }
  if (!open_for_reading(command, context, report)) {
    return std::nullopt;
  }
  fleet::Discovery discovery(context.session(), context.known(), context.identification());
  auto selection = discovery.select(*targets, fleet::servo_search_time);
  if (!selection) {
    context.broken(selection.error(), report);
    return std::vector<dronecan::NodeId>{};
  }
  for (const std::string& note : selection->notes) {
    context.reporter().note(note);
  }
  for (Error& error : selection->errors) {
    report.fail_target(std::move(error));
  }
  return std::move(selection->ids);
}

void note_copies(std::span<const fleet::Snapshot> servos, Context& context) {
  for (const fleet::Snapshot& snapshot : servos) {
    if (const auto copied = fleet::not_unique(context.session().roster(), snapshot.servo.id)) {
      context.reporter().note(copied->message);
    }
  }
}

} // namespace blactl::cli
