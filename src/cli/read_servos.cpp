#include "cli/read_servos.hpp"

#include "blactl/fleet/discovery.hpp"
#include "blactl/fleet/texts.hpp"

#include "cli/interface/bus_factory.hpp"
#include "cli/texts.hpp"

#include <utility>

namespace blactl::cli {
namespace {

/// Nothing may be sent, and it is no recording.
bool must_be_silent(const Context& context) {
  return context.shared().listen_only && !takes_no_frames(context.shared().interface);
}

} // namespace

std::optional<std::vector<dronecan::NodeId>> select_for_reading(std::string_view command,
                                                                Context& context, Report& report) {
  const auto stop = [&](Error error) {
    report.fail(std::move(error));
    return std::nullopt;
  };
  if (must_be_silent(context)) {
    return stop({Code::usage, say<texts::listen_only_refused>(command),
                 say<texts::listen_only_hint>(), std::nullopt});
  }
  const auto targets = context.targets();
  if (!targets) {
    return stop(targets.error());
  }
  if (auto session = context.open(fleet::Session::Hearing::answers); !session) {
    return stop(session.error());
  }
  report.interface = context.session().interface();
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

} // namespace blactl::cli
