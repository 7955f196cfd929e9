#include "cli/doctor/motion.hpp"

#include "blactl/fleet/doctor/motion.hpp"

#include "cli/doctor/texts.hpp"
#include "cli/interface/scheme.hpp"
#include "cli/stores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

fleet::HeardCommands heard_commands(const fleet::Servo& servo, Context& context,
                                    const fleet::Traffic& traffic) {
  const fleet::Session& session = context.session();
  auto heard = fleet::commands_to(servo, session.roster(), fleet::heard_until(session));
  heard.is_long_enough = !context.is_fleet_file() && traffic.duration() >= fleet::Repeated::least;
  return heard;
}

std::vector<dronecan::NodeId> servos_to_move(const fleet::Findings& findings, bool are_named,
                                             Time now) {
  std::vector<dronecan::NodeId> servos;
  for (const fleet::Finding& node : findings.nodes) {
    const bool is_one = node.servo.is_servo && !findings.roster->is_doubled(node.servo.id);
    if (is_one && !node.is_offline &&
        (are_named || !fleet::commands_to(node.servo, *findings.roster, now).to_it.empty())) {
      servos.push_back(node.servo.id);
    }
  }
  return servos;
}

/// What is recorded of these servos; empty: nothing, or they are in a file, of whatever time.
std::optional<fleet::History> history_of(const Context& context) {
  const std::string_view interface = context.shared().interface;
  auto history = takes_no_frames(interface)
                     ? Result<fleet::History>(fail(Code::not_recorded, std::string()))
                     : open_history(interface, "doctor", state::Access::read);
  return history ? std::optional(std::move(*history)) : std::nullopt;
}

std::string commands_unjudged(dronecan::NodeId id, const fleet::Traffic& traffic) {
  using Seconds = std::chrono::duration<double>;
  return traffic.duration()
             ? say<texts::doctor_commands_unjudged>(
                   id.value(), fmt::format("{:.1f}", Seconds(*traffic.duration()).count()),
                   Seconds(fleet::Repeated::least).count())
             : say<texts::doctor_commands_untimed>(id.value());
}

} // namespace

fleet::Snapshots read_motion(Context& context, const fleet::Findings& findings, bool are_named) {
  const auto servos = servos_to_move(findings, are_named, fleet::heard_until(context.session()));
  const auto choice = [](const fleet::Servo& servo) -> Result<std::vector<const bla::Parameter*>> {
    return fleet::registers_of_motion(servo);
  };
  return fleet::take_snapshots(context.session(), context.known(), servos, context.identification(),
                               choice);
}

fleet::Diagnoses diagnose_motions(const fleet::Snapshots& servos, bool are_named, Context& context,
                                  const fleet::Traffic& traffic) {
  fleet::Diagnoses found;
  auto history = history_of(context);
  const auto look = are_named ? fleet::MotionLook::named : fleet::MotionLook::commanded;
  for (const fleet::Snapshot& servo : servos.servos) {
    if (!servo.error) {
      const auto rom = history ? history->known_rom(servo, context.session()) : bla::Values();
      std::ranges::move(fleet::diagnose_motion(servo, heard_commands(servo.servo, context, traffic),
                                               context.known(), look, rom),
                        std::back_inserter(found));
    }
    const auto error = servo.first_error();
    if (error && error->code != Code::not_recorded && error->code != Code::interrupted) {
      found.push_back({.code = std::string(name(error->code)),
                       .level = bla::Level::failure,
                       .node = servo.servo.id,
                       .text = error->message,
                       .fix = error->hint});
    }
  }
  return found;
}

std::vector<Unjudged> unjudged_motions(const fleet::Snapshots& servos, Context& context,
                                       const fleet::Traffic& traffic) {
  std::vector<Unjudged> unjudged;
  if (servos.servos.empty()) {
    return {{.text = say<texts::doctor_read_none>()}};
  }
  if (context.is_fleet_file()) { // of which nobody expects what only a bus tells
    return {};
  }
  for (const fleet::Snapshot& servo : servos.servos) {
    const dronecan::NodeId id = servo.servo.id;
    const auto heard = heard_commands(servo.servo, context, traffic);
    if (!heard.is_long_enough && heard.to_it.empty()) {
      unjudged.push_back({id, commands_unjudged(id, traffic)});
    }
    for (const Error& error : servo.errors()) {
      if (error.code == Code::not_recorded) {
        unjudged.push_back({id, error.message});
      }
    }
  }
  return unjudged;
}

} // namespace blactl::cli
